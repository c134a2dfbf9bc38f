// The page of a study: parallel coordinates with brushes, two columns, a scatter matrix, and each variant's net.

const SVG = "http://www.w3.org/2000/svg";

/** @typedef {number | string | boolean | null} Value */
/** @typedef {{at: (k: number) => number, ticks: [number, string][]}} Scale */
/** @typedef {{counts: number[], families: string, points: string, scale: number, size: number}} Lines */
/** @typedef {Lines & {steps: Int16Array, far: number}} View */

/** @type {{names: string[], columns: Record<string, Value[]>, variables: string[], goals: string[], shown: string[],
 *   best: string[], refused: string[][]}} */
const study = JSON.parse(document.getElementById("data")?.textContent ?? "{}");
const { names, columns, variables, goals, best, refused } = study;
const count = names.length;
const bests = new Set(best);

/** An element that the page has. @template {Element} T @param {string} id @param {new () => T} kind @returns {T} */
function element(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${id}`);
  return found;
}

const byId = (/** @type {string} */ id) => element(id, HTMLElement);
const select = (/** @type {string} */ id) => element(id, HTMLSelectElement);
const drawing = (/** @type {string} */ id) => element(id, SVGSVGElement);

let axes = [...new Set([...variables, ...goals])];
/** @type {Map<string, {scale: Scale, low: number, high: number}>} */
const brushes = new Map();
/** @type {Map<string, {view?: View, waiting: ((view: View) => void)[]}>} */
const views = new Map();
let chosen = -1;
let shown = 24;

/** @param {Value} value */
const text = (value) =>
  value === null ? "" : typeof value === "number" ? Number(value.toPrecision(5)).toString() : String(value);

/** Values of a column as positions 0 to 1: numbers by size, words by their order.
 * @param {string} name @returns {Scale} */
function scaleOf(name) {
  const values = columns[name];
  const present = values.filter((value) => value !== null);
  const numbers = present.filter((value) => typeof value === "number");
  if (numbers.length === present.length) {
    const low = numbers.reduce((a, b) => Math.min(a, b), Infinity);
    const high = numbers.reduce((a, b) => Math.max(a, b), -Infinity);
    const width = high - low || 1;
    return {
      at: (k) => (values[k] === null ? NaN : high === low ? 0.5 : (Number(values[k]) - low) / width),
      ticks: high === low ? [[0.5, text(low)]] : [0, 0.25, 0.5, 0.75, 1].map((s) => [s, text(low + s * width)]),
    };
  }
  const words = [...new Set(present.map(String))].sort();
  const place = (/** @type {Value} */ value) => (words.length > 1 ? words.indexOf(String(value)) / (words.length - 1) : 0.5);
  return {
    at: (k) => (values[k] === null ? NaN : place(values[k])),
    ticks: words.slice(0, 12).map((word) => [place(word), word]),
  };
}

/** @param {Element} parent @param {string} kind @param {Record<string, string | number>} attributes
 * @returns {SVGElement} */
function add(parent, kind, attributes = {}, content = "") {
  const made = /** @type {SVGElement} */ (document.createElementNS(SVG, kind));
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  if (content) made.textContent = content;
  parent.append(made);
  return made;
}

/** @param {string} name @param {number} most */
const short = (name, most) => (name.length > most ? `…${name.slice(1 - most)}` : name);

/** Whether a variant is within all ranges that are kept. @param {number} k */
function isIn(k) {
  for (const [name, { scale, low, high }] of brushes) {
    if (!axes.includes(name)) continue;
    const at = scale.at(k);
    if (!(at >= low && at <= high)) return false;
  }
  return true;
}

/** @param {Element} mark @param {number} k */
function markUp(mark, k) {
  mark.classList.toggle("best", bests.has(names[k]));
  mark.classList.toggle("out", !isIn(k));
  mark.classList.toggle("chosen", k === chosen);
}

function drawParallel() {
  const svg = drawing("parallel");
  svg.replaceChildren();
  const gap = Math.max(130, Math.min(300, 1000 / Math.max(1, axes.length - 1))), height = 300, top = 36, left = 90;
  const width = Math.max(left + gap * (axes.length - 1) + 110, 600);
  svg.setAttribute("width", String(width));
  svg.setAttribute("height", String(height + top + 20));
  const scales = axes.map(scaleOf);
  const y = (/** @type {number} */ share) => top + (1 - share) * height;
  const lines = add(svg, "g");
  for (let k = 0; k < count; k++) {
    const places = scales.map((scale) => scale.at(k));
    const parts = places.flatMap((at, a) => (Number.isNaN(at) ? [] : [`${left + a * gap} ${y(at).toFixed(1)}`]));
    if (!parts.length) continue;
    const line = add(lines, "path", { class: "v", d: `M${parts.join("L")}`, "data-k": k });
    markUp(line, k);
    line.addEventListener("click", () => choose(k));
  }
  axes.forEach((name, a) => {
    const x = left + a * gap, scale = scales[a];
    add(svg, "line", { class: "axis", x1: x, x2: x, y1: top, y2: top + height });
    const label = add(svg, "text", { x, y: top - 14, "text-anchor": "middle" }, short(name, 24));
    add(label, "title", {}, name);
    for (const [at, word] of scale.ticks) add(svg, "text", { class: "soft", x: x + 5, y: y(at) + 4 }, word);
    const brush = add(svg, "rect", { class: "brush", x: x - 9, width: 18, height: 0 });
    const grab = add(svg, "rect", { class: "grab", x: x - 12, y: top - 6, width: 24, height: height + 12 });
    const kept = brushes.get(name);
    if (kept) {
      brush.setAttribute("y", String(y(kept.high)));
      brush.setAttribute("height", String((kept.high - kept.low) * height));
    }
    const share = (/** @type {PointerEvent} */ event) => 1 - (event.clientY - svg.getBoundingClientRect().top - top) / height;
    grab.addEventListener("pointerdown", (event) => {
      const from = share(event);
      grab.setPointerCapture(event.pointerId);
      const move = (/** @type {PointerEvent} */ moved) => {
        const to = share(moved);
        const low = Math.max(Math.min(from, to), -0.02), high = Math.min(Math.max(from, to), 1.02);
        brushes.set(name, { scale, low, high });
        brush.setAttribute("y", String(y(high)));
        brush.setAttribute("height", String(Math.max(0, (high - low) * height)));
        refresh();
      };
      grab.addEventListener("pointermove", move);
      grab.addEventListener("pointerup", () => grab.removeEventListener("pointermove", move), { once: true });
    });
    grab.addEventListener("dblclick", () => {
      brushes.delete(name);
      brush.setAttribute("height", "0");
      refresh();
    });
  });
}

/** @param {Element} svg @param {string} xName @param {string} yName @param {number} x0 @param {number} y0
 * @param {number} size @param {boolean} detailed */
function plot(svg, xName, yName, x0, y0, size, detailed) {
  const xs = scaleOf(xName), ys = scaleOf(yName);
  if (detailed) {
    for (const [at, word] of xs.ticks)
      add(svg, "text", { class: "soft", x: x0 + at * size, y: y0 + size + 22, "text-anchor": "middle" }, word);
    for (const [at, word] of ys.ticks)
      add(svg, "text", { class: "soft", x: x0 - 12, y: y0 + (1 - at) * size + 4, "text-anchor": "end" }, word);
  }
  for (let k = 0; k < count; k++) {
    const x = xs.at(k), y = ys.at(k);
    if (Number.isNaN(x) || Number.isNaN(y)) continue;
    const dot = add(svg, "circle", { cx: x0 + x * size, cy: y0 + (1 - y) * size, r: detailed ? 4 : 2.2, "data-k": k });
    markUp(dot, k);
    if (detailed) add(dot, "title", {}, `${names[k]}: ${text(columns[xName][k])}, ${text(columns[yName][k])}`);
    dot.addEventListener("click", () => choose(k));
  }
}

function drawScatter() {
  const svg = drawing("scatter"), size = 360;
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${size + 110} ${size + 60}`);
  add(svg, "rect", { x: 80, y: 16, width: size, height: size, fill: "none", class: "axis" });
  plot(svg, select("x").value, select("y").value, 80, 16, size, true);
}

