//! Programs made by a seeded generator: those that are valid by construction check and run; those
//! that were then damaged end with diagnostics, never with a panic.

use crate::fuzz::inputs::damage::damaged_tokens;
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::programs::program;
use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};

const VALID: u64 = 40;
const DAMAGED: u64 = 400;

fn options() -> Options {
    let mut options = Options::default();
    options.limits.steps = 200_000;
    options.limits.samples = 1_000;
    options.limits.list = 10_000;
    options.limits.modules = 500;
    options
}

#[test]
fn programs_that_are_right_check_and_run() {
    for seed in 0..VALID {
        let text = program(&mut Dice::new(seed));
        let files = MapFiles::of(&text);
        for mode in [Mode::Check, Mode::Run] {
            let ran = ran(&files, "main.mod", mode, &options());
            let errors: Vec<_> = ran.outcome.diagnostics.iter().filter(|d| d.is_error()).collect();
            assert!(errors.is_empty(), "seed {seed}, {mode:?}: {errors:#?}\n{text}");
            assert_eq!(ran.host.printed.len(), if mode == Mode::Run { 3 } else { 0 }, "seed {seed}\n{text}");
        }
    }
}

#[test]
fn programs_that_were_damaged_never_panic() {
    let mut refused = 0;
    for seed in 0..DAMAGED {
        let mut dice = Dice::new(1_000 + seed);
        let whole = program(&mut dice);
        let text = damaged_tokens(&mut dice, &whole);
        let mode = if seed % 2 == 0 { Mode::Run } else { Mode::Check };
        let ran = ran(&MapFiles::of(&text), "main.mod", mode, &options());
        refused += u64::from(ran.outcome.diagnostics.iter().any(|d| d.is_error()));
    }
    assert!(refused > DAMAGED / 4, "the damage is seen: {refused}");
}
