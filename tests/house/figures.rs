//! The figures of the house, measured: `cargo test --release --test all figures -- --nocapture` prints the
//! table that stands in `docs/architecture.md`, and holds what has a limit to it.

use crate::support::sources::{code_lines, knots, rust};
use std::collections::BTreeMap;

/// Files of one import knot at most.
const KNOT_MAX: usize = 8;

/// The rooms of the back end, whose `pub` items are an interface for Rust programs.
const BACK_END: &[&str] = &[
    "units", "geometry", "optimize", "robot", "plan", "behavior", "planners", "simulate", "view", "formats",
];

/// The share of `pub` items of the back end that have a doc comment, at least.
const DOCUMENTED_MIN: f64 = 0.95;

/// One thing of each kind that grows, with patterns that only the code about it contains.
const GROWTH: &[(&str, &[&str], &str)] = &[
    ("a built-in (`footprint`)", &["\"footprint\""], "src/natives/robot.rs"),
    ("a planner (`squeeze`)", &["squeeze::"], "src/planners/squeeze/"),
    ("a check of the judge (`Rest`)", &["CheckKind::Rest"], "src/plan/verify/"),
    ("a family of plans (stages)", &["Body::Stages"], "src/plan/stages/"),
    ("a mesh format (STL)", &["stl::"], "src/formats/stl.rs"),
    (
        "a family of modules (struts)",
        &["Family::Strut", "DesignKind::Strut", "Rule::strut"],
        "src/check/family.rs",
    ),
];

#[test]
fn figures_of_the_house() {
    let source = rust("src");
    let lines: usize = source.values().map(|text| text.lines().count()).sum();
    println!("files / lines: {} / {lines}", source.len());
    println!("lines in natives: {}", lines_of(&source, "src/natives/"));
    let knots = knots();
    for knot in knots.iter().take(4) {
        println!("import knot of {}: {}", knot.len(), knot.join(" "));
    }
    let (documented, items) = documented(&source);
    println!("pub items of the back end with a doc comment: {documented} of {items}");
    for (kind, patterns, home) in GROWTH {
        let places = mentions(&source, patterns)
            .into_iter()
            .filter(|file| !file.starts_with(home))
            .collect::<Vec<_>>();
        println!("{kind}: named in {} files outside of {home}: {}", places.len(), places.join(" "));
    }
    let numbered = numbered_arguments(&source);
    println!("numbered arguments: {}", numbered.len());
    let texts = text_errors(&source);
    println!("`Result<_, String>` in plan: {}", texts.len());

    assert!(knots.iter().all(|knot| knot.len() <= KNOT_MAX), "import knots of more than {KNOT_MAX} files");
    assert!(
        documented as f64 >= DOCUMENTED_MIN * items as f64,
        "{documented} of {items} pub items are documented"
    );
    assert!(numbered.is_empty(), "arguments by number:\n  {}", numbered.join("\n  "));
    assert!(texts.is_empty(), "errors that are texts:\n  {}", texts.join("\n  "));
}

fn lines_of(source: &BTreeMap<String, String>, folder: &str) -> usize {
    source.iter().filter(|(file, _)| file.starts_with(folder)).map(|(_, text)| text.lines().count()).sum()
}

/// The files that contain one of the patterns in their code.
fn mentions<'s>(source: &'s BTreeMap<String, String>, patterns: &[&str]) -> Vec<&'s str> {
    let has =
        |text: &str| code_lines(text).any(|(_, line)| patterns.iter().any(|pattern| line.contains(pattern)));
    source.iter().filter(|(_, text)| has(text)).map(|(file, _)| file.as_str()).collect()
}

/// The `pub` items of the back end that have a doc comment, and all of them: functions, types, constants,
/// modules and fields.
fn documented(source: &BTreeMap<String, String>) -> (usize, usize) {
    let (mut documented, mut items) = (0, 0);
    for (file, text) in source {
        if !BACK_END.iter().any(|room| file.starts_with(&format!("src/{room}/"))) {
            continue;
        }
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for (i, line) in lines.iter().enumerate() {
            let Some(item) = line.strip_prefix("pub ") else { continue };
            // A module is documented in its own file, a re-export where it comes from.
            if item.starts_with("mod ") || item.starts_with("use ") {
                continue;
            }
            items += 1;
            let above = lines[..i].iter().rev().find(|above| !above.starts_with("#["));
            documented +=
                usize::from(above.is_some_and(|above| above.starts_with("///") || above.ends_with(")]")));
        }
    }
    (documented, items)
}

/// Lines of natives that ask a call for an argument by its place.
fn numbered_arguments(source: &BTreeMap<String, String>) -> Vec<String> {
    let natives = source.iter().filter(|(file, _)| file.starts_with("src/natives/"));
    let by_number = |line: &str| {
        line.match_indices("call.").any(|(at, _)| {
            let inside = line[at..].split_once('(').map(|(_, inside)| inside);
            inside.is_some_and(|inside| inside.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    let found = natives.flat_map(|(file, text)| {
        code_lines(text)
            .filter(|(_, line)| by_number(line))
            .map(move |(n, line)| format!("{file}:{n}: {}", line.trim()))
    });
    found.collect()
}

/// Functions of the room of plans whose error is a bare text.
fn text_errors(source: &BTreeMap<String, String>) -> Vec<String> {
    let plans = source.iter().filter(|(file, _)| file.starts_with("src/plan/"));
    let found = plans.flat_map(|(file, text)| {
        code_lines(text)
            .filter(|(_, line)| line.contains("Result<") && line.contains(", String>"))
            .map(move |(n, line)| format!("{file}:{n}: {}", line.trim()))
    });
    found.collect()
}
