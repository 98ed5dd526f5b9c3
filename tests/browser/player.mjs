// The player used as a person would: buttons, keys, the line of time, the address.

import { PATIENCE, time } from "./opening.mjs";

const near = (a, b, slack = 1e-6) => Math.abs(a - b) <= slack;

export async function plays(page, fault) {
  const { end, whole, stops } = await page.evaluate(() => ({ end: window.modl.plan.end, whole: window.modl.plan.duration, stops: window.modl.stops }));
  const playing = () => page.evaluate(() => window.modl.state.playing);
  const until = (what, fn, arg) => page.waitForFunction(fn, arg, PATIENCE).catch(() => fault(what));
  const key = name => page.keyboard.press(name);

  await key("Home");
  if (await time(page) !== 0) fault("Home does not go to the start");
  await key("Space");
  await until("it does not play", () => window.modl.state.t > 0);
  await key("Space");
  const paused = await time(page);
  await page.waitForTimeout(80);
  if (await playing() || await time(page) !== paused) fault("it does not pause");
  await page.locator("#play").click();
  if (!(await playing()) && await time(page) < end) fault("the button does not play");
  await key("End");
  if (!near(await time(page), end)) fault("End does not go to the end");

  await key("Home");
  const steps = [[() => key("."), 1], [() => key("Shift+ArrowRight"), 1], [() => page.locator("#after").click(), 1], [() => key(","), -1], [() => key("Shift+ArrowLeft"), -1], [() => page.locator("#before").click(), -1]];
  let stop = 0;
  for (const [act, by] of steps) {
    await act();
    stop = Math.min(Math.max(stop + by, 0), stops.length - 1);
    if (!near(await time(page), stops[stop])) fault(`a step does not lead to event ${stop} at ${stops[stop]} s but to ${await time(page)} s`);
  }
  await key("End");
  await key("ArrowLeft");
  if (!(await time(page) < end)) fault("the arrow does not go back");
  const before = await time(page);
  await key("ArrowRight");
  if (!(await time(page) > before)) fault("the arrow does not go on");

  await scrubs(page, end, whole, fault);
  await hurries(page, fault);

  await page.evaluate(() => window.modl.seek(window.modl.plan.end * 0.99));
  await key("Space");
  await until("it does not stop at the end", () => !window.modl.state.playing && window.modl.state.t === window.modl.plan.end);
  await key("l");
  await page.evaluate(() => window.modl.seek(window.modl.plan.end * 0.99));
  await key("Space");
  await until("it does not begin again", () => window.modl.state.playing && window.modl.state.t < window.modl.plan.end / 2);
  await key("Space");
  await key("l");
  if (await page.locator("#loop").getAttribute("aria-pressed") !== "false") fault("it goes on beginning again");

  await page.evaluate(() => (location.hash = "#t=0.1"));
  await until("the address does not set the time", wish => Math.abs(window.modl.state.t - wish) < 1e-6, Math.min(0.1, end));
  await page.evaluate(t => window.modl.seek(t), end / 2);
  await until("the time does not set the address", wish => Math.abs(parseFloat(location.hash.slice(3)) - wish) < 0.006, end / 2);

  await key("?");
  if (!(await page.locator("#keys kbd").first().isVisible())) fault("the keys are not told");
  await key("Escape");
  if (await page.locator("#keys").isVisible()) fault("the keys stay");
}

/** The line of time, its marks and the findings. */
async function scrubs(page, end, whole, fault) {
  const track = await page.locator("#track").boundingBox();
  const at = part => [track.x + track.width * (end / whole) * part, track.y + track.height / 2];
  await page.mouse.move(...at(0.5));
  await page.mouse.down();
  if (!near(await time(page), end / 2, end * 0.02)) fault("the track does not jump");
  await page.mouse.move(...at(0.25));
  await page.mouse.up();
  if (!near(await time(page), end / 4, end * 0.02)) fault("the track does not scrub");
  const marked = async (what, flags, words) => {
    for (const flag of (await flags.all()).slice(0, 6)) {
      await flag.dispatchEvent("click");
      const label = parseFloat(await words(flag));
      if (!near(await time(page), Math.min(label, end), 0.06)) fault(`${what} leads elsewhere: ${label}`);
    }
  };
  await marked("a mark", page.locator("#flags button"), flag => flag.getAttribute("title"));
  await marked("a finding", page.locator(".finding"), row => row.locator("time").textContent());
}

/** The speed, as it is chosen and as it is. */
async function hurries(page, fault) {
  const rate = () => page.evaluate(async () => {
    const frame = () => new Promise(requestAnimationFrame);
    window.modl.seek(0);
    document.getElementById("play").click();
    // The clock of frames, which is what the page goes by: that of the script runs on while one is drawn.
    const clock = await frame();
    const { t } = window.modl.state;
    for (let i = 0; i < 3; i++) await frame();
    const passed = (await frame()) - clock;
    const { t: now } = window.modl.state;
    // A short plan is over before its speed is known.
    const found = now === window.modl.plan.end ? Infinity : (now - t) / (passed / 1000);
    if (window.modl.state.playing) document.getElementById("play").click();
    return found;
  });
  const chosen = () => page.locator("#speed").inputValue();
  for (let i = 0; i < 9; i++) await page.keyboard.press("ArrowDown");
  if (await chosen() !== "0.05") fault("it does not get slower: " + await chosen());
  const slow = await rate();
  if (!(slow > 0 && slow < 0.07)) fault(`at a twentieth of the speed it goes at ${slow}`);
  for (let i = 0; i < 9; i++) await page.keyboard.press("ArrowUp");
  if (await chosen() !== "16") fault("it does not get faster: " + await chosen());
  const fast = await rate();
  if (!(fast > 0.3)) fault(`at sixteen times the speed it goes at ${fast}`);
  await page.locator("#speed").selectOption("1");
}
