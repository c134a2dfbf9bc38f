"use strict";
// The page of a study: parallel coordinates with brushes, two columns, a scatter matrix, and each variant's net.

const SVG = "http://www.w3.org/2000/svg";
const study = JSON.parse(document.getElementById("data").textContent);
const { names, columns, variables, goals, best, refused } = study;
const count = names.length;
const bests = new Set(best);
const byId = (id) => document.getElementById(id);

let axes = [...new Set([...variables, ...goals])];
const brushes = new Map();
const views = new Map();
let chosen = -1;
let shown = 24;

const text = (value) =>
  value === null ? "" : typeof value === "number" ? Number(value.toPrecision(5)).toString() : String(value);

/** Values of a column as positions 0 to 1: numbers by size, words by their order. */
function scaleOf(name) {
  const values = columns[name];
  const present = values.filter((value) => value !== null);
  if (present.every((value) => typeof value === "number")) {
    const low = Math.min(...present), high = Math.max(...present);
    const width = high - low || 1;
    return {
      at: (k) => (values[k] === null ? NaN : high === low ? 0.5 : (values[k] - low) / width),
      ticks: high === low ? [[0.5, text(low)]] : [0, 0.25, 0.5, 0.75, 1].map((s) => [s, text(low + s * width)]),
    };
  }
  const words = [...new Set(present.map(String))].sort();
  const place = (value) => (words.length > 1 ? words.indexOf(String(value)) / (words.length - 1) : 0.5);
  return {
    at: (k) => (values[k] === null ? NaN : place(values[k])),
    ticks: words.slice(0, 12).map((word) => [place(word), word]),
  };
}

function add(parent, kind, attributes = {}, content = "") {
  const element = document.createElementNS(SVG, kind);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (content) element.textContent = content;
  parent.append(element);
  return element;
}

const short = (name, most) => (name.length > most ? "…" + name.slice(1 - most) : name);

function isIn(k) {
  for (const [name, { scale, low, high }] of brushes) {
    if (!axes.includes(name)) continue;
    const at = scale.at(k);
    if (!(at >= low && at <= high)) return false;
  }
  return true;
}

function markUp(element, k) {
  element.classList.toggle("best", bests.has(names[k]));
  element.classList.toggle("out", !isIn(k));
  element.classList.toggle("chosen", k === chosen);
}

