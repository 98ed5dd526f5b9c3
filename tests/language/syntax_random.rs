//! The parser under random texts: it never panics, and what it says lies within the text.

use crate::fuzz::inputs::damage::TOKENS;
use modl::source::{Diagnostic, FileId};
use modl::syntax::ast::{Item, ItemKind};
use modl::syntax::parse;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]))
}

/// Parses, and checks what holds for every text.
fn check(text: &str) -> Result<(), TestCaseError> {
    let parsed = parse(FileId(0), text);
    for Diagnostic { labels, .. } in &parsed.diagnostics {
        prop_assert!(!labels.is_empty());
        for label in labels {
            prop_assert!(text.get(label.span.range()).is_some(), "{:?} in {text:?}", label.span);
        }
    }
    for Item { span, kind, .. } in &parsed.file.items {
        prop_assert!(text.get(span.range()).is_some(), "{span:?} in {text:?}");
        let told = !parsed.diagnostics.is_empty();
        prop_assert!(told || !matches!(kind, ItemKind::Error), "an error that was not told: {text:?}");
    }
    // The tree can be walked, whatever it is of.
    crate::support::tree::tree(&parsed.file);
    Ok(())
}

#[test]
fn token_soup_never_panics() {
    let soup = prop::collection::vec((prop::sample::select(TOKENS), any::<bool>()), 0..60);
    let result = runner(3_000).run(&soup, |tokens| {
        let text: String =
            tokens.iter().flat_map(|(token, glued)| [*token, if *glued { "" } else { " " }]).collect();
        check(&text)
    });
    result.unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn mutated_programs_never_panic() {
    let programs: Vec<String> = crate::support::suite::programs("syntax");
    let edits =
        prop::collection::vec((any::<prop::sample::Index>(), prop::sample::select(TOKENS), 0..3u8), 1..5);
    let result = runner(3_000).run(&(prop::sample::select(programs), edits), |(mut text, edits)| {
        for (place, token, kind) in edits {
            let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
            let at = places[place.index(places.len())];
            match kind {
                0 => text.insert_str(at, token),
                1 => text.truncate(at),
                _ => drop(text[at..].chars().next().map(|c| text.replace_range(at..at + c.len_utf8(), ""))),
            }
        }
        check(&text)
    });
    result.unwrap_or_else(|failure| panic!("{failure}"));
}

/// A program cut off anywhere is told to be wrong, or is whole.
#[test]
fn cut_programs_never_panic() {
    for program in crate::support::suite::programs("syntax") {
        for (at, _) in program.char_indices() {
            check(&program[..at]).unwrap_or_else(|failure| panic!("{failure}"));
        }
    }
}
