// The pose of every body at a time. One motion per family, all with the same interface:
//   bodies       how many there are
//   solids       what is drawn: {body, shape, p, q, s}; `collides` the same for the judge's shapes
//   moduleOf     the module (cell, node, strut) of each body, an index of `modules`
//   modules      {name, type, group}: group is the part that gives the colour
//   place(t, X)  writes position, rotation and size of each body into X, 16 numbers a body
//   joints       {module, name, turns}; `driven` those that plans move; jointsOf(module), jointAt(joint, t)
//   causes(t)    indices of what commands the motion at t
//   facts(b, t)  lines about a body for the tooltip

/** Smaller than this on the screen, in pixels, fittings and the plates of cells are not drawn. */
const FITTING = 7;
const PLATE = 22;

/** Numbers of a body in X: place, -, rotation, size, -, colour, glow. */
const POSE = 16;

function motionOf(plan) {
  const body = plan.body;
  //: if (plan.simulation) return measuredMotion(plan, robotMotion(plan, body));
  if (body.form === "tracks") return robotMotion(plan, body);
  if (body.form === "stages") return latticeMotion(plan, body);
  if (body.form === "node_paths") return trussMotion(plan, body);
  throw new Error("a plan of the form " + body.form + " can't be drawn");
}

/** The part that each path name belongs to: its first step that is not the same for all, as `leg[2]` of `leg[2].m[0]`. */
function groupsOf(names) {
  const paths = names.map(name => name.split("."));
  let step = 0;
  while (paths.every(path => path.length > step + 1 && path[step] === paths[0][step])) step++;
  return paths.map(path => path[step]);
}

/** The value of a polynomial in Bernstein form, by de Casteljau's rule. */
function bernstein(segment, first, u) {
  const n = segment.length - first;
  if (u <= 0) return segment[first];
  if (u >= 1) return segment[segment.length - 1];
  for (let i = 0; i < n; i++) scratch[i] = segment[first + i];
  for (let last = n - 1; last > 0; last--)
    for (let i = 0; i < last; i++) scratch[i] += (scratch[i + 1] - scratch[i]) * u;
  return scratch[0];
}
const scratch = new Float64Array(32);

