//! The validation of declarations: the rules by which modules, connectors, cells and struts are sound.
//!
//! Programs and plan files are held to the same rules, which stand here and nowhere else: a program names the
//! position of a fault in its text, a plan file the part of its library.

use super::fault::{LibraryFault, ModulePart};
use super::library::{
    Cell, Connector, Joint, JointKind, Library, Limits, Link, ModuleType, Motor, Servo, Strut, Surface,
};
use super::step::MIMIC_DEPTH_MAX;
use crate::geometry::soundness::{EXTENT_MAX, TOL_THICKNESS, TOL_UNIT, check_placed, check_pose};
use crate::geometry::{Placed, Solid, Unsound, Vec3, protrusion};
use nalgebra::Matrix3;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// The greatest mass, force, torque, speed, acceleration, factor and coefficient, in SI units. A thousand million of
/// any is far above what robots have, and sums and products of a few such numbers lose no digit that a check rests on.
pub const QUANTITY_MAX: f64 = 1e9;
/// The greatest absolute value of a joint position, rad or m, that a range or a motion may have: 160,000 turns. To
/// judge more would take too long.
pub const POSITION_MAX: f64 = 1e6;
/// The greatest coordinate of a link, joint, port or shape in the frame of its module, m. Modules are parts of robots;
/// with levers longer than this the judge, which follows contacts by the smallest steps that a tip could make, takes
/// minutes for seconds of motion.
pub const MODULE_EXTENT_MAX: f64 = 10.0;
/// The greatest `touch` of a module, m: a deeper penetration is more than a tolerance of shapes.
pub const TOUCH_MAX: f64 = 5e-3;
/// The greatest `contact` of a module, m: links farther above the ground do not stand on it.
pub const CONTACT_MAX: f64 = 2e-2;
/// The greatest number of turns of a connector; more are no discrete turns any more.
pub const TURNS_MAX: u32 = 3600;

/// Threshold: the fraction of a link's inertia by which its principal moments may miss the triangle inequality, and by
/// which they may exceed the bound of its extent: rounding, and the few digits of a data sheet.
const TOL_INERTIA: f64 = 1e-3;
/// Threshold: the distance by which a centre of mass may be outside the box around its module, m: rounding of lengths.
const TOL_COM: f64 = 1e-6;
/// Threshold: the distance by which a drawn shape may stick out of the shape that is judged without being stated, m:
/// below the depth that the judge lets shapes touch.
const TOL_LEFT_OUT: f64 = 1e-5;

/// The result of a check.
type Checked = Result<(), LibraryFault>;

fn need(holds: bool, fault: impl FnOnce() -> LibraryFault) -> Checked {
    if holds { Ok(()) } else { Err(fault()) }
}

fn need_index(index: usize, count: usize, what: &'static str) -> Checked {
    need(index < count, || LibraryFault::Index { what, index, count })
}

/// Returns `Ok` for a number whose absolute value is at most `most`; not for NaN.
fn need_bounded(value: f64, most: f64, what: &'static str) -> Checked {
    need(value.abs() <= most, || LibraryFault::Bound { what, value, most })
}

fn need_positive(value: f64, most: f64, what: &'static str) -> Checked {
    need(value > 0.0, || LibraryFault::NotPositive { what, value })?;
    need_bounded(value, most, what)
}

fn need_not_negative(value: f64, most: f64, what: &'static str) -> Checked {
    need(value >= 0.0, || LibraryFault::Negative { what, value })?;
    need_bounded(value, most, what)
}

/// Checks all declarations of a library, and that every index in it is within its list.
///
/// # Errors
/// The first fault, inside the declaration that has it.
pub fn check_library(library: &Library) -> Checked {
    for (index, connector) in library.connectors.iter().enumerate() {
        let checked = check_connector(&library.connectors, index);
        checked.map_err(|fault| fault.of("connector", &connector.name))?;
    }
    for module in &library.modules {
        check_module(module, library.connectors.len()).map_err(|fault| fault.of("module", &module.name))?;
    }
    for cell in &library.cells {
        check_cell(cell).map_err(|fault| fault.of("cell", &cell.name))?;
    }
    library
        .struts
        .iter()
        .try_for_each(|strut| check_strut(strut).map_err(|fault| fault.of("strut", &strut.name)))
}

