// Curves over time under the same cursor: joints, clearance, margin, load.

const INKS = ["#1a6eb1", "#be8b15", "#168f58", "#a45093", "#4e4cbf", "#7d7f20"];
const INKS_DARK = ["#75a0e0", "#f5b628", "#4fdb9e", "#ca94bd", "#997ef3", "#d2cd7c"];
/** Points of one curve: as many as a screen can tell apart. */
const CURVE_POINTS = 400;
const JOINTS_SHOWN = 6;

function curvesOf(plan, motion, seek) {
  const root = document.getElementById("curves");
  const canvas = root.querySelector("canvas");
  let module = null;
  let rows = [];

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
    const row = (title, name, points, unit, limit) => {
      if (points && points.length > 1) rows.push({ title, lines: [{ name, points, unit }], limit });
    };
    row("clearance", "", plan.clearance, " mm", 0);
    row("stability margin", "", plan.stand.map(s => [s[0], s[4]]).filter(p => p[1] !== null).map(([t, m]) => [t, m * 1000]), " mm", 0);
    // No limit is drawn: the judge seeks the forces of the ground that load the joints least, and these are other ones.
    const judged = plan.verdict.load === undefined || plan.verdict.load === null ? "" : "; judged: at most " + (100 * plan.verdict.load).toFixed(1) + " %";
    row("greatest joint load, were the ground's forces spread evenly" + judged, "", plan.loads && plan.loads.moments.map(([t, ratios]) => [t, 100 * Math.max(...ratios)]), " %");
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
    const tall = h / Math.max(rows.length, 1);
    rows.forEach((row, i) => drawRow(g, row, i * tall, tall, w, t, colour, inks));
  }

  function drawRow(g, row, top, tall, w, t, colour, inks) {
    const x = time => (w * time) / Math.max(plan.duration, 1e-9);
    let low = Infinity;
    let high = -Infinity;
    for (const line of row.lines) for (const [, v] of line.points) (low = Math.min(low, v)), (high = Math.max(high, v));
    //: for (const line of row.lines) for (const [, v] of line.commanded || []) (low = Math.min(low, v)), (high = Math.max(high, v));
    if (row.limit !== undefined) (low = Math.min(low, row.limit)), (high = Math.max(high, row.limit));
    if (high - low < 1e-9) (low -= 1), (high += 1);
    const [from, to] = [top + tall - 5, top + 17];
    const y = v => mix(from, to, (v - low) / (high - low));
    g.strokeStyle = colour("--line");
    g.lineWidth = 1;
    g.beginPath();
    g.moveTo(0, top + tall - 0.5);
    g.lineTo(w, top + tall - 0.5);
    g.stroke();
    if (row.limit !== undefined) {
      g.strokeStyle = colour("--bad");
      g.setLineDash([3, 3]);
      g.beginPath();
      g.moveTo(0, y(row.limit));
      g.lineTo(w, y(row.limit));
      g.stroke();
      g.setLineDash([]);
    }
    g.lineWidth = 1.6;
    g.lineJoin = "round";
    row.lines.forEach((line, k) => {
      g.strokeStyle = inks[k % inks.length];
      g.beginPath();
      line.points.forEach(([time, v], i) => (i ? g.lineTo(x(time), y(v)) : g.moveTo(x(time), y(v))));
      g.stroke();
      //: if (line.commanded) dashed(g, line.commanded, x, y);
    });
    g.strokeStyle = colour("--ink");
    g.lineWidth = 1;
    g.beginPath();
    g.moveTo(x(t), top);
    g.lineTo(x(t), top + tall);
    g.stroke();
    g.font = "11px system-ui, sans-serif";
    g.textBaseline = "top";
    g.fillStyle = colour("--soft");
    g.fillText(row.title, 2, top + 2);
    let left = g.measureText(row.title).width + 12;
    row.lines.forEach((line, k) => {
      g.fillStyle = inks[k % inks.length];
      const text = (line.name ? line.name + " " : "") + valueAt(line.points, t).toFixed(1) + line.unit;
      if (left < w - 40) g.fillText(text, left, top + 2);
      left += g.measureText(text).width + 14;
    });
  }

  const at = e => clamp((e.clientX - canvas.getBoundingClientRect().left) / canvas.clientWidth, 0, 1) * plan.duration;
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

function valueAt(points, t) {
  const at = lastNotAbove(points.map(p => p[0]), t);
  const a = points[Math.max(at, 0)];
  const b = points[Math.min(at + 1, points.length - 1)];
  return b[0] > a[0] ? mix(a[1], b[1], clamp((t - a[0]) / (b[0] - a[0]), 0, 1)) : a[1];
}
