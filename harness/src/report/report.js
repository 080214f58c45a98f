const view = JSON.parse(document.getElementById("view").textContent);

/** Gives pictures their sources: each is stored once, however often it is shown. */
function showPictures(root) {
  for (const image of root.querySelectorAll("img[data-picture]")) {
    image.src = view.uris[view.pictures[image.dataset.picture]] || "";
  }
}

/** Buttons that choose between the panels around them. */
function makeChoosable(panels) {
  const buttons = [...panels.querySelectorAll("[data-choose]")].filter((button) => button.closest(".panels") === panels);
  const bodies = panels.querySelectorAll(":scope > [data-panel]");
  for (const button of buttons) {
    button.addEventListener("click", () => {
      for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
      for (const body of bodies) body.hidden = body.dataset.panel !== button.dataset.choose;
    });
  }
}

function makeSortable(table) {
  const body = table.tBodies[0];
  const original = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  const key = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.value === undefined) return cell.textContent;
    return cell.dataset.value === "" ? null : Number(cell.dataset.value);
  };
  const compare = (a, b) => {
    if (a === null || b === null) return (a === null) - (b === null);
    return typeof a === "string" ? a.localeCompare(b, "en", { numeric: true }) : a - b;
  };
  heads.forEach((head, column) => {
    head.querySelector("button").addEventListener("click", () => {
      const next = { ascending: "descending", descending: null }[head.getAttribute("aria-sort")];
      const order = next === undefined ? "ascending" : next;
      for (const other of heads) other.removeAttribute("aria-sort");
      let rows = original;
      if (order) {
        head.setAttribute("aria-sort", order);
        const sign = order === "ascending" ? 1 : -1;
        rows = [...original].sort((a, b) => {
          const [x, y] = [key(a, column), key(b, column)];
          // What was not measured stays last in both orders.
          return compare(x, y) * (x === null || y === null ? 1 : sign);
        });
      }
      body.append(...rows);
    });
  });
}

/** Opens the viewer of a chart's point: a shot beside what it should look like. */
function makeOpenable(plot) {
  const viewer = plot.querySelector(".viewer");
  if (!viewer) return;
  const open = (mark) => {
    const shot = document.querySelector(`template[data-shot="${CSS.escape(mark.dataset.key)}"]`);
    if (!shot) return;
    viewer.replaceChildren(shot.content.cloneNode(true));
    showPictures(viewer);
    makeExplainable(viewer);
    viewer.querySelector("button").addEventListener("click", () => { viewer.hidden = true; });
    viewer.dataset.key = mark.dataset.key;
    viewer.hidden = false;
    for (const other of plot.querySelectorAll(".chart [data-key]")) {
      other.classList.toggle("current", other.dataset.key === mark.dataset.key);
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

/** Shows the command that explains the pixel under the pointer. The last one stays, to be selected. */
function makeExplainable(root) {
  for (const picture of root.querySelectorAll("[data-explain]")) {
    const line = picture.closest(".stage")?.querySelector(".pixel");
    if (!line) continue;
    const sides = picture.dataset.size.split("x").map(Number);
    const show = (event) => {
      const box = picture.getBoundingClientRect();
      const shares = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
      const pixel = shares.map((share, axis) => Math.max(0, Math.min(sides[axis] - 1, Math.floor(share * sides[axis]))));
      line.textContent = `${picture.dataset.explain} ${pixel.join(",")}`;
      line.classList.add("known");
    };
    for (const kind of ["pointermove", "pointerdown"]) picture.addEventListener(kind, show);
  }
}

function themeSwitch() {
  const button = document.getElementById("theme");
  const modes = [["", "system setting"], ["light", "light"], ["dark", "dark"]];
  let ix = 0;
  try {
    ix = Math.max(0, modes.findIndex(([mode]) => mode === (localStorage.getItem("lightbench-theme") || "")));
  } catch { /* no storage for files */ }
  if (location.hash === "#dark") ix = 2;
  if (location.hash === "#light") ix = 1;
  const apply = () => {
    document.documentElement.style.colorScheme = modes[ix][0] || "light dark";
    button.textContent = `Colours: ${modes[ix][1]}`;
  };
  button.addEventListener("click", () => {
    ix = (ix + 1) % modes.length;
    apply();
    try { localStorage.setItem("lightbench-theme", modes[ix][0]); } catch { /* no storage for files */ }
  });
  apply();
}

function actions() {
  const data = document.getElementById("data").textContent;
  // Data too large for the page lie beside it, where the link leads already.
  if (data !== "null") {
    const file = new Blob([data, "\n"], { type: "application/json" });
    document.getElementById("download").href = URL.createObjectURL(file);
  }
  const copy = document.getElementById("copy");
  if (!navigator.clipboard) {
    copy.hidden = true;
    return;
  }
  copy.addEventListener("click", () => {
    navigator.clipboard.writeText(document.querySelector(".command").textContent).then(
      () => { copy.textContent = "Copied"; },
      () => { copy.textContent = "Select it above and copy"; },
    );
  });
}

/** Opens what a link leads to, if it can be folded. */
function openTarget() {
  const target = document.getElementById(location.hash.slice(1));
  if (target instanceof HTMLDetailsElement) target.open = true;
}

themeSwitch();
openTarget();
window.addEventListener("hashchange", openTarget);
actions();
showPictures(document);
makeExplainable(document);
document.querySelectorAll("table.results").forEach(makeSortable);
document.querySelectorAll(".panels").forEach(makeChoosable);
document.querySelectorAll(".plot-of-errors").forEach(makeOpenable);