/// Checks that every index in a library is within its list, and that the joints of every module carry its links as a
/// tree: the conditions for naming and following the indices.
///
/// # Errors
/// The first fault, inside the declaration that has it.
pub fn check_references(library: &Library) -> Checked {
    let connectors = library.connectors.len();
    for connector in &library.connectors {
        let mut mates = connector.mates.iter();
        let checked = mates.try_for_each(|&mate| need_index(mate, connectors, "connector"));
        checked.map_err(|fault| fault.of("connector", &connector.name))?;
    }
    library.modules.iter().try_for_each(|module| {
        check_module_references(module, connectors).map_err(|fault| fault.of("module", &module.name))
    })
}

fn check_module_references(module: &ModuleType, connectors: usize) -> Checked {
    need(!module.links.is_empty(), || LibraryFault::NoLink)?;
    check_tree(module)?;
    let joint = |index| need_index(index, module.joints.len(), "joint");
    for (index, declared) in module.joints.iter().enumerate() {
        let mut followed = declared.mimic.iter().flatten();
        let checked = followed.try_for_each(|(followed, _)| joint(*followed));
        checked.map_err(|fault| fault.inside(ModulePart::Joint(index), &declared.name))?;
    }
    for (index, motor) in module.motors.iter().enumerate() {
        let checked = motor.joints.iter().try_for_each(|(driven, _)| joint(*driven));
        checked.map_err(|fault| fault.inside(ModulePart::Motor(index), &motor.name))?;
    }
    let link = |index| need_index(index, module.links.len(), "link");
    for (index, port) in module.ports.iter().enumerate() {
        let checked = link(port.link).and(need_index(port.connector, connectors, "connector"));
        checked.map_err(|fault| fault.inside(ModulePart::Port(index), &port.name))?;
    }
    module.touching.iter().try_for_each(|&(a, b)| link(a).and(link(b)))
}

/// Checks the connector of an index among those that its `mates` are indices of. `all`: the connectors. Panics if
/// there is no connector of this index.
///
/// # Errors
/// Its first fault: turns, mates, held loads, capture or hinge.
pub fn check_connector(all: &[Connector], index: usize) -> Checked {
    let Connector { mates, turns, holds_force, holds_moment, capture, hinge, .. } = &all[index];
    need((1..=TURNS_MAX).contains(turns), || LibraryFault::Turns { turns: *turns, most: TURNS_MAX })?;
    for &mate in mates {
        need_index(mate, all.len(), "connector")?;
        let other = &all[mate];
        need(other.mates.contains(&index), || LibraryFault::OneWayMate { other: other.name.clone() })?;
        need(other.turns == *turns, || LibraryFault::MateTurns { other: other.name.clone() })?;
    }
    holds_force
        .iter()
        .try_for_each(|force| need_positive(*force, QUANTITY_MAX, "the force that it holds"))?;
    holds_moment
        .iter()
        .try_for_each(|moment| need_positive(*moment, QUANTITY_MAX, "the moment that it holds"))?;
    if let Some(capture) = capture {
        need_positive(capture.distance, EXTENT_MAX, "the distance of capture")?;
        need_positive(capture.angle, PI + TOL_UNIT, "the angle of capture")?;
        for (speed, what) in
            [(capture.speed, "the speed of capture"), (capture.rate, "the angular speed of capture")]
        {
            speed.map_or(Ok(()), |speed| need_positive(speed, QUANTITY_MAX, what))?;
        }
    }
    if let Some(hinge) = hinge {
        unit(&hinge.axis)?;
        check_limits(&hinge.limits, POSITION_MAX)?;
    }
    Ok(())
}

