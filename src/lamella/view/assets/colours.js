// Colours of quantities and of materials, in linear RGB as three.js wants them.

const MISSING_COLOUR = "#8a8f96";
const LEVELS = 256;

/** What materials look like: colour on light and on dark ground, gloss, how wide the gloss is. */
export const LOOKS = {
  steel: { colours: ["#b4bbc3", "#a3abb5"], specular: "#6d7278", shininess: 45 },
  timber: { colours: ["#c79d6c", "#b98f5f"], specular: "#1c1812", shininess: 10 },
  fibre: { colours: ["#4d5359", "#5d646b"], specular: "#555a60", shininess: 60 },
  surface: { colours: ["#a9b6c6", "#5f6f84"], specular: "#000000", shininess: 1 },
  ground: { colours: ["#e3e5e3", "#2b3036"], specular: "#000000", shininess: 1 },
  person: { colours: ["#566270", "#97a2b0"], specular: "#000000", shininess: 1 },
  plain: { colours: ["#7b8796", "#8b96a4"], specular: "#1a1a1a", shininess: 10 },
};

/** @param {string} hex */
export const channels = (hex) => [1, 3, 5].map((start) => parseInt(hex.slice(start, start + 2), 16) / 255);

/** @param {number} c */
const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

/**
 * Linear RGB of a colour.
 *
 * @param {string} hex
 */
export const linearOf = (hex) => channels(hex).map(linear);

/**
 * Table of linear RGB for LEVELS + 1 entries, the last for missing values.
 *
 * @param {string[]} stops
 */
function lookup(stops) {
  const colours = stops.map(channels);
  const table = new Float32Array(3 * (LEVELS + 1));
  for (let level = 0; level < LEVELS; level++) {
    const place = (level / (LEVELS - 1)) * (colours.length - 1);
    const left = Math.min(Math.floor(place), Math.max(colours.length - 2, 0));
    const right = Math.min(left + 1, colours.length - 1);
    for (let k = 0; k < 3; k++)
      table[3 * level + k] = linear(
        colours[left][k] + (place - left) * (colours[right][k] - colours[left][k]),
      );
  }
  table.set(linearOf(MISSING_COLOUR), 3 * LEVELS);
  return table;
}

/**
 * A colour for each value of a quantity.
 *
 * @param {ArrayLike<number>} values
 * @param {{ stops: string[], low: number, high: number }} quantity
 */
export function paint(values, { stops, low, high }) {
  const table = lookup(stops);
  const scale = high > low ? (LEVELS - 1) / (high - low) : 0;
  const colours = new Float32Array(3 * values.length);
  for (let i = 0; i < values.length; i++) {
    const level = Number.isNaN(values[i])
      ? LEVELS
      : Math.round(Math.min(Math.max((values[i] - low) * scale, 0), LEVELS - 1));
    colours[3 * i] = table[3 * level];
    colours[3 * i + 1] = table[3 * level + 1];
    colours[3 * i + 2] = table[3 * level + 2];
  }
  return colours;
}

/**
 * One colour for all.
 *
 * @param {string} hex
 * @param {number} count
 */
export function even(hex, count) {
  const colour = linearOf(hex);
  const colours = new Float32Array(3 * count);
  for (let i = 0; i < colours.length; i++) colours[i] = colour[i % 3];
  return colours;
}
