//! The servos of joints: stated values that modules do not have yet, and the actuators that they make.

use super::tree::Trees;
use super::xml::{Attribute, Xml, number, numbers};
use crate::robot::Joint;

/// A position servo with damping, and the inertia of its rotor as the joint feels it.
struct Servo {
    /// The name of its class in the model.
    class: &'static str,
    /// Stiffness, N·m/rad or N/m.
    stiffness: f64,
    /// Damping, N·m·s/rad or N·s/m.
    damping: f64,
    /// Armature, kg·m² or kg.
    armature: f64,
}

/// The servo of joints that turn.
const TURNING: Servo =
    Servo { class: "turning", stiffness: Joint::TURN_STIFFNESS_DEFAULT, damping: 6.0, armature: 2e-3 };
/// The servo of joints that slide: that of joints that turn at a lever of 0.1 m.
const SLIDING: Servo =
    Servo { class: "sliding", stiffness: Joint::SLIDE_STIFFNESS_DEFAULT, damping: 600.0, armature: 0.2 };

fn servo(trees: &Trees, joint: usize) -> &'static Servo {
    if trees.slides(joint) { &SLIDING } else { &TURNING }
}

/// Returns the name of the class of a driven joint.
pub(super) fn class(trees: &Trees, joint: usize) -> &'static str {
    servo(trees, joint).class
}

/// Adds the classes of servos.
pub(super) fn defaults(xml: &mut Xml) {
    for Servo { class, stiffness, damping, armature } in [TURNING, SLIDING] {
        xml.open("default", &[("class", class.into())]);
        xml.leaf("joint", &[("armature", number(armature))]);
        xml.leaf("position", &[("kp", number(stiffness)), ("kv", number(damping))]);
        xml.close("default");
    }
}

/// Adds an actuator for each driven joint of the model, in the order of its joints.
pub(super) fn actuators(xml: &mut Xml, trees: &Trees) {
    xml.open("actuator", &[]);
    let mut noted = vec![false; trees.robot.library.modules.len()];
    for (joint, link) in trees.moved() {
        let kind = trees.kind(link).0;
        if !std::mem::replace(&mut noted[kind], true) {
            coupled(xml, trees, kind);
        }
        if !trees.is_driven(joint) {
            continue;
        }
        let name = trees.joint_name(joint);
        let mut attributes: Vec<Attribute> =
            vec![("name", name.clone()), ("class", class(trees, joint).into()), ("joint", name)];
        if let Some(range) = trees.range(joint) {
            attributes.push(("ctrlrange", numbers(range)));
        }
        if let Some(effort) = trees.limits(joint).effort {
            attributes.push(("forcerange", numbers([-effort, effort])));
        }
        xml.leaf("position", &attributes);
    }
    xml.close("actuator");
}

/// Adds a comment on the motors of a module type that drive several joints together.
fn coupled(xml: &mut Xml, trees: &Trees, kind: usize) {
    let kind = &trees.robot.library.modules[kind];
    for motor in &kind.motors {
        let term =
            |(joint, factor): &(usize, f64)| format!("{} {}", number(*factor), kind.joints[*joint].name);
        let sum: Vec<String> = motor.joints.iter().map(term).collect();
        let effort =
            motor.limits.effort.map_or(String::new(), |effort| format!(", at most {}", number(effort)));
        xml.comment(&format!(
            "{}: the motor {} drives {}{effort}; here each joint has an actuator of its own.",
            kind.name,
            motor.name,
            sum.join(" + ")
        ));
    }
}
