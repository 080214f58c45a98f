/** What is known of the difference of a record's image to that of no culling. */
function verdict(record) {
  const channels = record.width * record.height * 3;
  if (record.differing_channels === 0) {
    return `The same in every bit: none of ${count(channels)} channels differs.`;
  }
  if (isNumber(record.differing_channels)) {
    const most = isNumber(record.max_abs_diff) ? `by at most ${record.max_abs_diff.toPrecision(3)}` : "by more than a number can say";
    return `${count(record.differing_channels)} of ${count(channels)} channels differ, ${most} (linear).`;
  }
  return isNumber(record.max_abs_diff)
    ? `Differs by at most ${record.max_abs_diff.toPrecision(3)} (linear).`
    : "Not compared with no culling.";
}

function picture(source, alternative, properties = {}) {
  return source
    ? h("img", { src: source, alt: alternative, draggable: "false", ...properties })
    : h("div", { class: "missing" }, "No picture was kept");
}

/** No culling on the left of a line that can be moved, the strategy on its right. */
function slider(record, baseline) {
  const frame = h("div", { class: "compare", style: `aspect-ratio:${record.width}/${record.height};--at:50%` },
    picture(baseline, `${record.scene} without culling`),
    picture(uri(record.images.image), `${record.scene} with ${record.strategy}`, { class: "over" }),
    h("span", { class: "tag left" }, "no culling"),
    h("span", { class: "tag right" }, record.strategy),
    h("span", { class: "line" }),
    h("input", {
      type: "range", min: "0", max: "100", step: "0.5", value: "50",
      "aria-label": `Share of the picture that shows no culling; the rest shows ${record.strategy}`,
      oninput: (event) => frame.style.setProperty("--at", `${event.target.value}%`),
    }));
  return frame;
}

function still(record) {
  return h("div", { class: "compare", style: `aspect-ratio:${record.width}/${record.height}` },
    picture(uri(record.images.image), `${record.scene} with ${record.strategy}`));
}

function differenceFigure(record) {
  const factor = record.images.difference_amplification;
  const times = isNumber(factor) && factor !== 1 ? ` \u00d7\u00a0${tickText(Number(factor.toPrecision(3)))}` : "";
  const source = uri(record.images.difference);
  if (!source && record.differing_channels === 0) {
    return h("figure", { class: "difference" }, h("figcaption", {}, h("b", {}, "Difference. "), verdict(record)));
  }
  return h("figure", { class: "difference" },
    h("div", { style: `aspect-ratio:${record.width}/${record.height}` },
      picture(source, `Difference of ${record.strategy} to no culling: ${verdict(record)}`)),
    h("figcaption", {}, h("b", {}, `Difference${times}. `), source ? "Black is no difference. " : "", verdict(record)));
}

function show(record, baseline) {
  if (record.strategy === "Clay") {
    return [h("figure", { class: "main" }, still(record), h("figcaption", {}, "The surfaces alone, without lights."))];
  }
  if (record.strategy === "None") {
    return [h("figure", { class: "main" }, still(record), h("figcaption", {}, "No culling: every light at every sample."))];
  }
  const own = uri(record.images.image);
  const main = own && baseline ? slider(record, baseline) : still(record);
  const hint = own && baseline
    ? "Drag the line, or use the arrow keys: no culling on its left, "
    : "Drawn with ";
  return [
    h("figure", { class: "main" }, main, h("figcaption", {}, hint, h("b", {}, record.strategy), own && baseline ? " on its right." : ".")),
    differenceFigure(record),
    heatFigure(record),
    histogramFigure(record),
  ].filter((figure) => figure !== null);
}

function drawPictures(place, records, baselineRecord) {
  const culling = records.filter((record) => record.strategy !== "None");
  const options = culling.length ? culling : records;
  if (!records.some((record) => uri(record.images.image) || uri(record.images.difference))) {
    place.append(h("p", { class: "note" }, "No pictures were kept."));
    return;
  }
  const stage = h("div", { class: "stage" });
  const draw = (record) => {
    const baseline = (baselineRecord && uri(baselineRecord.images.image)) || uri(record.images.baseline);
    stage.replaceChildren(...show(record, baseline));
  };
  const choices = options.map((record) => ({ value: record, text: record.strategy, mark: strategyClass(record) }));
  place.append(
    h("div", { class: "figcaption" }, h("h3", {}, "What it looks like"),
      options.length > 1 ? choice("Strategy", choices, options[0], draw) : null),
    stage);
  draw(options[0]);
}

view.comparisons.forEach((comparison, ix) => {
  const records = comparison.records.map((record) => results.records[record]);
  const baseline = comparison.baseline === null ? null : records[comparison.baseline];
  drawPictures(document.querySelector(`[data-comparison="${ix}"] .pictures`), records, baseline);
});
