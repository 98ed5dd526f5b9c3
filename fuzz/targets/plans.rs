//! Plan files, read and judged.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::plans::{self, ARTICULATED, LATTICE, TRUSS};
use modl::behavior::unfaithful;
use modl::plan::time::tick_near;
use modl::plan::verify::verify;
use modl::plan::{Plan, file};
use modl::plan::{joined, reversed, sliced};

/// Returns a plan file of a robot with joints.
pub fn articulated(dice: &mut Dice) -> Vec<u8> {
    plans::altered(&ARTICULATED, dice)
}

/// Returns a plan file of a lattice.
pub fn lattice(dice: &mut Dice) -> Vec<u8> {
    plans::altered(&LATTICE, dice)
}

/// Returns a plan file of a truss.
pub fn truss(dice: &mut Dice) -> Vec<u8> {
    plans::altered(&TRUSS, dice)
}

/// Reads a plan file. A plan that is read is written and read the same, judged, reversed, cut and repeated.
pub fn check(input: &[u8]) {
    let Ok(plan) = file::read(&String::from_utf8_lossy(input)) else { return };
    same_again(&plan, "the plan");
    let verdict = verify(&plan);
    let _ = unfaithful(&plan);
    let duration = plan.body.duration();
    let back = reversed(&plan);
    let part = sliced(&plan, duration / 3.0, duration / 2.0);
    if is_exact(&plan) {
        same_again(&back, "the reversed plan");
        part.iter().for_each(|part| same_again(part, "a part of the plan"));
    }
    drop(joined(&plan, &back));
    let mut judged = plan;
    judged.verdict = Some(verdict);
    same_again(&judged, "the plan with its verdict");
}

/// Checks that a plan is written and read the same.
fn same_again(plan: &Plan, what: &str) {
    // Numbers that overflow can't be written, and are refused.
    let Ok(text) = file::write(plan) else { return };
    let again = match file::read(&text) {
        Ok(again) => again,
        Err(error) => panic!("{what} was written, and is refused: {error}"),
    };
    // Of a verdict, nothing is read that is not written.
    assert!(plan.verdict.is_some() || again == *plan, "{what} was written, and is read as another");
    assert!(file::write(&again).as_ref() == Ok(&text), "{what} is another text when it is written again");
}

/// Returns true for a plan whose times are whole ticks and whose positions are less than a million radians or metres, as
/// those of all planners are: others are not reversed and cut exactly.
fn is_exact(plan: &Plan) -> bool {
    let is_tick = |time: f64| tick_near(time) == time;
    let Some(tracks) = plan.body.tracks() else { return true };
    let mut positions =
        tracks.tracks.iter().flat_map(|track| &track.segments).flat_map(|segment| &segment.control);
    tracks.instants().into_iter().all(is_tick) && positions.all(|position| position.abs() < 1e6)
}
