// Scenes as lamella.view.scene.encode writes them.

const READERS = { f4: Float32Array, i2: Int16Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
const MAGIC = 0x43534d4c; // "LMSC"
const HEAD = 8;
const MISSING = 65535;
const UNIT = 32767;

/**
 * @typedef {Record<string, any>} Decoded
 */

/**
 * The scene in some bytes: its arrays are typed arrays, missing numbers NaN.
 *
 * @param {ArrayBuffer} buffer
 * @returns {Decoded}
 */
export function decodeScene(buffer) {
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new Error("these bytes are no scene");
  const length = view.getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, HEAD, length)));
  return revived(header, buffer, HEAD + length);
}

/**
 * @param {any} value
 * @param {ArrayBuffer} buffer
 * @param {number} body
 * @returns {any}
 */
function revived(value, buffer, body) {
  if (Array.isArray(value)) return value.map((item) => revived(item, buffer, body));
  if (value === null || typeof value !== "object") return value;
  if (typeof value.type === "string" && typeof value.count === "number") return arrayOf(value, buffer, body);
  return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, revived(item, buffer, body)]));
}

/**
 * @param {Decoded} spec
 * @param {ArrayBuffer} buffer
 * @param {number} body
 */
function arrayOf(spec, buffer, body) {
  if (spec.type === "constant") return new Float32Array(spec.count).fill(spec.value ?? NaN);
  const raw = new READERS[/** @type {keyof typeof READERS} */ (spec.type)](
    buffer,
    body + spec.at,
    spec.count,
  );
  if (spec.step !== undefined)
    return Float32Array.from(raw, (level) => (level === MISSING ? NaN : spec.low + level * spec.step));
  return spec.type === "i2" ? Float32Array.from(raw, (level) => level / UNIT) : raw;
}

/**
 * Bytes of a text in base64.
 *
 * @param {string} text
 * @returns {ArrayBuffer}
 */
export function bytesOf(text) {
  const characters = atob(text.trim());
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes.buffer;
}
