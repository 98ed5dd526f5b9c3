//! Scenes, planned and judged.

use super::programs::{placed, plans_hold, ran};
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::project::Project;
use crate::fuzz::inputs::scenes;
use modl::interpret::Mode;

/// Returns a program with a scene.
pub fn input(dice: &mut Dice) -> Vec<u8> {
    scenes::scene(dice).into_bytes()
}

/// Elaborates a scene, then plans and judges it.
pub fn check(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let files = Project::of(&text);
    let checked = modl::check::check(&files, "main.mod");
    placed(&checked.diagnostics, &checked.sources);
    if checked.has_errors() {
        return;
    }
    for mode in [Mode::Check, Mode::Run] {
        let (desk, outcome) = ran(&checked, mode, &files);
        placed(&outcome.diagnostics, &checked.sources);
        plans_hold(&desk);
    }
}
