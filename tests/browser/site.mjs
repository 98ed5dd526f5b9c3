// Uses the site of documentation as a person would, in headless Chromium. Prints what is wrong as JSON: a list of sentences.
//   node site.mjs PLAYWRIGHT CHROMIUM FOLDER

import { createRequire } from "node:module";
import { opened } from "./opening.mjs";

const [, , playwright, executablePath, folder] = process.argv;
const { chromium } = createRequire(import.meta.url)(playwright);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-background-networking"] });
const all = [];

/** The least contrast of small text (WCAG 2.1, 1.4.3). */
const CONTRAST = 4.5;

/** A page at a size, with what it complains of. */
async function on(name, options, use) {
  const { context, page, faults } = await opened(browser, folder, name, { viewport: { width: 1400, height: 800 }, deviceScaleFactor: 1, colorScheme: "light", ...options });
  await use(page, words => faults.push(words));
  all.push(...faults.map(words => `${name}: ${words}`));
  await context.close();
}

/** Contrasts that are too small, of colours of text against what they stand on. */
const faint = page => page.evaluate(least => {
  const style = getComputedStyle(document.documentElement);
  const light = name => {
    const hex = style.getPropertyValue(name).trim();
    const part = k => { const c = parseInt(hex.slice(1 + 2 * k, 3 + 2 * k), 16) / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
    return 0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2);
  };
  const pairs = [["--ink", "--paper"], ["--link", "--paper"], ["--link", "--side"], ["--soft", "--paper"], ["--soft", "--side"], ["--ink", "--mark"]];
  for (const of of ["--ink", "--key", "--type", "--number", "--text", "--comment"]) pairs.push([of, "--code"]);
  const contrast = ([a, b]) => { const [dark, bright] = [light(a), light(b)].sort((x, y) => x - y); return (bright + 0.05) / (dark + 0.05); };
  return pairs.filter(pair => !(contrast(pair) >= least)).map(pair => pair.join(" on ") + ": " + contrast(pair).toFixed(2));
}, CONTRAST);

await on("index.html", {}, async (page, fault) => {
  if (!(await page.locator(".card img").count() > 20)) fault("few robots have a picture");
  const loaded = await page.locator(".card img").first().evaluate(image => (image.loading = "eager", image.decode().then(() => image.naturalWidth)));
  if (!(loaded > 100)) fault("a picture is not there");
  await page.keyboard.press("/");
  await page.keyboard.type("friction cone");
  const rows = page.locator("#found li");
  if (!(await rows.count() > 0)) fault("nothing is found");
  const marked = (await page.locator("#found mark").allTextContents()).map(words => words.toLowerCase());
  if (!["friction", "cone"].every(word => marked.includes(word))) fault("what is found is not marked: " + marked);
  if (!(await rows.first().locator("span").textContent()).trim()) fault("no words around what is found");
  await page.keyboard.press("Escape");
  if (await rows.count()) fault("what was found stays");
  await page.keyboard.type("std.nothing of that kind");
  if (await rows.count()) fault("found is what is nowhere");
  await page.locator("#search").fill("E0612");
  await page.keyboard.press("Enter");
  await page.waitForURL(/manual-errors\.html#e0612/).catch(() => fault("the first that is found is at " + page.url()));
  const top = await page.evaluate(() => document.querySelector(":target")?.getBoundingClientRect().top);
  if (!(top >= -2 && top < 200)) fault("the place that was found is not seen: " + top);
});

await on("manual-language.html", {}, async (page, fault) => {
  if (!(await page.locator("pre .k").count() > 10) || !(await page.locator("pre .c").count() > 5)) fault("programs have no colours");
  const link = page.locator("aside li a").nth(3);
  const [to, words] = [await link.getAttribute("href"), await link.textContent()];
  await link.click();
  const heading = await page.locator(":target").textContent();
  if (heading !== words) fault(`${to} leads to ${heading}`);
  if ((await faint(page)).length) fault("faint in the light: " + await faint(page));
  await page.locator("#theme").click();
  if ((await faint(page)).length) fault("faint in the dark: " + await faint(page));
  const dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await page.reload();
  if (await page.evaluate(() => getComputedStyle(document.body).backgroundColor) !== dark) fault("dark does not last");
  await page.locator("#theme").click();
  if (await page.evaluate(() => getComputedStyle(document.body).backgroundColor) === dark) fault("it stays dark");
});

await on("std-smores.html", { viewport: { width: 390, height: 780 }, colorScheme: "dark" }, async (page, fault) => {
  if (await page.evaluate(() => document.documentElement.dataset.theme) !== "dark") fault("it does not follow the system");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > 390) fault(`a phone has to scroll sideways: ${wide}`);
  const top = await page.locator("h1").evaluate(title => title.getBoundingClientRect().top);
  if (top > 400) fault("lists stand before the text: " + top);
});

await browser.close();
console.log(JSON.stringify(all));
