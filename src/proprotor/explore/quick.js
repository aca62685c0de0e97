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
} catch (error) {
  console.info("Bokeh paints in its own way:", error.message); // another Bokeh, which is slower at most
}
