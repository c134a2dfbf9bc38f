// What lies under a place on the screen.

const PICK_RADIUS = 12;
const NODE_RADIUS = 14;

/**
 * @typedef {{ layer: string, id: string, index: number, element: number, local: number, point: number[] }} Picked
 * `index` of the id in its layer, `local` number of the element on its curve.
 */

/**
 * What a ray meets first among drawn layers, or the curve or point that passes nearest on the screen: for thin strips
 * and fingers.
 *
 * @param {any[]} drawn
 * @param {any} caster
 * @param {(point: any) => boolean} isSeen
 * @param {(points: Float32Array, i: number) => number[]} onScreen
 * @param {number} x
 * @param {number} y
 * @returns {Picked | null}
 */
export function pick(drawn, caster, isSeen, onScreen, x, y) {
  let best = null,
    least = Infinity;
  for (const one of drawn) {
    const hit = one.hit(caster, isSeen);
    if (hit && hit.distance < least)
      [best, least] = [picked(one, hit.element, hit.point.toArray()), hit.distance];
  }
  return best ?? nearestCurve(drawn, isSeen, onScreen, x, y);
}

/**
 * @param {any} one
 * @param {number} element
 * @param {number[]} point
 * @returns {Picked}
 */
function picked(one, element, point) {
  const { layer } = one;
  const index = layer.owner ? layer.owner[element] : curveOf(layer.offsets, element);
  const local = layer.offsets ? element - layer.offsets[index] : 0;
  return { layer: layer.name, id: layer.ids[index] ?? "", index, element, local, point };
}

/**
 * The curve that has a sample.
 *
 * @param {ArrayLike<number>} offsets
 * @param {number} sample
 */
export function curveOf(offsets, sample) {
  let [low, high] = [0, offsets.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (offsets[middle] <= sample) low = middle;
    else high = middle;
  }
  return low;
}

/**
 * @param {any[]} drawn
 * @param {(point: any) => boolean} isSeen
 * @param {(points: Float32Array, i: number) => number[]} onScreen
 * @param {number} x
 * @param {number} y
 * @returns {Picked | null}
 */
function nearestCurve(drawn, isSeen, onScreen, x, y) {
  let best = null,
    least = PICK_RADIUS;
  for (const one of drawn) {
    const { layer, points } = one;
    if (!layer.offsets || !layer.ids.length) continue;
    for (let curve = 0; curve + 1 < layer.offsets.length; curve++) {
      let end = onScreen(points, layer.offsets[curve]);
      for (let i = layer.offsets[curve]; i + 1 < layer.offsets[curve + 1]; i++) {
        const start = end;
        end = onScreen(points, i + 1);
        const distance = distanceToPiece(x, y, start, end);
        if (distance < least && Math.abs(start[2]) < 1) {
          const place = new THREE.Vector3().fromArray(points, 3 * i);
          if (isSeen(place)) [best, least] = [picked(one, i, place.toArray()), distance];
        }
      }
    }
  }
  return best;
}

/**
 * @param {number} x
 * @param {number} y
 * @param {number[]} start
 * @param {number[]} end
 */
function distanceToPiece(x, y, [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const along = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}

/**
 * The point of a layer of points nearest to a place on the screen, within reach.
 *
 * @param {any[]} drawn
 * @param {(point: any) => boolean} isSeen
 * @param {(points: Float32Array, i: number) => number[]} onScreen
 * @param {number} x
 * @param {number} y
 * @returns {Picked | null}
 */
export function nearestNode(drawn, isSeen, onScreen, x, y) {
  let best = null,
    least = NODE_RADIUS * NODE_RADIUS,
    depth = 1;
  for (const one of drawn) {
    if (one.layer.kind !== "points") continue;
    for (let i = 0; i < one.layer.count; i++) {
      const [px, py, pz] = onScreen(one.points, i);
      const away = (px - x) ** 2 + (py - y) ** 2;
      // of nodes behind each other the one in front
      if (Math.abs(pz) < 1 && (away < least * 0.6 || (away < least && pz < depth))) {
        const place = new THREE.Vector3().fromArray(one.points, 3 * i);
        if (isSeen(place)) [best, least, depth] = [picked(one, i, place.toArray()), away, pz];
      }
    }
  }
  return best;
}
