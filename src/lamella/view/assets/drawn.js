// Layers as objects of three.js: one class a kind, with the same methods.

import { Drawn, firstHit, gathered, pairsOf, pixelRatio, setAttribute } from "./drawn_base.js";
import { cornersOf, pieceStarts, ruledIndex, ruledPositions, sweptIndex, sweptPositions } from "./strips.js";

/** @typedef {import("./drawn_base.js").Layer} Layer */

class DrawnMesh extends Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    super(layer);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(layer.positions), 3));
    if (layer.normals) geometry.setAttribute("normal", new THREE.BufferAttribute(layer.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(layer.faces), 1));
    const isGround = layer.material === "ground";
    const material = this.surfaceMaterial({
      flatShading: !layer.normals,
      // the ground is seen through from below; surfaces are pushed back, so that lines in them win
      ...(isGround ? { side: 0 } : {}),
      ...(layer.material === "surface"
        ? { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }
        : {}),
    });
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.castShadow = !isGround && layer.opacity === 1;
    this.mesh.receiveShadow = isGround;
    this.object.add(this.mesh);
    /** The strips whose colours it takes. @type {Drawn | null} */
    this.source = null;
  }

  repaint() {
    const { geometry, material } = this.mesh;
    const coloured = Boolean(this.quantity) || (this.source !== null && Boolean(this.source.quantity));
    material.vertexColors = coloured;
    if (coloured) {
      const colours = this.source
        ? gathered(this.source.elementColours(), this.layer.samples)
        : this.elementColours();
      setAttribute(geometry, "color", colours);
      material.color.set(0xffffff);
    } else material.color.set(this.source ? this.source.plainColour : this.plainColour);
    if (this.layer.opacity < 1) material.opacity = coloured ? 0.85 : this.layer.opacity;
    material.needsUpdate = true;
  }

  placed() {
    setAttribute(this.mesh.geometry, "position", this.points);
    if (this.layer.normals) this.mesh.geometry.computeVertexNormals();
  }

  /**
   * @param {any} caster
   * @param {(point: any) => boolean} isSeen
   */
  hit(caster, isSeen) {
    if (!this.layer.owner) return null;
    const hit = firstHit(caster, this.mesh, isSeen);
    return hit && { element: hit.face.a, distance: hit.distance, point: hit.point };
  }
}

class DrawnInstances extends Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    super(layer);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(layer.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(layer.faces), 1));
    this.mesh = new THREE.InstancedMesh(geometry, this.surfaceMaterial({ flatShading: true }), layer.count);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.object.add(this.mesh);
    this.placed();
  }

  repaint() {
    const coloured = Boolean(this.quantity);
    this.mesh.material.color.set(coloured ? 0xffffff : this.plainColour);
    if (!coloured && !this.mesh.instanceColor) return;
    const colours = this.elementColours();
    const colour = new THREE.Color();
    for (let i = 0; i < this.layer.count; i++)
      this.mesh.setColorAt(i, coloured ? colour.fromArray(colours, 3 * i) : colour.set(0xffffff));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  placed() {
    const { axes } = this.layer;
    const matrices = this.mesh.instanceMatrix.array;
    for (let i = 0; i < this.layer.count; i++) {
      for (let row = 0; row < 3; row++)
        for (let k = 0; k < 3; k++) matrices[16 * i + 4 * row + k] = axes[9 * i + 3 * row + k];
      for (let k = 0; k < 3; k++) matrices[16 * i + 12 + k] = this.points[3 * i + k];
      matrices[16 * i + 15] = 1;
    }
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.boundingSphere = null;
  }

  /**
   * @param {any} caster
   * @param {(point: any) => boolean} isSeen
   */
  hit(caster, isSeen) {
    if (!this.layer.owner) return null;
    const hit = firstHit(caster, this.mesh, isSeen);
    return hit && { element: hit.instanceId, distance: hit.distance, point: hit.point };
  }
}

class DrawnLines extends Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    super(layer);
    this.starts = pieceStarts(layer.offsets);
    this.material = new THREE.LineMaterial({ linewidth: layer.width, vertexColors: true });
    this.materials.push(this.material);
    this.lines = new THREE.LineSegments2(new THREE.LineSegmentsGeometry(), this.material);
    if (this.starts.length) this.object.add(this.lines);
    this.placed();
  }

  repaint() {
    if (this.starts.length) this.lines.geometry.setColors(pairsOf(this.elementColours(), this.starts));
  }

  placed() {
    if (this.starts.length) this.lines.geometry.setPositions(pairsOf(this.points, this.starts));
  }
}

