/** The lengths of a histogram's bin: 0, 1, 2 to 3, 4 to 7 and so on. */
function binText(bin) {
  if (bin < 2) return String(bin);
  return `${count(2 ** (bin - 1))}\u2013${count(2 ** bin - 1)}`;
}

/** Lights per pixel over the scene, with its scale. */
function heatFigure(record) {
  const source = uri(record.images.heat_map);
  if (!source) return null;
  const scale = h("div", { class: "heat-scale", "aria-hidden": "true" },
    h("span", {}, "0"), h("i", { class: "heat-ramp" }), h("span", {}, "150"), h("i", { class: "heat-above" }), h("span", {}, "more"));
  return h("figure", { class: "difference heat" },
    h("div", { style: `aspect-ratio:${record.width}/${record.height}` },
      picture(source, `Lights in the list of each pixel, ${record.strategy}`)),
    h("figcaption", {}, h("b", {}, "Lights per pixel. "), `${record.strategy} lists ${significant(record.listed_per_sample)} a pixel on average.`, scale));
}

/** How many of the groups that pixels read have lists of which length. */
function histogramFigure(record) {
  const bins = record.histogram || [];
  const total = bins.reduce((sum, groups) => sum + groups, 0);
  if (total === 0) return null;
  const most = Math.max(...bins);
  const rows = bins.map((groups, bin) =>
    h("div", { class: "bin" },
      h("span", { class: "bin-lights" }, binText(bin)),
      h("span", { class: "bin-bar" }, h("i", { class: strategyClass(record), style: `width:${((groups / most) * 100).toFixed(2)}%` })),
      h("span", { class: "bin-groups" }, count(groups))));
  return h("figure", { class: "histogram" },
    h("div", { role: "img", "aria-label": `Groups of ${record.strategy} by the number of lights in their list: ${bins.map((groups, bin) => `${binText(bin)}: ${groups}`).join(", ")}` },
      h("div", { class: "bin bin-head", "aria-hidden": "true" }, h("span", { class: "bin-lights" }, "lights"), h("span"), h("span", { class: "bin-groups" }, "groups")),
      ...rows),
    h("figcaption", {}, h("b", {}, "Lists by length. "), `${count(total)} groups that some pixel reads, of ${count(record.groups)}.`));
}
