// The level of detail of each body: by its size on the screen, and not at all where it is out of the
// picture. A robot of hundreds of modules costs no more than what can be seen of it.

/** From this diameter on, in pixels, round things are drawn with so many pieces a full turn. */
const DETAILS = [{ from: 100, round: 40 }, { from: 28, round: 16 }, { from: 0, round: 8 }];
/** A module smaller than this is drawn as one box, in pixels. */
const SPECK = 6;
/** The shade of fittings, which are of metal whatever the colour of their module. */
const METAL = 9;
const METAL_COLOUR = [0.42, 0.45, 0.48];
const BOX = 0;
const MESHES = 3;
/** Numbers of an instance: its three sides and its place in the world by rows [side, coordinate of the
    place], colour and glow, number of the body, three that fill up its last texel. */
const INSTANCE = 20;
/** Indices of a mesh that are drawn at once, in as many copies as it takes: what draws in software begins anew for every
    instance, which takes longer than a small mesh does. */
const DRAWN_AT_ONCE = 6000;
/** A place that no picture shows, m: that of copies without an instance. */
const NOWHERE = 1e9;
/** Numbers of a solid in its body: three sides, place. */
const SOLID = 12;

/** The solids of a list as instances: what of them is drawn is chosen for every picture. */
function instancesOf(gl, meshes, plan, motion, solids) {
  const own = new Float32Array(SOLID * solids.length);
  const fill = (target, i, { p, q, s }) => target.set([...[0, 1, 2].flatMap(k => turned(q, [0, 1, 2].map(r => (r === k ? s[k] : 0)))), ...p], SOLID * i);
  solids.forEach((solid, i) => fill(own, i, solid));
  const shades = solids.map(({ shade, metal }) => (metal ? METAL : SHADES[shade % SHADES.length]));
  const modules = modulesOf(plan, motion, solids);
  const specks = new Float32Array(SOLID * modules.length);
  let known = false;
  const counts = new Map();
  solids.forEach(({ shape }) => counts.set(shape, (counts.get(shape) || 0) + 1));
  /** A batch for each fineness of each shape; the last is for specks, of which no edges are seen. */
  const batches = new Map();
  for (const [shape, count] of counts) batches.set(shape, meshes[shape].map(mesh => batchOf(gl, mesh, count, shape < MESHES, true)));
  const far = batchOf(gl, meshes[BOX][0], modules.length, true, false);
  const all = [...[...batches.values()].flat(), far];
  const levelsOf = solids.map(({ shape }) => batches.get(shape));
  const wide = solids.map(({ s }) => Math.max(s[0], s[1]));
  const least = solids.map(({ least }) => least || 0);

  /** Chooses for a camera: poses X, view matrix, pixels of a metre at a distance of one; of `within`
      only what is in its picture. */
  function choose(X, view, pixels, within) {
    if (!known) modules.forEach((module, i) => fill(specks, i, speckOf(module, X)));
    known = true;
    for (const batch of all) batch.count = 0;
    const sides = within && sidesOf(within);
    modules.forEach((bodies, m) => {
      const i = POSE * bodies[0].body;
      const [x, y, z] = [X[i], X[i + 1], X[i + 2]];
      let reach = 0;
      for (const { body, reach: own } of bodies) {
        const k = POSE * body;
        reach = Math.max(reach, Math.hypot(X[k] - x, X[k + 1] - y, X[k + 2] - z) + own * Math.max(X[k + 8], X[k + 9], X[k + 10]));
      }
      if (sides && sides.some(([a, b, c, d, n]) => a * x + b * y + c * z + d < -n * reach)) return;
      const away = Math.max(view[3] * x + view[7] * y + view[11] * z + view[15] - reach, 1e-3);
      if ((2 * reach * pixels) / away < SPECK) return far.add(specks, m, frameOf(X, bodies[0].body), 0);
      for (const { body, first, after } of bodies) {
        const frame = frameOf(X, body);
        const seen = (Math.max(X[POSE * body + 8], X[POSE * body + 9]) * pixels) / away;
        for (let j = first; j < after; j++) {
          if (wide[j] * seen < least[j]) continue;
          const levels = levelsOf[j];
          let level = 0;
          while (level + 1 < levels.length && wide[j] * seen < DETAILS[level].from) level++;
          levels[level].add(own, j, frame, shades[j]);
        }
      }
    });
    for (const batch of all) batch.upload();
  }

  return { batches: all, choose };
}

/** A body as it stands in X: m takes its own coordinates to the world's, its size within. */
const frame_ = { m: new Float64Array(12), colour: new Float64Array(4), body: 0 };
function frameOf(X, body) {
  const i = POSE * body;
  const [x, y, z, w] = [X[i + 4], X[i + 5], X[i + 6], X[i + 7]];
  const [a, b, c] = [X[i + 8], X[i + 9], X[i + 10]];
  const { m, colour } = frame_;
  (m[0] = a * (1 - 2 * (y * y + z * z))), (m[1] = a * 2 * (x * y + z * w)), (m[2] = a * 2 * (x * z - y * w));
  (m[3] = b * 2 * (x * y - z * w)), (m[4] = b * (1 - 2 * (x * x + z * z))), (m[5] = b * 2 * (y * z + x * w));
  (m[6] = c * 2 * (x * z + y * w)), (m[7] = c * 2 * (y * z - x * w)), (m[8] = c * (1 - 2 * (x * x + y * y)));
  for (let k = 0; k < 3; k++) m[9 + k] = X[i + k];
  for (let k = 0; k < 4; k++) colour[k] = X[i + 12 + k];
  frame_.body = body;
  return frame_;
}

/** The bodies of each module, which follow each other, and so do their solids: which solids, a box around
    them in the body's frame, and how far it reaches. */
