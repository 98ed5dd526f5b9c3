// Beside the picture: the source with its live line, findings, the plan's data, what is drawn.
// All text from the plan goes in as text, never as markup.

/** An element with attributes and children; strings become text. */
function el(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key === "on") made.addEventListener("click", value);
    else if (value !== undefined && value !== null) made.setAttribute(key, value);
  }
  made.append(...children.flat().filter(child => child !== undefined && child !== null));
  return made;
}

/** Control and direction-changing characters, made visible. */
function visible(text) {
  return text.replace(/[\u0000-\u001f\u007f-\u009f\u200e\u200f\u202a-\u202e\u2066-\u2069]/g, c =>
    c === "\t" ? "  " : "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
}

function panelOf(plan, player) {
  const tabs = document.getElementById("tabs");
  const pages = document.getElementById("pages");
  const made = [];
  const source = sourcePage(plan, player);
  const open = index => made.forEach(({ tab, page }, i) => {
    tab.setAttribute("aria-selected", i === index);
    page.hidden = i !== index;
  });
  const add = (title, page) => {
    const index = made.length;
    const tab = el("button", { role: "tab", on: () => open(index) }, title);
    made.push({ tab, page });
    tabs.append(tab);
    pages.append(page);
  };
  if (source) add("Source", source.page);
  add("Findings", findingsPage(plan, player));
  add("Plan", dataPage(plan));
  add("View", viewPage(plan, player));
  open(plan.verdict.stamp === "failed" && source ? 1 : 0);
  return { show: causes => source && source.show(causes) };
}

/** Where in the user's own files a cause stands, and the library's line below it. */
const placesOf = cause => [cause.caller, cause].filter(Boolean).map(place => place.file + ":" + place.line);

function sourcePage(plan, player) {
  const texts = plan.sources.length ? plan.sources : linesOfCauses(plan);
  if (!texts.length) return null;
  const rows = new Map();
  const firsts = new Map();
  player.motion.beginnings().forEach(([time, cause]) => {
    for (const place of placesOf(plan.causes[cause] || {})) if (!firsts.has(place) || firsts.get(place) > time) firsts.set(place, time);
  });
  const blamed = new Set(plan.verdict.failures.flatMap(f => f.blame).flatMap(c => placesOf(plan.causes[c] || {})));
  const page = el("div", { class: "source" });
  for (const { name, lines } of texts) {
    page.append(el("h2", {}, visible(name)));
    page.append(el("ol", {}, lines.map(([number, text]) => {
      const place = name + ":" + number;
      const row = el("li", { "data-line": number, class: blamed.has(place) ? "blame" : null }, el("span", {}, coloured(text)));
      if (firsts.has(place)) {
        row.classList.add("can");
        row.title = "commands from " + seconds(firsts.get(place)) + " on";
        row.addEventListener("click", () => player.seek(firsts.get(place), true));
      }
      rows.set(place, row);
      return row;
    })));
  }
  let lit = [];
  return {
    page,
    show(causes) {
      const commanding = [...causes].map(c => plan.causes[c] || {});
      const places = new Set(commanding.flatMap(placesOf));
      const next = [...places].map(place => rows.get(place)).filter(Boolean);
      if (next.length === lit.length && next.every((row, i) => row === lit[i])) return;
      lit.forEach(row => row.classList.remove("lit", "callee"));
      next.forEach(row => row.classList.add("lit"));
      // What was called stands below the line that called it, and is lit more faintly.
      for (const { caller, file, line } of commanding) if (caller) rows.get(file + ":" + line)?.classList.add("callee");
      for (const { caller } of commanding) if (caller) rows.get(caller.file + ":" + caller.line)?.classList.remove("callee");
      lit = next;
      const box = document.getElementById("pages");
      if (!next.length || page.hidden) return;
      const top = next[0].offsetTop - box.offsetTop;
      if (top < box.scrollTop + 20 || top > box.scrollTop + box.clientHeight - 60) box.scrollTop = top - box.clientHeight / 3;
    },
  };
}

/** Words with a meaning of their own in a program. */
const KEYWORDS = new Set(("alias allows and as at base behavior by capture cell closed collides config connect connector contact each else ensure expect extern facing fn for "
  + "hinge holds if in is joint lattice let link mass mates module motor node not obstacle of on or part port record require scene set snap strut study test touch "
  + "touching truss turn turned turns type up use with world").split(" "));
/** A comment, a text, a number with its unit, a word, in this order; what is none of them stays as it is. */
const TOKEN = /(\/\/.*)|("""[^]*?(?:"""|$)|"(?:[^"\\]|\\.)*"?)|(\b[0-9][0-9_]*(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?(?:[A-Za-z_][A-Za-z0-9_]*(?:\^-?[0-9]+)?(?:[*\/][A-Za-z_][A-Za-z0-9_]*(?:\^-?[0-9]+)?)*)?)|([A-Za-z_][A-Za-z0-9_]*)/g;

