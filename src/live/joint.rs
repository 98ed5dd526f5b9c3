//! The joints of a robot with their start positions, and where the text sets them.

use super::robot::{Place, place};
use crate::interpret::design::Design;
use crate::interpret::robot::Robot as Assembled;
use crate::robot::{JointKind, JointOwner, Limits};
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{ConfigClause, ConfigClauseKind};
use serde::Serialize;
use std::rc::Rc;

/// A joint that has a start position.
#[derive(Clone, Debug, Serialize)]
pub struct Joint {
    /// The path of the joint, as the text names it: `leg[2].m[0].tilt`, or `m[0].edge[1].joint` for one of a bond.
    pub name: String,
    /// The number of the joint among those of the picture.
    pub index: usize,
    /// The module that the joint belongs to, by its number; `None` for the joint of a bond.
    pub module: Option<usize>,
    /// True for a joint that turns.
    pub turns: bool,
    /// The start position, rad or m.
    pub value: f64,
    /// The range of positions, rad or m; `None` where none is stated.
    pub range: Option<(f64, f64)>,
    /// The reason why the page can't set the joint; `None` if it can.
    pub fixed: Option<String>,
    /// The place of the clause of the shown configuration that sets the joint; `None` if none does.
    pub place: Option<Place>,
    #[serde(skip)]
    pub(super) set: Option<Span>,
}

/// The place of a clause `set` in a configuration.
enum Depth {
    /// Between its braces.
    Top,
    /// In a loop or a branch.
    Inner,
    /// Somewhere else: in a configuration that is a part.
    Elsewhere,
}

/// Returns the joints of a robot that do not follow others. `clauses`: those of its configuration, which stands in `file`.
pub(super) fn joints(
    design: &Rc<Design>,
    robot: &Assembled,
    clauses: &[ConfigClause],
    file: &SourceFile,
) -> Vec<Joint> {
    let assembly = &robot.assembly;
    let sets = design.sets();
    let each = assembly.joints().enumerate().filter_map(|(index, owner)| {
        let (name, module, limits, turns): (String, Option<usize>, Limits, bool) = match owner {
            JointOwner::Module { module, joint } => {
                let declared = &assembly.module_type(module).joints[joint];
                if declared.kind == JointKind::Fixed || declared.mimic.is_some() {
                    return None;
                }
                let turns = declared.kind == JointKind::Revolute;
                (assembly.joint_name(owner), Some(module), declared.limits, turns)
            }
            JointOwner::Bond(bond) => {
                let port = assembly.bonds[bond].a;
                let kind = assembly.module_type(port.module);
                let hinge = assembly.library.connectors[kind.ports[port.port].connector].hinge.as_ref()?;
                let name =
                    format!("{}.{}.joint", assembly.modules[port.module].name, kind.ports[port.port].name);
                (name, None, hinge.limits, true)
            }
        };
        let last = sets.iter().rev().find(|set| set.joint == owner).map(|set| set.span);
        let depth = last.map_or(Depth::Elsewhere, |span| depth(clauses, span));
        let set = last.filter(|_| matches!(depth, Depth::Top));
        let inner = matches!(depth, Depth::Inner);
        let reason = || format!("`{name}` is set in a loop or a branch; it is changed in the text");
        Some(Joint {
            index,
            module,
            turns,
            value: robot.start.joints[index],
            range: limits.range,
            fixed: inner.then(reason),
            place: last.filter(|_| !matches!(depth, Depth::Elsewhere)).map(|span| place(file, span)),
            set,
            name,
        })
    });
    each.collect()
}

/// Returns where a clause stands, seen from the clauses of a configuration.
fn depth(clauses: &[ConfigClause], span: Span) -> Depth {
    let around = clauses.iter().find(|clause| clause.span.contains(span));
    match around.map(|clause| &clause.kind) {
        Some(ConfigClauseKind::Set { .. }) => Depth::Top,
        Some(_) => Depth::Inner,
        None => Depth::Elsewhere,
    }
}
