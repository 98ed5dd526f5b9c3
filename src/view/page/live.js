// A program that is typed: the text, the picture and the values are one.

/** So long a message stays, ms. */
const MESSAGE_FOR = 6000;

function live() {
  const page = { state: null, robot: null, chosen: [], previewed: null, edits: 0 };
  let hush = 0;

  /** Says something that was refused. */
  function say(words) {
    const box = $("message");
    box.textContent = visible(words);
    box.hidden = false;
    clearTimeout(hush);
    hush = setTimeout(() => (box.hidden = true), MESSAGE_FOR);
  }

  /** Asks for a change of the text; what is refused is said, and the picture is that of the text again. */
  async function change(what, edit) {
    page.previewed = null;
    const answer = await ask(what, edit ? { version: wire.version, edit } : { version: wire.version });
    page.edits++;
    if (!answer.refused) return;
    say(answer.refused);
    if (page.state) show(page.state, true);
  }

  /** The last wish to see a change before it is made; one is under way at a time. */
  let [wish, waits] = [null, false];
  async function foresee(edit) {
    wish = edit;
    if (waits) return;
    waits = true;
    while (wish) {
      const edit = wish;
      wish = null;
      const answer = await ask("preview", { version: wire.version, edit });
      if (!answer) continue;
      if (answer.refused) say(answer.refused);
      else if (answer.robot && page.previewed === edit.name) $("message").hidden = true, picture.show(answer.robot);
    }
    waits = false;
  }

  const text = sourceOf(line => {
    const modules = modulesOf(line);
    if (modules.length || page.chosen.length) choose(modules, line);
  });
  const picture = pictureOf({
    choose: module => choose(module === null ? [] : [module]),
    port: (port, place) => menu.open(port, port.offers.map(i => page.robot.offers[i]), place) || (page.port = port),
    joint: moveJoint,
    refused: say,
  });
  const menu = menuOf((offer, turn) => change("edit", { edit: "dock", robot: page.robot.name, port: page.port.name, part: offer.part, at: offer.port, turn }));
  const controls = controlsOf({
    parameter(parameter, value, done) {
      const edit = { edit: "parameter", robot: page.robot.name, behavior: parameter.behavior, name: parameter.name, value };
      if (done) return change("edit", edit);
      // What a behaviour does is not seen in a robot that stands still.
      if (parameter.behavior === null) (page.previewed = parameter.name), foresee(edit);
    },
    joint: moveJoint,
  });

  function moveJoint(joint, value, done) {
    const label = $("value");
    label.hidden = done;
    if (done) {
      if (Math.abs(value - joint.value) < 1e-9) return picture.preview(joint, joint.value);
      return change("edit", { edit: "joint", robot: page.robot.name, joint: joint.name, value });
    }
    picture.preview(joint, value);
    label.textContent = visible(joint.name) + "  " + (joint.turns ? ((value * 180) / Math.PI).toFixed(1) + "°" : (value * 1000).toFixed(1) + " mm");
    [label.style.left, label.style.top] = ["18px", "86px"];
  }

  /** The modules that a line is about. */
  function modulesOf(line) {
    if (!page.robot) return [];
    const within = ({ line: first, last }) => first <= line && line <= last;
    const own = page.robot.modules.flatMap((module, i) => (module.parts.some(within) ? [i] : []));
    return [...new Set([...own, ...page.robot.marks.filter(mark => within(mark.place)).flatMap(mark => mark.modules)])];
  }

  const linesOf = ({ line, last }) => Array.from({ length: last - line + 1 }, (_, i) => line + i);

  /** Selects modules, in the picture and in the text; `line`: that of the text that was clicked. */
  function choose(modules, line) {
    page.chosen = modules.map(i => page.robot.modules[i]).filter(Boolean).map(module => module.name);
    menu.close();
    mark(line);
  }

  function mark(line) {
    const { robot } = page;
    if (!robot) return;
    const modules = robot.modules.flatMap((module, i) => (page.chosen.includes(module.name) ? [i] : []));
    picture.select(modules);
    controls.show(robot, new Set(modules));
    const parts = modules.map(i => robot.modules[i].parts);
    const own = line ? [line] : parts.flatMap(([first]) => (first ? linesOf(first) : []));
    const inner = parts.flatMap(list => list.slice(1).flatMap(linesOf));
    text.mark(own, [...inner, ...(line ? parts.flatMap(([first]) => (first ? linesOf(first) : [])) : [])], !line);
  }

  function show(state, again) {
    page.state = state;
    const { model } = state;
    text.show(state.text);
    const errors = model.findings.filter(found => found.severity === "error");
    const lines = new Set(errors.flatMap(found => found.labels.slice(0, 1).filter(label => !label.library).map(label => label.line)));
    showFindings(model.findings, state.gone, text.reveal);
    [$("undo").disabled, $("redo").disabled] = [!state.undo, !state.redo];
    showRobots(model.robots);
    const { robot } = model;
    if (robot) {
      page.robot = robot;
      document.body.classList.add("shown");
      document.title = robot.name;
      $("head").querySelector("h1").textContent = visible(robot.name);
      const count = robot.modules.length;
      $("stamp").textContent = count ? count + (count === 1 ? " module" : " modules") : "";
      // A refused change has left its traces in what was shown.
      if (again) for (const joint of robot.joints) robot.picture.body.start[joint.index] = joint.value;
      picture.show(robot);
    } else if (page.robot && page.state) {
      // The lines of the picture are those of an older text.
      page.robot = { ...page.robot, modules: page.robot.modules.map(module => ({ ...module, parts: [] })), marks: [] };
    }
    const stale = !robot && page.robot;
    $("why").textContent = errors.length || state.gone ? (stale ? "The picture is that of the text before the error." : "The text has an error.") : robot ? "" : "The text declares no robot that needs no arguments.";
    const can = new Set(page.robot ? [...page.robot.modules.flatMap(module => module.parts), ...page.robot.marks.map(m => m.place)].flatMap(linesOf) : []);
    text.note(can, lines);
    mark();
  }

  function showRobots(names) {
    const select = $("robots");
    const now = page.state.model.robot ? page.state.model.robot.name : wire.robot;
    if ([...select.options].map(o => o.value).join("\n") !== names.join("\n")) select.replaceChildren(...names.map(name => el("option", { value: name }, name)));
    if (names.includes(now)) select.value = now;
    select.disabled = names.length < 2;
  }

  const wire = wireOf(state => show(state), lost => document.body.classList.toggle("lost", lost) && say("modl does not answer: is it still running?"));

  $("robots").addEventListener("change", () => {
    page.chosen = [];
    wire.wish($("robots").value);
  });
  $("ground").addEventListener("change", () => picture.ground($("ground").checked));
  $("undo").addEventListener("click", () => change("undo"));
  $("redo").addEventListener("click", () => change("redo"));
  $("stage").addEventListener("pointerdown", e => e.target === $("view") && menu.close());
  document.addEventListener("keydown", e => {
    if (e.target instanceof HTMLInputElement && e.target.type === "number") return;
    const key = e.key.toLowerCase();
    if ((e.ctrlKey || e.metaKey) && (key === "z" || key === "y")) {
      e.preventDefault();
      return change(key === "y" || e.shiftKey ? "redo" : "undo");
    }
    if (e.ctrlKey || e.metaKey || e.altKey || e.target instanceof HTMLSelectElement) return;
    if (key === "escape") menu.close(), choose([]);
    if (key === "f") picture.fit();
    if (key === "h") picture.camera.side("corner"), picture.fit();
    if (key === "g") $("ground").click();
    if (key === "d") picture.theme(!picture.state.theme.dark);
  });
  // For scripts and tests.
  window.modl = { page, wire, picture };
}

live();
