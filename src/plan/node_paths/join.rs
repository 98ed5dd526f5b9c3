//! Node paths one after the other.

use super::limits::{Margins, TrussLimits};
use super::motion::{Keyframe, NodePaths};
use super::topology::TopologyEvent;
use crate::plan::cause::CauseId;
use crate::plan::operation_error::OperationError;
use crate::plan::time::tick_after;
use crate::plan::tolerances::TOLERANCES;

/// Returns the paths of `a` followed by those of `b`, whose causes are numbered from `causes` on.
///
/// # Errors
/// [`OperationError`] for trusses that differ in their struts where they meet, in their surroundings, or in the positions of their
/// nodes where they meet.
pub(in crate::plan) fn joined(
    a: &NodePaths,
    b: &NodePaths,
    causes: u32,
) -> Result<NodePaths, OperationError> {
    let meets = a.topology_at_end();
    if meets != b.topology_at_start() {
        let same = a.struts.len() == b.struts.len() && a.node_names.len() == b.node_names.len();
        let merges = !(a.events.is_empty() && a.merged.is_empty() && b.merged.is_empty());
        return Err(if same && merges {
            OperationError::Topologies
        } else {
            OperationError::Trusses { node: None }
        });
    }
    let at = tick_after(a.duration());
    let (end, start) = (a.state(at), b.state(0.0));
    let differ =
        |p: &[f64; 3], q: &[f64; 3]| p.iter().zip(q).any(|(x, y)| (x - y).abs() > TOLERANCES.join_node);
    if let Some(node) = end.iter().zip(&start).position(|(p, q)| differ(p, q)) {
        return Err(OperationError::Trusses { node: Some(a.node_names[node].clone()) });
    }
    if a.surroundings != b.surroundings {
        return Err(OperationError::Surroundings);
    }
    let mut new = a.clone();
    // Each part keeps its own limits; the whole states limits only if both have the same.
    if a.limits != b.limits {
        new.limits = TrussLimits::default();
    }
    let margins = |margins: Margins| if a.limits == b.limits { margins } else { Margins::default() };
    new.keyframes.iter_mut().for_each(|keyframe| keyframe.margins = margins(keyframe.margins));
    new.keyframes.extend(b.keyframes.iter().skip(1).map(|k| Keyframe {
        time: k.time + at,
        cause: CauseId(k.cause.0 + causes),
        margins: margins(k.margins),
        ..k.clone()
    }));
    new.events.extend(b.events.iter().map(|event| TopologyEvent {
        // The first keyframe of the second plan is the last of the first.
        time: if event.time == 0.0 { a.duration() } else { event.time + at },
        cause: CauseId(event.cause.0 + causes),
        ..event.clone()
    }));
    Ok(new)
}
