//! The formatter: the library and the examples are in its style, and it changes how a program looks,
//! never what it means.

use crate::desk::cli::Sandbox;
use crate::support::generated::{Dice, program};
use modl::format::format;
use modl::source::FileId;
use modl::syntax::{TokenKind, skeleton};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Generated programs that are formatted.
const GENERATED: u64 = 10_000;

fn formatted(text: &str) -> String {
    format(FileId(0), text).expect("the meaning stays").text
}

/// All programs below a folder of the repository, by name.
fn programs(folder: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the folder can be read") {
            let path = entry.expect("the folder can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "mod") {
                let text = fs::read_to_string(&path).expect("programs are UTF-8");
                found.insert(path.to_string_lossy().into_owned(), text);
            }
        }
    }
    assert!(!found.is_empty());
    found
}

#[test]
fn the_library_and_the_examples_are_in_style() {
    let mut all = programs("stdlib");
    all.extend(programs("examples"));
    all.extend(programs("src"));
    let page = include_str!("../../docs/style.md");
    let listing = page.split("```modl check\n").nth(1).and_then(|rest| rest.split("```").next());
    all.insert("docs/style.md".to_owned(), listing.expect("the page shows a program").to_owned());
    let other: Vec<&String> =
        all.iter().filter(|(_, text)| formatted(text) != **text).map(|(n, _)| n).collect();
    assert!(other.is_empty(), "`modl fmt` would change {other:?}");
}

/// The cases of the suites, each a program of its own.
fn cases() -> Vec<String> {
    let texts = programs("tests").into_values();
    let bodies = |text: String| -> Vec<String> {
        let cases = format!("\n{text}");
        // The first line of each names the case.
        let cases = cases.split("\n--- ").skip(1).filter_map(|case| case.split_once('\n'));
        cases.map(|(_, body)| format!("{body}\n")).collect()
    };
    texts.flat_map(bodies).collect()
}

#[test]
fn whatever_can_be_read_keeps_its_meaning_and_stays_as_it_is_then() {
    let mut sound = 0;
    for case in cases() {
        let once = formatted(&case);
        assert_eq!(once, formatted(&once), "the second time is another:\n{case}");
        if let Some(meaning) = skeleton(&case) {
            sound += 1;
            assert!(Some(meaning) == skeleton(&once), "another program:\n{case}");
        }
    }
    assert!(sound > 100, "only {sound} cases can be read");
}

/// The same program with other spaces, indentation and blank lines.
fn respaced(text: &str, dice: &mut Dice) -> String {
    let mut out = String::new();
    // Nothing is changed within texts and comments, and nothing at the margin becomes so or ceases to.
    let tokens = modl::syntax::Outline::of(text).expect("short").tokens;
    let mut at = 0;
    for token in tokens {
        let gap = &text[at..token.start];
        let first = at == 0 || text.as_bytes()[at - 1] == b'\n';
        if gap.is_empty() && !first {
        } else if first && token.kind == TokenKind::LineComment {
            out.push_str(gap);
        } else {
            let least = usize::from(!first);
            out.push_str(&" ".repeat(least + dice.below(4)));
        }
        out.push_str(&text[token.start..token.end]);
        // A second blank line is one too many.
        if token.kind == TokenKind::LineBreak && out.ends_with("\n\n") && dice.below(2) == 0 {
            out.push('\n');
        }
        at = token.end;
    }
    out
}

#[test]
fn how_a_program_was_spaced_does_not_matter() {
    let mut dice = Dice::new(5);
    let mut all = programs("stdlib");
    all.extend(programs("examples"));
    for (name, text) in &all {
        for _ in 0..4 {
            let other = respaced(text, &mut dice);
            assert_eq!(formatted(&other), *text, "{name}");
        }
    }
}

/// The text with a comment at some of the places where white space stands, or at one of them.
fn commented(text: &str, dice: &mut Dice, one_in: usize) -> String {
    let tokens = modl::syntax::Outline::of(text).expect("short").tokens;
    let mut out = String::new();
    let mut at = 0;
    for token in tokens {
        let gap = &text[at..token.start];
        out.push_str(gap);
        let (here, line) = (dice.below(one_in) == 0, token.kind == TokenKind::LineBreak);
        match dice.below(3) {
            _ if !here => {}
            0 if line => out.push_str(" // why"),
            1 if line => out.push_str("\n// alone"),
            // Beside `/` it would be another comment.
            _ if line => out.push_str(" /* so */"),
            _ if !gap.is_empty() => out.push_str("/* so */ "),
            _ => {}
        }
        out.push_str(&text[token.start..token.end]);
        at = token.end;
    }
    out
}

