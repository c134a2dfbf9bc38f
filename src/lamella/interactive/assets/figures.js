// Figures, misses and warnings beside the view, and what has changed.

import { byId, element } from "./dom.js";
import { format } from "./text.js";

/** Key, label, unit, factor, whether less is better (null: neither). @type {[string, string, string, number, boolean | null][]} */
const ROWS = [
  ["utilisation_max", "Utilisation", "%", 100, true],
  ["mass", "Mass", "kg", 1, true],
  ["parts_different", "Different parts", "", 1, true],
  ["parts", "Parts", "", 1, true],
  ["sheets", "Sheets", "", 1, true],
  ["lamellas", "Lamellas", "", 1, null],
  ["nodes", "Nodes", "", 1, null],
  ["total_length", "Length, one layer", "m", 1, null],
  ["cell_edge_median", "Cell edge, median", "m", 1, null],
  ["node_angle_deviation_max_deg", "Node angle off by", "°", 1, true],
  ["area", "Area", "m²", 1, null],
  ["mean_curvature", "Mean curvature H", "1/m", 1, null],
];
const WHOLE = new Set(["parts_different", "parts", "sheets", "lamellas", "nodes"]);
/** Of a value: less is no change. */
const CHANGE = 5e-4;
const CLOSES = 1e-3;
const POINT = /\((-?[\d.,e+-]+), (-?[\d.,e+-]+), (-?[\d.,e+-]+)\) m/;

/**
 * @param {any} frame
 * @param {Record<string, number>} before
 * @param {Record<string, number> | null} pinned
 * @param {Record<string, number>} last of the last exact frame
 */
export function showFigures(frame, before, pinned, last) {
  const isCoarse = frame.level === "coarse";
  byId("level").textContent = isCoarse ? "while it moves, about" : "";
  const rows = ROWS.flatMap(([key, label, unit, factor, less]) => {
    const now = frame.figures[key];
    const value = now ?? last[key];
    if (value === undefined) return [];
    const than = isCoarse ? last[key] : before[key];
    const row = element("tr", { class: now === undefined ? "old" : "", "data-key": key });
    if (key === "utilisation_max" && value > 1) row.classList.add("over");
    const shown = element("td", {}, `${isCoarse && now !== undefined ? "≈ " : ""}${told(key, value * factor)}`);
    if (unit) shown.append(element("small", {}, unit));
    row.append(element("th", { scope: "row" }, label), shown, changeOf(key, now, than, factor, less));
    if (pinned) row.append(element("td", { class: "pinned" }, pinned[key] === undefined ? "–" : told(key, pinned[key] * factor)));
    return [row];
  });
  const head = pinned
    ? [element("thead", {}, element("tr", {}, element("td"), element("td", {}, "now"), element("td", { class: "pinned" }, "pinned")))]
    : [];
  byId("figures").replaceChildren(...head, element("tbody", {}, ...rows));
}

/**
 * @param {string} key
 * @param {number} value
 */
const told = (key, value) => (WHOLE.has(key) ? String(Math.round(value)) : format(value, 4));

/**
 * @param {string} key
 * @param {number | undefined} now
 * @param {number | undefined} than
 * @param {number} factor
 * @param {boolean | null} less
 */
function changeOf(key, now, than, factor, less) {
  const cell = element("td", { class: "change" });
  if (now === undefined || than === undefined) return cell;
  const change = now - than;
  if (Math.abs(change) <= CHANGE * Math.max(Math.abs(now), Math.abs(than))) return cell;
  if (less !== null) cell.classList.add(change < 0 === less ? "better" : "worse");
  cell.textContent = `${change > 0 ? "+" : ""}${WHOLE.has(key) ? Math.round(change) : format(change * factor, 2)}`;
  return cell;
}

/**
 * @param {any} frame
 * @param {string} closing
 * @param {(point: number[]) => void} goTo
 */
export function showMisses(frame, closing, goTo) {
  const { apart = [], misses = [], umbilics = [] } = frame.details;
  /** @type {Node[]} */
  const items = [];
  const between = apart.map((/** @type {any} */ { a, b }) => {
    const isWhole = Math.max(offWhole(a), offWhole(b)) < 5e-3;
    const text = `${format(a, 4)} × ${format(b, 4)} cells between two singular points`;
    return element("li", { class: isWhole ? "closes" : "open" }, text);
  });
  const counted = misses.filter((/** @type {any} */ { off }) => off > CLOSES);
  for (const { between: ends, off, place, closed } of counted) {
    const item = element("li", { class: closed ? "closes" : "open" }, `${format(off, 2)} cells ${ends}${closed ? ", closed by moving lines" : ""}`);
    if (place) item.append(goButton(() => goTo(place.map((/** @type {number} */ value, /** @type {number} */ k) => value + frame.origin[k]))));
    items.push(item);
  }
  if (!counted.length && (misses.length || umbilics.length)) items.push(element("li", { class: "closes" }, "The net meets itself everywhere."));
  if (frame.details.no_lines) items.push(element("li", { class: "open" }, frame.details.no_lines));
  byId("misses").replaceChildren(...items, ...between);
  byId("closing-ways").dataset.value = closing;
}

/** @param {number} value */
const offWhole = (value) => Math.abs(value - Math.round(value));

/**
 * @param {any} frame
 * @param {(point: number[]) => void} goTo
 */
export function showWarnings(frame, goTo) {
  const warnings = frame.details.warnings;
  // coarse frames have none of their own: those of the last exact one stay
  if (!warnings) return;
  byId("warnings").hidden = !warnings.length;
  byId("warning-list").replaceChildren(
    ...warnings.map((/** @type {string} */ text) => {
      const item = element("li", {}, text);
      const place = POINT.exec(text);
      if (place) item.append(goButton(() => goTo(place.slice(1, 4).map(Number))));
      return item;
    }),
  );
}

/** @param {() => void} go */
function goButton(go) {
  const button = element("button", { type: "button" }, "show");
  button.addEventListener("click", go);
  return button;
}
