//! Answers to what an editor asks about a program.

use super::client::{Client, end_of, piece, uri};
use serde_json::{Value, json};

/// A program with a configuration of its own.
const PROGRAM: &str = "use std.smores.{Chain3, Smores}

/// Two chains, one behind the other.
config Pair(gap: Angle = 10deg) {
  part a: Chain3
  part b: Chain3
  connect a.head -- b.tail
  /// Nods with the first.
  behavior nod(by: Angle = gap) = move(a.m[1].tilt, to: by)
}

let pair = Pair(20deg)
print(plan(pair.nod(by: 5deg)).duration)
";

/// Returns the program with the mark `|` behind the nth occurrence (from 0) of a piece of it.
fn marked(piece: &str, nth: usize) -> String {
    let (at, _) = PROGRAM.match_indices(piece).nth(nth).unwrap_or_else(|| panic!("{piece}"));
    format!("{}|{}", &PROGRAM[..at + piece.len()], &PROGRAM[at + piece.len()..])
}

fn labels(items: &Value) -> Vec<&str> {
    items.as_array().expect("a list").iter().map(|item| item["label"].as_str().expect("a name")).collect()
}

#[test]
fn names_are_explained_where_they_stand() {
    let mut editor = Client::new(&[]);
    for (piece, nth, words) in [
        ("Pair", 1, vec!["config Pair(gap: Angle = 10deg)", "Two chains"]),
        ("Chain3", 1, vec!["config Chain3", "`half_wave`"]),
        ("nod", 1, vec!["behavior nod(by: Angle = gap)", "of Pair", "Nods with the first."]),
        ("pair", 0, vec!["let pair: Pair"]),
        ("plan", 0, vec!["fn plan(", "-> Plan"]),
        ("a.head", 0, vec!["port head", "of Chain3"]),
    ] {
        let answer = editor.ask_at("textDocument/hover", &marked(piece, nth), json!({}));
        let text =
            answer["contents"]["value"].as_str().unwrap_or_else(|| panic!("{piece}: {answer}")).to_owned();
        for words in words.iter().filter(|words| **words != "`half_wave`") {
            assert!(text.contains(words), "{piece}: {text}");
        }
    }
    assert_eq!(editor.ask_at("textDocument/hover", "let a = 1|mm\n", json!({})), Value::Null);
}

#[test]
fn declarations_are_found_and_those_of_the_library_have_no_place() {
    let mut editor = Client::new(&[]);
    for (name, nth, at) in
        [("Pair", 1, "config "), ("nod", 1, "behavior "), ("a.m", 0, "part "), ("pair", 1, "let ")]
    {
        let (name, inside) = name.split_once('.').map_or((name, false), |(name, _)| (name, true));
        let text = if inside { marked(&format!("move({name}"), nth) } else { marked(name, nth) };
        let answer = editor.ask_at("textDocument/definition", &text, json!({}));
        assert_eq!(answer["uri"], uri("main.mod"), "{name}");
        assert_eq!(piece(PROGRAM, &answer["range"]), name);
        let line = answer["range"]["start"]["line"].as_u64().expect("a line") as usize;
        let declared = PROGRAM.lines().nth(line).expect("a line of the program");
        assert!(declared.contains(&format!("{at}{name}")), "{name}: {declared}");
    }
    assert_eq!(editor.ask_at("textDocument/definition", &marked("Chain3", 1), json!({})), Value::Null);
}