function modulesOf(plan, motion, solids) {
  const modules = [];
  let [last, body] = [-1, null];
  solids.forEach((solid, i) => {
    if (!body || body.body !== solid.body) {
      body = { body: solid.body, first: i, shade: solid.shade, low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity], reach: 0 };
      if (motion.moduleOf[solid.body] !== last) modules.push([]);
      last = motion.moduleOf[solid.body];
      modules[modules.length - 1].push(body);
    }
    body.after = i + 1;
    for (const corner of cornersOf(plan, solid)) {
      const p = add(solid.p, turned(solid.q, corner));
      widen(body, p);
      body.reach = Math.max(body.reach, norm(p));
    }
  });
  return modules;
}

function widen({ low, high }, p) {
  for (let k = 0; k < 3; k++) (low[k] = Math.min(low[k], p[k])), (high[k] = Math.max(high[k], p[k]));
}

/** A module as one box, as it stands in X, fixed to its first body. */
function speckOf(bodies, X) {
  const at = body => [0, 4, 8].map(k => Array.from(X.subarray(POSE * body + k, POSE * body + k + (k === 4 ? 4 : 3))));
  const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  const [origin, [x, y, z, w], grown] = at(bodies[0].body);
  for (const { body, low, high } of bodies) {
    const [p, q, s] = at(body);
    for (let i = 0; i < 8; i++) {
      const corner = [0, 1, 2].map(k => (i >> k & 1 ? high : low)[k] * s[k]);
      const own = turned([-x, -y, -z, w], sub(add(p, turned(q, corner)), origin));
      widen(box, own.map((c, k) => c / grown[k]));
    }
  }
  const { body, shade } = bodies[0];
  return { body, shade, p: scaled(add(box.low, box.high), 0.5), q: [0, 0, 0, 1], s: box.high.map((h, k) => Math.max(h - box.low[k], 1e-6)) };
}

function cornersOf(plan, { shape, s }) {
  if (shape < MESHES) return [0, 1, 2, 3, 4, 5, 6, 7].map(i => [0, 1, 2].map(k => (i >> k & 1 ? 0.5 : -0.5) * s[k]));
  const { points } = plan.meshes[shape - MESHES];
  return Array.from({ length: points.length / 3 }, (_, i) => points.slice(3 * i, 3 * i + 3));
}

/** The planes around what a matrix shows, but the far one: [a, b, c, d, length of (a, b, c)]. */
function sidesOf(m) {
  const row = r => [m[r], m[4 + r], m[8 + r], m[12 + r]];
  const last = row(3);
  return [[0, 1], [0, -1], [1, 1], [1, -1], [2, 1]].map(([r, sign]) => {
    const side = row(r).map((x, k) => last[k] + sign * x);
    return [...side, norm(side)];
  });
}

/** Instances of one mesh, filled anew for every picture. They lie in a texture, from which every vertex reads its own: the
    mesh is there in several copies. `closed`: its inside is never seen. */
function batchOf(gl, mesh, capacity, closed, edged) {
  const { copies } = mesh;
  const rows = Math.ceil((capacity + copies) / PER_ROW);
  const data = new Float32Array(INSTANCE * PER_ROW * rows);
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE2);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, (PER_ROW * INSTANCE) / 4, rows);
  for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.NEAREST);
  return {
    count: 0,
    /** A solid as its body stands. Parts of one module are told apart by brightness, not by hue. */
    add(own, i, { m, colour, body }, shade) {
      const to = INSTANCE * this.count++;
      for (let c = 0; c < 4; c++) {
        const [x, y, z] = [own[SOLID * i + 3 * c], own[SOLID * i + 3 * c + 1], own[SOLID * i + 3 * c + 2]];
        for (let r = 0; r < 3; r++) {
          const value = m[r] * x + m[3 + r] * y + m[6 + r] * z;
          if (c < 3) data[to + 4 * c + r] = value;
          else data[to + 4 * r + 3] = value + m[9 + r];
        }
      }
      if (shade === METAL) return data.set([...METAL_COLOUR, -1, body], to + 12);
      const grey = 0.3 * colour[0] + 0.6 * colour[1] + 0.1 * colour[2];
      for (let k = 0; k < 3; k++) data[to + 12 + k] = shade ? mix(colour[k], grey, 0.45) * (1 + 0.55 * shade) : colour[k];
      data[to + 15] = colour[3];
      data[to + 16] = body;
    },
    upload() {
      if (!this.count) return;
      for (let i = this.count; i % copies; i++) {
        data.fill(0, INSTANCE * i, INSTANCE * (i + 1));
        for (let r = 0; r < 3; r++) data[INSTANCE * i + 4 * r + 3] = NOWHERE;
      }
      gl.activeTexture(gl.TEXTURE2);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, (PER_ROW * INSTANCE) / 4, Math.ceil(this.count / PER_ROW), gl.RGBA, gl.FLOAT, data);
    },
    /** Draws them as `faces` or as `lines`; says how many calls it took. */
    draw(what) {
      const part = mesh[what];
      if (!this.count || !part.length || (what === "lines" && !edged)) return 0;
      gl.activeTexture(gl.TEXTURE2);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.bindVertexArray(part.array);
      const length = part.length * Math.min(copies, this.count);
      const times = Math.ceil(this.count / copies);
      if (what === "lines") gl.drawArraysInstanced(gl.LINES, 0, length, times);
      else {
        (closed ? gl.enable : gl.disable).call(gl, gl.CULL_FACE);
        gl.drawElementsInstanced(gl.TRIANGLES, length, gl.UNSIGNED_INT, 0, times);
      }
      return 1;
    },
    free: () => gl.deleteTexture(texture),
  };
}
