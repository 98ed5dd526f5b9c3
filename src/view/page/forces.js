// Simulations in the picture: contact forces as arrows, the way of the base, and those of all runs.

/** The numbers of a contact: link, other link or -1, place in tenths of a millimetre, force in units of the page. */
const CONTACT_NUMBERS = 8;
/** The head of an arrow, as a part of its length and of the robot's size. */
const ARROW_HEAD = 0.28;
const ARROW_HEAD_MAX = 0.04;
const PLAN_TINT = "#1f78d8";

/** What the arrows mean. */
const arrowScale = ({ simulation }) => "an arrow of 100 mm is a force of " + simulation.newtons + " N";

function simulationToggles(plan, motion) {
  const { contacts, runs } = plan.simulation;
  return [
    ["nominal", "The plan, as a ghost", "n", true],
    ["forces", "Contact forces: " + arrowScale(plan), "k", contacts.some(c => c.length)],
    ["paths", runs.length === 1 ? "Way of the other run" : "Ways of " + runs.length + " runs", "r", runs.length > 0],
  ];
}

/** The plan's motion at a time, painted as a ghost in Y. */
function placeNominal(plan, motion, t, Y) {
  motion.nominal.place(t, Y);
  paint(plan, motion, { colour: () => rgb(PLAN_TINT) }, Y, t, null, null, false);
  return Y;
}

/** The contact forces at a time, each from the point that it acts on; between links both of them. */
function forceArrows(plan, motion, t, size, eye, theme) {
  const { contacts, force, newtons } = plan.simulation;
  const numbers = contacts[motion.momentAt(t)] || [];
  const lines = [];
  for (let i = 0; i < numbers.length; i += CONTACT_NUMBERS) {
    const [, other, x, y, z, ...f] = numbers.slice(i, i + CONTACT_NUMBERS);
    const p = scaled([x, y, z], 1e-4);
    const d = scaled(f, (force * 0.1) / newtons);
    lines.push(...arrow(p, d, size, eye, theme));
    if (other >= 0) lines.push(...arrow(p, scaled(d, -1), size, eye, theme));
  }
  return lines;
}

/** An arrow whose head is seen from the eye. */
function arrow(p, d, size, eye, theme) {
  const tip = add(p, d);
  const head = Math.min(ARROW_HEAD * norm(d), ARROW_HEAD_MAX * size);
  const back = scaled(unit(d), -head);
  const side = scaled(unit(cross(d, sub(eye, tip))), head / 2);
  const colour = [...theme.contact, 1];
  return [
    { a: p, b: tip, width: 3, colour },
    { a: tip, b: add(tip, add(back, side)), width: 3, colour },
    { a: tip, b: add(tip, sub(back, side)), width: 3, colour },
  ];
}

/** A way through places [x, y] at a height, or [x, y, z]. */
function wayLines(places, height, width, colour) {
  const lines = [];
  const at = ([x, y, z]) => [x, y, z ?? height];
  for (let i = 1; i < places.length; i++) lines.push({ a: at(places[i - 1]), b: at(places[i]), width, colour });
  return lines;
}

/** Ground that is not level, as lines on it, and the edges of obstacles. */
function surroundingLines({ simulation }, theme) {
  const places = numbers => Array.from({ length: numbers.length / 3 }, (_, i) => numbers.slice(3 * i, 3 * i + 3));
  const drawn = (lines, width, opacity) => lines.flatMap(numbers => wayLines(places(numbers), 0, width, [...theme.ink, opacity]));
  return [...drawn(simulation.terrain || [], 1, 0.22), ...drawn(simulation.obstacles, 2, 0.6)];
}

/** The way of the base as it was measured, and as planned. */
function measuredTrail(plan, motion, floor, theme, nominal) {
  const stride = Math.max(Math.ceil(motion.way.length / 600), 1);
  const kept = list => list.filter((_, i) => i % stride === 0 || i + 1 === list.length);
  const lines = wayLines(kept(motion.way), floor + 0.0012, 2, [...theme.ink, 0.5]);
  const keys = plan.body.base || [];
  const level = plan.simulation.terrain ? 3 : 2;
  if (nominal) lines.push(...wayLines(keys.map(key => key.slice(1, 1 + level)), floor + 0.0006, 2, [...rgb(PLAN_TINT), 0.4]));
  if (plan.simulation.fell && plan.ground) lines.push(...crossLines(plan.simulation.fell, floor, 0.03, 3, theme));
  return lines;
}

/** A cross where something fell or failed, its arms of so many metres. */
function crossLines([x, y, floor], level, arm, width, theme) {
  const at = (dx, dy) => [x + dx * arm, y + dy * arm, (floor ?? level) + 0.0009];
  const colour = [...theme.bad, 1];
  return [{ a: at(-1, -1), b: at(1, 1), width, colour }, { a: at(-1, 1), b: at(1, -1), width, colour }];
}

/** The ways of all runs; those that fail are coloured, with a cross where they do first. */
const runWays = new Map();
function runLines(plan, floor, theme) {
  if (runWays.has(theme.dark)) return runWays.get(theme.dark);
  const lines = plan.simulation.runs.flatMap(([count, x, y, failed, z]) => {
    const [xs, ys, zs] = [x, y, z].map(column => column && columnOf(column, count));
    const colour = failed ? [...theme.bad, 0.75] : [...theme.good, 0.55];
    const way = wayLines(Array.from(xs, (_, i) => (zs ? [xs[i], ys[i], zs[i]] : [xs[i], ys[i]])), floor + 0.0004, 1, colour);
    return failed ? [...way, ...crossLines(failed, floor, 0.012, 1.5, theme)] : way;
  });
  runWays.set(theme.dark, lines);
  return lines;
}

/** Adds what the arrows and ways mean to the legend. */
function showScale(plan, options, box) {
  const { contacts, runs } = plan.simulation;
  const words = [];
  if (options.nominal) words.push(["blue: the plan"]);
  if (options.forces && contacts.some(c => c.length)) words.push([arrowScale(plan)]);
  const failing = runs.filter(run => run[3]).length;
  if (options.paths && runs.length) words.push([runs.length + " runs, " + failing + " of them fail"]);
  box.append(...words.map(text => el("span", { class: "scale" }, text)));
  box.hidden = box.hidden && !words.length;
}
