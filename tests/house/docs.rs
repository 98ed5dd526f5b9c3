//! Every program in the documentation does what its page says.
//!
//! In `docs/` and in the standard library ` ```modl ` runs without a diagnostic, ` ```modl check ` is
//! only checked. A tag ` ```modl NAME.mod ` adds a file to the program before it. (`pages` judges the
//! pages of errors, `acceptance` the examples.)

use crate::support::desk;
use crate::support::fences::{Fence, documentation, fences, files};
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// A program with the files that belong to it.
struct Piece<'a> {
    fence: &'a Fence,
    extra: Vec<&'a Fence>,
}

impl Piece<'_> {
    /// What the program says, one message a line.
    fn said(&self, mode: Mode) -> String {
        let mut project = MapFiles::of(&self.fence.code);
        for fence in &self.extra {
            let name = fence.modl().expect("an extra file is a program");
            project.0.insert(name.to_owned(), fence.code.as_bytes().to_vec());
        }
        let (observed, _, _) = desk::run(&project, mode);
        observed.diagnostics.iter().map(|d| format!("  {} {}\n", d.code, d.message)).collect()
    }

    fn tag(&self) -> &str {
        self.fence.modl().expect("a piece is a program")
    }
}

/// The programs among the fences of a page.
fn pieces(all: &[Fence]) -> Vec<Piece<'_>> {
    let mut found: Vec<Piece> = Vec::new();
    for fence in all {
        match fence.modl() {
            Some(tag) if tag.contains('.') => {
                let owner =
                    found.last_mut().unwrap_or_else(|| panic!("{}: a file of no program", fence.place));
                owner.extra.push(fence);
            }
            Some(_) => found.push(Piece { fence, extra: Vec::new() }),
            None => {}
        }
    }
    found
}

fn judge_page(name: &str, text: &str, wrong: &mut String) {
    let all = fences(text, name);
    for piece in pieces(&all) {
        let mode = match piece.tag() {
            "" => Mode::Run,
            "check" => Mode::Check,
            other => panic!("{}: what is `modl {other}`?", piece.fence.place),
        };
        let said = piece.said(mode);
        if !said.is_empty() {
            wrong.push_str(&format!("{}:\n{said}", piece.fence.place));
        }
    }
}

#[test]
fn examples_of_the_library_run() {
    let mut wrong = String::new();
    for (name, text) in files("stdlib", "mod") {
        judge_page(&name, &documentation(&text), &mut wrong);
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn programs_in_the_documentation_run() {
    let mut wrong = String::new();
    // The listings of the tour build on each other: `tour` follows it.
    for (name, text) in files("docs", "md").into_iter().filter(|(name, _)| !name.ends_with("/tour.md")) {
        judge_page(&name, &text, &mut wrong);
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