/** Strips; `proxy` is the ruled strip that rays are tested against, made anew when it is needed. */
class DrawnStrips extends Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    super(layer);
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(sweptIndex(layer), 1));
    this.mesh = new THREE.Mesh(geometry, this.surfaceMaterial({ flatShading: true }));
    this.mesh.castShadow = true;
    this.object.add(this.mesh);
    /** @type {any} */
    this.proxy = null;
    this.placed();
  }

  repaint() {
    const { geometry, material } = this.mesh;
    material.vertexColors = Boolean(this.quantity);
    material.color.set(this.quantity ? 0xffffff : this.plainColour);
    material.needsUpdate = true;
    if (!this.quantity) return;
    const colours = this.elementColours();
    const corners = cornersOf(this.layer).length;
    const painted = new Float32Array(colours.length * corners * this.layer.sheets);
    let at = 0;
    for (let sheet = 0; sheet < this.layer.sheets; sheet++)
      for (let i = 0; i < colours.length; i += 3)
        for (let corner = 0; corner < corners; corner++) {
          painted[at++] = colours[i];
          painted[at++] = colours[i + 1];
          painted[at++] = colours[i + 2];
        }
    setAttribute(geometry, "color", painted);
  }

  placed() {
    setAttribute(this.mesh.geometry, "position", sweptPositions(this.layer, this.points, this.normals));
    this.proxy?.geometry.dispose();
    this.proxy = null;
  }

  /**
   * @param {any} caster
   * @param {(point: any) => boolean} isSeen
   */
  hit(caster, isSeen) {
    if (!this.proxy) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute(
        "position",
        new THREE.BufferAttribute(ruledPositions(this.layer, this.points, this.normals), 3),
      );
      geometry.setIndex(new THREE.BufferAttribute(ruledIndex(this.layer.offsets), 1));
      this.proxy = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
    }
    const hit = firstHit(caster, this.proxy, isSeen);
    return hit && { element: hit.face.a >> 1, distance: hit.distance, point: hit.point };
  }

  dispose() {
    this.proxy?.geometry.dispose();
    super.dispose();
  }
}

/** By what share of its distance a point is drawn nearer than it is: larger ones more. */
const nearer = (/** @type {number} */ size) => 0.004 + 0.0007 * size;

/** Round points of a size on the screen, drawn a little nearer to the eye than they are. */
export class DrawnPoints extends Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    super(layer);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(layer.positions), 3));
    const share = (1 - nearer(layer.size)).toFixed(4);
    const material = new THREE.PointsMaterial({ size: layer.size * pixelRatio(), sizeAttenuation: false });
    material.onBeforeCompile = (/** @type {any} */ shader) => {
      shader.vertexShader = shader.vertexShader.replace(
        "#include <project_vertex>",
        `#include <project_vertex>
        gl_Position = projectionMatrix * vec4(mvPosition.xyz * ${share}, 1.0);`,
      );
      shader.fragmentShader = shader.fragmentShader.replace(
        "void main() {",
        "void main() {\nif (length(gl_PointCoord - 0.5) > 0.5) discard;",
      );
    };
    material.customProgramCacheKey = () => `round ${share}`;
    this.materials.push(material);
    this.mesh = new THREE.Points(geometry, material);
    this.object.add(this.mesh);
  }

  repaint() {
    const { geometry, material } = this.mesh;
    material.vertexColors = Boolean(this.quantity);
    if (this.quantity) setAttribute(geometry, "color", this.elementColours());
    material.color.set(this.quantity ? 0xffffff : this.plainColour);
    material.needsUpdate = true;
  }

  placed() {
    setAttribute(this.mesh.geometry, "position", this.points);
  }

  /**
   * Points shrink with the cells about them on the screen, so that a dense net does not drown in them.
   *
   * @param {number} cellPixels
   */
  fit(cellPixels) {
    const { size, least } = this.layer;
    this.mesh.material.size = Math.min(Math.max(0.14 * cellPixels, least), size) * pixelRatio();
  }
}

const KINDS = {
  mesh: DrawnMesh,
  lines: DrawnLines,
  points: DrawnPoints,
  instances: DrawnInstances,
  strips: DrawnStrips,
};

/**
 * A layer as it is drawn.
 *
 * @param {Layer} layer
 * @returns {any}
 */
export function drawLayer(layer) {
  return new KINDS[/** @type {keyof typeof KINDS} */ (layer.kind)](layer);
}
