// Handles of the boundary over the view: dragged with locks, snap and a symmetric partner, or typed in.

import { svg } from "./dom.js";

/** Between two messages of a drag, ms. */
const PAUSE_MS = 40;
/** Of the boundary's size: nearer than that a handle is another one's mirror image. */
const PARTNER = 2e-3;
/** @type {Record<string, number[]>} */
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
/** @type {Record<string, number[]>} */
const NORMALS = { ground: [0, 0, 1], xz: [0, 1, 0], yz: [1, 0, 0] };
const KINDS = { point: "circle", center: "diamond", radius: "square", normal: "tilt", shift: "diamond" };

export class Handles {
  /**
   * @param {SVGElement} root
   * @param {any} view
   * @param {{ lock: () => string, snap: () => number, symmetry: () => string }} options
   * @param {(kind: "drag" | "edit" | "drop", handles: Record<string, number[]>) => void} moved
   * @param {(handle: any) => void} chosen
   */
  constructor(root, view, options, moved, chosen) {
    this.root = root;
    this.view = view;
    this.options = options;
    this.moved = moved;
    this.chosen = chosen;
    /** @type {any[]} */
    this.all = [];
    this.grips = new Map();
    /** @type {any} */
    this.drag = null;
    /** @type {string | null} */
    this.current = null;
    view.viewer.on("draw", () => this.place());
    addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.drag) this.end(false);
    });
  }

  /** @param {any[]} all */
  set(all) {
    this.all = all;
    const ids = new Set(all.map(({ id }) => id));
    for (const [id, grip] of this.grips) {
      if (ids.has(id)) continue;
      grip.remove();
      this.grips.delete(id);
    }
    for (const handle of all) if (!this.grips.has(handle.id)) this.add(handle);
    if (this.current && !ids.has(this.current)) this.choose(null);
    else if (this.current) this.chosen(this.of(this.current));
    this.place();
  }

  /** @param {string} id */
  of(id) {
    return this.all.find((one) => one.id === id) ?? null;
  }

  /** @param {any} handle */
  add({ id, kind }) {
    const group = svg("g", { class: "handle", "data-id": id, tabindex: "0", role: "button", "aria-label": id });
    group.append(svg("circle", { class: "hit", r: 13 }), shapeOf(KINDS[/** @type {keyof typeof KINDS} */ (kind)]));
    group.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => this.begin(event, id));
    group.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => this.move(event));
    group.addEventListener("pointerup", () => this.end(true));
    group.addEventListener("pointercancel", () => this.end(false));
    group.addEventListener("focus", () => this.choose(id));
    this.grips.set(id, group);
    this.root.append(group);
  }

  /** @param {string | null} id */
  choose(id) {
    this.current = id;
    for (const [name, grip] of this.grips) grip.classList.toggle("chosen", name === id);
    this.chosen(id === null ? null : this.of(id));
  }

  /** Where the handles are on the screen. */
  place() {
    const onScreen = this.view.viewer.onScreen();
    for (const { id, at } of this.all) {
      const [x, y, z] = onScreen(this.view.inside(at), 0);
      const grip = this.grips.get(id);
      grip.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
      grip.style.display = Math.abs(z) < 1 ? "" : "none";
    }
  }

  /**
   * @param {PointerEvent} event
   * @param {string} id
   */
  begin(event, id) {
    if (event.button !== 0) return;
    const handle = this.of(id);
    this.choose(id);
    this.grips.get(id).setPointerCapture(event.pointerId);
    this.grips.get(id).classList.add("dragged");
    this.view.viewer.controls.enabled = false;
    const start = new THREE.Vector3().fromArray(this.view.inside(handle.at));
    this.drag = { id, start, partners: this.partners(handle), to: null, sent: 0, timer: 0 };
    this.drag.from = this.met(event) ?? start.clone();
    event.stopPropagation();
    event.preventDefault();
    this.grips.get(id).focus({ preventScroll: true });
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (!this.drag) return;
    const met = this.met(event);
    if (!met) return;
    const to = this.drag.start.clone().add(met).sub(this.drag.from);
    this.drag.to = this.snapped(this.view.outside(to), this.of(this.drag.id)?.at);
    this.tell();
  }

  /** Send where it is, not more often than every so many ms. */
  tell() {
    const { drag } = this;
    if (!drag.to || drag.timer) return;
    const wait = Math.max(PAUSE_MS - (performance.now() - drag.sent), 0);
    drag.timer = setTimeout(() => {
      drag.timer = 0;
      if (this.drag !== drag) return;
      drag.sent = performance.now();
      this.moved("drag", this.all_(drag));
    }, wait);
  }

  /** @param {boolean} isDone */
  end(isDone) {
    const { drag } = this;
    if (!drag) return;
    this.drag = null;
    clearTimeout(drag.timer);
    this.grips.get(drag.id)?.classList.remove("dragged");
    this.view.viewer.controls.enabled = true;
    if (!drag.to) return;
    if (isDone) this.moved("edit", this.all_(drag));
    else this.moved("drop", {});
  }

  /**
   * The places of what is dragged, and of its partners.
   *
   * @param {any} drag
   */
  all_({ id, to, partners }) {
    /** @type {Record<string, number[]>} */
    const places = { [id]: to };
    for (const { other, mirror } of partners) places[other] = mirror(to);
    return places;
  }

  /**
   * Type coordinates in.
   *
   * @param {number[]} to
   */
  put(to) {
    const handle = this.current && this.of(this.current);
    if (handle) this.moved("edit", this.all_({ id: handle.id, to, partners: this.partners(handle) }));
  }

  /**
   * Where the pointer is on the line or plane of the lock, in the viewer's coordinates.
   *
   * @param {PointerEvent} event
   */
  met(event) {
    const { viewer } = this.view;
    const { ray } = viewer.ray(event);
    const lock = this.options.lock();
    const { start } = this.drag;
    if (lock in AXES) {
      const axis = new THREE.Vector3(...AXES[lock]);
      // the plane through the axis that faces the eye
      const normal = axis.clone().cross(ray.direction).cross(axis).normalize();
      const place = this.cut(ray, normal, start);
      return place && start.clone().addScaledVector(axis, place.sub(start).dot(axis));
    }
    const normal = NORMALS[lock] ? new THREE.Vector3(...NORMALS[lock]) : viewer.camera.getWorldDirection(new THREE.Vector3());
    return this.cut(ray, normal, start);
  }

  /**
   * @param {any} ray
   * @param {any} normal
   * @param {any} through
   */
  cut(ray, normal, through) {
    // a plane that is seen from its edge leads to infinity
    if (Math.abs(ray.direction.dot(normal)) < 0.02) return null;
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
    return ray.intersectPlane(plane, new THREE.Vector3());
  }

  /**
   * @param {number[]} place
   * @param {number[] | undefined} before
   */
  snapped(place, before) {
    const step = this.options.snap();
    if (!(step > 0)) return place;
    return place.map((value, k) => (before && Math.abs(value - before[k]) < 1e-9 ? value : Math.round(value / step) * step));
  }

  /**
   * Handles that move as the mirror images of one.
   *
   * @param {any} handle
   */
  partners(handle) {
    const wanted = this.options.symmetry();
    if (!wanted) return [];
    const { low, high } = boxOf(this.all);
    const middle = low.map((value, k) => (value + high[k]) / 2);
    const size = Math.hypot(...low.map((value, k) => high[k] - value));
    /** @type {Record<string, number[][]>} */
    const signs = { x: [[-1, 1]], y: [[1, -1]], xy: [[-1, 1], [1, -1], [-1, -1]], c: [[-1, -1]] };
    return signs[wanted].flatMap(([sx, sy]) => {
      const mirror = (/** @type {number[]} */ [x, y, z]) => [
        sx < 0 ? 2 * middle[0] - x : x,
        sy < 0 ? 2 * middle[1] - y : y,
        z,
      ];
      const image = mirror(handle.at);
      const other = this.all.find(
        (one) => one.kind === handle.kind && one.id !== handle.id && apart(one.at, image) < PARTNER * size,
      );
      return other ? [{ other: other.id, mirror }] : [];
    });
  }
}

/** @param {any[]} all */
export function boxOf(all) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const { at, kind } of all) {
    if (kind === "normal") continue;
    at.forEach((/** @type {number} */ value, /** @type {number} */ k) => {
      low[k] = Math.min(low[k], value);
      high[k] = Math.max(high[k], value);
    });
  }
  return { low, high };
}

/**
 * @param {number[]} one
 * @param {number[]} other
 */
const apart = (one, other) => Math.hypot(...one.map((value, k) => value - other[k]));

/** @param {string} name */
function shapeOf(name) {
  if (name === "circle") return svg("circle", { class: "grip", r: 5.5 });
  if (name === "square") return svg("rect", { class: "grip", x: -5, y: -5, width: 10, height: 10, rx: 1.5 });
  const d = name === "tilt" ? "M0 -7 L6.5 5 L-6.5 5 Z" : "M0 -7.5 L7.5 0 L0 7.5 L-7.5 0 Z";
  return svg("path", { class: "grip", d });
}
