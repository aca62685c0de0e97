// Put what the server sent together where it belongs: a text into its Div, without the layout of the whole page, and
// columns into the source of a plot. `{"numbers": n}` stands for the next n of all numbers.
const {content: [content], numbers: [sent]} = post.data;
const parts = () => {
  const numbers = new Float32Array(sent.buffer, sent.byteOffset, sent.length); // parts of Bokeh's own arrays are whole
  let next = 0;
  const taken = (_, value) => value?.numbers === undefined ? value : numbers.subarray(next, (next += value.numbers));
  return JSON.parse(content, taken);
};
(content === undefined ? [] : parts()).forEach((part, place) => {
  const model = models[place];
  if (typeof part !== "string") {
    model.setv({data: {...model.data, ...part}}, {sync: false, check_eq: false});
  } else if (part !== model.text) {
    model.setv({text: part}, {silent: true}); // for Bokeh, should it draw the Div again
    const view = Bokeh.index.find_one(model);
    if (view) view.markup_el.innerHTML = part;
  }
});
