/** More than this between the fastest and the slowest frame, and the axis starts logarithmic. */
const LOG_ABOVE = 60;

/** A pass's time in a record: the mean along a path, where a frame without the pass counts as 0, else the median. */
function timeOf(record, pass) {
  if (!record.along_path || !pass.samples?.length) return pass.median_ms;
  return pass.samples.reduce((sum, time) => sum + (isNumber(time) ? time : 0), 0) / pass.samples.length;
}

/** Names and times of the passes that were measured. */
const measured = (record) => Object.entries(record.passes)
  .map(([name, pass]) => [name, timeOf(record, pass)])
  .filter(([, time]) => isNumber(time));

/** The names of all passes, in the order in which a frame runs them. */
function passNames(records) {
  const kinds = ["scene", "assign", "shade", "other"];
  const kindOf = new Map(records.flatMap((record) => Object.entries(record.passes).map(([name, pass]) => [name, pass.kind])));
  return [...kindOf.keys()].sort((a, b) => kinds.indexOf(kindOf.get(a)) - kinds.indexOf(kindOf.get(b)));
}

/** At most about five round steps from 0 to `most`. */
function linearTicks(most) {
  const raw = most / 5;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((factor) => factor * power).find((size) => size >= raw) || power;
  const ticks = [];
  for (let ix = 0; ix * step <= most * 1.0001; ix += 1) ticks.push(ix * step);
  return ticks;
}

/** An axis of times: where a time lies, as a share of the width, and its ticks. */
function timeAxis(records, logarithmic) {
  const frames = records.map((record) => record.frame_ms).filter(isNumber);
  const most = Math.max(...frames, 0) || 1;
  if (!logarithmic) {
    return { place: (time) => time / most, ticks: linearTicks(most) };
  }
  const times = records.flatMap((record) => measured(record).map(([, time]) => time));
  const positive = [...times, ...frames].filter((time) => time > 0);
  const low = Math.floor(Math.log10(Math.min(...positive, most)));
  const high = Math.max(Math.ceil(Math.log10(most)), low + 1);
  const place = (time) => (Math.log10(time) - low) / (high - low);
  const ticks = [];
  for (let power = low; power <= high; power += 1) ticks.push(10 ** power);
  return { place, ticks };
}

/** A tick's label: no more digits than it needs. */
const tickText = (value) => Number(value.toPrecision(6)).toLocaleString("en-US", { maximumFractionDigits: 6 });

const at = (share) => `${(Math.min(Math.max(share, 0), 1) * 100).toFixed(3)}%`;

function breakdown(record, current) {
  const rows = measured(record).map(([name, time]) =>
    h("tr", { class: name === current ? "current" : null },
      h("td", {}, dot(passClass(name)), name),
      h("td", {}, ms(time)),
      h("td", {}, record.frame_ms > 0 ? percent(time / record.frame_ms) : "")));
  return [
    h("b", {}, record.strategy),
    h("table", {}, ...rows, h("tr", { class: "total" }, h("td", {}, "frame"), h("td", {}, ms(record.frame_ms)), h("td"))),
  ];
}

function stackedBar(record, axis) {
  let start = 0;
  return measured(record).map(([name, time]) => {
    const segment = h("span", {
      class: `segment ${passClass(name)}`,
      style: `left:${at(axis.place(start))};width:${at(axis.place(time))}`,
      "data-pass": name,
    }, h("span", { class: "label" }, name));
    start += time;
    return segment;
  });
}

/** Lengths cannot be added up on a logarithmic axis: a dot per pass, and a line to the frame. */
function dots(record, axis) {
  const passes = measured(record).filter(([, time]) => time > 0);
  const shares = passes.map(([, time]) => axis.place(time));
  const frame = axis.place(record.frame_ms);
  const first = Math.min(...shares, frame);
  return [
    h("span", { class: "span", style: `left:${at(first)};width:${at(frame - first)}` }),
    ...passes.map(([name], ix) =>
      h("span", { class: `point ${passClass(name)}`, style: `left:${at(shares[ix])}`, "data-pass": name })),
    h("span", { class: "frame-mark", style: `left:${at(frame)}` }),
  ];
}

function barRow(record, axis, logarithmic) {
  const shown = isNumber(record.frame_ms) && record.frame_ms > 0;
  const marks = shown ? (logarithmic ? dots : stackedBar)(record, axis) : [];
  const passes = measured(record).map(([name, time]) => `${name} ${ms(time)}`);
  const track = h("div", {
    class: "track",
    role: "img",
    tabindex: "0",
    "aria-label": `${record.strategy}: frame ${ms(record.frame_ms)}; ${passes.join(", ")}`,
  }, ...marks, h("span", { class: "value", style: `left:${shown ? at(axis.place(record.frame_ms)) : "0"}` }, ms(record.frame_ms)));
  let current = null;
  track.addEventListener("pointerover", (event) => { current = event.target.closest("[data-pass]")?.dataset.pass; });
  explain(track, () => breakdown(record, current));
  return [h("div", { class: "name" }, dot(strategyClass(record)), h("span", {}, record.strategy)), track];
}

/** Hides the labels that their segment has no room for. */
function fitLabels(plot) {
  for (const segment of plot.querySelectorAll(".segment")) {
    const label = segment.firstElementChild;
    label.style.visibility = label.offsetWidth + 10 > segment.clientWidth ? "hidden" : "visible";
  }
}

function drawBars(figure, records) {
  const names = passNames(records);
  const frames = records.map((record) => record.frame_ms).filter((time) => isNumber(time) && time > 0);
  let logarithmic = Math.max(...frames) / Math.min(...frames) > LOG_ABOVE;
  const plot = h("div", { class: "plot" });
  const note = h("p", { class: "note" });
  const draw = () => {
    const axis = timeAxis(records, logarithmic);
    const ticks = axis.ticks.map((tick) =>
      h("span", { class: "tick", style: `left:${at(axis.place(tick))}` }, h("span", {}, tickText(tick))));
    plot.classList.toggle("log", logarithmic);
    plot.replaceChildren(
      h("div", { class: "grid", "aria-hidden": "true" }, ...ticks, h("span", { class: "unit" }, "ms")),
      ...records.flatMap((record) => barRow(record, axis, logarithmic)),
    );
    note.textContent = logarithmic
      ? "Each dot is a pass, the bar at the end the whole frame; every step to the right is ten times as long."
      : "Each segment is a pass; a bar is as long as a frame.";
    fitLabels(plot);
  };
  const scales = [{ value: false, text: "Linear" }, { value: true, text: "Logarithmic" }];
  const legend = h("ul", { class: "legend" }, ...names.map((name) => h("li", {}, dot(passClass(name)), name)));
  figure.append(
    h("figcaption", {},
      h("h3", {}, "Where a frame\u2019s time goes"),
      choice("Axis", scales, logarithmic, (value) => { logarithmic = value; draw(); })),
    legend, plot, note);
  draw();
  new ResizeObserver(() => fitLabels(plot)).observe(plot);
}

view.comparisons.forEach((comparison, ix) => {
  const figure = document.querySelector(`[data-comparison="${ix}"] .bars`);
  drawBars(figure, comparison.records.map((record) => results.records[record]));
});
