/** What the charts' tips say, line by line. */
function tipLines(text) {
  return text.split("\n").map((line, ix) => h(ix === 0 ? "b" : "div", {}, line));
}

for (const mark of document.querySelectorAll(".chart [data-tip]")) {
  explain(mark, () => tipLines(mark.dataset.tip));
}

/** Buttons that choose between panels. */
for (const panels of document.querySelectorAll(".panels")) {
  const buttons = [...panels.querySelectorAll(":scope > .choice > button")];
  const bodies = [...panels.querySelectorAll(":scope > [data-panel]")];
  for (const button of buttons) {
    button.addEventListener("click", () => {
      for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
      for (const body of bodies) body.hidden = body.dataset.panel !== button.dataset.choose;
    });
  }
}

for (const image of document.querySelectorAll("img[data-picture]")) {
  image.src = uri(image.dataset.picture) || "";
}

/** A shot beside what it should look like, and how far it is from it. */
function openShot(viewer, key) {
  const shot = view.shots[key];
  if (!shot) return;
  const reference = uri(shot.images.baseline);
  const own = uri(shot.images.image);
  const errors = Object.entries(shot.errors).filter(([, error]) => isNumber(error));
  const knob = isNumber(shot.threshold) ? `, threshold ${shot.threshold}` : "";
  const figures = h("ul", { class: "legend" },
    h("li", {}, ms(shot.both_ms)),
    ...errors.map(([id, error]) => h("li", {}, `${id.replaceAll("_", " ")} ${error === 0 ? "0" : error.toPrecision(2)}`)));
  const main = own && reference ? slider(shot, reference) : still(shot);
  const tag = main.querySelector(".tag.left");
  if (tag) tag.textContent = shot.reference;
  const difference = uri(shot.images.difference) ? differenceFigure(shot) : null;
  viewer.replaceChildren(
    h("div", { class: "figcaption" }, h("b", {}, `${shot.strategy}${knob}`),
      h("button", { type: "button", class: "quiet", onclick: () => { viewer.hidden = true; } }, "Close")),
    figures,
    h("div", { class: "stage" },
      h("figure", { class: "main" }, main,
        h("figcaption", {}, reference ? `Drag the line, or use the arrow keys: ${shot.reference} on its left.` : "")),
      difference));
  viewer.dataset.key = key;
  viewer.hidden = false;
}

for (const plot of document.querySelectorAll(".plot-of-errors")) {
  const viewer = plot.querySelector(".viewer");
  if (!viewer) continue;
  const open = (mark) => {
    openShot(viewer, mark.dataset.key);
    for (const other of plot.querySelectorAll("[data-key]")) {
      other.classList.toggle("current", other.dataset.key === mark.dataset.key && other !== viewer);
    }
    viewer.scrollIntoView({ block: "nearest" });
  };
  for (const mark of plot.querySelectorAll(".chart [data-key]")) {
    mark.addEventListener("click", () => open(mark));
    mark.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      open(mark);
    });
  }
}
