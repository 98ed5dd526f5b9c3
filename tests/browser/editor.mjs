// The extension of VS Code, driven in headless Chromium with code-server as a person would use it. Prints what it found as JSON:
// {faults, figures}, and takes screenshots into a folder.
//   node editor.mjs PLAYWRIGHT CHROMIUM CODE_SERVER MODL VSIX PICTURES

import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [, , playwright, executablePath, codeServer, modl, extension, pictures] = process.argv;
const { chromium } = createRequire(import.meta.url)(playwright);
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
/** The time for what the editor does by itself, ms: on a busy machine it starts slowly. */
const PATIENCE = 40_000;

/** The faults after which nothing more is tried. */
const FAULTS_MAX = 4;

const PROGRAM = `use std.smores.Chain3

/// A chain that lifts its middle.
config Worm(gap: Angle = 10deg) {
  part c: Chain3
  /// Goes up in the middle.
  behavior lift(a: Angle = 20deg) = c.half_wave(a)
  /// Rolls itself up, and tips over.
  behavior curl = Pc([move(x.tilt, to: 90deg) for x in c.m])
}

let worm = Worm()
let reach = 3 * 40mm
emit(worm.lift(), "worm.plan.json")
`;

const faults = [];
const figures = {};
const home = mkdtempSync(join(tmpdir(), "modl-editor-"));
const [data, extensions, project] = ["data", "extensions", "project"].map(name => join(home, name));
const file = join(project, "main.mod");
mkdirSync(join(data, "User"), { recursive: true });
mkdirSync(project);
mkdirSync(pictures, { recursive: true });
writeFileSync(file, PROGRAM);
writeFileSync(join(data, "User", "settings.json"), JSON.stringify({
  "modl.path": modl,
  "workbench.startupEditor": "none",
  "workbench.colorTheme": "Default Light Modern",
  "security.workspace.trust.enabled": false,
  "telemetry.telemetryLevel": "off",
  "extensions.autoUpdate": false,
  "extensions.ignoreRecommendations": true,
  "editor.minimap.enabled": false,
  "editor.fontFamily": "DejaVu Sans Mono",
  "editor.cursorBlinking": "solid",
}));

const wanted = (what, is) => is || faults.push(what);
const text = () => readFileSync(file, "utf8");
const port = await new Promise(resolve => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});
const common = ["--user-data-dir", data, "--extensions-dir", extensions, "--config", join(home, "config.yaml")];
writeFileSync(join(home, "config.yaml"), "auth: none\ncert: false\n");
const entry = join(codeServer, "out/node/entry.js");
execFileSync(process.execPath, [entry, ...common, "--install-extension", extension], { stdio: "ignore" });
const server = spawn(process.execPath, [entry, ...common, "--bind-addr", `127.0.0.1:${port}`, "--auth", "none", "--disable-telemetry", "--disable-update-check", project], { stdio: ["ignore", "pipe", "pipe"], detached: true });
await new Promise((resolve, reject) => {
  server.stdout.on("data", words => /HTTP server listening/.test(words) && resolve());
  server.on("exit", code => reject(new Error(`code-server ended with ${code}`)));
});

const browser = await chromium.launch({ executablePath, args: [...quiet, ...drawing] });
const page = await (await browser.newContext({ viewport: { width: 1360, height: 820 }, reducedMotion: "reduce" })).newPage();
const until = (what, wanted, argument) => page.waitForFunction(wanted, argument, { timeout: PATIENCE, polling: 50 }).then(() => true, () => (faults.push("never: " + what), false));
const shot = name => page.screenshot({ path: join(pictures, name + ".png") });
const press = keys => page.keyboard.press(keys);
/** Waits until a place that a selector finds has these words; the editor writes its blanks as ones that do not break. */
const seen = (what, selector, words) => until(`${what}: ${words}`, ([selector, words]) => [...document.querySelectorAll(selector)].some(found => found.textContent.replaceAll("\u00a0", " ").includes(words)), [selector, words]);

/** Runs a command of the palette. */
async function run(title) {
  await press("F1");
  await page.locator(".quick-input-widget input").first().fill(">" + title);
  await seen("the command", ".quick-input-list .monaco-list-row", title.replace(/^.*: /, ""));
  await press("Enter");
}

