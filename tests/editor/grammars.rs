//! The grammars that editors have, against `modl.pest`: on the library, the examples and generated programs. The tree-sitter
//! parser reads them all, and the TextMate grammar colours them as the language server does. Skipped, with a message, where the
//! tools are missing: `MODL_TREE_SITTER` is the tool of `grammar/tree-sitter`, `MODL_TEXTMATE` a folder `node_modules` with
//! vscode-textmate and vscode-oniguruma (`.ci/tools.sh` installs both).

use crate::editor::client::{Client, uri};
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::forms;
use crate::support::properties::whole;
use modl::syntax::RESERVED;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The generated programs, with `MODL_WHOLE=1` five times as many.
fn generated() -> u64 {
    if whole() { 10_000 } else { 2_000 }
}

/// Programs as (name, text): those of the library and the examples, then generated ones.
fn programs(generated: u64) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in ["stdlib", "examples", "tests/acceptance"] {
        for entry in std::fs::read_dir(root.join(folder)).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.extension().is_some_and(|ending| ending == "mod") {
                let name = path.file_name().expect("a file").to_string_lossy().into_owned();
                let text = std::fs::read_to_string(&path).expect("it is text");
                found.push((format!("{}_{name}", folder.replace('/', "_")), text));
            }
        }
    }
    found.sort();
    assert!(found.len() > 50, "{} programs", found.len());
    found.extend(
        (0..generated).map(|seed| (format!("generated_{seed:05}.mod"), forms::program(&mut Dice::new(seed)))),
    );
    found
}

/// A new folder with programs in it.
struct Folder(PathBuf);

