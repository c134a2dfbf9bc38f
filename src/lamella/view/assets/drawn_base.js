// What all drawn layers share.

import { LOOKS, even, paint } from "./colours.js";

/** @typedef {any} Layer a layer as decode.js reads it */

/** More than two drawn pixels a point cost time and show nothing. */
export const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);

/** What all drawn layers share. */
export class Drawn {
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
    return quantity
      ? paint(this.values ?? quantity.values, quantity)
      : even(this.plainColour, this.layer.count);
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
export function firstHit(caster, object, isSeen) {
  return caster.intersectObject(object, false).find((/** @type {any} */ one) => isSeen(one.point)) ?? null;
}

/**
 * @param {any} geometry
 * @param {string} name
 * @param {any} array
 * @param {number} size
 */
export function setAttribute(geometry, name, array, size = 3) {
  const known = geometry.getAttribute(name);
  if (known && known.array.length === array.length) {
    known.array.set(array);
    known.needsUpdate = true;
  } else geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
  if (name === "position") geometry.boundingSphere = geometry.boundingBox = null;
}

/**
 * @param {Float32Array} colours
 * @param {ArrayLike<number>} some
 */
export function gathered(colours, some) {
  const chosen = new Float32Array(3 * some.length);
  for (let i = 0; i < some.length; i++) {
    const from = 3 * some[i];
    chosen[3 * i] = colours[from];
    chosen[3 * i + 1] = colours[from + 1];
    chosen[3 * i + 2] = colours[from + 2];
  }
  return chosen;
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