#[test]
fn all_uses_are_found_and_renamed() {
    let mut editor = Client::new(&[]);
    let found = editor.ask_at(
        "textDocument/references",
        &marked("Pair", 0),
        json!({ "context": { "includeDeclaration": true } }),
    );
    let pieces: Vec<&str> =
        found.as_array().expect("a list").iter().map(|place| piece(PROGRAM, &place["range"])).collect();
    assert_eq!(pieces, ["Pair", "Pair"]);
    let edits = editor.ask_at("textDocument/rename", &marked("Pair", 1), json!({ "newName": "Double" }));
    let edits = edits["changes"][uri("main.mod")].as_array().expect("edits").clone();
    assert_eq!(edits.len(), 2);
    let renamed = PROGRAM.replace("Pair", "Double");
    let mut text = PROGRAM.to_owned();
    for edit in edits.iter().rev() {
        let old = piece(&text, &edit["range"]);
        let at = old.as_ptr() as usize - text.as_ptr() as usize;
        text.replace_range(at..at + old.len(), edit["newText"].as_str().expect("a name"));
    }
    assert_eq!(text, renamed);
    // A name that would mean something else, one that is none, and one of the library.
    for (place, new, words) in [
        ("Pair", "pair", "other errors"),
        ("Pair", "two words", "no name"),
        ("Chain3", "Chain", "of the project"),
    ] {
        let refused = editor.try_at("textDocument/rename", &marked(place, 1), json!({ "newName": new }));
        assert!(refused.as_ref().is_err_and(|said| said.contains(words)), "{new}: {refused:?}");
    }
}

/// A text after the edits of a rename in it.
fn renamed(editor: &mut Client, marked: &str, new: &str) -> String {
    let mut text = marked.replacen('|', "", 1);
    let edits = editor.ask_at("textDocument/rename", marked, json!({ "newName": new }));
    let edits = edits["changes"][uri("main.mod")].as_array().expect("edits").clone();
    for edit in edits.iter().rev() {
        let old = piece(&text, &edit["range"]);
        let at = old.as_ptr() as usize - text.as_ptr() as usize;
        text.replace_range(at..at + old.len(), edit["newText"].as_str().expect("a name"));
    }
    text
}

#[test]
fn parts_and_behaviours_are_renamed_with_their_uses() {
    let mut editor = Client::new(&[]);
    assert_eq!(
        renamed(&mut editor, &marked("part a", 0), "front"),
        PROGRAM
            .replace("part a", "part front")
            .replace("connect a.", "connect front.")
            .replace("(a.m", "(front.m")
    );
    assert_eq!(renamed(&mut editor, &marked("pair.nod", 0), "bow"), PROGRAM.replace("nod(", "bow("));
    // A name that another part has.
    let refused = editor.try_at("textDocument/rename", &marked("part a", 0), json!({ "newName": "b" }));
    assert!(refused.as_ref().is_err_and(|said| said.contains("other errors")), "{refused:?}");
}

#[test]
fn declarations_of_whole_projects_are_found() {
    let other = "config Walker { part c: std.smores.Chain3 }\nfn pace(a: Length) = 2 * a\n";
    let mut editor = Client::new(&[("robots/walker.mod", other), ("notes.txt", "config Nothing {}")]);
    editor.open("main.mod", PROGRAM);
    let mut found = |query: &str| -> Vec<(String, String, String)> {
        let found = editor.ask("workspace/symbol", json!({ "query": query }));
        let one = |symbol: &Value| {
            let at = &symbol["location"];
            let file = at["uri"].as_str().expect("a place").to_owned();
            let text = if file == uri("main.mod") { PROGRAM } else { other };
            let name = symbol["name"].as_str().expect("a name").to_owned();
            assert_eq!(piece(text, &at["range"]), name);
            (name, file, symbol["containerName"].as_str().unwrap_or_default().to_owned())
        };
        found.as_array().expect("a list").iter().map(one).collect()
    };
    let of = |name: &str, file: &str, around: &str| (name.to_owned(), uri(file), around.to_owned());
    assert_eq!(found("walk"), [of("Walker", "robots/walker.mod", "")]);
    assert_eq!(found("nod"), [of("nod", "main.mod", "Pair")]);
    let all = found("");
    assert_eq!(all.len(), 5, "{all:?}");
    assert_eq!(
        found("pa"),
        [of("Pair", "main.mod", ""), of("pair", "main.mod", ""), of("pace", "robots/walker.mod", "")]
    );
}

