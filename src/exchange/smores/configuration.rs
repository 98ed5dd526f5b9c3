//! `.conf` files: the modules of a robot with their places and joints, and what is connected.
//!
//! The tools' module frame lies on the block that carries the top face: x to the left, y to the back, z up. Its pose is six
//! numbers, the last three roll, pitch and yaw, or seven, the last four a quaternion with its real part first. Joints stand in
//! the order front, left, right, centre. The chassis is turned against that frame by the centre joint.

use super::super::import_fault::ImportFault;
use super::parts::{Face, Member, Place, Robot, tilt_fault};
use super::{Document, MODULES_MAX, Node, xml};
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// The distance between opposite faces of these modules, m.
pub(super) const PITCH: f64 = 0.1;

/// Reads a configuration.
pub(super) fn read(document: &Document) -> Result<Robot, ImportFault> {
    let root = document.root_element();
    let mut robot = Robot::new(PITCH);
    let modules = xml::children(xml::child(root, "modules")?, "module")?;
    if modules.len() > MODULES_MAX {
        return Err(ImportFault::at_node(
            root,
            format!("{} modules are more than {MODULES_MAX}", modules.len()),
        ));
    }
    let mut names = BTreeMap::new();
    for node in modules {
        let member = member(node)?;
        if names.insert(member.name.clone(), robot.members.len()).is_some() {
            return Err(ImportFault::at_node(node, format!("the module `{}` is there twice", member.name)));
        }
        robot.members.push(member);
    }
    // A single module may be stated without connections.
    let Some(connections) = root.children().find(|node| node.has_tag_name("connections")) else {
        return Ok(robot);
    };
    for node in xml::children(connections, "connection")? {
        let ends = ends(node, &names, "module", "node", &|text| number(text))?;
        let turn = turn(node)?;
        robot.connect(ends, turn, place(node))?;
    }
    Ok(robot)
}

/// Returns the place of a node.
pub(super) fn place(node: Node) -> Place {
    let at = node.document().text_pos_at(node.range().start);
    (at.row as usize, at.col as usize)
}

fn number(text: &str) -> Option<Face> {
    text.parse::<usize>().ok().and_then(|number| Face::ALL.get(number).copied())
}

/// Returns the two ends of a connection, whose modules stand in the elements `module` and whose faces in the elements
/// `node`, each with 1 and 2 behind.
pub(super) fn ends(
    node: Node,
    names: &BTreeMap<String, usize>,
    module: &str,
    face: &str,
    named: &dyn Fn(&str) -> Option<Face>,
) -> Result<[(usize, Face); 2], ImportFault> {
    let end = |number: usize| {
        let name = xml::text(node, &format!("{module}{number}"))?;
        let index = names
            .get(name)
            .copied()
            .ok_or_else(|| ImportFault::at_node(node, format!("there is no module `{name}`")))?;
        let text = xml::text(node, &format!("{face}{number}"))?;
        let face = named(text)
            .ok_or_else(|| ImportFault::at_node(node, format!("`{text}` is no face of a module")))?;
        Ok((index, face))
    };
    Ok([end(1)?, end(2)?])
}

/// Returns the turn of a connection, rad.
pub(super) fn turn(node: Node) -> Result<f64, ImportFault> {
    let distance = xml::number(node, "distance")?;
    if distance != 0.0 {
        return Err(ImportFault::at_node(
            node,
            format!("the faces are to stay {distance} m apart, and docked faces touch"),
        ));
    }
    let angle = xml::number(node, "angle")?;
    let quarters = angle / 90.0;
    if (quarters - libm::round(quarters)).abs() > 1e-6 || quarters.abs() > 1e6 {
        return Err(ImportFault::at_node(node, format!("a turn by {angle}°: modules dock in quarter turns")));
    }
    Ok(quarters * FRAC_PI_2)
}

fn member(node: Node) -> Result<Member, ImportFault> {
    let name = xml::text(node, "name")?.to_owned();
    if name.is_empty() {
        return Err(ImportFault::at_node(node, "a module without a name"));
    }
    if let Some(path) = node.children().find(|child| child.has_tag_name("path")) {
        let file = path.text().unwrap_or("").trim();
        let model = file.rsplit(['/', '\\']).next().unwrap_or(file);
        if !["", "SMORE.sdf", "SMORES.sdf"].contains(&model) {
            let message = format!(
                "`{name}` is of the model `{model}`, and the library has the module of `SMORE.sdf` only"
            );
            return Err(ImportFault::at_node(path, message));
        }
    }
    let numbers = xml::numbers(node, "position", &[6, 7])?;
    let [front, left, right, centre] = *xml::numbers(node, "joints", &[4])? else {
        return Err(ImportFault::at_node(node, "4 joint positions are wanted"));
    };
    if let Some(message) = tilt_fault(centre) {
        return Err(ImportFault::at_node(node, message));
    }
    let turn = match numbers[3..] {
        [roll, pitch, yaw] => turned(Vec3::z(), yaw) * turned(Vec3::y(), pitch) * turned(Vec3::x(), roll),
        [w, x, y, z] => {
            let turn = nalgebra::Quaternion::new(w, x, y, z);
            if (turn.norm() - 1.0).abs() > 1e-2 {
                return Err(ImportFault::at_node(
                    node,
                    format!("the orientation of `{name}` is no unit quaternion"),
                ));
            }
            Pose::from_parts(
                nalgebra::Translation3::identity(),
                nalgebra::UnitQuaternion::new_normalize(turn),
            )
        }
        _ => return Err(ImportFault::at_node(node, "an orientation of 3 or 4 numbers is wanted")),
    };
    let X_WB = shifted(Vec3::new(numbers[0], numbers[1], numbers[2])) * turn;
    let X_BC = turned(Vec3::x(), centre) * turned(Vec3::z(), -FRAC_PI_2);
    Ok(Member { name, X: X_WB * X_BC, state: [front, left, right, centre] })
}
