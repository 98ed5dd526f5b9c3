// Takes a picture of a page at a time.
//   node picture.mjs PLAYWRIGHT CHROMIUM PAGE PICTURE TIME [KEYS]

import { createRequire } from "node:module";
import { resolve } from "node:path";

const [, , playwright, executablePath, file, picture, time, keys = ""] = process.argv;
const { chromium } = createRequire(import.meta.url)(resolve(playwright));
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-background-networking", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 1200, height: 720 }, reducedMotion: "reduce" });
await page.goto("file://" + resolve(file) + "#t=" + time);
for (const key of keys) await page.keyboard.press(key);
await page.waitForTimeout(300);
// A picture at rest gets better for a while.
await page.evaluate(() => window.modl.redraw());
await page.waitForFunction(() => !window.modl.state.more, null, { timeout: 120000 });
await page.screenshot({ path: picture });
await browser.close();