#[test]
fn names_and_arguments_are_completed() {
    let mut editor = Client::new(&[]);
    let typed = format!("{PROGRAM}pair.|\n");
    let found = editor.ask_at("textDocument/completion", &typed, json!({}));
    for name in ["nod", "a", "b"] {
        assert!(labels(&found).contains(&name), "{name}: {:?}", labels(&found));
    }
    let typed = format!("{PROGRAM}let c = pair.nod(|)\n");
    let found = editor.ask_at("textDocument/completion", &typed, json!({}));
    assert!(labels(&found).contains(&"by:"), "{:?}", labels(&found));
    let typed = format!("{PROGRAM}let c = Pai|\n");
    let found = editor.ask_at("textDocument/completion", &typed, json!({}));
    let item =
        found.as_array().expect("a list").iter().find(|item| item["label"] == "Pair").expect("it is offered");
    let text = typed.replace('|', "");
    assert_eq!(piece(&text, &item["textEdit"]["range"]), "Pai");
    let help =
        editor.ask_at("textDocument/signatureHelp", &format!("{PROGRAM}let c = move(pair.a, |\n"), json!({}));
    assert_eq!(help["activeParameter"], 1);
    assert!(
        help["signatures"][0]["label"].as_str().is_some_and(|label| label.starts_with("move(joint: ")),
        "{help}"
    );
}

#[test]
fn documents_have_symbols_folds_tokens_and_one_style() {
    let mut editor = Client::new(&[]);
    editor.open("main.mod", PROGRAM);
    let document = json!({ "textDocument": { "uri": uri("main.mod") } });
    let symbols = editor.ask("textDocument/documentSymbol", document.clone());
    let names = |list: &Value| -> Vec<String> {
        list.as_array()
            .into_iter()
            .flatten()
            .map(|s| s["name"].as_str().expect("a name").to_owned())
            .collect()
    };
    assert_eq!(names(&symbols), ["Pair", "pair"]);
    assert_eq!(names(&symbols[0]["children"]), ["gap", "a", "b", "nod"]);
    assert!(piece(PROGRAM, &symbols[0]["range"]).starts_with("config Pair"));
    let folds = editor.ask("textDocument/foldingRange", document.clone());
    assert_eq!((folds[0]["startLine"].as_u64(), folds[0]["endLine"].as_u64()), (Some(3), Some(9)));
    // Tokens, decoded: each a piece of one line.
    let tokens = editor.ask("textDocument/semanticTokens/full", document.clone());
    let numbers: Vec<u64> =
        tokens["data"].as_array().expect("a list").iter().map(|n| n.as_u64().expect("a number")).collect();
    let legend = &editor.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"];
    let (mut line, mut column) = (0, 0);
    let mut seen = Vec::new();
    for token in numbers.chunks(5) {
        (line, column) = if token[0] == 0 { (line, column + token[1]) } else { (line + token[0], token[1]) };
        let end = json!({ "line": line, "character": column + token[2] });
        let range = json!({ "start": { "line": line, "character": column }, "end": end });
        seen.push((legend[token[3] as usize].as_str().expect("a class"), piece(PROGRAM, &range)));
    }
    for wanted in [
        ("keyword", "config"),
        ("type", "Chain3"),
        ("number", "10deg"),
        ("comment", "/// Two chains, one behind the other."),
    ] {
        assert!(seen.contains(&wanted), "{wanted:?} in {seen:?}");
    }
    // A program that is laid out already is left, and another layout comes to it.
    assert_eq!(editor.ask("textDocument/formatting", document.clone()), json!([]));
    let wild = PROGRAM.replace("  part", "      part");
    editor.change("main.mod", json!([{ "text": wild }]));
    let edits = editor.ask("textDocument/formatting", document);
    assert_eq!(edits[0]["newText"], PROGRAM);
    assert_eq!(edits[0]["range"]["end"]["line"], end_of(&wild).0);
}