function drawMatrix() {
  const svg = drawing("matrix"), shownAxes = axes.slice(0, 8), cell = 104, left = 20;
  svg.replaceChildren();
  const whole = String(left + shownAxes.length * (cell + 10) + 10);
  svg.setAttribute("width", whole);
  svg.setAttribute("height", whole);
  shownAxes.forEach((yName, row) =>
    shownAxes.forEach((xName, column) => {
      const x = left + column * (cell + 10), y = left + row * (cell + 10);
      add(svg, "rect", { x, y, width: cell, height: cell, fill: "none", class: "axis", opacity: 0.4 });
      if (row === column) {
        const label = add(svg, "text", { x: x + cell / 2, y: y + cell / 2, "text-anchor": "middle" }, short(xName, 17));
        add(label, "title", {}, xName);
      } else plot(svg, xName, yName, x + 6, y + 6, cell - 12, false);
    }),
  );
}

function refresh() {
  for (const mark of document.querySelectorAll("[data-k]")) markUp(mark, Number(mark.getAttribute("data-k")));
  byId("counts").textContent = countsLine();
  drawGallery();
}

function countsLine() {
  const inside = [...Array(count).keys()].filter(isIn).length;
  const parts = [`${count} variants computed`];
  if (refused.length) parts.push(`${refused.length} refused`);
  if (best.length) parts.push(`${best.length} best`);
  if (brushes.size) parts.push(`${inside} within the ranges kept`);
  return parts.join(", ");
}

