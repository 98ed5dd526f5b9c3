//! The parser: what it accepts, which tree it builds, what it says and how it goes on.

use crate::support::suite;
use crate::support::tree::tree;
use modl::source::{Code, FileId, Sources, code};
use modl::syntax::{Parsed, parse};

fn parsed(text: &str) -> Parsed {
    parse(FileId(0), text)
}

fn codes(text: &str) -> Vec<Code> {
    parsed(text).diagnostics.iter().map(|d| d.code).collect()
}

/// The messages of all cases under `tests/suite/syntax/`, and the trees of those that show one.
#[test]
fn cases_parse_as_they_say() {
    suite::run("syntax", |case| {
        let mut sources = Sources::default();
        let id = sources.add("case.mod", case, false);
        let Parsed { file, diagnostics } = parse(id, case);
        let printed = if case.contains("\n//>") { tree(&file) } else { Vec::new() };
        suite::Observed { sources, file: Some(id), diagnostics, printed }
    });
}

/// All codes in order, without the tree.
fn only(text: &str) -> Vec<Code> {
    let mut codes = codes(text);
    codes.dedup();
    codes
}

#[test]
fn the_library_and_the_examples_parse() {
    for folder in ["stdlib", "examples"] {
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("it can be listed").path();
            if path.extension().is_some_and(|extension| extension == "mod") {
                let text = std::fs::read_to_string(&path).expect("it can be read");
                assert_eq!(codes(&text), [], "{}", path.display());
            }
        }
    }
}

/// Each form of nesting, as what opens one level and what closes it.
const NESTS: &[(&str, &str)] = &[
    ("(", ")"),
    ("[", "]"),
    ("f(", ")"),
    ("f(a: ", ")"),
    ("a[", "]"),
    ("(x => ", ")"),
    ("[x for y in ", "]"),
    ("[x for y in z if ", "]"),
    ("if ", " { 1 } else { 2 }"),
    ("if c { ", " } else { 2 }"),
    ("if c { 1 } else { ", " }"),
    ("if c { if d { 3 } else { 4 } } else { ", " }"),
    ("{ let a = ", "\n 1 }"),
    ("-(", ")"),
    ("not (", ")"),
    ("(1 + ", ")"),
    ("(1 else ", ")"),
    ("\"{", "}\""),
];

fn nested(open: &str, close: &str, depth: usize) -> String {
    let body = if open == "{ let a = " { "" } else { " " };
    format!("let a ={body}{}1{}\n", open.repeat(depth), close.repeat(depth))
}

#[test]
fn brackets_nest_a_hundred_deep() {
    for (open, close) in NESTS {
        assert_eq!(codes(&nested(open, close, 100)), [], "{open}");
    }
    let types = format!("let a: {}Int{} = 1\n", "List<".repeat(100), ">".repeat(100));
    assert_eq!(codes(&types), []);
    let loops = format!("config C {{ {} {} }}\n", "for i in 0..2 { if a {".repeat(50), "} }".repeat(50));
    assert_eq!(codes(&loops), []);
    let comments = format!("{} {} let a = 1\n", "/*".repeat(100), "*/".repeat(100));
    assert_eq!(codes(&comments), []);
}

/// A hundred levels with a mistake inside, or without their ends, are told once. An exponential
/// alternative would never come to an end here.
#[test]
fn broken_nests_are_told_once() {
    for (open, close) in NESTS {
        let faulty = format!("let a = {}1 1{}\nlet b = 2\n", open.repeat(100), close.repeat(100));
        assert_eq!(codes(&faulty).len(), 1, "{open}: {:?}", parsed(&faulty).diagnostics);
        let endless = format!("let a = {}1\nlet b = 2\n", open.repeat(100));
        let told = codes(&endless);
        assert!((1..=2).contains(&told.len()), "{open}: {told:?}");
    }
}

/// Returns the number of pieces of a length that are wanted, or that a text has room for if that is less.
fn fitting(wanted: usize, length: usize) -> usize {
    wanted.min((modl::syntax::TEXT_MAX - 100) / length)
}

#[test]
fn what_nests_too_deeply_is_told_and_never_overflows() {
    for depth in [201, 1_000, 100_000] {
        for (open, close) in NESTS {
            // The operand of `if` nests no brackets; its tree is limited by its height.
            let enough =
                if open.starts_with("if ") && !open.ends_with("{ ") { depth.max(1_000) } else { depth };
            let enough = fitting(enough, open.len() + close.len());
            assert_eq!(only(&nested(open, close, enough)), [code::TOO_DEEP], "{open} {depth}");
            let endless = only(&format!("let a = {}", open.repeat(enough)));
            // Conditions open no brackets, and a text ends on its line.
            let wanted = match *open {
                "if " => &[code::SYNTAX, code::TOO_DEEP][..],
                "\"{" => &[code::UNCLOSED],
                _ => &[code::TOO_DEEP],
            };
            assert!(endless.iter().any(|code| wanted.contains(code)), "{open} {depth}: {endless:?}");
        }
        let comments = format!("{} {} let a = 1\n", "/*".repeat(depth), "*/".repeat(depth));
        assert_eq!(codes(&comments), [code::TOO_DEEP]);
        let types = format!("let a: {}Int{} = 1\n", "List<".repeat(depth), ">".repeat(depth));
        assert_eq!(codes(&types), [code::TOO_DEEP], "{depth}");
        let functions = format!("let a: {}Int = 1\n", "fn() -> ".repeat(fitting(depth, 8)));
        assert_eq!(codes(&functions), [code::TOO_DEEP]);
        let deep = fitting(depth, 14);
        let loops = format!("config C {{ {} {} }}\n", "for i in a { ".repeat(deep), "}".repeat(deep));
        assert_eq!(codes(&loops), [code::TOO_DEEP]);
    }
}

