// The scene at a time: colours, lines, marks.

/** Told apart by people who see no red, no green or no blue, too: a test measures it. */
const PALETTE = ["#4c75ae", "#daa43d", "#519277", "#a06182", "#a3c8de", "#cabe87", "#6b6c95", "#9cb6a1"];
const FAILED = "#cf4520";
/** What is no part of a robot: obstacles, and ground that is not flat. */
const AROUND = "#b9bbb5";

const rgb = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255);

/** The colours of the picture: light or dark, or a figure for a paper. */
function themeOf(dark, figure) {
  const axes = dark ? { axisX: rgb("#ee8f73"), axisY: rgb("#8fd08f"), accent: rgb("#6cb6ee") } : { axisX: rgb("#b23a1e"), axisY: rgb("#35893f"), accent: rgb("#0b63a5") };
  return {
    dark, figure, ...axes,
    ...(dark
      ? { above: rgb("#161b21"), below: rgb("#262d36"), ink: [0, 0, 0], good: rgb("#4fcfa6"), bad: rgb("#ff7a3c"), contact: rgb("#ffd24a"), paper: rgb("#14181e") }
      : figure
        ? { above: [1, 1, 1], below: [1, 1, 1], ink: rgb("#30363c"), good: rgb("#00755a"), bad: rgb(FAILED), contact: rgb("#8a2be2"), paper: [1, 1, 1] }
        : { above: rgb("#dfe4e8"), below: rgb("#f7f6f3"), ink: rgb("#222c36"), good: rgb("#00755a"), bad: rgb(FAILED), contact: rgb("#8a2be2"), paper: rgb("#fffefb") }),
  };
}

/** From cold to warm, as bright in steps as it is in hue (after cividis). */
const RAMP = ["#234f85", "#537298", "#828d8c", "#b8a65c", "#ecd262"].map(rgb);
function ramp(u) {
  const x = clamp(u, 0, 1) * (RAMP.length - 1);
  const i = Math.min(Math.floor(x), RAMP.length - 2);
  return RAMP[i].map((c, k) => mix(c, RAMP[i + 1][k], x - i));
}

/** Ways to colour: {name, title, colour(body, X, t), legend}. */
function colouringsOf(plan, motion) {
  const parts = motion.modules.filter(m => !m.around);
  const groups = [...new Set(parts.map(m => m.group))];
  const types = [...new Set(parts.map(m => m.type))];
  const by = (list, key) => motion.modules.map(m => rgb(m.around ? AROUND : PALETTE[list.indexOf(m[key]) % PALETTE.length]));
  const swatches = list => list.map((name, i) => [PALETTE[i % PALETTE.length], name]);
  const ofGroup = by(groups, "group");
  const ofType = by(types, "type");
  const all = [];
  const plain = (name, title, colours, list) => all.push({ name, title, colour: body => colours[motion.moduleOf[body]], legend: swatches(list) });
  if (motion.squeezed) all.push({ name: "size", title: "Size", colour: (b, X) => (motion.modules[b].around ? rgb(AROUND) : ramp(1 - motion.squeezed(X, b))), legend: [["ramp", "squeezed to full size"]] });
  if (motion.extended) all.push({
    name: "length", title: "Length", legend: [["ramp", "shortest to longest"]],
    colour: (b, X) => { const u = motion.extended(X, b); return u === null ? rgb(motion.modules[b].around ? AROUND : "#59626c") : ramp(u); },
  });
  // Cells of a lattice are parts of nothing.
  if (groups.some(Boolean)) plain("part", "Part", ofGroup, groups);
  if (plan.loads) {
    const loads = loadsOf(plan, motion);
    all.push({ name: "load", title: "Joint load", colour: (b, X, t) => loads(motion.moduleOf[b], t), legend: [["ramp", "joint load, none to its limit, were the ground's forces spread evenly"]] });
  }
  //: all.push(...effortColours(motion));
  plain("type", "Type", ofType, types);
  return all;
}

/** The surroundings of the robot, for every legend: obstacles, and ground that is not flat. The target is told by itself. */
function surroundingsOf(motion) {
  const around = motion.modules.filter(m => m.around && !(motion.target && m.name === "target"));
  const names = [["obstacles", around.some(m => m.type !== "ground")], ["ground", around.some(m => m.type === "ground")]].filter(([, is]) => is).map(([name]) => name);
  return names.length ? [[AROUND, names.join(" and ")]] : [];
}

/** A legend: a swatch and a name for each. */
function legendOf(legend) {
  const stops = RAMP.map(c => `rgb(${c.map(x => Math.round(x * 255)).join(" ")})`).join(", ");
  return legend.map(([colour, name]) => {
    const swatch = el("i", { class: colour === "ramp" ? "ramp" : null });
    swatch.style.background = colour === "ramp" ? `linear-gradient(90deg, ${stops})` : colour;
    return el("span", {}, swatch, visible(name));
  });
}

/** The colour of the greatest joint load of a module. */
function loadsOf(plan, motion) {
  const { joints, moments } = plan.loads;
  const times = moments.map(m => m[0]);
  const of = motion.modules.map(() => []);
  joints.forEach((j, i) => motion.joints[j].module >= 0 && of[motion.joints[j].module].push(i));
  return (module, t) => {
    if (!of[module].length) return rgb(motion.modules[module].around ? AROUND : "#8d949b");
    const ratios = moments[Math.max(lastNotAbove(times, t), 0)][1];
    return ramp(Math.max(...of[module].map(i => ratios[i])));
  };
}

