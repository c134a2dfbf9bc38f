// What of a scene is shown and how: lists, switches, sliders. The same in report and studio.

import { byId, element } from "./dom.js";
import { legends } from "./legend.js";
import { format } from "./text.js";
import { VIEWS } from "./standpoint.js";
import { save } from "./exporting.js";

const FAMILY = "layer";
const VIEW_LABELS = { iso: "Fit", top: "Top", front: "Front", side: "Side", back: "Back", left: "Left" };

/**
 * Lists of colourings, switches of groups and labels; to be made anew with every scene.
 *
 * @param {any} viewer
 * @param {() => void} changed
 */
export function makeSwitches(viewer, changed) {
  // lamellas before the surface they stand on
  const lists = [...viewer.palettes.keys()].reverse().map((palette) => {
    const select = element("select", { id: `colour-${slug(palette)}`, "data-palette": palette });
    for (const [key, label] of colourings(viewer, palette))
      select.append(element("option", { value: key }, label));
    select.value = viewer.palettes.get(palette);
    select.addEventListener("change", () => {
      viewer.colour(palette, select.value);
      changed();
    });
    return element("label", { class: "field" }, `${palette} `, select);
  });
  const boxes = [...viewer.groups].map(([group, isShown]) =>
    switchOf(`show-${slug(group)}`, group, isShown, (on) => {
      viewer.show(group, on);
      changed();
    }),
  );
  for (const [name, { labels, shown }] of viewer.overlay.labels)
    boxes.push(switchOf(`label-${slug(name)}`, labels.label, shown, (on) => viewer.showLabels(name, on)));
  byId("lists").replaceChildren(...lists);
  byId("switches").replaceChildren(...boxes);
}

/** @param {string} text */
export const slug = (text) => text.toLowerCase().replace(/[^a-z0-9]+/g, "-");

/**
 * @param {string} id
 * @param {string} label
 * @param {boolean} isOn
 * @param {(on: boolean) => void} changed
 */
function switchOf(id, label, isOn, changed) {
  const box = element("input", { type: "checkbox", id });
  box.checked = isOn;
  box.addEventListener("change", () => changed(box.checked));
  return element("label", {}, box, ` ${label}`);
}

/**
 * What layers of a list can be coloured by: key and label.
 *
 * @param {any} viewer
 * @param {string} palette
 * @returns {Map<string, string>}
 */
export function colourings(viewer, palette) {
  const found = new Map();
  const layers = viewer.scene.layers.filter((/** @type {any} */ layer) => layer.palette === palette);
  // those of the last layer first: strips have more than centre lines
  for (const layer of [...layers].reverse())
    for (const { key, label } of layer.quantities) if (!found.has(key)) found.set(key, label);
  if (layers.some((/** @type {any} */ layer) => layer.colour)) found.set(FAMILY, "Family");
  const materials = new Set(layers.map((/** @type {any} */ layer) => layer.material));
  materials.delete("plain");
  if (materials.size)
    found.set("", materials.has("surface") ? "Plain" : `Material (${[...materials].join(", ")})`);
  return found;
}

/** @param {any} viewer */
export function showLegends(viewer) {
  byId("legends").replaceChildren(...legends(viewer));
}

/**
 * Buttons of views.
 *
 * @param {any} viewer
 */
export function makeViews(viewer) {
  const buttons = Object.keys(VIEWS).map((name) => {
    const label = VIEW_LABELS[/** @type {keyof typeof VIEW_LABELS} */ (name)] ?? name;
    const button = element("button", { type: "button", "data-view": name }, label);
    button.addEventListener("click", () => viewer.lookFrom(name));
    return button;
  });
  byId("buttons").replaceChildren(...buttons);
}

/**
 * Section plane, measuring, files.
 *
 * @param {any} viewer
 * @param {() => string} name of the project
 */
export function makeTools(viewer, name) {
  const [axis, at, flip] = [byId("section-axis"), byId("section-at"), byId("section-flip")];
  const cut = () => {
    at.disabled = flip.disabled = axis.value === "";
    viewer.setSection(axis.value ? { axis: axis.value, at: Number(at.value), flip: flip.checked } : null);
  };
  for (const input of [axis, at, flip]) input.addEventListener("input", cut);
  cut();
  const measure = byId("measure");
  measure.addEventListener("click", () => {
    const isOn = measure.getAttribute("aria-pressed") !== "true";
    measure.setAttribute("aria-pressed", String(isOn));
    byId("measured").textContent = isOn ? "click two nodes" : "";
    viewer.setMeasuring(isOn);
  });
  viewer.on("measure", (/** @type {string} */ text) => {
    byId("measured").textContent = text || "and a second one";
  });
  byId("save-png").addEventListener("click", async () => save(await viewer.picture(), `${name()}.png`));
  byId("save-glb").addEventListener("click", async () => {
    save(new Blob([await viewer.exportGlb()], { type: "model/gltf-binary" }), `${name()}.glb`);
  });
}

/**
 * The list of what can be shown, and its slider.
 *
 * @param {any} viewer
 * @param {() => void} changed
 */
export function makeFrames(viewer, changed) {
  const [choice, slider, caption, factor] = ["frames", "frame", "caption", "exaggeration"].map(byId);
  const { frames } = viewer.scene;
  byId("frames-bar").hidden = !frames.length;
  choice.replaceChildren(
    element("option", { value: "" }, "As designed"),
    ...frames.map((/** @type {any} */ one) => element("option", { value: one.name }, one.label)),
  );
  const tell = () => {
    const { frames: shown, frame } = viewer;
    for (const part of document.querySelectorAll("[data-needs=frames]"))
      /** @type {HTMLElement} */ (part).hidden = !shown;
    const moves = shown?.motions.some((/** @type {any} */ motion) => motion.displacements);
    byId("exaggeration-field").hidden = !moves;
    if (!shown) return;
    const nearest = Math.round(frame);
    const value = shown.unit ? `${format(shown.values[nearest])} ${shown.unit}` : "";
    caption.textContent = [value, viewer.caption()].filter(Boolean).join(" · ");
  };
  choice.onchange = () => {
    viewer.setFrames(choice.value || null);
    const { frames: shown } = viewer;
    if (shown) {
      Object.assign(slider, { min: 0, max: shown.values.length - 1, step: shown.continuous ? "any" : 1 });
      slider.value = shown.first;
      factor.value = shown.exaggeration;
    }
    tell();
    changed();
  };
  slider.oninput = () => {
    viewer.setFrame(Number(slider.value));
    tell();
  };
  factor.oninput = () => {
    if (Number.isFinite(factor.valueAsNumber)) viewer.setExaggeration(factor.valueAsNumber);
  };
  byId("play").onclick = () => play(viewer, slider, tell);
  tell();
}

/** Number of the film that runs. */
let film = 0;
const FILM_SECONDS = 6;

/**
 * Show all frames one after the other.
 *
 * @param {any} viewer
 * @param {any} slider
 * @param {() => void} tell
 */
function play(viewer, slider, tell) {
  const own = ++film;
  const { frames } = viewer;
  const last = frames.values.length - 1;
  const start = performance.now();
  const step = (/** @type {number} */ now) => {
    if (own !== film || viewer.frames !== frames) return;
    const share = Math.min((now - start) / (1000 * FILM_SECONDS), 1);
    const at = share * last;
    slider.value = frames.continuous ? at : Math.round(at);
    viewer.setFrame(Number(slider.value));
    tell();
    if (share < 1) requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}
