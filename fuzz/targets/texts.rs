//! Programs as texts: read to trees, and formatted.

use crate::fuzz::inputs::corpus;
use crate::fuzz::inputs::dice::Dice;
use modl::source::FileId;
use modl::syntax::ast::ItemKind;
use modl::syntax::{Outline, skeleton};

/// Returns a text.
pub fn input(dice: &mut Dice) -> Vec<u8> {
    corpus::text(dice).into_bytes()
}

/// Parses a text: what is told lies within it, and an error in the tree is told.
pub fn parse(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let parsed = modl::syntax::parse(FileId(0), &text);
    for diagnostic in &parsed.diagnostics {
        assert!(!diagnostic.labels.is_empty(), "{} has no place", diagnostic.message);
        for label in &diagnostic.labels {
            assert!(text.get(label.span.range()).is_some(), "{:?} is no place", label.span);
        }
    }
    let mut end = 0;
    for item in &parsed.file.items {
        let range = item.span.range();
        assert!(text.get(range.clone()).is_some(), "{:?} is no place", item.span);
        let spans = || parsed.file.items.iter().map(|item| item.span.range()).collect::<Vec<_>>();
        assert!(end <= range.start, "items stand in their order: {:?}", spans());
        end = range.end;
        let told = !parsed.diagnostics.is_empty();
        assert!(told || !matches!(item.kind, ItemKind::Error), "an error was not told");
    }
    if let Some(outline) = Outline::of(&text) {
        let mut end = 0;
        for token in &outline.tokens {
            assert!(end <= token.start && token.start <= token.end, "tokens stand in their order");
            assert!(text.get(token.start..token.end).is_some());
            end = token.end;
        }
    }
}

/// Formats a text: it means the same, and stays as it is then.
pub fn format(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let formatted = |text: &str| modl::format::format(FileId(0), text).expect("the meaning stays").text;
    let once = formatted(&text);
    let twice = formatted(&once);
    assert!(once == twice, "the second time is another:\n{once}\n--- and then\n{twice}");
    if let Some(meaning) = skeleton(&text) {
        assert!(Some(meaning) == skeleton(&once), "another program:\n{once}");
    }
}
