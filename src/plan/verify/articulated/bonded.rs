//! Links that bonds join, and the penetration depth that they may have.
//!
//! Two links with mated ports belong together, so that their distance is no clearance. They are solid all the
//! same. They may overlap as far as they do at the nominal pose of the bond, the hinge at zero, as far as the
//! error explains that the connector states for docking: guides and pins are no longer than what they guide. A
//! bond that closes a loop may hold its links off the nominal pose by that error once more.

use super::bodies::{Bodies, Body};
use super::docking;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::robot::{Assembly, Bond, Capture, Kinematics, PortRef, mate};
use std::collections::BTreeMap;

/// A table of the penetration depths of two bonded links at the nominal pose of their bond, m, filled as they are
/// computed. The key: type and port of the one module, type and port of the other, and the turn of the bond, as
/// indices.
#[derive(Debug, Default)]
pub(super) struct NominalOverlaps(BTreeMap<[usize; 5], f64>);

/// The pairs of links that bonds join, by the two links' numbers ([`Kinematics::link`]); each pair is there in both
/// orders.
#[derive(Debug, Default)]
pub(super) struct BondedLinks(BTreeMap<(usize, usize), BondedPair>);

/// Two links that one or several bonds join.
#[derive(Clone, Copy, Debug)]
pub(super) struct BondedPair {
    /// The index in the assembly of the first of the bonds, or of that which holds the links at its nominal pose.
    pub bond: usize,
    /// The penetration depth of the two links at the nominal pose of the bond, m.
    pub overlap: f64,
    /// The part of that depth that the error of docking explains, m.
    pub explained: f64,
    /// True if the links keep the nominal pose as long as the bond holds.
    pub rigid: bool,
    /// The greatest error of a bond that closes a loop, with the origin of the port on each link; `None` if no such
    /// bond joins them.
    error: Option<(Capture, [Vec3; 2])>,
}

impl NominalOverlaps {
    fn of(&mut self, robot: &Assembly, bodies: &Bodies, bond: usize) -> f64 {
        let Bond { a, b, turn } = robot.bonds[bond];
        let kind = |at: PortRef| robot.modules[at.module].kind;
        let key = [kind(a), a.port, kind(b), b.port, turn as usize];
        *self.0.entry(key).or_insert_with(|| {
            let port = |at: PortRef| &robot.module_type(at.module).ports[at.port];
            let X_AB = port(a).pose * mate(robot, bond) * port(b).pose.inverse();
            bodies.overlap((a.module, port(a).link), (b.module, port(b).link), &X_AB)
        })
    }
}

impl BondedLinks {
    /// Finds the pairs of links that bonds join, in the part of the robot that `kinematics` reaches. `bonds`: for
    /// each bond of the assembly, by index, true if it holds; `overlaps`: the table of depths, which grows.
    pub(super) fn new(
        robot: &Assembly,
        bonds: &[bool],
        kinematics: &Kinematics,
        bodies: &Bodies,
        overlaps: &mut NominalOverlaps,
    ) -> BondedLinks {
        let mut found = BondedLinks::default();
        for &(_, bond) in &kinematics.tree.order {
            if let Some(bond) = bond {
                found.join(robot, kinematics, bodies, (bond, true), overlaps);
            }
        }
        for &bond in kinematics.tree.closing.iter().filter(|bond| bonds[**bond]) {
            found.join(robot, kinematics, bodies, (bond, false), overlaps);
        }
        found
    }

    /// Returns the bonded pair of two links, given by their numbers ([`Kinematics::link`]) in either order; `None` if
    /// no bond joins them.
    pub(super) fn get(&self, a: usize, b: usize) -> Option<&BondedPair> {
        self.0.get(&(a, b))
    }

    /// Iterates over the pairs, each once, as ((number of the one link, number of the other), pair), ascending, the
    /// lesser number first.
    pub(super) fn iter(&self) -> impl Iterator<Item = ((usize, usize), &BondedPair)> {
        self.0.iter().filter(|((a, b), _)| a < b).map(|(links, pair)| (*links, pair))
    }

    fn join(
        &mut self,
        robot: &Assembly,
        kinematics: &Kinematics,
        bodies: &Bodies,
        (bond, in_tree): (usize, bool),
        overlaps: &mut NominalOverlaps,
    ) {
        let Bond { a, b, .. } = robot.bonds[bond];
        let [x, y] = [a, b].map(|at| kinematics.port_link(robot, at));
        let origin = |at: PortRef| robot.module_type(at.module).ports[at.port].pose.translation.vector;
        let error = docking::tolerated(robot, bond, &Tolerances::default());
        let overlap = overlaps.of(robot, bodies, bond);
        let new = BondedPair {
            bond,
            overlap,
            explained: overlap.min(error.distance),
            rigid: in_tree && robot.hinge(bond).is_none(),
            error: (!in_tree).then(|| (stated(error), [origin(a), origin(b)])),
        };
        let joined = self.0.get(&(x, y)).map_or(new, |known| known.and(&new));
        self.0.insert((y, x), joined.reversed());
        self.0.insert((x, y), joined);
    }
}

impl BondedPair {
    /// Returns the depth, m, up to which two bodies of the links may penetrate each other: `touch` (m), plus the part
    /// of the nominal overlap that the error of docking explains, plus, for a bond that closes a loop, the motion
    /// that its error allows. `a`: a body of the first link of the pair, `b`: one of the second.
    pub(super) fn allowed(&self, a: &Body, b: &Body, touch: f64) -> f64 {
        let moved = self.error.as_ref().map_or(0.0, |(error, ports)| {
            // To turn a body about its port moves none of its points by more than this.
            let lever = |body: &Body, port: &Vec3| (body.home - port).norm() + body.part.radius;
            error.distance + error.angle * f64::min(lever(a, &ports[0]), lever(b, &ports[1]))
        });
        touch + self.explained + moved
    }

    /// Returns the pair for links that another bond joins, too, which closes a loop: the greater explained overlap and the
    /// greater error.
    fn and(&self, other: &BondedPair) -> BondedPair {
        BondedPair {
            explained: self.explained.max(other.explained),
            error: [self.error, other.error]
                .into_iter()
                .flatten()
                .max_by(|x, y| x.0.distance.total_cmp(&y.0.distance)),
            ..*self
        }
    }

    fn reversed(&self) -> BondedPair {
        BondedPair { error: self.error.map(|(error, [a, b])| (error, [b, a])), ..*self }
    }
}

/// Returns the error with the usual angle in place of one that is not stated, which is a half turn and explains
/// nothing.
fn stated(error: Capture) -> Capture {
    if error.angle < std::f64::consts::PI {
        return error;
    }
    Capture { angle: Tolerances::default().closure_angle, ..error }
}