/** The findings at a moment: {modules, failure}. */
function failureAt(plan, t) {
  const near = plan.verdict.failures.filter(f => f.kind !== "form" && t >= f.time - 1e-3 && t <= Math.max(f.until || 0, f.time + 0.15));
  return near.length ? near[0] : null;
}

function paint(plan, motion, colouring, X, t, hovered, failure, dark) {
  const bad = failure ? new Set(failure.modules) : null;
  const grey = dark ? 0.34 : 0.72;
  for (let b = 0; b < motion.bodies; b++) {
    let c = colouring.colour(b, X, t);
    const module = motion.moduleOf[b];
    if (bad && bad.size) c = bad.has(module) ? rgb(FAILED) : c.map(x => mix(x, grey, 0.7));
    const i = POSE * b + 12;
    X[i] = c[0];
    X[i + 1] = c[1];
    X[i + 2] = c[2];
    X[i + 3] = module === hovered ? 0.45 : 0;
  }
}

/** How the robot stands at a time: centre of mass, margin, corners of its support. */
function standAt(plan, t) {
  if (!plan.stand.length) return null;
  const at = Math.max(lastNotAbove(standTimes(plan), t), 0);
  const [, x, y, z, margin, held, corners] = plan.stand[at];
  const area = [];
  for (let i = 0; i < corners.length; i += 2) area.push([corners[i], corners[i + 1]]);
  return { centre: [x, y, z], margin, held, area };
}
let standTimesKnown = null;
function standTimes(plan) {
  if (!standTimesKnown) standTimesKnown = plan.stand.map(s => s[0]);
  return standTimesKnown;
}

/** The height of the ground under a point: a plane, level unless the plan has a slope. */
function floorOf(plan) {
  const [a, b] = plan.slope || [0, 0];
  return ([x, y]) => plan.floor + a * x + b * y;
}

/** The support around the foot of the centre of mass, on the ground. */
function supportLines(stand, floor, theme) {
  const [x, y, z] = stand.centre;
  const lifted = p => [p[0], p[1], floor(p) + 0.0008];
  const lines = stand.area.map((p, i) => {
    const q = stand.area[(i + 1) % stand.area.length];
    return { a: lifted(p), b: lifted(q), width: 2, colour: tintOf(stand, theme) };
  });
  lines.push({ a: [x, y, z], b: lifted([x, y]), width: 1.5, colour: [...theme.ink, 0.7] });
  return lines;
}

/** The centre of mass, and its foot where there is ground: seen through everything. */
function centreMarks(stand, floor, size, ground, theme) {
  const [x, y, z] = stand.centre;
  const r = size * 0.02;
  const cross = ([c, h]) => [[r, 0, 0], [0, r, 0], [0, 0, h * r]].map(d => ({ a: sub(c, d), b: add(c, d), width: 2.5, colour: tintOf(stand, theme) }));
  return [[[x, y, z], 1], ...(ground ? [[[x, y, floor([x, y]) + 0.0008], 0]] : [])].flatMap(cross);
}

/** Good or bad, by how it stands; without a support neither. */
function tintOf(stand, theme) {
  const ok = stand.margin === null ? !stand.held && !stand.area.length : stand.margin >= 0 && !stand.held;
  return [...(ok ? theme.good : theme.bad), 0.95];
}

/** Points that touch the ground at a time. */
function contactDots(plan, t, floor, theme) {
  const at = lastNotAbove(contactTimes(plan), t);
  if (at < 0) return [];
  const points = plan.contacts[at][1];
  const dots = [];
  for (let i = 0; i < points.length; i += 2) dots.push(...spotOf([points[i], points[i + 1], floor(points.slice(i, i + 2))], 7, [...theme.contact, 1], theme));
  return dots;
}
let contactTimesKnown = null;
function contactTimes(plan) {
  if (!contactTimesKnown) contactTimesKnown = plan.contacts.map(c => c[0]);
  return contactTimesKnown;
}

/** A dot with a rim that tells it from what is behind it: as wide as asked for, in pixels. */
function spotOf(p, width, colour, theme) {
  return [{ a: p, b: p, width: width + 3, colour: [...theme.paper, 1] }, { a: p, b: p, width, colour }];
}

/** The edge of the support that the centre of mass is nearest to, or went over. */
function nearestEdge(stand, floor, theme) {
  let best = null;
  const [x, y] = stand.centre;
  stand.area.forEach((a, i) => {
    const b = stand.area[(i + 1) % stand.area.length];
    const d = [b[0] - a[0], b[1] - a[1]];
    const u = clamp(((x - a[0]) * d[0] + (y - a[1]) * d[1]) / (d[0] ** 2 + d[1] ** 2 || 1), 0, 1);
    const away = Math.hypot(a[0] + u * d[0] - x, a[1] + u * d[1] - y);
    if (!best || away < best.away) best = { away, a, b };
  });
  return best ? [{ a: [...best.a, floor(best.a)], b: [...best.b, floor(best.b)], width: 6, colour: [...theme.bad, 1] }] : [];
}

/** Where the base goes, on the ground; nothing if that is not seen from where a scene of size `grain` is. */
function trailLines(plan, floor, theme, grain) {
  const keys = plan.body.base || [];
  if (!keys.some(key => Math.hypot(key[1] - keys[0][1], key[2] - keys[0][2]) > grain / 100)) return [];
  const stride = Math.max(Math.floor(keys.length / 600), 1);
  const lines = [];
  for (let i = stride; i < keys.length && keys[i][0] <= plan.end; i += stride) {
    const [a, b] = [keys[i - stride], keys[i]].map(([, x, y]) => [x, y, floor([x, y]) + 0.0006]);
    lines.push({ a, b, width: 2, colour: [...theme.ink, 0.35] });
  }
  return lines;
}
