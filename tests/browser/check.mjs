// Opens pages in headless Chromium and uses them as a person would. Reads a list of pages as JSON from
// standard input, prints what it found as JSON: {pages: [{name, faults, figures}]}.
//   node check.mjs PLAYWRIGHT CHROMIUM FOLDER

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const [, , playwright, executablePath, folder] = process.argv;
const { chromium } = createRequire(import.meta.url)(playwright);
const wanted = JSON.parse(readFileSync(0, "utf8"));
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** A software renderer on a busy machine takes its time. */
const PATIENCE = { timeout: 20000 };

/** Farther than this from where the judge has it, m, and a link is in the wrong place. */
const PLACE = 2e-3;

async function opened(browser, name, options) {
  const context = await browser.newContext({ viewport: { width: 800, height: 480 }, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on("console", message => faults.push("console: " + message.text()));
  page.on("pageerror", error => faults.push("error: " + error.message));
  page.on("dialog", dialog => { faults.push("a dialog: " + dialog.message()); dialog.dismiss(); });
  page.on("request", request => request.url().startsWith("file:") || faults.push("asks for " + request.url()));
  await page.goto("file://" + join(folder, name));
  return { context, page, faults };
}

/** What the canvas shows at a time: a number that tells pictures apart, and how many colours it has. */
const picture = (page, t) => page.evaluate(t => {
  const { modl } = window;
  modl.seek(t === "end" ? modl.plan.end : t);
  modl.redraw();
  const gl = document.getElementById("view").getContext("webgl2");
  const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint32Array(w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
  let sum = 0;
  for (const pixel of pixels) sum = (Math.imul(sum, 31) + pixel) >>> 0;
  return { sum, colours: new Set(pixels).size };
}, t);

const time = page => page.evaluate(() => window.modl.state.t);

async function uses(page, moves, fault) {
  const end = await page.evaluate(() => window.modl.plan.end);
  if (!moves) return;
  await page.keyboard.press("Home");
  if (await time(page) !== 0) fault("Home does not go to the start");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.modl.state.t > 0, null, PATIENCE).catch(() => fault("it does not play"));
  await page.keyboard.press("End");
  if (Math.abs(await time(page) - end) > 1e-6) fault("End does not go to the end");
  await page.keyboard.press(",");
  const before = await time(page);
  if (!(before < end)) fault("no event before the end");
  await page.keyboard.press("ArrowLeft");
  if (!(await time(page) < before)) fault("the arrow does not go back");
  const track = await page.locator("#track").boundingBox();
  const whole = await page.evaluate(() => window.modl.plan.duration);
  await page.mouse.click(track.x + track.width * (end / whole) * 0.5, track.y + track.height / 2);
  if (Math.abs(await time(page) - end / 2) > end * 0.02) fault("the track does not scrub");
  const flag = page.locator("#flags button").last();
  if (await flag.count()) {
    await flag.dispatchEvent("click");
    const label = parseFloat(await flag.getAttribute("title"));
    if (Math.abs(await time(page) - Math.min(label, end)) > 0.06) fault("a mark leads elsewhere: " + label);
  }
  await page.evaluate(() => (location.hash = "#t=0.1"));
  const wish = Math.min(0.1, end);
  await page.waitForFunction(wish => Math.abs(window.modl.state.t - wish) < 1e-6, wish, PATIENCE).catch(() => fault("the address does not set the time"));
}

async function hovers(page, fault) {
  const found = await page.evaluate(() => {
    const { modl } = window;
    const [view, X] = [document.getElementById("view"), modl.places(modl.state.t)];
    for (let i = 0; i < X.length; i += 16) {
      const at = modl.onScreen([X[i], X[i + 1], X[i + 2]]);
      const [x, y] = at ? [at[0] / view.clientWidth, at[1] / view.clientHeight] : [-1, -1];
      if (x > 0.1 && x < 0.9 && y > 0.2 && y < 0.9 && modl.pick(x, y) >= 0) return [x, y];
    }
    return null;
  });
  if (!found) return fault("nothing is under the mouse anywhere");
  const box = await page.locator("#view").boundingBox();
  await page.mouse.move(box.x + found[0] * box.width, box.y + found[1] * box.height);
  const words = await page.waitForFunction(() => !document.getElementById("tip").hidden && document.querySelector("#tip b").textContent, null, PATIENCE).catch(() => null);
  if (!words) fault("no name under the mouse");
}

/** Link positions against those of the judge: [time, [body, x, y, z], ...]. */
async function places(page, poses, fault) {
  for (const [t, ...bodies] of poses) {
    const found = await page.evaluate(t => window.modl.places(t), t);
    for (const [body, ...p] of bodies) {
      const off = Math.hypot(...p.map((x, k) => x - found[16 * body + k]));
      if (!(off < PLACE)) return fault(`at ${t} s body ${body} is ${off} m from where the judge has it`);
    }
  }
}

async function checked(browser, { name, moves, poses, title, measured }) {
  const { context, page, faults } = await opened(browser, name, { reducedMotion: "reduce" });
  const fault = words => faults.push(words);
  await page.waitForTimeout(100);
  const [start, end] = [await picture(page, 0), await picture(page, "end")];
  if (start.colours < 50) fault(`a blank picture of ${start.colours} colours`);
  if (moves && start.sum === end.sum) fault("nothing moves");
  await hovers(page, fault);
  await uses(page, moves, fault);
  await places(page, poses || [], fault);
  const shown = await page.locator("h1").textContent();
  if (title && shown !== title) fault("the title is " + shown);
  if (await page.locator("img").count() > 1) fault("a picture came from a name");
  const frames = measured && await page.evaluate(() => {
    const times = [[], []];
    const gl = document.getElementById("view").getContext("webgl2");
    for (let i = 0; i < 5; i++) {
      window.modl.seek((window.modl.plan.end * i) / 5);
      const start = performance.now();
      window.modl.redraw();
      times[0].push(window.modl.stats.frame);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      times[1].push(performance.now() - start);
    }
    return times.map(list => list.sort((a, b) => a - b)[2]);
  });
  const stats = await page.evaluate(() => window.modl.stats);
  await context.close();
  const figures = { calls: stats.calls, first_ms: Math.round(stats.first) };
  // The script's part of a frame, and the whole with a software renderer.
  if (measured) [figures.script_ms, figures.frame_ms] = frames.map(time => Number(time.toFixed(1)));
  return { name, faults, figures };
}

/** A phone: everything is in reach. */
async function phone(browser, name) {
  const { context, page, faults } = await opened(browser, name, { viewport: { width: 390, height: 780 }, hasTouch: true, colorScheme: "dark" });
  const reach = await page.evaluate(() => {
    const bar = document.getElementById("bar");
    return { wide: document.documentElement.scrollWidth, bar: bar.scrollWidth - bar.clientWidth };
  });
  if (reach.wide > 390 || reach.bar > 0) faults.push("wider than a phone: " + JSON.stringify(reach));
  await page.locator("#sheet").tap();
  if (!(await page.locator("#panel").isVisible())) faults.push("the panel does not open");
  await context.close();
  return { name: name + " on a phone", faults };
}

async function still(name) {
  const browser = await chromium.launch({ executablePath, args: [...quiet, "--disable-3d-apis"] });
  const { page, faults } = await opened(browser, name, {});
  if (!(await page.locator("#still").isVisible())) faults.push("no still picture");
  if (!(await page.locator("#panel").isVisible())) faults.push("no panel");
  await browser.close();
  return { name: name + " without WebGL", faults };
}

const browser = await chromium.launch({ executablePath, args: [...quiet, ...drawing] });
const pages = [];
for (const one of wanted) pages.push(await checked(browser, one));
pages.push(await phone(browser, wanted[0].name));
await browser.close();
pages.push(await still(wanted[0].name));
console.log(JSON.stringify({ pages }));