function robotMotion(plan, body) {
  const firstLink = [];
  const modules = [];
  const links = [];
  const joints = [];
  const solids = [];
  const collides = [];
  const groups = groupsOf(body.modules.map(([name]) => name));
  body.modules.forEach(([name, kind], module) => {
    const type = body.kinds[kind];
    firstLink.push(links.length);
    modules.push({ name, type: type.name, group: groups[module] });
    type.links.forEach((link, index) => {
      for (const solid of link.solids) solids.push({ ...solid, body: links.length, shade: index });
      for (const solid of link.fittings) solids.push({ ...solid, body: links.length, metal: true, least: FITTING });
      for (const solid of link.collides || link.solids) collides.push({ ...solid, body: links.length, shade: index });
      links.push({ module, name: link.name });
    });
    type.joints.forEach(joint => joints.push({ module, name: joint.name, turns: joint.turns, still: joint.still }));
  });
  // Obstacles stay where their shapes are.
  const moving = links.length;
  for (const { name, solids: own } of body.around || []) {
    for (const solid of own) for (const list of [solids, collides]) list.push({ ...solid, body: links.length, shade: 0 });
    links.push({ module: modules.length, name });
    modules.push({ name, type: name.replace(/\[[0-9]+\]$/, ""), group: "surroundings", around: true });
  }
  body.hinges.forEach(([name, ...between]) => joints.push({ module: -1, between, name, turns: true }));
  const belongs = (j, module) => !joints[j].still && (joints[j].module === module || Boolean(joints[j].between && joints[j].between.includes(module)));
  const starts = body.tracks.map(([, segments]) => segments.map(s => s[0]));
  const n = links.length;
  const state = { q: new Float64Array(body.start), P: new Float64Array(3 * n), Q: new Float64Array(4 * n) };
  for (let i = moving; i < n; i++) state.Q[4 * i + 3] = 1;
  const treeTimes = body.trees.map(tree => tree.time);
  const baseTimes = body.base.map(key => key[0]);
  const driven = [...new Set(body.tracks.map(([joint]) => joint))];

  /** The segment of a track that has begun at t. */
  const segmentAt = (track, t) => {
    const at = lastNotAbove(starts[track], t);
    return at < 0 ? null : body.tracks[track][1][at];
  };

  function jointsAt(t) {
    state.q.set(body.start);
    body.tracks.forEach(([joint], track) => {
      const s = segmentAt(track, t);
      if (s) state.q[joint] = bernstein(s, 3, (t - s[0]) / (s[1] - s[0]));
    });
    return state.q;
  }

  /** Position and rotation on a path, from the judge's walk. */
  function baseAt(t, keys = body.base, times = baseTimes) {
    const at = lastNotAbove(times, t);
    const a = keys[Math.max(at, 0)];
    const b = keys[Math.min(at + 1, keys.length - 1)];
    const u = b[0] > a[0] ? clamp((t - a[0]) / (b[0] - a[0]), 0, 1) : 0;
    const sign = a[4] * b[4] + a[5] * b[5] + a[6] * b[6] + a[7] * b[7] < 0 ? -1 : 1;
    const q = [4, 5, 6, 7].map(i => mix(a[i], sign * b[i], u));
    const length = Math.hypot(...q);
    return { p: [1, 2, 3].map(i => mix(a[i], b[i], u)), q: q.map(c => c / length) };
  }

  function walk(tree, q, base) {
    const { P, Q } = state;
    P.set(base.p, 3 * tree.root);
    Q.set(base.q, 4 * tree.root);
    for (const [link, parent, form, joint] of tree.steps) {
      const f = body.forms[form];
      const parentQ = [Q[4 * parent], Q[4 * parent + 1], Q[4 * parent + 2], Q[4 * parent + 3]];
      let turn = product(parentQ, f.turn);
      let shift = f.shift;
      let x = 0;
      if (typeof joint === "number") x = q[joint];
      else if (joint) for (let i = 0; i < joint.length; i += 2) x += joint[i + 1] * q[joint[i]];
      if (f.axis) turn = product(turn, about(f.axis, x));
      if (f.along) shift = add(shift, scaled(f.along, x));
      const p = turned(parentQ, shift);
      const o = f.offset ? turned(turn, f.offset) : [0, 0, 0];
      for (let i = 0; i < 3; i++) P[3 * link + i] = P[3 * parent + i] + p[i] + o[i];
      Q.set(turn, 4 * link);
    }
  }

  const pathTimes = (body.paths || []).map(keys => keys.map(key => key[0]));

  /** Parts that have come off follow their own paths; modules of which no path is known stay where they were. */
  function poses(t) {
    const at = Math.max(lastNotAbove(treeTimes, t), 0);
    for (let i = 0; i < at; i++)
      if (body.trees[i + 1].loose) walk(body.trees[i], jointsAt(treeTimes[i + 1]), baseAt(treeTimes[i + 1]));
    const q = jointsAt(t);
    walk(body.trees[at], q, baseAt(t));
    for (const part of body.trees[at].parts || []) walk(part, q, baseAt(t, body.paths[part.path], pathTimes[part.path]));
  }

  return {
    bodies: n,
    solids,
    collides: body.kinds.some(kind => kind.links.some(link => link.collides)) ? collides : null,
    moduleOf: links.map(link => link.module),
    modules,
    joints,
    driven,
    jointsOf: module => joints.flatMap((_, j) => (belongs(j, module) ? [j] : [])),
    jointAt: (joint, t) => jointsAt(t)[joint],
    jointName: j => (joints[j].module < 0 ? joints[j].name : modules[joints[j].module].name + "." + joints[j].name),
    //: walk,
    //: write: X => { for (let i = 0; i < n; i++) X.set([...state.P.subarray(3 * i, 3 * i + 3), 0, ...state.Q.subarray(4 * i, 4 * i + 4), 1, 1, 1], POSE * i); },
    place(t, X) {
      poses(t);
      const { P, Q } = state;
      for (let i = 0; i < n; i++) {
        X.set([P[3 * i], P[3 * i + 1], P[3 * i + 2], 0, Q[4 * i], Q[4 * i + 1], Q[4 * i + 2], Q[4 * i + 3], 1, 1, 1], POSE * i);
      }
    },
    causes(t) {
      const found = new Set();
      body.tracks.forEach((_, track) => {
        const s = segmentAt(track, t);
        if (s && t < s[1]) found.add(s[2]);
      });
      for (const dock of body.docks) if (Math.abs(dock[0] - t) < 0.25) found.add(dock[3]);
      return found;
    },
    /** When each cause begins to command something. */
    beginnings() {
      const found = [];
      body.tracks.forEach(([, segments]) => segments.forEach(s => found.push([s[0], s[2]])));
      for (const dock of body.docks) found.push([dock[0], dock[3]]);
      return found;
    },
    events: body.docks.map(([time, docks, bond]) => ({ time, kind: "dock", text: (docks ? "docks " : "undocks ") + body.bonds[bond] })),
    facts(b, t) {
      const link = links[b];
      const q = jointsAt(t);
      const lines = [["type", modules[link.module].type], ["link", link.name]];
      joints.forEach((joint, j) => {
        if (!belongs(j, link.module)) return;
        lines.push([joint.name, joint.turns ? ((q[j] * 180) / Math.PI).toFixed(1) + "°" : (q[j] * 1000).toFixed(1) + " mm"]);
      });
      return lines;
    },
  };
}

