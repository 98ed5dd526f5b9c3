//! Sessions: entries and commands, one after the other.

use super::corpus::{CORPUS, is_quick};
use super::damage::damaged;
use super::dice::Dice;
use super::{files, programs};

/// The commands, as they are typed.
const COMMANDS: &[&str] = &[
    ":undo",
    ":undo",
    ":reset",
    ":reload",
    ":vars",
    ":load hinge.mod",
    ":load none.mod",
    ":save",
    ":type x",
    ":type r",
    ":type [1, n",
    ":doc Hinge",
    ":doc move",
    ":doc f",
    ":source Robot",
    ":source _",
    ":source Face",
    ":call move(",
    ":call f",
    ":what r",
];

/// A file that sessions load.
pub const HINGE: &str = "\
/// A single hinge.
module Hinge(length: Length = 40mm) {
  mass 150g
  link base = box(length, 40mm, 40mm)
  link tip = box(length, 40mm, 40mm) at [length + 20mm, 0mm, 0mm]
  joint bend: base -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s) at [length / 2 + 10mm, 0mm, 0mm]
  port back: Face on base at [-length / 2, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [length / 2, 0mm, 0mm] facing +X up +Z
}

connector Face { mates Face, turns 4 }
";

/// Returns the entries of a session, each behind a line `=== entry`.
pub fn session(dice: &mut Dice) -> Vec<u8> {
    let pieces = pieces(&programs::program(dice));
    let mut next = 0;
    let mut entries = Vec::new();
    for _ in 0..1 + dice.below(8) {
        let entry = match dice.below(8) {
            // Most of a program that is right, in its order.
            0..3 if next < pieces.len() => {
                next += 1;
                pieces[next - 1].clone()
            }
            3 => COMMANDS[dice.below(COMMANDS.len())].to_owned(),
            4 => {
                let case = &CORPUS.quick[dice.below(CORPUS.quick.len())];
                let found = self::pieces(case);
                if found.is_empty() { case.clone() } else { found[dice.below(found.len())].clone() }
            }
            5 => CORPUS.quick[dice.below(CORPUS.quick.len())].clone(),
            _ => CORPUS.entries[dice.below(CORPUS.entries.len())].clone(),
        };
        let entry = if dice.below(4) == 0 { damaged(dice, &entry) } else { entry };
        if is_quick(&entry) {
            entries.push(entry);
        }
    }
    let all: Vec<(&str, &[u8])> = entries.iter().map(|entry| ("entry", entry.as_bytes())).collect();
    files::joined(&all)
}

/// Returns the pieces of a program that begin at the margin.
fn pieces(text: &str) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    for line in text.lines() {
        match pieces.last_mut() {
            Some(last) if line.starts_with([' ', '}', ']', ')']) => {
                last.push('\n');
                last.push_str(line);
            }
            _ if line.trim().is_empty() => {}
            _ => pieces.push(line.to_owned()),
        }
    }
    pieces
}
