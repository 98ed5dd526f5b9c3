//! Any text parses without a panic, and every place that is told lies within it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use modl::source::FileId;

fuzz_target!(|text: &str| {
    let parsed = modl::syntax::parse(FileId(0), text);
    for diagnostic in &parsed.diagnostics {
        for label in &diagnostic.labels {
            assert!(text.get(label.span.range()).is_some());
        }
    }
});