#[test]
fn ten_thousand_programs_with_comments_anywhere_keep_their_meaning() {
    for seed in 0..GENERATED {
        let mut dice = Dice::new(seed);
        // Programs that mean something, and those that have every form of the grammar.
        let plain =
            if seed % 2 == 0 { program(&mut dice) } else { crate::language::forms::program(&mut dice) };
        let text = commented(&plain, &mut dice, 1 + (seed % 40) as usize);
        let once = formatted(&text);
        assert_eq!(once, formatted(&once), "the second time is another:\n{text}");
        assert!(skeleton(&plain) == skeleton(&once), "another program:\n{text}");
        let comments = |text: &str| text.matches("/* so */").count() + text.matches("//").count();
        assert_eq!(comments(&text), comments(&once), "a comment is lost:\n{text}");
    }
}

#[test]
fn what_cannot_be_read_stays_as_it_is() {
    let text = "let a   =  1\nlet b = (1 +\n  2 ]]\nlet c   =  3\n";
    let found = format(FileId(0), text).expect("no meaning to change");
    assert!(found.text.starts_with("let a = 1\n"), "{}", found.text);
    assert!(found.text.contains("let b = (1 +\n  2 ]]\n"), "{}", found.text);
    assert!(!found.diagnostics.is_empty());
}

/// By hand: what each rule of the style does.
#[test]
fn the_style_is_as_the_documentation_says() {
    let text = "\
use std.smores.{ Smores ,Walk4 }


config  C( a:Angle=30deg ,n :Int= 2){
part m[ n ]:Smores   part x : Smores
    connect m[0] .top--x.bottom   turn 90deg

  behavior b=Sc( move(m[0].tilt,to:- a),
wait( 2s ) ,
  ) // the end
  behavior long = Pc(m) // another
}
let y = [x^2
 for x in 0 .. 4] ++[ - -1 ]
let z=2m ^ 2 / 3s
test \"t\" {   expect not(true)   }
";
    let wanted = "\
use std.smores.{Smores, Walk4}

config C(a: Angle = 30deg, n: Int = 2) {
  part m[n]: Smores  part x: Smores
  connect m[0].top -- x.bottom turn 90deg

  behavior b = Sc(move(m[0].tilt, to: -a),
    wait(2s),
  )                      // the end
  behavior long = Pc(m)  // another
}
let y = [x^2
  for x in 0..4] ++ [- -1]
let z = 2m ^ 2 / 3s
test \"t\" { expect not (true) }
";
    assert_eq!(formatted(text), wanted);
}

/// Short records stand on one line, long ones have a line for each field.
#[test]
fn records_keep_their_lines() {
    let text = "\
record  S{a:Int,b:Int=3}
/// Long.
record Long {

    /// The first.
  a :Int
 b: Length=3m ,   c: List<Long>=[ ],

    d: fn(Int)->Angle
}
let d = S( a:1 )with{b:4}
let e = Long(a: 1,
b: 2m) with {
a: 2
  b: 3m,
 }.a
";
    let wanted = "\
record S { a: Int, b: Int = 3 }
/// Long.
record Long {
  /// The first.
  a: Int
  b: Length = 3m, c: List<Long> = [],

  d: fn(Int) -> Angle
}
let d = S(a: 1) with { b: 4 }
let e = Long(a: 1,
  b: 2m) with {
    a: 2
    b: 3m,
  }.a
";
    assert_eq!(formatted(text), wanted);
}

#[test]
fn files_are_formatted_in_place_or_only_looked_at() {
    let sandbox =
        Sandbox::new(&[("a.mod", b"let a  = 1\n"), ("b/c.mod", b"let a = 1\n"), ("d.mod", b"let a = (\n")]);
    let looked = sandbox.run(&["fmt", "--check", "a.mod", "b"]);
    assert_eq!((looked.code, looked.out.as_str()), (1, "a.mod:1\n"));
    let wrote = sandbox.run(&["fmt", "a.mod", "b"]);
    assert_eq!((wrote.code, wrote.err.as_str()), (0, "formatted a.mod\n"));
    assert_eq!(fs::read_to_string(sandbox.path("a.mod")).expect("it is there"), "let a = 1\n");
    assert_eq!(sandbox.run(&["fmt", "--check", "a.mod", "b"]).code, 0);
    let faulty = sandbox.run(&["fmt", "d.mod"]);
    assert!(faulty.code == 1 && faulty.err.contains("E0004"), "{}", faulty.err);
    assert_eq!(fs::read_to_string(sandbox.path("d.mod")).expect("it is there"), "let a = (\n");
    assert_eq!(sandbox.run(&["fmt", "missing.mod"]).code, 2);
}
