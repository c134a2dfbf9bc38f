// One curve beside the view: what it is, and plots along it.

import { byId, element } from "./dom.js";
import { createPlot } from "./plots.js";
import { format } from "./text.js";

/**
 * @param {any} curves
 * @param {(curve: number | null, local: number) => void} onCursor
 */
export function createPanel(curves, onCursor) {
  const choice = byId("lamella-choice");
  const facts = byId("facts");
  /** @type {number | null} */
  let current = null;
  const setCursor = (/** @type {number | null} */ sample) => {
    plots.forEach((/** @type {any} */ plot) => plot.setCursor(sample));
    if (sample === null || current === null) onCursor(null, 0);
    else onCursor(current, sample - curves.offsets[current]);
  };
  const plots = curves.plots.map((/** @type {any} */ spec) => createPlot(spec, curves, setCursor));
  byId("plots").append(...plots.map((/** @type {any} */ plot) => plot.figure));
  choice.append(
    element("option", { value: "" }, "none"),
    ...curves.ids.map((/** @type {string} */ id, /** @type {number} */ k) =>
      element("option", { value: k }, id),
    ),
  );
  byId("lamella-title").textContent = curves.noun;
  byId("lamella-panel").hidden = false;

  function showFacts() {
    const none = {
      label: "",
      text: `Choose a ${curves.noun.toLowerCase()} here or in the 3D view.`,
      unit: "",
    };
    const entries =
      current === null ? [none] : curves.facts.map((/** @type {any} */ fact) => told(fact, current));
    facts.replaceChildren(
      ...entries.map((/** @type {any} */ { label, text, unit }) => {
        const value = element("dd", {}, text, element("span", {}, unit ? ` ${unit}` : ""));
        return element("div", {}, element("dt", {}, label), value);
      }),
    );
  }

  /** @param {number | null} curve */
  function show(curve) {
    current = curve;
    choice.value = curve ?? "";
    byId("plots").hidden = curve === null;
    showFacts();
    if (curve !== null) plots.forEach((/** @type {any} */ plot) => plot.draw(curve));
  }

  new ResizeObserver(() => {
    if (current !== null) plots.forEach((/** @type {any} */ plot) => plot.draw(current));
  }).observe(byId("plots"));
  return { show };
}

/**
 * @param {any} fact
 * @param {any} curve
 */
function told({ label, unit, values, decimals }, curve) {
  const value = values[curve];
  const text = typeof value === "string" ? value : decimals < 0 ? format(value) : value.toFixed(decimals);
  return { label, unit, text };
}

/**
 * The curve with the largest value of its series `worst_by`; null where there is none.
 *
 * @param {any} curves
 * @returns {number | null}
 */
export function worstOf(curves) {
  const series = curves.plots
    .flatMap((/** @type {any} */ plot) => plot.series)
    .find((/** @type {any} */ one) => one.key === curves.worst_by);
  if (!series) return null;
  let best = 0;
  series.values.forEach((/** @type {number} */ value, /** @type {number} */ i) => {
    if (value > series.values[best]) best = i;
  });
  let curve = 0;
  while (curves.offsets[curve + 1] <= best) curve++;
  return curve;
}
