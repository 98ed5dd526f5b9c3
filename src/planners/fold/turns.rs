//! Turns of hinges: how far each hinge turns in each step of a folding, also where it stops on its way.

use super::layout::Layout;
use super::target::Target;

/// A stop of a hinge on its way: it ends a step short of its fold angle, and goes on in a later step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The index of the step at whose end the hinge stops, from 0.
    pub step: usize,
    /// The face whose hinge to its parent it is, as an index in [`Target::faces`].
    pub face: usize,
    /// The angle at which the hinge stops, rad: between 0, level, and its fold angle.
    pub angle: f64,
}

/// A turn of a hinge in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The face whose hinge to its parent turns, as an index in [`Target::faces`].
    pub face: usize,
    /// The angle of the hinge when the step begins, rad.
    pub from: f64,
    /// The angle of the hinge when the step ends, rad.
    pub to: f64,
}

/// Returns the turns of each step of a folding, in the order of `steps`, each a list of faces (indices in
/// [`Target::faces`]). A hinge turns to its fold angle in the one step that names its face; a face whose hinge has a
/// stop among `stops` is named by a later step again. `target` and `layout`: the surface and how it is unfolded. Panics
/// if a step names no face of the target.
pub fn turns(target: &Target, layout: &Layout, steps: &[Vec<usize>], stops: &[Stop]) -> Vec<Vec<Turn>> {
    let mut angles = vec![0.0; layout.parent.len()];
    let in_step = |(step, faces): (usize, &Vec<usize>)| {
        let turn = |&face: &usize| {
            let stop = stops.iter().find(|stop| (stop.step, stop.face) == (step, face));
            let to = stop.map_or_else(|| layout.angle(target, face), |stop| stop.angle);
            Turn { face, from: std::mem::replace(&mut angles[face], to), to }
        };
        faces.iter().map(turn).collect()
    };
    steps.iter().enumerate().map(in_step).collect()
}

/// Returns the angle of every hinge after the first `done` of these steps, by face, rad; that of the root is 0.
/// `faces`: the number of faces.
pub fn angles_after(turns: &[Vec<Turn>], done: usize, faces: usize) -> Vec<f64> {
    let mut angles = vec![0.0; faces];
    turns[..done].iter().flatten().for_each(|turn| angles[turn.face] = turn.to);
    angles
}
