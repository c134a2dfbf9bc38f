// The page of the studio: what the server tells goes into the view and the panels, what is done goes to the server.

import { makeSwitches, makeViews, showLegends } from "./controls.js";
import { DesignView } from "./design_view.js";
import { byId, element } from "./dom.js";
import { Fields } from "./fields.js";
import { showFigures, showMisses, showWarnings } from "./figures.js";
import { boxOf, Handles } from "./handles.js";
import { Link } from "./link.js";
import { Sketch } from "./sketch.js";
import { TextPanel } from "./text_panel.js";
import { drawTriad } from "./triad.js";
import { noView } from "./stage.js";

const BASE = document.body.dataset.base ?? "/";
const REFUSED_MS = 7000;
const LEAST_POINTS = 3;
/** Of a new hole's radius, the boundary's size. */
const HOLE = 0.08;
/** Of what is seen about the place of a warning, m over the size of the design. */
const NEARBY = 0.12;
const WAYS = { open: "Leave open", round: "Round", adjust: "Adjust" };
/** @type {Record<string, string>} */
const LOCK_KEYS = { g: "ground", x: "x", y: "y", z: "z", s: "screen" };

/** What the server has told last. @type {any} */
const known = { state: null, status: {}, frame: null, exact: {} };
const preference = matchMedia("(prefers-color-scheme: dark)");

