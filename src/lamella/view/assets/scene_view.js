// The layers of a scene: which are seen, in what colours, in which frame.

import { drawLayer } from "./drawn.js";
import { cellOf, isAround, recentred } from "./layers.js";
import { around, moved } from "./moving.js";
import { Overlay } from "./overlay.js";
import { Stage } from "./stage.js";
import { boxOf, reach } from "./standpoint.js";

export class SceneView extends Stage {
  /**
   * @param {HTMLElement} container
   * @param {{ dark?: boolean, label?: string }} options
   */
  constructor(container, { dark = false, label = "3D view" } = {}) {
    super(container, label);
    this.dark = dark;
    /** @type {Map<string, any>} */
    this.drawn = new Map();
    /** @type {any} */
    this.scene = {
      layers: [],
      frames: [],
      labels: [],
      marks: [],
      curves: [],
      low: [0, 0, 0],
      high: [0, 0, 0],
    };
    /** @type {Map<string, boolean>} */
    this.groups = new Map();
    /** @type {Map<string, string>} */
    this.palettes = new Map();
    /** @type {any} */
    this.frames = null;
    this.frame = 0;
    this.exaggeration = 1;
    this.cell = 0;
    this.overlay = new Overlay(container);
    /** Of what was chosen. @type {string | null} */
    this.selected = null;
    /** Where what is there is cut. @type {any} */
    this.plane = null;
  }

  /**
   * Outline what has an id.
   *
   * @param {string | null} id
   */
  select(id) {
    this.selected = id;
  }

  /**
   * Show a scene, seen whole.
   *
   * @param {any} scene
   */
  setScene(scene) {
    this.setFrames(null);
    for (const name of [...this.drawn.keys()]) this.remove(name);
    this.scene = scene;
    this.groups.clear();
    this.palettes.clear();
    for (const layer of scene.layers) this.add(layer);
    for (const layer of scene.layers) {
      for (const group of layer.groups) this.groups.set(group, this.groups.get(group) || layer.visible);
      if (layer.palette) this.palettes.set(layer.palette, layer.quantity);
    }
    this.overlay.setLabels(scene.labels);
    this.select(null);
    this.setLimits();
    for (const [palette, key] of this.palettes) this.colour(palette, key);
    this.applyVisibility();
    this.lookFrom("iso");
  }

  /**
   * Take what is new of a scene: its layers by their names; the camera and all that was chosen stays.
   *
   * @param {any} scene
   */
  updateScene(scene) {
    const shift = this.scene.centre ?? scene.centre;
    for (const layer of scene.layers) {
      recentred(layer, scene.centre, shift);
      if (this.drawn.has(layer.name)) this.remove(layer.name);
      this.add(layer);
      for (const group of layer.groups) if (!this.groups.has(group)) this.groups.set(group, layer.visible);
      if (layer.palette && !this.palettes.has(layer.palette))
        this.palettes.set(layer.palette, layer.quantity);
    }
    const names = new Set(scene.layers.map((/** @type {any} */ layer) => layer.name));
    const kept = this.scene.layers.filter((/** @type {any} */ layer) => !names.has(layer.name));
    // lists that the scene leaves out stay as they are
    const lists = ["frames", "labels", "marks", "curves"].filter((list) => scene[list].length);
    const given = Object.fromEntries(lists.map((list) => [list, scene[list]]));
    const built = [...this.drawn.values()].filter((one) => !isAround(one.layer));
    const [low, high] = boxOf(built.map(({ points }) => points));
    this.scene = { ...this.scene, ...given, centre: shift, low, high, layers: [...kept, ...scene.layers] };
    if (given.labels) this.overlay.setLabels(scene.labels);
    for (const [palette, key] of this.palettes) this.colour(palette, key);
    this.select(this.selected);
    this.applyVisibility();
  }

  /** @param {any} layer */
  add(layer) {
    const one = drawLayer(layer);
    if (layer.like) one.source = this.drawn.get(layer.like) ?? null;
    one.setTheme(this.dark);
    if (this.plane && !isAround(layer)) one.clip([this.plane]);
    this.drawn.set(layer.name, one);
    this.three.add(one.object);
    this.renderer.shadowMap.needsUpdate = true;
  }

  /** @param {string} name */
  remove(name) {
    const one = this.drawn.get(name);
    this.three.remove(one.object);
    one.dispose();
    this.drawn.delete(name);
  }

  /** Distances that go with the size of what is there. */
  setLimits() {
    const size = reach(this.clouds());
    Object.assign(this.camera, { near: size * 0.01, far: size * 60 });
    Object.assign(this.controls, { minDistance: size * 0.03, maxDistance: size * 20 });
    const { low } = this.scene;
    this.sun.position.set(-0.45 * size, -0.75 * size, low[2] + 2.2 * size);
    this.sun.target.position.set(0, 0, low[2]);
    Object.assign(this.sun.shadow.camera, {
      left: -size,
      right: size,
      top: size,
      bottom: -size,
      near: 0.1 * size,
      far: 6 * size,
    });
    this.sun.shadow.camera.updateProjectionMatrix();
    this.cell = cellOf(this.scene);
  }

