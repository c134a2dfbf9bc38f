// What a viewer has to know of layers.

/** @param {any} layer */
export const isAround = (layer) => layer.material === "ground" || layer.material === "person";

/** The point that is marked. */
export const markerLayer = () => ({
  kind: "points",
  name: "marker",
  groups: [],
  replaces: [],
  ids: [],
  quantities: [],
  quantity: "",
  material: "plain",
  colour: "#111418",
  opacity: 1,
  count: 1,
  positions: new Float32Array(3),
  size: 11,
  least: 11,
});

/**
 * Mean distance of neighbouring nodes along curves.
 *
 * @param {any} scene
 */
export function cellOf(scene) {
  let [length, cells] = [0, 0];
  for (const { offsets, arclengths, stop_nodes } of scene.curves) {
    for (let i = 0; i + 1 < offsets.length; i++) length += arclengths[offsets[i + 1] - 1];
    cells += stop_nodes.length - (offsets.length - 1);
  }
  return cells > 0 ? length / cells : 0;
}

/**
 * Move a layer that was measured from another middle.
 *
 * @param {any} layer
 * @param {number[]} from
 * @param {number[]} to
 */
export function recentred(layer, from, to) {
  const places = layer.kind === "instances" ? layer.origins : layer.positions;
  if (from.every((value, k) => value === to[k])) return;
  for (let i = 0; i < places.length; i++) places[i] += from[i % 3] - to[i % 3];
}
