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

/// Beginnings of a comment that hide its subject.
const OPENINGS: &[&str] = &[
    "What ",
    "How ",
    "Whether ",
    "By how ",
    "By so ",
    "Where ",
    "From how ",
    "So many ",
    "So far ",
    "So much ",
];

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
fn documentation_begins_with_its_subject() {
    let mut faults = Vec::new();
    for (file, text) in rust("src") {
        let mut before = "";
        for (i, line) in text.lines().enumerate() {
            let comment = line.trim_start();
            let said = ["/// ", "//! "].iter().find_map(|mark| comment.strip_prefix(mark));
            // Only the beginning of a paragraph: a sentence may go on with any of these words.
            let begins = !["///", "//!"].iter().any(|mark| before.starts_with(mark) && before != *mark);
            if let Some(said) = said
                && begins
                && OPENINGS.iter().any(|opening| said.starts_with(opening))
            {
                faults.push(format!("{file}:{}: {said}", i + 1));
            }
            before = comment;
        }
    }
    assert!(
        faults.is_empty(),
        "{} comments that do not begin with their subject:\n  {}",
        faults.len(),
        faults.join("\n  ")
    );
}
