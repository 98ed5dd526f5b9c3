//! Clusters of modules, the broad phase of conservative advancement: if the bounding spheres of two clusters are kept
//! apart over an interval by a bound on motion, then so are all of their pairs of modules, none of which is touched
//! (chain trees: Lotan, Schwarzer, Halperin and Latombe 2002).
//!
//! The clusters are the parts of the centroid decomposition (see [`ReferenceLinks`]) and the modules themselves. All
//! pairs of a module of one part and one of another have the same reference link, so that the spheres are seen from
//! it. A pair of clusters is split only where its spheres neither separate all of its pairs of modules nor leave all
//! of them open: what is found is what the examination of every pair by itself would find.

use super::bodies::Bodies;
use super::interval_state::IntervalState;
use super::reference_links::ReferenceLinks;
use super::separation::Motion;
use super::tolerances::NUMERICS;
use crate::robot::Kinematics;

/// The gap between the bounding spheres of two modules up to which they count as near each other, as a fraction of
/// the sum of the spheres' radii.
pub(super) const NEARLY: f64 = 1.0 / 16.0;

/// A set of modules, whose indices are those in the assembly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cluster {
    /// A single module.
    Module(u32),
    /// A part of the robot in the centroid decomposition, of two modules or more, named by its centroid.
    Part(u32),
}

/// A pair of clusters, which stands for all pairs of a module of the one and a module of the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClusterPair {
    /// The first cluster of modules.
    pub a: Cluster,
    /// The second cluster of modules, which has no module of the first.
    pub b: Cluster,
    /// The level of the reference link that all of the pairs have, an index in [`ReferenceLinks::levels`].
    pub level: u32,
}

/// The proximity of all pairs of modules that a pair of clusters stands for, over an interval, as far as their
/// bounding spheres decide it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Proximity {
    /// All are separated.
    Separated,
    /// None is separated, and no two bounding spheres touch, or nearly touch, in the middle of the interval.
    Open,
    /// It differs, or the spheres do not tell; split the first cluster, if true, or else the second.
    Undecided(bool),
}

/// The part of the robot that is examined, as bounds on its clusters need it.
pub(super) struct Scene<'a> {
    /// The bodies of the robot, for the radii of the modules.
    pub bodies: &'a Bodies,
    /// The kinematics of the part of the robot that bonds connect.
    pub kinematics: &'a Kinematics,
    /// The reference links of that part.
    pub levels: &'a ReferenceLinks,
}

/// The bounding spheres of the clusters of the centroid decomposition over one interval, each computed when it is
/// first needed.
#[derive(Clone, Debug, Default)]
pub(super) struct ClusterBounds {
    /// The spheres by level and centroid, each with the number of its interval ([`IntervalState::epoch`]).
    known: Vec<Vec<(u32, Ball)>>,
}

/// A bound on where the modules of a cluster are over the interval. In uniform motion with its velocity, the centre
/// stays this near to every module, as seen from a reference link.
#[derive(Clone, Copy, Debug, Default)]
struct Ball {
    /// The position in the middle and the velocity, m and m/s.
    centre: Motion,
    /// No point of any module gets farther from the centre, m.
    outer: f64,
    /// The greatest distance of a module's centre from the centre, less its radius and the bound on its motion, m.
    inner: f64,
    /// No point of a module, with the radius that counts as near, is farther from the centre in the middle, m.
    near: f64,
}

impl Cluster {
    fn of(levels: &ReferenceLinks, centroid: u32) -> Cluster {
        let alone = levels.pieces[centroid as usize].is_empty();
        if alone { Cluster::Module(centroid) } else { Cluster::Part(centroid) }
    }
}

impl ClusterPair {
    /// Returns the pairs of clusters that together stand for each pair of modules of the connected part exactly once.
    pub(super) fn all(levels: &ReferenceLinks, kinematics: &Kinematics) -> Vec<ClusterPair> {
        let mut pairs = Vec::new();
        for &(module, _) in &kinematics.tree.order {
            let level = levels.between(module, module) as u32;
            let pieces = &levels.pieces[module];
            for (i, &b) in pieces.iter().enumerate() {
                let b = Cluster::of(levels, b);
                pairs.push(ClusterPair { a: Cluster::Module(module as u32), b, level });
                let before = pieces[..i].iter().map(|a| Cluster::of(levels, *a));
                pairs.extend(before.map(|a| ClusterPair { a, b, level }));
            }
        }
        pairs
    }

