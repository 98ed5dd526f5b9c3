// Opens pages in headless Chromium and uses them as a person would. Reads a list of pages as JSON from
// standard input, prints what it found as JSON: {pages: [{name, faults, figures}]}.
//   node check.mjs PLAYWRIGHT CHROMIUM FOLDER

import { createRequire } from "node:module";
import { readFileSync, readdirSync } from "node:fs";
import { PATIENCE, lost, opened, picture, time } from "./opening.mjs";
import { plays } from "./player.mjs";
import * as views from "./views.mjs";

const [, , playwright, executablePath, folder] = process.argv;
const { chromium } = createRequire(import.meta.url)(playwright);
const wanted = JSON.parse(readFileSync(0, "utf8"));
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Farther than this from where the judge has it, m, and a link is in the wrong place. A page rounds how the
    base is turned, which moves what is far from it by a part of the distance. */
const PLACE = 2e-3;
const PLACE_FAR = 3e-4;
/** More draw calls than this are not made by instancing; a ghost takes as many as what it is the ghost of. */
const CALLS_MAX = 16;
const GHOST_CALLS_MAX = 28;

/** Link positions against those of the judge: [time, [body, x, y, z], ...]. */
async function places(page, poses, fault) {
  for (const [t, ...bodies] of poses) {
    const found = await page.evaluate(t => window.modl.places(t), t);
    const size = Math.hypot(...[0, 1, 2].map(k => Math.max(...bodies.map(b => b[k + 1])) - Math.min(...bodies.map(b => b[k + 1]))));
    for (const [body, ...p] of bodies) {
      const off = Math.hypot(...p.map((x, k) => x - found[16 * body + k]));
      if (!(off < PLACE + PLACE_FAR * size)) return fault(`at ${t} s body ${body} is ${off} m from where the judge has it`);
    }
  }
}

/** The script's part of a frame, and the whole with a software renderer: middle of some frames, ms. */
const measure = page => page.evaluate(() => {
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
  return times.map(list => Number(list.sort((a, b) => a - b)[2].toFixed(1)));
});

/** Frames a second while it plays at 1200 x 720, one pixel for one, once the page has found its pace. It begins again at its
    end without a stop: at rest a picture is drawn in full. */
async function pace(browser, name) {
  const { context, page } = await opened(browser, folder, name, { viewport: { width: 1200, height: 720 }, deviceScaleFactor: 1 });
  const rate = await page.evaluate(async () => {
    const played = async wanted => {
      const start = performance.now();
      let frames = 0;
      while (performance.now() - start < wanted) {
        if (!window.modl.state.playing) document.getElementById("play").click();
        await new Promise(requestAnimationFrame);
        frames++;
      }
      return (1e3 * frames) / (performance.now() - start);
    };
    document.getElementById("loop").click();
    await played(4000);
    return played(5000);
  });
  await context.close();
  return Number(rate.toFixed(1));
}

async function checked(browser, one) {
  const { context, page, faults } = await opened(browser, folder, one.name, { reducedMotion: "reduce" });
  const fault = words => faults.push(words);
  await page.waitForTimeout(100);
  if (await page.evaluate(() => window.modl.state.playing)) fault("it moves though calm was asked for");
  const figures = await page.evaluate(() => ({ calls: window.modl.stats.calls, first_ms: Math.round(window.modl.stats.first) }));
  if (figures.calls > (one.ghost ? GHOST_CALLS_MAX : CALLS_MAX)) fault(`${figures.calls} draw calls`);
  const out = await lost(page);
  if (out.length) fault("out of the picture: " + JSON.stringify(out));
  const [start, end] = [await picture(page, 0), await picture(page, "end")];
  if (start.colours < 50) fault(`a blank picture of ${start.colours} colours`);
  // What comes back to where it was has moved between.
  if (start.sum === end.sum && start.sum === (await picture(page, 0.4 * (await time(page)))).sum) fault("nothing moves");
  await views.hovers(page, one.joints, fault);
  await places(page, one.poses, fault);
  if (one.title && await page.locator("h1").textContent() !== one.title) fault("the title is " + await page.locator("h1").textContent());
  if (await page.locator("img").count() > 1) fault("a picture came from a name");
  await plays(page, fault);
  await views.colours(page, one.colours, fault);
  await views.toggles(page, one.toggles, fault);
  if (one.curves.length) await views.curves(page, one.curves, fault);
  if (one.lit.length) await views.source(page, one.lit, fault);
  await views.data(page, one.data, fault);
  await views.sides(page, fault);
  if (one.failure) await views.failure(page, one.failure, fault);
  if (one.measured) [figures.script_ms, figures.frame_ms] = await measure(page);
  await context.close();
  if (one.measured) figures.frames_a_second = await pace(browser, one.name);
  return { name: one.name, faults, figures };
}

