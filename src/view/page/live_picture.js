// The picture of a program that is typed: what it shows may change at any time, the camera stays.

/** A dot of a port is hit from so many pixels away. */
const PORT_NEAR = 11;
/** Where a joint's link hardly moves on the screen, it turns by so much a pixel: rad, m. */
const SLOW_TURN = 0.01;
const SLOW_SLIDE = 0.0005;
/** Pixels a radian (or a metre) below which it hardly does, and pixels for a radian at least: near its axis a link is slow to turn. */
const SCREEN_LEAST = 12;
const SCREEN_RADIAN = 60;

/** `on.choose(module)`, `on.port(port, place)`, `on.joint(joint, value, done)` are told what is done in the picture. */
function pictureOf(on) {
  const canvas = $("view");
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const state = { dirty: false, moved: 0, hovered: null, chosen: new Set(), round: 0, more: false, began: 0, theme: null, held: null, let_go: false, grounded: false };
  const stats = { frames: 0, shown: 0 };
  let [robot, plan, motion, X, framing, renderer, colouring, pace, scene] = [];
  const touch = () => (state.dirty = true);
  const camera = cameraOf(canvas, () => calm.matches, () => ((state.moved = performance.now()), touch()));
  camera.follow = false;
  const cube = cubeOf(name => {
    camera.side(name);
    fit();
  });
  const scale = scaleBar(() => true);

  function fit(jump) {
    if (!plan) return;
    motion.place(0, X);
    camera.fit(framing);
    if (jump) camera.jump();
    touch();
  }

  /** The picture of one robot as it is declared, without the ground. What was its base stays where it was, so that a change of
      one joint, or a new base, does not move everything. Several robots stand where they are placed. */
  let anchor = null;
  const isFree = ({ picture: { body } }) => body.form === "tracks" && !body.paths && !body.around;
  function asDeclared({ picture, modules }) {
    const { body } = picture;
    const free = { ...picture, ground: null, floor: 0, stand: [], contacts: [], body: { ...body, base: [[0, 0, 0, 0, 0, 0, 0, 1]] } };
    const known = anchor ? modules.findIndex(module => module.name === anchor.name) : -1;
    let base = { p: [0, 0, 0], q: [0, 0, 0, 1] };
    const motion = motionOf(free);
    if (known >= 0) {
      const places = new Float32Array(POSE * motion.bodies);
      motion.place(0, places);
      const at = POSE * motion.moduleOf.indexOf(known);
      const [x, y, z, w] = places.subarray(at + 4, at + 8);
      const q = product(anchor.q, [-x, -y, -z, w]);
      base = { p: sub(anchor.p, turned(q, [...places.subarray(at, at + 3)])), q };
    }
    anchor = { name: modules[motion.moduleOf[body.trees[0].root]].name, ...base };
    free.body.base = [[0, ...base.p, ...base.q]];
    return free;
  }

  /** Shows a robot; the camera stays where it is, but for the first one and for another declaration. */
  function show(next) {
    const other = !robot || robot.name !== next.name;
    if (other) anchor = null;
    [robot, plan] = [next, state.grounded || !isFree(next) ? next.picture : asDeclared(next)];
    $("rest").hidden = !isFree(next);
    [standTimesKnown, contactTimesKnown] = [null, null];
    motion = motionOf(plan);
    X = new Float32Array(POSE * motion.bodies);
    try {
      if (renderer) renderer.replace(plan, motion);
      else if (renderer !== null) {
        renderer = rendererOf(canvas, plan, motion);
        pace = paceOf(renderer.software);
      }
    } catch (error) {
      renderer = null;
      [canvas.hidden, $("still").hidden] = [true, false];
    }
    framing = framingOf(plan, motion, X);
    camera.reach = 6 * framing.radius;
    camera.lowest = plan.ground ? -0.2 : -1.55;
    colouring = colouringsOf(plan, motion)[0];
    if (other) fit(stats.shown === 0);
    // Where drawing takes long, the first picture of a newer text is a quick one.
    if (stats.shown) state.moved = performance.now();
    stats.shown++;
    touch();
  }

  /** The link of a body with what carries it: its step in the tree. */
  const stepOf = body => plan.body.form === "tracks" ? plan.body.trees[0].steps.find(([link]) => link === body) : undefined;
  const frame = body => ({ p: [...X.subarray(POSE * body, POSE * body + 3)], q: [...X.subarray(POSE * body + 4, POSE * body + 8)] });

  /** The joint that moves a body, with its axis in the world: {joint, factor, axis, origin}; null if none does that can be set. */
  function jointOf(body) {
    for (let step = stepOf(body); step; step = stepOf(step[1])) {
      const [, parent, form, terms] = step;
      const pairs = typeof terms === "number" ? [[terms, 1]] : Array.from({ length: (terms || []).length / 2 }, (_, i) => [terms[2 * i], terms[2 * i + 1]]);
      for (const [index, factor] of pairs) {
        const joint = robot.joints.find(known => known.index === index);
        if (!joint) continue;
        const [{ axis, along, shift, turn }, { p, q }] = [plan.body.forms[form], frame(parent)];
        // A step slides in the frame of what carries it, and turns in its own.
        const direction = axis ? turned(product(q, turn), axis) : turned(q, along || [0, 0, 0]);
        return { joint, factor, turns: Boolean(axis), axis: direction, origin: add(p, turned(q, shift)) };
      }
      // What holds it still is asked for what moves that.
    }
    return null;
  }

  const ratio = () => [canvas.clientWidth, canvas.clientHeight];
  /** Where a point of the world is on the canvas, in pixels; null behind the camera. */
  function onScreen(p) {
    const s = projected(camera.matrix, p);
    const [w, h] = ratio();
    return s && [((s[0] + 1) / 2) * w, ((1 - s[1]) / 2) * h];
  }

  /** The free ports whose dots are shown, with their places: those of what is selected or pointed at, seen from outside. */
  function dots() {
    if (!robot || !robot.ports.length) return [];
    const firstLink = firstLinks();
    return robot.ports.filter(port => port.offers.length && (state.chosen.has(port.module) || port.module === state.hovered)).flatMap(port => {
      const { p, q } = frame(firstLink[port.module] + port.link);
      const at = add(p, turned(q, port.at));
      return dot(turned(q, port.out), sub(camera.eye, at)) > 0 ? [{ port, at }] : [];
    });
  }
  let links = null;
  function firstLinks() {
    if (links && links.of === motion) return links.list;
    const list = [];
    motion.moduleOf.forEach((module, body) => (list[module] === undefined ? (list[module] = body) : 0));
    links = { of: motion, list };
    return list;
  }

  const placeOf = e => {
    const rect = canvas.getBoundingClientRect();
    return [e.clientX - rect.left, e.clientY - rect.top];
  };
  const bodyAt = ([x, y]) => {
    const [w, h] = ratio();
    return renderer && scene ? renderer.pick(scene, X, x / w, y / h) : -1;
  };
  function portAt([x, y]) {
    const near = dots().map(({ port, at }) => ({ port, at: onScreen(at) })).filter(({ at }) => at && Math.hypot(at[0] - x, at[1] - y) < PORT_NEAR);
    return near.sort((a, b) => Math.hypot(a.at[0] - x, a.at[1] - y) - Math.hypot(b.at[0] - x, b.at[1] - y))[0] || null;
  }

  /** A link of what is selected is held: it follows the pointer round its joint. */
  $("stage").addEventListener("pointerdown", e => {
    if (e.target !== canvas || e.button !== 0 || e.shiftKey || !renderer || !scene) return;
    const at = placeOf(e);
    if (portAt(at)) return;
    const body = bodyAt(at);
    if (body < 0 || !state.chosen.has(motion.moduleOf[body])) return;
    const found = jointOf(body);
    if (!found || found.joint.fixed) return found && on.refused(found.joint.fixed);
    const [w, h] = ratio();
    const depth = renderer.pick(scene, X, at[0] / w, at[1] / h, true);
    if (depth < 0) return;
    const point = unprojected(camera.matrix, at[0] / w, at[1] / h, depth);
    state.held = { ...found, point, at, from: at, start: plan.body.start[found.joint.index], value: plan.body.start[found.joint.index], moved: 0 };
    canvas.setPointerCapture(e.pointerId);
    canvas.classList.add("held");
    $("tip").hidden = true;
    e.stopPropagation();
  }, true);
  $("stage").addEventListener("pointermove", e => {
    const { held } = state;
    if (!held) return;
    e.stopPropagation();
    const at = placeOf(e);
    const [dx, dy] = [at[0] - held.at[0], at[1] - held.at[1]];
    held.at = at;
    held.moved += Math.abs(dx) + Math.abs(dy);
    if (held.moved < 4) return;
    // The point that is held has moved with its link so far.
    const turnedBy = held.factor * (held.value - held.start);
    const arm = sub(held.point, held.origin);
    const now = held.turns ? turned(about(held.axis, turnedBy), arm) : add(arm, scaled(held.axis, turnedBy));
    const speed = held.turns ? cross(held.axis, now) : held.axis;
    const small = held.turns ? 1e-3 : 1e-4;
    const [a, b] = [onScreen(add(held.origin, now)), onScreen(add(add(held.origin, now), scaled(speed, small * held.factor)))];
    const s = a && b ? [(b[0] - a[0]) / small, (b[1] - a[1]) / small] : [0, 0];
    const size = s[0] ** 2 + s[1] ** 2;
    held.value += size > SCREEN_LEAST ** 2 ? (dx * s[0] + dy * s[1]) / Math.max(size, held.turns ? SCREEN_RADIAN ** 2 : 0) : (dx - dy) * (held.turns ? SLOW_TURN : SLOW_SLIDE);
    const range = held.joint.range || [-Infinity, Infinity];
    on.joint(held.joint, clamp(roundedJoint(held.joint, held.value, e.altKey), range[0], range[1]), false);
  }, true);
  for (const end of ["pointerup", "pointercancel"]) $("stage").addEventListener(end, e => {
    const { held } = state;
    if (!held) return;
    state.held = null;
    canvas.classList.remove("held");
    e.stopPropagation();
    const value = plan.body.start[held.joint.index];
    // The click that follows is none.
    state.let_go = held.moved >= 4;
    if (held.moved < 4 || end === "pointercancel") preview(held.joint, held.start);
    else on.joint(held.joint, value, true);
  }, true);

  /** A joint at a value, before the text says so. */
  function preview(joint, value) {
    if (!plan || plan.body.form !== "tracks") return;
    plan.body.start[joint.index] = value;
    touch();
  }

  let pressed = null;
  canvas.addEventListener("pointermove", e => {
    if (!renderer || !scene || e.buttons) return;
    const at = placeOf(e);
    const port = portAt(at);
    const body = port ? -1 : bodyAt(at);
    const module = port ? port.port.module : body < 0 ? null : motion.moduleOf[body];
    canvas.classList.toggle("joint", Boolean(port) || (body >= 0 && state.chosen.has(module)));
    const tip = $("tip");
    tip.hidden = module === null;
    if (module !== null) {
      const facts = port ? [["free port", port.port.name], ["connector", port.port.connector]] : motion.facts(body, 0);
      tip.replaceChildren(el("b", {}, visible(motion.modules[module].name)), el("dl", {}, facts.flatMap(([k, v]) => [el("dt", {}, visible(k)), el("dd", {}, visible(v))])));
      tip.style.left = clamp(at[0] + 16, 0, ratio()[0] - 240) + "px";
      tip.style.top = clamp(at[1] + 16, 0, ratio()[1] - 30 - 20 * facts.length) + "px";
    }
    if (module !== state.hovered) (state.hovered = module), touch();
  });
  canvas.addEventListener("pointerleave", () => {
    state.hovered = null;
    $("tip").hidden = true;
    touch();
  });
  canvas.addEventListener("pointerdown", e => (pressed = placeOf(e)));
  canvas.addEventListener("click", e => {
    const at = placeOf(e);
    if (state.let_go) return (state.let_go = false);
    if (camera.dragged() && pressed && Math.hypot(at[0] - pressed[0], at[1] - pressed[1]) > 4) return;
    const port = portAt(at);
    $("tip").hidden = true;
    if (port) return on.port(port.port, at);
    const body = bodyAt(at);
    on.choose(body < 0 ? null : motion.moduleOf[body]);
  });

  function theme(dark) {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    state.theme = { ...themeOf(dark, false), lineInk: dark ? rgb("#e6e8ea") : rgb("#222c36") };
    touch();
  }

  const coarseness = () => (renderer && (state.held || performance.now() - state.moved < TURNED_FOR) ? pace.level() : 0);
  function resize() {
    document.body.classList.toggle("slow", coarseness() > 1);
    const size = Math.min(devicePixelRatio || 1, 2) * PIXELS[coarseness()];
    const [w, h] = ratio().map(x => Math.max(Math.round(x * size), 1));
    if (canvas.width !== w || canvas.height !== h) (canvas.width = w), (canvas.height = h);
    touch();
  }

  function draw(seconds) {
    motion.place(0, X);
    paint(plan, motion, colouring, X, 0, state.hovered, null, state.theme.dark);
    for (let b = 0; b < motion.bodies; b++) {
      if (!state.chosen.size) break;
      if (state.chosen.has(motion.moduleOf[b])) X[POSE * b + 15] = 0.6;
      else for (let k = 12; k < 15; k++) X[POSE * b + k] = mix(X[POSE * b + k], state.theme.dark ? 0.34 : 0.78, 0.45);
    }
    const moving = camera.update(seconds);
    const now = framing.now();
    const grain = framing.radius;
    const floor = floorOf(plan);
    const marks = dots().flatMap(({ at }) => spotOf(at, 9, [...state.theme.accent, 1], state.theme));
    scene = {
      camera, theme: state.theme, solids: motion.solids, middle: now.middle, radius: now.radius, grain, floor: plan.floor, lowest: framing.lowest, floorAt: floor,
      slope: plan.slope || [0, 0], ground: plan.ground, shadow: coarseness() < 2, sky: coarseness() < 1, edges: coarseness() < 2, grid: true,
      smooth: coarseness() < 1, detail: DETAIL[coarseness()], ghosts: [], target: null, area: [], lines: [], marks,
    };
    if (renderer) {
      const drawn = renderer.show(scene, X, 0);
      [state.round, state.more, state.began] = [0, drawn.more, performance.now()];
    }
    cube.turn(camera.yaw, camera.pitch);
    scale.show(camera.distance, canvas.clientHeight, gridStep(grain));
    stats.frames++;
    return moving;
  }

  let last = performance.now();
  let coarse = 0;
  function step(now) {
    const passed = clamp((now - last) / 1000, 0, 0.1);
    if (renderer && (now - state.moved < TURNED_FOR || state.held) && state.dirty && pace.saw(now - last)) resize();
    if (renderer && coarseness() !== coarse) (coarse = coarseness()), resize();
    last = now;
    if (state.dirty && plan) {
      state.dirty = false;
      state.dirty = draw(passed) || state.dirty;
    } else if (state.more && renderer && performance.now() - state.began > RESTED_FOR) {
      const drawn = renderer.show(scene, X, ++state.round);
      state.more = drawn.more && (state.round < ROUNDS_LEAST || performance.now() - state.began < REFINED_FOR);
    }
    requestAnimationFrame(step);
  }

  new ResizeObserver(resize).observe($("stage"));
  theme(matchMedia("(prefers-color-scheme: dark)").matches);
  resize();
  requestAnimationFrame(step);

  return {
    state, stats, camera, show, preview, fit, theme, onScreen,
    /** On the ground, or as it is declared. */
    ground(on) {
      state.grounded = on;
      anchor = null;
      if (!robot) return;
      show(robot);
      fit();
    },
    select(modules) {
      state.chosen = new Set(modules);
      touch();
    },
    /** Places for scripts and tests: of a module's middle link, of the shown dots; what is under a place. */
    middleOf: module => onScreen(frame(firstLinks()[module]).p),
    placeOfLink: body => onScreen(frame(body).p),
    dots: () => dots().map(({ port, at }) => ({ name: port.name, at: onScreen(at) })),
    moduleAt: at => { const body = bodyAt(at); return body < 0 ? null : motion.moduleOf[body]; },
    bodyAt,
    jointAt: body => { const found = jointOf(body); return found && found.joint.name; },
    value: index => plan.body.start[index],
  };
}

/** So long after it was turned the picture counts as moving, ms. */
const TURNED_FOR = 160;
/** So long everything is at rest before the picture gets better, ms; so long it does, but so often at least. */
const RESTED_FOR = 200;
const REFINED_FOR = 5000;
const ROUNDS_LEAST = 5;

/** A position that is let go is a whole degree or millimetre, with the key Alt a tenth of one. */
function roundedJoint(joint, value, finely) {
  const unit = (joint.turns ? Math.PI / 180 : 1e-3) * (finely ? 0.1 : 1);
  return Math.round(value / unit) * unit;
}
