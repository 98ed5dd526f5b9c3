// The values beside the picture: parameters of the configuration and of its behaviours, joints of what is selected.

/** Digits of a number of a slider. */
const digitsOf = step => Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9)));

/** A slider with a number. `tell(value, done)`: it is dragged, or was let go. */
function sliderOf(tell) {
  const number = el("input", { type: "number", step: "any" });
  const range = el("input", { type: "range" });
  const [label, unit, note] = [el("label", {}), el("span", { class: "unit" }), el("span", { class: "note", hidden: "" })];
  const root = el("div", { class: "control" }, label, number, unit, range, note);
  let busy = false;
  range.addEventListener("input", () => {
    busy = true;
    number.value = range.value;
    tell(Number(range.value), false);
  });
  range.addEventListener("change", () => {
    busy = false;
    tell(Number(range.value), true);
  });
  number.addEventListener("change", () => number.value !== "" && tell(Number(number.value), true));
  return {
    root,
    show({ name, value, low, high, step, unit: shown, fixed }) {
      label.textContent = visible(name);
      for (const input of [number, range]) input.setAttribute("aria-label", name);
      unit.textContent = shown;
      [number.disabled, range.disabled, note.hidden] = [Boolean(fixed), Boolean(fixed), !fixed];
      note.textContent = fixed ? visible(fixed) : "";
      number.hidden = value === null;
      if (busy || value === null) return;
      const rounded = Number(value.toFixed(6));
      [range.min, range.max, range.step] = [Math.min(low, rounded), Math.max(high, rounded), step];
      range.value = rounded;
      if (document.activeElement !== number) number.value = rounded;
    },
  };
}

/** A box for a truth value. */
function boxOf(tell) {
  const box = el("input", { type: "checkbox" });
  const label = el("span", {});
  box.addEventListener("change", () => tell(box.checked, true));
  return {
    root: el("div", { class: "control" }, el("label", { class: "switch" }, box, label)),
    show({ name, value, fixed }) {
      label.textContent = visible(name);
      box.checked = value === 1;
      box.disabled = Boolean(fixed);
      if (fixed) label.title = visible(fixed);
    },
  };
}

/** The panel of values. `on.parameter(parameter, value, done)` and `on.joint(joint, value, done)` are told of changes. */
function controlsOf(on) {
  const root = $("controls");
  let shape = "";
  let made = [];

  /** What is shown, in sections: [title, [[key, kind, data], ...], words]. */
  function sectionsOf(robot, chosen) {
    const sections = [];
    const own = robot.parameters.filter(p => p.behavior === null);
    const values = list => list.map(p => [(p.behavior || "") + "." + p.name, p.truth ? "box" : "parameter", p]);
    if (own.length) sections.push(["Parameters of " + robot.name, values(own)]);
    for (const behavior of new Set(robot.parameters.map(p => p.behavior).filter(Boolean)))
      sections.push(["Behaviour " + behavior, values(robot.parameters.filter(p => p.behavior === behavior))]);
    const joints = robot.joints.filter(j => chosen.has(j.module) || (j.module === null && chosen.size > 0 && [...chosen].some(m => robot.modules[m] && j.name.startsWith(robot.modules[m].name + "."))));
    if (chosen.size === 1) {
      const { name } = robot.modules[[...chosen][0]];
      const ports = robot.ports.filter(p => chosen.has(p.module)).length;
      sections.push([name, joints.map(j => ["joint " + j.name, "joint", j]), (joints.length ? "Drag a link of it to turn its joint. " : "") + (ports ? ports + " free ports: click a dot to dock something there." : "")]);
    } else if (joints.length && chosen.size < 9) sections.push(["Joints of " + chosen.size + " modules", joints.map(j => ["joint " + j.name, "joint", j])]);
    else if (robot.modules.length) sections.push(["Selection", [], "Click a module in the picture, or a line of the text."]);
    return sections;
  }

  const dataOf = (kind, data, robot, alone) => {
    if (kind !== "joint") return data;
    const scale = data.turns ? 180 / Math.PI : 1000;
    const [low, high] = data.range || (data.turns ? [-Math.PI, Math.PI] : [-0.1, 0.1]);
    const name = data.module === null || !alone ? data.name : data.name.slice(robot.modules[data.module].name.length + 1);
    return { name, value: data.value * scale, low: low * scale, high: high * scale, step: 1, unit: data.turns ? "deg" : "mm", fixed: data.fixed };
  };

  return {
    /** Shows the values of a robot and of the modules that are selected. Controls that stay are not made anew, since one may be held. */
    show(robot, chosen) {
      const sections = sectionsOf(robot, chosen);
      const next = JSON.stringify(sections.map(([title, rows, words]) => [title, rows.map(row => row.slice(0, 2)), words]));
      if (next !== shape) {
        shape = next;
        made = [];
        root.replaceChildren();
        for (const [title, rows, words] of sections) {
          root.append(el("h2", {}, visible(title)));
          for (const [key, kind] of rows) {
            const control = { key, kind, data: null };
            const tell = (value, done) => (kind === "joint" ? on.joint(control.data, value / (control.data.turns ? 180 / Math.PI : 1000), done) : on.parameter(control.data, value, done));
            Object.assign(control, kind === "box" ? boxOf(tell) : sliderOf(tell));
            control.root.dataset.key = key;
            made.push(control);
            root.append(control.root);
          }
          if (words) root.append(el("p", {}, words));
        }
      }
      const rows = sections.flatMap(([, list]) => list);
      made.forEach((control, i) => {
        control.data = rows[i][2];
        control.show(dataOf(control.kind, control.data, robot, chosen.size === 1));
      });
    },
  };
}

/** The menu of what mates at a port. `dock(offer, turn)` is told what is chosen. */
function menuOf(dock) {
  const menu = $("menu");
  menu.addEventListener("pointerdown", e => e.stopPropagation());
  return {
    close: () => (menu.hidden = true),
    open(port, offers, [x, y]) {
      let turn = 0;
      const head = [el("b", {}, visible(port.name)), el("p", {}, offers.length ? "A free port (" + visible(port.connector) + "). What is docked here?" : "Nothing that the program names mates with a " + visible(port.connector) + "; a `use` brings more.")];
      const turns = el("div", { class: "choice" }, Array.from({ length: offers.length ? port.turns : 0 }, (_, k) => {
        const button = el("button", { "aria-pressed": k === 0, title: "turn" }, Number(((360 * k) / port.turns).toFixed(2)) + "°");
        button.addEventListener("click", () => {
          turn = k;
          turns.querySelectorAll("button").forEach((other, i) => other.setAttribute("aria-pressed", i === k));
        });
        return button;
      }));
      const parts = [...new Set(offers.map(offer => offer.part))].flatMap(part => [
        el("b", {}, visible(part)),
        el("div", { class: "choice" }, offers.filter(offer => offer.part === part).map(offer => el("button", { "data-offer": offer.part + "." + offer.port, on: () => ((menu.hidden = true), dock(offer, turn)) }, visible(offer.port)))),
      ]);
      menu.replaceChildren(...head, ...(port.turns > 1 && offers.length ? [turns] : []), ...parts);
      menu.hidden = false;
      const stage = $("stage");
      menu.style.left = clamp(x + 12, 8, Math.max(stage.clientWidth - 262, 8)) + "px";
      menu.style.top = clamp(y - 20, 8, Math.max(stage.clientHeight - menu.offsetHeight - 8, 8)) + "px";
    },
  };
}
