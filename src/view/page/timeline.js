// The line of time: what moves when, events and findings, the hand that scrubs.

/** Events closer than this on the screen are one stop for the keys and one mark for the eye, s. */
const SAME_TIME = 1e-6;
/** Pixels at the left of the line of time and of the curves, where numbers and the button to play stand. */
const GUTTER = 52;
/** The kinds of marks, the most important first, and what they mean. */
const MARKS = [["failure", "fails"], ["tip", "tips"], ["dock", "docks, undocks"], ["merge", "merges, splits"], ["worst", "worst value"], ["stage", "stage"]];
/** More marks than this would be a solid bar. */
const FLAGS_MAX = 300;

/** All events in order of time: the beginnings of commands, and what is worth a mark. */
function eventsOf(plan, motion) {
  const marks = [...motion.events];
  const verdict = plan.verdict;
  for (const failure of verdict.failures) marks.push({ time: failure.time, kind: "failure", text: failure.message });
  for (const [time, text] of verdict.events) marks.push({ time, kind: "tip", text });
  for (const [time, text] of verdict.worst) marks.push({ time, kind: "worst", text });
  const stops = new Map();
  for (const [time] of motion.beginnings()) stops.set(Math.round(time / SAME_TIME), time);
  for (const { time } of marks) stops.set(Math.round(time / SAME_TIME), time);
  for (const time of [0, plan.end]) stops.set(Math.round(time / SAME_TIME), time);
  marks.sort((a, b) => a.time - b.time);
  return { marks, stops: [...stops.values()].filter(time => time <= plan.end).sort((a, b) => a - b) };
}

function timelineOf(plan, motion, events, seek) {
  const root = document.getElementById("track");
  const canvas = root.querySelector("canvas");
  const now = document.getElementById("now");
  const flags = document.getElementById("flags");
  const whole = Math.max(plan.duration, 1e-9);
  const percent = t => (100 * clamp(t / whole, 0, 1)).toFixed(3) + "%";
  root.setAttribute("aria-valuemax", plan.duration.toFixed(2));

  // Of marks of a kind, the failures come first when there are too many.
  const order = MARKS.map(([kind]) => kind);
  const shown = [...events.marks].sort((a, b) => order.indexOf(a.kind) - order.indexOf(b.kind)).slice(0, FLAGS_MAX);
  for (const { time, kind, text } of shown.reverse()) {
    const flag = document.createElement("button");
    flag.className = kind;
    flag.style.left = percent(time);
    flag.title = seconds(time) + ": " + text;
    flag.setAttribute("aria-label", flag.title);
    flag.addEventListener("pointerdown", e => e.stopPropagation());
    flag.addEventListener("click", () => seek(time, true));
    flags.append(flag);
  }

  const kinds = new Set(shown.map(mark => mark.kind));
  document.getElementById("marks").replaceChildren(
    ...MARKS.filter(([kind]) => kinds.has(kind)).map(([kind, words]) => el("span", {}, el("i", { class: kind }), words)),
    el("span", {}, el("i", { class: "busy" }), "what moves"), el("span", {}, el("i", { class: "stop" }), "a command begins"),
  );

  const busy = busyness(plan, motion);
  function draw() {
    const ratio = devicePixelRatio || 1;
    canvas.width = root.clientWidth * ratio;
    canvas.height = root.clientHeight * ratio;
    const g = canvas.getContext("2d");
    const style = getComputedStyle(document.documentElement);
    const colour = name => style.getPropertyValue(name).trim();
    const [w, h] = [canvas.width, canvas.height];
    const middle = 17 * ratio;
    g.fillStyle = colour("--line");
    g.fillRect(0, middle - 2 * ratio, w, 4 * ratio);
    g.fillStyle = colour("--accent");
    busy.forEach((share, i) => {
      const x = (w * i) / busy.length;
      const tall = share > 0 ? (3 + 13 * share) * ratio : 0;
      g.globalAlpha = 0.5;
      g.fillRect(x, middle - tall / 2, Math.max(w / busy.length - 0.5, 1), tall);
    });
    g.globalAlpha = 1;
    g.fillStyle = colour("--soft");
    const gap = 3 * ratio;
    let last = -gap;
    for (const time of events.stops) {
      const x = (w * time) / whole;
      if (x - last < gap) continue;
      g.fillRect(x, 27 * ratio, ratio, 4 * ratio);
      last = x;
    }
    g.save();
    g.scale(ratio, ratio);
    timeAxis(g, time => (root.clientWidth * time) / whole, 32, plan.duration, root.clientWidth, colour);
    g.restore();
    if (plan.end < plan.duration) {
      // The time after a failure is not shown.
      g.strokeStyle = colour("--bad");
      g.globalAlpha = 0.55;
      const from = (w * plan.end) / whole;
      g.save();
      g.beginPath();
      g.rect(from, middle - 7 * ratio, w - from, 14 * ratio);
      g.clip();
      for (let x = from - 20 * ratio; x < w; x += 6 * ratio) {
        g.beginPath();
        g.moveTo(x, middle + 7 * ratio);
        g.lineTo(x + 14 * ratio, middle - 7 * ratio);
        g.stroke();
      }
      g.restore();
    }
  }

  const at = e => clamp((e.clientX - root.getBoundingClientRect().left) / root.clientWidth, 0, 1) * whole;
  root.addEventListener("pointerdown", e => {
    root.setPointerCapture(e.pointerId);
    root.focus({ preventScroll: true });
    seek(at(e), true);
  });
  root.addEventListener("pointermove", e => e.buttons && root.hasPointerCapture(e.pointerId) && seek(at(e), true));

  return {
    draw,
    show(t) {
      now.style.left = percent(t);
      root.setAttribute("aria-valuenow", t.toFixed(2));
      root.setAttribute("aria-valuetext", seconds(t) + " of " + seconds(plan.duration));
    },
  };
}

/** What part of the busiest moment's commands is under way, over the whole time. */
function busyness(plan, motion) {
  const bins = new Float64Array(240);
  const tracks = plan.body.tracks || [];
  if (!tracks.length) return plan.duration > 0 ? bins.fill(0.4) : bins;
  const scale = bins.length / Math.max(plan.duration, 1e-9);
  for (const [, segments] of tracks)
    for (const s of segments) {
      if (s.slice(4).every(c => c === s[3])) continue;
      const last = Math.min(Math.ceil(s[1] * scale), bins.length);
      for (let i = Math.floor(s[0] * scale); i < last; i++) bins[i]++;
    }
  const most = Math.max(...bins, 1);
  return bins.map(n => n / most);
}

function seconds(t) {
  return t >= 100 ? t.toFixed(1) + " s" : t.toFixed(2) + " s";
}