function drawParallel() {
  const svg = byId("parallel");
  svg.replaceChildren();
  const gap = Math.max(130, Math.min(300, 1000 / Math.max(1, axes.length - 1))), height = 300, top = 36, left = 60;
  const width = Math.max(left + gap * (axes.length - 1) + 110, 600);
  svg.setAttribute("width", width);
  svg.setAttribute("height", height + top + 20);
  const scales = axes.map(scaleOf);
  const y = (share) => top + (1 - share) * height;
  const lines = add(svg, "g");
  for (let k = 0; k < count; k++) {
    const parts = scales.map((scale, a) => [left + a * gap, scale.at(k)]).filter(([, at]) => !Number.isNaN(at));
    if (parts.length < 1) continue;
    const line = add(lines, "path", {
      class: "v",
      d: parts.map(([x, at], p) => `${p ? "L" : "M"}${x} ${y(at).toFixed(1)}`).join(""),
      "data-k": k,
    });
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
      brush.setAttribute("y", y(kept.high));
      brush.setAttribute("height", (kept.high - kept.low) * height);
    }
    const share = (event) => 1 - (event.clientY - svg.getBoundingClientRect().top - top) / height;
    grab.addEventListener("pointerdown", (event) => {
      const from = share(event);
      grab.setPointerCapture(event.pointerId);
      const move = (moved) => {
        const to = share(moved);
        const low = Math.max(Math.min(from, to), -0.02), high = Math.min(Math.max(from, to), 1.02);
        brushes.set(name, { scale, low, high });
        brush.setAttribute("y", y(high));
        brush.setAttribute("height", Math.max(0, (high - low) * height));
        refresh();
      };
      grab.addEventListener("pointermove", move);
      grab.addEventListener("pointerup", () => grab.removeEventListener("pointermove", move), { once: true });
    });
    grab.addEventListener("dblclick", () => {
      brushes.delete(name);
      brush.setAttribute("height", 0);
      refresh();
    });
  });
}

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
  const svg = byId("scatter"), size = 360;
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${size + 110} ${size + 60}`);
  add(svg, "rect", { x: 80, y: 16, width: size, height: size, fill: "none", class: "axis" });
  plot(svg, byId("x").value, byId("y").value, 80, 16, size, true);
}

function drawMatrix() {
  const svg = byId("matrix"), shownAxes = axes.slice(0, 8), cell = 104, left = 20;
  svg.replaceChildren();
  svg.setAttribute("width", left + shownAxes.length * (cell + 10) + 10);
  svg.setAttribute("height", left + shownAxes.length * (cell + 10) + 10);
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
  for (const element of document.querySelectorAll("[data-k]")) markUp(element, Number(element.dataset.k));
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

globalThis.lamellaVariant = (name, view) => {
  const bytes = Uint8Array.from(atob(view.points), (letter) => letter.charCodeAt(0));
  const steps = new Int16Array(bytes.buffer);
  const waiting = views.get(name)?.waiting ?? [];
  let far = 1;
  for (let at = 0; at < steps.length; at += 3) far = Math.max(far, Math.hypot(steps[at], steps[at + 1], steps[at + 2]));
  views.set(name, { ...view, steps, far });
  for (const draw of waiting) draw(views.get(name));
};

function withView(name, draw) {
  const known = views.get(name);
  if (known?.steps) draw(known);
  else if (known) known.waiting.push(draw);
  else {
    views.set(name, { waiting: [draw] });
    const script = document.createElement("script");
    script.src = `variants/${name}/view.js`;
    document.head.append(script);
  }
}

function paint(canvas, view, turn, tilt) {
  const ratio = devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
  canvas.width = wide * ratio;
  canvas.height = high * ratio;
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.lineWidth = wide > 250 ? 1.2 : 0.6;
  const style = getComputedStyle(document.documentElement);
  const colours = { A: style.getPropertyValue("--a"), B: style.getPropertyValue("--b"), S: style.getPropertyValue("--soft") };
  const [ct, st, cp, sp] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  const scale = (0.48 * Math.min(wide, high)) / view.far;
  let at = 0;
  view.counts.forEach((length, k) => {
    pen.strokeStyle = colours[view.families[k]] || colours.S;
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
let pose = [...START];
const drawChosen = () => chosen >= 0 && withView(names[chosen], (view) => paint(byId("view"), view, ...pose));

byId("view").addEventListener("pointerdown", (event) => {
  const canvas = byId("view"), [x, y] = [event.clientX, event.clientY], [turn, tilt] = pose;
  canvas.setPointerCapture(event.pointerId);
  const move = (moved) => {
    pose = [turn + (moved.clientX - x) / 120, Math.max(-1.57, Math.min(1.57, tilt + (moved.clientY - y) / 120))];
    drawChosen();
  };
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", () => canvas.removeEventListener("pointermove", move), { once: true });
});

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

const seen = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    seen.unobserve(entry.target);
    withView(entry.target.dataset.name, (view) => paint(entry.target, view, ...START));
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
      const card = document.createElement("button"), canvas = document.createElement("canvas");
      const label = document.createElement("span");
      card.type = "button";
      canvas.dataset.name = names[k];
      label.textContent = `${names[k]}${bests.has(names[k]) ? " best" : ""}`;
      label.className = bests.has(names[k]) ? "best" : "";
      card.append(canvas, label);
      card.dataset.k = k;
      card.addEventListener("click", () => choose(k));
      seen.observe(canvas);
      return card;
    });
    byId("gallery").replaceChildren(...cards);
  }
  for (const card of byId("gallery").children) card.classList.toggle("chosen", Number(card.dataset.k) === chosen);
  byId("show-more").hidden = sorted.length <= shown;
}

// ---- begin

const numeric = Object.keys(columns);
for (const id of ["x", "y", "more"]) {
  for (const name of numeric) byId(id).append(new Option(name, name));
}
byId("more").prepend(new Option("choose a column", "", true, true));
byId("x").value = goals.length > 1 ? goals[0] : variables[0];
byId("y").value = goals.length > 1 ? goals[1] : (goals[0] ?? variables[1] ?? study.shown[0] ?? variables[0]);
byId("x").addEventListener("change", drawScatter);
byId("y").addEventListener("change", drawScatter);
byId("more").addEventListener("change", () => {
  if (byId("more").value && !axes.includes(byId("more").value)) axes = [...axes, byId("more").value];
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
