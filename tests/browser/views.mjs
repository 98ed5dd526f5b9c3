// What is shown, and how: colours, ghosts, toggles, names, curves, source, the plan's data.

import { PATIENCE, picture, time } from "./opening.mjs";

/** Looks at the first body from nearer; says from where it was looked before. */
const nearer = page => page.evaluate(() => {
  const { camera, places, state } = window.modl;
  const { target, distance } = camera.goal;
  Object.assign(camera.goal, { target: places(state.t).slice(0, 3), distance: distance / 8 });
  return { target, distance };
});

/** Every switch changes the picture, and back. */
export async function toggles(page, wanted, fault) {
  const { end } = await page.evaluate(() => window.modl.plan);
  await picture(page, end * 0.4);
  const names = await page.locator("[data-toggle]").evaluateAll(boxes => boxes.map(box => box.dataset.toggle));
  for (const name of wanted) if (!names.includes(name)) fault(`there is no switch for ${name}: ${names}`);
  // What lies under the robot or has not moved yet can't be seen to change.
  const seen = names.filter(name => !["follow", "trail", "start", "goal"].includes(name) || wanted.includes(name));
  for (const name of seen) {
    // Edges of what is small on the screen fade.
    const look = name === "edges" && await nearer(page);
    // Each switch ends where it began, or is complained of.
    const before = await picture(page);
    const flip = () => page.locator(`[data-toggle="${name}"]`).evaluate(box => box.click());
    await flip();
    if ((await picture(page)).sum === before.sum) fault(`the switch for ${name} changes nothing`);
    await flip();
    if ((await picture(page)).sum !== before.sum) fault(`the switch for ${name} does not go back`);
    if (look) await page.evaluate(look => Object.assign(window.modl.camera.goal, look), look);
  }
  const key = { grid: "i", target: "a", mass: "m", contacts: "k", goal: "g", start: "s", collides: "j", nominal: "n", forces: "k", paths: "r" };
  for (const name of wanted.filter(name => key[name])) {
    const on = () => page.locator(`[data-toggle="${name}"]`).isChecked();
    const before = await on();
    await page.keyboard.press(key[name]);
    if (await on() === before) fault(`the key ${key[name]} does not switch ${name}`);
    await page.keyboard.press(key[name]);
  }
}

/** Ways to colour, each with its legend, which names what stands around; what is measured changes with time. */
export async function colours(page, wanted, fault) {
  const around = await page.evaluate(() => [...(window.modl.plan.body.around || []), ...(window.modl.plan.body.obstacles || [])].length);
  const names = await page.locator("[data-colour]").evaluateAll(list => list.map(one => one.dataset.colour));
  if (names.join() !== wanted.join()) fault(`it is coloured by ${names}`);
  const looks = [];
  for (const [i, name] of names.entries()) {
    await page.keyboard.press(String(i + 1));
    if (await page.locator(`[data-colour="${name}"]`).getAttribute("aria-pressed") !== "true") fault(`the key ${i + 1} does not choose ${name}`);
    looks.push((await picture(page)).sum);
    const named = await page.locator("#legend").innerText();
    if (named.includes("obstacles") !== around > 0) fault(`with ${around} obstacles the legend of ${name} says ${named}`);
  }
  if (names.includes("load") && looks[names.indexOf("load")] === looks[0]) fault("loads look like parts");
  await page.keyboard.press("1");
}

export async function hovers(page, joints, fault) {
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
  const at = [box.x + found[0] * box.width, box.y + found[1] * box.height];
  await page.mouse.move(...at);
  const shown = () => !document.getElementById("tip").hidden && document.querySelector("#tip b").textContent;
  const words = await page.waitForFunction(shown, null, PATIENCE).catch(() => null);
  if (!words) return fault("no name under the mouse");
  const facts = await page.locator("#tip dl").textContent();
  if (joints && !/-?\d+(\.\d+)?(°| mm)/.test(facts)) fault("no joints under the mouse: " + facts);
  return at;
}

/** Curves under the cursor of the player; a click in them is a time, a click on a module chooses its joints. */
export async function curves(page, wanted, fault) {
  const canvas = page.locator("#curves canvas");
  await page.keyboard.press("c");
  if (!(await canvas.isVisible())) return fault("no curves");
  const drawn = () => canvas.evaluate(canvas => canvas.toDataURL());
  const label = () => canvas.getAttribute("aria-label");
  for (const name of wanted) if (!(await label()).includes(name)) fault(`no curve of ${name}: ${await label()}`);
  const box = await canvas.boundingBox();
  const { end, duration } = await page.evaluate(() => window.modl.plan);
  const before = (await picture(page, 0), await drawn());
  // Numbers stand to the left of the plots, which have the scale of the line of time.
  const track = await page.locator("#track").boundingBox();
  await page.mouse.click(track.x + track.width * 0.5 * (end / duration), box.y + box.height / 2);
  if (Math.abs(await time(page) - end / 2) > end * 0.02) fault("a click in the curves is no time");
  await picture(page);
  if (await drawn() === before) fault("the curves have no cursor");
  await page.keyboard.press("c");
  const at = await hovers(page, true, fault);
  if (!at) return;
  await page.mouse.click(...at);
  await page.keyboard.press("c");
  if (!(await label()).includes("joints of ")) fault("a click on a module does not choose its joints: " + await label());
  await page.keyboard.press("c");
}

