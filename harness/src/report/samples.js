/** Samples further than this from their median are drawn at the edge, as arrows. */
const WIDEST = 1;

function spread(pass) {
  const samples = pass.samples.filter(isNumber);
  const most = Math.max(...samples);
  const least = Math.min(...samples);
  return { samples, least, most, share: pass.median_ms > 0 ? (most - least) / pass.median_ms : 0 };
}

const deviation = (sample, pass) => (pass.median_ms > 0 ? sample / pass.median_ms - 1 : 0);

/** A round share that every sample lies within, or the widest. */
function halfWidth(passes) {
  const all = passes.flatMap((pass) => pass.samples.filter(isNumber).map((sample) => Math.abs(deviation(sample, pass))));
  const most = all.reduce((a, b) => Math.max(a, b), 0);
  return [0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5].find((share) => share >= most) || WIDEST;
}

function strip(record, name, pass, half) {
  const { samples, least, most, share } = spread(pass);
  const place = (sample) => 500 + (deviation(sample, pass) / half) * 490;
  const inside = samples.filter((sample) => Math.abs(deviation(sample, pass)) <= half);
  const outside = samples.length - inside.length;
  const ticks = inside.map((sample) => `M${place(sample).toFixed(1)} 4V20`).join("");
  const picture = s("svg", { viewBox: "0 0 1000 24", preserveAspectRatio: "none", "aria-hidden": "true" },
    s("path", { class: "middle", d: "M500 0V24" }),
    s("path", { class: `ticks ${passClass(name)}`, d: ticks }));
  const label = samples.length === 0
    ? "no sample"
    : `${samples.length} samples from ${ms(least)} to ${ms(most)}, ${percent(share, 1)} of the median apart`;
  const box = h("div", { class: "strip", role: "img", tabindex: "0", "aria-label": label }, picture,
    outside ? h("span", { class: "outside" }, `${outside} further out \u25b8`) : null);
  explain(box, () => [
    h("b", {}, `${record.strategy}, ${name}`),
    h("table", {}, ...[["least", least], ["median", pass.median_ms], ["95th percentile", pass.p95_ms], ["most", most]]
      .map(([what, time]) => h("tr", {}, h("td", {}, what), h("td", {}, ms(time))))),
    h("div", {}, `${samples.length} samples`),
  ]);
  return box;
}

function sampleRows(record, half) {
  const rows = Object.entries(record.passes).map(([name, pass]) =>
    h("tr", {},
      h("th", { scope: "row" }, dot(passClass(name)), name),
      h("td", {}, significant(pass.median_ms)),
      h("td", {}, significant(pass.p95_ms)),
      h("td", { class: "wide" }, strip(record, name, pass, half))));
  const name = h("th", { scope: "rowgroup", class: "strategy", colspan: "4" }, dot(strategyClass(record)), record.strategy);
  return [h("tr", {}, name), ...rows];
}

function drawSamples(figure, records) {
  const passes = records.flatMap((record) => Object.values(record.passes));
  if (passes.length === 0) {
    figure.remove();
    return;
  }
  const half = halfWidth(passes);
  const side = percent(half);
  const head = h("tr", {},
    h("th", { scope: "col" }, "pass"),
    ...["median", "p95"].map((text) => h("th", { scope: "col", class: "number" }, text, " ", h("span", { class: "unit" }, "ms"))),
    h("th", { scope: "col", class: "wide" },
      h("span", { class: "ends" }, h("span", {}, `\u2212${side}`), h("span", {}, "median"), h("span", {}, `+${side}`))));
  figure.append(
    h("figcaption", {}, h("h3", {}, "Every sample")),
    h("p", { class: "note" }, "One line per frame, placed by how far it is from its pass\u2019s median. Bunched lines mean a steady clock."),
    h("div", { class: "scroll", role: "region", tabindex: "0", "aria-label": "Samples of every pass" },
      h("table", {}, h("thead", {}, head), ...records.map((record) => h("tbody", {}, ...sampleRows(record, half))))));
}

view.comparisons.forEach((comparison, ix) => {
  const figure = document.querySelector(`[data-comparison="${ix}"] .samples`);
  drawSamples(figure, comparison.records.map((record) => results.records[record]));
});