/** What motions have in common in which every body is a module of its own, without joints. */
const eachItsOwn = modules => ({ collides: null, moduleOf: modules.map((_, i) => i), modules, joints: [], driven: [] });

/** How far between its ends a stage is, with ramps at its start and its end. */
function stageProgress([first, last], u) {
  u = clamp(u, 0, 1);
  const speed = 2 / (2 - first - last);
  if (u < first) return (speed * u * u) / (2 * first);
  if (u <= 1 - last) return speed * (u - first / 2);
  return 1 - (speed * (1 - u) * (1 - u)) / (2 * last);
}

const commonDivisor = (a, b) => (b ? commonDivisor(b, a % b) : a);

/** More cells than this are drawn only in part. */
const CELLS_MAX = 30000;
/** Boxes of all kept configurations together. */
const KEPT_MAX = 2e6;

function latticeMotion(plan, body) {
  const every = Math.ceil(body.count / CELLS_MAX);
  const n = Math.ceil(body.count / every);
  if (every > 1) plan.notes.push(`of ${body.count} cells one in ${every} is drawn`);
  // Configurations are differences: each stage names the cells that it moves, in runs that count along
  // axes. Of the innermost axis only the cells that are drawn are gone through.
  const fill = (boxes, runs, every) => {
    for (const [first, counters, [x, y, z], size] of runs) {
      const along = (c, cell, x, y, z) => {
        const [count, stride, dx, dy, dz] = counters[c] || [1, 0, 0, 0, 0];
        const last = c + 1 >= counters.length;
        const period = last ? every / commonDivisor(Math.abs(stride), every) : 1;
        let k = 0;
        if (last) while (k < period && (cell + stride * k) % every) k++;
        if (k === period && last) return;
        for (; k < count; k += period) {
          const here = cell + stride * k;
          if (!last) along(c + 1, here, x + dx * k, y + dy * k, z + dz * k);
          else {
            const i = (6 * here) / every;
            boxes[i] = x + dx * k;
            boxes[i + 1] = y + dy * k;
            boxes[i + 2] = z + dz * k;
            boxes[i + 3] = size[0];
            boxes[i + 4] = size[1];
            boxes[i + 5] = size[2];
          }
        }
      };
      along(0, first, x, y, z);
    }
    return boxes;
  };
  // Or it says which move each cell makes: of every class of cells the displacement and the growth.
  const shift = (boxes, [classes, spans]) => {
    let cell = 0;
    for (const span of spans) {
      const [k, count] = span.length ? span : [span, 1];
      const end = cell + count;
      for (let i = 6 * Math.ceil(cell / every); i * every < 6 * end; i += 6)
        for (let axis = 0; axis < 6; axis++) boxes[i + axis] += classes[k][axis];
      cell = end;
    }
    return boxes;
  };
  const after = (boxes, stage) => (stage.moves ? shift(boxes.slice(), stage.moves) : fill(boxes.slice(), stage.end, every));
  const around = body.obstacles.reduce((count, run) => count + run[1].reduce((n, counter) => n * counter[0], 1), 0);
  const obstacles = fill(new Float64Array(6 * around), body.obstacles, 1);
  const times = [0];
  for (const stage of body.stages) times.push(times[times.length - 1] + stage.duration);
  // Configurations at the stages' ends: every so many are kept, those between are found again from the
  // one before, and the last two are at hand.
  const apart = Math.ceil(((body.stages.length + 1) * n) / KEPT_MAX);
  const kept = [fill(new Float64Array(6 * n), body.start, every)];
  const hand = new Map();
  let low = Infinity;
  const lower = boxes => {
    for (let i = 0; i < n; i++) low = Math.min(low, boxes[6 * i + 2] - boxes[6 * i + 5] / 2);
  };
  for (let i = 0; i < around; i++) low = Math.min(low, obstacles[6 * i + 2] - obstacles[6 * i + 5] / 2);
  lower(kept[0]);
  body.stages.reduce((boxes, stage, i) => {
    const next = after(boxes, stage);
    lower(next);
    if ((i + 1) % apart === 0) kept.push(next);
    return next;
  }, kept[0]);
  const endAt = index => {
    if (index % apart === 0) return kept[index / apart];
    if (!hand.has(index)) {
      const boxes = after(endAt(index - 1), body.stages[index - 1]);
      if (hand.size > 1) hand.delete(hand.keys().next().value);
      hand.set(index, boxes);
    }
    return hand.get(index);
  };
  const stageAt = t => clamp(lastNotAbove(times, t), 0, Math.max(body.stages.length - 1, 0));
  const modules = Array.from({ length: n }, (_, i) => ({ name: "cell " + i * every, type: body.cell, group: "" }));
  for (let i = 0; i < around; i++) modules.push({ name: "obstacle " + i, type: "obstacle", group: "surroundings", around: true });
  return {
    bodies: n + around,
    // A cube with a plate on each face, if it is near.
    solids: modules.flatMap((module, i) => module.around ? [{ body: i, shape: 0, p: [0, 0, 0], q: [0, 0, 0, 1], s: [1, 1, 1], shade: 0 }] : [[[0.97, 0.97, 0.97], 0, 0], ...[0, 1, 2].map(axis => [[0, 1, 2].map(k => (k === axis ? 0.985 : 0.72)), 5, PLATE])]
      .map(([s, shade, least]) => ({ body: i, shape: 0, p: [0, 0, 0], q: [0, 0, 0, 1], s, shade, least }))),
    ...eachItsOwn(modules),
    place(t, X) {
      const at = stageAt(t);
      const stage = body.stages[at];
      const a = endAt(at);
      const b = stage ? endAt(at + 1) : a;
      const u = stage ? stageProgress(stage.law, stage.duration > 0 ? (t - times[at]) / stage.duration : 1) : 0;
      for (let i = 0; i < n + around; i++) {
        const box = k => (i < n ? mix(a[6 * i + k], b[6 * i + k], u) : obstacles[6 * (i - n) + k]) * body.size;
        X.set([box(0), box(1), box(2) - low * body.size, 0, 0, 0, 0, 1, box(3), box(4), box(5)], POSE * i);
      }
    },
    causes: t => new Set(body.stages.length ? [body.stages[stageAt(t)].cause] : []),
    beginnings: () => body.stages.map((stage, i) => [times[i], stage.cause]),
    events: body.stages.map((stage, i) => ({ time: times[i], kind: "stage", text: stage.name })),
    facts(b, t) {
      const X = new Float32Array(POSE * this.bodies);
      this.place(t, X);
      return [["type", modules[b].type], ["size", [8, 9, 10].map(k => (X[POSE * b + k] * 1000).toFixed(0)).join(" × ") + " mm"]];
    },
    /** How much smaller than at rest each cell is, 0..1: for the colours. */
    squeezed: (X, i) => 1 - (X[POSE * i + 8] * X[POSE * i + 9] * X[POSE * i + 10]) / body.size ** 3,
  };
}

