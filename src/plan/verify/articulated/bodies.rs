//! The convex parts of all links that can collide, and the pairs of them that may touch.

use super::tolerances::Tolerances;
use crate::geometry::distance::{
    distance_of_solids, enclosed_depth, enclosed_point, signed_distance, signed_distance_within,
};
use crate::geometry::{Part, Pose, Solid, Unsound, Vec3};
use crate::plan::Tracks;
use crate::robot::{Assembly, Joint, JointKind, Kinematics, ModuleType};
use std::collections::BTreeSet;

/// The error of a link whose collision shape can't be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct UnsoundLink {
    /// The name of the module type.
    pub module: String,
    /// The name of the link.
    pub link: String,
    /// The fault of the shape.
    pub why: Unsound,
}

/// The convex parts of all links of a robot, compiled for the checks of collisions.
#[derive(Clone, Debug)]
pub struct Bodies {
    /// The bodies, ascending by the number of their link ([`Kinematics::link`]); links without shapes have none.
    pub bodies: Vec<Body>,
    /// Index of the first body of each module, and the number of bodies at the end.
    first: Vec<usize>,
    /// An upper bound, for each module by index, on the distance of its points from the origin of its body link (link
    /// 0) in any posture, m.
    pub reach: Vec<f64>,
    /// The module types, by their index in the library.
    kinds: Vec<Kind>,
    /// The index of the type of each module, by the module's index in the assembly.
    kind_of: Vec<usize>,
}

/// Two bodies of one module that are checked for collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerPair {
    /// The first body, by its index among the bodies of its module.
    pub a: usize,
    /// The second body, by its index among the bodies of its module; greater than `a`.
    pub b: usize,
    /// True if the pair counts for the clearance: two links that a joint joins do not.
    pub counts: bool,
    /// The greatest penetration depth that is not a collision, m.
    pub allowed: f64,
    /// The signed distance of the two, m, if no joint can change it: wheels on an axle, and links that turn about it;
    /// `None` if joints can.
    pub fixed: Option<f64>,
}

/// One convex part of a link, in the frame of the link that carries it.
#[derive(Clone, Debug)]
pub struct Body {
    /// The convex part, in the frame of the carrier.
    pub part: Part,
    /// The number of the link that the part belongs to ([`Kinematics::link`]).
    pub link: usize,
    /// The number of the link that carries the part ([`Kinematics::link`]). A disc that turns about its own axis is
    /// carried by the link that bears the axis: the turn changes nothing.
    pub carrier: usize,
    /// The index in the assembly of the module that the part belongs to.
    pub module: usize,
    /// An upper bound on the distance of the part's points from the carrier's origin, m.
    pub reach: f64,
    /// The centre of the part in the frame of its own link, m.
    pub home: Vec3,
}

impl Bodies {
    /// Compiles the convex parts of all links of a plan's robot; links are numbered as by [`Kinematics::link`].
    ///
    /// # Errors
    /// [`UnsoundLink`] for the first link whose shape is not sound.
    pub(super) fn of_plan(tracks: &Tracks) -> Result<Bodies, UnsoundLink> {
        Bodies::new(&tracks.robot, &Kinematics::new(&tracks.robot, &tracks.start.bonds, 0))
    }

    /// Compiles the convex parts of all links of the assembly `robot`; `kinematics` gives the links their numbers. A
    /// link with an empty shape has no parts.
    ///
    /// # Errors
    /// [`UnsoundLink`] for the first link whose shape is not sound.
    pub fn new(robot: &Assembly, kinematics: &Kinematics) -> Result<Bodies, UnsoundLink> {
        let kinds: Vec<Kind> = robot.library.modules.iter().map(Kind::new).collect::<Result<_, _>>()?;
        let mut all = Bodies {
            bodies: vec![],
            first: vec![0],
            reach: vec![],
            kinds: vec![],
            kind_of: robot.modules.iter().map(|m| m.kind).collect(),
        };
        for (module, instance) in robot.modules.iter().enumerate() {
            let kind = &kinds[instance.kind];
            let own = kind.solids.iter().flat_map(|solid| &solid.parts);
            let bodies = kind.bodies.iter().zip(own).map(|((link, carrier, part), own)| Body {
                part: part.clone(),
                link: kinematics.link(module, *link),
                carrier: kinematics.link(module, *carrier),
                module,
                reach: part.centre.norm() + part.radius,
                home: own.centre,
            });
            all.bodies.extend(bodies);
            all.first.push(all.bodies.len());
            all.reach.push(kind.reach);
        }
        all.kinds = kinds;
        Ok(all)
    }

