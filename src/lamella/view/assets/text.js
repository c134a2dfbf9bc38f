// Numbers as people read them.

/**
 * A number with some digits, "–" where it is none.
 *
 * @param {number} value
 * @param {number} digits
 */
export function format(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text =
    size < 1e-3 || size >= 1e6
      ? value
          .toExponential(digits - 1)
          .replace(
            /e([+-])(\d+)$/,
            (_, sign, power) => ` · 10${superscript((sign === "-" ? "-" : "") + power)}`,
          )
      : value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size))));
  return text.replace(/^-/, "−");
}

/** @param {string} text */
function superscript(text) {
  return text.replace(/./g, (character) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[/** @type {any} */ (character)] ?? "⁻");
}

/**
 * Round numbers that divide low..high in about `count` steps, and how they are written.
 *
 * @param {number} low
 * @param {number} high
 * @param {number} count
 * @returns {{ ticks: number[], text: (value: number) => string }}
 */
export function niceTicks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step =
    [1, 2, 2.5, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.999) ??
    rough;
  const decimals = Math.max(
    0,
    -Math.floor(Math.log10(step) + 1e-9) + (Math.abs(step / power - 2.5) < 1e-9 ? 1 : 0),
  );
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(k * step);
  return {
    ticks,
    text: (value) =>
      step < 1e-5 || step >= 1e6
        ? format(value, 2)
        : value
            .toFixed(decimals)
            .replace(/^-(?=0(\.0*)?$)/, "")
            .replace("-", "−"),
  };
}

/**
 * Smallest and largest of some numbers; 0 and 0 where there is none.
 *
 * @param {ArrayLike<number>} values
 * @returns {[number, number]}
 */
export function extent(values) {
  let low = Infinity,
    high = -Infinity;
  for (let i = 0; i < values.length; i++) {
    if (values[i] < low) low = values[i];
    if (values[i] > high) high = values[i];
  }
  return low <= high ? [low, high] : [0, 0];
}
