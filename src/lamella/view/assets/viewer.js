// A scene in 3D: what report, studio and notebook share.

import { drawLayer, pixelRatio, pairsOf } from "./drawn.js";
import { element } from "./dom.js";
import { glbOf } from "./exporting.js";
import { around, moved } from "./moving.js";
import { Overlay } from "./overlay.js";
import { nearestNode, pick } from "./pick.js";
import { fittingDistance, reach, turned, VIEWS } from "./standpoint.js";
import { pieceStarts, ruledPositions } from "./strips.js";

/** Elements up to which the pointer is followed. */
const HOVER_LIMIT = 60000;
const INK = ["#111418", "#ffffff"];

export class Viewer {
  /**
   * @param {HTMLElement} container
   * @param {{ dark?: boolean, label?: string }} options
   */
  constructor(container, { dark = false, label = "3D view" } = {}) {
    this.container = container;
    this.dark = dark;
    this.renderer = makeRenderer(container, label);
    this.canvas = this.renderer.domElement;
    this.three = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.sun = new THREE.DirectionalLight(0xffffff, 1.35);
    this.addLights();
    /** @type {Map<string, any>} */
    this.drawn = new Map();
    /** @type {any} */
    this.scene = { layers: [], frames: [], labels: [], marks: [], curves: [], low: [0, 0, 0], high: [0, 0, 0] };
    /** @type {Map<string, boolean>} */
    this.groups = new Map();
    /** @type {Map<string, string>} */
    this.palettes = new Map();
    /** @type {any} */
    this.frames = null;
    this.frame = 0;
    this.exaggeration = 1;
    this.overlay = new Overlay(container);
    this.highlight = new THREE.Group();
    this.marker = drawLayer(markerLayer());
    this.marker.object.visible = false;
    this.three.add(this.highlight, this.marker.object);
    /** @type {string | null} */
    this.selected = null;
    /** @type {any} */
    this.plane = null;
    this.isMeasuring = false;
    /** The named view that still fits the picture, until the reader turns or moves it. @type {string | null} */
    this.standpoint = "iso";
    /** @type {Map<string, Set<(value: any) => void>>} */
    this.listeners = new Map();
    this.isWaiting = false;
    this.connect();
    this.resize();
  }

  addLights() {
    const lamp = new THREE.DirectionalLight(0xffffff, 0.85);
    // a lamp that goes with the eye leaves no side of the model in the dark
    lamp.position.set(-0.5, 0.8, 1);
    this.camera.add(lamp);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0005;
    this.three.add(this.camera, this.sun, this.sun.target, new THREE.HemisphereLight(0xffffff, 0xb5aea5, 1.45));
  }

