// Shapes as triangles and as the lines of their edges. 0 is a box, 1 a cylinder along z, 2 a ball,
// all of size 1; from 3 on the meshes of the plan.

/** Faces that meet at less than this are drawn as one smooth surface. */
const CREASE = Math.cos((32 * Math.PI) / 180);

/** Every shape, each in the finenesses in which it is drawn, the finest first. */
function shapesOf(plan, rounds) {
  return [[boxShape()], rounds.map(cylinderShape), rounds.map(ballShape), ...(plan.meshes || []).map(mesh => [meshShape(mesh)])];
}

/** Corners [x, y, z, normal], three a triangle, as corners that are there once, and their indices. */
function indexed(corners) {
  const known = new Map();
  const faces = [];
  const index = corners.map(corner => {
    const key = corner.join();
    if (!known.has(key)) known.set(key, known.size), faces.push(...corner);
    return known.get(key);
  });
  return { faces: new Float32Array(faces), index: new Uint32Array(index) };
}

function boxShape() {
  const faces = [];
  const lines = [];
  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const corner = (a, b, c) => {
      const p = [0, 0, 0];
      p[axis] = a / 2;
      p[u] = b / 2;
      p[v] = c / 2;
      return p;
    };
    for (const side of [-1, 1]) {
      const normal = corner(2 * side, 0, 0);
      const ring = [corner(side, -side, -1), corner(side, side, -1), corner(side, side, 1), corner(side, -side, 1)];
      for (const i of [0, 1, 2, 0, 2, 3]) faces.push([...ring[i], ...normal]);
      for (const other of [-1, 1]) lines.push(...corner(-1, side, other), ...corner(1, side, other));
    }
  }
  return { ...indexed(faces), lines: new Float32Array(lines) };
}

function cylinderShape(round) {
  const faces = [];
  const lines = [];
  const at = (i, z) => [Math.cos((2 * Math.PI * (i % round)) / round) / 2, Math.sin((2 * Math.PI * (i % round)) / round) / 2, z];
  for (let i = 0; i < round; i++) {
    const quad = [at(i, -0.5), at(i + 1, -0.5), at(i + 1, 0.5), at(i, 0.5)];
    for (const k of [0, 1, 2, 0, 2, 3]) faces.push([...quad[k], 2 * quad[k][0], 2 * quad[k][1], 0]);
    for (const z of [-0.5, 0.5]) {
      const [a, b] = z > 0 ? [i, i + 1] : [i + 1, i];
      if (i) for (const p of [at(0, z), at(a, z), at(b, z)]) faces.push([...p, 0, 0, 2 * z]);
      lines.push(...at(i, z), ...at(i + 1, z));
    }
  }
  // A mark on each end, or nobody would see it turn.
  for (const z of [-0.501, 0.501]) lines.push(0.12, 0, z, 0.46, 0, z);
  return { ...indexed(faces), lines: new Float32Array(lines) };
}

function ballShape(round) {
  const [around, down] = [Math.round(round * 0.6), Math.round(round * 0.35)];
  const faces = [];
  const at = (i, j) => {
    const [a, b] = [(2 * Math.PI * (i % around)) / around, (Math.PI * j) / down];
    return [(Math.sin(b) * Math.cos(a)) / 2, (Math.sin(b) * Math.sin(a)) / 2, Math.cos(b) / 2];
  };
  for (let i = 0; i < around; i++)
    for (let j = 0; j < down; j++) {
      const quad = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
      for (const k of [0, 1, 2, 0, 2, 3]) faces.push([...quad[k], ...scaled(quad[k], 2)]);
    }
  return { ...indexed(faces), lines: new Float32Array(0) };
}

/** A mesh with its sharp edges as lines, smooth across the others. */
function meshShape({ points, triangles }) {
  const p = i => points.slice(3 * i, 3 * i + 3);
  const count = triangles.length / 3;
  const normals = [];
  const around = new Map();
  const edges = new Map();
  for (let t = 0; t < count; t++) {
    const [a, b, c] = triangles.slice(3 * t, 3 * t + 3);
    normals.push(unit(cross(sub(p(b), p(a)), sub(p(c), p(a)))));
    for (const [i, j] of [[a, b], [b, c], [c, a]]) {
      if (!around.has(i)) around.set(i, []);
      around.get(i).push(t);
      const key = Math.min(i, j) + "," + Math.max(i, j);
      if (!edges.has(key)) edges.set(key, []);
      edges.get(key).push(t);
    }
  }
  const faces = [];
  for (let t = 0; t < count; t++)
    for (let k = 0; k < 3; k++) {
      const i = triangles[3 * t + k];
      const smooth = around.get(i).filter(o => dot(normals[o], normals[t]) > CREASE);
      faces.push([...p(i), ...unit(smooth.reduce((sum, o) => add(sum, normals[o]), [0, 0, 0]))]);
    }
  const lines = [];
  for (const [key, [a, b]] of edges)
    if (b === undefined || dot(normals[a], normals[b]) < CREASE) {
      const [i, j] = key.split(",").map(Number);
      lines.push(...p(i), ...p(j));
    }
  return { ...indexed(faces), lines: new Float32Array(lines) };
}
