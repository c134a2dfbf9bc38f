// A loop drawn point by point on the ground.

import { svg } from "./dom.js";

export class Sketch {
  /**
   * @param {SVGElement} root
   * @param {any} view
   * @param {(count: number) => void} changed
   */
  constructor(root, view, changed) {
    this.view = view;
    this.changed = changed;
    /** @type {number[][]} */
    this.points = [];
    this.isOn = false;
    this.path = svg("path", { class: "sketch" });
    root.prepend(this.path);
    root.addEventListener("click", (/** @type {MouseEvent} */ event) => {
      if (this.isOn) this.add(event);
    });
    view.viewer.on("draw", () => this.draw());
  }

  /** @param {boolean} isOn */
  set(isOn) {
    this.isOn = isOn;
    this.points = [];
    this.view.viewer.container.classList.toggle("sketches", isOn);
    if (isOn) this.view.viewer.lookFrom("top");
    this.changed(0);
    this.draw();
  }

  /** @param {any} event */
  add(event) {
    const { viewer } = this.view;
    const ground = this.view.inside([0, 0, 0])[2];
    const plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), -ground);
    const met = viewer.ray(event).ray.intersectPlane(plane, new THREE.Vector3());
    if (!met) return;
    this.points.push(this.view.outside(met));
    this.changed(this.points.length);
    this.draw();
  }

  draw() {
    const onScreen = this.view.viewer.onScreen();
    const places = this.points.map((point) => onScreen(this.view.inside(point), 0).slice(0, 2).map((/** @type {number} */ value) => value.toFixed(1)));
    const dots = places.map(([x, y]) => `M${x} ${y} m-3 0 a3 3 0 1 0 6 0 a3 3 0 1 0 -6 0`).join(" ");
    this.path.setAttribute("d", places.length ? `M${places.map((one) => one.join(" ")).join(" L")} Z ${dots}` : "");
  }
}