// ---- nets: scripts of their own beside the page, loaded when they are looked at

/** @param {string} name @param {Lines} lines */
function received(name, lines) {
  const bytes = Uint8Array.from(atob(lines.points), (letter) => letter.charCodeAt(0));
  const steps = new Int16Array(bytes.buffer);
  let far = 1;
  for (let at = 0; at < steps.length; at += 3) far = Math.max(far, Math.hypot(steps[at], steps[at + 1], steps[at + 2]));
  const view = { ...lines, steps, far };
  const waiting = views.get(name)?.waiting ?? [];
  views.set(name, { view, waiting: [] });
  for (const draw of waiting) draw(view);
}
Object.assign(globalThis, { lamellaVariant: received });

/** @param {string} name @param {(view: View) => void} draw */
function withView(name, draw) {
  const known = views.get(name);
  if (known?.view) draw(known.view);
  else if (known) known.waiting.push(draw);
  else {
    views.set(name, { waiting: [draw] });
    const script = document.createElement("script");
    script.src = `variants/${name}/view.js`;
    document.head.append(script);
  }
}

/** @param {HTMLCanvasElement} canvas @param {View} view @param {number} turn @param {number} tilt */
function paint(canvas, view, turn, tilt) {
  const ratio = window.devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
  canvas.width = wide * ratio;
  canvas.height = high * ratio;
  const pen = canvas.getContext("2d");
  if (!pen) return;
  pen.scale(ratio, ratio);
  pen.lineWidth = wide > 250 ? 1.2 : 0.6;
  const style = getComputedStyle(document.documentElement);
  const soft = style.getPropertyValue("--soft");
  const colours = new Map([["A", style.getPropertyValue("--a")], ["B", style.getPropertyValue("--b")]]);
  const [ct, st, cp, sp] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  const scale = (0.48 * Math.min(wide, high)) / view.far;
  let at = 0;
  view.counts.forEach((length, k) => {
    pen.strokeStyle = colours.get(view.families[k]) ?? soft;
    pen.beginPath();
    for (let p = 0; p < length; p++, at += 3) {
      const [x, y, z] = [view.steps[at], view.steps[at + 1], view.steps[at + 2]];
      const across = ct * x + st * y, deep = -st * x + ct * y;
      pen.lineTo(wide / 2 + scale * across, high / 2 - scale * (cp * z + sp * deep));
    }
    pen.stroke();
  });
}

const START = [-0.6, 0.5];
let [turned, tilted] = START;
const canvas = element("view", HTMLCanvasElement);
const drawChosen = () => {
  if (chosen >= 0) withView(names[chosen], (view) => paint(canvas, view, turned, tilted));
};