/// Checks a module type: its indices, that the joints carry the links as a tree, `touch` and `contact`, shapes and
/// masses of the links, joints, motors and ports. `connectors`: the number of connectors that the indices in its ports
/// may name.
///
/// # Errors
/// Its first fault; if it is that of a link, joint, motor or port, inside that part.
pub fn check_module(module: &ModuleType, connectors: usize) -> Checked {
    check_module_references(module, connectors)?;
    need_not_negative(module.touch, TOUCH_MAX, "`touch`")?;
    need_not_negative(module.contact, CONTACT_MAX, "`contact`")?;
    for (index, link) in module.links.iter().enumerate() {
        check_link(link).map_err(|fault| fault.inside(ModulePart::Link(index), &link.name))?;
    }
    let mass: f64 = module.links.iter().map(|link| link.mass).sum();
    need_positive(mass, QUANTITY_MAX, "its mass")?;
    check_masses(module)?;
    for (index, joint) in module.joints.iter().enumerate() {
        check_joint(joint).map_err(|fault| fault.inside(ModulePart::Joint(index), &joint.name))?;
    }
    check_mimics(module)?;
    for (index, motor) in module.motors.iter().enumerate() {
        let checked = check_motor(motor);
        checked.map_err(|fault| fault.inside(ModulePart::Motor(index), &motor.name))?;
    }
    for (index, port) in module.ports.iter().enumerate() {
        let checked = check_pose(&port.pose).map_err(LibraryFault::from);
        let checked = checked.and_then(|()| need_near(&port.pose.translation.vector));
        checked.map_err(|fault| fault.inside(ModulePart::Port(index), &port.name))?;
    }
    Ok(())
}

/// Checks the shapes of a link, and the numbers that need no other link.
fn check_link(link: &Link) -> Checked {
    check_pose(&link.pose)?;
    for shapes in [&link.shape, &link.collides] {
        need(!shapes.is_empty(), || LibraryFault::Shape(Unsound::Empty))?;
        shapes.iter().try_for_each(check_placed)?;
    }
    need_not_negative(link.mass, QUANTITY_MAX, "its mass")?;
    need_not_negative(link.friction, QUANTITY_MAX, "its friction")?;
    let Surface { static_friction, stiffness } = link.surface;
    static_friction.iter().try_for_each(|f| need_not_negative(*f, QUANTITY_MAX, "its static friction"))?;
    stiffness.iter().try_for_each(|k| need_positive(*k, QUANTITY_MAX, "the stiffness of its surface"))?;
    link.com.iter().try_for_each(|c| need_bounded(*c, EXTENT_MAX, "its centre of mass"))?;
    let most = QUANTITY_MAX * EXTENT_MAX * EXTENT_MAX;
    link.inertia.iter().try_for_each(|i| need_bounded(*i, most, "its inertia"))?;
    need_not_negative(link.left_out, EXTENT_MAX, "what its `collides` leaves out")?;
    let (found, stated) = (left_out(&link.shape, &link.collides)?, link.left_out);
    need(found <= stated, || LibraryFault::LeftOut { found, stated })
}

/// Returns an upper bound on the distance by which the drawn shapes `shape` stick out of `collides`, those that are
/// judged, m, both in the link's frame: 0 up to the `TOL_LEFT_OUT` that tolerances of shapes explain; infinite if only
/// `collides` is empty.
///
/// # Errors
/// The first fault of a shape that is not sound.
pub fn left_out(shape: &[Placed], collides: &[Placed]) -> Result<f64, Unsound> {
    let found = protrusion(shape, collides)?;
    Ok(if found <= TOL_LEFT_OUT { 0.0 } else { found })
}

/// Returns `Ok` for a position in a module's frame (m) within [`MODULE_EXTENT_MAX`] along each axis.
fn need_near(position: &Vec3) -> Checked {
    position
        .iter()
        .try_for_each(|c| need_bounded(*c, MODULE_EXTENT_MAX, "its distance from the module's frame, in m,"))
}

/// Checks that shapes and centres of mass are within the module, and that inertias are those of bodies within it:
/// positive, with principal moments of which none is more than the other two together, and none more than all of the
/// mass at the farthest corner would give.
///
/// A body need not be within its own drawn shape: a shaft may reach into the next link.
fn check_masses(module: &ModuleType) -> Checked {
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for (index, link) in module.links.iter().enumerate() {
        let inside = |fault: Unsound| LibraryFault::from(fault).inside(ModulePart::Link(index), &link.name);
        let drawn = Solid::new(&link.shape).map_err(inside)?;
        let judged = Solid::new(&link.collides).map_err(inside)?;
        let at = |corner: Vec3| link.pose.transform_point(&corner.into()).coords;
        let near = corners(&judged.bounds).into_iter().try_for_each(|corner| need_near(&at(corner)));
        near.map_err(|fault| fault.inside(ModulePart::Link(index), &link.name))?;
        for corner in corners(&drawn.bounds).map(at) {
            need_near(&corner).map_err(|fault| fault.inside(ModulePart::Link(index), &link.name))?;
            (low, high) = (low.inf(&corner), high.sup(&corner));
        }
    }
    for (index, link) in module.links.iter().enumerate() {
        let com = link.pose.transform_point(&link.com.into()).coords;
        let outside = (low - com).sup(&(com - high)).max();
        let farthest = corners(&(low, high)).iter().map(|corner| (corner - com).norm()).fold(0.0, f64::max);
        let part = |fault: LibraryFault| fault.inside(ModulePart::Link(index), &link.name);
        need(outside <= TOL_COM, || LibraryFault::MassOutside { outside }).map_err(part)?;
        check_inertia(link, farthest).map_err(part)?;
    }
    Ok(())
}

