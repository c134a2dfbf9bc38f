// Lines about what was chosen.

import { pairsOf } from "./drawn_base.js";
import { pieceStarts, ruledPositions } from "./strips.js";

/**
 * Lines about a curve: the edges of a strip, or the curve itself.
 *
 * @param {{ one: any, index: number }} found
 */
export function outline({ one, index }) {
  const { layer } = one;
  const [first, end] = [layer.offsets[index], layer.offsets[index + 1]];
  const points = one.points.subarray(3 * first, 3 * end);
  if (layer.kind !== "strips") return { pairs: pairsOf(points, pieceStarts([0, end - first])), width: 5 };
  const edges = ruledPositions(layer, points, one.normals.subarray(3 * first, 3 * end));
  const corner = (/** @type {number} */ sample, /** @type {number} */ side) =>
    Array.from(edges.subarray(6 * sample + 3 * side, 6 * sample + 3 * side + 3));
  const last = end - first - 1;
  const pairs = [...corner(0, 0), ...corner(0, 1), ...corner(last, 0), ...corner(last, 1)];
  for (let i = 0; i < last; i++)
    for (const side of [0, 1]) pairs.push(...corner(i, side), ...corner(i + 1, side));
  return { pairs: new Float32Array(pairs), width: 2.2 };
}
