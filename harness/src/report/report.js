const results = JSON.parse(document.getElementById("data").textContent);
const view = JSON.parse(document.getElementById("view").textContent);

/** An element with properties (class, data-*, aria-*, on*) and children (nodes or text). */
function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  setProperties(element, properties);
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** As `h`, for SVG. */
function s(tag, properties = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  setProperties(element, properties);
  element.append(...children);
  return element;
}

function setProperties(element, properties) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value);
  }
}

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** Three significant digits, thousands separated, as in the tables. */
function significant(value) {
  if (!isNumber(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-5) return value.toExponential(1);
  const rounded = Number(value.toPrecision(3));
  const decimals = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(rounded))));
  const options = { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
  return rounded.toLocaleString("en-US", options);
}

const count = (value) => (isNumber(value) ? value.toLocaleString("en-US") : "\u2013");
const ms = (value) => (isNumber(value) ? `${significant(value)} ms` : "not measured");
const percent = (share, digits = 0) => `${(share * 100).toFixed(digits)} %`;

const strategyClass = (record) => view.strategies[record.strategy] || "strategy-none";
const passClass = (name) => view.passes[name] || "pass-other-0";
const dot = (className) => h("i", { class: `dot ${className}`, "aria-hidden": "true" });
const uri = (name) => (name && name in view.pictures ? view.uris[view.pictures[name]] : null);

/** A group of buttons of which one is pressed; `choose` hears its value. */
function choice(label, options, chosen, choose) {
  const buttons = options.map(({ value, text, mark }) =>
    h("button", {
      type: "button",
      "aria-pressed": String(value === chosen),
      onclick: (event) => {
        for (const button of buttons) button.setAttribute("aria-pressed", String(button === event.currentTarget));
        choose(value);
      },
    }, mark ? dot(mark) : null, text));
  return h("div", { class: "choice", role: "group", "aria-label": label }, ...buttons);
}

const tip = document.getElementById("tip");

/** Shows what `content` returns beside the pointer, or below the element that has the focus. */
function explain(element, content) {
  const show = (x, y) => {
    tip.replaceChildren(...content());
    tip.hidden = false;
    const box = tip.getBoundingClientRect();
    const left = Math.max(8, Math.min(x + 14, innerWidth - box.width - 8));
    const top = y + 18 + box.height > innerHeight ? y - box.height - 12 : y + 18;
    tip.style.transform = `translate(${left}px, ${Math.max(8, top)}px)`;
  };
  const hide = () => { tip.hidden = true; };
  element.addEventListener("pointermove", (event) => show(event.clientX, event.clientY));
  element.addEventListener("pointerleave", hide);
  element.addEventListener("focus", () => {
    if (!element.matches(":focus-visible")) return;
    const box = element.getBoundingClientRect();
    show(box.left, box.bottom - 12);
  });
  element.addEventListener("blur", hide);
  element.addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
}

function makeSortable(table) {
  const body = table.tBodies[0];
  const original = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  const key = (row, column) => {
    const cell = row.cells[column];
    if (column === 0) return cell.textContent;
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
          // What was not measured stays last, whichever the order.
          return compare(x, y) * (x === null || y === null ? 1 : sign);
        });
      }
      body.append(...rows);
    });
  });
}

function themeSwitch() {
  const button = document.getElementById("theme");
  const modes = [["", "as the system"], ["light", "light"], ["dark", "dark"]];
  let ix = 0;
  try {
    ix = Math.max(0, modes.findIndex(([mode]) => mode === (localStorage.getItem("lightbench-theme") || "")));
  } catch { /* no storage for files */ }
  if (location.hash === "#dark") ix = 2;
  if (location.hash === "#light") ix = 1;
  const apply = () => {
    document.documentElement.style.colorScheme = modes[ix][0] || "light dark";
    button.textContent = `Theme: ${modes[ix][1]}`;
  };
  button.addEventListener("click", () => {
    ix = (ix + 1) % modes.length;
    apply();
    try { localStorage.setItem("lightbench-theme", modes[ix][0]); } catch { /* no storage for files */ }
  });
  apply();
}

function actions() {
  // Data too large for the page lies beside it, where the link leads already.
  if (results) {
    const file = new Blob([JSON.stringify(results, null, 2), "\n"], { type: "application/json" });
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

themeSwitch();
actions();
document.querySelectorAll("table.results").forEach(makeSortable);