    /// Returns the range of indices in [`Bodies::bodies`] that the bodies of a module take, given by its index in the
    /// assembly. Panics if there is no such module.
    pub fn of(&self, module: usize) -> std::ops::Range<usize> {
        self.first[module]..self.first[module + 1]
    }

    /// Returns the pairs of bodies within a module (its index in the assembly) that are checked for collision. Panics
    /// if there is no such module.
    pub fn inner(&self, module: usize) -> &[InnerPair] {
        &self.kinds[self.kind_of[module]].inner
    }

    /// Returns the depth up to which links of two modules may penetrate each other, m: the lesser of the `touch` that
    /// their types state. `a` and `b`: their indices in the assembly; it panics if there are no such modules.
    pub fn allowed_depth(&self, a: usize, b: usize) -> f64 {
        let touch = |module: usize| self.kinds[self.kind_of[module]].touch;
        f64::min(touch(a), touch(b))
    }

    /// Returns the least `touch` that a module of the robot states, m; infinite for a robot without modules.
    pub(super) fn least_allowed_depth(&self) -> f64 {
        self.kind_of.iter().map(|kind| self.kinds[*kind].touch).fold(f64::INFINITY, f64::min)
    }

    /// Returns the penetration depth of two links at a relative pose, m; 0 if they are apart. `a`, `b`: each link as
    /// (index of its module in the assembly, index of the link in the module); `X_AB`: the pose of b in a's frame.
    pub(super) fn overlap(&self, a: (usize, usize), b: (usize, usize), X_AB: &Pose) -> f64 {
        let distance = distance_of_solids(self.solid(a), &Pose::identity(), self.solid(b), X_AB);
        (-distance).max(0.0)
    }

    /// Returns true if a link of a module, given by its index in the assembly, has a mesh that is not convex, inside
    /// which another link could be without touching the surface.
    pub(super) fn may_enclose(&self, module: usize) -> bool {
        self.kinds[self.kind_of[module]].solids.iter().any(Solid::has_shells)
    }

    /// Returns one pair of bodies for each pair of links within a module (its index in the assembly) of which at
    /// least one has a mesh that is not convex, and so may enclose the other.
    pub(super) fn inner_enclosing(&self, module: usize) -> &[InnerPair] {
        &self.kinds[self.kind_of[module]].inner_enclosing
    }

    /// Iterates over the first body of each link of a module (its index in the assembly), as indices in
    /// [`Bodies::bodies`]; links without a shape are left out.
    pub(super) fn first_of_links(&self, module: usize) -> impl Iterator<Item = usize> {
        let all = self.of(module);
        let first = all.start;
        all.filter(move |&body| body == first || self.bodies[body].link != self.bodies[body - 1].link)
    }

    /// Returns a lower bound, m, on the depth to which one of two links is inside the meshes of the other that are not
    /// convex ([`enclosed_depth`](crate::geometry::distance::enclosed_depth)); 0 if no probe point of either is inside
    /// the other. The arguments are as for [`overlap`](Self::overlap).
    pub(super) fn enclosed_depth(&self, a: (usize, usize), b: (usize, usize), X_AB: &Pose) -> f64 {
        enclosed_depth(self.solid(a), self.solid(b), X_AB)
    }

    /// Returns a lower bound on the depth to which one of two links is inside the meshes of the other that are not
    /// convex, as [`enclosed_depth`](Self::enclosed_depth) does, with a point that is as deep: as (depth, point), m,
    /// the point in the frame of link a. `None` if no probe point of either link is inside the other's meshes. The
    /// arguments are as for [`overlap`](Self::overlap).
    pub(super) fn enclosed_point(
        &self,
        a: (usize, usize),
        b: (usize, usize),
        X_AB: &Pose,
    ) -> Option<(f64, Vec3)> {
        enclosed_point(self.solid(a), self.solid(b), X_AB)
    }

    /// Returns the signed distance of two links, m, or `enough` (m) if it is no less: that of [`distance`](Self::distance),
    /// but negative also for a link wholly inside another's mesh that is not convex. `a`, `b`: each link as (index of its
    /// module in the assembly, index of the link in the module); `numbers` and `poses`: the numbers of the links, and
    /// their poses by these, in one common frame.
    pub(super) fn signed_distance(
        &self,
        numbers: &Kinematics,
        (a, b): ((usize, usize), (usize, usize)),
        poses: &[Pose],
        enough: f64,
    ) -> f64 {
        let [i, j] = [a, b].map(|(module, link)| numbers.link(module, link));
        let apart = self.distance(i, j, poses, enough);
        if !self.may_enclose(a.0) && !self.may_enclose(b.0) {
            return apart;
        }
        let enclosed = self.enclosed_depth(a, b, &(poses[i].inverse() * poses[j]));
        if enclosed > 0.0 { apart.min(-enclosed) } else { apart }
    }

