// The extension of modl: the language server with its pages, and commands that run and verify the program or show its robot.

const { execFile } = require("node:child_process");
const { mkdtempSync, readFileSync, rmSync } = require("node:fs");
const { tmpdir } = require("node:os");
const { basename, dirname, join } = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

/** The line with which the command tells the page that it wrote. */
const WROTE = /^wrote (.*\.html)$/m;

let client = null;
/** Tells of programs that change on disk. */
let programs = null;
/** The panels that show robots, by program. */
const panels = new Map();

const setting = name => vscode.workspace.getConfiguration("modl").get(name);

async function start() {
  const root = setting("root");
  const server = { command: setting("path"), args: root ? ["lsp", "--root", root] : ["lsp"] };
  client = new LanguageClient("modl", "modl", server, {
    documentSelector: [{ language: "modl", scheme: "file" }],
    synchronize: { fileEvents: programs },
  });
  await client.start();
}

/** A page that the server has, such as that of an error's code. */
async function page(uri) {
  const answer = await client?.sendRequest("workspace/textDocumentContent", { uri: uri.toString() });
  return answer?.text ?? "";
}

async function restart() {
  if (client) await client.stop().catch(() => {});
  await start();
}

/** The program that is edited, saved; null where there is none. */
async function program(place) {
  // Lenses name it by a text.
  const uri = typeof place === "string" ? vscode.Uri.parse(place) : place;
  const document = uri ? await vscode.workspace.openTextDocument(uri) : vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "modl") return null;
  if (document.isDirty) await document.save();
  return document.uri.fsPath;
}

/** Runs a command on the program in a terminal, where its messages have colours and links. */
async function inTerminal(command, uri) {
  const file = await program(uri);
  if (!file) return;
  const name = "modl";
  const terminal = vscode.window.terminals.find(one => one.name === name && !one.exitStatus)
    || vscode.window.createTerminal({ name, cwd: dirname(file) });
  terminal.show(true);
  const quoted = text => (process.platform === "win32" ? `"${text}"` : `'${text.replaceAll("'", "'\\''")}'`);
  terminal.sendText(`${quoted(setting("path"))} ${command} ${quoted(file)}`);
}

/** Draws the page of a program into a folder that is removed again; the page, or what kept it from being drawn. */
function drawn(file) {
  const folder = mkdtempSync(join(tmpdir(), "modl-"));
  return new Promise(resolve => {
    execFile(setting("path"), ["show", file, "--out", folder], { cwd: dirname(file), maxBuffer: 1 << 26 }, (error, out, said) => {
      const written = WROTE.exec(said) || WROTE.exec(out);
      let page = null;
      try {
        if (written) page = readFileSync(join(folder, basename(written[1])), "utf8");
      } catch { /* what was said is shown */ }
      rmSync(folder, { recursive: true, force: true });
      resolve({ page, said: said || out || String(error || "nothing was drawn") });
    });
  });
}

async function draw(panel, file) {
  const { page, said } = await drawn(file);
  if (!panels.has(file)) return;
  const escaped = said.replace(/[&<>]/g, c => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);
  // A panel has margins of its own, which the page does not want.
  panel.webview.html = page?.replace("</head>", "<style>body { padding: 0 }</style>\n</head>") || `<!doctype html><meta charset="utf-8"><title>modl</title><pre>${escaped}</pre>`;
}

/** Shows the robot of the program beside it; it is drawn again whenever the program is saved. */
async function show(uri) {
  const file = await program(uri);
  if (!file) return;
  const open = panels.get(file);
  if (open) {
    open.reveal(undefined, true);
    return draw(open, file);
  }
  const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
  const panel = vscode.window.createWebviewPanel("modl.page", basename(file), place, { enableScripts: true, retainContextWhenHidden: true });
  panels.set(file, panel);
  panel.onDidDispose(() => panels.delete(file));
  await vscode.window.withProgress({ location: vscode.ProgressLocation.Window, title: "modl draws " + basename(file) }, () => draw(panel, file));
}

exports.activate = async context => {
  const command = (name, action) => context.subscriptions.push(vscode.commands.registerCommand("modl." + name, action));
  command("show", show);
  command("run", uri => inTerminal("run", uri));
  command("test", uri => inTerminal("test", uri));
  // The server verifies: it says beside the text what it has found.
  command("verifyProgram", uri => {
    const document = uri ?? vscode.window.activeTextEditor?.document.uri;
    return document && vscode.commands.executeCommand("modl.verify", document.toString());
  });
  command("restart", restart);
  programs = vscode.workspace.createFileSystemWatcher("**/*.mod");
  context.subscriptions.push(
    programs,
    vscode.workspace.registerTextDocumentContentProvider("modl", { provideTextDocumentContent: page }),
    vscode.workspace.onDidSaveTextDocument(({ uri }) => {
      const panel = panels.get(uri.fsPath);
      if (panel) draw(panel, uri.fsPath);
    }),
    vscode.workspace.onDidChangeConfiguration(change => change.affectsConfiguration("modl") && restart()),
  );
  await start().catch(error => vscode.window.showErrorMessage(`modl can't be started: ${error.message}. Is it installed, and does the setting modl.path lead to it?`));
};

exports.deactivate = () => client?.stop();
