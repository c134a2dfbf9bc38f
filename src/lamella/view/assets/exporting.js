// What is shown, as a file.

/**
 * Binary glTF of drawn layers: y is up there, colours are those that are shown.
 *
 * @param {any[]} drawn
 * @returns {Promise<ArrayBuffer>}
 */
export async function glbOf(drawn) {
  const root = new THREE.Group();
  root.rotation.x = -Math.PI / 2;
  for (const one of drawn) {
    const parts = partsOf(one);
    if (!parts.length) continue;
    const group = new THREE.Group();
    group.name = one.layer.name;
    group.add(...parts);
    root.add(group);
  }
  root.updateMatrixWorld(true);
  const data = await new THREE.GLTFExporter().parseAsync(root, { binary: true, onlyVisible: false });
  return /** @type {ArrayBuffer} */ (data);
}

/** @param {any} one */
function partsOf(one) {
  const { kind } = one.layer;
  if (kind === "points") return [];
  if (kind === "lines") {
    const geometry = new THREE.BufferGeometry();
    const ends = [];
    for (const i of one.starts) for (let k = 3 * i; k < 3 * i + 6; k++) ends.push(one.points[k]);
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
    return ends.length
      ? [new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: one.plainColour }))]
      : [];
  }
  const { geometry, material } = one.mesh;
  const look = new THREE.MeshStandardMaterial({
    color: material.color,
    vertexColors: material.vertexColors,
    metalness: one.layer.material === "steel" ? 0.6 : 0,
    roughness: 0.55,
    transparent: material.transparent,
    opacity: material.opacity,
    side: material.side,
  });
  if (kind !== "instances") return [new THREE.Mesh(geometry, look)];
  // pieces one by one: few programs read instances
  return Array.from({ length: one.layer.count }, (_, i) => {
    const piece = new THREE.Mesh(geometry, look);
    one.mesh.getMatrixAt(i, piece.matrix);
    piece.matrix.decompose(piece.position, piece.quaternion, piece.scale);
    piece.name = one.layer.ids[i] ?? "";
    return piece;
  });
}

/**
 * Let the reader save some bytes.
 *
 * @param {Blob} blob
 * @param {string} name
 */
export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
