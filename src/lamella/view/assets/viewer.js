// A scene in 3D: what report, studio and notebook share.

import { drawLayer } from "./drawn.js";
import { glbOf } from "./exporting.js";
import { isAround, markerLayer } from "./layers.js";
import { outline } from "./outline.js";
import { nearestNode, pick } from "./pick.js";
import { SceneView } from "./scene_view.js";

/** Elements up to which the pointer is followed. */
const HOVER_LIMIT = 60000;
const INK = ["#111418", "#ffffff"];

export class Viewer extends SceneView {
  /**
   * @param {HTMLElement} container
   * @param {{ dark?: boolean, label?: string }} options
   */
  constructor(container, options = {}) {
    super(container, options);
    this.highlight = new THREE.Group();
    this.marker = drawLayer(markerLayer());
    this.marker.object.visible = false;
    this.three.add(this.highlight, this.marker.object);
    this.isMeasuring = false;
    this.connect();
  }

  connect() {
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
      if (isHovering || event.buttons || event.pointerType === "touch" || !this.listeners.get("hover")?.size)
        return;
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

  /** @param {boolean} dark */
  setTheme(dark) {
    this.dark = dark;
    for (const one of this.drawn.values()) one.setTheme(dark);
    this.select(this.selected);
    this.redraw();
  }

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
    for (const one of this.drawn.values())
      if (!isAround(one.layer)) one.clip(this.plane ? [this.plane] : null);
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
    return [...this.drawn.values()].filter(
      (one) => one.isPickable && (one.layer.owner || one.layer.kind === "strips"),
    );
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

  draw() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const { clientWidth, clientHeight } = this.container;
    const tall = 2 * distance * Math.tan((this.camera.fov * Math.PI) / 360);
    for (const one of this.drawn.values())
      if (one.layer.kind === "points") one.fit((this.cell * clientHeight) / tall);
    super.draw();
    this.overlay.draw(this.onScreen(), (point) => this.isSeen(point), clientWidth, clientHeight);
  }

  /** Binary glTF of what is shown. */
  exportGlb() {
    return glbOf([...this.drawn.values()].filter((one) => one.object.visible && !isAround(one.layer)));
  }

  dispose() {
    for (const name of [...this.drawn.keys()]) this.remove(name);
    this.marker.dispose();
    this.overlay.dispose();
    super.dispose();
  }
}
