//! The words of the field: names that were given back to robotics papers and compiler books do not return,
//! comments begin with their subject, and the documents of functions with a verb.

use crate::support::sources::rust;

/// Words in comments that another word says better: images, and British "programme".
const OLD_WORDS: &[(&str, &str)] = &[
    ("programme", "program"),
    ("programmes", "programs"),
    ("hung", "rooted at, or connected with"),
    ("dearer", "costlier"),
    ("undercut", "go below"),
    ("wing", "front end, or back end"),
    ("he", "it"),
    ("his", "its"),
    ("him", "it"),
];

/// Plurals that begin a document of a function, where a verb should.
const NOUNS: &[&str] =
    &["Faces", "Modules", "Names", "Nodes", "Parts", "Places", "Positions", "Seconds", "This", "Values"];

/// Names of types, functions and constants that were private to this house, each with the word of the field
/// that stands for it now.
const OLD_NAMES: &[(&str, &str)] = &[
    ("Wish", "Settings, or CancelState"),
    ("Dice", "SplitMix64"),
    ("Rung", "Relaxation"),
    ("ladder", "fallbacks"),
    ("eased", "relaxed_steps"),
    ("Hearing", "Candidates"),
    ("Glance", "bound prefilter"),
    ("LOOKS_MAX", "ADVANCEMENT_STEPS_MAX"),
    ("CUSHION", "CLEARANCE_MARGIN"),
    ("INSIST", "ROW_GAIN"),
    ("Knot", "Keyframe"),
    ("Waypoint", "Checkpoint"),
    ("Spot", "CellState"),
    ("twin_stages", "two-phase"),
    ("Trussed", "PlannerReport"),
    ("Squeezed", "PlannerReport"),
    ("Unwound", "PlannerReport"),
    ("Refolded", "PlannerReport"),
    ("be_curious", "poll progress"),
    ("CURIOSITY", "PROGRESS_INTERVAL"),
    ("leave_gaps", "reserved definition"),
    ("Nearness", "SignedDistance"),
    ("evened", "whitened"),
    ("untwist", "zero twist"),
    ("odds_against", "logit of failure"),
    ("tells_apart", "separated"),
    ("portrait", "display"),
    ("Showing", "render input"),
    ("Aim", "TaskSpace"),
    ("Census", "Enumeration"),
    ("HELD_BACK", "PROXIMAL_WEIGHT"),
    ("Lifting", "WorkOrder"),
    ("Look", "SvgAttributes"),
    ("Misfit", "ArgumentError"),
    ("Suspect", "Candidate"),
    ("Tell", "Shown"),
    ("WAYPOINTS_MAX", "CHECKPOINTS_MAX"),
    ("rehearse", "run_body"),
    ("untold", "unreported"),
];

/// Words that hide the subject of a sentence of a comment. A condition opens with "If", a list by index with
/// "For each".
const OPENINGS: &[&str] =
    &["What", "How", "Whether", "Where", "Which", "Who", "Whose", "Why", "By", "From how"];

/// Openings of a document, besides those of any sentence, that hide its subject.
const DOCUMENT_OPENINGS: &[&str] =
    &["When", "Of", "From", "That", "Asked", "Behind", "At", "Only", "Without", "Up to", "Returns whether"];

/// Openings with such a word that hide nothing.
const PLAIN_OPENINGS: &[&str] = &["By default", "At most:", "At least:"];

#[test]
fn old_names_do_not_return() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        // There old words of programs get their hints.
        if file == "src/source/foreign.rs" {
            continue;
        }
        for (i, line) in text.lines().enumerate() {
            let is_part = |c: char| c.is_alphanumeric() || c == '_';
            for word in line.split(|c| !is_part(c)) {
                if let Some((old, new)) = OLD_NAMES.iter().find(|(old, _)| *old == word) {
                    faults.push(format!("{file}:{}: `{old}`; the field says {new}", i + 1));
                }
            }
        }
    }
    assert!(faults.is_empty(), "words of the past:\n  {}", faults.join("\n  "));
}

#[test]
fn sentences_of_comments_begin_with_their_subject() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        for (line, sentence) in sentences(&text) {
            let opens = |words: &[&str]| {
                let mut rests = words.iter().filter_map(|word| sentence.strip_prefix(word));
                rests.any(|rest| rest.starts_with(' '))
            };
            if opens(OPENINGS) && !opens(PLAIN_OPENINGS) {
                faults.push(format!("{file}:{line}: {sentence}"));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "{} sentences that do not begin with their subject:\n  {}",
        faults.len(),
        faults.join("\n  ")
    );
}

#[test]
fn old_words_do_not_return_to_comments() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        for (line, sentence) in sentences(&text) {
            for word in sentence.split(|c: char| !c.is_alphanumeric()) {
                if let Some((old, new)) = OLD_WORDS.iter().find(|(old, _)| *old == word) {
                    faults.push(format!("{file}:{line}: \"{old}\"; better \"{new}\""));
                }
            }
        }
    }
    assert!(faults.is_empty(), "words of the past in comments:\n  {}", faults.join("\n  "));
}

#[test]
fn documents_say_what_an_item_is() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        // There the documents are the help of the command line.
        if file == "src/cli/arguments.rs" {
            continue;
        }
        for (line, document, item) in documents(&text) {
            if let Some(fault) = document_fault(&document, &item) {
                faults.push(format!("{file}:{line}: {fault}: {document}"));
            }
        }
    }
    assert!(faults.is_empty(), "{} documents:\n  {}", faults.len(), faults.join("\n  "));
}