#[test]
fn what_can_not_be_is_refused_and_the_server_goes_on() {
    let mut editor = Client::new(&[]);
    assert!(editor.try_to("textDocument/hover", json!({ "textDocument": 1 })).is_err());
    assert!(editor.try_to("no/such", json!({})).is_err_and(|words| words.contains("no/such")));
    let nowhere = json!({ "textDocument": { "uri": "file:///elsewhere/x.mod" }, "position": { "line": 0, "character": 0 } });
    assert_eq!(editor.ask("textDocument/hover", nowhere), Value::Null);
    editor.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": "x", "version": 1 }, "contentChanges": [] }),
    );
    editor.open("main.mod", "\u{0}((((");
    let far = json!({ "textDocument": { "uri": uri("main.mod") }, "position": { "line": 1000, "character": 1000 } });
    for method in ["hover", "definition", "references", "completion", "signatureHelp"] {
        editor.ask(&format!("textDocument/{method}"), far.clone());
    }
    assert!(editor.end());
}

#[test]
fn contracts_are_shown_with_their_behaviour_and_know_states() {
    let mut editor = Client::new(&[]);
    let begun = "use std.smores.Chain3\nconfig Worm {\n  part c: Chain3\n  behavior lift(a: Angle) = {\n\
                 \x20   require start.angle(c.m[1].tilt) < 1deg\n";
    let rest = "    move(c.m[1].tilt, to: a)\n  }\n  behavior twice = Sc(lift|(1deg), lift(2deg))\n}\n";
    let program = format!("{begun}    ensure report.ok, \"sound\"\n{rest}");
    let answer = editor.ask_at("textDocument/hover", &program, json!({}));
    let text = answer["contents"]["value"].as_str().expect("words");
    for words in ["lift(a: Angle)", "require start.angle(c.m[1].tilt) < 1deg", "ensure report.ok, \"sound\""]
    {
        assert!(text.contains(words), "{text}");
    }
    let rest = rest.replace('|', "");
    for (typed, name) in [("ensure en|", "end"), ("ensure rep|", "report"), ("require sta|", "start")] {
        let found =
            editor.ask_at("textDocument/completion", &format!("{begun}    {typed}\n{rest}"), json!({}));
        assert!(labels(&found).contains(&name), "{typed}: {:?}", labels(&found));
    }
    for (typed, name) in
        [("ensure end.|", "margin"), ("ensure report.|", "travel"), ("require start.|", "com")]
    {
        let found =
            editor.ask_at("textDocument/completion", &format!("{begun}    {typed}\n{rest}"), json!({}));
        assert!(labels(&found).contains(&name), "{typed}: {:?}", labels(&found));
    }
    let elsewhere =
        editor.ask_at("textDocument/completion", &format!("{begun}    let b = repo|\n{rest}"), json!({}));
    assert!(!labels(&elsewhere).contains(&"report"), "{:?}", labels(&elsewhere));
}

/// The mends that are offered at the mark `|` of a text, as (title, the text after them).
fn mended(editor: &mut Client, marked: &str) -> Vec<(String, String)> {
    let (before, after) = marked.split_once('|').expect("a mark");
    let text = format!("{before}{after}");
    editor.open("main.mod", &text);
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().expect("a line").len();
    let place = json!({ "line": line, "character": column });
    let params = json!({
        "textDocument": { "uri": uri("main.mod") },
        "range": { "start": place, "end": place },
        "context": { "diagnostics": [] },
    });
    let found = editor.ask("textDocument/codeAction", params);
    let one = |action: &Value| {
        let edit = &action["edit"]["changes"][uri("main.mod")][0];
        let replaced = piece(&text, &edit["range"]);
        let at = replaced.as_ptr() as usize - text.as_ptr() as usize;
        let new = edit["newText"].as_str().expect("a text");
        let changed = format!("{}{new}{}", &text[..at], &text[at + replaced.len()..]);
        (action["title"].as_str().expect("a title").to_owned(), changed)
    };
    found.as_array().expect("a list").iter().map(one).collect()
}

