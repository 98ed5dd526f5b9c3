//! A truss as its planners see it: the graph of nodes and struts, and its limits.

use super::surroundings::Surroundings;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::robot::Strut;
use crate::robot::truss_statics::{ForceModel, Layout};

/// A truss of linear actuators: its graph, the limits of its struts and of its shape, and its surroundings. The
/// positions of its nodes are not part of it; functions take them as `x`, m, in the world's frame, one for each node.
#[derive(Clone, Debug)]
pub struct Structure {
    /// The number of nodes of the truss.
    pub nodes: usize,
    /// The indices of the two nodes of each strut; the index of a strut here, from 0, names it in the whole planner.
    pub struts: Vec<(usize, usize)>,
    /// The least and the greatest length of each strut, m, in the order of `struts`.
    pub lengths: Vec<(f64, f64)>,
    /// The greatest rate of length of a strut, m/s.
    pub speed: f64,
    /// The greatest acceleration of the length of a strut, m/s²; `None` for no limit.
    pub acceleration: Option<f64>,
    /// The least distance between struts that share no node, and between struts and obstacles, m.
    pub clearance: f64,
    /// The whole mass, kg.
    pub mass: f64,
    /// The fraction of the whole mass that each node carries, in their order, in all 1: its own mass and half of each of its
    /// struts.
    pub mass_fractions: Vec<f64>,
    /// The mean length of a strut at the start, m: the unit of steps and tolerances.
    pub unit: f64,
    /// The limits of the shape beside those of the struts.
    pub limits: Limits,
    /// The least and the greatest sum of lengths of each of `limits.loops`, in their order, m.
    pub loop_ranges: Vec<(f64, f64)>,
    /// Pairs of struts (indices) that share a node, the lesser index first; empty unless their angles are limited.
    pub corners: Vec<(usize, usize)>,
    /// The obstacles and the terrain in the world's frame.
    pub surroundings: Surroundings,
    /// The tolerances of all computations on this truss.
    pub tolerances: Tolerances,
    /// The envelope of its stiffness matrix.
    pub layout: Layout,
}

/// The limits of the shape of a truss beside those that every strut has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// The least angle between struts that share a node, rad, below π/3; 0 for no limit.
    pub angle: f64,
    /// The lower limit after every step on the smallest singular value of the rigidity matrix (rows of unit vectors)
    /// that belongs to no rigid motion, without unit; 0 for no limit.
    pub rigidity: f64,
    /// The loads on the nodes and the strength of the struts under which forces have to hold the truss; `None` for no
    /// limit on forces.
    pub forces: Option<ForceModel>,
    /// The indices of struts that keep their length at the start: they failed, or have no motor.
    pub locked: Vec<usize>,
    /// The loops: sets of struts (indices) made of one tube or cable; the sum of the lengths of each set stays.
    pub loops: Vec<Vec<usize>>,
}

impl Structure {
    /// Returns the truss of struts of one kind, with the nodes at `start`, m, and without further limits, obstacles or
    /// terrain. `struts`: the indices of the two nodes of each, which must be different; an index that is not a node
    /// panics. `strut`: the kind of the struts.
    pub fn new(strut: &Strut, start: &[Vec3], struts: &[(usize, usize)]) -> Structure {
        let masses = strut.node_masses(start.len(), struts);
        let whole: f64 = masses.iter().sum();
        let mass_fractions = masses.into_iter().map(|mass| mass / whole).collect();
        let length = |&(a, b): &(usize, usize)| (start[a] - start[b]).norm();
        Structure {
            nodes: start.len(),
            struts: struts.to_vec(),
            lengths: vec![strut.length; struts.len()],
            speed: strut.speed,
            acceleration: strut.acceleration,
            clearance: strut.clearance,
            mass: whole,
            mass_fractions,
            unit: struts.iter().map(length).sum::<f64>() / struts.len().max(1) as f64,
            limits: Limits::default(),
            loop_ranges: Vec::new(),
            corners: Vec::new(),
            surroundings: Surroundings::default(),
            tolerances: Tolerances::DEFAULT,
            layout: Layout::new(start.len(), struts),
        }
    }

    /// Returns the truss under `limits` in place of those that it has. Locked struts and loops keep the lengths that
    /// they have at the positions `start` of the nodes, m, up to the tolerance `locked_slack`. Panics if a limit names
    /// a strut that is not there.
    pub fn with_limits(mut self, start: &[Vec3], limits: Limits) -> Structure {
        let slack = self.tolerances.locked_slack * self.unit;
        for &strut in &limits.locked {
            let length = self.length(start, strut);
            self.lengths[strut] = (length - slack, length + slack);
        }
        if limits.angle > 0.0 {
            let count = self.struts.len();
            let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
            self.corners = pairs.filter(|&(i, j)| self.share_node(i, j)).collect();
        }
        self.limits = limits;
        let sums = (0..self.limits.loops.len()).map(|index| self.loop_length(start, index));
        self.loop_ranges = sums.map(|sum| (sum - slack, sum + slack)).collect();
        self
    }

