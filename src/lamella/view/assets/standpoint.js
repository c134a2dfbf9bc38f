// Where a scene is looked at from.

/** Directions from what is looked at to the eye. @type {Record<string, number[]>} */
export const VIEWS = {
  iso: [0.75, -1.15, 0.62],
  top: [0, -0.001, 1],
  front: [0, -1, 0.001],
  back: [0, 1, 0.001],
  side: [1, 0, 0.001],
  left: [-1, 0, 0.001],
};

/**
 * Distance from the origin at which all points are inside the picture.
 *
 * @param {any} camera
 * @param {Float32Array[]} clouds
 */
export function fittingDistance(camera, clouds) {
  camera.updateMatrixWorld();
  const [right, up, back] = [0, 1, 2].map((k) =>
    new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, k),
  );
  const vertical = Math.tan((camera.fov * Math.PI) / 360);
  const horizontal = vertical * camera.aspect;
  const point = new THREE.Vector3();
  let distance = 0;
  for (const points of clouds)
    for (let i = 0; i < points.length; i += 3) {
      point.fromArray(points, i);
      const needed = Math.max(Math.abs(point.dot(right)) / horizontal, Math.abs(point.dot(up)) / vertical);
      distance = Math.max(distance, point.dot(back) + needed * 1.06);
    }
  return distance || 1;
}

/**
 * The farthest of some points from the origin.
 *
 * @param {Float32Array[]} clouds
 */
export function reach(clouds) {
  let most = 0;
  for (const points of clouds)
    for (let i = 0; i < points.length; i += 3)
      most = Math.max(most, Math.hypot(points[i], points[i + 1], points[i + 2]));
  return most || 1;
}

/**
 * Lowest and highest coordinates of some points.
 *
 * @param {Float32Array[]} clouds
 */
export function boxOf(clouds) {
  const [low, high] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  for (const points of clouds)
    for (let i = 0; i < points.length; i++) {
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
  return low[0] <= high[0] ? [low, high] : [[0, 0, 0], [0, 0, 0]];
}

/**
 * Turn a camera about what it looks at, or go nearer.
 *
 * @param {any} camera
 * @param {any} target
 * @param {number} azimuth
 * @param {number} elevation
 * @param {number} factor
 */
export function turned(camera, target, azimuth, elevation, factor) {
  const away = camera.position.clone().sub(target);
  const distance = away.length();
  const polar = Math.min(Math.max(Math.acos(away.z / distance) - elevation, 0.01), Math.PI - 0.01);
  const around = Math.atan2(away.y, away.x) + azimuth;
  away.set(Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar));
  camera.position.copy(target).addScaledVector(away, distance * factor);
}
