// three.min.js is a classic script that gives what three.entry.js names.
import type * as entry from "../../src/lamella/view/assets/three.entry.js";

declare global {
  const THREE: typeof entry;
}
