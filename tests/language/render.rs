//! How diagnostics look: snippets, narrow terminals, long lines, odd spans, several files, JSON.

use modl::source::json::to_json;
use modl::source::render::{Style, render, render_one};
use modl::source::{Diagnostic, FileId, Sources, Span, code};

fn style(width: usize) -> Style {
    Style { width, ..Style::default() }
}

/// The columns that text takes, as far as these tests need it.
fn width(text: &str) -> usize {
    text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
}

fn span(sources: &Sources, file: FileId, needle: &str) -> Span {
    let start = sources.file(file).text.find(needle).expect("the needle is in the text");
    Span::new(file, start, start + needle.len())
}

#[test]
fn two_labels_and_a_hint() {
    let mut sources = Sources::default();
    let f = sources.add(
        "port.mod",
        "config C {\n  connect m[0].top -- m[1].bottom\n  connect m[0].top -- m[2].bottom\n}\n",
        false,
    );
    let first = span(&sources, f, "m[0].top");
    let start = sources.file(f).text.rfind("m[0].top").expect("twice");
    let d = Diagnostic::error(code::PORT_TAKEN, "the port `m[0].top` is taken")
        .label(Span::new(f, start, start + 8), "this port is taken")
        .label(first, "taken here")
        .hint("free ports of `m[0]`: left, right, bottom");
    let expected = "\
E0301 (modl explain E0301)

  × the port `m[0].top` is taken
   ╭─[port.mod:3:11]
 1 │ config C {
 2 │   connect m[0].top -- m[1].bottom
   ·           ────┬───
   ·               ╰── taken here
 3 │   connect m[0].top -- m[2].bottom
   ·           ────┬───
   ·               ╰── this port is taken
 4 │ }
   ╰────
  help: free ports of `m[0]`: left, right, bottom
";
    assert_eq!(render_one(&sources, &d, &style(80)), expected);
}

#[test]
fn labels_in_two_files_are_two_snippets_and_the_primary_one_comes_first() {
    let mut sources = Sources::default();
    let a = sources.add("a.mod", "let A = 1\n", false);
    let b = sources.add("parts/b.mod", "\n\n\nlet B = A\n", false);
    let d = Diagnostic::error(code::IMPORT_CYCLE, "these files import each other")
        .label(span(&sources, b, "let B"), "here")
        .label(span(&sources, a, "let A"), "and here");
    let folder = Style { folder: "robots".to_owned(), ..style(80) };
    let text = render_one(&sources, &d, &folder);
    let at = |needle: &str| text.find(needle).unwrap_or_else(|| panic!("no {needle} in\n{text}"));
    assert!(at("[robots/parts/b.mod:4:1]") < at("╰── here"));
    assert!(at("╰── here") < at("[robots/a.mod:1:1]"));
    assert!(at("[robots/a.mod:1:1]") < at("and here"));
}

#[test]
fn far_lines_of_one_file_are_two_snippets() {
    let mut sources = Sources::default();
    let f = sources.add("f.mod", &format!("first\n{}last\n", "between\n".repeat(1000)), false);
    let d = Diagnostic::error(code::CONFLICT, "two commands")
        .label(span(&sources, f, "last"), "one")
        .label(span(&sources, f, "first"), "other");
    let text = render_one(&sources, &d, &style(80));
    assert!(text.contains("1002 │ last") && text.contains("1 │ first"), "{text}");
    assert_eq!(text.matches("between").count(), 2, "{text}");
}

