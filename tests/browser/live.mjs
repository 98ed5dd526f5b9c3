// Opens the page of a program that is typed, in headless Chromium, and uses it as a person would. Prints what it found as
// JSON: {faults, figures}.
//   node live.mjs PLAYWRIGHT CHROMIUM ADDRESS FILE

import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { PATIENCE } from "./opening.mjs";

const [, , playwright, executablePath, address, file] = process.argv;
const { chromium } = createRequire(import.meta.url)(playwright);
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

const faults = [];
const figures = {};
const text = () => readFileSync(file, "utf8");
const first = text();

const browser = await chromium.launch({ executablePath, args: [...quiet, ...drawing] });
const page = await (await browser.newContext({ viewport: { width: 1000, height: 620 }, deviceScaleFactor: 0.5, reducedMotion: "reduce" })).newPage();
// The driver may complain that picking takes time.
page.on("console", message => /GL Driver Message \(OpenGL, Performance/.test(message.text()) || faults.push("console: " + message.text()));
page.on("pageerror", error => faults.push("error: " + error.message));
page.on("request", request => request.url().startsWith(address) || faults.push("asks for " + request.url()));

const until = (what, wanted, argument) => page.waitForFunction(wanted, argument, PATIENCE).catch(() => faults.push("never: " + what));
const lit = () => page.evaluate(() => [...document.querySelectorAll("#text li.lit:not(.callee)")].map(row => Number(row.dataset.line)));
const camera = () => page.evaluate(() => JSON.stringify(window.modl.picture.camera.goal));
const wanted = (what, is) => is || faults.push(what);
const lineOf = words => 1 + text().split("\n").findIndex(line => line.includes(words));
const inPage = at => page.evaluate(at => { const { left, top } = document.getElementById("view").getBoundingClientRect(); return [left + at[0], top + at[1]]; }, at);
const version = () => page.evaluate(() => window.modl.wire.version);
const later = v => until("a newer text after " + v, v => window.modl.wire.version > v, v);

/** A place of the canvas where a module, or a joint's link of it, is seen, once the picture is one in full. */
const seen = (module, joint) => until("a picture at rest", () => performance.now() - window.modl.picture.state.moved > 500 && !window.modl.picture.state.dirty).then(() => page.evaluate(([module, joint]) => {
  const { picture, page: { robot } } = window.modl;
  const { clientWidth: w, clientHeight: h } = document.getElementById("view");
  const index = robot.modules.findIndex(known => known.name === module);
  const places = [];
  for (let y = 6; y < h; y += 9) for (let x = 6; x < w; x += 9) {
    if (picture.moduleAt([x, y]) !== index) continue;
    if (joint && picture.jointAt(picture.bodyAt([x, y])) !== joint) continue;
    if (picture.dots().some(({ at }) => Math.hypot(at[0] - x, at[1] - y) < 16)) continue;
    places.push([x, y]);
  }
  return places[Math.floor(places.length / 2)] || null;
}, [module, joint || null]));

await page.goto(address);
await until("a picture", () => window.modl && window.modl.picture.stats.frames > 0);

// A click on a module marks its line, a click on a line its modules.
await page.mouse.click(...(await inPage(await seen("body"))));
wanted("the line of `body` is not marked: " + (await lit()), String(await lit()) === String(lineOf("part body")));
await page.click(`#text li[data-line="${lineOf("part right")}"]`);
const chosen = await page.evaluate(() => window.modl.page.chosen);
wanted("a line selects " + chosen, String(chosen) === "right.hip,right.foot");
await page.keyboard.press("Escape");

// What is typed is seen; the camera stays.
await page.mouse.move(...(await inPage([30, 300])));
await page.mouse.down();
await page.mouse.move(...(await inPage([130, 330])), { steps: 4 });
await page.mouse.up();
const before = await camera();
const times = [];
for (const angle of [25, 30, 35, 40, 45]) {
  const v = await version();
  await page.evaluate(() => {
    const shown = window.modl.picture.stats.shown;
    window.seenAt = new Promise(resolve => {
      const look = () => (window.modl.picture.stats.shown > shown ? resolve(performance.timeOrigin + performance.now()) : setTimeout(look, 2));
      look();
    });
  });
  const written = performance.timeOrigin + performance.now();
  writeFileSync(file, first.replace("Leg(20deg)", `Leg(${angle}deg)`));
  times.push((await page.evaluate(() => window.seenAt)) - written);
  await later(v);
}
figures.seen = Math.round(times.sort((a, b) => a - b)[2]);
wanted("the camera moved when something was typed", (await camera()) === before);

// A mistake is told about, and the picture stays.
let v = await version();
writeFileSync(file, first.replace("part body: Smores", "part body: Smoores"));
await later(v);
await until("a finding", () => document.querySelector("#findings .error"));
wanted("the wrong line is not marked", await page.evaluate(line => document.querySelector(`#text li[data-line="${line}"]`).classList.contains("wrong"), lineOf("part body")));
wanted("there is no word of the old picture", /before the error/.test(await page.textContent("#why")));
v = await version();
writeFileSync(file, first);
await later(v);
await until("no finding", () => document.getElementById("findings").hidden);
wanted("the camera moved at a mistake", (await camera()) === before);
const start = text();
const texts = [start];

/** Waits until the file is another one, and remembers it. */
async function changed(what) {
  const last = texts[texts.length - 1];
  for (let i = 0; i < 400 && text() === last; i++) await page.waitForTimeout(25);
  if (text() === last) return faults.push("the text stays: " + what);
  texts.push(text());
  await until("the page shows " + what, text => window.modl.page.state && window.modl.page.state.text === text, text());
}

// A slider writes a default.
await page.focus('[data-key=".lift"] input[type="range"]');
await page.keyboard.press("ArrowRight");
await changed("a slider");
wanted("the default is not written", text() === start.replace("lift: Angle = -5deg", "lift: Angle = -4deg"));
await page.focus('[data-key="step.time"] input[type="range"]');
await page.keyboard.press("ArrowRight");
await changed("a slider of a behaviour");
wanted("the default of a behaviour is not written", /time: Time = 1\.5[0-9]+s/.test(text()));

// A joint that is dragged writes its `set`.
await page.keyboard.press("Escape");
await page.click(`#text li[data-line="${lineOf("part left")}"]`);
const grip = await seen("left.foot", "left.foot.tilt");
if (!grip) faults.push("no link of left.foot.tilt is seen");
else {
  await page.mouse.move(...(await inPage(grip)));
  await page.mouse.down();
  // Some direction turns it by more than five degrees.
  const turned = () => page.evaluate(() => {
    const { value, index } = window.modl.page.robot.joints.find(j => j.name === "left.foot.tilt");
    return Math.abs(window.modl.picture.value(index) - value) > 0.09;
  });
  for (const [x, y] of [[40, 0], [40, 40], [0, 60], [-50, 0], [0, -60]]) {
    await page.mouse.move(...(await inPage([grip[0] + x, grip[1] + y])), { steps: 5 });
    if (await turned()) break;
  }
  wanted("no value is shown at a joint", await page.isVisible("#value"));
  await page.mouse.up();
  await changed("a joint");
  const set = /set left\.foot\.tilt = (-?[0-9]+)deg/.exec(text());
  wanted("the joint is not set in whole degrees", set && set[1] !== "12");
  wanted("the selection is lost when a joint is let go", String(await page.evaluate(() => window.modl.page.chosen)) === "left.hip,left.foot");
  const shown = await page.evaluate(() => window.modl.page.robot.joints.find(j => j.name === "left.foot.tilt").value);
  wanted("the picture has another angle than the text", set && Math.abs((shown * 180) / Math.PI - Number(set[1])) < 1e-6);
}

// A free port offers what mates, and docks it.
await page.keyboard.press("Escape");
await page.mouse.click(...(await inPage(await seen("body"))));
await until("a dot", () => window.modl.picture.dots().length > 0);
const [port] = await page.evaluate(() => window.modl.picture.dots());
await page.mouse.click(...(await inPage(port.at)));
await page.click('#menu [data-offer="Smores.bottom"]', PATIENCE).catch(() => faults.push("no offer at a port"));
await changed("a port");
wanted("nothing is docked", text().includes(`connect ${port.name} -- smores1.bottom`) && text().includes("part smores1: Smores"));
wanted("the new module is not seen", await page.evaluate(() => window.modl.page.robot.modules.some(module => module.name === "smores1")));

// All is undone, to the byte.
for (const wish of texts.slice(0, -1).reverse()) {
  const v = await version();
  await page.keyboard.press("Control+z");
  await later(v);
  wanted("undone to another text", text() === wish);
}
wanted("there is still something to undo", await page.isDisabled("#undo"));

// What a loop sets is refused, in words.
v = await version();
writeFileSync(file, start.replace("  set body.tilt = lift\n", "  for i in 0..1 { set body.tilt = lift }\n"));
await later(v);
await until("the loop", () => window.modl.page.robot.joints.some(joint => joint.fixed));
await page.click(`#text li[data-line="${lineOf("part body")}"]`);
wanted("a loop has a slider", /in a loop/.test(await page.textContent("#controls")));
v = await version();
writeFileSync(file, first);
await later(v);

// A page of another origin gets nothing.
const other = await (await browser.newContext()).newPage();
await other.goto("data:text/html,<title>another</title>");
figures.foreign = await other.evaluate(async address => {
  const asked = ["", "state?since=0&robot="].map(path => fetch(address + path).then(answer => answer.text()).catch(() => "refused"));
  const frame = document.body.appendChild(document.createElement("iframe"));
  frame.src = address;
  await new Promise(resolve => setTimeout(resolve, 500));
  let inside = "refused";
  try { inside = frame.contentDocument ? frame.contentDocument.title : "refused"; } catch { /* as it should be */ }
  return [...(await Promise.all(asked)), inside];
}, address);
wanted("another origin gets " + figures.foreign, figures.foreign.every(found => found === "refused" || found === ""));

await browser.close();
process.stdout.write(JSON.stringify({ faults, figures }));
