// The axes, turned as the view is.

import { svg } from "./dom.js";

/** @type {[string, string][]} */
const AXES = [
  ["x", "#d0453b"],
  ["y", "#3d9a4b"],
  ["z", "#3b78d0"],
];

/**
 * @param {Element} target
 * @param {any} camera
 */
export function drawTriad(target, camera) {
  const inverse = camera.matrixWorldInverse.elements;
  const axes = AXES.map(([name, colour], k) => ({
    name,
    colour,
    x: inverse[4 * k],
    y: -inverse[4 * k + 1],
    depth: inverse[4 * k + 2],
  }));
  axes.sort((p, q) => p.depth - q.depth);
  target.replaceChildren(
    ...axes.flatMap(({ name, colour, x, y }) => [
      svg("line", { x2: 22 * x, y2: 22 * y, stroke: colour }),
      svg("text", { x: 30 * x, y: 30 * y, fill: colour }, name),
    ]),
  );
}
