"use strict";
// Light or dark as the system has it, until one of the two is chosen. Some viewers keep nothing.
const THEMES = ["light", "dark"];
const kept = () => { try { return localStorage.getItem("modl-theme"); } catch { return null; } };
const wish = matchMedia("(prefers-color-scheme: dark)");
const theme = () => (THEMES.includes(kept()) ? kept() : wish.matches ? "dark" : "light");
const showTheme = name => { document.documentElement.dataset.theme = name; };

showTheme(theme());
wish.addEventListener("change", () => showTheme(theme()));
addEventListener("DOMContentLoaded", () => {
  document.getElementById("theme").addEventListener("click", () => {
    const other = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    try { localStorage.setItem("modl-theme", other); } catch { /* it is chosen for this page */ }
    showTheme(other);
  });
  // On a narrow screen the lists would stand above the text.
  if (matchMedia("(max-width: 60rem)").matches)
    for (const list of document.querySelectorAll("nav details, aside details")) list.open = false;
});