  connect() {
    this.controls.addEventListener("change", () => this.redraw());
    this.controls.addEventListener("start", () => {
      this.standpoint = null;
    });
    this.controls.addEventListener("end", () => this.emit("camera", this.camera));
    // at once, not in the next frame: resizing has emptied the canvas
    this.observer = new ResizeObserver(() => {
      this.resize();
      if (this.standpoint) this.lookFrom(this.standpoint);
      this.draw();
    });
    this.observer.observe(this.container);
    /** @type {number[] | null} */
    let down = null;
    this.canvas.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
      down = event.isPrimary ? this.place(event) : null;
    });
    this.canvas.addEventListener("pointerup", (/** @type {PointerEvent} */ event) => {
      const [x, y] = this.place(event);
      const isClick = down && Math.hypot(x - down[0], y - down[1]) < 5;
      down = null;
      if (isClick && event.button === 0) this.clicked(x, y);
    });
    let isHovering = false;
    this.canvas.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
      if (isHovering || event.buttons || event.pointerType === "touch" || !this.listeners.get("hover")?.size) return;
      if (this.elementCount() > HOVER_LIMIT) return;
      isHovering = true;
      const [x, y] = this.place(event);
      requestAnimationFrame(() => {
        isHovering = false;
        this.emit("hover", { picked: this.pick(x, y), x, y });
      });
    });
    for (const name of ["pointerleave", "pointerdown"])
      this.canvas.addEventListener(name, () => this.emit("hover", { picked: null, x: 0, y: 0 }));
  }

  /**
   * @param {string} name "pick", "hover", "draw", "camera", "measure"
   * @param {(value: any) => void} listener
   * @returns {() => void} takes it off again
   */
  on(name, listener) {
    const those = this.listeners.get(name) ?? new Set();
    this.listeners.set(name, those.add(listener));
    return () => those.delete(listener);
  }

  /**
   * @param {string} name
   * @param {any} value
   */
  emit(name, value) {
    this.listeners.get(name)?.forEach((listener) => listener(value));
  }

  // ------------------------------------------------------------------------------- scene

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
      if (layer.palette && !this.palettes.has(layer.palette)) this.palettes.set(layer.palette, layer.quantity);
    }
    const names = new Set(scene.layers.map((/** @type {any} */ layer) => layer.name));
    const kept = this.scene.layers.filter((/** @type {any} */ layer) => !names.has(layer.name));
    this.scene = { ...scene, centre: shift, layers: [...kept, ...scene.layers] };
    if (scene.labels.length) this.overlay.setLabels(scene.labels);
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
    Object.assign(this.sun.shadow.camera, { left: -size, right: size, top: size, bottom: -size, near: 0.1 * size, far: 6 * size });
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

  // ------------------------------------------------------------------------------- what is seen

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
      hides.has(layer.name) || layer.groups.some((/** @type {string} */ group) => hides.has(`group:${group}`));
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

  /** @param {boolean} dark */
  setTheme(dark) {
    this.dark = dark;
    for (const one of this.drawn.values()) one.setTheme(dark);
    this.select(this.selected);
    this.redraw();
  }

  // ------------------------------------------------------------------------------- frames

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
    one.place(Float32Array.from(one.layer.kind === "instances" ? one.layer.origins : one.layer.positions), one.layer.normals ?? null);
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

  // ------------------------------------------------------------------------------- section, measuring

  /**
   * Cut what is there open.
   *
   * @param {{ axis: "x" | "y" | "z", at: number, flip?: boolean } | null} section `at` from 0 to 1 of what is there
   */
  setSection(section) {
    this.plane = null;
    if (section) {
      const k = "xyz".indexOf(section.axis);
      const [low, high] = [this.scene.low[k], this.scene.high[k]];
      const place = low + section.at * (high - low);
      const normal = new THREE.Vector3().setComponent(k, section.flip ? 1 : -1);
      this.plane = new THREE.Plane(normal, section.flip ? -place : place);
    }
    for (const one of this.drawn.values()) if (!isAround(one.layer)) one.clip(this.plane ? [this.plane] : null);
    this.select(this.selected);
    this.redraw();
  }

  /** @param {any} point */
  isSeen(point) {
    return !this.plane || this.plane.distanceToPoint(point) >= 0;
  }

  /** @param {boolean} isMeasuring */
  setMeasuring(isMeasuring) {
    this.isMeasuring = isMeasuring;
    this.overlay.ends = [];
    this.canvas.classList.toggle("measuring", isMeasuring);
    this.redraw();
  }

  /**
   * @param {string} name
   * @param {boolean} isShown
   */
  showLabels(name, isShown) {
    const labels = this.overlay.labels.get(name);
    if (labels) labels.shown = isShown;
    this.redraw();
  }

  // ------------------------------------------------------------------------------- pointing

  /**
   * @param {number} x
   * @param {number} y
   */
  clicked(x, y) {
    if (!this.isMeasuring) return this.emit("pick", this.pick(x, y));
    const found = this.nearestNode(x, y) ?? this.pick(x, y);
    if (!found) return;
    const ends = this.overlay.ends;
    this.overlay.ends = ends.length < 2 ? [...ends, found.point] : [found.point];
    this.emit("measure", this.overlay.ends.length === 2 ? this.overlay.distance() : "");
    this.redraw();
  }

  pickable() {
    return [...this.drawn.values()].filter((one) => one.isPickable && (one.layer.owner || one.layer.kind === "strips"));
  }

  /**
   * What is at a place in the canvas, pixels from its corner.
   *
   * @param {number} x
   * @param {number} y
   */
  pick(x, y) {
    return pick(this.pickable(), this.caster(x, y), (point) => this.isSeen(point), this.onScreen(), x, y);
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  nearestNode(x, y) {
    return nearestNode(this.pickable(), (point) => this.isSeen(point), this.onScreen(), x, y);
  }

  /** @param {PointerEvent} event */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  ray(event) {
    const [x, y] = this.place(event);
    return this.caster(x, y);
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  caster(x, y) {
    const caster = new THREE.Raycaster();
    const { clientWidth, clientHeight } = this.container;
    caster.setFromCamera(new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    return caster;
  }

  /** Function to the pixels of a point, and its depth. */
  onScreen() {
    const place = new THREE.Vector3();
    const { clientWidth, clientHeight } = this.container;
    return (/** @type {ArrayLike<number>} */ points, /** @type {number} */ i) => {
      place.set(points[3 * i], points[3 * i + 1], points[3 * i + 2]).project(this.camera);
      return [((place.x + 1) * clientWidth) / 2, ((1 - place.y) * clientHeight) / 2, place.z];
    };
  }

  /**
   * Outline what has an id, once hidden by what is before it and once faintly through everything.
   *
   * @param {string | null} id
   */
  select(id) {
    this.selected = id;
    this.highlight.children.forEach((/** @type {any} */ lines) => lines.geometry.dispose());
    this.highlight.clear();
    const found = id === null ? null : this.curve(id);
    if (found) {
      const clippingPlanes = this.plane ? [this.plane] : null;
      const { pairs, width } = outline(found);
      const color = INK[this.dark ? 1 : 0];
      const front = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 };
      const through = { transparent: true, opacity: 0.35, depthTest: false };
      for (const options of [front, through]) {
        const geometry = new THREE.LineSegmentsGeometry();
        geometry.setPositions(pairs);
        const material = new THREE.LineMaterial({ linewidth: width, color, clippingPlanes, ...options });
        this.highlight.add(new THREE.LineSegments2(geometry, material));
      }
    }
    this.redraw();
  }

  /**
   * The drawn curve with an id: of strips rather than of lines.
   *
   * @param {string} id
   */
  curve(id) {
    let found = null;
    for (const one of this.drawn.values()) {
      const index = one.layer.offsets && one.isPickable !== false ? one.layer.ids.indexOf(id) : -1;
      if (index >= 0 && (!found || one.layer.kind === "strips")) found = { one, index };
    }
    return found;
  }

  /**
   * Mark a sample of the curve with an id.
   *
   * @param {string | null} id
   * @param {number} local
   */
  mark(id, local = 0) {
    const found = id === null ? null : this.curve(id);
    this.marker.object.visible = Boolean(found);
    if (found) {
      const sample = found.one.layer.offsets[found.index] + local;
      this.markAt(Array.from(found.one.points.subarray(3 * sample, 3 * sample + 3)));
    }
    this.redraw();
  }

  /** @param {number[] | null} point */
  markAt(point) {
    this.marker.object.visible = Boolean(point);
    this.marker.dark = this.dark;
    this.marker.mesh.material.color.set(INK[this.dark ? 1 : 0]);
    if (point) this.marker.place(Float32Array.from(point), null);
    this.redraw();
  }

  // ------------------------------------------------------------------------------- camera

  /** @param {string} name */
  lookFrom(name) {
    this.standpoint = name;
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(...VIEWS[name]).normalize();
    this.camera.lookAt(this.controls.target);
    this.camera.position.multiplyScalar(fittingDistance(this.camera, this.clouds()));
    this.moved();
  }

  fit() {
    this.lookFrom(this.standpoint ?? "iso");
  }

  /**
   * Look at a point from nearby.
   *
   * @param {number[]} point
   * @param {number} radius of what is to be seen, m
   */
  goTo(point, radius) {
    this.standpoint = null;
    const away = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.fromArray(point);
    const distance = Math.max(radius / Math.tan((this.camera.fov * Math.PI) / 360), this.controls.minDistance);
    this.camera.position.copy(this.controls.target).addScaledVector(away, distance);
    this.moved();
  }

  /**
   * @param {number} azimuth
   * @param {number} elevation
   */
  turn(azimuth, elevation) {
    this.standpoint = null;
    turned(this.camera, this.controls.target, azimuth, elevation, 1);
    this.moved();
  }

  /** @param {number} factor */
  zoom(factor) {
    this.standpoint = null;
    turned(this.camera, this.controls.target, 0, 0, factor);
    this.moved();
  }

  moved() {
    this.controls.update();
    this.camera.updateProjectionMatrix();
    this.redraw();
    this.emit("camera", this.camera);
  }

  // ------------------------------------------------------------------------------- drawing

  redraw() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.isWaiting = false;
    const distance = this.camera.position.distanceTo(this.controls.target);
    const { clientWidth, clientHeight } = this.container;
    const cellPixels = ((this.cell ?? 0) * clientHeight) / (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360));
    for (const one of this.drawn.values()) if (one.layer.kind === "points") one.fit(cellPixels);
    this.renderer.render(this.three, this.camera);
    this.overlay.draw(this.onScreen(), (point) => this.isSeen(point), clientWidth, clientHeight);
    this.emit("draw", this);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.container;
    if (!width || !height) return;
    this.renderer.setPixelRatio(pixelRatio());
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /**
   * PNG of what is shown.
   *
   * @param {{ width?: number, height?: number }} size pixels; those of the view when not given
   * @returns {Promise<Blob>}
   */
  async picture({ width, height } = {}) {
    if (width && height) {
      this.renderer.setPixelRatio(1);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.three, this.camera);
    const blob = await new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
    this.resize();
    this.draw();
    return /** @type {Blob} */ (blob);
  }

  /** Binary glTF of what is shown. */
  exportGlb() {
    return glbOf([...this.drawn.values()].filter((one) => one.object.visible && !isAround(one.layer)));
  }

  dispose() {
    this.observer?.disconnect();
    for (const name of [...this.drawn.keys()]) this.remove(name);
    this.marker.dispose();
    this.controls.dispose();
    this.overlay.dispose();
    this.renderer.dispose();
    this.canvas.remove();
  }
}