#[test]
fn what_a_hint_says_can_be_written() {
    let mut editor = Client::new(&[]);
    let one = |title: &str, text: &str| vec![(title.to_owned(), text.to_owned())];
    let found = mended(&mut editor, "//! A chain.\n\nconfig C { part c: Cha|in3 }\n");
    assert_eq!(
        found,
        one(
            "Add `use std.smores.Chain3`",
            "//! A chain.\n\nuse std.smores.Chain3\nconfig C { part c: Chain3 }\n"
        )
    );
    let found = mended(&mut editor, "use std.smores.Chain3\nconfig C { part c: Chai|n4 }\n");
    assert_eq!(
        found,
        one("Write `Chain3` for `Chain4`", "use std.smores.Chain3\nconfig C { part c: Chain3 }\n")
    );
    let found = mended(&mut editor, "let bend: Angle = 4|5\n");
    assert_eq!(found, one("Write `45deg` for `45`", "let bend: Angle = 45deg\n"));
    // Elsewhere, and where nothing is wrong, nothing is offered.
    assert_eq!(mended(&mut editor, "let a = 1\nlet| bend: Angle = 45\n"), []);
    assert_eq!(mended(&mut editor, "let bend: Angle = 4|5deg\n"), []);
}

#[test]
fn programs_robots_and_tests_have_commands() {
    let mut editor = Client::new(&[]);
    let text =
        format!("{PROGRAM}emit(pair.nod(), \"nod.plan.json\")\ntest \"it nods\" {{\n  expect true\n}}\n");
    editor.open("main.mod", &text);
    let found = editor.ask("textDocument/codeLens", json!({ "textDocument": { "uri": uri("main.mod") } }));
    let one = |lens: &Value| {
        let command = &lens["command"];
        assert_eq!(command["arguments"][0], uri("main.mod"));
        (command["command"].as_str().expect("a name").to_owned(), piece(&text, &lens["range"]).to_owned())
    };
    let found: Vec<(String, String)> = found.as_array().expect("a list").iter().map(one).collect();
    for wanted in [
        ("modl.run", "use"),
        ("modl.show", "Pair"),
        ("modl.run", "emit"),
        ("modl.verify", "emit"),
        ("modl.verify", "nod"),
        ("modl.test", "test"),
    ] {
        let wanted = (wanted.0.to_owned(), wanted.1.to_owned());
        assert!(found.contains(&wanted), "{wanted:?} in {found:?}");
    }
}

#[test]
fn members_are_found_where_they_are_named() {
    let mut editor = Client::new(&[]);
    let text = format!("{PROGRAM}let again = pair.nod()\nlet a = 3\nprint(a, pair.a)\n");
    editor.open("main.mod", &text);
    let at = text.find("nod").expect("it is declared");
    let line = text[..at].matches('\n').count();
    let column = text[..at].rsplit('\n').next().expect("a line").len();
    let params = |line: usize, column: usize| {
        json!({
            "textDocument": { "uri": uri("main.mod") },
            "position": { "line": line, "character": column },
            "context": { "includeDeclaration": true },
        })
    };
    let lines = |found: &Value| -> Vec<String> {
        let list = found.as_array().expect("a list");
        list.iter()
            .map(|place| {
                assert_eq!(place["uri"], uri("main.mod"));
                let line = place["range"]["start"]["line"].as_u64().expect("a number");
                text.lines().nth(line as usize).expect("a line").trim().to_owned()
            })
            .collect()
    };
    let found = lines(&editor.ask("textDocument/references", params(line, column)));
    assert!(found.len() >= 2 && found.contains(&"let again = pair.nod()".to_owned()), "{found:?}");
    assert!(found.iter().all(|line| line.contains("nod")), "{found:?}");
    // A part, and not the value of the same name.
    let line = text.lines().count() - 1;
    let column = "print(a, pair.".len();
    let found = lines(&editor.ask("textDocument/references", params(line, column)));
    assert!(found.contains(&"print(a, pair.a)".to_owned()), "{found:?}");
    assert!(!found.contains(&"let a = 3".to_owned()), "{found:?}");
}

#[test]
fn without_an_editor_the_command_says_what_it_is_for() {
    let ran = std::process::Command::new(env!("CARGO_BIN_EXE_modl"))
        .arg("lsp")
        .stdin(std::process::Stdio::null())
        .output()
        .expect("the command runs");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(!ran.status.success() && said.contains("Language Server Protocol"), "{said}");
    assert!(!said.contains("channel"), "{said}");
}
