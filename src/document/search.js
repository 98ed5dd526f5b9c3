"use strict";
const search = document.getElementById("search");
const found = document.getElementById("found");

/** Rows that are shown, and letters of a snippet before and behind the first word that is found. */
const ROWS_MAX = 30;
const BEFORE = 40;
const BEHIND = 110;

/** How well a row fits: 0 if a word is nowhere in it. Names count more than kinds and pages, and these more than text. */
function score([name, place, , text], words) {
  const [low, near, far] = [name, place, text].map(part => part.toLowerCase());
  let sum = 0;
  for (const word of words) {
    if (low === word) sum += 100;
    else if (low.startsWith(word)) sum += 60;
    else if (low.includes(word)) sum += 30;
    else if (near.includes(word)) sum += 8;
    else if (far.includes(word)) sum += 4;
    else return 0;
  }
  return sum - name.length / 100;
}

/** The text around the first of the words that is in it, from the beginning of a word on. */
function snippet(text, words) {
  const low = text.toLowerCase();
  const first = Math.min(...words.map(word => low.indexOf(word)).filter(at => at >= 0));
  if (!Number.isFinite(first)) return text.length > BEHIND ? text.slice(0, BEHIND) + " …" : text;
  const from = first <= BEFORE ? 0 : text.lastIndexOf(" ", first - BEFORE) + 1;
  const to = first + BEHIND >= text.length ? text.length : text.lastIndexOf(" ", first + BEHIND);
  return (from ? "… " : "") + text.slice(from, Math.max(to, first + 1)) + (to < text.length ? " …" : "");
}

/** A text as nodes, with the words that were looked for marked. */
function marked(text, words) {
  const low = text.toLowerCase();
  const nodes = [];
  for (let at = 0; at < text.length; ) {
    const [start, word] = words.map(word => [low.indexOf(word, at), word]).filter(([i]) => i >= 0).sort((a, b) => a[0] - b[0])[0] || [text.length, ""];
    if (start > at) nodes.push(text.slice(at, start));
    if (word) {
      const mark = document.createElement("mark");
      mark.textContent = text.slice(start, start + word.length);
      nodes.push(mark);
    }
    at = start + word.length;
  }
  return nodes;
}

function show() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = words.length ? INDEX.map(row => [score(row, words), row]).filter(([s]) => s > 0) : [];
  rows.sort((a, b) => b[0] - a[0]);
  found.replaceChildren(...rows.slice(0, ROWS_MAX).map(([, [name, place, address, text]]) => {
    const [item, link, small, words_] = ["li", "a", "small", "span"].map(tag => document.createElement(tag));
    link.href = address;
    link.append(...marked(name, words));
    small.textContent = place;
    words_.append(...marked(snippet(text, words), words));
    item.append(link, small, words_);
    return item;
  }));
}

search.addEventListener("input", show);
search.addEventListener("keydown", event => {
  const first = found.querySelector("a");
  if (event.key === "Enter" && first) location.href = first.href;
  if (event.key === "Escape") (search.value = ""), show();
  if (event.key === "ArrowDown" && first) first.focus(), event.preventDefault();
});
found.addEventListener("keydown", event => {
  const links = [...found.querySelectorAll("a")];
  const at = links.indexOf(document.activeElement) + { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (Number.isNaN(at)) return;
  (links[at] || search).focus();
  event.preventDefault();
});
addEventListener("keydown", event => {
  if (event.key !== "/" || event.ctrlKey || event.metaKey || event.altKey || document.activeElement === search) return;
  search.focus();
  event.preventDefault();
});
// A page that is shown again keeps what was typed.
show();