#[test]
fn a_long_line_is_cut_about_its_label() {
    let mut sources = Sources::default();
    let f =
        sources.add("long.mod", &format!("{}needle{}\n", "abc ".repeat(5000), " xyz".repeat(5000)), false);
    let d = Diagnostic::error(code::SYNTAX, "a long line").label(span(&sources, f, "needle"), "here");
    for columns in [30, 40, 80, 200] {
        let text = render_one(&sources, &d, &style(columns));
        assert!(width(&text) <= columns, "{} > {columns}:\n{text}", width(&text));
        assert!(text.contains("needle") && text.contains('…'), "{text}");
        assert!(text.contains("long.mod:1:20001"), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        let code = lines.iter().position(|l| l.contains("needle")).expect("shown");
        let column = |line: &str, c: char| line.chars().position(|x| x == c);
        let needle = lines[code].chars().collect::<String>();
        let at = needle[..needle.find("needle").expect("shown")].chars().count();
        let from = column(lines[code + 1], '─').expect("a mark");
        assert_eq!(from, at, "{text}");
    }
}

#[test]
fn text_of_labels_messages_and_hints_keeps_to_narrow_terminals() {
    let mut sources = Sources::default();
    let f = sources.add("n.mod", "config Walker { part body: Body3 }\n", false);
    let words = "the centre of mass leaves the support polygon over its front edge";
    let d = Diagnostic::error(code::FALL, words).label(span(&sources, f, "Body3"), words).hint(words);
    let long = sources.add("l.mod", "  behavior dig = move(arm[1].tilt, to: -90deg, in: 2s)\n", false);
    let e = Diagnostic::error(code::FALL, words)
        .label(span(&sources, long, "move(arm[1].tilt, to: -90deg, in: 2s)"), words);
    for columns in [30, 40, 60] {
        for d in [&d, &e] {
            let text = render_one(&sources, d, &style(columns));
            assert!(width(&text) <= columns, "{} > {columns}:\n{text}", width(&text));
        }
    }
}

/// The underlined text of the first snippet.
fn underlined(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mark = lines.iter().position(|l| l.contains('·')).unwrap_or_else(|| panic!("no mark in\n{text}"));
    let columns = lines[mark].chars().enumerate().filter(|(_, c)| "─┬▲".contains(*c)).map(|(i, _)| i);
    let line: Vec<char> = lines[mark - 1].chars().collect();
    columns.filter_map(|i| line.get(i)).collect()
}

#[test]
fn spans_without_length_mark_something_that_can_be_seen() {
    let text = "let a = 1  \n\n  let b = (\n\n";
    let mut sources = Sources::default();
    let f = sources.add("e.mod", text, false);
    let marked = |start: usize, end: usize| {
        let d = Diagnostic::error(code::SYNTAX, "m").label(Span::new(f, start, end), "here");
        underlined(&render_one(&sources, &d, &style(80)))
    };
    assert_eq!(marked(text.len(), text.len()), "(", "end of file");
    assert_eq!(marked(text.len() - 1, text.len()), "(", "the last line end");
    assert_eq!(marked(9, 9), "1", "blanks at the end of a line");
    assert_eq!(marked(4, 4), "a", "before a character");
    assert_eq!(marked(8, 13), "1", "over blank lines");
    let empty = sources.add("empty.mod", "", false);
    let d = Diagnostic::error(code::SYNTAX, "m").label(Span::new(empty, 0, 0), "here");
    assert!(render_one(&sources, &d, &style(80)).contains("here"));
    let d = Diagnostic::error(code::SYNTAX, "m").label(Span::new(f, 12, 12), "on a blank line");
    assert!(render_one(&sources, &d, &style(80)).contains("on a blank line"));
}

#[test]
fn every_span_of_an_odd_text_can_be_drawn() {
    let text = "a\t\u{1b}[31mä😀\r\n\n\t漢字 x\u{202e}y \u{0}\n\r\n  ";
    let mut sources = Sources::default();
    let f = sources.add("odd.mod", text, false);
    for start in 0..=text.len() + 2 {
        for end in start..=text.len() + 2 {
            let d = Diagnostic::error(code::SYNTAX, text).label(Span::new(f, start, end), "here").hint(text);
            let drawn = render_one(&sources, &d, &style(40));
            assert!(drawn.contains("here"), "{start}..{end}\n{drawn}");
            assert!(
                !drawn.contains(['\u{1b}', '\u{202e}', '\u{0}', '\r', '\t']),
                "{start}..{end}: {drawn:?}"
            );
        }
    }
}

#[test]
fn a_label_over_many_lines_shows_its_first_line() {
    let mut sources = Sources::default();
    let f = sources.add("m.mod", &"line\n".repeat(500), false);
    let d = Diagnostic::error(code::SYNTAX, "m").label(Span::new(f, 5, 2000), "all of this");
    let text = render_one(&sources, &d, &style(80));
    assert!(text.lines().count() < 12, "{text}");
    let d = Diagnostic::error(code::SYNTAX, "m").label(Span::new(f, 5, 14), "both");
    let text = render_one(&sources, &d, &style(80));
    assert!(text.contains("╭─▶ line") && text.contains("both"), "{text}");
}

#[test]
fn diagnostics_come_by_place_once_each_and_not_too_many() {
    let mut sources = Sources::default();
    let f = sources.add("f.mod", &"x".repeat(10_000), false);
    let at = |i: usize| Diagnostic::error(code::SYNTAX, "m").label(Span::new(f, i, i + 1), "here");
    let mut many: Vec<Diagnostic> = (0..10_000).rev().map(at).collect();
    many.push(at(7));
    let text = render(&sources, &many, &style(80));
    assert!(text.contains("... and 9950 more"), "{}", &text[text.len() - 200..]);
    assert!(text.find("f.mod:1:1]") < text.find("f.mod:1:2]"));
    assert_eq!(to_json(&sources, &many, &style(80)).len(), 10_000);
}

#[test]
fn json_has_lines_and_columns_in_characters_and_offsets_in_bytes() {
    let mut sources = Sources::default();
    let f = sources.add("ä.mod", "let a = 1\nlet ä = \"äöü\" + bad\n", false);
    let d = Diagnostic::warning(code::UNKNOWN_NAME, "no `bad`")
        .label(span(&sources, f, "bad\n"), "here")
        .hint("why");
    let json = serde_json::to_value(to_json(&sources, &[d], &style(80))).expect("plain data");
    let expected = serde_json::json!([{
        "code": "E0101", "severity": "warning", "message": "no `bad`", "hints": ["why"],
        "labels": [{
            "file": "ä.mod", "library": false, "offset": 30, "length": 4,
            "line": 2, "column": 17, "end_line": 3, "end_column": 1, "text": "here",
        }],
    }]);
    assert_eq!(json, expected);
}