function start() {
  const view = new DesignView(byId("stage"), preference.matches);
  const link = new Link(`${location.origin.replace(/^http/, "ws")}${BASE}socket`, received, (isOpen) => {
    byId("ended").hidden = isOpen;
  });
  const options = {
    lock: () => byId("lock").value,
    snap: () => Number(byId("snap").value),
    symmetry: () => byId("symmetry").value,
  };
  const handles = new Handles(byId("handles"), view, options, moved, showChosen);
  const sketch = new Sketch(byId("handles"), view, (count) => {
    byId("sketch-count").textContent = count ? `number ${count}` : "missing";
    byId("sketch-close").disabled = byId("sketch-hole").disabled = count < LEAST_POINTS;
  });
  const fields = new Fields((kind, edit) => link.send(kind, { edit }));
  const text = new TextPanel(
    (content) => link.send("text", { text: content }),
    async (kind) => (await fetch(`${BASE}help/${encodeURIComponent(kind)}`)).json(),
  );

  // ------------------------------------------------------------------------------- what is told

  /** @param {any} message */
  function received(message) {
    const actions = { state: showState, status: showStatus, frame: showFrame, refused: showRefused };
    if (message.type === "pinned") view.pin(message);
    else if (message.type === "unpinned") view.pin(null);
    else actions[/** @type {keyof typeof actions} */ (message.type)]?.(message);
  }

  /** @param {any} state */
  function showState(state) {
    known.state = state;
    byId("name").textContent = state.name;
    document.title = `${state.saved ? "" : "● "}${state.name} – lamella studio`;
    byId("file").textContent = state.file;
    byId("file").classList.toggle("unsaved", !state.saved);
    byId("undo").disabled = !state.can_undo;
    byId("redo").disabled = !state.can_redo;
    byId("save").disabled = state.saved;
    byId("left").hidden = !state.left;
    for (const id of ["pin-back", "pin-drop"]) byId(id).hidden = !state.pinned;
    handles.set(state.handles);
    fields.set(state.fields);
    for (const button of document.querySelectorAll(".films")) /** @type {any} */ (button).disabled = state.kind !== "form-found";
    showClosing();
    if (known.frame) showFigures(known.frame, state.before, state.pinned, known.exact);
    text.set(state.text, state.kind);
  }

  /** @param {any} status */
  function showStatus(status) {
    known.status = status;
    const { busy, problem, run } = status;
    byId("busy").hidden = !busy;
    if (busy) byId("busy").textContent = busy.text + (busy.fraction ? ` ${Math.round(100 * busy.fraction)} %` : "");
    byId("stage").classList.toggle("stale", Boolean(problem));
    byId("problem").hidden = !problem;
    if (problem) {
      const where = problem.line ? `Line ${problem.line}${problem.where ? `, ${problem.where}` : ""}` : problem.where;
      byId("problem").replaceChildren(element("b", {}, where || "There is no such design"), problem.message, ...(problem.remedy ? [element("br"), element("span", {}, `Remedy: ${problem.remedy}`)] : []));
    }
    text.mark(problem?.line ?? 0);
    showRun(run);
    if (status.closing) link.isClosed = true;
  }

  /** @param {any} frame */
  function showFrame(frame) {
    known.frame = frame;
    if (view.show(frame)) {
      makeSwitches(view.viewer, () => showLegends(view.viewer));
      showLegends(view.viewer);
    } else if (frame.level === "coarse") showLegends(view.viewer);
    const last = known.exact;
    showFigures(frame, known.state?.before ?? {}, known.state?.pinned ?? null, last);
    if (frame.level === "exact") known.exact = frame.figures;
    showMisses(frame, closing(), goTo);
    showWarnings(frame, goTo);
    handles.place();
    document.body.dataset.frame = String(frame.number);
    document.body.dataset.level = frame.level;
    document.body.dataset.revision = String(frame.revision);
  }

  let refusing = 0;
  /** @param {any} refused */
  function showRefused({ message, remedy, where, of }) {
    const notice = byId("refused");
    notice.replaceChildren(remedy ? `${message}. ${remedy}.` : message);
    if (where === "changed" && of === "save") {
      const button = element("button", { type: "button" }, "Save anyway");
      button.addEventListener("click", () => {
        notice.hidden = true;
        link.send("save", { name: wanted ?? undefined, anyway: true });
      });
      notice.append(button);
    }
    notice.hidden = false;
    clearTimeout(refusing);
    refusing = setTimeout(() => (notice.hidden = true), REFUSED_MS);
  }

  const closing = () => known.state?.fields.find((/** @type {any} */ one) => one.path.join(".") === "network.closing")?.value ?? "open";

  function showClosing() {
    const buttons = Object.entries(WAYS).map(([value, label]) => {
      const button = element("button", { type: "button", "aria-pressed": String(value === closing()) }, label);
      button.disabled = value === "adjust" && known.state.kind !== "form-found";
      button.addEventListener("click", () => link.send("edit", { edit: { do: "set", values: [[["network", "closing"], value]] } }));
      return button;
    });
    byId("closing-ways").replaceChildren(...buttons);
  }

  /** @param {number[]} point in the drawing, m */
  function goTo(point) {
    const inside = view.inside(point);
    view.viewer.goTo(inside, NEARBY * (known.frame?.size ?? 1));
    view.viewer.markAt(inside);
  }

  // ------------------------------------------------------------------------------- what is done

  /**
   * @param {"drag" | "edit" | "drop"} kind
   * @param {Record<string, number[]>} places
   */
  function moved(kind, places) {
    if (kind === "drop") link.send("drop");
    else link.send(kind, { edit: { do: "move", handles: places } });
  }

  /** @param {any} handle */
  function showChosen(handle) {
    byId("chosen").hidden = !handle;
    if (!handle) return;
    const loop = known.state?.loops[handle.loop];
    byId("chosen-name").textContent = `${loop?.name ?? ""} ${handle.kind === "point" ? (handle.index >= 0 ? handle.index + 1 : "") : handle.kind}`;
    ["x", "y", "z"].forEach((axis, k) => {
      const box = byId(`at-${axis}`);
      if (document.activeElement !== box) box.value = String(Number(handle.at[k].toFixed(5)));
    });
    byId("insert-point").hidden = byId("delete-point").hidden = handle.index < 0;
    byId("remove-loop").hidden = handle.loop === 0;
  }

  /** @type {string | null} */
  let wanted = null;
  /** @type {Record<string, () => void>} */
  const buttons = {
    undo: () => link.send("undo"),
    redo: () => link.send("redo"),
    save: () => {
      wanted = null;
      link.send("save");
    },
    "save-as": () => {
      byId("save-name").value = known.state?.file ?? "";
      byId("save-dialog").showModal();
    },
    pin: () => link.send("pin"),
    "pin-back": () => link.send("pin", { what: "back" }),
    "pin-drop": () => link.send("pin", { what: "drop" }),
    restore: () => link.send("restore"),
    forget: () => link.send("forget"),
    run: () => {
      byId("run-dialog").showModal();
      if (!known.status.run?.running) link.send("run");
    },
    "run-cancel": () => link.send("cancel"),
    "run-close": () => byId("run-dialog").close(),
    "show-text": () => {
      const isOn = byId("text-panel").hidden;
      byId("text-panel").hidden = !isOn;
      byId("show-text").setAttribute("aria-pressed", String(isOn));
    },
    "to-ground": () => {
      const handle = handles.current && handles.of(handles.current);
      if (handle) handles.put([handle.at[0], handle.at[1], 0]);
    },
    "insert-point": () => withChosen(({ loop, index }) => ({ do: "insert_point", loop, after: index })),
    "delete-point": () => withChosen(({ loop, index }) => ({ do: "delete_point", loop, index })),
    "remove-loop": () => withChosen(({ loop }) => ({ do: "remove_loop", loop })),
    "add-hole": addHole,
    sketch: () => setSketch(!sketch.isOn),
    "sketch-cancel": () => setSketch(false),
    "sketch-close": () => endSketch("outer"),
    "sketch-hole": () => endSketch("hole"),
  };

  /** @param {(handle: any) => any} editOf */
  function withChosen(editOf) {
    const handle = handles.current && handles.of(handles.current);
    if (handle) link.send("edit", { edit: editOf(handle) });
  }

  function addHole() {
    const { low, high } = boxOf(known.state.handles.filter((/** @type {any} */ one) => one.loop === 0));
    const size = Math.hypot(high[0] - low[0], high[1] - low[1]);
    // beside the middle where that is taken
    const beside = known.state.loops.length > 1 ? 0.25 * (high[0] - low[0]) : 0;
    const center = [(low[0] + high[0]) / 2 + beside, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
    link.send("edit", { edit: { do: "add_hole", center, radius: HOLE * size } });
  }

  /** @param {boolean} isOn */
  function setSketch(isOn) {
    handles.choose(null);
    sketch.set(isOn);
    byId("sketching").hidden = !isOn;
    byId("sketch").setAttribute("aria-pressed", String(isOn));
  }

  /** @param {"outer" | "hole"} as */
  function endSketch(as) {
    link.send("edit", { edit: { do: "sketch", as, points: sketch.points } });
    setSketch(false);
  }

  /** @param {any} run */
  function showRun(run) {
    if (!run) return;
    const lines = byId("run-lines");
    lines.textContent = run.lines.join("\n") + (run.cancelled ? "\ncancelled, nothing written" : "");
    lines.scrollTop = lines.scrollHeight;
    byId("run-cancel").hidden = !run.running;
    byId("run-report").hidden = !run.report;
    if (run.report) byId("run-report").href = `${BASE}${run.report}`;
  }

  for (const [id, action] of Object.entries(buttons)) byId(id).addEventListener("click", action);
  for (const axis of ["x", "y", "z"])
    byId(`at-${axis}`).addEventListener("change", () => {
      const to = ["x", "y", "z"].map((one) => byId(`at-${one}`).valueAsNumber);
      if (to.every(Number.isFinite)) handles.put(to);
    });
  byId("save-dialog").addEventListener("close", (/** @type {any} */ event) => {
    if (event.target.returnValue !== "save") return;
    wanted = byId("save-name").value;
    link.send("save", { name: wanted });
  });
  addEventListener("keydown", onKey);
  makeViews(view.viewer);
  view.viewer.on("draw", () => drawTriad(byId("triad"), view.viewer.camera));
  view.viewer.canvas.addEventListener("pointerdown", () => handles.choose(null));
  preference.addEventListener("change", () => {
    view.setTheme(preference.matches);
    showLegends(view.viewer);
  });
  Object.assign(window, { lamellaStudio: { view, link, handles, known } });

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    const isTyping = /** @type {HTMLElement} */ (event.target).closest?.("textarea, input, select, dialog");
    const key = event.key.toLowerCase();
    const isCommand = event.ctrlKey || event.metaKey;
    if (isCommand && key === "s") buttons.save();
    else if (isCommand && key === "z" && !isTyping) link.send(event.shiftKey ? "redo" : "undo");
    else if (isCommand && key === "y" && !isTyping) link.send("redo");
    else if (isCommand || isTyping || event.altKey) return;
    else if (LOCK_KEYS[key]) byId("lock").value = LOCK_KEYS[key];
    else if ((key === "delete" || key === "backspace") && handles.current) buttons["delete-point"]();
    else return;
    event.preventDefault();
  }
}

try {
  start();
} catch (error) {
  byId("stage").append(noView());
  throw error;
}
