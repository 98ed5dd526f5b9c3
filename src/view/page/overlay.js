// What lies over the picture: the cube that shows and chooses the side, the bar of scale, distances that are measured.

/** The faces of the cube: name, normal, what is up in its words. */
const FACES = [
  ["front", [1, 0, 0], [0, 0, 1]], ["back", [-1, 0, 0], [0, 0, 1]], ["left", [0, 1, 0], [0, 0, 1]],
  ["right", [0, -1, 0], [0, 0, 1]], ["top", [0, 0, 1], [0, 1, 0]], ["below", [0, 0, -1], [0, 1, 0]],
];
const CUBE_HALF = 26;
/** The axes of the world at a corner of the cube, with their letters. */
const AXES = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];

/** A matrix of the style sheet that takes the axes of something to directions of the world. */
const matrixOf = (x, y, z, p) => `matrix3d(${[x, y, z, p].map((v, i) => [...v.map(c => c.toFixed(5)), i < 3 ? 0 : 1].join()).join()})`;

/** The cube beside the picture: its faces are buttons for the sides. */
function cubeOf(choose) {
  const root = document.getElementById("cube");
  const solid = el("div", { class: "solid" });
  for (const [name, normal, up] of FACES) {
    const right = cross(up, normal);
    const face = el("button", { title: "From " + (name === "top" ? "above" : name), on: () => choose(name) }, name);
    // Down in a style sheet is up in the world.
    face.style.transform = matrixOf(right, scaled(up, -1), normal, scaled(normal, CUBE_HALF));
    solid.append(face);
  }
  const corner = [-1, -1, -1].map(x => 1.12 * CUBE_HALF * x);
  const letters = AXES.map(([name]) => el("b", { class: name }, name));
  const bars = AXES.map(([name]) => el("i", { class: name }));
  root.append(solid, ...bars, ...letters);
  let shown = "";
  return {
    turn(yaw, pitch) {
      const key = yaw.toFixed(3) + pitch.toFixed(3);
      if (key === shown) return;
      shown = key;
      const { away, right, up } = axesOf(yaw, pitch);
      const onScreen = v => [dot(v, right), -dot(v, up), dot(v, away)];
      solid.style.transform = matrixOf(onScreen([1, 0, 0]), onScreen([0, 1, 0]), onScreen([0, 0, 1]), [0, 0, 0]);
      AXES.forEach(([, axis], i) => {
        const [a, b] = [onScreen(corner), onScreen(add(corner, scaled(axis, 2.7 * CUBE_HALF)))];
        const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        bars[i].style.transform = `translate(${a[0]}px, ${a[1]}px) rotate(${Math.atan2(dy, dx)}rad) scaleX(${Math.hypot(dx, dy) / 100})`;
        // Nearer than all of the cube, which would cover them.
        letters[i].style.transform = `translate3d(${b[0] + dx * 0.1}px, ${b[1] + dy * 0.1}px, 60px) translate(-50%, -50%)`;
        bars[i].style.zIndex = b[2] > a[2] ? 2 : 0;
      });
    },
  };
}

/** A round length not above one, m: 1, 2 or 5 times a power of ten. */
function roundLength(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}

/** A length as people write it. */
function lengthWords(x) {
  const digits = (value, least) => String(Number(value.toFixed(least)));
  return Math.abs(x) >= 1 ? digits(x, 3) + " m" : digits(x * 1000, 1) + " mm";
}

/** The bar of scale: true for what is as far away as the middle of the robot. */
function scaleBar(grid) {
  const root = document.getElementById("scale");
  const [bar, words] = [el("i", {}), el("span", {})];
  root.append(bar, words);
  return {
    show(distance, height, step) {
      const pixels = height / (2 * distance * Math.tan(FOVY / 2));
      const length = roundLength(150 / pixels);
      bar.style.width = length * pixels + "px";
      words.textContent = lengthWords(length) + (grid() ? ", grid " + lengthWords(step) : "");
    },
  };
}

/** The distance between grid lines: the power of ten below the size of the scene, m. */
const gridStep = grain => 10 ** Math.floor(Math.log10(grain * 0.9));

/** Measuring: two points of the picture, and what lies between them. */
function measureOf(pickPoint, touch) {
  const label = document.getElementById("measured");
  const button = document.getElementById("measure");
  const measure = { on: false, points: [] };
  measure.toggle = on => {
    measure.on = on === undefined ? !measure.on : on;
    measure.points = [];
    label.hidden = !measure.on;
    button.setAttribute("aria-pressed", measure.on);
    document.body.classList.toggle("measuring", measure.on);
    touch();
  };
  /** A click at a place of the canvas (0..1 each way); says whether it was one of measuring. */
  measure.click = (x, y) => {
    if (!measure.on) return false;
    const point = pickPoint(x, y);
    if (point) measure.points = [...(measure.points.length > 1 ? [] : measure.points), point];
    touch();
    return true;
  };
  /** The lines and dots of what is measured, and its words beside them. */
  measure.marks = (theme, onScreen) => {
    const [a, b] = measure.points;
    const at = b && onScreen(scaled(add(a, b), 0.5));
    label.hidden = !at && !measure.on;
    if (!at) {
      label.textContent = measure.points.length ? "click the second point" : "click a point";
      [label.style.left, label.style.top] = ["50%", "76px"];
    } else {
      const d = sub(b, a);
      label.textContent = lengthWords(norm(d)) + "  (" + d.map((x, k) => "xyz"[k] + " " + lengthWords(x)).join(", ") + ")";
      [label.style.left, label.style.top] = [at[0] + "px", at[1] - 14 + "px"];
    }
    const line = b ? [{ a, b, width: 2.5, colour: [...theme.accent, 1] }] : [];
    return [...line, ...measure.points.flatMap(p => spotOf(p, 7, [...theme.accent, 1], theme))];
  };
  return measure;
}

/** The point of the world at a place of the picture (x, y in 0..1 from the top left) and a depth (0..1). */
function unprojected(matrix, x, y, depth) {
  const m = inverse(matrix);
  const v = [2 * x - 1, 1 - 2 * y, 2 * depth - 1, 1];
  const row = r => [0, 1, 2, 3].reduce((sum, c) => sum + m[4 * c + r] * v[c], 0);
  return [0, 1, 2].map(r => row(r) / row(3));
}
