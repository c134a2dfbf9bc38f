// A camera, lights and a canvas; a scene is put in by whoever extends it.

import { pixelRatio } from "./drawn_base.js";
import { element } from "./dom.js";
import { fittingDistance, turned, VIEWS } from "./standpoint.js";

export class Stage {
  /**
   * @param {HTMLElement} container
   * @param {string} label
   */
  constructor(container, label) {
    this.container = container;
    this.renderer = makeRenderer(container, label);
    this.canvas = this.renderer.domElement;
    this.three = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.sun = new THREE.DirectionalLight(0xffffff, 1.35);
    this.addLights();
    /** The named view that still fits the picture, until the reader turns or moves it. @type {string | null} */
    this.standpoint = "iso";
    /** @type {Map<string, Set<(value: any) => void>>} */
    this.listeners = new Map();
    this.isWaiting = false;
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
    this.observer.observe(container);
    this.resize();
  }

  /**
   * Points that the camera has to see.
   *
   * @returns {Float32Array[]}
   */
  clouds() {
    return [];
  }

  addLights() {
    const lamp = new THREE.DirectionalLight(0xffffff, 0.85);
    // a lamp that goes with the eye leaves no side of the model in the dark
    lamp.position.set(-0.5, 0.8, 1);
    this.camera.add(lamp);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0005;
    this.three.add(
      this.camera,
      this.sun,
      this.sun.target,
      new THREE.HemisphereLight(0xffffff, 0xb5aea5, 1.45),
    );
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
    caster.setFromCamera(
      new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight),
      this.camera,
    );
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

  /** @param {string} name */
  lookFrom(name) {
    this.standpoint = name;
    this.controls.target.set(0, 0, 0);
    this.camera.position.fromArray(VIEWS[name]).normalize();
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
    const distance = Math.max(
      radius / Math.tan((this.camera.fov * Math.PI) / 360),
      this.controls.minDistance,
    );
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

  redraw() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => this.draw());
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

  draw() {
    this.isWaiting = false;
    this.renderer.render(this.three, this.camera);
    this.emit("draw", this);
  }

  dispose() {
    this.observer.disconnect();
    this.controls.dispose();
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
