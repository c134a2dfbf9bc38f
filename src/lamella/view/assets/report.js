// The page of a run.

import { bytesOf, decodeScene } from "./decode.js";
import { byId } from "./dom.js";
import { colourings, makeFrames, makeSwitches, makeTools, makeViews, showLegends, slug } from "./controls.js";
import { readHash, writeHash } from "./hash.js";
import { createPanel, worstOf } from "./panel.js";
import { format } from "./text.js";
import { drawTriad } from "./triad.js";
import { VIEWS } from "./standpoint.js";
import { noView } from "./stage.js";
import { Viewer } from "./viewer.js";

const QUARTER = Math.PI / 24;
/** Of what is seen about the place of a warning, cells of the net. */
const NEARBY = 4;

function start() {
  const scene = decodeScene(bytesOf(byId("scene").textContent));
  const curves = scene.curves[0] ?? null;
  const preference = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () =>
    /** @type {Record<string, boolean>} */ ({ dark: true, light: false })[readHash().theme] ??
    preference.matches;
  const stage = byId("stage");
  /** @type {any} */
  let viewer = null;
  applyTheme();
  try {
    viewer = new Viewer(stage, { dark: isDark(), label: "3D view of the surface and its lamellas" });
  } catch {
    stage.append(noView());
  }
  /** Colourings at first, which the address does not tell. */
  const first = new Map();
  /** @type {number | null} */
  let selected = null;
  const panel = curves
    ? createPanel(curves, (curve, local) => viewer?.mark(curve === null ? null : curves.ids[curve], local))
    : null;

  function applyTheme() {
    document.documentElement.style.colorScheme =
      /** @type {Record<string, string>} */ ({ dark: "dark", light: "light" })[readHash().theme] ?? "";
  }

  /** @param {number | null} curve */
  function select(curve) {
    selected = curve;
    panel?.show(curve);
    viewer?.mark(null);
    viewer?.select(curve === null ? null : curves.ids[curve]);
    tellAddress();
  }

  /** @param {number} by */
  function step(by) {
    if (!panel) return;
    const count = curves.ids.length;
    select(selected === null ? (by > 0 ? 0 : count - 1) : (selected + by + count) % count);
  }

  function tellAddress() {
    /** @type {Record<string, string | undefined>} */
    const parameters = { ...readHash(), lamella: selected === null ? undefined : curves.ids[selected] };
    for (const [palette, key] of viewer?.palettes ?? []) {
      parameters[slug(palette)] = key === first.get(palette) ? undefined : key || "material";
    }
    writeHash(parameters);
  }

  function changed() {
    showLegends(viewer);
    tellAddress();
  }

  /** Selection, colours and what is seen from the address; the named ones only. */
  function applyHash() {
    const parameters = readHash();
    applyTheme();
    if (viewer) applyView(parameters);
    if (!panel) return;
    const index = curves.ids.indexOf(parameters.lamella);
    if (index >= 0) select(index);
    else select(parameters.lamella === "none" ? null : worstOf(curves));
  }

  /** @param {Record<string, string>} parameters */
  function applyView(parameters) {
    viewer.setTheme(isDark());
    for (const palette of viewer.palettes.keys()) {
      const wanted = parameters[slug(palette)];
      const key = wanted === "material" ? "" : wanted;
      viewer.colour(palette, colourings(viewer, palette).has(key) ? key : first.get(palette));
    }
    for (const group of viewer.groups.keys()) {
      const wanted = parameters[`show-${slug(group)}`];
      if (wanted !== undefined) viewer.show(group, wanted !== "0");
    }
    makeSwitches(viewer, changed);
    viewer.lookFrom(parameters.view in VIEWS ? parameters.view : "iso");
    if (scene.frames.some((/** @type {any} */ one) => one.name === parameters.frames)) {
      byId("frames").value = parameters.frames;
      byId("frames").onchange();
      if (parameters.frame) {
        byId("frame").value = parameters.frame;
        byId("frame").oninput();
      }
    }
    showLegends(viewer);
  }

  function connectView() {
    viewer.setScene(scene);
    for (const [palette, key] of viewer.palettes) first.set(palette, key);
    for (const id of ["toolbar", "buttons", "hint", "tools"]) byId(id).hidden = false;
    makeViews(viewer);
    makeTools(viewer, () => slug(scene.name) || "lamella");
    makeFrames(viewer, changed);
    viewer.on("draw", () => drawTriad(byId("triad"), viewer.camera));
    viewer.on("pick", (/** @type {any} */ picked) => {
      const curve = picked && panel ? curves.ids.indexOf(picked.id) : -1;
      if (curve >= 0) select(curve);
    });
    viewer.on("hover", showTip);
    viewer.canvas.addEventListener("keydown", onKey);
    connectWarnings();
    preference.addEventListener("change", () => {
      viewer.setTheme(isDark());
      showLegends(viewer);
    });
    addEventListener("beforeprint", () => {
      viewer.setTheme(false);
      viewer.draw();
    });
    addEventListener("afterprint", () => viewer.setTheme(isDark()));
  }

  /** Links from warnings to the places they speak of. */
  function connectWarnings() {
    for (const item of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-warning]"))) {
      const mark = scene.marks.find((/** @type {any} */ one) => one.key === item.dataset.warning);
      if (!mark || !mark.positions.length) continue;
      const count = mark.positions.length / 3;
      let next = 0;
      const link = document.createElement("button");
      link.type = "button";
      link.className = "place";
      link.textContent = count > 1 ? `show (${count})` : "show";
      link.addEventListener("click", () => {
        const point = Array.from(mark.positions.subarray(3 * next, 3 * next + 3));
        const index = mark.ids.length && panel ? curves.ids.indexOf(mark.ids[next] ?? mark.ids[0]) : -1;
        next = (next + 1) % count;
        if (index >= 0) select(index);
        viewer.goTo(point, NEARBY * (viewer.cell || 1));
        viewer.markAt(point);
        stage.scrollIntoView({ block: "nearest" });
      });
      item.append(" ", link);
    }
  }

  /** @param {any} found */
  function showTip({ picked, x, y }) {
    const tip = byId("tip");
    tip.hidden = !picked;
    viewer.canvas.style.cursor = picked ? "pointer" : "";
    if (!picked) return;
    const one = viewer.drawn.get(picked.layer);
    const { quantity } = one;
    const values = quantity && (one.values ?? quantity.values);
    tip.textContent = picked.id + (values ? `  ${format(values[picked.element])} ${quantity.unit}` : "");
    tip.style.left = `${Math.min(x + 14, stage.clientWidth - tip.offsetWidth - 4)}px`;
    tip.style.top = `${Math.max(y - 30, 4)}px`;
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    /** @type {Record<string, [number, number]>} */
    const turns = {
      ArrowLeft: [-QUARTER, 0],
      ArrowRight: [QUARTER, 0],
      ArrowUp: [0, QUARTER],
      ArrowDown: [0, -QUARTER],
    };
    if (event.shiftKey && turns[event.key]) viewer.turn(...turns[event.key]);
    else if (event.key === "+" || event.key === "=") viewer.zoom(0.85);
    else if (event.key === "-") viewer.zoom(1 / 0.85);
    else if (event.key === "0") viewer.lookFrom("iso");
    else return;
    event.preventDefault();
  }

  function connectPanel() {
    if (!panel) return;
    byId("lamella-choice").addEventListener("change", (/** @type {any} */ event) =>
      select(event.target.value === "" ? null : Number(event.target.value)),
    );
    byId("previous").addEventListener("click", () => step(-1));
    byId("next").addEventListener("click", () => step(1));
    byId("worst").hidden = !curves.worst;
    byId("worst").textContent = curves.worst;
    byId("worst").addEventListener("click", () => select(worstOf(curves)));
    document.addEventListener("keydown", (/** @type {any} */ event) => {
      const isTyping =
        event.target.closest?.("select, input") ||
        event.ctrlKey ||
        event.metaKey ||
        event.altKey ||
        event.shiftKey;
      const by = { ArrowLeft: -1, ArrowRight: 1 }[/** @type {string} */ (event.key)];
      if (isTyping) return;
      if (event.key === "Escape") select(null);
      else if (by) step(by);
    });
  }

  if (viewer) connectView();
  for (const part of /** @type {NodeListOf<HTMLElement>} */ (
    document.querySelectorAll("[data-needs=curves]")
  ))
    part.hidden = !curves;
  connectPanel();
  applyHash();
  addEventListener("hashchange", applyHash);
  Object.assign(window, { lamellaViewer: viewer });
}

start();
