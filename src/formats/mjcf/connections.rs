//! Constraints besides the tree, which are bonds and joints that follow others; pairs that do not collide; the keyframe
//! of the start.

use super::bodies::site_names;
use super::tree::Trees;
use crate::formats::xml::{Attribute, Xml, numbers};

use std::collections::BTreeSet;

/// Adds the pairs of links that do not collide with each other: those that a joint or a bond joins, and those declared as
/// touching.
pub(super) fn exclusions(xml: &mut Xml, trees: &Trees) {
    let mut pairs = BTreeSet::new();
    for module in 0..trees.robot.modules.len() {
        let kind = trees.robot.module_type(module);
        let joined = kind.joints.iter().map(|joint| (joint.parent, joint.child));
        for (a, b) in joined.chain(kind.touching.iter().copied()) {
            pairs.insert((trees.start.link(module, a), trees.start.link(module, b)));
        }
    }
    for bond in &trees.robot.bonds {
        let [a, b] = [bond.a, bond.b].map(|port| trees.start.port_link(trees.robot, port));
        pairs.insert((a, b));
    }
    let pairs: BTreeSet<(usize, usize)> =
        pairs.into_iter().filter(|(a, b)| a != b).map(|(a, b)| (a.min(b), a.max(b))).collect();
    for (a, b) in pairs {
        xml.leaf("exclude", &[("body1", trees.link_name(a)), ("body2", trees.link_name(b))]);
    }
}

/// Adds the element `equality` with the constraints: joints that follow others, and bonds that are in no tree. `holds`:
/// for each bond of the robot, true if it is closed at the start.
pub(super) fn couplings(xml: &mut Xml, trees: &Trees, holds: &[bool]) {
    let mut sums: Vec<(String, Vec<(String, f64)>)> = Vec::new();
    xml.open("equality", &[]);
    let moved = trees.moved();
    let in_model: BTreeSet<usize> = moved.iter().map(|(joint, _)| *joint).collect();
    for (joint, link) in moved {
        let Some(step) = &trees.steps[link] else { continue };
        let name = trees.joint_name(joint);
        match step.terms() {
            [(same, _)] if *same == joint => {}
            [(followed, factor)] if in_model.contains(followed) => xml.leaf(
                "joint",
                &[
                    ("name", format!("{name}: follows")),
                    ("joint1", name),
                    ("joint2", trees.joint_name(*followed)),
                    ("polycoef", numbers([0.0, *factor, 0.0, 0.0, 0.0])),
                ],
            ),
            terms => {
                let terms = terms.iter().filter(|(followed, _)| in_model.contains(followed));
                let minus = terms.map(|(followed, factor)| (trees.joint_name(*followed), -factor));
                let sum = std::iter::once((name.clone(), 1.0)).chain(minus).collect();
                sums.push((format!("{name}: follows"), sum));
            }
        }
    }
    for (name, _) in &sums {
        let zero = numbers([0.0; 5]);
        xml.leaf("tendon", &[("name", name.clone()), ("tendon1", name.clone()), ("polycoef", zero)]);
    }
    for &bond in &trees.constraints {
        let pairs = site_names(trees, bond);
        let turns = pairs.len() > 1;
        if turns {
            xml.comment("A bond that turns; what drives it is left out.");
        }
        for (names, name) in pairs.into_iter().zip(constraint_names(trees, bond)) {
            let [first, second] = names;
            let attributes: Vec<Attribute> = vec![
                ("name", name),
                ("site1", first),
                ("site2", second),
                ("active", holds[bond].to_string()),
            ];
            xml.leaf(if turns { "connect" } else { "weld" }, &attributes);
        }
    }
    xml.close("equality");
    if sums.is_empty() {
        return;
    }
    xml.open("tendon", &[]);
    for (name, terms) in sums {
        xml.open("fixed", &[("name", name)]);
        for (joint, factor) in terms {
            xml.leaf("joint", &[("joint", joint), ("coef", numbers([factor]))]);
        }
        xml.close("fixed");
    }
    xml.close("tendon");
}

/// Returns the names of the constraints of a bond (an index in the robot's bonds): one, or two of a bond that turns.
pub(super) fn constraint_names(trees: &Trees, bond: usize) -> Vec<String> {
    let name = trees.robot.bond_name(bond);
    match trees.robot.hinge(bond) {
        Some(_) => vec![format!("{name}, low"), format!("{name}, high")],
        None => vec![name],
    }
}

/// Adds the keyframe `start`: positions and commands at the start of the plan. `held`: true if the base is fixed in the
/// world; `joints`: the position of each joint of the robot, rad or m.
pub(super) fn start(xml: &mut Xml, trees: &Trees, held: bool, joints: &[f64]) {
    let mut positions = Vec::new();
    let mut commands = Vec::new();
    let mut roots = trees.roots.iter().enumerate().map(|(index, root)| (index, *root));
    let mut root = roots.next();
    for link in trees.depth_first() {
        if let Some((index, (at, X_WR))) = root
            && at == link
        {
            root = roots.next();
            if !(held && index == 0) {
                let q = X_WR.rotation;
                positions.extend(X_WR.translation.vector.iter().chain(&[q.w, q.i, q.j, q.k]));
            }
        }
        let (Some(joint), Some(step)) = (trees.joint_of[link], &trees.steps[link]) else { continue };
        positions.push(step.position(joints));
        if trees.is_driven(joint) {
            commands.push(step.position(joints));
        }
    }
    let mut attributes: Vec<Attribute> = vec![("name", "start".into())];
    attributes.extend((!positions.is_empty()).then(|| ("qpos", numbers(positions))));
    attributes.extend((!commands.is_empty()).then(|| ("ctrl", numbers(commands))));
    xml.open("keyframe", &[]);
    xml.leaf("key", &attributes);
    xml.close("keyframe");
}
