//! Contacts of links with the floor, which stand in the model as pairs: friction there is damped less than what bears, and discs
//! that lie flat stand on points of their rims.

use super::bodies::pieces;
use super::tree::Trees;
use crate::formats::xml::{Attribute, Xml, number, numbers, vector};
use crate::geometry::pose::perpendicular;
use crate::geometry::{Pose, Shape, Vec3};
use crate::plan::verify::articulated::LinkPaths;
use crate::plan::{Plan, Tracks, World};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The damping of contacts with the floor along its normal, for each kilogram that rests on them, N·s/m.
const FLOOR_DAMPING: f64 = 150.0;
/// The damping of friction on the floor, in the same unit. With more, what slides at some 70 mm/s is lifted off the floor; with less,
/// what should stick creeps under stiff servos.
const FLOOR_FRICTION_DAMPING: f64 = 25.0;

/// The number of points of a rim on which a disc stands that lies flat, as the judge has it. MuJoCo finds three or four for a
/// cylinder, and the least tilt changes which.
const RIM_POINTS: usize = 8;
/// The radius of the spheres that are these points, m.
const RIM_POINT_RADIUS: f64 = 1e-4;
/// The least cosine of the angle between the axis of a disc and the normal of the ground with which the disc lies flat.
const FLAT: f64 = 0.9;
/// The number of instants of a plan at which the attitude of discs is looked at.
const INSTANTS: usize = 200;

/// The contacts of a plan's robots with the floor.
pub(super) struct FloorContacts {
    /// The discs that lie flat during the whole plan, each by its link and its number among the shapes of that link, with the sign of
    /// the end of its axis that is the lower one.
    discs: BTreeMap<(usize, usize), f64>,
    /// The geoms that touch the floor, each as (name, coefficient of friction).
    touching: Vec<(String, f64)>,
}

impl FloorContacts {
    /// Returns the contacts of the robots of a plan whose world at the start has a floor; `None` without a floor.
    pub(super) fn of(plan: &Plan, tracks: &Tracks, trees: &Trees, world: &World) -> Option<FloorContacts> {
        let upright = world.ground_pose().rotation * Vec3::z();
        world
            .has_floor()
            .then(|| FloorContacts { discs: flat_discs(plan, tracks, trees, &upright), touching: Vec::new() })
    }

    /// Adds the default classes of the geoms of discs that lie flat, which do not touch the floor themselves, and of the points of
    /// their rims, which touch nothing else; and the defaults of the pairs. `stiffness`: that of contacts, N/m for each
    /// kilogram on them; `impedance`: without unit.
    pub(super) fn defaults(&self, xml: &mut Xml, stiffness: f64, impedance: f64) {
        xml.leaf(
            "pair",
            &[
                ("condim", "3".into()),
                ("solref", numbers([-stiffness, -FLOOR_DAMPING])),
                ("solreffriction", numbers([-stiffness, -FLOOR_FRICTION_DAMPING])),
                ("solimp", numbers([impedance, impedance])),
            ],
        );
        if self.discs.is_empty() {
            return;
        }
        xml.open("default", &[("class", "disc".into())]);
        xml.leaf("geom", &[("contype", "2".into()), ("conaffinity", "2".into())]);
        xml.close("default");
        xml.open("default", &[("class", "rim".into())]);
        xml.leaf(
            "geom",
            &[
                ("type", "sphere".into()),
                ("size", number(RIM_POINT_RADIUS)),
                ("contype", "0".into()),
                ("conaffinity", "0".into()),
                ("group", "3".into()),
            ],
        );
        xml.close("default");
    }

    /// Adds the geom of a shape of a link with its attributes: `name` is its own, and `friction` its coefficient on the floor. Below
    /// a disc that lies flat stand the points of its rim.
    pub(super) fn geom(
        &mut self,
        xml: &mut Xml,
        (link, piece): (usize, usize),
        (X_LS, shape): (&Pose, &Shape),
        name: String,
        friction: f64,
        mut attributes: Vec<Attribute>,
    ) {
        let disc = self.discs.get(&(link, piece)).zip(disc(shape));
        let Some((end, (axis, radius, length))) = disc else {
            xml.leaf("geom", &attributes);
            self.touching.push((name, friction));
            return;
        };
        attributes.insert(1, ("class", "disc".into()));
        xml.leaf("geom", &attributes);
        let across = perpendicular(&axis);
        let centre = axis * (end * (length / 2.0 - RIM_POINT_RADIUS));
        for point in 0..RIM_POINTS {
            let (s, c) = libm::sincos(TAU * point as f64 / RIM_POINTS as f64);
            let radial = (across * c + axis.cross(&across) * s) * (radius - RIM_POINT_RADIUS);
            let at = X_LS.transform_point(&(centre + radial).into()).coords;
            let name = format!("{name}.{point}");
            xml.leaf("geom", &[("name", name.clone()), ("class", "rim".into()), ("pos", vector(&at))]);
            self.touching.push((name, friction));
        }
    }

    /// Adds a pair of the floor with each geom that touches it.
    pub(super) fn pairs(self, xml: &mut Xml) {
        for (name, friction) in self.touching {
            let friction = numbers([friction, friction]);
            xml.leaf("pair", &[("geom1", "floor".into()), ("geom2", name), ("friction", friction)]);
        }
    }
}

/// Returns the axis (of unit length), radius and length, m, of a cylinder that is wide enough for points on its rim; `None` for
/// other shapes.
fn disc(shape: &Shape) -> Option<(Vec3, f64, f64)> {
    let Shape::Cylinder { radius, length, axis } = shape else { return None };
    (radius.min(length / 2.0) > RIM_POINT_RADIUS).then(|| (axis.normalize(), *radius, *length))
}

/// Returns the discs that lie flat on ground with this normal during the whole plan, as [`FloorContacts::discs`] has them.
fn flat_discs(plan: &Plan, tracks: &Tracks, trees: &Trees, upright: &Vec3) -> BTreeMap<(usize, usize), f64> {
    let mut discs = BTreeMap::new();
    for link in trees.depth_first() {
        for (piece, (X_LS, shape)) in pieces(&trees.link(link).collides).into_iter().enumerate() {
            discs.extend(disc(shape).map(|(axis, ..)| ((link, piece), X_LS.rotation * axis)));
        }
    }
    if discs.is_empty() {
        return BTreeMap::new();
    }
    let mut ends = BTreeMap::new();
    let Some(paths) = LinkPaths::of(plan) else { return ends };
    for instant in 0..=INSTANTS {
        let poses = paths.at(tracks.duration * instant as f64 / INSTANTS as f64);
        let end = |link: usize, axis: &Vec3| {
            let along = (poses[link].rotation * axis).dot(upright);
            (along.abs() >= FLAT).then_some(-along.signum())
        };
        if instant == 0 {
            ends = discs.iter().filter_map(|(key, axis)| Some((*key, end(key.0, axis)?))).collect();
        } else {
            ends.retain(|key, before| end(key.0, &discs[key]) == Some(*before));
        }
    }
    ends
}
