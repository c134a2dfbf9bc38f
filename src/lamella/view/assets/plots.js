// Quantities along a curve, over its arc length.

import { element, svg } from "./dom.js";
import { extent, format, niceTicks } from "./text.js";

const MARGIN = { left: 52, right: 12, top: 10, bottom: 42 };
const PLOT_HEIGHT = 240;
/** Below this (1/m, MPa) a plotted value is rounding. */
const ROUNDING = 1e-9;
const DASHES = ["", "", "", "", "6 3", "1 2", "2 2.5"];

/**
 * @param {any} spec a plot of some curves
 * @param {any} curves
 * @param {(sample: number | null) => void} onCursor
 */
export function createPlot(spec, curves, onCursor) {
  const drawing = svg("svg", { tabindex: "0", role: "img", height: PLOT_HEIGHT });
  const readout = element("ul", { class: "readout" });
  const place = element("span", { "aria-live": "polite" });
  const title = element("div", {}, `${spec.title} `, element("span", {}, spec.unit));
  const figure = element(
    "figure",
    { class: "plot" },
    element("figcaption", {}, title, place),
    drawing,
    readout,
  );
  const values = spec.series.map((/** @type {any} */ series, /** @type {number} */ k) => {
    const text = element("b");
    const line = svg("line", { x2: 18, y1: 4, y2: 4, ...strokeOf(k) });
    readout.append(element("li", {}, svg("svg", { viewBox: "0 0 18 8" }, line), series.label, text));
    return text;
  });
  /** @type {any} */
  let frame = null;

  /** @param {number} curve */
  function draw(curve) {
    frame = plotFrame(spec, curves, curve, drawing.clientWidth || 480);
    drawing.setAttribute("viewBox", `0 0 ${frame.width} ${PLOT_HEIGHT}`);
    const peaks = spec.series
      .map(
        (/** @type {any} */ series, /** @type {number} */ k) => `${series.label} ${format(frame.peaks[k])}`,
      )
      .join(", ");
    const about = `${spec.title} along ${curves.noun.toLowerCase()} ${curves.ids[curve]}`;
    drawing.setAttribute(
      "aria-label",
      `${about}: peaks ${peaks} ${spec.unit}. Left and right arrows read values.`,
    );
    drawing.replaceChildren(...axisShapes(frame), ...curveShapes(spec, frame));
    setCursor(null);
  }

  /** @param {number | null} sample */
  function setCursor(sample) {
    drawing.querySelector(".cursor-group")?.remove();
    spec.series.forEach((/** @type {any} */ series, /** @type {number} */ k) => {
      const value = sample === null ? frame.peaks[k] : series.values[sample];
      values[k].textContent = Math.abs(value) < ROUNDING ? "≈ 0" : format(value, spec.digits);
    });
    place.textContent = sample === null ? "peak values" : whereabouts(curves, frame.curve, sample);
    frame.held = sample;
    if (sample !== null) drawing.append(cursorShapes(spec, frame, sample));
  }

  drawing.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
    if (!frame) return;
    const box = drawing.getBoundingClientRect();
    onCursor(frame.sampleAt(((event.clientX - box.left) * frame.width) / box.width));
  });
  drawing.addEventListener("pointerleave", () => onCursor(null));
  drawing.addEventListener("blur", () => onCursor(null));
  drawing.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step && frame) {
      onCursor(frame.step(step * (event.shiftKey ? 10 : 1)));
      event.preventDefault();
      event.stopPropagation();
    }
  });
  return { figure, draw, setCursor };
}

/** @param {number} k */
const strokeOf = (k) => ({
  style: `stroke: var(--series-${k % 7})`,
  ...(DASHES[k % 7] ? { "stroke-dasharray": DASHES[k % 7] } : {}),
});

/**
 * @param {any} spec
 * @param {any} curves
 * @param {number} curve
 * @param {number} width
 */
function plotFrame(spec, curves, curve, width) {
  const [first, end] = [curves.offsets[curve], curves.offsets[curve + 1]];
  const length = curves.arclengths[end - 1] || 1;
  const bounds = spec.series.map((/** @type {any} */ series) => extent(series.values.subarray(first, end)));
  let low = Math.min(0, ...bounds.map((/** @type {number[]} */ [least]) => least));
  let high = Math.max(0, ...bounds.map((/** @type {number[]} */ [, most]) => most));
  // what is zero up to rounding stays a flat line
  if (high - low < ROUNDING) [low, high] = [low - 0.5, high + 0.5];
  const pad = 0.05 * (high - low);
  [low, high] = [low < 0 ? low - pad : low, high > 0 ? high + pad : high];
  const [inner, tall] = [width - MARGIN.left - MARGIN.right, PLOT_HEIGHT - MARGIN.top - MARGIN.bottom];
  const frame = {
    curves,
    curve,
    first,
    end,
    width,
    length,
    low,
    high,
    /** @type {number | null} */
    held: null,
    peaks: bounds.map((/** @type {number[]} */ [least, most]) =>
      Math.abs(least) > Math.abs(most) ? least : most,
    ),
    x: (/** @type {number} */ s) => MARGIN.left + (s / length) * inner,
    y: (/** @type {number} */ value) => MARGIN.top + ((high - value) / (high - low)) * tall,
    sampleAt: (/** @type {number} */ pixel) =>
      nearestIndex(curves.arclengths, first, end, ((pixel - MARGIN.left) / inner) * length),
    step: (/** @type {number} */ by) =>
      Math.min(Math.max((frame.held ?? first - Math.sign(by)) + by, first), end - 1),
  };
  return frame;
}

