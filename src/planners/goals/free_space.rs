//! The free space of joints: postures in which a robot meets neither itself nor other robots, obstacles or the ground.
//!
//! The rules are those of the judge, worked out anew: links that a joint or a bond joins may overlap as far as they do as
//! drawn, all others not at all. A straight motion in joint space is examined in its middle, and the motion up to its
//! ends is bounded by levers (Schwarzer, Saha and Latombe 2005): pairs that are thereby separated are discarded, and with
//! the others the motion is halved.

use super::tolerances::TOLERANCES;
use crate::geometry::distance::{distance_of_solids, signed_distance_within};
use crate::geometry::{Pose, Solid, Unsound, Vec3};
use crate::plan::Obstacle;
use crate::robot::{Assembly, Kinematics, Motion, State, mate};
use std::collections::{BTreeMap, VecDeque};

/// The robots and what stands around them, at the instant at which a motion begins.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// The robots, with every bond that exists at some time.
    pub robot: &'a Assembly,
    /// The positions of all joints, and the bonds that hold.
    pub state: &'a State,
    /// The world poses of all links, m, by their numbers ([`Kinematics::link`]).
    pub poses: &'a [Pose],
    /// The obstacles, in the world's frame.
    pub obstacles: &'a [Obstacle],
    /// True if there is ground at height 0, which links keep away from that do not stand on it.
    pub floor: bool,
}

/// Two bodies that meet, or are nearest to each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// The names of the two: links as in `arm[2].body`, obstacles, or `the ground`.
    pub bodies: [String; 2],
    /// Their signed distance, m; negative where they overlap.
    pub distance: f64,
}

/// Something that can be met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Body {
    Link(usize),
    Obstacle(usize),
    Ground,
}

/// Two bodies whose distance changes as joints move.
#[derive(Clone, Debug)]
struct Pair {
    a: usize,
    b: Body,
    /// The depth up to which they may overlap, m.
    allowed: f64,
    /// True for links that a joint or a bond joins, which keep no clearance.
    joined: bool,
    /// The distance that they keep, m.
    clearance: f64,
    /// True for links of one module, or of two that are docked to each other: what moves the one against the other are few
    /// joints, so that postures in the middle of short ways tell enough.
    near: bool,
    /// The joints that change it, each with the greatest way of a point of the one against the other, m per rad or m per
    /// m.
    levers: Vec<(usize, f64)>,
}

/// The free space of some joints: the others stay where they are, and so does one link.
pub struct FreeSpace<'a> {
    around: Surroundings<'a>,
    kinematics: Kinematics,
    solids: BTreeMap<usize, Solid>,
    obstacles: Vec<Solid>,
    pairs: Vec<Pair>,
    held: (usize, Pose),
    /// The joints that move, by the number in their `JointId`, each with its greatest lever, m per rad or m per m.
    joints: Vec<(usize, f64)>,
    poses: Vec<Pose>,
    /// The number of postures that were examined.
    pub work: u64,
}