#[test]
fn long_chains_are_told_and_never_overflow() {
    let chains = [
        ("1", " + 1"),
        ("1", "^1"),
        ("a", ".b"),
        ("a", "()"),
        ("a", "[0]"),
        ("a", " else a"),
        ("a", " and a"),
        ("if a { 1 }", " else if a { 1 }"),
    ];
    for (first, more) in chains {
        assert_eq!(codes(&format!("let a = {first}{}\n", more.repeat(150))), [], "{more}");
        for length in [600, 100_000] {
            let length = fitting(length, more.len());
            assert_eq!(
                only(&format!("let a = {first}{}\n", more.repeat(length))),
                [code::TOO_DEEP],
                "{more}"
            );
        }
    }
    for prefix in ["- ", "not ", "x => "] {
        assert_eq!(codes(&format!("let a = {}1\n", prefix.repeat(150))), [], "{prefix}");
        assert_eq!(only(&format!("let a = {}1\n", prefix.repeat(100_000))), [code::TOO_DEEP], "{prefix}");
    }
    // These grow no tree.
    for (before, one, after) in [("let a = [", "1, ", "]"), ("let a: T", "?", " = 1"), ("", "print(1)\n", "")]
    {
        assert_eq!(codes(&format!("{before}{}{after}\n", one.repeat(10_000))), [], "{one}");
    }
    let clauses = format!("config C {{ if a {{ }} {} }}\n", "else if a { }".repeat(fitting(100_000, 13)));
    assert_eq!(codes(&clauses), [code::TOO_DEEP]);
}

#[test]
fn a_text_has_a_greatest_size() {
    let large = " ".repeat(modl::syntax::TEXT_MAX);
    assert_eq!(codes(&large), []);
    assert_eq!(codes(&format!("{large} ")), [code::TOO_LARGE]);
}

#[test]
fn the_number_of_messages_is_limited() {
    let many = "let a = )\n".repeat(5_000);
    assert!(codes(&many).len() <= modl::syntax::DIAGNOSTICS_MAX);
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_change_nothing() {
    let text = "/// one\nlet a = f(1,\n  2) // end\n  * 3\nlet b = \"\"\"\n  x\n  y\n  \"\"\"\nprint(a)\n";
    let plain = tree(&parsed(text).file);
    assert_eq!(tree(&parsed(&text.replace('\n', "\r\n")).file), plain);
    let marked = parsed(&format!("\u{feff}{text}"));
    assert_eq!((tree(&marked.file), marked.diagnostics), (plain, Vec::new()));
    assert_eq!(codes("let a = 1 \u{feff}\n"), [code::BAD_CHARACTER]);
}

#[test]
fn characters_that_nobody_sees_are_told() {
    for c in ['\0', '\u{1}', '\u{200b}', '\u{202e}', '\u{2066}', '\u{ad}', '\u{7f}'] {
        let diagnostics = parsed(&format!("let a{c} = 1\n")).diagnostics;
        assert_eq!(diagnostics.len(), 1, "{c:?}");
        assert_eq!(diagnostics[0].code, code::BAD_CHARACTER);
        assert!(diagnostics[0].message.contains(&format!("U+{:04X}", u32::from(c))), "{c:?}");
    }
    for c in ['\0', '\u{1}', '\u{202e}', '\u{2066}', '\u{200f}'] {
        assert_eq!(codes(&format!("let a = \"x{c}y\" // {c}\n")), [code::BAD_CHARACTER; 2], "{c:?}");
    }
}

#[test]
fn comments_are_kept_with_their_places() {
    let text = "//! file\n/// item\nlet a = /* b /* c */ */ 1 // d\n//// e\n";
    let comments = parsed(text).file.comments;
    let shown: Vec<_> = comments.iter().map(|c| (&text[c.span.range()], c.kind)).collect();
    use modl::syntax::ast::CommentKind::*;
    let expected = [
        ("//! file", FileDoc),
        ("/// item", ItemDoc),
        ("/* b /* c */ */", Block),
        ("// d", Line),
        ("//// e", Line),
    ];
    assert_eq!(shown, expected);
    assert_eq!(parsed(text).file.doc.as_deref(), Some("file"));
}

/// Brackets deeper than the limit are counted, not kept: seven hundred thousand of them cost what as many blanks do.
#[test]
fn a_text_full_of_brackets_is_told_once() {
    for open in ["(", "[", "{", "f(", "[1, "] {
        let text = format!("let a = {}\nlet b = 2\n", open.repeat(700_000 / open.len()));
        assert_eq!(codes(&text), [code::TOO_DEEP], "{open}");
        let formatted = modl::format::format(FileId(0), &text).expect("it is left as it is");
        assert_eq!(formatted.diagnostics.len(), 1, "{open}");
        assert!(formatted.text == text, "{open}");
    }
    let closed = format!("let a = {}1{}\nlet b = a c\n", "(".repeat(1000), ")".repeat(1000));
    assert_eq!(codes(&closed), [code::TOO_DEEP, code::SYNTAX]);
}