canvas.addEventListener("pointerdown", (event) => {
  const [x, y, turn, tilt] = [event.clientX, event.clientY, turned, tilted];
  canvas.setPointerCapture(event.pointerId);
  const move = (/** @type {PointerEvent} */ moved) => {
    turned = turn + (moved.clientX - x) / 120;
    tilted = Math.max(-1.57, Math.min(1.57, tilt + (moved.clientY - y) / 120));
    drawChosen();
  };
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", () => canvas.removeEventListener("pointermove", move), { once: true });
});

/** @param {number} k */
function choose(k) {
  chosen = k;
  const name = names[k];
  byId("chosen-name").textContent = `Variant ${name}${bests.has(name) ? " (best)" : ""}`;
  const links = ["project.toml", "summary.json"].map((file) => {
    const link = document.createElement("a");
    link.href = `variants/${name}/${file}`;
    link.textContent = file;
    return link;
  });
  byId("links").replaceChildren(...links.flatMap((link) => [link, " "]), `run it: lamella run variants/${name}/project.toml`);
  const rows = [...new Set([...axes, ...study.shown])].map((column) => {
    const row = document.createElement("tr");
    const [head, cell] = [document.createElement("th"), document.createElement("td")];
    head.textContent = column;
    cell.textContent = text(columns[column][k]);
    cell.className = "n";
    row.append(head, cell);
    return row;
  });
  byId("values").replaceChildren(...rows);
  refresh();
  drawChosen();
}

const seen = new window.IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    const small = entry.target;
    seen.unobserve(small);
    if (small instanceof HTMLCanvasElement)
      withView(small.dataset.name ?? "", (view) => paint(small, view, START[0], START[1]));
  }
});

let galleryKey = "";
function drawGallery() {
  const inside = [...Array(count).keys()].filter(isIn);
  const sorted = [...inside.filter((k) => bests.has(names[k])), ...inside.filter((k) => !bests.has(names[k]))];
  const key = `${shown}:${sorted.slice(0, shown).join()}`;
  if (key !== galleryKey) {
    galleryKey = key;
    const cards = sorted.slice(0, shown).map((k) => {
      const card = document.createElement("button"), small = document.createElement("canvas");
      const label = document.createElement("span");
      card.type = "button";
      small.dataset.name = names[k];
      label.textContent = `${names[k]}${bests.has(names[k]) ? " best" : ""}`;
      label.className = bests.has(names[k]) ? "best" : "";
      card.append(small, label);
      card.dataset.k = String(k);
      card.addEventListener("click", () => choose(k));
      seen.observe(small);
      return card;
    });
    byId("gallery").replaceChildren(...cards);
  }
  byId("show-more").hidden = sorted.length <= shown;
}

// ---- begin

const numeric = Object.keys(columns);
for (const id of ["x", "y", "more"]) {
  for (const name of numeric) select(id).append(new window.Option(name, name));
}
select("more").prepend(new window.Option("choose a column", "", true, true));
select("x").value = goals.length > 1 ? goals[0] : variables[0];
select("y").value = goals.length > 1 ? goals[1] : (goals[0] ?? variables[1] ?? study.shown[0] ?? variables[0]);
select("x").addEventListener("change", drawScatter);
select("y").addEventListener("change", drawScatter);
select("more").addEventListener("change", () => {
  const wanted = select("more").value;
  if (wanted && !axes.includes(wanted)) axes = [...axes, wanted];
  drawParallel();
  drawMatrix();
});
byId("show-more").addEventListener("click", () => {
  shown += 48;
  drawGallery();
});
byId("refused-section").hidden = !refused.length;
byId("refused").replaceChildren(
  ...refused.map(([name, values, reason]) => {
    const row = document.createElement("tr");
    for (const content of [name, values, reason]) {
      const cell = document.createElement("td");
      cell.textContent = content;
      row.append(cell);
    }
    return row;
  }),
);
drawParallel();
drawScatter();
drawMatrix();
refresh();
if (count) choose(Math.max(0, names.indexOf(best[0] ?? names[0])));
addEventListener("resize", drawChosen);
