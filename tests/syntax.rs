//! The parser: what it accepts, which tree it builds, what it says and how it goes on.

use modl::source::FileId;
use modl::syntax::parse;

#[test]
fn a_small_program_parses() {
    let text =
        "let a = 1 + 2 * 3\nconfig C { part m[3]: M(bend: 30deg)\n  connect m[0].a -- m[1].b turn 90deg }\n";
    let parsed = parse(FileId(0), text);
    assert!(parsed.diagnostics.is_empty());
    assert_eq!(parsed.file.items.len(), 2);
}
