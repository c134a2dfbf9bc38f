// Texts over the view: labels, and what is measured.

import { element, svg } from "./dom.js";
import { format } from "./text.js";

const LABEL_LIMIT = 300;

/** Labels at points, those that would lie over another left out. */
export class Overlay {
  /** @param {HTMLElement} container */
  constructor(container) {
    this.root = element("div", { class: "overlay", "aria-hidden": "true" });
    this.lines = svg("svg", { class: "measure" });
    this.root.append(this.lines);
    container.append(this.root);
    /** @type {Map<string, { labels: any, shown: boolean }>} */
    this.labels = new Map();
    /** Two ends of what is measured. @type {number[][]} */
    this.ends = [];
  }

  /** @param {any[]} labels */
  setLabels(labels) {
    this.labels = new Map(labels.map((one) => [one.name, { labels: one, shown: one.visible }]));
  }

  /**
   * @param {(points: ArrayLike<number>, i: number) => number[]} onScreen
   * @param {(point: any) => boolean} isSeen
   * @param {number} width
   * @param {number} height
   */
  draw(onScreen, isSeen, width, height) {
    const made = [];
    const taken = new Set();
    for (const { labels, shown } of this.labels.values()) {
      if (!shown) continue;
      for (let i = 0; i < labels.texts.length && made.length < LABEL_LIMIT; i++) {
        const [x, y, z] = onScreen(labels.positions, i);
        if (Math.abs(z) >= 1 || x < 0 || y < 0 || x > width || y > height) continue;
        if (!isSeen(new THREE.Vector3().fromArray(labels.positions, 3 * i))) continue;
        const cell = `${Math.round(x / (10 + 7 * labels.texts[i].length))},${Math.round(y / 18)}`;
        if (taken.has(cell)) continue;
        taken.add(cell);
        made.push(placed(element("span", { class: "label" }, labels.texts[i]), x, y));
      }
    }
    made.push(...this.measured(onScreen));
    this.root.replaceChildren(this.lines, ...made);
  }

  /** @param {(points: ArrayLike<number>, i: number) => number[]} onScreen */
  measured(onScreen) {
    const places = this.ends.map((end) => onScreen(end, 0));
    const dots = places.map(([x, y]) => svg("circle", { cx: x, cy: y, r: 4 }));
    if (places.length < 2) {
      this.lines.replaceChildren(...dots);
      return [];
    }
    const [[ax, ay], [bx, by]] = places;
    this.lines.replaceChildren(svg("line", { x1: ax, y1: ay, x2: bx, y2: by }), ...dots);
    return [
      placed(element("span", { class: "label measured" }, this.distance()), (ax + bx) / 2, (ay + by) / 2),
    ];
  }

  /** "2.315 m (x 1.200, y 1.980, z 0.011)" */
  distance() {
    const [a, b] = this.ends;
    const by = a.map((value, k) => Math.abs(b[k] - value));
    const names = ["x", "y", "z"].map((name, k) => `${name} ${format(by[k], 4)}`).join(", ");
    return `${format(Math.hypot(...by), 4)} m (${names})`;
  }

  dispose() {
    this.root.remove();
  }
}

/**
 * @param {any} label
 * @param {number} x
 * @param {number} y
 */
function placed(label, x, y) {
  label.style.left = `${x}px`;
  label.style.top = `${y}px`;
  return label;
}
