//! Links as bodies: masses, collision shapes, joints.

use super::floor_contacts::FloorContacts;
use super::servo;
use super::tree::Trees;
use crate::formats::masses::{MASS_MIN, sound_inertia};
use crate::formats::xml::{Attribute, Xml, number, numbers, placed, vector};
use crate::geometry::pose::shifted;
use crate::geometry::{Placed, Pose, Shape, Vec3};
use crate::plan::Obstacle;
use crate::robot::{Motion, Step, mate};
use std::collections::BTreeSet;

/// Half the distance between the two points that a constraint holds together on the axis of a hinge, m.
const HINGE_ARM: f64 = 0.05;

/// Returns shapes and their poses in the frame that they are placed in, with unions taken apart.
pub(super) fn pieces(placed: &[Placed]) -> Vec<(Pose, &Shape)> {
    let mut pieces = Vec::new();
    let mut open: Vec<(Pose, &Placed)> = placed.iter().rev().map(|p| (Pose::identity(), p)).collect();
    while let Some((X_LP, part)) = open.pop() {
        let X_LS = X_LP * part.pose;
        match &part.shape {
            Shape::Union { parts } => open.extend(parts.iter().rev().map(|part| (X_LS, part))),
            shape => pieces.push((X_LS, shape)),
        }
    }
    pieces
}

/// Returns the points of a hull or mesh, m; `None` for other shapes.
fn points(shape: &Shape) -> Option<&[Vec3]> {
    match shape {
        Shape::Hull { points } | Shape::Mesh { vertices: points, .. } => Some(points),
        _ => None,
    }
}

/// Returns the name of the mesh of a piece of a link; modules of one type share it.
fn mesh_name(trees: &Trees, link: usize, piece: usize) -> String {
    let (kind, index) = trees.kind(link);
    let kinds = &trees.robot.library.modules;
    let declared = &kinds[kind];
    let twins = kinds[..kind].iter().filter(|other| other.name == declared.name).count();
    let other = if twins > 0 { format!(" ({})", twins + 1) } else { String::new() };
    format!("{}{other}.{}.{piece}", declared.name, declared.links[index].name)
}

/// Returns the name of the mesh of a piece of an obstacle.
fn obstacle_mesh_name(obstacle: &Obstacle, piece: usize) -> String {
    format!("{}: {piece}", obstacle.name)
}

/// Adds the element `asset` with a mesh for each convex hull and mesh among the shapes of the links and of obstacles;
/// nothing if there is none.
pub(super) fn assets(xml: &mut Xml, trees: &Trees, obstacles: &[Obstacle]) {
    let mut known = BTreeSet::new();
    let mut meshes: Vec<(String, &[Vec3])> = Vec::new();
    let mut hollow = false;
    for link in trees.depth_first() {
        if known.insert(trees.kind(link)) {
            for (piece, (_, shape)) in pieces(&trees.link(link).collides).into_iter().enumerate() {
                meshes.extend(points(shape).map(|points| (mesh_name(trees, link, piece), points)));
                hollow |= matches!(shape, Shape::Mesh { .. });
            }
        }
    }
    for obstacle in obstacles {
        for (piece, (_, shape)) in pieces(&obstacle.shapes).into_iter().enumerate() {
            meshes.extend(points(shape).map(|points| (obstacle_mesh_name(obstacle, piece), points)));
            hollow |= matches!(shape, Shape::Mesh { .. });
        }
    }
    if meshes.is_empty() {
        return;
    }
    xml.open("asset", &[]);
    if hollow {
        xml.comment("MuJoCo takes the convex hull of a mesh.");
    }
    for (name, points) in meshes {
        xml.leaf("mesh", &[("name", name), ("vertex", numbers(points.iter().flat_map(|p| [p.x, p.y, p.z])))]);
    }
    xml.close("asset");
}

/// Adds the bodies of all links, nested as in the trees. The base is fixed in the world if `held` is true; other trees
/// float. `friction` is the factor, without unit, on the friction of links; `floor` is asked for the geoms that touch it.
pub(super) fn bodies(
    xml: &mut Xml,
    trees: &Trees,
    held: bool,
    friction: f64,
    mut floor: Option<&mut FloorContacts>,
) {
    for (index, (root, X_WR)) in trees.roots.iter().enumerate() {
        let mut open = vec![Some(*root)];
        while let Some(next) = open.pop() {
            let Some(link) = next else {
                xml.close("body");
                continue;
            };
            let (X, step) = match &trees.steps[link] {
                Some(step) => (step.child_pose(&Pose::identity(), &trees.zero), Some(step)),
                None => (*X_WR, None),
            };
            let mut attributes = vec![("name", trees.link_name(link))];
            attributes.extend(placed(&X));
            xml.open("body", &attributes);
            match step {
                Some(step) => joint(xml, trees, link, step),
                None if held && index == 0 => {}
                None => xml.leaf("freejoint", &[("name", format!("{}.free", trees.link_name(link)))]),
            }
            contents(xml, trees, link, friction, floor.as_deref_mut());
            open.push(None);
            open.extend(trees.children[link].iter().rev().map(|child| Some(*child)));
        }
    }
}

/// Adds the joint of a link.
fn joint(xml: &mut Xml, trees: &Trees, link: usize, step: &Step) {
    let Some(joint) = trees.joint_of[link] else { return };
    let mut attributes: Vec<Attribute> = vec![("name", trees.joint_name(joint))];
    match (step.motion, step.motion.axis()) {
        (_, Some(axis)) => {
            attributes.push(("type", "hinge".into()));
            if step.offset != Vec3::zeros() {
                attributes.push(("pos", vector(&-step.offset)));
            }
            attributes.push(("axis", vector(&axis)));
        }
        (Motion::Along(direction), _) => {
            attributes.push(("type", "slide".into()));
            attributes.push(("axis", vector(&(step.turn.inverse() * direction))));
        }
        _ => return,
    }
    if let Some(range) = trees.range(joint) {
        attributes.push(("range", numbers(range)));
    }
    if trees.is_driven(joint) {
        attributes.extend(servo::attributes(trees, joint));
    }
    xml.leaf("joint", &attributes);
}

