// The player: time, keys, and what happens when they change.

const began = performance.now();
const plan = JSON.parse(document.getElementById("plan").textContent);
const $ = id => document.getElementById(id);
const calmWish = matchMedia("(prefers-reduced-motion: reduce)");
/** What stands at the place of a failure; the words of the judge stand under the title. */
const CALLOUTS = { collision: "they meet here", stability: "it falls here", torque: "overloaded", "bond load": "overloaded", closure: "torn", docking: "missed", ground: "in the ground" };
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8, 16];
/** Longer than this nobody waits, s. */
const WATCHED_MAX = 120;
/** So long after it was turned the picture counts as moving, ms. */
const TURNED_FOR = 160;
/** So long everything is at rest before the picture gets better, ms; so long it does, but so often at least. */
const RESTED_FOR = 200;
const REFINED_FOR = 5000;
const ROUNDS_LEAST = 5;
/** The colours of the ghosts of start and end. */
const GHOSTS = ["#7d8791", "#3f7fb5"];
/** Parts in the legend over the picture; all of them stand beside it. */
const LEGEND_MAX = 8;

function main() {
  const motion = motionOf(plan);
  const options = { shadow: true, edges: true, grid: true, start: false, goal: Boolean(plan.goal) && !motion.target, target: true, collides: false, contacts: false, mass: plan.verdict.stamp === "failed", trail: true, follow: true };
  const state = { t: 0, playing: false, speed: 1, loop: false, hovered: null, chosen: null, dirty: true, theme: null, round: 0, more: false, moved: 0 };
  const colourings = colouringsOf(plan, motion);
  let colouring = colourings[0];
  const canvas = $("view");
  const events = eventsOf(plan, motion);
  const stats = { calls: 0, frame: 0, frames: 0, first: null };
  const touch = () => (state.dirty = true);
  /** Where the robot is in the end, as corners, for a picture that its ghost is in; told once the framing is known. */
  let goalCorners = [];

  //: Object.assign(options, { nominal: true, forces: true, paths: true });
  const toggles = [
    //: ...simulationToggles(plan, motion),
    ["mass", plan.ground ? "Centre of mass and support" : "Centre of mass", "m", plan.stand.length > 0], ["contacts", "Contacts with the ground", "k", plan.contacts.some(c => c[1].length)], ["start", "Ghost of the start", "s", plan.duration > 0],
    ["goal", plan.goal ? "Ghost of the goal" : "Ghost of the end", "g", plan.duration > 0], ["collides", "Shapes that are judged", "j", Boolean(motion.collides)],
    ["trail", "Way of the base", "w", (plan.body.base || []).length > 1], ["follow", "Follow the robot", "o", true],
    ["target", "The target", "a", Boolean(motion.target)], ["edges", "Edges", "e", true], ["grid", "Grid and axes", "i", true], ["shadow", "Shadows", "", true],
  ].filter(([, , , there]) => there).map(([name, title, key]) => ({ name, title, key }));

  const player = {
    motion, options, colourings, toggles,
    seek(t, stop) {
      state.t = clamp(t, 0, plan.end);
      if (stop) play(false);
      touch();
    },
    colour(name) {
      colouring = colourings.find(c => c.name === name) || colouring;
      document.querySelectorAll("[data-colour]").forEach(b => b.setAttribute("aria-pressed", b.dataset.colour === colouring.name));
      showLegend(colouring);
      touch();
    },
    toggle(name, on) {
      if (!toggles.some(t => t.name === name)) return;
      options[name] = on === undefined ? !options[name] : on;
      document.querySelectorAll(`[data-toggle="${name}"]`).forEach(box => (box.checked = options[name]));
      if (name === "follow") camera.follow = options.follow;
      showLegend(colouring);
      touch();
    },
  };

  let renderer = null;
  try {
    renderer = rendererOf(canvas, plan, motion);
  } catch (error) {
    showStill(error);
  }
  const camera = cameraOf(canvas, () => calmWish.matches, () => ((state.moved = performance.now()), touch()));
  camera.lowest = plan.ground ? -0.2 : -1.55;
  const timeline = timelineOf(plan, motion, events, player.seek);
  const curves = curvesOf(plan, motion, player.seek);
  const panel = panelOf(plan, player);
  showHead();
  const X = new Float32Array(POSE * motion.bodies);
  const framing = framingOf(plan, motion, X);
  camera.reach = 6 * framing.radius;
  if (options.goal && plan.duration > 0) {
    motion.place(0, X);
    const { middle } = framing.now();
    motion.place(plan.end, X);
    framing.now(p => goalCorners.push(sub(p, middle)));
    const stride = Math.ceil(goalCorners.length / CORNERS_MAX);
    goalCorners = goalCorners.filter((_, i) => i % stride === 0);
  }
  const cube = cubeOf(name => {
    camera.side(name);
    fit();
  });
  const scale = scaleBar(() => options.grid);
  const measure = measureOf((x, y) => {
    const depth = renderer && scene_ ? renderer.pick(scene_, X, x, y, true) : -1;
    if (depth >= 0) return unprojected(camera.matrix, x, y, depth);
    // What is beside the robot is on the ground.
    const d = sub(unprojected(camera.matrix, x, y, 0.5), camera.eye);
    const [a, b] = plan.slope || [0, 0];
    const rate = d[2] - a * d[0] - b * d[1];
    const u = (plan.floor - camera.eye[2] + a * camera.eye[0] + b * camera.eye[1]) / rate;
    return plan.ground && u > 0 ? add(camera.eye, scaled(d, u)) : null;
  }, touch);
  const ghosts = [false, false];
  //: ghosts.push(true);
  //: const nominal = new Float32Array(POSE * motion.bodies);

  /** Whoever can't draw it shows a still picture, and everything else on the page. */
  function showStill(error) {
    renderer = null;
    canvas.hidden = true;
    $("still").hidden = false;
    if (!/missing/.test(error.message)) console.error(error);
  }

  /** The start (0) or the end (1) is placed when it is first wanted. */
  function makeGhost(i) {
    ghosts[i] = true;
    const ghost = new Float32Array(POSE * motion.bodies);
    motion.place(i ? plan.end : 0, ghost);
    paint(plan, motion, { colour: () => rgb(GHOSTS[i]) }, ghost, 0, null, null, false);
    renderer.ghosts[i] = ghost;
  }

  /** The whole robot, or what is seen of it at first. */
  function fit(first, jump) {
    motion.place(state.t, X);
    camera.follow = options.follow;
    const still = options.goal ? goalCorners : [];
    if (first) camera.begin(framing, still);
    else camera.fit(framing, still);
    if (jump) camera.jump();
    touch();
  }

  /** Light or dark; a figure for a paper is black on white, without what stands around the picture. */
  function theme(dark, figure = false) {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    document.body.classList.toggle("figure", figure);
    $("figure").setAttribute("aria-pressed", figure);
    state.theme = themeOf(dark, figure);
    state.lineInk = dark ? rgb("#e6e8ea") : rgb("#222c36");
    timeline.draw();
    touch();
  }

  function play(on) {
    if (on && state.t >= plan.end - 1e-9) state.t = 0;
    const before = coarseness();
    state.playing = on && plan.end > 0;
    if (coarseness() !== before) resize();
    $("play").firstElementChild.firstElementChild.setAttribute("d", state.playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M4 2l10 6-10 6z");
    $("play").setAttribute("aria-pressed", state.playing);
    touch();
  }

  function step(direction) {
    const away = 1e-4;
    const next = direction > 0 ? events.stops.find(t => t > state.t + away) : events.stops.findLast(t => t < state.t - away);
    player.seek(next === undefined ? (direction > 0 ? plan.end : 0) : next, true);
  }

  function speed(value) {
    state.speed = value;
    $("speed").value = String(value);
  }

  function showHead() {
    document.querySelector("#head h1").textContent = visible(plan.title);
    const { stamp, headline } = plan.verdict;
    $("stamp").className = { verified: "good", excepted: "part", failed: "bad" }[stamp] || "";
    $("stamp").append(el("b", {}, visible(headline)), visible(plan.summary));
    const first = plan.verdict.failures[0];
    $("why").textContent = first ? visible("at " + seconds(first.time) + ": " + first.message) : "";
  }

  function showLegend({ legend }) {
    const box = $("legend");
    const shown = legend.slice(0, LEGEND_MAX);
    const ghosts = [[options.start, GHOSTS[0], "ghost of the start"], [options.goal, GHOSTS[1], plan.goal ? "ghost of the goal" : "ghost of the end"], [motion.target && options.target, AROUND, "the target"]]
      .filter(([is]) => is).map(([, colour, name]) => [colour, name]);
    const besides = [...surroundingsOf(motion), ...ghosts];
    box.replaceChildren(...legendOf([...shown, ...besides]), ...(legend.length > shown.length ? [el("span", {}, "and " + (legend.length - shown.length) + " more, in View")] : []));
    box.hidden = legend.length < 2 && legend[0][0] !== "ramp" && !besides.length;
    $("parts").replaceChildren(...legendOf([...legend, ...surroundingsOf(motion)]));
    //: showScale(plan, options, box);
  }

  const pace = paceOf(Boolean(renderer && renderer.software));
  /** How coarsely it is drawn: only what moves by itself, or is turned. */
  const coarseness = () => (state.playing || performance.now() - state.moved < TURNED_FOR ? pace.level() : 0);
  let shaped = 0;
  function resize() {
    // What lies over the picture in depth takes as long as the picture, where it is drawn in software.
    document.body.classList.toggle("slow", coarseness() > 1);
    const ratio = Math.min(devicePixelRatio || 1, 2) * PIXELS[coarseness()];
    const [w, h] = [canvas.clientWidth, canvas.clientHeight].map(x => Math.max(Math.round(x * ratio), 1));
    const shape = w / h;
    const other = Math.abs(shape - shaped) > 0.01;
    shaped = shape;
    if (canvas.width !== w || canvas.height !== h) (canvas.width = w), (canvas.height = h);
    if (other && camera.framed) fit(camera.framed === "first", true);
    timeline.draw();
    touch();
  }

  let follows = null;
  function draw(seconds_) {
    const start = performance.now();
    motion.place(state.t, X);
    const failure = failureAt(plan, state.t);
    paint(plan, motion, colouring, X, state.t, state.hovered, failure, state.theme.dark);
    const stand = standAt(plan, state.t);
    const now = framing.now();
    const place = framing.followed(camera.atEnd, now);
    if (camera.follow && follows && follows.atEnd === camera.atEnd) camera.goal.target = add(camera.goal.target, sub(place, follows.place));
    follows = { place, atEnd: camera.atEnd };
    const moving = camera.update(seconds_);
    const lineTheme = { ...state.theme, ink: state.lineInk };
    const floor = floorOf(plan);
    const lines = [];
    const marks = [];
    const grain = framing.thread ? 5 * framing.thread.wide : framing.radius;
    //: if (options.trail) lines.push(...measuredTrail(plan, motion, plan.floor, lineTheme, options.nominal));
    //: if (options.paths) lines.push(...runLines(plan, plan.floor, lineTheme));
    //: lines.push(...surroundingLines(plan, lineTheme));
    //: if (options.forces) marks.push(...forceArrows(plan, motion, state.t, framing.radius, camera.eye, lineTheme));
    //: if (!plan.simulation)
    if (options.trail) lines.push(...trailLines(plan, floor, lineTheme, grain));
    if (options.mass && stand) {
      if (plan.ground) lines.push(...supportLines(stand, floor, lineTheme));
      marks.push(...centreMarks(stand, floor, framing.thread ? framing.thread.wide : framing.radius, plan.ground, lineTheme));
    }
    if (options.contacts) marks.push(...contactDots(plan, state.t, floor, lineTheme));
    if (failure && failure.point) marks.push(...spotOf(failure.point, 11, [...lineTheme.bad, 1], lineTheme));
    if (failure && failure.kind === "stability" && stand) marks.push(...nearestEdge(stand, floor, lineTheme));
    marks.push(...measure.marks(lineTheme, onScreen));
    const scene = {
      camera, theme: state.theme, solids: options.collides && motion.collides ? motion.collides : motion.solids,
      middle: now.middle, radius: now.radius, grain, floor: plan.floor, lowest: framing.lowest, floorAt: floor, slope: plan.slope || [0, 0], ground: plan.ground,
      shadow: options.shadow && coarseness() < 2, sky: options.shadow && coarseness() < 1,
      edges: options.edges && coarseness() < 2, grid: options.grid && !state.theme.figure, smooth: coarseness() < 1, detail: DETAIL[coarseness()], ghosts: [options.start, options.goal], target: options.target ? motion.target : null, area: options.mass && stand ? stand.area : [], lines, marks,
    };
    //: scene.ghosts.push(options.nominal);
    //: if (renderer && options.nominal) renderer.ghosts[2] = placeNominal(plan, motion, state.t, nominal);
    if (renderer) {
      scene.ghosts.forEach((shown, i) => shown && !ghosts[i] && makeGhost(i));
      const drawn = renderer.show(scene, X, 0);
      stats.calls = drawn.calls;
      [state.round, state.more, state.began] = [0, drawn.more, performance.now()];
    }
    scene_ = scene;
    cube.turn(camera.yaw, camera.pitch);
    scale.show(camera.distance, canvas.clientHeight, gridStep(grain));
    placeCallout(failure);
    timeline.show(state.t);
    curves.draw(state.t);
    panel.show(motion.causes(state.t));
    $("clock").replaceChildren(el("b", {}, state.t.toFixed(2)), " / " + seconds(plan.duration));
    stats.frame = performance.now() - start;
    stats.frames++;
    if (stats.first === null) stats.first = performance.now() - began;
    return moving;
  }
  let scene_ = null;

  /** One more of the pictures that are averaged while nothing moves. */
  function refine() {
    const drawn = renderer.show(scene_, X, ++state.round);
    state.more = drawn.more && (state.round < ROUNDS_LEAST || performance.now() - state.began < REFINED_FOR);
  }

  /** Where a module is on the screen, in pixels. */
  function onScreen(p) {
    const s = projected(camera.matrix, p);
    return s && [((s[0] + 1) / 2) * canvas.clientWidth, ((1 - s[1]) / 2) * canvas.clientHeight];
  }

  function placeCallout(failure) {
    const box = $("callout");
    box.hidden = !failure;
    if (!failure) return;
    const bodies = motion.moduleOf.flatMap((m, b) => (failure.modules.includes(m) ? [b] : []));
    const sum = bodies.reduce((s, b) => add(s, [X[POSE * b], X[POSE * b + 1], X[POSE * b + 2]]), [0, 0, 0]);
    const place = failure.point || (bodies.length ? scaled(sum, 1 / bodies.length) : framing.now().middle);
    const at = onScreen(place);
    box.hidden = !at;
    if (!at) return;
    box.textContent = CALLOUTS[failure.kind] || failure.kind;
    box.style.left = clamp(at[0], 150, Math.max(canvas.clientWidth - 150, 150)) + "px";
    box.style.top = clamp(at[1], 120, canvas.clientHeight) + "px";
  }

  function hover(e) {
    if (!renderer || !scene_ || e.buttons) return;
    const rect = canvas.getBoundingClientRect();
    const [x, y] = [(e.clientX - rect.left) / rect.width, (e.clientY - rect.top) / rect.height];
    const body = renderer.pick(scene_, X, x, y);
    const module = body < 0 ? null : motion.moduleOf[body];
    const tip = $("tip");
    tip.hidden = body < 0;
    if (body >= 0) {
      const facts = motion.facts(body, state.t);
      tip.replaceChildren(el("b", {}, visible(motion.modules[module].name)), el("dl", {}, facts.flatMap(([k, v]) => [el("dt", {}, visible(k)), el("dd", {}, visible(v))])));
      tip.style.left = clamp(e.clientX - rect.left + 16, 0, rect.width - 240) + "px";
      tip.style.top = clamp(e.clientY - rect.top + 16, 0, rect.height - 30 - 20 * facts.length) + "px";
    }
    if (module !== state.hovered) {
      state.hovered = module;
      touch();
    }
    return module;
  }
  canvas.addEventListener("pointermove", hover);
  canvas.addEventListener("pointerleave", () => {
    state.hovered = null;
    $("tip").hidden = true;
    touch();
  });
  canvas.addEventListener("click", e => {
    if (camera.dragged()) return;
    const rect = canvas.getBoundingClientRect();
    if (measure.click((e.clientX - rect.left) / rect.width, (e.clientY - rect.top) / rect.height)) return;
    const module = hover(e);
    if (motion.joints.length) curves.choose(module === undefined ? null : module);
    touch();
  });

  function showCurves(on) {
    curves.root.hidden = !on || !curves.build();
    $("plots").setAttribute("aria-pressed", !curves.root.hidden);
    resize();
  }

  let side = -1;
  const keys = [
    [" ", "space", "play or pause", () => play(!state.playing)],
    ["ArrowLeft", "←", "a little back (with shift: the event before)", e => (e.shiftKey ? step(-1) : player.seek(state.t - plan.duration / 200, true))],
    ["ArrowRight", "→", "a little on (with shift: the next event)", e => (e.shiftKey ? step(1) : player.seek(state.t + plan.duration / 200, true))],
    [",", ",", "the event before", () => step(-1)],
    [".", ".", "the next event", () => step(1)],
    ["ArrowUp", "↑", "faster", () => speed(SPEEDS[Math.min(SPEEDS.indexOf(state.speed) + 1, SPEEDS.length - 1)])],
    ["ArrowDown", "↓", "slower", () => speed(SPEEDS[Math.max(SPEEDS.indexOf(state.speed) - 1, 0)])],
    ["Home", "Home", "to the start", () => player.seek(0, true)],
    ["End", "End", "to the end", () => player.seek(plan.end, true)],
    ["l", "L", "begin again at the end", () => $("loop").click()],
    ["c", "C", "curves", () => $("plots").click()],
    ["f", "F", "the whole robot", () => fit()],
    ["v", "V", "from the next side", () => {
      side = (side + 1) % FACES.length;
      camera.side(FACES[side][0]);
      fit();
    }],
    ["h", "H", "from the corner, as at first", () => (camera.side("corner"), fit())],
    ["x", "X", "measure a distance", () => measure.toggle()],
    ["Escape", "Esc", "no longer measure", () => measure.toggle(false)],
    ["d", "D", "light or dark", () => $("shade").click()],
    ["b", "B", "a figure for a paper, black on white", () => $("figure").click()],
    ["p", "P", "panel", () => $("sheet").click()],
    ...toggles.filter(t => t.key).map(t => [t.key, t.key.toUpperCase(), t.title.toLowerCase(), () => player.toggle(t.name)]),
    ...colourings.map((c, i) => [String(i + 1), String(i + 1), "colour by " + c.title.toLowerCase(), () => player.colour(c.name)]),
    ["?", "?", "these keys", () => $("help").click()],
  ];
  $("keys").append(el("h2", {}, "Keys"), el("table", {}, keys.map(([, shown, what]) => el("tr", {}, el("td", {}, el("kbd", {}, shown)), el("td", {}, what)))), el("form", { method: "dialog" }, el("button", {}, "Close")));
  document.addEventListener("keydown", e => {
    if (e.ctrlKey || e.metaKey || e.altKey || $("keys").open) return;
    if (e.target instanceof HTMLSelectElement || (e.target instanceof HTMLButtonElement && e.key === " ") || e.target instanceof HTMLInputElement) return;
    const key = keys.find(([name]) => name === e.key || name === e.key.toLowerCase());
    if (!key) return;
    e.preventDefault();
    key[3](e);
  });

  $("play").addEventListener("click", () => play(!state.playing));
  $("before").addEventListener("click", () => step(-1));
  $("after").addEventListener("click", () => step(1));
  $("loop").addEventListener("click", () => {
    state.loop = !state.loop;
    $("loop").setAttribute("aria-pressed", state.loop);
  });
  $("plots").addEventListener("click", () => showCurves(curves.root.hidden));
  $("fit").addEventListener("click", () => fit());
  $("shade").addEventListener("click", () => theme(!state.theme.dark));
  $("figure").addEventListener("click", () => theme(false, !state.theme.figure));
  $("measure").addEventListener("click", () => measure.toggle());
  $("sheet").addEventListener("click", () => {
    document.body.classList.toggle("wide");
    $("panel").hidden = document.body.classList.contains("wide");
    resize();
  });
  $("grip").addEventListener("pointerdown", e => $("grip").setPointerCapture(e.pointerId));
  $("grip").addEventListener("pointermove", e => {
    if (!$("grip").hasPointerCapture(e.pointerId)) return;
    document.body.style.setProperty("--panel", clamp(innerWidth - e.clientX, 220, innerWidth - 320) + "px");
    resize();
  });
  $("help").addEventListener("click", () => $("keys").showModal());
  SPEEDS.forEach(s => $("speed").append(el("option", { value: s }, s + "×")));
  $("speed").addEventListener("change", () => speed(Number($("speed").value)));
  // A plan of many minutes is seen in two at first.
  speed(SPEEDS.find(s => s >= 1 && plan.duration / s <= WATCHED_MAX) || SPEEDS[SPEEDS.length - 1]);

  /** The address as it was last read or written: another one is a wish that is still to be read. */
  let known = location.hash;
  /** `#t=12.3` opens the page at a time. */
  function fromAddress() {
    known = location.hash;
    const wish = /[#&]t=([0-9.]+)/.exec(known);
    if (wish) player.seek(Number(wish[1]) || 0, true);
    return Boolean(wish);
  }
  addEventListener("hashchange", fromAddress);

  let last = performance.now();
  function frame(now) {
    // The first frame may have begun before the clock was read.
    const passed = clamp((now - last) / 1000, 0, 0.1);
    const turned_ = now - state.moved < TURNED_FOR;
    if ((state.playing || (turned_ && state.dirty)) && pace.saw(now - last)) resize();
    // What has been turned, and is at rest again, is drawn in full.
    if (coarseness() !== state.coarseness) (state.coarseness = coarseness()), resize();
    last = now;
    if (state.playing) {
      state.t += passed * state.speed;
      if (state.t >= plan.end) {
        state.t = state.loop ? 0 : plan.end;
        if (!state.loop) play(false);
      }
      state.dirty = true;
    }
    if (state.dirty) {
      state.dirty = false;
      state.dirty = draw(passed) || state.dirty;
      const address = "#t=" + state.t.toFixed(2);
      if (!state.playing && address !== known && location.hash === known && !(state.t === 0 && !known)) {
        // Some viewers of mail don't let a page touch its address.
        try { history.replaceState(null, "", address); } catch { /* nothing is lost */ }
        known = location.hash;
      }
    } else if (state.more && renderer && !state.playing && performance.now() - state.began > RESTED_FOR) {
      try { refine(); } catch (error) { showStill(error); }
    }
    requestAnimationFrame(frame);
  }

  document.body.classList.toggle("still", plan.duration === 0);
  const wide = innerWidth > 760;
  if (!wide) document.body.classList.add("wide"), ($("panel").hidden = true);
  new ResizeObserver(resize).observe($("stage"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", e => theme(e.matches));
  theme(matchMedia("(prefers-color-scheme: dark)").matches);
  player.colour(colouring.name);
  resize();
  const wished = fromAddress();
  fit(true, true);
  const places = t => {
    const X = new Float32Array(POSE * motion.bodies);
    motion.place(t, X);
    return Array.from(X);
  };
  // For scripts and tests.
  window.modl = { plan, stats, state, stops: events.stops, camera, seek: t => player.seek(t, true), redraw: () => draw(0), pick: (x, y) => renderer.pick(scene_, X, x, y), places, onScreen, measure, coarseness };
  try {
    if (renderer) renderer.ready();
  } catch (error) {
    showStill(error);
  }
  draw(0);
  if (!wished && !calmWish.matches) play(true);
  requestAnimationFrame(frame);
}

main();