/**
 * Throws where the browser has no WebGL.
 *
 * @param {HTMLElement} container
 * @param {string} label
 */
function makeRenderer(container, label) {
  // the drawing has to outlive its frame to be printed
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setClearAlpha(0);
  renderer.localClippingEnabled = true;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.shadowMap.autoUpdate = false;
  for (const [key, value] of Object.entries({ tabindex: "0", role: "img", "aria-label": label }))
    renderer.domElement.setAttribute(key, value);
  container.prepend(renderer.domElement);
  return renderer;
}

/** Message in place of a view that cannot be. */
export function noView() {
  const text = "This browser offers no WebGL, which the 3D view needs. Tables and plots work without it.";
  return element("p", { class: "message" }, text);
}

/** @param {any} layer */
const isAround = (layer) => layer.material === "ground" || layer.material === "person";

const markerLayer = () => ({
  kind: "points",
  name: "marker",
  groups: [],
  replaces: [],
  ids: [],
  quantities: [],
  quantity: "",
  material: "plain",
  colour: INK[0],
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
function cellOf(scene) {
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
function recentred(layer, from, to) {
  const places = layer.kind === "instances" ? layer.origins : layer.positions;
  if (from.every((value, k) => value === to[k])) return;
  for (let i = 0; i < places.length; i++) places[i] += from[i % 3] - to[i % 3];
}

/**
 * Lines about a curve: the edges of a strip, or the curve itself.
 *
 * @param {{ one: any, index: number }} found
 */
function outline({ one, index }) {
  const { layer } = one;
  const [first, end] = [layer.offsets[index], layer.offsets[index + 1]];
  const points = one.points.subarray(3 * first, 3 * end);
  if (layer.kind !== "strips") return { pairs: pairsOf(points, pieceStarts([0, end - first])), width: 5 };
  const edges = ruledPositions(layer, points, one.normals.subarray(3 * first, 3 * end));
  const corner = (/** @type {number} */ sample, /** @type {number} */ side) =>
    Array.from(edges.subarray(6 * sample + 3 * side, 6 * sample + 3 * side + 3));
  const last = end - first - 1;
  const pairs = [...corner(0, 0), ...corner(0, 1), ...corner(last, 0), ...corner(last, 1)];
  for (let i = 0; i < last; i++) for (const side of [0, 1]) pairs.push(...corner(i, side), ...corner(i + 1, side));
  return { pairs: new Float32Array(pairs), width: 2.2 };
}
