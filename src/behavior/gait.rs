//! Gaits: cyclic behaviours that run side by side, shifted against each other.

use crate::plan::{CauseId, Node};
use std::sync::Arc;

/// Returns a gait: behaviours that run side by side for `times` rounds of `period` seconds. `bodies`: each cyclic
/// behaviour with the phase (0 to 1) of its cycle at which it begins. All are brought to their beginnings before the
/// first round, so that the rounds begin together. Nothing is checked here: [`schedule`](super::schedule()) refuses
/// bad numbers and behaviours that are not cyclic. `cause`: that of the nodes that are added.
pub fn cycle(bodies: &[(Arc<Node>, f64)], period: f64, times: u64, cause: CauseId) -> Node {
    let stretched =
        |body: &Arc<Node>| Arc::new(Node::Stretch { body: body.clone(), duration: period, cause });
    let bodies: Vec<(Arc<Node>, f64)> =
        bodies.iter().map(|(body, shift)| (stretched(body), *shift)).collect();
    let approach = |(body, shift): &(Arc<Node>, f64)| {
        Arc::new(Node::Approach { body: body.clone(), shift: *shift, cause })
    };
    let rounds = |(body, shift): &(Arc<Node>, f64)| {
        let round = Arc::new(Node::Phase { body: body.clone(), shift: *shift, cause });
        Arc::new(Node::Repeat { body: round, times, until: None })
    };
    let begin = Arc::new(Node::Parallel(bodies.iter().map(approach).collect()));
    let go_on = Arc::new(Node::Parallel(bodies.iter().map(rounds).collect()));
    Node::Series(vec![begin, go_on])
}
