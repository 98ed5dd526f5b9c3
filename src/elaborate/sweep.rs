//! Joints swept through their range: links that meet within it.

use crate::check::typed::{DefId, DefKind};
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Solid, distance};
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::robot::{Joint, JointKind, ModuleType};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The number of positions at which a joint is sampled: every 5 degrees of a full turn.
const POSITIONS: usize = 72;

/// The deepest overlap of the two links of a joint.
struct Overlap {
    /// The position of the joint, rad or m.
    position: f64,
    /// The penetration depth, m.
    depth: f64,
}

impl Interpreter<'_> {
    /// Warns of joints whose two links overlap at one of `POSITIONS` + 1 sampled positions of the joint's range,
    /// deeper than at position 0 by more than the module's `touch` (m). Designs other than modules give no warning.
    ///
    /// # Errors
    /// None: the result is always `Ok`.
    pub(super) fn check_sweep(&mut self, def: DefId, design: &Rc<Design>) -> Eval<()> {
        let program = self.shared.program;
        let (DefKind::Module(declared), Some(module)) = (&program.def(def).kind, design.module()) else {
            return Ok(());
        };
        let module = &module.module;
        for (joint, declared) in module.joints.iter().zip(&declared.joints) {
            let Some(overlap) = sweep(module, joint) else { continue };
            let (parent, child) = (&module.links[joint.parent].name, &module.links[joint.child].name);
            let at = quantity(overlap.position, declared.dimension);
            let depth = quantity(overlap.depth, Dimension::LENGTH);
            let message =
                format!("`{parent}` and `{child}` overlap by {depth} where `{}` is at {at}", joint.name);
            self.add_report(
                Diagnostic::warning(code::JOINT_OVERLAP, message)
                    .label(declared.span, "within the range of this joint")
                    .hint(format!("narrow the range or the shapes, or write `touching {parent} {child}`")),
            );
        }
        Ok(())
    }
}

/// Returns the deepest overlap of the links of a joint at 73 positions over its range; `None` if it is no
/// deeper than allowed, and for joints that are fixed, follow others, or join links that may touch.
fn sweep(module: &ModuleType, joint: &Joint) -> Option<Overlap> {
    let pair = (joint.parent, joint.child);
    let exempt = module.touching.iter().any(|&(a, b)| (a, b) == pair || (b, a) == pair);
    if exempt || joint.mimic.is_some() || joint.kind == JointKind::Fixed {
        return None;
    }
    let solid = |link: usize| Solid::new(&module.links[link].collides).ok();
    let (parent, child) = (solid(joint.parent)?, solid(joint.child)?);
    let depth = |q: f64| {
        let (at_parent, at_child) =
            (module.links[joint.parent].pose, moved(joint, q) * module.links[joint.child].pose);
        -distance::distance_of_solids(&parent, &at_parent, &child, &at_child)
    };
    let allowed = depth(0.0).max(0.0) + module.touch;
    let (low, high) = joint.limits.range.unwrap_or((0.0, std::f64::consts::TAU));
    let positions = (0..=POSITIONS).map(|k| low + (high - low) * k as f64 / POSITIONS as f64);
    let worst = positions.map(|q| Overlap { position: q, depth: depth(q) });
    let worst = worst.max_by(|a, b| a.depth.total_cmp(&b.depth))?;
    (worst.depth > allowed).then_some(worst)
}

/// Returns the pose of the child in the module's frame at a joint position.
fn moved(joint: &Joint, q: f64) -> Pose {
    let motion = match joint.kind {
        JointKind::Revolute => turned(joint.axis, q),
        JointKind::Prismatic => shifted(joint.axis * q),
        JointKind::Fixed => Pose::identity(),
    };
    joint.pose * motion * joint.pose.inverse()
}
