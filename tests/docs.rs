//! Every program in the documentation does what its page says.
//!
//! In `docs/` and in the standard library ` ```modl ` runs without a diagnostic, ` ```modl check ` is
//! only checked. On the page of an error ` ```modl ` raises exactly that error when it is checked,
//! ` ```modl run ` when it is run, and ` ```modl fine ` raises nothing when it is checked. A tag
//! ` ```modl NAME.mod ` adds a file to the program before it.

use crate::fences::{Fence, documentation, fences, files};
use crate::suite::MapFiles;
use modl::check::check;

/// Codes of what checking a program says, in order, each once.
fn checked(main: &str, extra: &[&Fence]) -> Vec<String> {
    let mut project = MapFiles::of(main);
    for fence in extra {
        let name = fence.modl().expect("an extra file is a program");
        project.0.insert(name.to_owned(), fence.code.as_bytes().to_vec());
    }
    let mut codes: Vec<String> =
        check(&project, "main.mod").diagnostics.iter().map(|d| d.code.to_string()).collect();
    codes.sort();
    codes.dedup();
    codes
}

/// Each program of a page with the extra files that follow it.
fn programs(all: &[Fence]) -> Vec<(&Fence, Vec<&Fence>)> {
    let mut found: Vec<(&Fence, Vec<&Fence>)> = Vec::new();
    for fence in all {
        match fence.modl() {
            Some(tag) if tag.ends_with(".mod") => {
                found
                    .last_mut()
                    .unwrap_or_else(|| panic!("{}: a file of no program", fence.place))
                    .1
                    .push(fence);
            }
            Some(_) => found.push((fence, Vec::new())),
            None => {}
        }
    }
    found
}

#[test]
fn examples_of_the_library_check() {
    let mut wrong = String::new();
    for (name, text) in files("stdlib", "mod") {
        let all = fences(&documentation(&text), &name);
        for (fence, extra) in programs(&all) {
            let codes = checked(&fence.code, &extra);
            if !codes.is_empty() {
                wrong.push_str(&format!("{}: {}\n", fence.place, codes.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "examples that do not check:\n{wrong}");
}
