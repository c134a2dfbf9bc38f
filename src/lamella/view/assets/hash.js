// What is shown, in the address: "#A3&colour=twist" is { lamella: "A3", colour: "twist" }.

/** @returns {Record<string, string>} */
export function readHash() {
  /** @type {Record<string, string>} */
  const parameters = {};
  for (const part of location.hash.slice(1).split("&").filter(Boolean)) {
    const [key, value] = part.split("=");
    if (value === undefined) parameters.lamella = decodedPart(key);
    else parameters[key] = decodedPart(value);
  }
  return parameters;
}

/** @param {string} text */
function decodedPart(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

/** @param {Record<string, string | undefined>} parameters */
export function writeHash({ lamella, ...others }) {
  const parts = Object.entries(others)
    .filter(([, value]) => value !== undefined)
    .map(([key, value]) => `${encodeURIComponent(key)}=${encodeURIComponent(/** @type {string} */ (value))}`);
  if (lamella !== undefined) parts.unshift(encodeURIComponent(lamella));
  const hash = parts.join("&");
  if (hash === location.hash.slice(1)) return;
  try {
    history.replaceState(null, "", `#${hash}`);
  } catch {
    // a page inside another one (a notebook) may not touch its address; nothing depends on it
  }
}
