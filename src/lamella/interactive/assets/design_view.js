// The view of a design: one frame after the other in the shared viewer, and the pinned state as grey lines over it.

import { decodeScene } from "./decode.js";
import { pairsOf } from "./drawn_base.js";
import { pieceStarts } from "./strips.js";
import { Viewer } from "./viewer.js";

/** Kept from frame to frame: they come with exact ones alone. */
const AROUND = new Set(["ground", "person"]);
const GHOST = ["#7a2ea0", "#d9a4f0"];

export class DesignView {
  /**
   * @param {HTMLElement} stage
   * @param {boolean} dark
   */
  constructor(stage, dark) {
    this.viewer = new Viewer(stage, { dark, label: "3D view of the design" });
    this.ghost = new THREE.Group();
    this.viewer.three.add(this.ghost);
    this.origin = [0, 0, 0];
    this.isFirst = true;
    /** @type {any} */
    this.pinned = null;
  }

  /**
   * Show a frame; the camera and what was chosen stay.
   *
   * @param {any} message
   * @returns {boolean} whether lists and switches have to be made anew
   */
  show(message) {
    const { viewer } = this;
    const scene = sceneOf(message);
    this.origin = message.origin;
    if (this.isFirst) {
      this.isFirst = false;
      viewer.setScene(scene);
      return true;
    }
    const before = keysOf(viewer);
    const names = new Set(scene.layers.map((/** @type {any} */ layer) => layer.name));
    const isGone = (/** @type {any} */ layer) =>
      !names.has(layer.name) && !(message.level === "coarse" && AROUND.has(layer.material));
    for (const layer of viewer.scene.layers.filter(isGone)) viewer.remove(layer.name);
    viewer.scene.layers = viewer.scene.layers.filter((/** @type {any} */ layer) => !isGone(layer));
    for (const labels of scene.labels) shift(labels.positions, scene.centre, viewer.scene.centre);
    const shown = new Map([...viewer.overlay.labels].map(([name, one]) => [name, one.shown]));
    for (const labels of scene.labels) labels.visible = shown.get(labels.name) ?? labels.visible;
    if (!scene.labels.length) viewer.overlay.setLabels([]);
    viewer.updateScene(scene);
    return message.level === "exact" || keysOf(viewer) !== before;
  }

  /** @param {any} message a frame, or null */
  pin(message) {
    this.pinned = message;
    for (const lines of /** @type {any[]} */ (this.ghost.children)) lines.geometry.dispose();
    this.ghost.clear();
    if (message) {
      const scene = sceneOf(message);
      for (const layer of scene.layers) if (layer.name.startsWith("lines ")) this.ghost.add(this.ghostOf(layer, scene));
    }
    this.viewer.redraw();
  }

  /**
   * @param {any} layer
   * @param {any} scene
   */
  ghostOf(layer, scene) {
    const points = Float32Array.from(layer.positions);
    shift(points, scene.centre, this.viewer.scene.centre ?? scene.centre);
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(pairsOf(points, pieceStarts(layer.offsets)));
    const color = GHOST[this.viewer.dark ? 1 : 0];
    const material = new THREE.LineMaterial({ linewidth: 1.4, color, transparent: true, opacity: 0.75 });
    return new THREE.LineSegments2(geometry, material);
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    this.viewer.setTheme(dark);
    this.pin(this.pinned);
  }

  /**
   * Coordinates of the viewer of a place in the drawing, m.
   *
   * @param {number[]} point
   */
  inside(point) {
    const centre = this.viewer.scene.centre ?? [0, 0, 0];
    return point.map((value, k) => value - this.origin[k] - centre[k]);
  }

  /**
   * The place in the drawing of coordinates of the viewer.
   *
   * @param {any} point
   */
  outside(point) {
    const centre = this.viewer.scene.centre ?? [0, 0, 0];
    return point.toArray().map((/** @type {number} */ value, /** @type {number} */ k) => value + this.origin[k] + centre[k]);
  }
}

/** @param {any} message */
function sceneOf({ arrays }) {
  const bytes = arrays.scene;
  return decodeScene(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
}

/** @param {any} viewer */
const keysOf = (viewer) =>
  viewer.scene.layers.map((/** @type {any} */ layer) => [layer.palette, layer.quantities.map((/** @type {any} */ one) => one.key), layer.groups].join()).join(";");

/**
 * @param {Float32Array} positions
 * @param {number[]} from
 * @param {number[]} to
 */
function shift(positions, from, to) {
  for (let i = 0; i < positions.length; i++) positions[i] += from[i % 3] - to[i % 3];
}
