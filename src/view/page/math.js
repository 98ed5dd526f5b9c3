// Vectors are [x, y, z], quaternions [x, y, z, w], matrices 4x4 by columns. z points up.

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const mix = (a, b, u) => a + (b - a) * u;
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => scaled(a, 1 / (norm(a) || 1));

function turned(q, v) {
  const [x, y, z, w] = q;
  const t = scaled(cross([x, y, z], v), 2);
  return add(add(v, scaled(t, w)), cross([x, y, z], t));
}

function product(a, b) {
  return [
    a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
    a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
    a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
    a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
  ];
}

/** The rotation by an angle about a unit vector. */
function about(axis, angle) {
  const s = Math.sin(angle / 2);
  return [axis[0] * s, axis[1] * s, axis[2] * s, Math.cos(angle / 2)];
}

/** The shortest rotation that takes +z to a direction. */
function fromZ(to) {
  const d = unit(to);
  if (d[2] < -0.999999) return [1, 0, 0, 0];
  const q = [-d[1], d[0], 0, 1 + d[2]];
  const n = Math.hypot(...q);
  return q.map(c => c / n);
}

function times(a, b) {
  const m = new Float32Array(16);
  for (let c = 0; c < 4; c++)
    for (let r = 0; r < 4; r++)
      m[4 * c + r] = a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1] + a[8 + r] * b[4 * c + 2] + a[12 + r] * b[4 * c + 3];
  return m;
}

function perspective(fovy, aspect, near, far) {
  const f = 1 / Math.tan(fovy / 2);
  const d = 1 / (near - far);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (near + far) * d, -1, 0, 0, 2 * near * far * d, 0]);
}

function orthographic(half, near, far) {
  const d = 1 / (near - far);
  return new Float32Array([1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 * d, 0, 0, 0, (near + far) * d, 1]);
}

function lookAt(eye, target, up) {
  const z = unit(sub(eye, target));
  const x = unit(cross(up, z));
  const y = cross(z, x);
  return new Float32Array([
    x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1,
  ]);
}

/** The inverse of a matrix, by elimination. */
function inverse(a) {
  const rows = [0, 1, 2, 3].map(r => [...[0, 1, 2, 3].map(c => a[4 * c + r]), ...[0, 1, 2, 3].map(c => (c === r ? 1 : 0))]);
  for (let i = 0; i < 4; i++) {
    const best = [i, i + 1, i + 2, i + 3].filter(r => r < 4).reduce((b, r) => (Math.abs(rows[r][i]) > Math.abs(rows[b][i]) ? r : b), i);
    [rows[i], rows[best]] = [rows[best], rows[i]];
    rows[i] = rows[i].map(x => x / rows[i][i]);
    for (let r = 0; r < 4; r++) if (r !== i) rows[r] = rows[r].map((x, c) => x - rows[r][i] * rows[i][c]);
  }
  return [0, 1, 2, 3].flatMap(c => rows.map(row => row[4 + c]));
}

/** Where a point of the world is on the screen: x and y in -1..1, and depth; behind the eye: null. */
function projected(m, p) {
  const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
  if (w <= 0) return null;
  const row = r => (m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]) / w;
  return [row(0), row(1), row(2)];
}

/** The index of the last number that is not above x, in an ordered list; -1 before the first. */
function lastNotAbove(list, x) {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
