//! The fittings of modules: docks and hinges that are drawn where a module has its ports, and shafts where a joint spans a
//! gap. They are no part of what is judged or weighed; every module gets them, by its connectors and joints.
#![allow(non_snake_case)]

use super::mesh::Mesh;
use super::primitives::along;
use super::tolerances::TOLERANCES;
use crate::geometry::pose::shifted;
use crate::geometry::{Placed, Pose, Shape, Vec3};
use crate::robot::{Joint, JointKind, Library, ModuleType, Port};

/// The radius of a dock, and the depth to which it reaches into its link, as parts of the width of the link there.
const DOCK_RADIUS: f64 = 0.34;
const DOCK_DEPTH: f64 = 0.1;
/// The radius of a pin of a dock, and its distance from the middle, as parts of the dock's radius.
const PIN_RADIUS: f64 = 0.17;
const PIN_PLACE: f64 = 0.62;
/// The height of a pin, as a multiple of that of the dock.
const PIN_HEIGHT: f64 = 4.0;
/// The most turns of a connector that are shown by pins.
const PINS_MAX: u32 = 8;
/// The length of a hinge, and its radius, as parts of the width of the link along it and across.
const HINGE_LENGTH: f64 = 0.42;
const HINGE_RADIUS: f64 = 0.46;
/// The radius of a shaft, as a part of the width of the narrower link across it; the length by which it reaches into each
/// link, as a part of the radius; the longest gap that is spanned, as a part of that width.
const SHAFT_RADIUS: f64 = 0.28;
const SHAFT_REACH: f64 = 0.4;
const SHAFT_GAP_MAX: f64 = 0.4;

/// Returns the fittings of a link of a module type, in the frame of the link: of each port a disc with as many pins as its
/// connector has turns, or a barrel along its hinge; of each joint that carries another link a shaft, if there is a gap.
pub(super) fn fittings(library: &Library, kind: &ModuleType, link: usize) -> Vec<Placed> {
    let points = corners(kind, link, &Pose::identity());
    let ports = kind.ports.iter().filter(|port| port.link == link);
    let docks = ports.flat_map(|port| fitting(library, port, &points));
    let turns = |joint: &&Joint| joint.parent == link && joint.kind == JointKind::Revolute;
    docks.chain(kind.joints.iter().filter(turns).filter_map(|joint| shaft(kind, joint))).collect()
}

/// Returns the corners of the triangles of a link as they are drawn, in the frame A of `X_AL`.
fn corners(kind: &ModuleType, link: usize, X_AL: &Pose) -> Vec<Vec3> {
    let drawn = Mesh::of(&kind.links[link].shape);
    let points = drawn.triangles.iter().flat_map(|(corners, _)| corners);
    points.map(|p| X_AL.transform_point(&(*p).into()).coords).collect()
}

/// Returns the shaft of a joint between its links, in the frame of the one that carries; `None` if they meet on the axis,
/// or one of them is not there, or far away.
fn shaft(kind: &ModuleType, joint: &Joint) -> Option<Placed> {
    // Frame A: the joint's, with its axis as z.
    let X_MA = joint.pose * along(&joint.axis);
    let span = |link: usize| {
        let points = corners(kind, link, &(X_MA.inverse() * kind.links[link].pose));
        let on_axis = points.chunks_exact(3).filter_map(|t| height_on_axis(&[t[0], t[1], t[2]]));
        let (low, high) = on_axis.fold((f64::MAX, f64::MIN), |(low, high), z| (low.min(z), high.max(z)));
        let width = points.iter().map(|p| libm::hypot(p.x, p.y)).fold(0.0, f64::max) * 2.0;
        (low <= high).then_some((low, high, width))
    };
    let (first, second) = (span(joint.parent)?, span(joint.child)?);
    let (below, over) =
        if first.0 + first.1 <= second.0 + second.1 { (first, second) } else { (second, first) };
    let (gap, width) = (over.0 - below.1, below.2.min(over.2));
    if gap < TOLERANCES.size || gap > SHAFT_GAP_MAX * width {
        return None;
    }
    let radius = SHAFT_RADIUS * width;
    let length = gap + 2.0 * SHAFT_REACH * radius;
    let at = shifted(Vec3::new(0.0, 0.0, (below.1 + over.0) / 2.0));
    let X_LM = kind.links[joint.parent].pose.inverse();
    Some(Placed { pose: X_LM * X_MA * at, shape: Shape::Cylinder { radius, length, axis: Vec3::z() } })
}

/// Returns the height at which a triangle meets the z axis; `None` if it does not, or stands on edge.
fn height_on_axis([a, b, c]: &[Vec3; 3]) -> Option<f64> {
    let cross = |p: &Vec3, q: &Vec3| p.x * q.y - p.y * q.x;
    let (u, v, w) = (cross(b, c), cross(c, a), cross(a, b));
    let area = u + v + w;
    if area.abs() < TOLERANCES.size * TOLERANCES.size {
        return None;
    }
    let inside = [u, v, w].iter().all(|part| part / area >= -TOLERANCES.tick);
    inside.then(|| (u * a.z + v * b.z + w * c.z) / area)
}

/// Returns the fitting of one port; `points`: the corners of its link.
fn fitting(library: &Library, port: &Port, points: &[Vec3]) -> Vec<Placed> {
    let X_PL = port.pose.inverse();
    let width = |axis: usize| {
        let values = points.iter().map(|p| X_PL.transform_point(&(*p).into()).coords[axis]);
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        (high - low).max(0.0)
    };
    let across = width(1).min(width(2));
    if across <= 0.0 {
        return Vec::new();
    }
    let connector = &library.connectors[port.connector];
    let tube = |at: Vec3, axis: Vec3, radius: f64, length: f64| Placed {
        pose: port.pose * shifted(at),
        shape: Shape::Cylinder { radius, length, axis },
    };
    if let Some(hinge) = &connector.hinge {
        let along = hinge.axis.iamax();
        return vec![tube(Vec3::zeros(), hinge.axis, HINGE_RADIUS * across, HINGE_LENGTH * width(along))];
    }
    let radius = DOCK_RADIUS * across;
    let (depth, height) = (DOCK_DEPTH * across, TOLERANCES.fitting * across);
    let disc = |radius: f64, top: f64, y: f64, z: f64| {
        tube(Vec3::new((top - depth) / 2.0, y, z), Vec3::x(), radius, depth + top)
    };
    let mut parts = vec![disc(radius, height, 0.0, 0.0)];
    let turns = connector.turns;
    if (2..=PINS_MAX).contains(&turns) {
        parts.extend((0..turns).map(|turn| {
            let (s, c) = libm::sincos(std::f64::consts::TAU * (f64::from(turn) + 0.5) / f64::from(turns));
            disc(PIN_RADIUS * radius, PIN_HEIGHT * height, PIN_PLACE * radius * c, PIN_PLACE * radius * s)
        }));
    }
    parts
}
