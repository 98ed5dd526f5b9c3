// Tokenises programs with the TextMate grammar as VS Code does. Prints a line `NAME FROM TO CLASS` for each token with a colour,
// in bytes; the classes are those of the language server.
//   node textmate.mjs MODULES GRAMMAR FOLDER
// MODULES: the folder node_modules that has vscode-textmate and vscode-oniguruma.

import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [, , modules, grammarFile, folder] = process.argv;
const require = createRequire(join(resolve(modules), "x.js"));
const { Registry, INITIAL, parseRawGrammar } = require("vscode-textmate");
const onig = require("vscode-oniguruma");

const CLASSES = [["comment", /^comment/], ["string", /^string/], ["number", /^constant\.numeric/], ["type", /^entity\.name\.type/], ["keyword", /^keyword\.(control|declaration|other|operator\.word)|^constant\.language/]];

/** The class of a token: by the innermost scope that has one. What is inside a hole of a text is a part of the text. */
function classOf(scopes) {
  if (scopes.some(scope => scope.startsWith("comment"))) return "comment";
  if (scopes.some(scope => scope.startsWith("string"))) return "string";
  for (const scope of [...scopes].reverse()) for (const [name, pattern] of CLASSES) if (pattern.test(scope)) return name;
  return null;
}

const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
await onig.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
const onigLib = Promise.resolve({ createOnigScanner: list => new onig.OnigScanner(list), createOnigString: text => new onig.OnigString(text) });
const registry = new Registry({ onigLib, loadGrammar: async () => parseRawGrammar(readFileSync(grammarFile, "utf8"), grammarFile) });
const grammar = await registry.loadGrammar("source.modl");

const out = [];
for (const name of readdirSync(folder).filter(name => name.endsWith(".mod")).sort()) {
  let [state, start] = [INITIAL, 0];
  let last = null;
  for (const line of readFileSync(join(folder, name), "utf8").split("\n")) {
    const found = grammar.tokenizeLine(line, state);
    state = found.ruleStack;
    for (const { startIndex, endIndex, scopes } of found.tokens) {
      const kind = classOf(scopes);
      const [from, to] = [startIndex, Math.min(endIndex, line.length)].map(i => start + Buffer.byteLength(line.slice(0, i)));
      if (!kind || from === to) continue;
      // Pieces of one text or comment on a line are one.
      if (last && last.kind === kind && last.to === from && (kind === "string" || kind === "comment")) last.to = to;
      else out.push((last = { name, from, to, kind }));
    }
    last = null;
    start += Buffer.byteLength(line) + 1;
  }
}
process.stdout.write(out.map(({ name, from, to, kind }) => `${name} ${from} ${to} ${kind}\n`).join(""));
