//! Sliding down a slope: the friction that the weight of a robot at rest needs against that of its contacts.

use super::super::model::Model;
use super::equilibrium::Equilibrium;
use super::posed::Situation;
use super::tolerances::PARAMETERS;
use crate::geometry::Vec3;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, ExemptionKind, Failure};
use crate::robot::JointOwner;
use crate::units::{Dimension, quantity, rounded};
use std::collections::BTreeSet;

/// An instant at which the weight of a robot pulls it down a slope with more force than friction holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    /// The time of the instant, s.
    time: f64,
    /// The weight along the slope as a part of that along its normal: the tangent of its angle.
    needed: f64,
    /// The mean coefficient of friction of the contacts, weighted with their loads.
    friction: f64,
}

impl Slide {
    /// Returns the slide of a robot at rest on a slope, in the equilibrium that was found without momentum: friction does not
    /// hold its weight along the slope, or while no joint moves a loaded contact slides. `None` if it holds, or the ground is
    /// level.
    pub(super) fn of(time: f64, situation: &Situation, found: &Equilibrium) -> Option<Slide> {
        let loads = &found.loads.normal;
        let gives_way = found.slides || (is_still(situation) && !sticks(loads, &found.friction));
        let capacity: f64 = situation.candidates.iter().zip(loads).map(|(c, load)| c.friction * load).sum();
        let pressed: f64 = loads.iter().sum();
        let force = situation.base.force;
        (situation.sloped && gives_way).then(|| Slide {
            time,
            needed: libm::hypot(force.x, force.y) / force.z,
            friction: if pressed > 0.0 { capacity / pressed } else { 0.0 },
        })
    }

    /// Writes the failure of the first of some slides, in order of time, that no exemption excuses into the record.
    pub(super) fn judge(slides: &[Slide], ledger: &mut Ledger) {
        let of = |kind: &ExemptionKind| *kind == ExemptionKind::Traction;
        let mut excused = false;
        for slide in slides {
            if !ledger.excuses(CheckKind::Traction, slide.time, of) {
                ledger.fail(failure(slide.time, slide.needed, slide.friction));
                break;
            }
            excused = true;
        }
        if excused {
            ledger.note("the way down the slope while no joint moves is not followed".to_owned());
        }
    }
}

/// Returns the failure of a robot that slides down a slope from a time on (s): it needs a coefficient of friction, and has
/// another.
pub(in super::super) fn failure(time: f64, needed: f64, friction: f64) -> Failure {
    Failure {
        kind: CheckKind::Traction,
        time,
        until: None,
        at: vec![],
        message: format!(
            "the robot slides down the slope at {}: its weight needs a friction of {}, and has {}",
            quantity(time, Dimension::TIME),
            rounded(needed, 3),
            rounded(friction, 3)
        ),
        value: needed,
        limit: friction,
        blame: vec![],
        blames_start: false,
    }
}

/// Returns true for a robot on a slope whose joints do not move and whose loaded contacts do not slide: it stands, however
/// the friction of the model creeps. `loads`: the normal force at each candidate, N; `friction`: slip (m/s) and friction
/// (N) at each.
pub(super) fn stands(situation: &Situation, loads: &[f64], friction: &[(Vec3, Vec3)]) -> bool {
    situation.sloped && is_still(situation) && sticks(loads, friction)
}

/// Returns true if no joint moves.
fn is_still(situation: &Situation) -> bool {
    situation.posed.velocities.iter().all(|velocity| *velocity == 0.0)
}

/// Returns true if no loaded contact slides; the arguments are those of [`stands`].
fn sticks(loads: &[f64], friction: &[(Vec3, Vec3)]) -> bool {
    friction
        .iter()
        .zip(loads)
        .all(|((slip, _), load)| *load <= 0.0 || slip.norm() <= PARAMETERS.sliding_speed)
}

/// Returns the name of a joint without a motor beyond which one of some links, by their numbers, lies: on a slope it may let
/// the robot roll. `None` if there is none.
pub(in super::super) fn free_joint(model: &Model, bearing: &BTreeSet<usize>) -> Option<String> {
    let robot = model.robot;
    let owners: Vec<JointOwner> = robot.joints().collect();
    let free = |owner: &JointOwner| match *owner {
        JointOwner::Module { module, joint } => robot.module_type(module).joints[joint].passive,
        JointOwner::Bond(_) => false,
    };
    let steps = bearing.iter().flat_map(|link| model.kinematics.ancestors(*link));
    let joints = steps.flat_map(|step| step.terms()).map(|(joint, _)| owners[*joint]);
    joints.into_iter().find(free).map(|owner| robot.joint_name(owner))
}
