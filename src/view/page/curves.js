// Curves over time under the same cursor: joints, clearance, margin, load.

const INKS = ["#1a6eb1", "#be8b15", "#168f58", "#a45093", "#4e4cbf", "#7d7f20"];
const INKS_DARK = ["#75a0e0", "#f5b628", "#4fdb9e", "#ca94bd", "#997ef3", "#d2cd7c"];
/** Points of one curve: as many as a screen can tell apart. */
const CURVE_POINTS = 400;
const JOINTS_SHOWN = 6;
/** Pixels of a row of curves, at least and at most, and of the axis of time below all of them; the part of the window that
    they take, so that the robot is seen above them. */
const ROW_LEAST = 58;
const ROW_MOST = 92;
const CURVES_PART = 0.4;
const TIME_HEIGHT = 20;

/** Round numbers in a range, so many at most: where an axis has its ticks, and how many digits tell them apart. */
function ticksOf(low, high, most) {
  const least = Math.max(high - low, 1e-12) / Math.max(most, 1);
  const power = 10 ** Math.floor(Math.log10(least));
  const step = power * [1, 2, 5, 10].find(k => k * power >= least * (1 - 1e-9));
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) ticks.push(i * step);
  return { ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** A number of an axis, with a true minus. */
const tickWords = (x, digits) => (Math.abs(x) < 1e-12 ? "0" : x.toFixed(digits).replace("-", "\u2212"));

function curvesOf(plan, motion, seek) {
  const root = document.getElementById("curves");
  const canvas = root.querySelector("canvas");
  let module = null;
  let rows = [];
  let rowHeight = ROW_MOST;

  function jointRow() {
    let chosen = motion.driven;
    if (module !== null) chosen = motion.jointsOf(module);
    chosen = chosen.slice(0, JOINTS_SHOWN);
    const times = Array.from({ length: CURVE_POINTS + 1 }, (_, i) => (plan.end * i) / CURVE_POINTS);
    const lines = chosen.map(j => {
      const turns = motion.joints[j].turns;
      return { name: motion.jointName(j), points: times.map(t => [t, motion.jointAt(j, t) * (turns ? 180 / Math.PI : 1000)]), unit: turns ? "°" : " mm" };
    });
    //: if (plan.simulation) return measuredJoints(plan, motion, { title: module === null ? "joints" : "joints of " + motion.modules[module].name, lines }, chosen);
    return { title: module === null ? "joints" : "joints of " + motion.modules[module].name, lines };
  }

  function build() {
    rows = [];
    if (motion.driven.length || module !== null) rows.push(jointRow());
    //: rows.push(...effortRows(plan, motion, module === null ? motion.driven.slice(0, JOINTS_SHOWN) : motion.jointsOf(module)));
    const row = (title, name, points, unit, limits = []) => {
      if (points && points.length > 1) rows.push({ title, lines: [{ name, points, unit }], limits });
    };
    row("clearance", "", plan.clearance, " mm", [[0, "they meet"]]);
    row("stability margin", "", plan.stand.map(s => [s[0], s[4]]).filter(p => p[1] !== null).map(([t, m]) => [t, m * 1000]), " mm", [[0, "it falls"]]);
    // The judge seeks the forces of the ground that load the joints least; these are other ones, and may be above its limit.
    const { load } = plan.verdict;
    const judged = load === undefined || load === null ? [] : [[100 * load, "judged: at most " + (100 * load).toFixed(1) + " %"]];
    row("greatest joint load, were the ground's forces spread evenly", "", plan.loads && plan.loads.moments.map(([t, ratios]) => [t, 100 * Math.max(...ratios)]), " %", [[100, "limit of the joint"], ...judged]);
    rowHeight = Math.round(clamp((CURVES_PART * innerHeight - TIME_HEIGHT) / Math.max(rows.length, 1), ROW_LEAST, ROW_MOST));
    canvas.style.height = rows.length * rowHeight + TIME_HEIGHT + "px";
    canvas.setAttribute("aria-label", "Curves over time: " + rows.map(row => visible(row.title)).join(", "));
    return rows.length > 0;
  }

  function draw(t) {
    if (root.hidden) return;
    const ratio = devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = w * ratio;
    canvas.height = h * ratio;
    const g = canvas.getContext("2d");
    g.scale(ratio, ratio);
    const style = getComputedStyle(document.documentElement);
    const colour = name => style.getPropertyValue(name).trim();
    const inks = document.documentElement.dataset.theme === "dark" ? INKS_DARK : INKS;
    const frame = { left: GUTTER, right: w - 1, w, t, colour, inks };
    const x = time => mix(frame.left, frame.right, time / Math.max(plan.duration, 1e-9));
    rows.forEach((row, i) => drawRow(g, row, { ...frame, x, top: i * rowHeight, bottom: (i + 1) * rowHeight - 8 }));
    timeAxis(g, x, rows.length * rowHeight - 4, plan.duration, w, colour);
    g.strokeStyle = colour("--ink");
    g.lineWidth = 1;
    g.beginPath();
    g.moveTo(x(t), 0);
    g.lineTo(x(t), rows.length * rowHeight - 6);
    g.stroke();
  }

  /** The range of a row's numbers, with its limits if they are near. */
  function rangeOf(row) {
    let low = Infinity;
    let high = -Infinity;
    for (const line of row.lines) for (const [, v] of line.points) (low = Math.min(low, v)), (high = Math.max(high, v));
    //: for (const line of row.lines) for (const [, v] of line.commanded || []) (low = Math.min(low, v)), (high = Math.max(high, v));
    const wide = Math.max(high - low, 1e-9);
    for (const [limit] of row.limits || []) if (limit > low - 1.5 * wide && limit < high + 1.5 * wide) (low = Math.min(low, limit)), (high = Math.max(high, limit));
    if (high - low < 1e-9) return [low - 1, high + 1];
    return [low - 0.04 * (high - low), high + 0.04 * (high - low)];
  }

  function drawRow(g, row, { left, right, top, bottom, x, t, colour, inks }) {
    const [low, high] = rangeOf(row);
    const [from, to] = [bottom, top + 20];
    const y = v => mix(from, to, (v - low) / (high - low));
    g.font = "11px system-ui, sans-serif";
    g.lineWidth = 1;
    g.textBaseline = "middle";
    g.textAlign = "right";
    const { ticks, digits } = ticksOf(low, high, clamp((from - to) / 16, 2, 5));
    for (const tick of ticks) {
      g.strokeStyle = colour("--line");
      stroke(g, [[left, Math.round(y(tick)) + 0.5], [right, Math.round(y(tick)) + 0.5]]);
      g.fillStyle = colour("--soft");
      g.fillText(tickWords(tick, digits), left - 6, y(tick));
    }
    g.strokeStyle = colour("--soft");
    stroke(g, [[left + 0.5, to], [left + 0.5, from]]);
    g.save();
    g.beginPath();
    g.rect(left, to - 2, right - left + 1, from - to + 4);
    g.clip();
    for (const [limit] of row.limits || []) {
      g.strokeStyle = colour("--bad");
      g.setLineDash([3, 3]);
      stroke(g, [[left, y(limit)], [right, y(limit)]]);
      g.setLineDash([]);
    }
    g.lineWidth = 1.6;
    g.lineJoin = "round";
    row.lines.forEach((line, k) => {
      g.strokeStyle = inks[k % inks.length];
      stroke(g, line.points.map(([time, v]) => [x(time), y(v)]));
      //: if (line.commanded) dashed(g, line.commanded, x, y);
    });
    g.restore();
    g.textBaseline = "top";
    let edge = right - 4;
    for (const [limit, words] of row.limits || []) {
      if (y(limit) < to - 2 || y(limit) > from + 2) continue;
      g.fillStyle = colour("--bad");
      g.fillText(words, edge, y(limit) + (y(limit) < to + 14 ? 3 : -13));
      edge -= g.measureText(words).width + 16;
    }
    g.textAlign = "left";
    g.fillStyle = colour("--ink");
    const units = new Set(row.lines.map(line => line.unit.trim().split(" ")[0]));
    const title = row.title + (units.size === 1 ? " (" + [...units][0] + ")" : "");
    g.fillText(title, left + 4, top + 3);
    let at = left + g.measureText(title).width + 18;
    row.lines.forEach((line, k) => {
      g.fillStyle = inks[k % inks.length];
      const text = (line.name ? line.name + " " : "") + valueAt(line.points, t).toFixed(1).replace("-", "\u2212") + line.unit;
      if (at + g.measureText(text).width < right) g.fillText(text, at, top + 3);
      at += g.measureText(text).width + 14;
    });
  }

  const at = e => clamp((e.clientX - canvas.getBoundingClientRect().left - GUTTER) / (canvas.clientWidth - GUTTER), 0, 1) * plan.duration;
  canvas.addEventListener("pointerdown", e => {
    canvas.setPointerCapture(e.pointerId);
    seek(at(e), true);
  });
  canvas.addEventListener("pointermove", e => e.buttons && seek(at(e), true));

  return {
    root,
    build,
    draw,
    choose(next) {
      module = next;
      if (!root.hidden) build();
    },
  };
}

/** A line through points on a canvas. */
function stroke(g, points) {
  g.beginPath();
  points.forEach(([x, y], i) => (i ? g.lineTo(x, y) : g.moveTo(x, y)));
  g.stroke();
}

/** The axis of time below a height, with numbers, in seconds. */
function timeAxis(g, x, top, duration, width, colour) {
  const { ticks, digits } = ticksOf(0, duration, Math.max((width - GUTTER) / 90, 2));
  g.font = "11px system-ui, sans-serif";
  g.textBaseline = "top";
  g.textAlign = "center";
  for (const tick of ticks) {
    g.strokeStyle = g.fillStyle = colour("--soft");
    g.lineWidth = 1;
    stroke(g, [[x(tick), top], [x(tick), top + 4]]);
    const words = tickWords(tick, digits) + (tick === 0 ? " s" : "");
    const half = g.measureText(words).width / 2;
    g.fillText(words, clamp(x(tick), half, width - half - 1), top + 5);
  }
}

function valueAt(points, t) {
  const at = lastNotAbove(points.map(p => p[0]), t);
  const a = points[Math.max(at, 0)];
  const b = points[Math.min(at + 1, points.length - 1)];
  return b[0] > a[0] ? mix(a[1], b[1], clamp((t - a[0]) / (b[0] - a[0]), 0, 1)) : a[1];
}