    /// Appends to `out` the pairs into which this one falls if a cluster is split into its centroid and its pieces:
    /// the first if `first` is true, else the second. Panics if that is a single module.
    pub(super) fn split(&self, first: bool, levels: &ReferenceLinks, out: &mut Vec<ClusterPair>) {
        let (split, other) = if first { (self.a, self.b) } else { (self.b, self.a) };
        let Cluster::Part(centroid) = split else { unreachable!("a module is not split") };
        let pieces = levels.pieces[centroid as usize].iter().map(|piece| Cluster::of(levels, *piece));
        let split = std::iter::once(Cluster::Module(centroid)).chain(pieces);
        out.extend(split.map(|a| ClusterPair { a, b: other, level: self.level }));
    }
}

impl ClusterBounds {
    /// Returns the proximity of the modules of a pair of clusters, at least one of which is a part, over the interval
    /// of `state`. `needs`: the least and the greatest of the distances (m) that pairs of modules must be proved to
    /// have.
    pub(super) fn proximity(
        &mut self,
        state: &mut IntervalState,
        scene: &Scene,
        pair: &ClusterPair,
        needs: (f64, f64),
    ) -> Proximity {
        let level = pair.level as usize;
        let [a, b] = [pair.a, pair.b].map(|cluster| self.ball(state, scene, level, cluster));
        let between = a.centre.to(&b.centre);
        let (least, middle) = (between.nearest(state.interval.half), between.p.norm());
        let rounding = NUMERICS.cluster_rounding * (1.0 + middle);
        if least - a.outer - b.outer - rounding >= needs.1 {
            return Proximity::Separated;
        }
        let none = least + a.inner + b.inner + rounding < needs.0;
        if none && middle - a.near - b.near - rounding >= needs.1 {
            return Proximity::Open;
        }
        let splits = |cluster| matches!(cluster, Cluster::Part(_));
        Proximity::Undecided(!splits(pair.b) || (splits(pair.a) && a.outer >= b.outer))
    }

    fn ball(&mut self, state: &mut IntervalState, scene: &Scene, level: usize, cluster: Cluster) -> Ball {
        let centroid = match cluster {
            Cluster::Module(module) => return Ball::of_module(state, scene, level, module as usize),
            Cluster::Part(centroid) => centroid as usize,
        };
        if self.known.len() <= level {
            self.known.resize(level + 1, Vec::new());
        }
        let of_level = &mut self.known[level];
        of_level.resize(scene.levels.pieces.len(), (0, Ball::default()));
        let (epoch, ball) = of_level[centroid];
        if epoch == state.epoch() {
            return ball;
        }
        let mut ball = Ball::of_module(state, scene, level, centroid);
        for &piece in &scene.levels.pieces[centroid] {
            let piece = self.ball(state, scene, level, Cluster::of(scene.levels, piece));
            ball.include(&piece, state.interval.half);
        }
        self.known[level][centroid] = (state.epoch(), ball);
        ball
    }
}

impl Ball {
    fn of_module(state: &mut IntervalState, scene: &Scene, level: usize, module: usize) -> Ball {
        let link = scene.kinematics.link(module, 0);
        state.require_deviation(scene.kinematics, scene.levels, level, link);
        let origin = &state.links[scene.levels.origin(level, link)];
        let own = &state.links[link];
        let centre = Motion { p: own.p, v: own.v - origin.spin.cross(&own.p) };
        let reach = scene.bodies.reach[module];
        let extent = reach + state.drift(state.deviation(level, link).velocity);
        Ball { centre, outer: extent, inner: -extent, near: (1.0 + NEARLY) * reach }
    }

    /// Extends the ball by a ball of other modules; `half`: half the length of the interval, s.
    fn include(&mut self, other: &Ball, half: f64) {
        let between = self.centre.to(&other.centre);
        let away = between.p.norm();
        let moved = away + between.v.norm() * half;
        self.outer = self.outer.max(moved + other.outer);
        self.inner = self.inner.max(moved + other.inner);
        self.near = self.near.max(away + other.near);
    }
}
