// What colours mean.

import { element } from "./dom.js";
import { extent, format, niceTicks } from "./text.js";

/**
 * @param {string} colour
 * @param {string} text
 * @param {boolean} isDot
 */
export function swatch(colour, text, isDot = false) {
  const patch = element("i", isDot ? { class: "dot" } : {});
  patch.style.background = colour;
  return element("span", { class: "swatch" }, patch, text);
}

/**
 * @param {string} title
 * @param {string} unit
 * @param {...Node} content
 */
export function legend(title, unit, ...content) {
  const heading = element("h3", {}, title, element("span", {}, unit ? `  ${unit}` : ""));
  return element("div", { class: "legend" }, heading, ...content);
}

/**
 * Colours of a quantity; where its smallest or largest value lies beyond them, the ends say so.
 *
 * @param {any} quantity
 */
export function rampLegend({ label, unit, stops, low, high, remark, least, most }) {
  if (low === high)
    return legend(label, unit, swatch(stops[0], `${format(low, 4)} ${remark || "everywhere"}`));
  const bar = element("div", { class: "bar" });
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const ticks = element("div", { class: "ticks" });
  const span = high - low;
  const round = niceTicks(low, high, 5);
  const beyond = [least < low - 1e-6 * span, most > high + 1e-6 * span];
  /** @type {[number, string][]} */
  const marks = round.ticks.map((value) => [(value - low) / span, round.text(value)]);
  // an end with values beyond it is labelled, and room made for that longer label
  const shown = marks.filter(([place]) => !(beyond[0] && place < 0.25) && !(beyond[1] && place > 0.75));
  if (beyond[0]) shown.unshift([0, `≤ ${format(low, 2)}`]);
  if (beyond[1]) shown.push([1, `≥ ${format(high, 2)}`]);
  for (const [place, text] of shown) {
    const tick = element("span", { class: place < 0.02 ? "first" : place > 0.96 ? "last" : "" }, text);
    tick.style.left = `${100 * place}%`;
    ticks.append(tick);
  }
  const about = `(${format(least)} to ${format(most)})${remark && ` · ${remark}`}`;
  return legend(label, [unit, about].filter(Boolean).join(" "), bar, ticks);
}

/**
 * Legends of all that a viewer shows.
 *
 * @param {any} viewer
 * @returns {Node[]}
 */
export function legends(viewer) {
  const ramps = new Map();
  const families = new Map();
  const dots = new Map();
  for (const one of viewer.drawn.values()) {
    const { layer, quantity } = one;
    if (!one.isPickable) continue;
    if (quantity) ramps.set(`${layer.palette} ${quantity.key}`, quantity);
    else if (one.key === "layer" && layer.palette) families.set(layer.groups[0], layer.colour);
    if (layer.kind === "points" && !quantity) dots.set(layer.label, [layer.groups[0], one.plainColour]);
  }
  const made = [...ramps.values()].map(rampLegend);
  if (families.size) {
    const swatches = [...families].map(([name, colour]) => swatch(colour, name));
    made.push(legend("Family", "", element("div", { class: "swatches" }, ...swatches)));
  }
  if (dots.size) {
    const [[, [title]]] = dots;
    const swatches = [...dots].map(([label, [, colour]]) => swatch(colour, label, true));
    made.push(legend(title, "", element("div", { class: "swatches" }, ...swatches)));
  }
  return made;
}

/**
 * Largest size of some numbers.
 *
 * @param {ArrayLike<number>} values
 */
export const largest = (values) => Math.max(...extent(values).map(Math.abs));
