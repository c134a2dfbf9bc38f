// Where layers are in a frame, and between two.

/**
 * The frame before and after a place on a slider, and the share of the second.
 *
 * @param {any} frames
 * @param {number} at
 * @returns {[number, number, number]}
 */
export function around(frames, at) {
  const last = frames.values.length - 1;
  const place = Math.min(Math.max(at, 0), last);
  if (!frames.continuous) return [Math.round(place), Math.round(place), 0];
  const before = Math.floor(place);
  return [before, Math.min(before + 1, last), place - before];
}

/**
 * Numbers of one frame, or between two.
 *
 * @param {Float32Array} values
 * @param {number} size
 * @param {[number, number, number]} place
 */
export function mixed(values, size, [before, after, share]) {
  const first = values.subarray(before * size, (before + 1) * size);
  if (!share) return Float32Array.from(first);
  const second = values.subarray(after * size, (after + 1) * size);
  return Float32Array.from(first, (value, i) => value + share * (second[i] - value));
}

/**
 * Points of a layer, its normals and values in a frame; null: those it has.
 *
 * @param {any} motion
 * @param {any} drawn
 * @param {[number, number, number]} place
 * @param {number} exaggeration
 */
export function moved(motion, drawn, place, exaggeration) {
  const rest = drawn.layer.kind === "instances" ? drawn.layer.origins : drawn.layer.positions;
  let points = null;
  if (motion.positions) points = mixed(motion.positions, rest.length, place);
  if (motion.displacements) {
    points = mixed(motion.displacements, rest.length, place);
    for (let i = 0; i < points.length; i++) points[i] = rest[i] + exaggeration * points[i];
  }
  return {
    points: points ?? rest,
    normals: motion.normals ? mixed(motion.normals, rest.length, place) : (drawn.layer.normals ?? null),
    values: Object.fromEntries(
      Object.entries(motion.values).map(([key, values]) => [key, mixed(values, drawn.layer.count, place)]),
    ),
  };
}