impl<'a> FreeSpace<'a> {
    /// Compiles the free space of the joints given by the numbers in their `JointId`, while the body of the module `held`
    /// (an index) stays where it is. `clearance`: the distance that bodies keep, m; where they are nearer at the beginning
    /// already, half of what they have there.
    ///
    /// # Errors
    /// [`Unsound`] for the first shape that is not sound.
    pub fn new(
        around: Surroundings<'a>,
        held: usize,
        joints: &[usize],
        clearance: f64,
    ) -> Result<FreeSpace<'a>, Unsound> {
        let robot = around.robot;
        let kinematics = Kinematics::new(robot, &around.state.bonds, held);
        let mut solids = BTreeMap::new();
        for (module, instance) in robot.modules.iter().enumerate() {
            for (index, link) in robot.library.modules[instance.kind].links.iter().enumerate() {
                match Solid::new(&link.collides) {
                    Ok(solid) => drop(solids.insert(kinematics.link(module, index), solid)),
                    Err(Unsound::Empty) => {}
                    Err(why) => return Err(why),
                }
            }
        }
        let obstacles =
            around.obstacles.iter().map(|o| Solid::new(&o.shapes)).collect::<Result<Vec<_>, _>>()?;
        let held = (kinematics.link(held, 0), around.poses[kinematics.link(held, 0)]);
        let mut space = FreeSpace {
            poses: around.poses.to_vec(),
            around,
            kinematics,
            solids,
            obstacles,
            pairs: vec![],
            held,
            joints: vec![],
            work: 0,
        };
        space.pairs = space.changing_pairs(joints, clearance);
        space.joints = joints.iter().map(|joint| (*joint, space.greatest_lever(*joint))).collect();
        Ok(space)
    }

    /// Returns the joints that move, by the number in their `JointId`, each with its greatest lever: the way of the
    /// farthest point that it moves, m per rad or m per m.
    pub fn joints(&self) -> &[(usize, f64)] {
        &self.joints
    }

    /// Returns the world poses of all links at positions of all joints (rad or m), by their numbers.
    pub fn link_poses(&mut self, joints: &[f64]) -> &[Pose] {
        self.work += 1;
        let (module, pose) = (self.kinematics.module_of(self.held.0), self.held.1);
        self.kinematics.link_poses_from(module, joints, &pose, &mut self.poses);
        &self.poses
    }

    /// Returns the centre of mass, m, in the world, of the robot whose joints move, at positions of all joints (rad or m).
    pub fn centre_of_mass(&mut self, joints: &[f64]) -> Vec3 {
        self.link_poses(joints);
        self.kinematics.centre_of_mass(self.around.robot, &self.poses).0
    }

    /// Returns the two bodies that overlap deepest beyond what is allowed at positions of all joints (rad or m); `None` if
    /// nothing meets.
    pub fn meeting(&mut self, joints: &[f64]) -> Option<Meeting> {
        self.link_poses(joints);
        let found = self.pairs.iter().map(|pair| (self.distance(pair, 0.0), pair));
        let deepest = found.filter(|(d, pair)| *d < -pair.allowed);
        let (distance, pair) =
            deepest.min_by(|(d, p), (e, q)| (d + p.allowed).total_cmp(&(e + q.allowed)))?;
        Some(Meeting { bodies: self.names(pair), distance })
    }

    /// Returns the two bodies that are nearest at positions of all joints (rad or m), but for links of one module and of two
    /// that are docked; `None` if none are nearer than `enough`, m.
    pub fn nearest(&mut self, joints: &[f64], enough: f64) -> Option<Meeting> {
        self.link_poses(joints);
        let mut found: Option<(f64, &Pair)> = None;
        for pair in self.pairs.iter().filter(|pair| !pair.near) {
            let least = found.map_or(enough, |(least, _)| least);
            let distance = self.distance(pair, least);
            if distance < least {
                found = Some((distance, pair));
            }
        }
        found.map(|(distance, pair)| Meeting { bodies: self.names(pair), distance })
    }

    /// Lets bodies come as near as they are in a posture (all joints, rad or m), where that is nearer than the clearance.
    pub fn allow(&mut self, joints: &[f64]) {
        self.link_poses(joints);
        let mut pairs = std::mem::take(&mut self.pairs);
        for pair in pairs.iter_mut().filter(|pair| !pair.joined) {
            let distance = self.distance(pair, pair.clearance);
            pair.clearance = kept(pair.clearance, distance).max(-pair.allowed);
        }
        self.pairs = pairs;
    }

    /// Returns true if all bodies keep their clearance at positions of all joints (rad or m).
    pub fn is_free(&mut self, joints: &[f64]) -> bool {
        self.link_poses(joints);
        self.pairs.iter().all(|pair| self.margin(pair, 0.0) >= 0.0)
    }

    /// Returns true if all bodies keep their clearance while the joints go straight from one posture to another (all joints,
    /// rad or m). The posture `from` is not examined.
    pub fn is_way_free(&mut self, from: &[f64], to: &[f64]) -> bool {
        if !self.is_free(to) {
            return false;
        }
        let far: Vec<f64> = self
            .pairs
            .iter()
            .map(|pair| pair.levers.iter().map(|&(j, r)| (to[j] - from[j]).abs() * r).sum())
            .collect();
        let moving: Vec<usize> = (0..self.pairs.len()).filter(|pair| far[*pair] > 0.0).collect();
        // Intervals by their middle and half, the longest first: what blocks a way is seldom small.
        let mut open = VecDeque::from([(0.5, 0.5, moving)]);
        let mut joints = from.to_vec();
        while let Some((middle, half, pairs)) = open.pop_front() {
            for (joint, (a, b)) in joints.iter_mut().zip(from.iter().zip(to)) {
                *joint = a + middle * (b - a);
            }
            self.link_poses(&joints);
            let mut left = Vec::new();
            for index in pairs {
                let (pair, reach) = (&self.pairs[index], half * far[index]);
                let margin = self.margin(pair, reach);
                if margin < 0.0 {
                    return false;
                }
                let fine = if pair.near {
                    TOLERANCES.joined_step
                } else {
                    TOLERANCES.step.max(pair.clearance / 2.0)
                };
                if margin < reach && reach > fine {
                    left.push(index);
                }
            }
            if !left.is_empty() {
                open.push_back((middle - half / 2.0, half / 2.0, left.clone()));
                open.push_back((middle + half / 2.0, half / 2.0, left));
            }
        }
        true
    }

    /// Returns the distance of a pair at the poses of last, less what it has to keep, m; exact below `enough`.
    fn margin(&self, pair: &Pair, enough: f64) -> f64 {
        let keep = if pair.joined { -pair.allowed } else { pair.clearance };
        self.distance(pair, keep + enough + TOLERANCES.rounding) - keep + TOLERANCES.rounding
    }

    /// Returns the signed distance of a pair at the poses of last, m, or `enough` or more where it is no less.
    fn distance(&self, pair: &Pair, enough: f64) -> f64 {
        let (a, X_WA) = (&self.solids[&pair.a], &self.poses[pair.a]);
        match pair.b {
            Body::Link(link) => apart(a, X_WA, &self.solids[&link], &self.poses[link], enough),
            Body::Obstacle(index) => apart(a, X_WA, &self.obstacles[index], &Pose::identity(), enough),
            Body::Ground => height(a, X_WA),
        }
    }

    fn names(&self, pair: &Pair) -> [String; 2] {
        let link = |link: usize| self.around.robot.link_name(link);
        let other = match pair.b {
            Body::Link(other) => link(other),
            Body::Obstacle(index) => self.around.obstacles[index].name.clone(),
            Body::Ground => "the ground".to_owned(),
        };
        [link(pair.a), other]
    }

    fn greatest_lever(&self, joint: usize) -> f64 {
        let levers = self.pairs.iter().flat_map(|pair| &pair.levers).filter(|(j, _)| *j == joint);
        levers.map(|(_, lever)| *lever).fold(TOLERANCES.lever, f64::max)
    }

    /// Returns the pairs whose distance changes with the joints.
    fn changing_pairs(&self, joints: &[usize], clearance: f64) -> Vec<Pair> {
        let links: Vec<usize> = self.solids.keys().copied().collect();
        let moved: Vec<usize> = links
            .iter()
            .copied()
            .filter(|link| !self.levers(self.held.0, *link, joints).is_empty())
            .collect();
        let is_moved = |link: usize| moved.binary_search(&link).is_ok();
        let mut pairs = Vec::new();
        for &a in &moved {
            for &b in links.iter().filter(|b| **b != a && (!is_moved(**b) || **b > a)) {
                let levers = match self.kinematics.path(b, a) {
                    Some(_) => self.levers(b, a, joints),
                    None => self.levers(self.held.0, a, joints),
                };
                if !levers.is_empty() {
                    pairs.extend(self.pair_of_links(a, b, levers));
                }
            }
            let levers = self.levers(self.held.0, a, joints);
            let other = |b: Body, levers: Vec<(usize, f64)>| Pair {
                a,
                b,
                allowed: self.touch(a),
                joined: false,
                clearance: 0.0,
                near: false,
                levers,
            };
            pairs.extend((0..self.obstacles.len()).map(|index| other(Body::Obstacle(index), levers.clone())));
            let stands = height(&self.solids[&a], &self.around.poses[a]) < TOLERANCES.stands;
            if self.around.floor && !stands {
                pairs.push(other(Body::Ground, levers));
            }
        }
        for pair in pairs.iter_mut().filter(|pair| !pair.joined) {
            // Bodies that are nearer than that already may stay so.
            let clearance = if pair.near { clearance.min(TOLERANCES.near_clearance) } else { clearance };
            let distance = self.distance(pair, clearance);
            pair.clearance = kept(clearance, distance).max(-pair.allowed);
        }
        pairs
    }

    /// Returns the pair of two links; `None` if they may meet by design.
    fn pair_of_links(&self, a: usize, b: usize, levers: Vec<(usize, f64)>) -> Option<Pair> {
        let robot = self.around.robot;
        let [m, n] = [a, b].map(|link| self.kinematics.module_of(link));
        let mut allowed = f64::min(self.touch(a), self.touch(b));
        let mut joined = false;
        if m == n {
            let (kind, first) = (robot.module_type(m), self.kinematics.link(m, 0));
            let is =
                |(p, q): (usize, usize)| (p + first, q + first) == (a, b) || (q + first, p + first) == (a, b);
            if kind.touching.iter().any(|pair| is(*pair)) {
                return None;
            }
            joined = kind.joints.iter().any(|joint| is((joint.parent, joint.child)));
            if joined {
                let (X_MA, X_MB) = (kind.links[a - first].pose, kind.links[b - first].pose);
                allowed += (-distance_of_solids(&self.solids[&a], &X_MA, &self.solids[&b], &X_MB)).max(0.0);
            }
        }
        let mut near = m == n;
        for (index, bond) in robot.bonds.iter().enumerate().filter(|(i, _)| self.around.state.bonds[*i]) {
            let modules = (bond.a.module, bond.b.module);
            near |= modules == (m, n) || modules == (n, m);
            let [x, y] = [bond.a, bond.b].map(|port| self.kinematics.port_link(robot, port));
            if (x, y) != (a, b) && (y, x) != (a, b) {
                continue;
            }
            let port = |at: crate::robot::PortRef| robot.module_type(at.module).ports[at.port].pose;
            let X_XY = port(bond.a) * mate(robot, index) * port(bond.b).inverse();
            let drawn = distance_of_solids(&self.solids[&x], &Pose::identity(), &self.solids[&y], &X_XY);
            let error =
                robot.connector(bond.a).capture.map_or(TOLERANCES.closure, |capture| capture.distance);
            (joined, allowed) = (true, allowed + (-drawn).clamp(0.0, error));
        }
        Some(Pair { a, b: Body::Link(b), allowed, joined, clearance: 0.0, near, levers })
    }

    fn touch(&self, link: usize) -> f64 {
        self.around.robot.module_type(self.kinematics.module_of(link)).touch
    }

    /// Returns the joints among `joints` that move a link against another, each with the greatest way of a point of the link.
    fn levers(&self, against: usize, link: usize, joints: &[usize]) -> Vec<(usize, f64)> {
        let Some(path) = self.kinematics.path(link, against) else { return vec![] };
        let mut levers: Vec<(usize, f64)> = Vec::new();
        let solid = &self.solids[&link];
        let (mut lever, mut last) = (solid.radius, solid.centre);
        for pair in path.windows(2) {
            let (step, sign) = self.kinematics.step_between(pair[0], pair[1]);
            // The point of the axis that both links carry, in the frame of the one and of the other.
            let (in_parent, in_child) = (step.shift, -step.offset);
            let (here, there) = if sign > 0.0 { (in_parent, in_child) } else { (in_child, in_parent) };
            lever += (here - last).norm();
            last = there;
            for &(joint, factor) in step.terms().iter().filter(|(joint, _)| joints.contains(joint)) {
                let way = match step.motion {
                    Motion::Fixed => continue,
                    Motion::Along(_) => factor.abs(),
                    _ => factor.abs() * lever,
                };
                match levers.iter_mut().find(|(known, _)| *known == joint) {
                    Some((_, known)) => *known += way,
                    None => levers.push((joint, way)),
                }
            }
            if let Motion::Along(_) = step.motion {
                lever += self.travel(step.terms());
            }
        }
        levers
    }

    /// Returns the greatest distance by which a slide can be off its zero, m.
    fn travel(&self, terms: &[(usize, f64)]) -> f64 {
        let robot = self.around.robot;
        let most = |&(joint, factor): &(usize, f64)| {
            let owner = robot.joints().nth(joint);
            let range = owner.and_then(|owner| match owner {
                crate::robot::JointOwner::Module { module, joint } => {
                    robot.module_type(module).joints[joint].limits.range
                }
                crate::robot::JointOwner::Bond(_) => None,
            });
            range.map_or(TOLERANCES.travel, |(low, high)| factor.abs() * low.abs().max(high.abs()))
        };
        terms.iter().map(most).sum()
    }
}

