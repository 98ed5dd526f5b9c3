//! Gaits: cyclic behaviours shifted against each other, and tables of positions.

use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target};
use crate::robot::JointId;
use std::sync::Arc;

/// A cyclic behaviour begun at `shift` (0..1) of its cycle. The joints are first brought to where that
/// is, if they are elsewhere.
pub fn phase(body: Arc<Node>, shift: f64, cause: CauseId) -> Arc<Node> {
    Arc::new(Node::Phase { body, shift, cause })
}

/// Behaviours that run side by side, `times` rounds, each begun at its own phase (0..1). `period` (s)
/// is how long a round lasts; `None`: as long as each does by itself. All are brought to their
/// beginnings before the first round, so that the rounds begin together.
pub fn cycle(bodies: &[(Arc<Node>, f64)], period: Option<f64>, times: u64, cause: CauseId) -> Arc<Node> {
    let round = |body: &Arc<Node>| match period {
        Some(duration) => Arc::new(Node::Stretch { body: body.clone(), duration, cause }),
        None => body.clone(),
    };
    let bodies: Vec<(Arc<Node>, f64)> = bodies.iter().map(|(body, shift)| (round(body), *shift)).collect();
    let approach = |(body, shift): &(Arc<Node>, f64)| {
        Arc::new(Node::Approach { body: body.clone(), shift: *shift, cause })
    };
    let rounds = |(body, shift): &(Arc<Node>, f64)| {
        Arc::new(Node::Repeat { body: phase(body.clone(), *shift, cause), times })
    };
    let begin = Arc::new(Node::Parallel(bodies.iter().map(approach).collect()));
    let go_on = Arc::new(Node::Parallel(bodies.iter().map(rounds).collect()));
    Arc::new(Node::Series(vec![begin, go_on]))
}

/// An entry of a table: where a joint is to go, and what wrote it; `None` leaves the joint.
pub type Entry = Option<(f64, CauseId)>;

/// Rows of positions, one for each joint, reached smoothly one row after the other in `step` seconds
/// each. A row shorter than the list of joints leaves the rest.
pub fn table(joints: &[JointId], step: f64, rows: &[Vec<Entry>], cause: CauseId) -> Arc<Node> {
    let action = |command, cause| {
        let otherwise = Otherwise::Proceed;
        Arc::new(Node::Action(Action { command, until: None, timeout: None, otherwise, cause }))
    };
    let row = |entries: &Vec<Entry>| {
        let moves = joints.iter().zip(entries).filter_map(|(&joint, entry)| {
            let (position, cause) = (*entry)?;
            let target = Target::To(position);
            Some(action(
                Command::Move { joint, target, duration: Some(step), profile: Profile::Smooth },
                cause,
            ))
        });
        // A row that moves nothing takes its time all the same.
        let pause = action(Command::Wait { duration: step }, cause);
        Arc::new(Node::Parallel(moves.chain([pause]).collect()))
    };
    Arc::new(Node::Series(rows.iter().map(row).collect()))
}
