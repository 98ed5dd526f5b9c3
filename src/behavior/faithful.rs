//! The comparison of a plan's program with its tracks: a position-servo robot executes the program, and
//! the judge judges the tracks.

use super::conflict::conflicts;
use super::schedule::{Problem, Scheduled, Settings, schedule};
use super::tolerances::TOLERANCES;
use crate::plan::polynomial::elevated;
use crate::plan::{Failure, Plan, Track, Tracks};
use crate::units::{Dimension, quantity};

/// Schedules the program of a plan anew and compares the result with the plan's tracks. Returns a failure that names
/// the first difference, a conflict of the program, or the reason why it can't be scheduled; `None` if they are the
/// same up to rounding, causes and pieces in which nothing moves left out, and for a plan without a program or without
/// tracks.
pub fn unfaithful(plan: &Plan) -> Option<Failure> {
    let (Some(program), Some(tracks)) = (&plan.program, plan.body.tracks()) else { return None };
    let joints: Vec<_> = tracks.robot.joints().collect();
    if let Some(conflict) = conflicts(&program.root).errors.first() {
        let owner = joints.get(conflict.joint.0 as usize);
        let name = owner.map_or_else(String::new, |owner| tracks.robot.joint_name(*owner));
        return Some(Failure::form(format!("the program gives {name} two commands at one time")));
    }
    let problem = Problem {
        robot: tracks.robot.clone(),
        start: tracks.start.clone(),
        program: program.root.clone(),
        start_causes: vec![],
        bond_causes: vec![],
        settings: Settings::default(),
    };
    let played = match schedule(problem) {
        Ok(played) => played,
        Err(refusal) => {
            return Some(Failure::form(format!("the program can't be executed: {}", refusal.reason)));
        }
    };
    if played.nominal != plan.nominal {
        let word = if played.nominal { "depends" } else { "does not depend" };
        return Some(Failure::form(format!("the program {word} on sensors, and the file says otherwise")));
    }
    differs(&played, tracks).map(Failure::form)
}

/// Returns the first difference of two motions in words; `None` if they are the same up to rounding.
fn differs(played: &Scheduled, stated: &Tracks) -> Option<String> {
    let made = &played.tracks;
    if (made.duration - stated.duration).abs() > TOLERANCES.faithful {
        let time = |t| quantity(t, Dimension::TIME);
        let (made, stated) = (time(made.duration), time(stated.duration));
        return Some(format!("the program lasts {made}, the motion of the file {stated}"));
    }
    let same_docks = made.events.len() == stated.events.len()
        && made.events.iter().zip(&stated.events).all(|(a, b)| {
            let [one, other] = [&made.robot.bonds[a.bond], &stated.robot.bonds[b.bond]];
            let ports = (one.a, one.b) == (other.a, other.b) || (one.a, one.b) == (other.b, other.a);
            // Turns that depend on how robots stand are the judge's affair.
            let same = a.bond == b.bond || (ports && played.open_turns.contains(&a.bond));
            a.kind == b.kind && same && (a.time - b.time).abs() <= TOLERANCES.faithful
        });
    if !same_docks {
        return Some("the program docks or undocks otherwise than the motion of the file".to_owned());
    }
    let owners = stated.robot.joints().enumerate();
    for (joint, owner) in owners {
        let track = |tracks: &Tracks| tracks.tracks.iter().find(|t| t.joint.0 as usize == joint).cloned();
        let start = stated.start.joints[joint];
        if !same(track(made).as_ref(), track(stated).as_ref(), start) {
            let name = stated.robot.joint_name(owner);
            return Some(format!("the program moves {name} otherwise than the motion of the file"));
        }
    }
    None
}

/// Returns `true` where two tracks have the same segments, but for those that stand still.
fn same(a: Option<&Track>, b: Option<&Track>, start: f64) -> bool {
    let [a, b] = [a, b].map(|track| {
        let segments = track.map_or(&[][..], |t| &t.segments);
        let mut at = start;
        let mut moving = Vec::new();
        for segment in segments {
            if segment.control.iter().any(|q| (q - at).abs() > TOLERANCES.faithful) {
                moving.push(segment);
            }
            at = *segment.control.last().unwrap_or(&at);
        }
        moving
    });
    let near = |x: f64, y: f64| (x - y).abs() <= TOLERANCES.faithful * f64::max(1.0, x.abs());
    // A ramp is a polynomial of the second degree, and of the third where keyframes say it.
    let alike = |a: &[f64], b: &[f64]| {
        let degree = a.len().max(b.len()) - 1;
        elevated(a, degree).iter().zip(&elevated(b, degree)).all(|(x, y)| near(*x, *y))
    };
    a.len() == b.len()
        && a.iter()
            .zip(&b)
            .all(|(a, b)| near(a.start, b.start) && near(a.end, b.end) && alike(&a.control, &b.control))
}
