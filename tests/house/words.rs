//! The words of the field: names that were given back to robotics papers and compiler books do not return, and
//! comments begin with their subject.

use crate::support::sources::rust;

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
];

/// Words that hide the subject of a sentence of a comment. A condition opens with "If", a list by index with
/// "For each".
const OPENINGS: &[&str] =
    &["What", "How", "Whether", "Where", "Which", "Who", "Whose", "Why", "By", "From how"];

/// Openings with such a word that hide nothing.
const PLAIN_OPENINGS: &[&str] = &["By default"];

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