    fn solid(&self, (module, link): (usize, usize)) -> &Solid {
        &self.kinds[self.kind_of[module]].solids[link]
    }

    /// Returns the index in [`Bodies::bodies`] of the first body of a link, by its number ([`Kinematics::link`]);
    /// `None` for a link without a shape.
    pub(super) fn first_of_link(&self, link: usize) -> Option<usize> {
        let first = self.bodies.partition_point(|body| body.link < link);
        self.bodies.get(first).filter(|body| body.link == link).map(|_| first)
    }

    /// Returns the signed distance of two links, given by their numbers ([`Kinematics::link`]), m, or `enough` (m) if
    /// it is no less. `poses`: the poses of all links, by their numbers, in one common frame. A link wholly inside
    /// another's mesh that is not convex counts as outside of it: its distance is that from the surface, unlike that
    /// of [`distance_of_solids`].
    pub fn distance(&self, a: usize, b: usize, poses: &[Pose], enough: f64) -> f64 {
        let of = |link: usize| {
            let from = self.bodies.partition_point(|body| body.link < link);
            self.bodies[from..].iter().take_while(move |body| body.link == link)
        };
        let centre = |body: &Body| poses[body.carrier].transform_point(&body.part.centre.into());
        let mut least = enough;
        for x in of(a) {
            for y in of(b) {
                let balls = (centre(x) - centre(y)).norm() - x.part.radius - y.part.radius;
                if balls < least {
                    let X_AB = poses[x.carrier].inverse() * poses[y.carrier];
                    least = least.min(signed_distance_within(&x.part, &y.part, &X_AB, None, least).distance);
                }
            }
        }
        least
    }
}

/// A module type, compiled.
#[derive(Clone, Debug)]
struct Kind {
    /// Link, carrier, part in the carrier's frame.
    bodies: Vec<(usize, usize, Part)>,
    /// The solid of each link, in its frame.
    solids: Vec<Solid>,
    inner: Vec<InnerPair>,
    /// The first of the pairs of bodies for each pair of links of which one has a mesh that is not convex.
    inner_enclosing: Vec<InnerPair>,
    touch: f64,
    reach: f64,
}

impl Kind {
    fn new(kind: &ModuleType) -> Result<Kind, UnsoundLink> {
        let mut bodies = vec![];
        let mut solids = vec![];
        for (index, link) in kind.links.iter().enumerate() {
            let solid = Solid::new(&link.collides).or_else(|why| match why {
                Unsound::Empty => Ok(Solid::default()),
                why => Err(UnsoundLink { module: kind.name.clone(), link: link.name.clone(), why }),
            })?;
            bodies.extend(solid.parts.iter().map(|part| carried(kind, index, part)));
            solids.push(solid);
        }
        let mut inner = vec![];
        for b in 0..bodies.len() {
            // Bodies of one link are never a pair, and a mesh may have thousands.
            for a in 0..bodies.partition_point(|body| body.0 < bodies[b].0) {
                inner.extend(pair(kind, &solids, &bodies, (a, b)));
            }
        }
        let inner_enclosing = enclosing(&inner, &bodies, &solids);
        Ok(Kind { reach: reach(kind, &solids), bodies, solids, inner, inner_enclosing, touch: kind.touch })
    }
}

/// Returns the first of the pairs of bodies for each pair of links of which one has a mesh that is not convex.
fn enclosing(inner: &[InnerPair], bodies: &[(usize, usize, Part)], solids: &[Solid]) -> Vec<InnerPair> {
    if !solids.iter().any(Solid::has_shells) {
        return vec![];
    }
    let mut seen = BTreeSet::new();
    let is_first = |pair: &&InnerPair| {
        let (a, b) = (bodies[pair.a].0, bodies[pair.b].0);
        (solids[a].has_shells() || solids[b].has_shells()) && seen.insert((a, b))
    };
    inner.iter().filter(is_first).copied().collect()
}

/// Returns the constraint between two bodies of a module; `None` if they are of one link, or meet by design.
fn pair(
    kind: &ModuleType,
    solids: &[Solid],
    bodies: &[(usize, usize, Part)],
    (a, b): (usize, usize),
) -> Option<InnerPair> {
    let (x, y) = (&bodies[a], &bodies[b]);
    let links = |p: usize, q: usize| (p, q) == (x.0, y.0) || (q, p) == (x.0, y.0);
    if x.0 == y.0 || kind.touching.iter().any(|&(p, q)| links(p, q)) {
        return None;
    }
    let joined = kind.joints.iter().any(|j| links(j.parent, j.child));
    let allowed = kind.touch + if joined { drawn_overlap(kind, solids, x.0, y.0) } else { 0.0 };
    let fixed = stay(kind, x, y).then(|| {
        let X_AB = kind.links[x.1].pose.inverse() * kind.links[y.1].pose;
        signed_distance(&x.2, &y.2, &X_AB).distance
    });
    Some(InnerPair { a, b, counts: !joined, allowed, fixed })
}