/** A line of a program with colours. */
function coloured(text) {
  const parts = [];
  let at = 0;
  for (const found of text.matchAll(TOKEN)) {
    const [whole, remark, quoted, number, word] = found;
    const after = text.slice(found.index + whole.length);
    const kind = remark ? "remark" : quoted ? "text" : number ? "number" : text[found.index - 1] !== "." && KEYWORDS.has(word) && !/^\s*:/.test(after) ? "word"
      : /^[A-Z]/.test(word) ? "type" : /^\s*\(/.test(after) ? "call" : null;
    parts.push(visible(text.slice(at, found.index)), kind ? el("span", { class: kind }, visible(whole)) : visible(whole));
    at = found.index + whole.length;
  }
  return [...parts, visible(text.slice(at))].filter(Boolean);
}

/** A plan file has no source texts, but the lines that its causes stand on. */
function linesOfCauses(plan) {
  const files = new Map();
  for (const cause of plan.causes)
    for (const place of [cause.caller, cause])
      if (place) {
        if (!files.has(place.file)) files.set(place.file, new Map());
        files.get(place.file).set(place.line, place.text);
      }
  return [...files].map(([name, lines]) => ({ name, lines: [...lines].sort((a, b) => a[0] - b[0]) }));
}

function findingsPage(plan, player) {
  const { verdict } = plan;
  const page = el("div", {});
  const row = (time, text, kind) => el("button", { class: "finding " + (kind || ""), on: () => player.seek(time, true) }, el("time", {}, seconds(time)), el("span", {}, visible(text)));
  const list = (title, rows) => rows.length && page.append(el("h2", {}, title), ...rows);
  list("What is wrong", verdict.failures.flatMap(f => [row(f.time, f.message, "bad"), blames(plan, f)]));
  list("Worst values", verdict.worst.map(([time, text]) => row(time, text)));
  list("Events", [...verdict.events.map(([time, text]) => [time, text]), ...player.motion.events.map(e => [e.time, e.text])]
    .sort((a, b) => a[0] - b[0]).slice(0, 500).map(([time, text]) => row(time, text)));
  list("Notes", [...verdict.notes, ...plan.notes].map(note => el("p", {}, visible(note))));
  //: if (plan.simulation) return measuredNumbers(plan, page);
  const checks = el("dl", {}, verdict.checks.flatMap(([name, status]) => [el("dt", {}, name), el("dd", {}, visible(status))]));
  if (verdict.checks.length) list("Checks", [el("div", { class: "data" }, checks)]);
  else page.append(el("p", {}, "Nobody has judged this."));
  return page;
}

function blames(plan, failure) {
  const causes = failure.blame.map(c => plan.causes[c]).filter(Boolean);
  return el("ul", { class: "blames" }, causes.map(cause => {
    const place = cause.caller || cause;
    return el("li", {}, visible(place.file + ":" + place.line + " " + place.text + (cause.instance ? " (" + cause.instance + ")" : "")));
  }));
}

function dataPage(plan) {
  const page = el("div", { class: "data" });
  const rows = plan.data.flatMap(([name, value]) => [el("dt", {}, visible(name)), el("dd", {}, visible(value))]);
  page.append(el("h2", {}, "The plan"), el("dl", {}, rows));
  if (plan.command) page.append(el("h2", {}, "The same again"), el("p", {}, el("code", {}, visible(plan.command))));
  if (plan.texts.length) page.append(el("h2", {}, "Made from"), el("dl", {}, plan.texts.flatMap(([name, hash]) => [el("dt", {}, visible(name)), el("dd", {}, el("code", {}, hash.slice(0, 16)))])));
  return page;
}

function viewPage(plan, player) {
  const page = el("div", {});
  page.append(el("h2", {}, "Colour by"));
  const choice = el("div", { class: "choice" });
  player.colourings.forEach(({ name, title }, i) => choice.append(el("button", { "data-colour": name, on: () => player.colour(name), title: "key " + (i + 1) }, title)));
  page.append(choice, el("div", { id: "parts" }), el("h2", {}, "Show"));
  for (const { name, title, key } of player.toggles) {
    const box = el("input", { type: "checkbox", "data-toggle": name });
    box.checked = player.options[name];
    box.addEventListener("change", () => player.toggle(name, box.checked));
    page.append(el("label", { class: "switch" }, box, title, key ? el("kbd", {}, key) : ""));
  }
  return page;
}
