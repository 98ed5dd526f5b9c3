"use strict";
const search = document.getElementById("search");
const found = document.getElementById("found");

function score([name, about], words) {
  const low = name.toLowerCase();
  let sum = 0;
  for (const word of words) {
    if (low === word) sum += 100;
    else if (low.startsWith(word)) sum += 60;
    else if (low.includes(word)) sum += 30;
    else if (about.toLowerCase().includes(word)) sum += 5;
    else return 0;
  }
  return sum - name.length / 100;
}

search.addEventListener("input", () => {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = words.length ? INDEX.map((row) => [score(row, words), row]).filter(([s]) => s > 0) : [];
  rows.sort((a, b) => b[0] - a[0]);
  found.replaceChildren(...rows.slice(0, 30).map(([, [name, about, address]]) => {
    const item = document.createElement("li");
    const link = document.createElement("a");
    link.href = address;
    link.textContent = name;
    const small = document.createElement("small");
    small.textContent = about;
    item.append(link, small);
    return item;
  }));
});

search.addEventListener("keydown", (event) => {
  const first = found.querySelector("a");
  if (event.key === "Enter" && first) location.href = first.href;
});