/// Returns true if no joint changes the relative pose of two bodies: they have one carrier, or turn against
/// each other about an axis about which one of them is round.
fn stay(kind: &ModuleType, x: &(usize, usize, Part), y: &(usize, usize, Part)) -> bool {
    let about = |joint: &Joint, body: &(usize, usize, Part)| {
        let X_LJ = kind.links[body.1].pose.inverse() * joint.pose;
        body.2.is_round_about(
            &X_LJ.translation.vector,
            &(X_LJ.rotation * joint.axis),
            Tolerances::default().roundness,
        )
    };
    let mut revolute = kind.joints.iter().filter(|j| j.kind == JointKind::Revolute);
    let joins = |j: &Joint| (j.parent, j.child) == (x.1, y.1) || (j.child, j.parent) == (x.1, y.1);
    x.1 == y.1 || revolute.any(|j| joins(j) && (about(j, x) || about(j, y)))
}

/// Returns the link that a part moves with, and the part in its frame.
fn carried(kind: &ModuleType, link: usize, part: &Part) -> (usize, usize, Part) {
    let borne = |joint: &&Joint| joint.kind == JointKind::Revolute && joint.child == link;
    for joint in kind.joints.iter().filter(borne) {
        let other = joint.parent;
        let X_LJ = kind.links[link].pose.inverse() * joint.pose;
        let axis = X_LJ.rotation * joint.axis;
        if part.is_round_about(&X_LJ.translation.vector, &axis, Tolerances::default().roundness) {
            let X_OL = kind.links[other].pose.inverse() * kind.links[link].pose;
            return (link, other, part.moved(&X_OL));
        }
    }
    (link, link, part.clone())
}

/// Returns the penetration depth of two links as drawn, m; 0 if they are apart.
fn drawn_overlap(kind: &ModuleType, solids: &[Solid], a: usize, b: usize) -> f64 {
    let X_AB = kind.links[a].pose.inverse() * kind.links[b].pose;
    let pairs = solids[a].parts.iter().flat_map(|p| solids[b].parts.iter().map(move |q| (p, q)));
    let deepest = pairs.map(|(p, q)| -signed_distance(p, q, &X_AB).distance).fold(0.0, f64::max);
    deepest.max(enclosed_depth(&solids[a], &solids[b], &X_AB))
}

/// Returns an upper bound on the distance of any point of the module from its body's origin, m: by the joints' arms
/// at all angles, and the greatest travel of slides.
fn reach(kind: &ModuleType, solids: &[Solid]) -> f64 {
    let mut arm = vec![f64::INFINITY; kind.links.len()];
    arm[0] = 0.0;
    // As often as there are joints: then every link has been reached from its neighbours.
    for _ in &kind.joints {
        for joint in &kind.joints {
            let at = |link: usize| kind.links[link].pose.translation.vector;
            let axis = joint.pose.rotation * joint.axis;
            let from_axis = |p: Vec3| {
                let d = p - joint.pose.translation.vector;
                d - axis * axis.dot(&d)
            };
            let span = match joint.kind {
                JointKind::Revolute => {
                    let (a, b) = (at(joint.parent), at(joint.child));
                    from_axis(a).norm() + from_axis(b).norm() + axis.dot(&(b - a)).abs()
                }
                JointKind::Fixed => (at(joint.child) - at(joint.parent)).norm(),
                JointKind::Prismatic => {
                    let travel = joint.limits.range.map_or(f64::INFINITY, |(low, high)| high.max(-low));
                    (at(joint.child) - at(joint.parent)).norm() + travel
                }
            };
            arm[joint.child] = arm[joint.child].min(arm[joint.parent] + span);
            arm[joint.parent] = arm[joint.parent].min(arm[joint.child] + span);
        }
    }
    let corner = |part: &Part| {
        let directions = [Vec3::x(), Vec3::y(), Vec3::z()];
        // The corner of a box around the part that is farthest from the origin.
        let far = |n: &Vec3| {
            let along = part.centre.dot(n);
            (along + part.reach(n)).abs().max((along - part.reach(&-n)).abs())
        };
        let box_reach = directions.iter().map(|n| far(n) * far(n)).sum::<f64>().sqrt();
        box_reach.min(part.centre.norm() + part.radius)
    };
    let links = solids.iter().zip(&arm).filter(|(solid, _)| !solid.parts.is_empty());
    links.map(|(s, arm)| arm + s.parts.iter().map(corner).fold(0.0, f64::max)).fold(0.0, f64::max)
}