/** The lines that command the motion, at times: [time, [file:line, ...]]. */
export async function source(page, lit, fault) {
  await page.locator("#tabs button", { hasText: "Source" }).click();
  for (const [t, lines] of lit) {
    await picture(page, t);
    const found = await page.locator(".source li.lit").evaluateAll(rows => rows.map(row => row.closest("ol").previousSibling.textContent + ":" + row.dataset.line));
    if (found.sort().join() !== [...lines].sort().join()) fault(`at ${t} s lit are ${found} and not ${lines}`);
  }
  const row = page.locator(".source li.can").last();
  const begins = parseFloat((await row.getAttribute("title")).replace(/[^0-9.]*/, ""));
  await row.click();
  if (Math.abs(await time(page) - begins) > 0.06) fault("a click on a line leads elsewhere");
}

export async function data(page, wanted, fault) {
  await page.locator("#tabs button", { hasText: "Plan" }).click();
  const told = await page.locator("#pages .data:visible").last().textContent();
  for (const words of wanted) if (!told.includes(words)) fault(`the plan's data does not say ${words}: ${told}`);
}

/** What failed is marked, where it failed, at the end of what is played. */
export async function failure(page, wanted, fault) {
  await picture(page, "end");
  const why = await page.locator("#why").textContent();
  if (!why.includes(wanted.says)) fault("why it fails is told as: " + why);
  if (!(await page.locator("#callout").isVisible())) fault("nothing is pointed at");
  const red = await page.evaluate(modules => {
    const { modl } = window;
    const gl = document.getElementById("view").getContext("webgl2");
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    modl.redraw();
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let red = 0;
    for (let i = 0; i < pixels.length; i += 4) red += pixels[i] > 120 && pixels[i + 1] < 0.55 * pixels[i] && pixels[i + 2] < 0.35 * pixels[i];
    const failed = modl.plan.verdict.failures[0].modules.map(m => modl.plan.body.modules[m][0]).sort().join();
    return { red, failed };
  });
  if (red.failed !== [...wanted.modules].sort().join()) fault("marked are " + red.failed);
  if (!(red.red > 75)) fault("what failed is not red: " + red.red);
  if (!wanted.met) return;
  const off = await page.evaluate(() => {
    const { modl } = window;
    const [at, box] = [modl.onScreen(modl.plan.verdict.failures[0].point), document.getElementById("callout")];
    return Math.abs(at[0] - parseFloat(box.style.left));
  });
  if (!(off < 2)) fault(`what is pointed at is ${off} pixels from where they meet`);
}

/** The sides of the cube, the distance between two points, and a figure for print. */
export async function sides(page, fault) {
  const look = () => page.evaluate(() => [window.modl.camera.goal.yaw, window.modl.camera.goal.pitch]);
  for (const [name, yaw] of [["front", 0], ["left", Math.PI / 2], ["back", Math.PI], ["right", -Math.PI / 2]]) {
    await page.locator("#cube button", { hasText: name }).dispatchEvent("click");
    const [found, pitch] = await look();
    const off = Math.abs(Math.atan2(Math.sin(found - yaw), Math.cos(found - yaw)));
    if (off > 1e-6 || Math.abs(pitch) > 0.2) fault(`the ${name} is looked at from ${found}, ${pitch}`);
  }
  await page.locator("#cube button", { hasText: "top" }).dispatchEvent("click");
  if ((await look())[1] < 1.4) fault("the top is not looked at from above");
  await page.keyboard.press("h");
  await measures(page, fault);
  // What was just turned is drawn coarsely for a moment.
  await page.waitForFunction(() => window.modl.coarseness() === 0);
  const before = await picture(page);
  await page.keyboard.press("b");
  const white = await page.evaluate(() => {
    const gl = document.getElementById("view").getContext("webgl2");
    window.modl.redraw();
    const pixel = new Uint8Array(4);
    gl.readPixels(0, gl.drawingBufferHeight - 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return pixel.join();
  });
  if (white !== "255,255,255,255") fault("a figure is not on white: " + white);
  if (await page.locator("#head").isVisible()) fault("words stand over a figure");
  await page.keyboard.press("b");
  if ((await picture(page)).sum !== before.sum) fault("a figure does not go back");
}

/** A distance that is measured is the one between the points of the bodies that are clicked. */
async function measures(page, fault) {
  await page.keyboard.press("x");
  const size = await page.evaluate(() => {
    const { modl } = window;
    modl.redraw();
    const [X, view] = [modl.places(modl.state.t), document.getElementById("view")];
    const rect = view.getBoundingClientRect();
    const hits = [];
    for (let i = 0; i < X.length; i += 16) {
      const at = modl.onScreen([X[i], X[i + 1], X[i + 2]]);
      if (!at || modl.pick(at[0] / view.clientWidth, at[1] / view.clientHeight) < 0) continue;
      hits.push(at);
    }
    for (const [x, y] of [hits[0], hits[hits.length - 1]]) modl.measure.click(x / rect.width, y / rect.height);
    modl.redraw();
    const [a, b] = modl.measure.points;
    const seen = [a, b].map(modl.onScreen);
    const off = Math.max(...seen.map((p, i) => Math.hypot(p[0] - [hits[0], hits[hits.length - 1]][i][0], p[1] - [hits[0], hits[hits.length - 1]][i][1])));
    return { length: Math.hypot(...a.map((c, k) => c - b[k])), off, words: document.getElementById("measured").textContent };
  });
  if (!(size.off < 1)) fault(`a point that is clicked is ${size.off} pixels from the one that is measured`);
  const told = parseFloat(size.words) * (/^[^(]* mm/.test(size.words) ? 1e-3 : 1);
  if (Math.abs(told - size.length) > 6e-4) fault(`a distance of ${size.length} m is told as ${size.words}`);
  await page.keyboard.press("Escape");
  if (await page.locator("#measured").isVisible()) fault("a distance stays");
}
