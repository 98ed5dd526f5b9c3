// Shapes as triangles and as the lines of their edges. 0 is a box, 1 a cylinder along z, 2 a ball,
// all of size 1; from 3 on the meshes of the plan.

/** Faces that meet at less than this are drawn as one smooth surface. */
const CREASE = Math.cos((32 * Math.PI) / 180);

/** Every shape, each in the finenesses in which it is drawn, the finest first. */
function shapesOf(plan, rounds) {
  return [rounds.map((round, i) => boxShape(i + 1 < rounds.length)), rounds.map((round, i) => cylinderShape(round, i + 1 < rounds.length)), rounds.map(ballShape), ...(plan.meshes || []).map(mesh => [meshShape(mesh)])];
}

/** Corners [x, y, z, normal, inset], three a triangle, as corners that are there once, and their indices. */
function indexed(corners) {
  const known = new Map();
  const faces = [];
  const index = corners.map(corner => {
    const key = corner.join();
    if (!known.has(key)) known.set(key, known.size), faces.push(...corner, ...(corner.length < 9 ? [0, 0, 0] : []));
    return known.get(key);
  });
  return { faces: new Float32Array(faces), index: new Uint32Array(index) };
}

/** The corners of a convex polygon as a fan of triangles, turned so that it faces along its normals. */
function fan(faces, ring) {
  const p = ring.map(corner => corner.slice(0, 3).map((x, k) => x - 0.2 * corner[6 + k]));
  const outwards = dot(cross(sub(p[1], p[0]), sub(p[2], p[0])), add(add(ring[0].slice(3, 6), ring[1].slice(3, 6)), ring[2].slice(3, 6))) > 0;
  const turned_ = outwards ? ring : [...ring].reverse();
  for (let i = 2; i < ring.length; i++) faces.push(turned_[0], turned_[i - 1], turned_[i]);
}

/** A box, with rounded edges or without: its faces are drawn in from the edges, strips and corners lie between them. */
function boxShape(rounded) {
  const faces = [];
  const lines = [];
  /** A corner of the box as a corner of its face along an axis. */
  const corner = (signs, axis) => [
    ...signs.map(x => x / 2), ...[0, 1, 2].map(k => (k === axis ? signs[k] : 0)), ...signs.map((x, k) => (k === axis || !rounded ? 0 : x)),
  ];
  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const signs = (a, b, c) => [0, 1, 2].map(k => (k === axis ? a : k === u ? b : c));
    for (const side of [-1, 1]) {
      fan(faces, [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([b, c]) => corner(signs(side, b, c), axis)));
      for (const other of [-1, 1]) {
        const ends = [signs(-1, side, other), signs(1, side, other)];
        if (rounded) fan(faces, [corner(ends[0], u), corner(ends[1], u), corner(ends[1], v), corner(ends[0], v)]);
        for (const end of ends) lines.push(...end.map(x => x / 2), ...end.map(x => (rounded ? x / 2 : 0)));
      }
    }
  }
  for (let i = 0; rounded && i < 8; i++) {
    const signs = [0, 1, 2].map(k => (i >> k & 1 ? 1 : -1));
    fan(faces, [0, 1, 2].map(axis => corner(signs, axis)));
  }
  return { ...indexed(faces), lines: new Float32Array(lines) };
}

/** A cylinder, with rounded rims or without. */
function cylinderShape(round, rounded) {
  const faces = [];
  const lines = [];
  const out = i => [Math.cos((2 * Math.PI * (i % round)) / round), Math.sin((2 * Math.PI * (i % round)) / round)];
  const inset = rounded ? 1 : 0;
  const side = (i, z) => { const [c, s] = out(i); return [c / 2, s / 2, z / 2, c, s, 0, 0, 0, inset * z]; };
  const lid = (i, z) => { const [c, s] = out(i); return [c / 2, s / 2, z / 2, 0, 0, z, inset * c, inset * s, 0]; };
  for (let i = 0; i < round; i++) {
    fan(faces, [side(i, -1), side(i + 1, -1), side(i + 1, 1), side(i, 1)]);
    for (const z of [-1, 1]) {
      if (rounded) fan(faces, [side(i, z), side(i + 1, z), lid(i + 1, z), lid(i, z)]);
      if (i && i + 1 < round) fan(faces, [lid(0, z), lid(i, z), lid(i + 1, z)]);
      for (const k of [i, i + 1]) lines.push(...side(k, z).slice(0, 3), ...out(k).map(x => (inset * x) / 2), (inset * z) / 2);
    }
  }
  // A mark on each end, or nobody would see it turn.
  for (const z of [-0.501, 0.501]) lines.push(0.12, 0, z, 0, 0, 0, 0.40, 0, z, 0, 0, 0);
  return { ...indexed(faces), lines: new Float32Array(lines) };
}

function ballShape(round) {
  const [around, down] = [Math.round(round * 0.8), Math.round(round * 0.45)];
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
      lines.push(...p(i), 0, 0, 0, ...p(j), 0, 0, 0);
    }
  return { ...indexed(faces), lines: new Float32Array(lines) };
}
