// Strips with their thickness: rectangles swept along curves.

/** Rectangles are swept up to so many samples times layers; beyond, each layer is a surface without thickness. */
export const BOX_LIMIT = 120000;

/**
 * The two edges of the ruled strip on every sample: 6 numbers each, below and above.
 *
 * @param {any} layer
 * @param {Float32Array} points
 * @param {Float32Array} normals
 */
export function ruledPositions(layer, points, normals) {
  const positions = new Float32Array(2 * points.length);
  const [low, high] = [layer.level - layer.height / 2, layer.level + layer.height / 2];
  for (let i = 0; i < points.length; i += 3)
    for (let k = 0; k < 3; k++) {
      positions[2 * i + k] = points[i + k] + low * normals[i + k];
      positions[2 * i + 3 + k] = points[i + k] + high * normals[i + k];
    }
  return positions;
}

/**
 * Triangles of ruled strips: two a piece between neighbouring samples of a curve.
 *
 * @param {ArrayLike<number>} offsets
 */
export function ruledIndex(offsets) {
  const index = [];
  for (const i of pieceStarts(offsets))
    index.push(2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3);
  return new Uint32Array(index);
}

/**
 * Samples that have a next one on their curve.
 *
 * @param {ArrayLike<number>} offsets
 */
export function pieceStarts(offsets) {
  const starts = [];
  for (let curve = 0; curve + 1 < offsets.length; curve++)
    for (let i = offsets[curve]; i + 1 < offsets[curve + 1]; i++) starts.push(i);
  return starts;
}

/**
 * Unit vectors to the side of a curve, normal x tangent, at every sample.
 *
 * @param {ArrayLike<number>} offsets
 * @param {Float32Array} points
 * @param {Float32Array} normals
 */
export function sideways(offsets, points, normals) {
  const sides = new Float32Array(points.length);
  for (let curve = 0; curve + 1 < offsets.length; curve++) {
    const [first, last] = [offsets[curve], offsets[curve + 1] - 1];
    for (let i = first; i <= last; i++) {
      const [a, b] = [3 * Math.max(i - 1, first), 3 * Math.min(i + 1, last)];
      const [tx, ty, tz] = [
        points[b] - points[a],
        points[b + 1] - points[a + 1],
        points[b + 2] - points[a + 2],
      ];
      const [nx, ny, nz] = [normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]];
      const [x, y, z] = [ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx];
      const length = Math.hypot(x, y, z) || 1;
      sides.set([x / length, y / length, z / length], 3 * i);
    }
  }
  return sides;
}

/** @param {any} layer */
export const isBoxed = (layer) => layer.count * layer.sheets <= BOX_LIMIT;

/** Corners of a rectangle: to the side, up. */
const BOX = [
  [-0.5, -0.5],
  [0.5, -0.5],
  [0.5, 0.5],
  [-0.5, 0.5],
];
const SHEET = [
  [0, -0.5],
  [0, 0.5],
];

/** @param {any} layer */
export const cornersOf = (layer) => (isBoxed(layer) ? BOX : SHEET);

/**
 * Corners of the rectangles of all layers of strips, one sample after the other, one layer after the other.
 *
 * @param {any} layer
 * @param {Float32Array} points
 * @param {Float32Array} normals
 */
export function sweptPositions(layer, points, normals) {
  const across = sideways(layer.offsets, points, normals);
  const corners = cornersOf(layer);
  const count = layer.count;
  const positions = new Float32Array(3 * corners.length * layer.sheets * count);
  const perSample = layer.sides.length > layer.sheets;
  let at = 0;
  for (let sheet = 0; sheet < layer.sheets; sheet++)
    for (let i = 0; i < count; i++) {
      const beside = layer.sides[perSample ? sheet * count + i : sheet];
      for (const [aside, up] of corners) {
        const [d, z] = [beside + aside * layer.thickness, layer.level + up * layer.height];
        for (let k = 3 * i; k < 3 * i + 3; k++) positions[at++] = points[k] + d * across[k] + z * normals[k];
      }
    }
  return positions;
}

/**
 * Triangles of swept strips, with their ends.
 *
 * @param {any} layer
 */
export function sweptIndex(layer) {
  const corners = cornersOf(layer).length;
  const starts = pieceStarts(layer.offsets);
  const index = [];
  for (let sheet = 0; sheet < layer.sheets; sheet++) {
    const first = sheet * layer.count * corners;
    for (const i of starts) {
      const [a, b] = [first + corners * i, first + corners * (i + 1)];
      if (corners === 2) index.push(a, b, a + 1, a + 1, b, b + 1);
      else
        for (let k = 0; k < 4; k++) {
          const n = (k + 1) % 4;
          index.push(a + k, a + n, b + k, a + n, b + n, b + k);
        }
    }
    if (corners === 4)
      for (let curve = 0; curve + 1 < layer.offsets.length; curve++) {
        const [a, b] = [layer.offsets[curve], layer.offsets[curve + 1] - 1].map((i) => first + 4 * i);
        if (b > a) index.push(a, a + 2, a + 1, a, a + 3, a + 2, b, b + 1, b + 2, b, b + 2, b + 3);
      }
  }
  return new Uint32Array(index);
}