/// Returns the distance that two bodies keep, m, of which `clearance` is asked and which are at `distance` somewhere: where that
/// is less, half of it, so that neighbours may turn against each other.
fn kept(clearance: f64, distance: f64) -> f64 {
    if distance >= clearance { clearance } else { distance.min(distance / 2.0) }
}

/// Returns the height of the lowest point of a solid over the ground, m.
fn height(solid: &Solid, X_WL: &Pose) -> f64 {
    let down = X_WL.rotation.inverse() * -Vec3::z();
    let lowest =
        |part: &crate::geometry::Part| X_WL.transform_point(&part.centre.into()).z - part.reach(&down);
    solid.parts.iter().map(lowest).fold(f64::INFINITY, f64::min)
}

/// Returns the signed distance of two solids, m, or `enough` or more where it is no less.
fn apart(a: &Solid, X_WA: &Pose, b: &Solid, X_WB: &Pose, enough: f64) -> f64 {
    let between =
        |p: &Vec3, q: &Vec3| (X_WB.transform_point(&(*q).into()) - X_WA.transform_point(&(*p).into())).norm();
    let balls = between(&a.centre, &b.centre) - a.radius - b.radius;
    if balls >= enough {
        return balls;
    }
    if a.has_shells() || b.has_shells() {
        return distance_of_solids(a, X_WA, b, X_WB);
    }
    let X_AB = X_WA.inverse() * X_WB;
    let mut least = enough;
    for p in &a.parts {
        for q in &b.parts {
            if between(&p.centre, &q.centre) - p.radius - q.radius < least {
                least = least.min(signed_distance_within(p, q, &X_AB, None, least).distance);
            }
        }
    }
    least
}
