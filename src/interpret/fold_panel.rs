//! What `fold` is given: the panel and the shape, checked.

use super::call::Call;
use super::design::Design;
use super::stop::{Eval, Stop};
use super::value::Value;
use crate::planners::fold::{Target, Unfoldable};
use crate::source::{Diagnostic, code};
use std::rc::Rc;

/// How far sides may be off those of the panels, as a part of them.
const TOL_SIDE: f64 = 1e-6;

/// What a triangular panel is to the planner.
pub struct Panel {
    pub design: Rc<Design>,
    /// kg
    pub mass: f64,
    /// m
    pub side: f64,
}

impl Panel {
    /// The module in argument `index`.
    pub fn of(call: &Call, index: usize) -> Eval<Panel> {
        let design = call.instance(index)?.design.clone();
        let no_panel = |why: &str| call.refuse(index, format!("no triangular panel: {why}"));
        let Some(module) = design.module() else { return Err(no_panel("a module is wanted")) };
        let kind = &module.module;
        let [a, b, c] = &kind.ports[..] else { return Err(no_panel("it needs one port for each edge")) };
        if kind.links.len() != 1 {
            return Err(no_panel("it has more than one link"));
        }
        // From the middle of one edge to those of the others it is half a side.
        let middle = |port: &crate::robot::Port| port.pose.translation.vector;
        let halves = [(a, b), (b, c), (c, a)].map(|(p, q)| (middle(q) - middle(p)).norm());
        let side = 2.0 * halves[0];
        if halves.iter().any(|half| (2.0 * half - side).abs() > TOL_SIDE * side) {
            return Err(no_panel("its ports are not at the middles of equal edges"));
        }
        Ok(Panel { mass: kind.links[0].mass, side, design: design.clone() })
    }
}

/// The shape in argument `index`; `module` is where the panel was given.
pub fn target(call: &Call, index: usize, module: usize, panel: &Panel) -> Eval<Target> {
    let Value::Mesh(mesh) = call.arg(index) else { return Err(call.refuse(index, "a mesh is wanted")) };
    let unfoldable = |why: Unfoldable| -> Stop {
        let mut said =
            Diagnostic::error(code::UNFOLDABLE, why.to_string()).label(call.at(index), "does not fold");
        if let Unfoldable::UnequalSides { .. } = why {
            said = said
                .label(call.at(module), "these panels")
                .hint("give the mesh and the module the same side");
        }
        said.into()
    };
    let target = Target::new(mesh.vertices.clone(), &mesh.faces).map_err(unfoldable)?;
    target.check_sides(panel.side, TOL_SIDE * panel.side).map_err(unfoldable)?;
    Ok(target)
}
