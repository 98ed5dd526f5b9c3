// Pages opened and looked at: what every check begins with.

import { join } from "node:path";

/** A software renderer on a busy machine takes its time. */
export const PATIENCE = { timeout: 20000 };

/** Pixels of the picture to one of the page: drawn in software, half as many each way take a quarter of the time. */
const DENSITY = 0.5;

/** A page with what it complains of: messages, errors, dialogs, and requests for anything else. */
export async function opened(browser, folder, name, options) {
  const context = await browser.newContext({ viewport: { width: 800, height: 480 }, deviceScaleFactor: DENSITY, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on("console", message => faults.push("console: " + message.text()));
  page.on("pageerror", error => faults.push("error: " + error.message));
  page.on("dialog", dialog => { faults.push("a dialog: " + dialog.message()); dialog.dismiss(); });
  page.on("request", request => request.url().startsWith("file:") || request.url().startsWith("data:") || faults.push("asks for " + request.url()));
  await page.goto("file://" + join(folder, name));
  return { context, page, faults };
}

/** What the canvas shows at a time, or now: a number that tells pictures apart, and how many colours it has. */
export const picture = (page, t) => page.evaluate(t => {
  const { modl } = window;
  if (t !== null) modl.seek(t === "end" ? modl.plan.end : t);
  modl.redraw();
  const gl = document.getElementById("view").getContext("webgl2");
  const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint32Array(w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
  let sum = 0;
  for (const pixel of pixels) sum = (Math.imul(sum, 31) + pixel) >>> 0;
  return { sum, colours: new Set(pixels).size };
}, t ?? null);

export const time = page => page.evaluate(() => window.modl.state.t);

/** Bodies that are out of the picture at some time, as [time, body]; the first few. */
export const lost = page => page.evaluate(() => {
  const { modl } = window;
  const canvas = document.getElementById("view");
  const found = [];
  for (let i = 0; i <= 5; i++) {
    const t = (modl.plan.end * i) / 5;
    modl.seek(t);
    modl.redraw();
    modl.redraw();
    const X = modl.places(t);
    for (let b = 0; 16 * b < X.length; b++) {
      const at = modl.onScreen([X[16 * b], X[16 * b + 1], X[16 * b + 2]]);
      const inside = at && at[0] > 0 && at[0] < canvas.clientWidth && at[1] > 0 && at[1] < canvas.clientHeight;
      if (!inside && found.length < 3) found.push([t, b]);
    }
  }
  return found;
});