#[test]
fn faults_of_documents_are_found() {
    let cases = [
        ("Returns the mass, kg.", "pub fn mass(&self) -> f64 {", None),
        ("The mass, kg.", "pub fn mass(&self) -> f64 {", Some("a function's document begins with a verb")),
        ("Names of all.", "const fn names() {", Some("a function's document begins with a verb")),
        ("When it ends, s.", "pub end: f64,", Some("the subject comes first")),
        ("Returns whether it is.", "fn is(&self) -> bool {", Some("the subject comes first")),
        ("At most: `<=`.", "LessEqual,", None),
        ("Returns the mass.", "pub mass: f64,", Some("only a function returns")),
        ("Seconds.", "pub time: f64,", Some("a unit is not a document")),
        ("rad/s", "pub speed: f64,", Some("a unit is not a document")),
        ("`let`", "Let(Let),", Some("a snippet is not a document")),
        ("Positions.", "pub places: Vec<[i64; 3]>,", None),
    ];
    for (document, item, wanted) in cases {
        assert_eq!(document_fault(document, item), wanted, "{document} {item}");
    }
}

/// The fault of a document of an item, given by its first line.
fn document_fault(document: &str, item: &str) -> Option<&'static str> {
    const UNITS: &[&str] =
        &["Seconds", "Metres", "Radians", "Kilograms", "N", "N·m", "m", "s", "kg", "rad", "rad/s", "m/s"];
    let opens = |words: &[&str]| {
        let mut rests = words.iter().filter_map(|word| document.strip_prefix(word));
        rests.any(|rest| rest.starts_with(' '))
    };
    let code = item.split("fn ").next().expect("a first part");
    let qualifiers = ["pub", "const", "unsafe", "async", "crate", "super", "in", "self", "plan"];
    let is_fn = item.contains("fn ")
        && code
            .split(|c: char| !c.is_alphanumeric())
            .all(|word| word.is_empty() || qualifiers.contains(&word));
    let first = document.split([' ', '.', ',', ':', ';']).next().unwrap_or("");
    let is_verb = first.ends_with('s') && first.starts_with(char::is_uppercase) && !NOUNS.contains(&first);
    let is_item =
        ["fn ", "struct ", "enum ", "trait ", "type ", "const ", "mod "].iter().any(|w| item.contains(w));
    let snippet = document.trim_end_matches('.');
    if UNITS.contains(&document.trim_end_matches('.')) {
        Some("a unit is not a document")
    } else if snippet.len() > 1
        && snippet.starts_with('`')
        && snippet.ends_with('`')
        && !snippet[1..snippet.len() - 1].contains('`')
    {
        Some("a snippet is not a document")
    } else if opens(DOCUMENT_OPENINGS) && !opens(PLAIN_OPENINGS) {
        Some("the subject comes first")
    } else if is_fn && !is_verb {
        Some("a function's document begins with a verb")
    } else if !is_item && first == "Returns" && !item.contains("fn(") {
        Some("only a function returns")
    } else {
        None
    }
}

/// Returns the first sentence of the document of every item, with its line and the first line of the item.
fn documents(text: &str) -> Vec<(usize, String, String)> {
    let mut found = Vec::new();
    let mut document: Option<(usize, String)> = None;
    let mut goes_on = false;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        match (line.strip_prefix("///"), &mut document) {
            (Some(said), None) => {
                document = Some((number, said.trim().to_owned()));
                goes_on = !said.trim().ends_with('.');
            }
            (Some(said), Some((_, first))) if goes_on && !said.trim().is_empty() => {
                *first += " ";
                *first += said.trim();
                goes_on = !said.trim().ends_with('.');
            }
            (Some(_), Some(_)) => goes_on = false,
            (None, Some(_)) if line.starts_with("#[") => {}
            (None, _) => {
                if let Some((at, first)) = document.take() {
                    found.push((at, first, line.to_owned()));
                }
            }
        }
    }
    found
}

#[test]
fn sentences_are_found_across_lines() {
    let text = "/// One sentence\n/// over lines. How\n/// far is another.\n///\n/// - What an item is\n\
                let x = 1; // no comment line\n// By plain comment.\n/// ```\n/// What.\n/// ```\n";
    let found: Vec<(usize, String)> = sentences(text);
    let found: Vec<(usize, &str)> = found.iter().map(|(line, text)| (*line, text.as_str())).collect();
    let wanted = [
        (1, "One sentence over lines."),
        (2, "How far is another."),
        (5, "What an item is"),
        (7, "By plain comment."),
    ];
    assert_eq!(found, wanted);
}

/// Returns the sentences of all comments that stand on lines of their own, each with the line on which it
/// begins. Code in them is passed over; an empty line and an item of a list begin a sentence.
fn sentences(text: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let (mut mark, mut ended, mut in_code) = ("", true, false);
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim_start();
        let kind = ["///", "//!", "//"].into_iter().find(|mark| line.starts_with(mark)).unwrap_or("");
        let said = line[kind.len()..].trim();
        let fence = said.starts_with("```");
        let begins = kind != mark;
        mark = kind;
        in_code = (in_code && !begins) != fence;
        let item = said.strip_prefix("- ");
        ended |= begins || item.is_some();
        if kind.is_empty() || said.is_empty() || fence || in_code {
            ended = true;
            continue;
        }
        for word in item.unwrap_or(said).split_whitespace() {
            match found.last_mut() {
                Some((_, sentence)) if !ended => *sentence += &format!(" {word}"),
                _ => found.push((number, word.to_owned())),
            }
            ended = word.ends_with(['.', '!', '?']);
        }
    }
    found
}
