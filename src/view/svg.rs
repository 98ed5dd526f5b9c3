//! Drawings as SVG. The kind of drawing depends on the plan.

use super::input::RenderInput;
use super::{graph, layers, pattern, program};
use crate::plan::{Body, Node, Plan};

/// Returns a drawing: flat panels joined by hinges as their crease pattern, true to scale; a behaviour as
/// its series-parallel graph; a configuration as a graph of modules; a lattice or truss plan stage by
/// stage.
pub fn svg(input: &RenderInput) -> String {
    match &input.plan.body {
        Body::Tracks(tracks) => match pattern::pattern(input, tracks) {
            Some(drawing) => drawing,
            None if acts(input.plan) => program::program(input, tracks),
            None => graph::graph(input, tracks),
        },
        Body::Stages(stages) => layers::lattice(input, stages),
        Body::NodePaths(paths) => layers::truss(input, paths),
    }
}

/// Returns true if a plan has a program with at least one action.
fn acts(plan: &Plan) -> bool {
    let root = plan.program.as_ref().map(|program| &*program.root);
    root.is_some_and(|root| !matches!(root, Node::Series(list) if list.is_empty()))
}
