//! The program that executes given tracks by the clock: for plans that were reversed or cut, and for planned
//! ones.

use super::motion::{DockingKind, Segment, Track, Tracks};
use crate::plan::cause::CauseId;
use crate::plan::operation_error::OperationError;
use crate::plan::program::{Action, Command, Node, Otherwise, Profile, Target};
use crate::robot::JointId;
use std::sync::Arc;

/// Returns the program that makes the joints move as the tracks state: a series for every joint and one for docking,
/// in parallel. Each action lasts exactly as long as its segment; gaps are waits.
///
/// # Errors
/// [`OperationError::NoCommand`] for a segment of degree above 3 that is not a smooth move.
pub fn timeline(tracks: &Tracks) -> Result<Arc<Node>, OperationError> {
    let mut branches = Vec::with_capacity(tracks.tracks.len() + 1);
    for track in &tracks.tracks {
        branches.push(joint(track)?);
    }
    if !tracks.events.is_empty() {
        branches.push(docking(tracks));
    }
    // A motion without tracks takes its time, too.
    branches.push(wait(tracks.duration));
    Ok(Arc::new(Node::Parallel(branches)))
}

fn joint(track: &Track) -> Result<Arc<Node>, OperationError> {
    let mut now = 0.0;
    let mut series = Vec::with_capacity(track.segments.len());
    for segment in &track.segments {
        if segment.start > now {
            series.push(wait(segment.start - now));
        }
        series.push(action(command(track.joint, segment)?, segment.cause));
        now = segment.end;
    }
    Ok(Arc::new(Node::Series(series)))
}

fn command(joint: JointId, segment: &Segment) -> Result<Command, OperationError> {
    let duration = segment.end - segment.start;
    let moved = |profile| Command::Move {
        joint,
        target: Target::To(segment.last()),
        duration: Some(duration),
        profile,
    };
    match segment.control[..] {
        [_, _] => Ok(moved(Profile::Linear)),
        [a, b, c, d, e, f] if a == b && b == c && d == e && e == f => Ok(moved(Profile::Smooth)),
        // Up to the third degree a piece is the cubic between its ends' positions and velocities.
        [_, _, _] | [_, _, _, _] => {
            let keyframe = |t: f64, at: f64| [t - segment.start, at, segment.velocity(t)];
            let keyframes =
                vec![keyframe(segment.start, segment.control[0]), keyframe(segment.end, segment.last())];
            Ok(Command::Follow { joint, keyframes })
        }
        _ => Err(OperationError::NoCommand { from: segment.start, to: segment.end }),
    }
}

fn docking(tracks: &Tracks) -> Arc<Node> {
    let mut now = 0.0;
    let mut series = Vec::with_capacity(tracks.events.len());
    for dock in &tracks.events {
        if dock.time > now {
            series.push(wait(dock.time - now));
            now = dock.time;
        }
        let bond = tracks.robot.bonds[dock.bond];
        let command = match dock.kind {
            DockingKind::Dock => Command::Dock { a: bond.a, b: bond.b },
            DockingKind::Undock => Command::Undock { port: bond.b },
        };
        series.push(action(command, dock.cause));
    }
    Arc::new(Node::Series(series))
}

/// Returns an action that waits; it has no cause of its own, since nothing moves by it.
fn wait(duration: f64) -> Arc<Node> {
    action(Command::Wait { duration }, CauseId(0))
}

fn action(command: Command, cause: CauseId) -> Arc<Node> {
    Arc::new(Node::Action(Action {
        command,
        until: None,
        timeout: None,
        otherwise: Otherwise::Proceed,
        cause,
    }))
}
