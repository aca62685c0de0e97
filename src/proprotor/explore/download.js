// Save the file that the server sent: its name, kind and content in base64.
const [name, kind, content] = ["name", "kind", "content"].map((column) => cb_obj.data[column][0]);
const bytes = Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0));
const place = document.createElement("a");
place.href = URL.createObjectURL(new Blob([bytes], {type: kind}));
place.download = name;
place.click();
URL.revokeObjectURL(place.href);
