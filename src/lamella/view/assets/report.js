(() => {
  "use strict";

  // -------------------------------------------------------------------------------- data

  const READERS = { f4: Float32Array, i2: Int16Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
  const MISSING = 65535;

  function bytesOf(text) {
    return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  }

  /** Typed array of an encoded one; quantised numbers come back as floats, missing ones as NaN. */
  function decode(spec) {
    if (spec.type === "constant") return new Float64Array(spec.count).fill(spec.value ?? NaN);
    const values = new READERS[spec.type](bytesOf(spec.data).buffer);
    if (spec.step === undefined) return values;
    return Float64Array.from(values, (level) => (level === MISSING ? NaN : spec.low + level * spec.step));
  }

  function decodeAll(record) {
    if (!record) return null;
    const isEncoded = (value) => value !== null && typeof value === "object" && "type" in value;
    return Object.fromEntries(
      Object.entries(record).map(([key, value]) => [key, isEncoded(value) ? decode(value) : value]),
    );
  }

  function readData() {
    const raw = JSON.parse(document.getElementById("data").textContent);
    return {
      ...raw,
      surface: { ...decodeAll(raw.surface), colourings: raw.surface.colourings.map(decodeAll) },
      network: decodeAll(raw.network),
      lamellas: decodeAll(raw.lamellas),
      built: raw.built && {
        strips: raw.built.strips.map(decodeAll),
        hardware: raw.built.hardware.map(decodeAll),
      },
    };
  }

  function extent(values) {
    let low = Infinity,
      high = -Infinity;
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return low <= high ? [low, high] : [0, 0];
  }

  const largest = (values) => Math.max(...extent(values).map(Math.abs));

  // -------------------------------------------------------------------------------- text

  function format(value, digits = 3) {
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

  function superscript(text) {
    return text.replace(/./g, (character) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[character] ?? "⁻");
  }

  const byId = (id) => document.getElementById(id);

  /** DOM element with attributes; text always goes in as text, never as HTML. */
  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  function svg(tag, attributes = {}, ...children) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  // -------------------------------------------------------------------------------- colours

  const FAMILY_COLOURS = { A: "#2374b8", B: "#e07a2d" };
  const RAMPS = {
    // Dark to bright at even steps of lightness, so that it also reads without hues.
    magnitude: ["#2b2f8f", "#6d2da6", "#b23a8e", "#e2616a", "#f7953f", "#f5d547"],
    // The ends are the colours of the families: A twists with tg > 0, B with tg < 0.
    signed: [FAMILY_COLOURS.B, "#eab68d", "#d9dade", "#8fb2d2", FAMILY_COLOURS.A],
    // Pure red from 0.005 on, as in the paper.
    planarity: ["#e9e6e1", "#f3b9a4", "#f87a63", "#ff0000"],
  };
  const MISSING_COLOUR = "#8a8f96";
  const LEVELS = 256;

  const channels = (hex) => [1, 3, 5].map((start) => parseInt(hex.slice(start, start + 2), 16) / 255);
  const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

  /** Table of linear RGB for LEVELS + 1 entries, the last for missing values. */
  function lookup(stops) {
    const colours = stops.map(channels);
    const table = new Float32Array(3 * (LEVELS + 1));
    for (let level = 0; level < LEVELS; level++) {
      const place = (level / (LEVELS - 1)) * (colours.length - 1);
      const left = Math.min(Math.floor(place), Math.max(colours.length - 2, 0));
      const right = Math.min(left + 1, colours.length - 1);
      for (let k = 0; k < 3; k++) {
        table[3 * level + k] = linear(
          colours[left][k] + (place - left) * (colours[right][k] - colours[left][k]),
        );
      }
    }
    table.set(channels(MISSING_COLOUR).map(linear), 3 * LEVELS);
    return table;
  }

  function paint(values, { stops, domain: [low, high] }) {
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

  function signedDomain(values) {
    const size = largest(values);
    return [-size, size];
  }

  /** Ways to colour the lamellas: key, label, unit, values at the samples, colour scale. */
  function lamellaColourings(network, strips) {
    if (!network) return [];
    const upTo = (values, high) => ({ values, domain: [0, high] });
    const magnitude = (values, high = largest(values)) => ({ ...upTo(values, high), stops: RAMPS.magnitude });
    const torsion = network.geodesicTorsion;
    const family = { key: "family", label: "Family" };
    const twist = { key: "twist", label: "Geodesic torsion (twist) tg", unit: "1/m", values: torsion };
    const ofNetwork = [
      { ...twist, stops: RAMPS.signed, domain: signedDomain(torsion) },
      {
        key: "geodesic",
        label: "Geodesic curvature |kg|",
        unit: "1/m",
        ...magnitude(network.geodesicCurvature.map(Math.abs)),
      },
    ];
    if (!strips) return [family, ...ofNetwork];
    const utilisation = magnitude(strips.utilisation, Math.min(1, largest(strips.utilisation)));
    const planarity = { stops: RAMPS.planarity, ...upTo(strips.planarity, 0.005) };
    return [
      { key: "utilisation", label: "Utilisation", unit: "of strength", ...utilisation },
      { key: "mises", label: "Von Mises stress", unit: "MPa", ...magnitude(strips.vonMises) },
      { key: "layer", label: "Stress of layers beside", unit: "MPa", ...magnitude(strips.layer) },
      ...ofNetwork,
      { key: "planarity", label: "Planarity score", unit: "", ...planarity },
      family,
    ];
  }

  /** Ways to colour the surface, as lamella.view.quantity describes them. */
  function surfaceColourings(surface) {
    const ofVertices = surface.colourings.map(({ low, high, ...colouring }) => ({
      ...colouring,
      domain: [low, high],
    }));
    return [{ key: "plain", label: "Plain" }, ...ofVertices];
  }

  // -------------------------------------------------------------------------------- legends

  function swatch(colour, text, dot = false) {
    const patch = element("i", dot ? { class: "dot" } : {});
    patch.style.background = colour;
    return element("span", { class: "swatch" }, patch, text);
  }

  function legend(title, unit, ...content) {
    return element(
      "div",
      { class: "legend" },
      element("h3", {}, title, element("span", {}, unit ? `  ${unit}` : "")),
      ...content,
    );
  }

  /** Colours of a quantity; `least` and `most` (its extent) may lie beyond them, and the ends then say so. */
  function rampLegend({
    label,
    unit,
    stops,
    values,
    domain: [low, high],
    remark = "",
    least = extent(values)[0],
    most = extent(values)[1],
  }) {
    if (low === high)
      return legend(label, unit, swatch(stops[0], `${format(low, 4)} ${remark || "everywhere"}`));
    const bar = element("div", { class: "bar" });
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    const ticks = element("div", { class: "ticks" });
    const span = high - low;
    const round = niceTicks(low, high, 5);
    const beyond = [least < low - 1e-6 * span, most > high + 1e-6 * span];
    const marks = round.ticks.map((value) => [(value - low) / span, round.text(value)]);
    // An end with values beyond it is labelled, and room made for that longer label.
    const shown = marks.filter(([place]) => !(beyond[0] && place < 0.25) && !(beyond[1] && place > 0.75));
    if (beyond[0]) shown.unshift([0, `≤ ${format(low, 2)}`]);
    if (beyond[1]) shown.push([1, `≥ ${format(high, 2)}`]);
    for (const [place, text] of shown) {
      const tick = element("span", { class: place < 0.02 ? "first" : place > 0.96 ? "last" : "" }, text);
      tick.style.left = `${100 * place}%`;
      ticks.append(tick);
    }
    const about = `(${format(least)} to ${format(most)})${remark && ` · ${remark}`}`;
    return legend(label, [unit, about].filter(Boolean).join(" "), bar, ticks);
  }

  function familyLegend() {
    const swatches = element(
      "div",
      { class: "swatches" },
      swatch(FAMILY_COLOURS.A, "A (tg > 0)"),
      swatch(FAMILY_COLOURS.B, "B (tg < 0)"),
    );
    return legend("Family", "", swatches);
  }

  // -------------------------------------------------------------------------------- 3D view

  // Largest and least size on the screen (pixels), and by what share of its distance each is drawn nearer.
  const NODE_STYLES = [
    { label: "regular", colour: ["#39424e", "#d5dbe3"], size: 3.5, least: 0.6, nearer: 0.006 },
    { label: "boundary", colour: ["#7b8796", "#8b96a4"], size: 3.5, least: 0.6, nearer: 0.006 },
    { label: "singular", colour: ["#d0103a", "#ff4d6d"], size: 12, least: 7, nearer: 0.012 },
    { label: "seam", colour: ["#1f9d55", "#4ad08a"], size: 6, least: 1.5, nearer: 0.006 },
  ];
  const VIEWS = { iso: [0.75, -1.15, 0.62], top: [0, -0.001, 1], front: [0, -1, 0.001], side: [1, 0, 0.001] };
  const PICK_RADIUS = 12;
  const HOVER_LIMIT = 60000;

  const themed = ([light, dark], isDark) => (isDark ? dark : light);

  // More than two drawn pixels a point cost time and show nothing.
  const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);

  /** The scene and its camera; `null` where the browser has no WebGL. */
  function createView(stage, data, isDark) {
    const renderer = createRenderer(stage);
    if (!renderer) return null;
    const { network, surface } = data;
    const canvas = renderer.domElement;
    const cloud = network ? [surface.points, network.points] : [surface.points];
    const size = cloud.reduce((most, points) => Math.max(most, radius(points)), 0) || 1;
    const scene = new THREE.Scene();
    const camera = new THREE.PerspectiveCamera(32, 1, size * 0.01, size * 40);
    camera.up.set(0, 0, 1);
    scene.add(camera, new THREE.AmbientLight(0xffffff, 1.6));
    const lamp = new THREE.DirectionalLight(0xffffff, 1.55);
    // A lamp that goes with the eye leaves no side of the model in the dark.
    lamp.position.set(-0.5, 0.8, 1);
    camera.add(lamp);
    const controls = new THREE.OrbitControls(camera, canvas);
    controls.minDistance = size * 0.03;
    controls.maxDistance = size * 20;

    const parts = {
      surface: surfaceMesh(surface),
      // Under lamellas it would be one line among many.
      rim: network ? new THREE.Group() : rimLines(surface),
      families: network ? { A: familyPart(data, "A", size), B: familyPart(data, "B", size) } : {},
      nodes: network ? nodePoints(network) : new THREE.Group(),
      solids: builtStrips(data.built),
      hardware: hardwarePieces(data.built),
      highlight: new THREE.Group(),
      marker: pointCloud(new Float32Array(3), { size: 11, nearer: 0.015 }),
    };
    parts.marker.visible = false;
    scene.add(
      parts.surface,
      parts.rim,
      ...Object.values(parts.families).map((part) => part.group),
      parts.nodes,
      ...Object.values(parts.solids),
      parts.hardware,
      parts.highlight,
      parts.marker,
    );

    const cell = network ? meanCell(network) : 0;
    // The named view that still fits the picture, until the reader turns or moves it.
    let standpoint = "iso";
    let dark = isDark;
    let pending = false;
    const listeners = [];

    function draw() {
      pending = false;
      fitNodes();
      renderer.render(scene, camera);
      listeners.forEach((listener) => listener());
    }
    /** Nodes shrink with their cells on the screen, so that a dense net does not drown in them. */
    function fitNodes() {
      const distance = camera.position.distanceTo(controls.target);
      const cellPixels =
        (cell * stage.clientHeight) / (2 * distance * Math.tan((camera.fov * Math.PI) / 360));
      for (const points of parts.nodes.children) {
        const { size: most, least } = points.userData.style;
        points.material.size = Math.min(Math.max(0.14 * cellPixels, least), most) * pixelRatio();
      }
    }
    function redraw() {
      if (pending) return;
      pending = true;
      requestAnimationFrame(draw);
    }

    function resize() {
      const { clientWidth: width, clientHeight: height } = stage;
      if (!width || !height) return;
      renderer.setPixelRatio(pixelRatio());
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
    }

    function lookFrom(name) {
      standpoint = name;
      const direction = new THREE.Vector3(...VIEWS[name]).normalize();
      controls.target.set(0, 0, 0);
      camera.position.copy(direction);
      camera.lookAt(controls.target);
      camera.position.multiplyScalar(fittingDistance(camera, cloud));
      controls.update();
      redraw();
    }

    function setTheme(nowDark) {
      dark = nowDark;
      parts.surface.userData.plain.set(themed(["#a9b6c6", "#5f6f84"], dark));
      if (!parts.surface.material.vertexColors)
        parts.surface.material.color.copy(parts.surface.userData.plain);
      for (const points of parts.nodes.children)
        points.material.color.set(themed(points.userData.style.colour, dark));
      parts.marker.material.color.set(themed(["#111418", "#ffffff"], dark));
      for (const lines of [...parts.highlight.children, ...parts.rim.children])
        lines.material.color.set(themed(["#111418", "#ffffff"], dark));
      redraw();
    }

    function colourLamellas(colouring) {
      for (const [family, part] of Object.entries(parts.families)) {
        const colours = sampleColours(colouring, family, network);
        part.paint(colours);
        if (parts.solids[family]) paintSolid(parts.solids[family], colours);
      }
      redraw();
    }

    function colourSurface(colouring) {
      const { material, geometry, userData } = parts.surface;
      material.vertexColors = Boolean(colouring.values);
      // Alone it may hide its own far side; around lamellas it must not hide them.
      material.opacity = network ? (colouring.values ? 0.85 : 0.42) : 1;
      material.depthWrite = !network;
      if (colouring.values)
        geometry.setAttribute("color", new THREE.BufferAttribute(paint(colouring.values, colouring), 3));
      material.color.copy(colouring.values ? new THREE.Color(0xffffff) : userData.plain);
      material.needsUpdate = true;
      redraw();
    }

    /** Strips with their thickness take the place of those without. */
    function showSolids(visible, families) {
      for (const [family, mesh] of Object.entries(parts.solids)) {
        mesh.visible = visible && families[family];
        if (parts.families[family].mesh) parts.families[family].mesh.visible = !visible;
      }
      redraw();
    }

    function show(name, visible) {
      const part = parts.families[name]?.group ?? parts[name];
      part.visible = visible;
      if (name === "surface") parts.rim.visible = visible;
      redraw();
    }

    function highlight(lamella) {
      parts.highlight.children.forEach((lines) => lines.geometry.dispose());
      parts.highlight.clear();
      if (lamella !== null) parts.highlight.add(...outline(data, lamella));
      setTheme(dark);
    }

    function mark(sample) {
      parts.marker.visible = sample !== null;
      if (sample !== null) {
        parts.marker.geometry.attributes.position.array.set(
          network.points.subarray(3 * sample, 3 * sample + 3),
        );
        parts.marker.geometry.attributes.position.needsUpdate = true;
      }
      redraw();
    }

    /** Sample under a place in the canvas (pixels from its corner), or null. */
    function pick(x, y) {
      const visible = Object.values(parts.families).filter((part) => part.group.visible);
      return hitStrip(visible, camera, x, y, stage) ?? nearestSample(visible, network, camera, x, y, stage);
    }

    function turn(azimuth, elevation) {
      standpoint = null;
      const away = camera.position.clone().sub(controls.target);
      const distance = away.length();
      const polar = Math.min(Math.max(Math.acos(away.z / distance) - elevation, 0.01), Math.PI - 0.01);
      const around = Math.atan2(away.y, away.x) + azimuth;
      away.set(Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar));
      camera.position.copy(controls.target).addScaledVector(away, distance);
      controls.update();
      redraw();
    }

    function zoom(factor) {
      standpoint = null;
      const away = camera.position.clone().sub(controls.target);
      const distance = Math.min(Math.max(away.length() * factor, controls.minDistance), controls.maxDistance);
      camera.position.copy(controls.target).addScaledVector(away.normalize(), distance);
      controls.update();
      redraw();
    }

    controls.addEventListener("change", redraw);
    controls.addEventListener("start", () => {
      standpoint = null;
    });
    // At once, not in the next frame: resizing has emptied the canvas.
    new ResizeObserver(() => {
      resize();
      if (standpoint) lookFrom(standpoint);
      draw();
    }).observe(stage);
    resize();
    setTheme(dark);
    return {
      canvas,
      camera,
      colourLamellas,
      colourSurface,
      draw,
      highlight,
      lookFrom,
      mark,
      pick,
      setTheme,
      show,
      showSolids,
      turn,
      zoom,
      onDraw: (listener) => listeners.push(listener),
      hasHover: Boolean(network) && network.arclengths.length <= HOVER_LIMIT,
    };
  }

  function createRenderer(stage) {
    try {
      // The drawing has to outlive its frame to be printed.
      const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
      renderer.setClearAlpha(0);
      Object.entries({
        tabindex: "0",
        role: "img",
        "aria-label": "3D view of the surface and its lamellas",
      }).forEach(([key, value]) => renderer.domElement.setAttribute(key, value));
      stage.prepend(renderer.domElement);
      return renderer;
    } catch {
      stage.append(
        element(
          "p",
          { class: "message" },
          "This browser offers no WebGL, which the 3D view needs. Tables and plots work without it.",
        ),
      );
      return null;
    }
  }

  /** Mean distance of neighbouring nodes along the lamellas. */
  function meanCell(network) {
    const cells = network.nodeCounts.reduce((total, count) => total + count, 0) - network.ids.length;
    return network.lengths.reduce((total, length) => total + length, 0) / (cells || 1);
  }

  function radius(points) {
    let most = 0;
    for (let i = 0; i < points.length; i += 3)
      most = Math.max(most, Math.hypot(points[i], points[i + 1], points[i + 2]));
    return most;
  }

  /** Distance from the origin at which all points are inside the picture. */
  function fittingDistance(camera, clouds) {
    camera.updateMatrixWorld();
    const [right, up, back] = [0, 1, 2].map((k) =>
      new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, k),
    );
    const vertical = Math.tan((camera.fov * Math.PI) / 360);
    const horizontal = vertical * camera.aspect;
    const point = new THREE.Vector3();
    let distance = 0;
    for (const points of clouds) {
      for (let i = 0; i < points.length; i += 3) {
        point.fromArray(points, i);
        const needed = Math.max(Math.abs(point.dot(right)) / horizontal, Math.abs(point.dot(up)) / vertical);
        distance = Math.max(distance, point.dot(back) + needed * 1.06);
      }
    }
    return distance || 1;
  }

  function surfaceMesh(surface) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.points, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(surface.normals, 3, true));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(surface.triangles), 1));
    // Pushed back, so that centre lines, which lie in the surface, win against it.
    const material = new THREE.MeshLambertMaterial({
      side: THREE.DoubleSide,
      transparent: true,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.userData.plain = new THREE.Color();
    return mesh;
  }

  /** Edges of one triangle only, as lines. */
  function rimLines({ points, triangles }) {
    const count = points.length / 3;
    const open = new Map();
    for (let i = 0; i < triangles.length; i += 3) {
      for (let k = 0; k < 3; k++) {
        const [a, b] = [triangles[i + k], triangles[i + ((k + 1) % 3)]];
        // The neighbour runs along the edge the other way.
        if (!open.delete(b * count + a)) open.set(a * count + b, [a, b]);
      }
    }
    const group = new THREE.Group();
    if (!open.size) return group;
    const pairs = new Float32Array(6 * open.size);
    [...open.values()]
      .flat()
      .forEach((vertex, i) => pairs.set(points.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
    group.add(lineSegments(pairs, { linewidth: 2 }));
    return group;
  }

  /** Samples that have a next one in their lamella, of one family. */
  function segmentStarts(network, family) {
    const starts = [];
    network.ids.forEach((_, lamella) => {
      if (network.families[lamella] !== family) return;
      for (let i = network.offsets[lamella]; i + 1 < network.offsets[lamella + 1]; i++) starts.push(i);
    });
    return starts;
  }

  function stripPositions(network, height) {
    const { points, normals } = network;
    const positions = new Float32Array(2 * points.length);
    const half = height / 2 / 32767;
    for (let i = 0; i < points.length; i += 3) {
      for (let k = 0; k < 3; k++) {
        positions[2 * i + k] = points[i + k] - half * normals[i + k];
        positions[2 * i + 3 + k] = points[i + k] + half * normals[i + k];
      }
    }
    return positions;
  }

  function stripMesh(network, height, starts) {
    const index = new Uint32Array(6 * starts.length);
    starts.forEach((i, k) =>
      index.set([2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3], 6 * k),
    );
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(stripPositions(network, height), 3));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const material = new THREE.MeshLambertMaterial({
      side: THREE.DoubleSide,
      vertexColors: true,
      flatShading: true,
    });
    return new THREE.Mesh(geometry, material);
  }

  function lineSegments(pairs, options) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(pairs);
    return new THREE.LineSegments2(geometry, new THREE.LineMaterial(options));
  }

  function gathered(values, starts, scale = 1) {
    const pairs = new Float32Array(6 * starts.length);
    starts.forEach((i, k) => {
      for (let c = 0; c < 6; c++) pairs[6 * k + c] = values[3 * i + c] * scale;
    });
    return pairs;
  }

  /** Strips and centre lines of one family. */
  function familyPart({ network, lamellas }, family, size) {
    const group = new THREE.Group();
    const starts = segmentStarts(network, family);
    const nothing = { group, starts, mesh: null, paint: () => {} };
    if (!starts.length) return nothing;
    const mesh = lamellas ? stripMesh(network, lamellas.height, starts) : null;
    // Strips too low to be seen from afar leave the colour to their centre lines.
    const isLow = !lamellas || lamellas.height < size / 250;
    const lines = lineSegments(gathered(network.points, starts), {
      vertexColors: true,
      linewidth: lamellas ? (isLow ? 2 : 1.2) : 2.5,
    });
    group.add(...[mesh, lines].filter(Boolean));
    function paintPart(colours) {
      if (mesh) mesh.geometry.setAttribute("color", new THREE.BufferAttribute(doubled(colours), 3));
      lines.geometry.setColors(gathered(colours, starts, isLow ? 1 : 0.35));
    }
    return { group, starts, mesh, paint: paintPart };
  }

  /** Strips as they are built, a mesh for each family; every vertex has the colour of a sample. */
  function builtStrips(built) {
    const meshes = {};
    for (const { family, points, triangles, samples } of built?.strips ?? []) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
      geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(triangles), 1));
      const material = new THREE.MeshLambertMaterial({ vertexColors: true, flatShading: true });
      meshes[family] = new THREE.Mesh(geometry, material);
      meshes[family].userData.samples = samples;
    }
    return meshes;
  }

  function paintSolid(mesh, colours) {
    const { samples } = mesh.userData;
    const painted = new Float32Array(3 * samples.length);
    samples.forEach((sample, i) => painted.set(colours.subarray(3 * sample, 3 * sample + 3), 3 * i));
    mesh.geometry.setAttribute("color", new THREE.BufferAttribute(painted, 3));
  }

  /** A mesh for each kind of hardware, drawn in all its places. */
  function hardwarePieces(built) {
    const group = new THREE.Group();
    for (const { points, triangles, matrices, colour } of built?.hardware ?? []) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
      geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(triangles), 1));
      const count = matrices.length / 16;
      const material = new THREE.MeshLambertMaterial({ color: colour, flatShading: true });
      const mesh = new THREE.InstancedMesh(geometry, material, count);
      mesh.instanceMatrix.array.set(matrices);
      mesh.frustumCulled = false;
      group.add(mesh);
    }
    return group;
  }

  function doubled(colours) {
    const twice = new Float32Array(2 * colours.length);
    for (let i = 0; i < colours.length; i += 3) {
      for (let k = 0; k < 3; k++) twice[2 * i + k] = twice[2 * i + 3 + k] = colours[i + k];
    }
    return twice;
  }

  function sampleColours(colouring, family, network) {
    if (colouring.values) return paint(colouring.values, colouring);
    const colour = channels(FAMILY_COLOURS[family]).map(linear);
    return Float32Array.from(network.points, (_, i) => colour[i % 3]);
  }

  /** Round points of constant size on the screen, drawn a little nearer to the eye than they are. */
  function pointCloud(positions, style) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    const material = new THREE.PointsMaterial({
      size: style.size * pixelRatio(),
      sizeAttenuation: false,
    });
    material.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader.replace(
        "#include <project_vertex>",
        `#include <project_vertex>
        gl_Position = projectionMatrix * vec4(mvPosition.xyz * ${(1 - style.nearer).toFixed(4)}, 1.0);`,
      );
      shader.fragmentShader = shader.fragmentShader.replace(
        "void main() {",
        "void main() {\nif (length(gl_PointCoord - 0.5) > 0.5) discard;",
      );
    };
    material.customProgramCacheKey = () => `round ${style.nearer}`;
    return new THREE.Points(geometry, material);
  }

  function nodePoints(network) {
    const group = new THREE.Group();
    NODE_STYLES.forEach((style, kind) => {
      const positions = [];
      network.nodeKinds.forEach((value, node) => {
        if (value === kind) positions.push(...network.nodePoints.subarray(3 * node, 3 * node + 3));
      });
      if (!positions.length) return;
      const points = pointCloud(new Float32Array(positions), style);
      points.userData.style = style;
      group.add(points);
    });
    return group;
  }

  /** Outline of a lamella, once hidden by what is before it and once faintly through everything. */
  function outline({ network, lamellas }, lamella) {
    const [first, end] = [network.offsets[lamella], network.offsets[lamella + 1]];
    const starts = Array.from({ length: end - first - 1 }, (_, k) => first + k);
    let pairs = gathered(network.points, starts);
    if (lamellas) {
      const edges = stripPositions(
        {
          points: network.points.subarray(3 * first, 3 * end),
          normals: network.normals.subarray(3 * first, 3 * end),
        },
        lamellas.height,
      );
      pairs = stripEdges(edges, end - first);
    }
    const width = lamellas ? 2.2 : 5;
    return [
      lineSegments(pairs, {
        linewidth: width,
        polygonOffset: true,
        polygonOffsetFactor: -2,
        polygonOffsetUnits: -2,
      }),
      lineSegments(pairs, { linewidth: width, transparent: true, opacity: 0.35, depthTest: false }),
    ];
  }

  function stripEdges(edges, count) {
    const corner = (sample, side) =>
      Array.from(edges.subarray(6 * sample + 3 * side, 6 * sample + 3 * side + 3));
    const pairs = [...corner(0, 0), ...corner(0, 1), ...corner(count - 1, 0), ...corner(count - 1, 1)];
    for (let i = 0; i + 1 < count; i++) {
      for (const side of [0, 1]) pairs.push(...corner(i, side), ...corner(i + 1, side));
    }
    return new Float32Array(pairs);
  }

  function hitStrip(parts, camera, x, y, stage) {
    const caster = new THREE.Raycaster();
    caster.setFromCamera(
      new THREE.Vector2((2 * x) / stage.clientWidth - 1, 1 - (2 * y) / stage.clientHeight),
      camera,
    );
    const [hit] = caster.intersectObjects(parts.map((part) => part.mesh).filter(Boolean), false);
    return hit ? hit.face.a >> 1 : null;
  }

  /** Sample of the centre line that passes nearest on the screen, for thin strips and fingers. */
  function nearestSample(parts, network, camera, x, y, stage) {
    const place = new THREE.Vector3();
    const onScreen = (i) => {
      place.fromArray(network.points, 3 * i).project(camera);
      return [((place.x + 1) * stage.clientWidth) / 2, ((1 - place.y) * stage.clientHeight) / 2, place.z];
    };
    let best = null,
      least = PICK_RADIUS;
    for (const { starts } of parts) {
      let last = -1,
        end = null;
      for (const i of starts) {
        const start = i === last ? end : onScreen(i);
        end = onScreen(i + 1);
        last = i + 1;
        const distance = distanceToSegment(x, y, start, end);
        if (distance < least && Math.abs(start[2]) < 1) [best, least] = [i, distance];
      }
    }
    return best;
  }

  function distanceToSegment(x, y, [ax, ay], [bx, by]) {
    const [dx, dy] = [bx - ax, by - ay];
    const along = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    return Math.hypot(x - ax - along * dx, y - ay - along * dy);
  }

  const AXES = [
    ["x", "#d0453b"],
    ["y", "#3d9a4b"],
    ["z", "#3b78d0"],
  ];

  function drawTriad(target, camera) {
    const inverse = camera.matrixWorldInverse.elements;
    const axes = AXES.map(([name, colour], k) => ({
      name,
      colour,
      x: inverse[4 * k],
      y: -inverse[4 * k + 1],
      depth: inverse[4 * k + 2],
    }));
    axes.sort((p, q) => p.depth - q.depth);
    target.replaceChildren(
      ...axes.flatMap(({ name, colour, x, y }) => [
        svg("line", { x2: 22 * x, y2: 22 * y, stroke: colour }),
        svg("text", { x: 30 * x, y: 30 * y, fill: colour }, name),
      ]),
    );
  }

  // -------------------------------------------------------------------------------- plots

  const MARGIN = { left: 52, right: 12, top: 10, bottom: 42 };
  const PLOT_HEIGHT = 240;
  // Below this (1/m, MPa) a plotted value is rounding.
  const ROUNDING = 1e-9;

  const PLOTS = [
    {
      title: "Curvature",
      unit: "1/m",
      digits: 4,
      series: [
        { key: "normalCurvature", label: "kn normal", colour: "kn" },
        { key: "geodesicCurvature", label: "kg geodesic", colour: "kg" },
        { key: "geodesicTorsion", label: "tg torsion", colour: "tg" },
      ],
    },
    {
      title: "Residual stress",
      unit: "MPa",
      digits: 3,
      series: [
        { key: "bending", label: "bending", colour: "bending" },
        { key: "torsion", label: "torsion", colour: "torsion" },
        { key: "helixEdge", label: "helix edge", colour: "edge" },
        { key: "helixCentre", label: "helix centre", colour: "centre" },
        { key: "restraint", label: "restraint", colour: "restraint", dash: "6 3" },
        { key: "layer", label: "layers beside", colour: "layer", dash: "1 2" },
        { key: "vonMises", label: "von Mises", colour: "mises", dash: "2 2.5" },
      ],
    },
  ];

  /** Round numbers that divide low..high in about `count` steps. */
  function niceTicks(low, high, count) {
    const rough = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10]
      .map((factor) => factor * power)
      .find((candidate) => candidate >= rough * 0.999);
    const decimals = Math.max(
      0,
      -Math.floor(Math.log10(step) + 1e-9) + (Math.abs(step / power - 2.5) < 1e-9 ? 1 : 0),
    );
    const ticks = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(k * step);
    const text = (value) =>
      step < 1e-5 || step >= 1e6
        ? format(value, 2)
        : value
            .toFixed(decimals)
            .replace(/^-(?=0(\.0*)?$)/, "")
            .replace("-", "−");
    return { ticks, text };
  }

  function createPlot(spec, quantities, network, onCursor) {
    const drawing = svg("svg", { tabindex: "0", role: "img", height: PLOT_HEIGHT });
    const readout = element("ul", { class: "readout" });
    const place = element("span", { "aria-live": "polite" });
    const title = element("div", {}, `${spec.title} `, element("span", {}, spec.unit));
    const caption = element("figcaption", {}, title, place);
    const figure = element("figure", { class: "plot" }, caption, drawing, readout);
    const values = spec.series.map((series) => {
      const text = element("b");
      const key = svg(
        "svg",
        { viewBox: "0 0 18 8" },
        svg("line", { x2: 18, y1: 4, y2: 4, ...strokeOf(series) }),
      );
      readout.append(element("li", {}, key, series.label, text));
      return text;
    });
    let frame = null;

    function draw(lamella) {
      frame = plotFrame(spec, quantities, network, lamella, drawing.clientWidth || 480);
      drawing.setAttribute("viewBox", `0 0 ${frame.width} ${PLOT_HEIGHT}`);
      const peaks = spec.series.map(({ label }, k) => `${label} ${format(frame.peaks[k])}`).join(", ");
      drawing.setAttribute(
        "aria-label",
        `${spec.title} along lamella ${network.ids[lamella]}: peaks ${peaks} ${spec.unit}. Left and right arrows read values.`,
      );
      drawing.replaceChildren(...axisShapes(frame), ...curveShapes(spec, quantities, frame));
      setCursor(null);
    }

    function setCursor(sample) {
      drawing.querySelector(".cursor-group")?.remove();
      spec.series.forEach((series, k) => {
        const value = sample === null ? frame.peaks[k] : quantities[series.key][sample];
        values[k].textContent = Math.abs(value) < ROUNDING ? "≈ 0" : format(value, spec.digits);
      });
      place.textContent = sample === null ? "peak values" : whereabouts(network, frame.lamella, sample);
      frame.held = sample;
      if (sample !== null) drawing.append(cursorShapes(spec, quantities, frame, sample));
    }

    drawing.addEventListener("pointermove", (event) => {
      if (!frame) return;
      const box = drawing.getBoundingClientRect();
      onCursor(frame.sampleAt(((event.clientX - box.left) * frame.width) / box.width));
    });
    drawing.addEventListener("pointerleave", () => onCursor(null));
    drawing.addEventListener("blur", () => onCursor(null));
    drawing.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (step && frame) {
        onCursor(frame.step(step * (event.shiftKey ? 10 : 1)));
        event.preventDefault();
        event.stopPropagation();
      }
    });
    return { figure, draw, setCursor };
  }

  const strokeOf = ({ colour, dash }) => ({
    style: `stroke: var(--series-${colour})`,
    ...(dash ? { "stroke-dasharray": dash } : {}),
  });

  function plotFrame(spec, quantities, network, lamella, width) {
    const [first, end] = [network.offsets[lamella], network.offsets[lamella + 1]];
    const length = network.arclengths[end - 1] || 1;
    const curves = spec.series.map((series) => quantities[series.key].subarray(first, end));
    const bounds = curves.map(extent);
    let low = Math.min(0, ...bounds.map(([least]) => least));
    let high = Math.max(0, ...bounds.map(([, most]) => most));
    // Curvatures that are zero up to rounding stay a flat line.
    if (high - low < ROUNDING) [low, high] = [low - 0.5, high + 0.5];
    const pad = 0.05 * (high - low);
    [low, high] = [low < 0 ? low - pad : low, high > 0 ? high + pad : high];
    const [inner, tall] = [width - MARGIN.left - MARGIN.right, PLOT_HEIGHT - MARGIN.top - MARGIN.bottom];
    const frame = {
      network,
      lamella,
      first,
      end,
      width,
      length,
      low,
      high,
      held: null,
      peaks: bounds.map(([least, most]) => (Math.abs(least) > Math.abs(most) ? least : most)),
      x: (s) => MARGIN.left + (s / length) * inner,
      y: (value) => MARGIN.top + ((high - value) / (high - low)) * tall,
      sampleAt: (pixel) =>
        nearestIndex(network.arclengths, first, end, ((pixel - MARGIN.left) / inner) * length),
      step: (by) => Math.min(Math.max((frame.held ?? first - Math.sign(by)) + by, first), end - 1),
    };
    return frame;
  }

  /** Index in first..end of the entry nearest to `target` in increasing values. */
  function nearestIndex(values, first, end, target) {
    let [low, high] = [first, end - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (values[middle] <= target) low = middle;
      else high = middle;
    }
    return target - values[low] < values[high] - target ? low : high;
  }

  function axisShapes({ network, lamella, first, width, length, low, high, x, y }) {
    const shapes = [];
    const [left, right, bottom] = [MARGIN.left, width - MARGIN.right, PLOT_HEIGHT - MARGIN.bottom];
    const vertical = niceTicks(low, high, 5);
    for (const tick of vertical.ticks) {
      shapes.push(
        svg("line", { class: tick === 0 ? "axis" : "grid", x1: left, x2: right, y1: y(tick), y2: y(tick) }),
      );
      shapes.push(svg("text", { x: left - 7, y: y(tick) + 4, "text-anchor": "end" }, vertical.text(tick)));
    }
    const [firstStop, endStop] = [network.stopOffsets[lamella], network.stopOffsets[lamella + 1]];
    const isSparse = (right - left) / (endStop - firstStop) > 7;
    for (let stop = firstStop; stop < endStop; stop++) {
      const place = x(network.arclengths[first + network.stopSamples[stop]]);
      if (isSparse)
        shapes.push(svg("line", { class: "node", x1: place, x2: place, y1: MARGIN.top, y2: bottom }));
      shapes.push(svg("line", { class: "tick", x1: place, x2: place, y1: bottom, y2: bottom + 5 }));
    }
    const horizontal = niceTicks(0, length, Math.max(2, Math.min(8, width / 80)));
    for (const tick of horizontal.ticks) {
      shapes.push(
        svg("text", { x: x(tick), y: bottom + 18, "text-anchor": "middle" }, horizontal.text(tick)),
      );
    }
    shapes.push(svg("line", { class: "axis", x1: left, x2: right, y1: bottom, y2: bottom }));
    shapes.push(
      svg("text", { x: right, y: bottom + 35, "text-anchor": "end" }, "arc length, m; ticks: nodes"),
    );
    return shapes;
  }

  function curveShapes(spec, quantities, { network, first, end, x, y }) {
    return spec.series.map((series) => {
      let path = "",
        command = "M";
      for (let i = first; i < end; i++) {
        const value = quantities[series.key][i];
        if (Number.isNaN(value)) {
          command = "M";
          continue;
        }
        path += `${command}${x(network.arclengths[i]).toFixed(1)} ${y(value).toFixed(1)}`;
        command = "L";
      }
      return svg("path", { d: path, ...strokeOf(series) });
    });
  }

  function cursorShapes(spec, quantities, { network, x, y }, sample) {
    const place = x(network.arclengths[sample]);
    const group = svg(
      "g",
      { class: "cursor-group" },
      svg("line", { class: "cursor", x1: place, x2: place, y1: MARGIN.top, y2: PLOT_HEIGHT - MARGIN.bottom }),
    );
    for (const series of spec.series) {
      const value = quantities[series.key][sample];
      if (!Number.isNaN(value))
        group.append(
          svg("circle", { cx: place, cy: y(value), r: 3.4, style: `fill: var(--series-${series.colour})` }),
        );
    }
    return group;
  }

  // --------------------------------------------------------------------------------- selected lamella

  function createPanel({ network, lamellas }, onCursor) {
    const choice = byId("lamella-choice");
    const facts = byId("facts");
    let current = null;
    const setCursor = (sample) => {
      plots.forEach((plot) => plot.setCursor(sample));
      onCursor(sample);
    };
    const quantities = { ...network, ...lamellas };
    const plots = PLOTS.filter((spec) => spec.series[0].key in quantities).map((spec) =>
      createPlot(spec, quantities, network, setCursor),
    );
    byId("plots").append(...plots.map((plot) => plot.figure));
    choice.append(
      element("option", { value: "" }, "none"),
      ...network.ids.map((id, k) => element("option", { value: k }, id)),
    );
    byId("lamella-panel").hidden = false;

    function showFacts() {
      const entries =
        current === null
          ? [["", "Choose a lamella here or in the 3D view.", ""]]
          : factsOf(network, lamellas, current);
      facts.replaceChildren(
        ...entries.map(([label, value, unit]) =>
          element(
            "div",
            {},
            element("dt", {}, label),
            element("dd", {}, value, element("span", {}, unit ? ` ${unit}` : "")),
          ),
        ),
      );
    }

    function show(lamella) {
      current = lamella;
      choice.value = lamella ?? "";
      byId("plots").hidden = lamella === null;
      showFacts();
      if (lamella !== null) plots.forEach((plot) => plot.draw(lamella));
    }

    new ResizeObserver(() => {
      if (current !== null) plots.forEach((plot) => plot.draw(current));
    }).observe(byId("plots"));
    return { show };
  }

  function factsOf(network, strips, lamella) {
    const [first, end] = [network.offsets[lamella], network.offsets[lamella + 1]];
    const nodes = network.nodeCounts[lamella];
    const facts = [
      ["Family", network.families[lamella], ""],
      ["Length", network.lengths[lamella].toFixed(3), "m"],
      ["Nodes", String(nodes), ""],
    ];
    if (strips) {
      facts.push(["Developed length", strips.developedLengths[lamella].toFixed(3), "m"]);
      facts.push(["Largest utilisation", format(largest(strips.utilisation.subarray(first, end))), ""]);
    }
    return facts;
  }

  /** "2.310 m, node 7" or "2.310 m, nodes 7 to 12", numbered as in network.json. */
  function whereabouts(network, lamella, sample) {
    const [firstStop, endStop] = [network.stopOffsets[lamella], network.stopOffsets[lamella + 1]];
    const local = sample - network.offsets[lamella];
    const next = network.stopSamples.subarray(firstStop, endStop).findIndex((stop) => stop >= local);
    const at = `at ${network.arclengths[sample].toFixed(3)} m`;
    if (next < 0) return at;
    const node = network.stopNodes[firstStop + next];
    if (network.stopSamples[firstStop + next] === local) return `${at}, node ${node}`;
    return next ? `${at}, nodes ${network.stopNodes[firstStop + next - 1]} to ${node}` : at;
  }

  // -------------------------------------------------------------------------------- page

  /** "#A3&colour=twist" as { lamella: "A3", colour: "twist" }. */
  function readHash() {
    const parameters = {};
    for (const part of location.hash.slice(1).split("&").filter(Boolean)) {
      const [key, value] = part.split("=");
      if (value === undefined) parameters.lamella = decoded(key);
      else parameters[key] = decoded(value);
    }
    return parameters;
  }

  function decoded(text) {
    try {
      return decodeURIComponent(text);
    } catch {
      return text;
    }
  }

  function fillSelect(select, colourings) {
    select.append(...colourings.map(({ key, label }) => element("option", { value: key }, label)));
  }

  /** Index of the lamella with the sample of greatest von Mises stress. */
  function mostStressed(network, strips) {
    let best = 0;
    strips.vonMises.forEach((value, i) => {
      if (value > strips.vonMises[best]) best = i;
    });
    return lamellaOf(network, best);
  }

  function lamellaOf(network, sample) {
    let [low, high] = [0, network.ids.length];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (network.offsets[middle] <= sample) low = middle;
      else high = middle;
    }
    return low;
  }

  function start() {
    const data = readData();
    const { network, surface, lamellas, built } = data;
    const preference = matchMedia("(prefers-color-scheme: dark)");
    const isDark = () => ({ dark: true, light: false })[readHash().theme] ?? preference.matches;
    const applyTheme = () => {
      document.documentElement.style.colorScheme = { dark: "dark", light: "light" }[readHash().theme] ?? "";
    };
    applyTheme();

    const stage = byId("stage");
    const hasLamellas = Boolean(network && network.ids.length);
    const view = createView(stage, data, isDark());
    const colourings = lamellaColourings(network, hasLamellas ? lamellas : null);
    const surfaces = surfaceColourings(surface);
    const panel = hasLamellas ? createPanel(data, (sample) => view?.mark(sample)) : null;
    let selected = null;

    const chosen = (list, key, otherwise = list[0]?.key) =>
      list.find((item) => item.key === key) ?? list.find((item) => item.key === otherwise);

    function select(lamella) {
      selected = lamella;
      panel?.show(lamella);
      view?.mark(null);
      view?.highlight(lamella);
      writeHash();
    }

    function stepLamella(by) {
      if (!panel) return;
      const count = network.ids.length;
      select(selected === null ? (by > 0 ? 0 : count - 1) : (selected + by + count) % count);
    }

    function writeHash() {
      const parameters = { ...readHash(), lamella: selected === null ? undefined : network.ids[selected] };
      if (colourings.length) parameters.colour = byId("colouring").value;
      parameters.surface = byId("surface-colouring").value;
      if (parameters.colour === colourings[0]?.key) delete parameters.colour;
      if (parameters.surface === surface.first) delete parameters.surface;
      const { lamella, ...others } = parameters;
      const parts = Object.entries(others).map(
        ([key, value]) => `${encodeURIComponent(key)}=${encodeURIComponent(value)}`,
      );
      if (lamella !== undefined) parts.unshift(encodeURIComponent(lamella));
      const hash = parts.join("&");
      if (hash === location.hash.slice(1)) return;
      try {
        history.replaceState(null, "", `#${hash}`);
      } catch {
        // A page inside another one (a notebook) may not touch its address; nothing depends on it.
      }
    }

    function recolour() {
      const colouring = chosen(colourings, byId("colouring").value);
      const surfaceColouring = chosen(surfaces, byId("surface-colouring").value);
      if (colouring) view.colourLamellas(colouring);
      view.colourSurface(surfaceColouring);
      byId("legends").replaceChildren(...legends(colouring, surfaceColouring));
    }

    function legends(colouring, surfaceColouring) {
      const shown = [];
      if (colouring) shown.push(colouring.values ? rampLegend(colouring) : familyLegend());
      if (surfaceColouring.values && byId("show-surface").checked) shown.push(rampLegend(surfaceColouring));
      if (network && byId("show-nodes").checked) shown.push(nodeLegend());
      return shown;
    }

    function nodeLegend() {
      const kinds = NODE_STYLES.map((style, kind) => ({
        ...style,
        count: network.kindCounts[kind],
      }));
      const swatches = kinds
        .filter(({ count }) => count)
        .map(({ label, colour, count }) => swatch(themed(colour, isDark()), `${label} (${count})`, true));
      return legend("Nodes", "", element("div", { class: "swatches" }, ...swatches));
    }

    /** Selection, colours and visibility from the address; the named ones only. */
    function applyHash() {
      const parameters = readHash();
      applyTheme();
      byId("surface-colouring").value = chosen(surfaces, parameters.surface, surface.first).key;
      if (colourings.length) byId("colouring").value = chosen(colourings, parameters.colour).key;
      for (const name of ["a", "b", "nodes", "solids", "hardware"]) {
        if (name in parameters) byId(`show-${name}`).checked = parameters[name] !== "0";
      }
      if (parameters.surface === "none") byId("show-surface").checked = false;
      if (view) {
        view.setTheme(isDark());
        applyVisibility();
        view.lookFrom(parameters.view in VIEWS ? parameters.view : "iso");
        recolour();
      }
      if (!panel) return;
      const index = network.ids.indexOf(parameters.lamella);
      if (index >= 0) select(index);
      else select(lamellas && parameters.lamella !== "none" ? mostStressed(network, lamellas) : null);
    }

    function applyVisibility() {
      view.show("surface", byId("show-surface").checked);
      if (!network) return;
      view.show("A", byId("show-a").checked);
      view.show("B", byId("show-b").checked);
      view.show("nodes", byId("show-nodes").checked);
      view.showSolids(byId("show-solids").checked && Boolean(built?.strips.length), {
        A: byId("show-a").checked,
        B: byId("show-b").checked,
      });
      view.show("hardware", byId("show-hardware").checked);
    }

    function connectToolbar() {
      fillSelect(byId("colouring"), colourings);
      fillSelect(byId("surface-colouring"), surfaces);
      if (!view) return;
      byId("toolbar").hidden = byId("buttons").hidden = byId("hint").hidden = false;
      if (!network)
        document.querySelectorAll("[data-needs=network]").forEach((part) => {
          part.hidden = true;
        });
      for (const id of ["colouring", "surface-colouring"])
        byId(id).addEventListener("change", () => {
          recolour();
          writeHash();
        });
      for (const [need, list] of Object.entries({ solids: built?.strips, hardware: built?.hardware }))
        document.querySelectorAll(`[data-needs=${need}]`).forEach((part) => {
          part.hidden = !list?.length;
        });
      for (const id of ["show-a", "show-b", "show-surface", "show-nodes", "show-solids", "show-hardware"])
        byId(id).addEventListener("change", () => {
          applyVisibility();
          recolour();
        });
      document
        .querySelectorAll("[data-view]")
        .forEach((button) => button.addEventListener("click", () => view.lookFrom(button.dataset.view)));
      view.onDraw(() => drawTriad(byId("triad"), view.camera));
      connectCanvas();
    }

    function connectCanvas() {
      const { canvas } = view;
      const place = (event) => {
        const box = canvas.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
      };
      canvas.addEventListener("keydown", onCanvasKey);
      if (!hasLamellas) return;
      let down = null;
      canvas.addEventListener("pointerdown", (event) => {
        down = event.isPrimary ? place(event) : null;
      });
      canvas.addEventListener("pointerup", (event) => {
        const [x, y] = place(event);
        const isClick = down && Math.hypot(x - down[0], y - down[1]) < 5;
        down = null;
        if (!isClick || event.button !== 0) return;
        const sample = view.pick(x, y);
        if (sample !== null) select(lamellaOf(network, sample));
      });
      connectTip(canvas, place);
    }

    function connectTip(canvas, place) {
      const tip = byId("tip");
      let waiting = false;
      canvas.addEventListener("pointermove", (event) => {
        if (!view.hasHover || waiting || event.buttons || event.pointerType === "touch") return;
        waiting = true;
        const [x, y] = place(event);
        requestAnimationFrame(() => {
          waiting = false;
          showTip(tip, x, y);
        });
      });
      for (const name of ["pointerleave", "pointerdown"])
        canvas.addEventListener(name, () => {
          tip.hidden = true;
        });
    }

    function showTip(tip, x, y) {
      const sample = view.pick(x, y);
      tip.hidden = sample === null;
      view.canvas.style.cursor = sample === null ? "" : "pointer";
      if (sample === null) return;
      const { values, unit } = chosen(colourings, byId("colouring").value);
      tip.textContent =
        network.ids[lamellaOf(network, sample)] + (values ? `  ${format(values[sample])} ${unit}` : "");
      tip.style.left = `${Math.min(x + 14, stage.clientWidth - tip.offsetWidth - 4)}px`;
      tip.style.top = `${Math.max(y - 30, 4)}px`;
    }

    function onCanvasKey(event) {
      const quarter = Math.PI / 24;
      const turns = {
        ArrowLeft: [-quarter, 0],
        ArrowRight: [quarter, 0],
        ArrowUp: [0, quarter],
        ArrowDown: [0, -quarter],
      };
      if (event.shiftKey && turns[event.key]) view.turn(...turns[event.key]);
      else if (event.key === "+" || event.key === "=") view.zoom(0.85);
      else if (event.key === "-") view.zoom(1 / 0.85);
      else if (event.key === "0") view.lookFrom("iso");
      else return;
      event.preventDefault();
    }

    function connectPanel() {
      if (!panel) return;
      byId("lamella-choice").addEventListener("change", (event) =>
        select(event.target.value === "" ? null : Number(event.target.value)),
      );
      byId("previous").addEventListener("click", () => stepLamella(-1));
      byId("next").addEventListener("click", () => stepLamella(1));
      byId("worst").hidden = !lamellas;
      byId("worst").addEventListener("click", () => select(mostStressed(network, lamellas)));
      document.addEventListener("keydown", (event) => {
        const isTyping =
          event.target.closest?.("select, input") ||
          event.ctrlKey ||
          event.metaKey ||
          event.altKey ||
          event.shiftKey;
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (isTyping) return;
        if (event.key === "Escape") select(null);
        else if (step) stepLamella(step);
      });
    }

    connectToolbar();
    connectPanel();
    applyHash();
    window.addEventListener("hashchange", applyHash);
    if (!view) return;
    preference.addEventListener("change", () => {
      view.setTheme(isDark());
      recolour();
    });
    window.addEventListener("beforeprint", () => {
      view.setTheme(false);
      view.draw();
    });
    window.addEventListener("afterprint", () => view.setTheme(isDark()));
  }

  start();
})();
