//! Sessions, entry by entry.

use super::programs::{options, placed};
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::files::parted;
use crate::fuzz::inputs::project::{Desk, Project};
use crate::fuzz::inputs::sessions;
use modl::interpret::session::Shown;
use modl::session::entry::{goes_on, is_given_up, is_incomplete};
use modl::session::{Input, Reply, Session};
use std::sync::Arc;

/// Returns the entries of a session.
pub fn input(dice: &mut Dice) -> Vec<u8> {
    sessions::session(dice)
}

/// Enters what the input says.
pub fn check(input: &[u8]) {
    let mut desk = Desk::default();
    let mut project = Project::default();
    project.0.insert("hinge.mod".to_owned(), sessions::HINGE.as_bytes().to_vec());
    let mut session = Session::new(Arc::new(project), options(), &desk).expect("there is memory");
    let mut sound = true;
    for (_, entry) in parted(input) {
        let entry = entry.trim_end();
        let before = session.vars();
        let reply = match entry.strip_prefix(':') {
            Some(command) => {
                let (word, rest) = command.split_once(' ').unwrap_or((command, ""));
                act(&mut session, word, rest, &mut desk)
            }
            None => {
                let _ = (is_incomplete(entry), is_given_up(entry), goes_on(entry));
                let input =
                    Input { text: entry, name: "<stdin>", first_line: 1, shown: Shown::All, keep: true };
                Some(session.enter(&input, &mut desk))
            }
        };
        if let Some(reply) = reply {
            let defect = reply.notes.iter().find(|note| note.contains("defect of modl"));
            assert!(defect.is_none(), "the evaluator panicked");
            placed(&reply.diagnostics, &reply.checked.sources);
            placed(&reply.broken, &reply.checked.sources);
            assert!(
                reply.ok || before == session.vars(),
                "an entry that failed changed the session: {entry}"
            );
            sound &= reply.broken.is_empty();
        }
    }
    saved(&session, sound);
}

/// Executes a command.
fn act(session: &mut Session, word: &str, rest: &str, desk: &mut Desk) -> Option<Reply> {
    match word {
        "undo" => drop(session.undo(desk)),
        "reset" => session.reset(desk),
        "reload" => return Some(session.reload(desk).reply),
        "load" => return Some(session.load(rest, desk)),
        "type" => drop(session.type_of(rest)),
        "doc" => drop(session.doc(rest)),
        "source" => drop(session.source(rest)),
        "call" => drop(session.call_of(rest)),
        "what" => return Some(session.repertoire(rest, desk).0),
        _ => saved(session, false),
    }
    None
}

/// Checks that what was entered is a program: it is formatted, and has no errors unless an entry broke an earlier one.
fn saved(session: &Session, sound: bool) {
    let text = session.program();
    super::texts::format(text.as_bytes());
    let mut project = Project::of(&text);
    project.0.insert("hinge.mod".to_owned(), sessions::HINGE.as_bytes().to_vec());
    let checked = modl::check::check(&project, "main.mod");
    let errors: Vec<_> = checked.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(!sound || errors.is_empty(), "what is saved has errors: {errors:#?}\n{text}");
}