  /** Points that the camera has to see. */
  clouds() {
    const own = [...this.drawn.values()].filter(({ layer }) => layer.material !== "ground");
    const shown = own.filter((one) => !isAround(one.layer) || one.object.visible);
    return shown.map(({ points }) => points);
  }

  elementCount() {
    let count = 0;
    for (const { layer } of this.drawn.values()) if (layer.offsets) count += layer.count;
    return count;
  }

  /**
   * @param {string} group
   * @param {boolean} isShown
   */
  show(group, isShown) {
    this.groups.set(group, isShown);
    this.applyVisibility();
  }

  applyVisibility() {
    const isOn = (/** @type {any} */ layer) =>
      layer.groups.every((/** @type {string} */ group) => this.groups.get(group) ?? true);
    const hides = new Set(this.frames?.hides ?? []);
    const isHidden = (/** @type {any} */ layer) =>
      hides.has(layer.name) ||
      layer.groups.some((/** @type {string} */ group) => hides.has(`group:${group}`));
    const on = [...this.drawn.values()].filter(({ layer }) => isOn(layer) && !isHidden(layer));
    const replaced = new Set(on.flatMap(({ layer }) => layer.replaces));
    for (const one of this.drawn.values()) {
      one.isReplaced = replaced.has(one.layer.name);
      one.object.visible = on.includes(one) && !one.isReplaced;
      one.isPickable = on.includes(one);
    }
    this.renderer.shadowMap.needsUpdate = true;
    this.redraw();
  }

  /**
   * Colour all layers of a list by a quantity; "" by their material, "layer" by their own colour.
   *
   * @param {string} palette
   * @param {string} key
   */
  colour(palette, key) {
    this.palettes.set(palette, key);
    const likes = [];
    for (const one of this.drawn.values()) {
      if (one.source) likes.push(one);
      if (one.layer.palette !== palette) continue;
      const isOwn = this.frames?.layers.includes(one.layer) && this.frames.colour;
      const shown = isOwn ? this.frames.colour : key;
      one.colour(shown, this.valuesOf(one, shown));
    }
    likes.forEach((one) => one.repaint());
    this.redraw();
  }

  /**
   * Values of a layer's quantity in the frame that is shown.
   *
   * @param {any} one
   * @param {string} key
   */
  valuesOf(one, key) {
    return one.frameValues?.[key] ?? null;
  }

  /**
   * Show frames of a name, or what was designed.
   *
   * @param {string | null} name
   */
  setFrames(name) {
    for (const layer of this.frames?.layers ?? []) this.remove(layer.name);
    for (const motion of this.frames?.motions ?? []) this.rest(this.drawn.get(motion.layer));
    this.frames = this.scene.frames.find((/** @type {any} */ one) => one.name === name) ?? null;
    if (this.frames) {
      for (const layer of this.frames.layers) this.add(layer);
      this.exaggeration = this.frames.exaggeration;
      for (const layer of this.frames.layers)
        if (!layer.palette) this.drawn.get(layer.name).colour(this.frames.colour || layer.quantity);
      this.setFrame(this.frames.first);
    }
    this.applyVisibility();
    for (const [palette, key] of this.palettes) this.colour(palette, key);
  }

  /** @param {any} one */
  rest(one) {
    if (!one) return;
    one.frameValues = null;
    one.place(
      Float32Array.from(one.layer.kind === "instances" ? one.layer.origins : one.layer.positions),
      one.layer.normals ?? null,
    );
  }

  /**
   * @param {number} at between 0 and the number of frames less 1
   */
  setFrame(at) {
    if (!this.frames) return;
    this.frame = at;
    const place = around(this.frames, at);
    for (const motion of this.frames.motions) {
      const one = this.drawn.get(motion.layer);
      const { points, normals, values } = moved(motion, one, place, this.exaggeration);
      one.frameValues = values;
      one.place(points, normals);
      one.colour(one.key, this.valuesOf(one, one.key));
    }
    if (this.selected) this.select(this.selected);
    this.renderer.shadowMap.needsUpdate = true;
    this.redraw();
  }

  /** @param {number} factor */
  setExaggeration(factor) {
    this.exaggeration = factor;
    this.setFrame(this.frame);
  }

  /** What is said of the frame that is shown. */
  caption() {
    if (!this.frames) return "";
    const [before, after, share] = around(this.frames, this.frame);
    return this.frames.captions[share < 0.5 ? before : after] ?? "";
  }
}
