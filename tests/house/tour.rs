//! The tour: every listing is a file, every command is run on those before it, and prints what the page
//! says that it prints.
//!
//! ` ```modl NAME.mod ` is a file; ` ```modl NAME.mod OTHER.mod ` is the other file with more at its end.

use crate::desk::cli::Sandbox;
use crate::desk::transcripts::Transcript;
use crate::support::fences::fences;
use std::collections::BTreeSet;
use std::fs;

const TOUR: &str = include_str!("../../docs/tour.md");

#[test]
fn the_tour_can_be_followed_as_it_stands() {
    let sandbox = Sandbox::new(&[]);
    let mut unused = BTreeSet::new();
    let mut commands = 0;
    for fence in fences(TOUR, "docs/tour.md") {
        if let Some(names) = fence.modl() {
            let mut names = names.split_whitespace();
            let name = names.next().expect("a listing has a name");
            let before = names.next().map_or_else(String::new, |other| {
                fs::read_to_string(sandbox.path(other)).expect("the other file came before")
            });
            fs::write(sandbox.path(name), format!("{before}{}", fence.code)).expect("a file can be written");
            unused.insert(name.to_owned());
            continue;
        }
        let command = fence.code.strip_prefix("$ modl ").and_then(|rest| rest.split_once('\n'));
        let (command, printed) = command.unwrap_or_else(|| panic!("{}: no listing, no command", fence.place));
        let arguments: Vec<&str> = command.split(' ').collect();
        if arguments[0] == "repl" {
            Transcript::of(printed).judge(&sandbox, &arguments, &fence.place);
        } else {
            let ran = sandbox.run(&arguments);
            assert_eq!(format!("{}{}", ran.out, ran.err).trim(), printed.trim(), "{}", fence.place);
        }
        for argument in &arguments {
            unused.remove(*argument);
        }
        commands += 1;
    }
    assert!(unused.is_empty(), "nobody uses {unused:?}");
    assert!(commands >= 10, "only {commands} commands");
}
