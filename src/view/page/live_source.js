// The text: its lines with colours, those that are marked, and what is wrong with it.

/** The text beside the picture; `choose` is told the number of a line that is clicked. */
function sourceOf(choose) {
  const list = $("text").querySelector("ol");
  let lines = [];
  let rows = [];
  let marked = [];

  const rowOf = (line, i) => {
    const row = el("li", { "data-line": i + 1 }, el("span", {}, coloured(line)));
    row.addEventListener("click", () => choose(i + 1));
    return row;
  };

  /** Shows a text; the lines that are other ones than before light up for a moment, but for the first time. */
  function show(text) {
    const next = text.split(/\r?\n/);
    let [first, last] = [0, 0];
    while (first < Math.min(lines.length, next.length) && lines[first] === next[first]) first++;
    while (last < Math.min(lines.length, next.length) - first && lines[lines.length - 1 - last] === next[next.length - 1 - last]) last++;
    const fresh = next.slice(first, next.length - last).map((line, i) => rowOf(line, first + i));
    if (lines.length) fresh.forEach(row => row.classList.add("fresh"));
    rows.slice(first, rows.length - last).forEach(row => row.remove());
    const kept = rows.slice(rows.length - last);
    if (next.length !== lines.length) kept.forEach((row, i) => {
      // A row knows its line by its number: those behind a change move.
      const moved = rowOf(next[next.length - last + i], next.length - last + i);
      row.replaceWith(moved);
      kept[i] = moved;
    });
    const before = rows[first - 1];
    if (before) before.after(...fresh);
    else list.prepend(...fresh);
    rows = [...rows.slice(0, first), ...fresh, ...kept];
    lines = next;
  }

  /** Marks lines: `lit` strongly, `callee` faintly; brings the first of them into view. */
  function mark(lit, callee, scroll) {
    marked.forEach(row => row.classList.remove("lit", "callee"));
    const of = numbers => numbers.map(number => rows[number - 1]).filter(Boolean);
    of(callee).forEach(row => row.classList.add("lit", "callee"));
    of(lit).forEach(row => (row.classList.remove("callee"), row.classList.add("lit")));
    marked = [...of(callee), ...of(lit)];
    const [row] = of(lit);
    if (row && scroll) row.scrollIntoView({ block: "nearest" });
  }

  /** Lines that can be clicked, and lines that something is wrong with. */
  function note(can, wrong) {
    rows.forEach((row, i) => {
      row.classList.toggle("can", can.has(i + 1));
      row.classList.toggle("wrong", wrong.has(i + 1));
    });
  }

  const reveal = number => rows[number - 1] && rows[number - 1].scrollIntoView({ block: "center" });
  return { show, mark, note, reveal };
}

/** Lists what is wrong, with the lines that are at fault: numbers of the shown file. */
function showFindings(findings, gone, reveal) {
  const box = $("findings");
  const rows = findings.filter(found => found.severity !== "note").map(found => {
    const place = found.labels[0];
    const where = place ? (place.library ? place.file + ":" : "line ") + place.line : "";
    const text = [...found.labels.map(label => label.text).filter(Boolean), ...found.hints].join("; ");
    const row = el("button", { class: found.severity, on: () => place && reveal(place.line) },
      el("b", {}, visible(found.message)), el("small", {}, visible([found.code, where].filter(Boolean).join(", "))), text ? el("small", {}, visible(text)) : null);
    return row;
  });
  if (gone) rows.unshift(el("button", { class: "error" }, el("b", {}, visible(gone))));
  box.hidden = !rows.length;
  box.replaceChildren(...rows);
}
