// Sliders with number fields, and lists, for what has no handle in the view.

import { byId, element } from "./dom.js";

/** Of a slider's reach. */
const STEPS = 500;
const PAUSE_MS = 60;

export class Fields {
  /** @param {(kind: "drag" | "edit", edit: any) => void} changed */
  constructor(changed) {
    this.changed = changed;
    this.shape = "";
    /** @type {Map<string, any>} */
    this.rows = new Map();
    /** Values that were there when a slider was taken. @type {Map<string, number>} */
    this.taken = new Map();
  }

  /** @param {any[]} fields */
  set(fields) {
    const shape = JSON.stringify(fields.map(({ path, kind, group, label, choices }) => [path, kind, group, label, choices]));
    if (shape !== this.shape) this.make(fields);
    this.shape = shape;
    for (const field of fields) this.rows.get(keyOf(field))?.(field);
  }

  /** @param {any[]} fields */
  make(fields) {
    this.rows.clear();
    const groups = new Map();
    for (const field of fields) {
      // its buttons stand beside the misses
      if (field.path.join(".") === "network.closing") continue;
      const row = field.kind === "choice" ? this.choice(field) : this.number(field);
      groups.set(field.group, [...(groups.get(field.group) ?? []), row]);
    }
    byId("fields").replaceChildren(
      ...[...groups].map(([name, rows]) => element("section", { class: "fields" }, element("h2", {}, name), ...rows)),
    );
  }

  /** @param {any} field */
  choice(field) {
    const select = element("select", { "aria-label": field.label, title: field.help ?? "" });
    for (const value of field.choices) select.append(element("option", { value }, value));
    select.addEventListener("change", () => this.changed("edit", { do: "set", values: [[field.path, select.value]] }));
    this.rows.set(keyOf(field), (/** @type {any} */ { value }) => {
      select.value = value;
    });
    return element("div", { class: "row choice" }, element("label", { title: field.help ?? "" }, field.label), select);
  }

  /** @param {any} field */
  number(field) {
    const key = keyOf(field);
    const box = element("input", { type: "number", step: field.kind === "integer" ? 1 : "any", "aria-label": field.label });
    const slider = element("input", { type: "range", "aria-label": `${field.label}, slider`, "data-key": key });
    let timer = 0;
    const edit = (/** @type {number} */ value) => this.editOf(field, value, this.taken.get(key) ?? value);
    slider.addEventListener("pointerdown", () => this.taken.set(key, Number(box.value)));
    slider.addEventListener("input", () => {
      if (!this.taken.has(key)) this.taken.set(key, Number(box.value));
      box.value = slider.value;
      if (timer) return;
      timer = setTimeout(() => {
        timer = 0;
        if (this.taken.has(key)) this.changed("drag", edit(Number(slider.value)));
      }, PAUSE_MS);
    });
    slider.addEventListener("change", () => {
      const last = edit(Number(slider.value));
      this.taken.delete(key);
      this.changed("edit", last);
    });
    box.addEventListener("focus", () => this.taken.set(key, Number(box.dataset.value)));
    box.addEventListener("blur", () => this.taken.delete(key));
    box.addEventListener("change", () => {
      if (!Number.isFinite(box.valueAsNumber)) return;
      this.changed("edit", this.editOf(field, box.valueAsNumber, Number(box.dataset.value)));
    });
    this.rows.set(key, (/** @type {any} */ now) => {
      box.dataset.value = now.value;
      // what is being pulled is not pulled away
      if (this.taken.has(key) && document.activeElement !== box) return;
      const step = field.kind === "integer" ? 1 : stepOf((now.max - now.min) / STEPS);
      Object.assign(slider, { min: now.min, max: now.max, step });
      slider.value = now.value;
      if (document.activeElement !== box) box.value = rounded(now.value);
    });
    const label = element("label", { title: field.help ?? "" }, field.label);
    if (field.unit) label.append(element("small", {}, ` ${field.unit}`));
    return element("div", { class: "row" }, label, box, slider);
  }

  /**
   * @param {any} field
   * @param {number} value
   * @param {number} before of what is in the history
   */
  editOf(field, value, before) {
    if (field.shift !== undefined) return { do: "shift", loop: field.shift, by: [0, 0, value - before] };
    const own = field.kind === "integer" ? Math.round(value) : value;
    return { do: "set", values: [[field.path, own], ...(field.without ?? []).map((/** @type {any} */ path) => [path, null])] };
  }
}

/** @param {any} field */
const keyOf = ({ path, shift }) => path.join(".") + (shift === undefined ? "" : " height");

/** @param {number} value */
const rounded = (value) => String(Number(value.toPrecision(6)));

/**
 * A round number near to a step.
 *
 * @param {number} wanted
 */
function stepOf(wanted) {
  const power = 10 ** Math.floor(Math.log10(wanted || 1e-3));
  return Number((power * (wanted / power < 2 ? 1 : wanted / power < 5 ? 2 : 5)).toPrecision(1));
}