/** Puts the cursor behind the nth occurrence of a text in a line that has words. */
async function goTo(line, behind) {
  const lines = text().split("\n");
  const row = lines.findIndex(words => words.includes(line));
  if (row < 0) return faults.push(`no line has ${line}`);
  await press("Control+g");
  await page.locator(".quick-input-widget input").first().fill(`:${row + 1}:${lines[row].indexOf(behind) + behind.length + 1}`);
  await press("Enter");
}

/** Saves, and returns the text once it has these words. */
async function saved(words) {
  const begin = Date.now();
  while (!text().includes(words) && Date.now() - begin < PATIENCE / 4) {
    await press("Control+s");
    await page.waitForTimeout(200);
  }
  wanted(`the file has no ${words}: ${text()}`, text().includes(words));
}

async function part(name, body) {
  const begin = Date.now();
  try {
    await body();
  } catch (error) {
    faults.push(`${name}: ${String(error.message).split("\n")[0]}`);
  }
  figures[name] = Date.now() - begin;
  await shot(name).catch(() => {});
  if (faults.length > FAULTS_MAX) throw new Error("the rest is not tried");
}

try {
  await page.goto(`http://127.0.0.1:${port}/?folder=${project}`);
  await until("the editor", () => document.querySelector(".monaco-workbench"));

  await part("opened", async () => {
    // Searching for files needs a program that is not installed.
    await page.locator(".explorer-folders-view .monaco-list-row", { hasText: "main.mod" }).dblclick();
    if (!(await seen("the program", ".view-line", "config Worm"))) throw new Error("the program is not open");
    // Lenses, hints and colours of the server.
    await seen("a lens", ".codelens-decoration", "Show the robot");
    await seen("a lens", ".codelens-decoration", "Verify and write");
    await seen("a hint", ".view-line", "= 120mm");
    await seen("a hint", ".view-line", "reach: Length");
    await seen("a default", ".view-line", "Worm(gap: 10deg)");
    const colours = await page.locator(".view-line", { hasText: /behavior.lift/ }).locator("span span").evaluateAll(spans => new Set(spans.map(span => getComputedStyle(span).color)).size);
    wanted(`the program has ${colours} colours`, colours >= 3);
    wanted("the sound program has errors", (await page.locator(".squiggly-error").count()) === 0);
  });

  await part("verified", async () => {
    await page.locator(".codelens-decoration a", { hasText: /^Verify$/ }).first().click();
    await seen("a verdict", ".codelens-decoration", "✓ verified under full dynamics, least margin");
    await page.locator(".codelens-decoration a", { hasText: /^Verify$/ }).first().click();
    await seen("a verdict", ".codelens-decoration", "✗ not verified");
    await until("the failure", () => document.querySelector(".squiggly-error"));
  });

  await part("diagnostics", async () => {
    await goTo("let reach", "40mm");
    const begin = Date.now();
    await page.keyboard.type(" + 1s");
    await until("an error", () => [...document.querySelectorAll(".squiggly-error")].length > 0);
    figures.keyToSquiggle = Date.now() - begin;
    await press("Control+Shift+m");
    await seen("the problem", ".markers-panel .monaco-list-row", "E0201");
    await page.locator(".markers-panel a", { hasText: "E0201" }).first().waitFor();
  });

  await part("explained", async () => {
    await page.locator(".markers-panel a", { hasText: "E0201" }).first().click();
    await seen("the page of the code", ".view-line", "# E0201");
  });

  await part("mended", async () => {
    await page.locator('.tab[data-resource-name="main.mod"]').click();
    // Keys would go to the page of the code until the program is back.
    await seen("the program", ".view-line", "let reach");
    await goTo("let reach", "40mm");
    await press("Shift+End");
    await press("Delete");
    await press("Control+Shift+m");
    await until("no error", () => document.querySelectorAll(".squiggly-error").length === 0);
    await saved("let reach = 3 * 40mm\n");
  });

  await part("completion", async () => {
    await goTo("emit(", ")");
    await press("End");
    await press("Enter");
    await page.keyboard.type("let more = worm.");
    await seen("a candidate", ".suggest-widget.visible .monaco-list-row", "lift");
    await seen("a candidate", ".suggest-widget.visible .monaco-list-row", "curl");
  });

  await part("signature", async () => {
    await page.keyboard.type("lift");
    await press("Escape");
    await page.keyboard.type("(");
    await seen("the parameters", ".parameter-hints-widget.visible", "a: Angle");
    await press("Escape");
    await page.keyboard.type("5deg");
    await saved("let more = worm.lift(5deg)");
  });

  await part("hover", async () => {
    await goTo("let worm = ", "Wor");
    await run("Show or Focus Hover");
    await seen("the explanation", ".monaco-hover", "A chain that lifts its middle.");
    await seen("the signature", ".monaco-hover", "config Worm(gap: Angle = 10deg)");
  });

  await part("rename", async () => {
    await press("Escape");
    await goTo("let worm", "let wor");
    await press("F2");
    const box = page.locator(".rename-box input").first();
    await box.waitFor({ timeout: PATIENCE / 4 });
    await box.fill("snake");
    await press("Enter");
    await seen("the new name", ".view-line", "snake.lift()");
    await saved("let snake = Worm()");
    await saved("emit(snake.lift()");
    await saved("let more = snake.lift(5deg)");
  });

  await part("formatted", async () => {
    await goTo("let reach", "let");
    await page.keyboard.type("   ");
    await seen("blanks", ".view-line", "let    reach");
    await run("Format Document");
    await seen("the layout", ".view-line", "let reach: Length = 3");
    await saved("let reach = 3 * 40mm\n");
  });

  await part("mend", async () => {
    await goTo("part c", "Chain3");
    await press("Backspace");
    await page.keyboard.type("4");
    await until("an error", () => document.querySelectorAll(".squiggly-error").length > 0);
    await press("Control+.");
    await seen("the mend", ".action-widget", "Write `Chain3` for `Chain4`");
    await shot("mend_offered");
    await press("Enter");
    await saved("part c: Chain3\n");
  });

  await part("symbols", async () => {
    await press("Control+t");
    await page.locator(".quick-input-widget input").first().fill("#lift");
    await seen("the symbol", ".quick-input-list .monaco-list-row", "lift");
    await shot("symbols_found");
    await press("Escape");
  });

  await part("run", async () => {
    await run("modl: Run the Program");
    await until("a terminal", () => document.querySelector(".terminal-wrapper .xterm"));
    const begin = Date.now();
    while (!existsSync(join(project, "out/worm.plan.json")) && Date.now() - begin < PATIENCE) await page.waitForTimeout(200);
    wanted("the program wrote no plan", existsSync(join(project, "out/worm.plan.json")));
    await page.waitForTimeout(500);
  });

  await part("verified_program", async () => {
    await goTo("emit(", ")");
    await run("modl: Verify the Plans of the Program");
    await seen("the verdict of the plan", ".codelens-decoration", "Verify and write | ✓ verified under full dynamics, least margin");
  });

  await part("show", async () => {
    await goTo("part c", "Chain3");
    await run("modl: Show the Robot beside the Program");
    // The page is in a frame within frames, and plays there as it does alone.
    const begin = Date.now();
    const drawn = () => !!window.modl?.plan?.end && document.querySelector("canvas")?.clientWidth > 100;
    let robot = null;
    while (!robot && Date.now() - begin < PATIENCE) {
      for (const frame of page.frames()) if (await frame.evaluate(drawn).catch(() => false)) robot = frame;
      await page.waitForTimeout(200);
    }
    if (!robot) throw new Error("the page is not drawn in the panel");
    await robot.evaluate(() => window.modl.seek(window.modl.plan.end / 2));
    await page.mouse.move(600, 480);
    await page.waitForTimeout(1000);
    const wide = await robot.evaluate(() => document.querySelector("canvas").clientWidth / innerWidth);
    wanted(`the picture leaves a margin: ${wide}`, wide > 0.97);
  });
} catch (error) {
  faults.push(String(error.message).split("\n")[0]);
} finally {
  await browser.close();
  process.kill(-server.pid);
  rmSync(home, { recursive: true, force: true, maxRetries: 5 });
}
console.log(JSON.stringify({ faults, figures }));
process.exit(faults.length ? 1 : 0);