/** Ways of a truss that are marked one by one. */
const KEYFRAMES_MARKED = 12;

/** The progress of a step, 0..1: even, or with a trapezoid of rates of which `before` and `after` are cut off. */
function stepProgress(ramps, duration, t) {
  if (!ramps) return t / duration;
  const [up, down, before, after] = ramps;
  const risen = clamp(up - before, 0, duration);
  const falls = clamp(duration + after - down, risen, duration);
  const over = t => {
    const rise = up > 0 ? (Math.min(t, risen) * (Math.min(t, risen) + 2 * before)) / (2 * up) : 0;
    const [first, last] = [duration - falls + after, duration - Math.max(t, falls) + after];
    return rise + Math.max(Math.min(t, falls) - risen, 0) + (down > 0 ? (first * first - last * last) / (2 * down) : 0);
  };
  return over(t) / over(duration);
}

function trussMotion(plan, body) {
  const nodes = body.nodes.length;
  const times = body.keyframes.map(keyframe => keyframe.time);
  const lengths = (P, [a, b]) => norm(sub(P(a), P(b)));
  const start = i => body.keyframes[0].at.slice(3 * i, 3 * i + 3);
  // The ends of the struts from each event on, at which nodes merge or split.
  const ends = [body.struts];
  for (const { ends: changed } of body.events) {
    const next = [...ends[ends.length - 1]];
    for (const [strut, a, b] of changed) next[strut] = [a, b];
    ends.push(next);
  }
  const changes = body.events.map(event => event.time);
  const strutsAt = t => ends[lastNotAbove(changes, t) + 1];
  const typical = body.struts.reduce((sum, strut) => sum + lengths(start, strut), 0) / Math.max(body.struts.length, 1);
  const thick = clamp(typical * 0.03, 1e-4, 1);
  const modules = body.nodes.map(name => ({ name, type: "node", group: "nodes" }));
  body.struts.forEach(([a, b]) => modules.push({ name: body.nodes[a] + " -- " + body.nodes[b], type: body.strut, group: "struts" }));
  const moving = modules.length;
  // The surface that it takes on is fixed to a body that is not drawn.
  const target = plan.target === undefined ? null : [{ body: modules.length + body.around.length, shape: 3 + plan.target, p: [0, 0, 0], q: [0, 0, 0, 1], s: [1, 1, 1], shade: 0 }];
  for (const { name } of body.around) modules.push({ name, type: name.replace(/ [0-9]+$/, ""), group: "surroundings", around: true });
  if (target) modules.push({ name: "target", type: "target", group: "surroundings", around: true });
  // A strut is a thick tube with a thinner rod that slides in it, as linear actuators are.
  const solids = [];
  modules.forEach((_, i) => {
    const solid = (shape, p, s, shade, rest) => solids.push({ body: i, shape, p, q: [0, 0, 0, 1], s, shade, ...rest });
    if (i >= moving + body.around.length) return;
    if (i >= moving) return body.around[i - moving].solids.forEach(s => solids.push({ ...s, body: i, shade: 0, endless: body.around[i - moving].name === "ground" }));
    if (i < nodes) return solid(2, [0, 0, 0], [2.6 * thick, 2.6 * thick, 2.6 * thick], 0);
    solid(1, [0, 0, 0], [thick * 0.56, thick * 0.56, 0.96], 1, { metal: true });
    solid(1, [0, 0, -0.21], [thick, thick, 0.5], 0);
    solid(1, [0, 0, 0.03], [thick * 1.24, thick * 1.24, 0.03], 1, { metal: true, least: FITTING });
  });
  function nodesAt(t) {
    const after = lastNotAbove(times, t) + 1;
    const a = body.keyframes[Math.max(after - 1, 0)];
    const b = body.keyframes[after];
    if (!b) return i => a.at.slice(3 * i, 3 * i + 3);
    const u = stepProgress(b.ramps, b.time - a.time, t - a.time);
    if (!b.roll) return i => [0, 1, 2].map(k => mix(a.at[3 * i + k], b.at[3 * i + k], u));
    const [from, to, angle] = b.roll;
    const origin = a.at.slice(3 * from, 3 * from + 3);
    const q = about(unit(sub(a.at.slice(3 * to, 3 * to + 3), origin)), angle * u);
    return i => add(origin, turned(q, sub(a.at.slice(3 * i, 3 * i + 3), origin)));
  }
  return {
    bodies: modules.length,
    solids,
    target,
    ...eachItsOwn(modules),
    place(t, X) {
      const at = nodesAt(t);
      for (let i = 0; i < nodes; i++) X.set([...at(i), 0, 0, 0, 0, 1, 1, 1, 1], POSE * i);
      strutsAt(t).forEach(([a, b], s) => {
        const [pa, pb] = [at(a), at(b)];
        const d = sub(pb, pa);
        X.set([...scaled(add(pa, pb), 0.5), 0, ...fromZ(d), 1, 1, norm(d)], POSE * (nodes + s));
      });
      for (let i = moving; i < modules.length; i++) X.set([0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1], POSE * i);
    },
    causes: t => new Set([body.keyframes[clamp(lastNotAbove(times, t) + 1, 0, times.length - 1)].cause]),
    beginnings: () => body.keyframes.slice(1).map((keyframe, i) => [times[i], keyframe.cause]),
    // Of a planner's many keyframes only the rolls are worth a mark, which lie before them.
    events: body.events.map(({ time, text }) => ({ time, kind: "merge", text })).concat(body.keyframes.flatMap((keyframe, i) => {
      if (keyframe.roll) return [{ time: times[i - 1], kind: "stage", text: "rolls over " + body.nodes[keyframe.roll[0]] + " -- " + body.nodes[keyframe.roll[1]] }];
      return i > 0 && i + 1 < times.length && times.length <= KEYFRAMES_MARKED ? [{ time: keyframe.time, kind: "stage", text: "moves on" }] : [];
    })),
    facts(b, t) {
      if (b < nodes) return [["node", nodesAt(t)(b).map(x => x.toFixed(2)).join(", ") + " m"]];
      if (b >= moving) return [];
      const strut = strutsAt(t)[b - nodes];
      const length = lengths(nodesAt(t), strut);
      return [["type", body.strut], ["between", strut.map(node => body.nodes[node]).join(" and ")], ["length", length.toFixed(3) + " m of " + body.range.map(x => x.toFixed(2)).join(".." ) + " m"]];
    },
    /** How far out each strut is in its range, 0..1: for the colours. */
    extended: (X, i) => (i < nodes || i >= moving ? null : (X[POSE * i + 10] - body.range[0]) / (body.range[1] - body.range[0])),
  };
}