/// Adds the mass of a link, its shapes, and the sites of the constraints at its ports.
fn contents(xml: &mut Xml, trees: &Trees, link: usize, friction: f64, mut floor: Option<&mut FloorContacts>) {
    let declared = trees.link(link);
    if declared.mass < MASS_MIN {
        xml.comment("This link has no mass; MuJoCo wants some.");
    }
    xml.leaf(
        "inertial",
        &[
            ("pos", vector(&declared.com)),
            ("mass", number(declared.mass.max(MASS_MIN))),
            ("fullinertia", numbers(sound_inertia(declared))),
        ],
    );
    for (piece, (X_LS, shape)) in pieces(&declared.collides).into_iter().enumerate() {
        let (name, friction) = (format!("{}.{piece}", trees.link_name(link)), declared.friction * friction);
        let mut attributes = vec![("name", name.clone())];
        attributes.extend(geom(&X_LS, shape, || mesh_name(trees, link, piece)));
        attributes.push(("friction", number(friction)));
        match &mut floor {
            Some(floor) => floor.geom(xml, (link, piece), (&X_LS, shape), name, friction, attributes),
            None => xml.leaf("geom", &attributes),
        }
    }
    sites(xml, trees, link);
}

/// Adds the geoms of obstacles, which stand fast in the world; `friction` is their coefficient, which is not used: links
/// have the higher priority, and theirs counts.
pub(super) fn obstacles(xml: &mut Xml, obstacles: &[Obstacle], friction: f64) {
    for obstacle in obstacles {
        for (piece, (X_WS, shape)) in pieces(&obstacle.shapes).into_iter().enumerate() {
            let mesh = obstacle_mesh_name(obstacle, piece);
            let mut attributes = vec![("name", mesh.clone())];
            attributes.extend(geom(&X_WS, shape, || mesh));
            attributes.extend([("priority", "0".to_owned()), ("friction", number(friction))]);
            xml.leaf("geom", &attributes);
        }
    }
}

/// Returns the attributes of the geom of a shape at a pose in its body; `mesh` names the mesh of a hull or mesh.
fn geom(X: &Pose, shape: &Shape, mesh: impl FnOnce() -> String) -> Vec<Attribute<'static>> {
    let mut attributes = vec![("type", geom_type(shape).to_owned())];
    let along = |axis: &Vec3, length: f64| {
        let (p, half) = (X.translation.vector, X.rotation * axis.normalize() * (length / 2.0));
        numbers((p - half).iter().chain((p + half).iter()).copied())
    };
    match shape {
        Shape::Box { size } => attributes.push(("size", vector(&(size / 2.0)))),
        Shape::Sphere { radius } => attributes.push(("size", number(*radius))),
        Shape::Cylinder { radius, length, axis } | Shape::Capsule { radius, length, axis } => {
            attributes.push(("size", number(*radius)));
            if *length > 0.0 {
                attributes.push(("fromto", along(axis, *length)));
            }
        }
        Shape::Hull { .. } | Shape::Mesh { .. } | Shape::Union { .. } => attributes.push(("mesh", mesh())),
    }
    if !attributes.iter().any(|(name, _)| *name == "fromto") {
        attributes.extend(placed(X));
    }
    attributes
}

fn geom_type(shape: &Shape) -> &'static str {
    match shape {
        Shape::Box { .. } => "box",
        Shape::Cylinder { .. } => "cylinder",
        Shape::Capsule { length, .. } if *length > 0.0 => "capsule",
        Shape::Sphere { .. } | Shape::Capsule { .. } => "sphere",
        Shape::Hull { .. } | Shape::Mesh { .. } | Shape::Union { .. } => "mesh",
    }
}

/// Returns the names of the sites at which a bond (an index in the robot's bonds) is constrained, as pairs of one on
/// its first and one on its second port. A bond that turns has two pairs, on either side along its axis.
pub(super) fn site_names(trees: &Trees, bond: usize) -> Vec<[String; 2]> {
    let name = trees.robot.bond_name(bond);
    let ends: &[&str] = if trees.robot.hinge(bond).is_some() { &[", low", ", high"] } else { &[""] };
    ends.iter().map(|end| ["first", "second"].map(|side| format!("{name}: {side}{end}"))).collect()
}

/// Adds the sites of a link for the constraints of bonds. While a bond holds, its first and second site coincide.
fn sites(xml: &mut Xml, trees: &Trees, link: usize) {
    let robot = trees.robot;
    for &(bond, second) in &trees.constraints_at[link] {
        let declared = robot.bonds[bond];
        let at = if second { declared.b } else { declared.a };
        let X_LQ = robot.module_type(at.module).ports[at.port].pose;
        // The frame of the first port, moved by the hinge, if there is one.
        let X_LP = if second { X_LQ * mate(robot, bond).inverse() } else { X_LQ };
        for (names, end) in site_names(trees, bond).iter().zip([-HINGE_ARM, HINGE_ARM]) {
            let arm = robot.hinge(bond).map_or(Vec3::zeros(), |hinge| hinge.axis * end);
            let mut attributes = vec![("name", names[usize::from(second)].clone())];
            attributes.extend(placed(&(X_LP * shifted(arm))));
            xml.leaf("site", &attributes);
        }
    }
}
