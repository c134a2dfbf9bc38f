// Layers as objects of three.js: one class a kind, with the same methods.

import { LOOKS, even, paint } from "./colours.js";
import { cornersOf, ruledIndex, ruledPositions, pieceStarts, sweptIndex, sweptPositions } from "./strips.js";

/** @typedef {any} Layer a layer as decode.js reads it */

/** More than two drawn pixels a point cost time and show nothing. */
export const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);

/** What all drawn layers share. */
class Drawn {
  /** @param {Layer} layer */
  constructor(layer) {
    this.layer = layer;
    /** @type {any} */
    this.object = new THREE.Group();
    /** @type {any[]} */
    this.materials = [];
    this.dark = false;
    /** Key of the quantity it shows; "" its material, "layer" its own colour. */
    this.key = layer.quantity;
    /** Values of the shown quantity in a frame, in place of the layer's. @type {Float32Array | null} */
    this.values = null;
    this.points = layer.kind === "instances" ? layer.origins : layer.positions;
    this.normals = layer.normals ?? null;
  }

  /** The quantity it shows, if any. */
  get quantity() {
    return this.layer.quantities.find((/** @type {any} */ one) => one.key === this.key);
  }

  /** Whether its quantity is chosen from a list. */
  get isChosen() {
    return Boolean(this.layer.palette);
  }

  get look() {
    return LOOKS[/** @type {keyof typeof LOOKS} */ (this.layer.material)] ?? LOOKS.plain;
  }

  /** The one colour of a layer that shows no quantity. */
  get plainColour() {
    const own = this.layer.colour && (this.key === "layer" || !this.isChosen);
    return own ? this.layer.colour : this.look.colours[this.dark ? 1 : 0];
  }

  /** Linear RGB of every element. */
  elementColours() {
    const { quantity } = this;
    return quantity ? paint(this.values ?? quantity.values, quantity) : even(this.plainColour, this.layer.count);
  }

  /**
   * A material that reads as steel, timber or whatever the layer is of.
   *
   * @param {Record<string, any>} options
   */
  surfaceMaterial(options) {
    const { specular, shininess } = this.look;
    const clear = this.layer.opacity < 1;
    const material = new THREE.MeshPhongMaterial({
      specular,
      shininess,
      transparent: clear,
      opacity: this.layer.opacity,
      depthWrite: !clear,
      side: THREE.DoubleSide,
      ...options,
    });
    this.materials.push(material);
    return material;
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    this.dark = dark;
    this.repaint();
  }

  /**
   * @param {string} key
   * @param {Float32Array | null} values
   */
  colour(key, values = null) {
    this.key = key;
    this.values = values;
    this.repaint();
  }

  repaint() {}

  /**
   * Put it elsewhere: what it is drawn at, and the normals of strips.
   *
   * @param {Float32Array} points
   * @param {Float32Array | null} normals
   */
  place(points, normals) {
    this.points = points;
    this.normals = normals ?? this.normals;
    this.placed();
  }

  placed() {}

  /** @param {any[] | null} planes */
  clip(planes) {
    for (const material of this.materials) {
      material.clippingPlanes = planes;
      material.needsUpdate = true;
    }
  }

  /**
   * What a ray meets first: element and distance.
   *
   * @param {any} caster
   * @param {(point: any) => boolean} isSeen
   * @returns {{ element: number, distance: number, point: any } | null}
   */
  hit(caster, isSeen) {
    return null;
  }

  dispose() {
    this.object.traverse((/** @type {any} */ part) => {
      part.geometry?.dispose();
      part.dispose?.();
    });
    this.materials.forEach((material) => material.dispose());
  }
}

/**
 * @param {any} caster
 * @param {any} object
 * @param {(point: any) => boolean} isSeen
 */
function firstHit(caster, object, isSeen) {
  return caster.intersectObject(object, false).find((/** @type {any} */ one) => isSeen(one.point)) ?? null;
}

/**
 * @param {any} geometry
 * @param {string} name
 * @param {any} array
 * @param {number} size
 */
function setAttribute(geometry, name, array, size = 3) {
  const known = geometry.getAttribute(name);
  if (known && known.array.length === array.length) {
    known.array.set(array);
    known.needsUpdate = true;
  } else geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
  if (name === "position") geometry.boundingSphere = geometry.boundingBox = null;
}

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

/**
 * @param {Float32Array} colours
 * @param {ArrayLike<number>} some
 */
function gathered(colours, some) {
  const chosen = new Float32Array(3 * some.length);
  for (let i = 0; i < some.length; i++) {
    const from = 3 * some[i];
    chosen[3 * i] = colours[from];
    chosen[3 * i + 1] = colours[from + 1];
    chosen[3 * i + 2] = colours[from + 2];
  }
  return chosen;
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
    this.mesh.instanceColor.needsUpdate = true;
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

/**
 * The three numbers of each piece's start and of its end.
 *
 * @param {ArrayLike<number>} values
 * @param {number[]} starts
 */
export function pairsOf(values, starts) {
  const pairs = new Float32Array(6 * starts.length);
  for (let k = 0; k < starts.length; k++)
    for (let c = 0; c < 6; c++) pairs[6 * k + c] = values[3 * starts[k] + c];
  return pairs;
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
