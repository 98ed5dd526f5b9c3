//! Drawings as SVG, of a kind that depends on the plan.

use super::input::RenderInput;
use super::{graph, layers, pattern, program};
use crate::plan::{Body, Node, Plan};

/// Returns a drawing of a plan as the text of an SVG file. Flat panels joined by hinges are drawn as their crease
/// pattern, true to scale; another plan with actions as its series-parallel graph; one without as the graph of its
/// modules and bonds at the start; a lattice or truss plan stage by stage.
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
