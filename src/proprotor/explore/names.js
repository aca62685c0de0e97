// Tell screen readers what each slider sets and what each plot shows: Bokeh gives sliders no name and plots no role.
const name_all = () => {
  for (const view of Bokeh.index.all_views()) {
    const {name, type, title} = view.model;
    if (type === "Slider" || type === "RangeSlider") {
      const handles = view.shadow_el.querySelectorAll(".noUi-handle");
      const ends = handles.length > 1 ? [", lowest", ", highest"] : [""];
      handles.forEach((handle, place) => handle.setAttribute("aria-label", title + ends[place]));
    } else if (type === "Div" && view.markup_el) {
      view.markup_el.setAttribute("aria-live", name === "readout" ? "polite" : "off");
    } else if (type === "Figure") {
      view.el.setAttribute("role", "img");
      view.el.setAttribute("aria-label", `${title.text}: see Modes for the numbers`);
    }
  }
};
name_all();
document.addEventListener("focusin", name_all); // sliders that were made since then