impl Folder {
    fn of(name: &str, programs: &[(String, String)]) -> Folder {
        let folder = std::env::temp_dir().join(format!("modl-grammars-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        for (name, text) in programs {
            std::fs::write(folder.join(name), text).expect("a file can be written");
        }
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Returns where a tool is, by the variable that says so; without it tests are skipped, with a message.
fn tool(variable: &str) -> Option<OsString> {
    let found = std::env::var_os(variable);
    if found.is_none() {
        println!("skipped: {variable} is not set (see .ci/tools.sh)");
    }
    found
}

/// Returns what a tool prints.
fn printed(command: &mut Command) -> String {
    let output = command.output().expect("the tool runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("it is text")
}

#[test]
fn tree_sitter_reads_every_program() {
    let Some(tool) = tool("MODL_TREE_SITTER") else { return };
    let mut programs = programs(generated());
    // On one line a bracket behind a value is an index or a call, unless it can be none: that an LR parser does not see.
    programs.retain(|(_, text)| !text.contains("capture 2mm 3deg [") && !text.contains("capture 2mm 3deg ("));
    assert!(programs.len() as u64 > generated() * 9 / 10, "{} programs", programs.len());
    let folder = Folder::of("tree-sitter", &programs);
    let said = printed(Command::new(&tool).arg("parse").arg(&folder.0));
    assert_eq!(said.lines().count(), programs.len());
    let wrong: Vec<&str> = said.lines().filter(|line| !line.ends_with(" ok")).collect();
    let texts: BTreeMap<&str, &str> =
        programs.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let first = wrong.first().map(|line| texts[line.split_once(' ').expect("a name").0]);
    assert!(
        wrong.is_empty(),
        "{} are not read, such as {:?}:\n{}",
        wrong.len(),
        wrong[0],
        first.expect("one")
    );
}

/// A piece of a program: its beginning and end in bytes.
type Piece = (usize, usize);

/// The pieces of each class, by the language server; texts and comments of several lines are cut at their ends.
fn served(editor: &mut Client, text: &str) -> BTreeMap<String, BTreeSet<Piece>> {
    editor.open("main.mod", text);
    let document = json!({ "textDocument": { "uri": uri("main.mod") } });
    let tokens = editor.ask("textDocument/semanticTokens/full", document);
    let legend = editor.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"].clone();
    let numbers =
        tokens["data"].as_array().expect("a list").iter().map(|n| n.as_u64().expect("a number") as usize);
    let starts: Vec<usize> =
        std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
    let byte = |line: usize, column: usize| {
        let rest = &text[starts[line]..];
        let units = rest.char_indices().scan(0, |units, (at, c)| {
            let before = *units;
            *units += c.len_utf16();
            Some((before, at))
        });
        starts[line]
            + units.into_iter().find(|(before, _)| *before >= column).map_or(rest.len(), |(_, at)| at)
    };
    let (mut line, mut column) = (0, 0);
    let mut found: BTreeMap<String, BTreeSet<Piece>> = BTreeMap::new();
    for token in numbers.collect::<Vec<_>>().chunks(5) {
        (line, column) = if token[0] == 0 { (line, column + token[1]) } else { (line + token[0], token[1]) };
        let class = legend[token[3]].as_str().expect("a class").to_owned();
        found.entry(class).or_default().insert((byte(line, column), byte(line, column + token[2])));
    }
    found
}

#[test]
fn the_textmate_grammar_colours_as_the_language_server_does() {
    let Some(modules) = tool("MODL_TEXTMATE") else { return };
    let programs = programs(0);
    let folder = Folder::of("textmate", &programs);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let said = printed(
        Command::new("node")
            .arg(root.join("tests/editor/textmate.mjs"))
            .arg(modules)
            .arg(root.join("grammar/vscode/syntaxes/modl.tmLanguage.json"))
            .arg(&folder.0),
    );
    let mut found: BTreeMap<(&str, &str), BTreeSet<Piece>> = BTreeMap::new();
    for line in said.lines() {
        let [name, from, to, class] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let piece = (from.parse().expect("a number"), to.parse().expect("a number"));
        found.entry((name, class)).or_default().insert(piece);
    }
    let mut editor = Client::new(&[]);
    let mut wrong = Vec::new();
    for (name, text) in &programs {
        for (class, wanted) in served(&mut editor, text) {
            let own = found.get(&(name.as_str(), class.as_str())).cloned().unwrap_or_default();
            // The grammar knows words by what stands around them: it colours those in which clauses go on, too, and not
            // those that begin a line as names of arguments.
            let more = matches!(class.as_str(), "keyword" | "type");
            let reserved = |piece: &&Piece| class != "keyword" || RESERVED.contains(&&text[piece.0..piece.1]);
            let missing = wanted.difference(&own).filter(reserved).map(|piece| ("is not", *piece));
            let beyond = own.difference(&wanted).filter(|_| !more).map(|piece| ("is", *piece));
            for (how, (from, to)) in missing.chain(beyond) {
                wrong.push(format!("{name}: `{}` {how} a {class}", &text[from..to]));
            }
        }
    }
    assert!(wrong.is_empty(), "{} pieces:\n{}", wrong.len(), wrong[..wrong.len().min(30)].join("\n"));
}

#[test]
fn tree_sitter_tells_ensure_from_a_name() {
    let Some(tool) = tool("MODL_TREE_SITTER") else { return };
    // The keyword stands where the first word, number or text of a condition follows.
    let text = "let ensure = 3\nconfig A {\n  behavior b = {\n    ensure a.b, \"x\"\n    ensure (3)\n    ensure - 1\n    \
                ensure and a\n    ensure in_b\n  }\n}\n";
    let folder = Folder::of("ensure", &[("main.mod".into(), text.into())]);
    let said = printed(Command::new(&tool).arg("classes").arg(&folder.0));
    let keywords = said.lines().filter_map(|line| {
        let [_, from, _, class] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let at: usize = from.parse().expect("a number");
        (class == "keyword" && text[at..].starts_with("ensure")).then(|| text[at..].lines().next())
    });
    assert_eq!(keywords.flatten().collect::<Vec<_>>(), ["ensure a.b, \"x\"", "ensure in_b"]);
}
