// Let Bokeh paint without computing the styles of the page again and again. At each paint Bokeh writes the place of each
// part of a plot into a style sheet, though the part stays where it is, and asks the styles for colours, which this page
// sets in no style sheet. See https://github.com/bokeh/bokeh/issues/15286.
try {
  const {InlineStyleSheet} = Bokeh.require("core/dom"), {VisualProperties} = Bokeh.require("core/visuals/visual");
  const {replace} = InlineStyleSheet.prototype;
  InlineStyleSheet.prototype.replace = function (...css) {
    if (css.length > 1 || css[0] !== this.css) replace.apply(this, css);
  };
  VisualProperties.prototype._get_css_value = () => "";
  // The size of letters and the room that the labels of an axis take, for which Bokeh asks the styles and measures all
  // labels twice at each paint, stay the same as long as the window and the range of the axis do.
  const {PlotView} = Bokeh.require("models/plots/plot"), {AxisView} = Bokeh.require("models/axes/axis");
  let sizes = new WeakMap(), extents = new WeakMap();
  addEventListener("resize", () => (sizes = new WeakMap(), extents = new WeakMap()));
  const kept = (view, name, found, same) => {
    const {get} = Object.getOwnPropertyDescriptor(view.prototype, name);
    Object.defineProperty(view.prototype, name, {configurable: true, get() {
      const now = same(this), last = found().get(this);
      if (last !== undefined && now.every((one, place) => one === last.now[place])) return last.value;
      const value = get.call(this);
      if (value !== null) found().set(this, {now, value});
      return value;
    }});
  };
  kept(PlotView, "base_font_size", () => sizes, () => []);
  kept(AxisView, "extents", () => extents, ({_axis_label_view, ranges: [{start, end}]}) => [_axis_label_view, start, end]);
} catch (error) {
  console.info("Bokeh paints in its own way:", error.message); // another Bokeh, which is slower at most
}
