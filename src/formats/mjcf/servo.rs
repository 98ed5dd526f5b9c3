//! The servos of joints, from the facts of their modules, and the actuators that they make.

use super::tree::Trees;
use crate::formats::xml::{Attribute, Xml, number, numbers};
use crate::robot::Servo as Facts;

/// A position servo with damping, and the inertia of its rotor as the joint feels it.
#[derive(Clone, Copy, PartialEq)]
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

impl Servo {
    fn of_stiffness(class: &'static str, stiffness: f64) -> Servo {
        Servo {
            class,
            stiffness,
            damping: Facts::DAMPING_DEFAULT * stiffness,
            armature: Facts::ARMATURE_DEFAULT * stiffness,
        }
    }

    /// Returns the servo of joints of which nothing is stated.
    fn of_class(slides: bool) -> Servo {
        let (class, stiffness) = match slides {
            true => ("sliding", Facts::SLIDE_STIFFNESS_DEFAULT),
            false => ("turning", Facts::TURN_STIFFNESS_DEFAULT),
        };
        Servo::of_stiffness(class, stiffness)
    }
}

fn servo(trees: &Trees, joint: usize) -> Servo {
    let (stiffness, stated) = trees.servo(joint);
    let assumed = Servo::of_stiffness(Servo::of_class(trees.slides(joint)).class, stiffness);
    Servo { armature: stated.armature_with(stiffness), damping: stated.damping_with(stiffness), ..assumed }
}

/// Returns the attributes of a driven joint (an index in the robot's joints): its class, and its armature where that is
/// not the class's.
pub(super) fn attributes(trees: &Trees, joint: usize) -> Vec<Attribute<'static>> {
    let servo = servo(trees, joint);
    let mut attributes: Vec<Attribute> = vec![("class", servo.class.into())];
    if servo.armature != Servo::of_class(trees.slides(joint)).armature {
        attributes.push(("armature", number(servo.armature)));
    }
    attributes
}

/// Adds the default classes of servos, one for joints that turn and one for joints that slide: armature, stiffness and
/// damping.
pub(super) fn defaults(xml: &mut Xml) {
    for Servo { class, stiffness, damping, armature } in [Servo::of_class(false), Servo::of_class(true)] {
        xml.open("default", &[("class", class.into())]);
        xml.leaf("joint", &[("armature", number(armature))]);
        xml.leaf("position", &[("kp", number(stiffness)), ("kv", number(damping))]);
        xml.close("default");
    }
}

/// Adds the element `actuator` with a position actuator for each driven joint of the model, in the order of its joints.
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
        let (name, servo) = (trees.joint_name(joint), servo(trees, joint));
        let mut attributes: Vec<Attribute> =
            vec![("name", name.clone()), ("class", servo.class.into()), ("joint", name)];
        let class = Servo::of_class(trees.slides(joint));
        if (servo.stiffness, servo.damping) != (class.stiffness, class.damping) {
            attributes.push(("kp", number(servo.stiffness)));
            attributes.push(("kv", number(servo.damping)));
        }
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