/** A phone, in the dark: it plays by itself, everything is in reach, and a finger turns the robot and scrubs. */
async function phone(browser, name) {
  const { context, page, faults } = await opened(browser, folder, name, { viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true, colorScheme: "dark" });
  const fault = words => faults.push(words);
  await page.waitForFunction(() => window.modl.state.t > 0).catch(() => fault("it does not begin by itself"));
  if (await page.evaluate(() => document.documentElement.dataset.theme) !== "dark") fault("it is not dark");
  const reach = await page.evaluate(() => {
    const bar = document.getElementById("bar");
    return { wide: document.documentElement.scrollWidth, bar: bar.scrollWidth - bar.clientWidth };
  });
  if (reach.wide > 390 || reach.bar > 0) fault("wider than a phone: " + JSON.stringify(reach));
  await page.locator("#play").tap();
  if (await page.evaluate(() => window.modl.state.playing)) fault("a finger does not pause it");
  // The camera follows at once.
  await page.emulateMedia({ reducedMotion: "reduce" });
  const out = await lost(page);
  if (out.length) fault("out of the picture: " + JSON.stringify(out));
  const track = await page.locator("#track").boundingBox();
  await page.touchscreen.tap(track.x + track.width / 2, track.y + track.height / 2);
  const part = await page.evaluate(() => window.modl.state.t / window.modl.plan.duration);
  if (Math.abs(part - 0.5) > 0.02) fault("a finger does not scrub: " + part);
  const yaw = () => page.evaluate(() => window.modl.camera.goal.yaw);
  const before = await yaw();
  const touch = await context.newCDPSession(page);
  const finger = (type, x) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x, y: 300 }] });
  await finger("touchStart", 150);
  await finger("touchMove", 200);
  await finger("touchMove", 240);
  await finger("touchEnd");
  if (await yaw() === before) fault("a finger does not turn it");
  // Two touches close in time are one gesture to a phone.
  await page.waitForTimeout(1500);
  await page.locator("#sheet").tap();
  if (!(await page.locator("#panel").isVisible())) fault("the panel does not open");
  await page.locator("#tabs button", { hasText: "View" }).tap({ timeout: 5000 }).catch(() => fault("the tabs are out of reach"));
  if (!(await page.locator("[data-toggle]").first().isVisible())) fault("the switches are out of reach");
  await context.close();
  return { name: name + " on a phone", faults };
}

/** Light and dark, by wish of the system and by key. */
async function shades(browser, name) {
  const { context, page, faults } = await opened(browser, folder, name, { reducedMotion: "reduce", colorScheme: "light" });
  const shade = () => page.evaluate(() => document.documentElement.dataset.theme + " " + getComputedStyle(document.body).backgroundColor);
  const [light, before] = [await shade(), await picture(page, 0)];
  await page.keyboard.press("d");
  if (!light.startsWith("light") || !(await shade()).startsWith("dark") || await shade() === light) faults.push("no light and dark: " + light + ", " + await shade());
  if ((await picture(page)).sum === before.sum) faults.push("the picture stays light");
  await page.keyboard.press("d");
  await page.emulateMedia({ colorScheme: "dark" });
  const dark = () => document.documentElement.dataset.theme === "dark";
  await page.waitForFunction(dark, null, PATIENCE).catch(() => faults.push("it does not follow the system"));
  await context.close();
  return { name: name + " in light and dark", faults };
}

/** Without WebGL, and without scripts, there is a picture. */
async function still(name, how, options, args) {
  const browser = await chromium.launch({ executablePath, args: [...quiet, ...args] });
  const { page, faults } = await opened(browser, folder, name, options);
  const image = page.locator("#still img");
  if (!(await image.isVisible())) faults.push("no still picture");
  else if (!((await image.boundingBox()).width > 200)) faults.push("the still picture is not drawn");
  if (options.javaScriptEnabled !== false && !(await page.locator("#panel").isVisible())) faults.push("no panel");
  await browser.close();
  return { name: name + " without " + how, faults };
}

/** The scripts of a page are one: of two functions of the same name the first would never be called. */
function twice(scripts) {
  const folder = new URL("../../src/view/page/", import.meta.url);
  const seen = new Map();
  const faults = [];
  for (const file of readdirSync(folder).filter(scripts))
    for (const [, name] of readFileSync(new URL(file, folder), "utf8").matchAll(/^(?:async )?(?:function|const|let|class) (\w+)/gm)) {
      if (seen.has(name)) faults.push(`${name} stands in ${seen.get(name)} and in ${file}`);
      seen.set(name, file);
    }
  return { name: "names of scripts", faults };
}

const browser = await chromium.launch({ executablePath, args: [...quiet, ...drawing] });
const live = name => name.startsWith("live");
const script = name => name.endsWith(".js");
const pages = [twice(name => script(name) && !live(name)), twice(name => script(name) && name !== "main.js")];
for (const one of wanted) pages.push(await checked(browser, one));
for (const one of wanted.filter(one => one.phone)) pages.push(await phone(browser, one.name));
pages.push(await shades(browser, wanted[0].name));
await browser.close();
pages.push(await still(wanted[0].name, "WebGL", {}, ["--disable-3d-apis"]));
pages.push(await still(wanted[0].name, "scripts", { javaScriptEnabled: false }, []));
console.log(JSON.stringify({ pages }));