fn corners((low, high): &(Vec3, Vec3)) -> [Vec3; 8] {
    std::array::from_fn(|k| Vec3::from_fn(|axis, _| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }))
}

/// Checks the inertia of a body of which no point is farther from its centre of mass than `farthest` (m).
fn check_inertia(link: &Link, farthest: f64) -> Checked {
    let [xx, yy, zz, xy, xz, yz] = link.inertia;
    if link.mass == 0.0 {
        return need(link.inertia.iter().all(|i| *i == 0.0), || LibraryFault::InertiaWithoutMass);
    }
    let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mut moments: [f64; 3] = matrix.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [least, middle, most] = moments;
    need(least > 0.0, || LibraryFault::InertiaNotPositive { least })?;
    let triangle = most <= (least + middle) * (1.0 + TOL_INERTIA);
    need(triangle, || LibraryFault::InertiaTriangle { moments })?;
    let bound = link.mass * farthest * farthest;
    need(most <= bound * (1.0 + TOL_INERTIA), || LibraryFault::InertiaExtent { most, bound })
}

/// Checks that joints carry every link but the first, each once, and connect all links with the first.
fn check_tree(module: &ModuleType) -> Checked {
    let count = module.links.len();
    let mut carried = BTreeSet::from([0]);
    for (index, joint) in module.joints.iter().enumerate().filter(|(_, joint)| !is_coordinate(joint)) {
        let inside = |fault: LibraryFault| fault.inside(ModulePart::Joint(index), &joint.name);
        need_index(joint.parent, count, "link").map_err(inside)?;
        need_index(joint.child, count, "link").map_err(inside)?;
        need(carried.insert(joint.child), || LibraryFault::SharedLink).map_err(inside)?;
    }
    let mut reached = BTreeSet::from([0]);
    let mut stack = vec![0];
    while let Some(link) = stack.pop() {
        let children = module.joints.iter().filter(|joint| joint.parent == link).map(|joint| joint.child);
        stack.extend(children.filter(|&child| reached.insert(child)));
    }
    let loose = (0..count).find(|link| !reached.contains(link));
    loose.map_or(Ok(()), |link| {
        Err(LibraryFault::LooseLink.inside(ModulePart::Link(link), &module.links[link].name))
    })
}

/// Returns true for a joint that only sums up others, `joint b = -a` alone, and joins no links.
fn is_coordinate(joint: &Joint) -> bool {
    joint.mimic.is_some() && joint.kind == JointKind::Fixed && (joint.parent, joint.child) == (0, 0)
}

fn check_joint(joint: &Joint) -> Checked {
    check_pose(&joint.pose)?;
    need_near(&joint.pose.translation.vector)?;
    unit(&joint.axis)?;
    let farthest = if joint.kind == JointKind::Prismatic { MODULE_EXTENT_MAX } else { POSITION_MAX };
    check_limits(&joint.limits, farthest)?;
    let Servo { stiffness, armature, damping, no_load_speed } = joint.servo;
    stiffness.iter().try_for_each(|k| need_positive(*k, QUANTITY_MAX, "the stiffness of its servo"))?;
    armature.iter().try_for_each(|i| need_positive(*i, QUANTITY_MAX, "the armature of its servo"))?;
    damping.iter().try_for_each(|d| need_positive(*d, QUANTITY_MAX, "the damping of its servo"))?;
    no_load_speed
        .iter()
        .try_for_each(|v| need_positive(*v, QUANTITY_MAX, "the no-load speed of its motor"))?;
    joint.mimic.iter().flatten().try_for_each(|(_, factor)| need_bounded(*factor, POSITION_MAX, "a factor"))
}