/**
 * Index in first..end of the entry nearest to `target` in increasing values.
 *
 * @param {ArrayLike<number>} values
 * @param {number} first
 * @param {number} end
 * @param {number} target
 */
function nearestIndex(values, first, end, target) {
  let [low, high] = [first, end - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= target) low = middle;
    else high = middle;
  }
  return target - values[low] < values[high] - target ? low : high;
}

/** @param {any} frame */
function axisShapes({ curves, curve, first, width, length, low, high, x, y }) {
  const shapes = [];
  const [left, right, bottom] = [MARGIN.left, width - MARGIN.right, PLOT_HEIGHT - MARGIN.bottom];
  const vertical = niceTicks(low, high, 5);
  for (const tick of vertical.ticks) {
    const kind = tick === 0 ? "axis" : "grid";
    shapes.push(svg("line", { class: kind, x1: left, x2: right, y1: y(tick), y2: y(tick) }));
    shapes.push(svg("text", { x: left - 7, y: y(tick) + 4, "text-anchor": "end" }, vertical.text(tick)));
  }
  const [firstStop, endStop] = [curves.stop_offsets[curve], curves.stop_offsets[curve + 1]];
  const isSparse = (right - left) / (endStop - firstStop) > 7;
  for (let stop = firstStop; stop < endStop; stop++) {
    const place = x(curves.arclengths[first + curves.stop_samples[stop]]);
    if (isSparse)
      shapes.push(svg("line", { class: "node", x1: place, x2: place, y1: MARGIN.top, y2: bottom }));
    shapes.push(svg("line", { class: "tick", x1: place, x2: place, y1: bottom, y2: bottom + 5 }));
  }
  const horizontal = niceTicks(0, length, Math.max(2, Math.min(8, width / 80)));
  for (const tick of horizontal.ticks)
    shapes.push(svg("text", { x: x(tick), y: bottom + 18, "text-anchor": "middle" }, horizontal.text(tick)));
  shapes.push(svg("line", { class: "axis", x1: left, x2: right, y1: bottom, y2: bottom }));
  shapes.push(svg("text", { x: right, y: bottom + 35, "text-anchor": "end" }, "arc length, m; ticks: nodes"));
  return shapes;
}

/**
 * @param {any} spec
 * @param {any} frame
 */
function curveShapes(spec, { curves, first, end, x, y }) {
  return spec.series.map((/** @type {any} */ series, /** @type {number} */ k) => {
    let path = "",
      command = "M";
    for (let i = first; i < end; i++) {
      const value = series.values[i];
      if (Number.isNaN(value)) {
        command = "M";
        continue;
      }
      path += `${command}${x(curves.arclengths[i]).toFixed(1)} ${y(value).toFixed(1)}`;
      command = "L";
    }
    return svg("path", { d: path, ...strokeOf(k) });
  });
}

/**
 * @param {any} spec
 * @param {any} frame
 * @param {number} sample
 */
function cursorShapes(spec, { curves, x, y }, sample) {
  const place = x(curves.arclengths[sample]);
  const line = { class: "cursor", x1: place, x2: place, y1: MARGIN.top, y2: PLOT_HEIGHT - MARGIN.bottom };
  const group = svg("g", { class: "cursor-group" }, svg("line", line));
  spec.series.forEach((/** @type {any} */ series, /** @type {number} */ k) => {
    const value = series.values[sample];
    const style = `fill: var(--series-${k % 7})`;
    if (!Number.isNaN(value)) group.append(svg("circle", { cx: place, cy: y(value), r: 3.4, style }));
  });
  return group;
}

/**
 * "2.310 m, node 7" or "2.310 m, nodes 7 to 12", numbered as in network.json.
 *
 * @param {any} curves
 * @param {number} curve
 * @param {number} sample
 */
function whereabouts(curves, curve, sample) {
  const [firstStop, endStop] = [curves.stop_offsets[curve], curves.stop_offsets[curve + 1]];
  const local = sample - curves.offsets[curve];
  const next = curves.stop_samples
    .subarray(firstStop, endStop)
    .findIndex((/** @type {number} */ stop) => stop >= local);
  const at = `at ${curves.arclengths[sample].toFixed(3)} m`;
  if (next < 0) return at;
  const node = curves.stop_nodes[firstStop + next];
  if (curves.stop_samples[firstStop + next] === local) return `${at}, node ${node}`;
  return next ? `${at}, nodes ${curves.stop_nodes[firstStop + next - 1]} to ${node}` : at;
}