    /// Returns the truss among these obstacles and on this terrain, in place of those that it has.
    pub fn with_surroundings(mut self, surroundings: Surroundings) -> Structure {
        self.surroundings = surroundings;
        self
    }

    /// Returns the truss with its clearance enlarged by `margin` units, and its least angle, if it has one, by
    /// `margin` rad, so that certificates by conservative advancement end.
    pub fn tightened(&self, margin: f64) -> Structure {
        let mut truss = self.clone();
        truss.clearance += margin * self.unit;
        truss.limits.angle += if self.limits.angle > 0.0 { margin } else { 0.0 };
        truss
    }

    /// Returns the sum of the lengths of the loop at `index` in [`Limits::loops`] with the nodes at `x`, m. Panics if
    /// there is no such loop.
    pub fn loop_length(&self, x: &[Vec3], index: usize) -> f64 {
        self.limits.loops[index].iter().map(|&strut| self.length(x, strut)).sum()
    }

    /// Returns (shared, end of `i`, end of `j`): the indices of the node that the struts `i` and `j` share, and of the
    /// other end of each. The struts must share a node. Panics if there is no such strut.
    pub fn corner(&self, i: usize, j: usize) -> (usize, usize, usize) {
        let ((a, b), (c, d)) = (self.struts[i], self.struts[j]);
        match (a == c, a == d, b == c) {
            (true, _, _) => (a, b, d),
            (_, true, _) => (a, b, c),
            (_, _, true) => (b, a, d),
            _ => (b, a, c),
        }
    }

    /// Returns the length, m, of a strut, given by its index, with the nodes at `x`, m. Panics if there is no such
    /// strut.
    pub fn length(&self, x: &[Vec3], strut: usize) -> f64 {
        let (a, b) = self.struts[strut];
        (x[a] - x[b]).norm()
    }

    /// Returns (end, end): the positions of the two ends of a strut, given by its index, with the nodes at `x`, m.
    /// Panics if there is no such strut.
    pub fn segment(&self, x: &[Vec3], strut: usize) -> (Vec3, Vec3) {
        let (a, b) = self.struts[strut];
        (x[a], x[b])
    }

    /// Returns true if two struts, given by their indices, have a node in common. Panics if there is no such strut.
    pub fn share_node(&self, i: usize, j: usize) -> bool {
        let ((a, b), (c, d)) = (self.struts[i], self.struts[j]);
        a == c || a == d || b == c || b == d
    }

    /// Returns the centre of mass with the nodes at `x`, m: the mean of the nodes by their masses.
    pub fn centre_of_mass(&self, x: &[Vec3]) -> Vec3 {
        x.iter().zip(&self.mass_fractions).map(|(p, fraction)| p * *fraction).sum()
    }

    /// Returns for each strut, in their order, the greatest absolute rate of its length, m/s, while the nodes move
    /// from `x` to `y`, m, at constant velocity in one second. The length is convex in time, so its rate is greatest
    /// at an end.
    pub fn rates(&self, x: &[Vec3], y: &[Vec3]) -> impl Iterator<Item = f64> {
        self.struts.iter().map(|&(a, b)| {
            let (from, to) = (x[a] - x[b], y[a] - y[b]);
            let change = to - from;
            let rate = |d: &Vec3| change.dot(d) / d.norm();
            rate(&from).abs().max(rate(&to).abs())
        })
    }

    /// Returns for each strut, in their order, the greatest second derivative of its length, m, by the progress of a linear
    /// motion of the nodes from `x` to `y`, m: h² c² / L³ with the change c of the vector between its ends and the distance h
    /// of that vector's line from zero, at the least length L. It is never negative.
    pub fn bends(&self, x: &[Vec3], y: &[Vec3]) -> impl Iterator<Item = f64> {
        self.struts.iter().map(|&(a, b)| {
            let (from, to) = (x[a] - x[b], y[a] - y[b]);
            let change = to - from;
            let squared = change.norm_squared();
            if squared == 0.0 {
                return 0.0;
            }
            let part = (-from.dot(&change) / squared).clamp(0.0, 1.0);
            let least = (from + change * part).norm();
            from.cross(&change).norm_squared() / (least * least * least)
        })
    }
}
