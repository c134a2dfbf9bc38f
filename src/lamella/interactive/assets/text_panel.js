// The project's text: edited beside the view, with errors at their lines and help on the key under the cursor.

import { byId, element } from "./dom.js";

const PAUSE_MS = 450;

export class TextPanel {
  /**
   * @param {(text: string) => void} changed
   * @param {(kind: string) => Promise<Record<string, { help: string, unit: string }>>} helpOf
   */
  constructor(changed, helpOf) {
    this.area = byId("text");
    this.kind = "";
    /** @type {Record<string, { help: string, unit: string }>} */
    this.help = {};
    this.helpOf = helpOf;
    this.line = 0;
    this.timer = 0;
    this.area.addEventListener("input", () => {
      this.number();
      clearTimeout(this.timer);
      this.timer = setTimeout(() => {
        this.timer = 0;
        changed(this.area.value);
      }, PAUSE_MS);
    });
    this.area.addEventListener("scroll", () => {
      byId("numbers").scrollTop = this.area.scrollTop;
    });
    for (const name of ["keyup", "click", "focus"]) this.area.addEventListener(name, () => this.tellHelp());
  }

  /**
   * @param {string} text
   * @param {string} kind of surface
   */
  async set(text, kind) {
    // what is being typed is newer
    if (!this.timer && this.area.value !== text) {
      const { selectionStart, selectionEnd, scrollTop } = this.area;
      this.area.value = text;
      this.area.setSelectionRange(selectionStart, selectionEnd);
      this.area.scrollTop = scrollTop;
    }
    this.number();
    if (kind && kind !== this.kind) {
      this.kind = kind;
      this.help = await this.helpOf(kind);
    }
  }

  /** @param {number} line with a mistake; 0: none */
  mark(line) {
    this.line = line;
    this.number();
  }

  number() {
    const count = this.area.value.split("\n").length;
    const numbers = Array.from({ length: count }, (_, k) => (k + 1 === this.line ? element("b", {}, String(k + 1)) : String(k + 1)));
    byId("numbers").replaceChildren(...numbers.flatMap((one) => [one, "\n"]), "\n\n");
    byId("numbers").scrollTop = this.area.scrollTop;
  }

  /** What the key under the cursor means. */
  tellHelp() {
    const before = this.area.value.slice(0, this.area.selectionStart).split("\n");
    const here = this.area.value.split("\n")[before.length - 1] ?? "";
    let table = "";
    for (const line of [...before.slice(0, -1), here]) {
      const header = /^\s*\[+\s*([^\]]+?)\s*\]/.exec(line);
      if (header) table = header[1];
    }
    const key = /^\s*([\w.-]+)\s*=/.exec(here)?.[1];
    const path = [table, key].filter(Boolean).join(".");
    const found = this.help[path];
    const told = byId("text-help");
    if (!found) told.textContent = "Put the cursor on a key for what it means.";
    else told.replaceChildren(element("b", {}, path), found.unit ? ` [${found.unit}]  ` : "  ", found.help);
  }
}
