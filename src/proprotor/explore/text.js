// Put a text that the server sent into a Div, without the layout of the whole page.
const text = cb_obj.data.text[0];
div.setv({text}, {silent: true}); // for Bokeh, should it draw the Div again
const view = Bokeh.index.find_one(div);
if (view) view.markup_el.innerHTML = text;