/// Checks that no joint follows itself over others, nor over more than [`MIMIC_DEPTH_MAX`] of them.
///
/// # Errors
/// [`LibraryFault::MimicCycle`] or [`LibraryFault::MimicDepth`] inside the first such joint.
fn check_mimics(module: &ModuleType) -> Checked {
    let followed = |joint: usize| module.joints[joint].mimic.iter().flatten().map(|(followed, _)| *followed);
    for joint in 0..module.joints.len() {
        let mut frontier = BTreeSet::from([joint]);
        for depth in 0.. {
            frontier = frontier.into_iter().flat_map(followed).collect();
            if frontier.is_empty() {
                break;
            }
            let inside =
                |fault: LibraryFault| fault.inside(ModulePart::Joint(joint), &module.joints[joint].name);
            need(!frontier.contains(&joint), || LibraryFault::MimicCycle).map_err(inside)?;
            need(depth < MIMIC_DEPTH_MAX, || LibraryFault::MimicDepth { most: MIMIC_DEPTH_MAX })
                .map_err(inside)?;
        }
    }
    Ok(())
}

fn check_motor(motor: &Motor) -> Checked {
    motor.joints.iter().try_for_each(|(_, factor)| need_bounded(*factor, POSITION_MAX, "a factor"))?;
    check_limits(&motor.limits, POSITION_MAX)
}

/// Checks limits, whose range reaches at most to `farthest` (rad or m).
fn check_limits(limits: &Limits, farthest: f64) -> Checked {
    if let Some((low, high)) = limits.range {
        need(low <= high, || LibraryFault::RangeOrder)?;
        need_bounded(low, farthest, "its range")?;
        need_bounded(high, farthest, "its range")?;
    }
    let stated = [
        (limits.speed, "its greatest speed"),
        (limits.acceleration, "its greatest acceleration"),
        (limits.effort, "its greatest torque or force"),
    ];
    let mut stated = stated.iter().filter_map(|(limit, what)| Some(((*limit)?, *what)));
    stated.try_for_each(|(limit, what)| need_positive(limit, QUANTITY_MAX, what))
}

fn unit(axis: &Vec3) -> Checked {
    need((axis.norm() - 1.0).abs() < TOL_UNIT, || LibraryFault::Axis)
}

/// Checks a type of expanding cubes.
///
/// # Errors
/// Its first fault: a size, mass, force or speed that is not positive or too large, an edge thinner than
/// [`TOL_THICKNESS`], or one that does not shrink.
pub fn check_cell(cell: &Cell) -> Checked {
    need_positive(cell.size, EXTENT_MAX, "`size`")?;
    need_positive(cell.shrinks_to, EXTENT_MAX, "`shrinks_to`")?;
    let thick = cell.shrinks_to >= TOL_THICKNESS;
    need(thick, || LibraryFault::Shape(Unsound::TooThin { what: "edge", value: cell.shrinks_to }))?;
    need(cell.shrinks_to < cell.size, || LibraryFault::NoShrinking)?;
    need_positive(cell.mass, QUANTITY_MAX, "`mass`")?;
    need_positive(cell.force, QUANTITY_MAX, "`max_force`")?;
    need_positive(cell.speed, QUANTITY_MAX, "`max_speed`")
}

/// Checks a type of linear actuators.
///
/// # Errors
/// Its first fault: a length, mass, force or speed that is not positive or too large, a negative clearance, or a
/// range of length without extent.
pub fn check_strut(strut: &Strut) -> Checked {
    let (low, high) = strut.length;
    need_positive(low, EXTENT_MAX, "the least `length`")?;
    need_positive(high, EXTENT_MAX, "the greatest `length`")?;
    need(low < high, || LibraryFault::NoLengthRange)?;
    need_positive(strut.speed, QUANTITY_MAX, "`max_speed`")?;
    need_positive(strut.force, QUANTITY_MAX, "`max_force`")?;
    need_positive(strut.mass, QUANTITY_MAX, "`mass`")?;
    need_not_negative(strut.clearance, EXTENT_MAX, "`clearance`")?;
    let stated = [
        (strut.acceleration, "`max_accel`"),
        (strut.buckling, "`buckling`"),
        (strut.node_mass, "`node_mass`"),
    ];
    for (value, name) in stated {
        value.map_or(Ok(()), |value| need_positive(value, QUANTITY_MAX, name))?;
    }
    Ok(())
}
