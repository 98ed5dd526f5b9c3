//! A truss as its planners see it: who is joined to whom, and what its struts allow.

use super::surroundings::Surroundings;
use crate::geometry::Vec3;
use crate::robot::Strut;

/// A value is below zero if it is by more than this part of the unit.
pub const ROUNDING: f64 = 1e-10;

/// Lengths in metres; `unit` is the mean length of a strut at the start, by which steps are measured.
#[derive(Clone, Debug)]
pub struct Structure {
    pub nodes: usize,
    pub struts: Vec<(usize, usize)>,
    /// The range of each.
    pub lengths: Vec<(f64, f64)>,
    /// Of each strut, m/s.
    pub speed: f64,
    /// Between struts that share no node.
    pub clearance: f64,
    /// The part of the whole mass that each node carries: half of each of its struts.
    pub shares: Vec<f64>,
    pub unit: f64,
    pub limits: Limits,
    /// Struts that share a node, where their angles have a limit.
    pub corners: Vec<(usize, usize)>,
    pub around: Surroundings,
}

/// Limits beside those that every strut has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// Between struts that share a node, rad; of 0 there is none.
    pub angle: f64,
    /// The least singular value of the rigidity matrix (rows of unit vectors) that is not one of a rigid
    /// motion, after every step; of 0 there is none.
    pub rigidity: f64,
    /// Struts that keep the length they have at the start: they failed, or have no motor.
    pub still: Vec<usize>,
    /// Struts of one tube or cable: the sum of their lengths stays.
    pub loops: Vec<Loop>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    pub struts: Vec<usize>,
    /// What their lengths add up to, m.
    pub range: (f64, f64),
}

/// Lengths that stay may be off by this part of the unit: nodes go straight on, and what turns meanwhile
/// gets shorter in between.
pub const SLACK: f64 = 2e-3;

impl Structure {
    pub fn new(strut: &Strut, start: &[Vec3], struts: &[(usize, usize)]) -> Structure {
        let mut shares = vec![0.0; start.len()];
        for &(a, b) in struts {
            shares[a] += 0.5 / struts.len() as f64;
            shares[b] += 0.5 / struts.len() as f64;
        }
        let length = |&(a, b): &(usize, usize)| (start[a] - start[b]).norm();
        Structure {
            nodes: start.len(),
            struts: struts.to_vec(),
            lengths: vec![strut.length; struts.len()],
            speed: strut.speed,
            clearance: strut.clearance,
            shares,
            unit: struts.iter().map(length).sum::<f64>() / struts.len().max(1) as f64,
            limits: Limits::default(),
            corners: Vec::new(),
            around: Surroundings::default(),
        }
    }

    /// Under more limits; loops are of struts, and keep the sum that they have at the start.
    pub fn limited(mut self, start: &[Vec3], limits: Limits) -> Structure {
        let slack = SLACK * self.unit;
        for &strut in &limits.still {
            let length = self.length(start, strut);
            self.lengths[strut] = (length - slack, length + slack);
        }
        if limits.angle > 0.0 {
            let count = self.struts.len();
            let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
            self.corners = pairs.filter(|&(i, j)| self.share_node(i, j)).collect();
        }
        self.limits = limits;
        for i in 0..self.limits.loops.len() {
            let sum = self.around(start, i);
            self.limits.loops[i].range = (sum - slack, sum + slack);
        }
        self
    }

    /// Among obstacles, and on uneven ground.
    pub fn amid(mut self, around: Surroundings) -> Structure {
        self.around = around;
        self
    }

    /// With distances and angles that are greater by a little, in units and rad, so that certificates end.
    pub fn cautious(&self, cushion: f64) -> Structure {
        let mut truss = self.clone();
        truss.clearance += cushion * self.unit;
        truss.limits.angle += if self.limits.angle > 0.0 { cushion } else { 0.0 };
        truss
    }

    /// What the lengths of a loop add up to.
    pub fn around(&self, x: &[Vec3], index: usize) -> f64 {
        self.limits.loops[index].struts.iter().map(|&strut| self.length(x, strut)).sum()
    }

    /// The node of two struts that share one, and their others.
    pub fn corner(&self, i: usize, j: usize) -> (usize, usize, usize) {
        let ((a, b), (c, d)) = (self.struts[i], self.struts[j]);
        match (a == c, a == d, b == c) {
            (true, _, _) => (a, b, d),
            (_, true, _) => (a, b, c),
            (_, _, true) => (b, a, d),
            _ => (b, a, c),
        }
    }

    pub fn length(&self, x: &[Vec3], strut: usize) -> f64 {
        let (a, b) = self.struts[strut];
        (x[a] - x[b]).norm()
    }

    pub fn segment(&self, x: &[Vec3], strut: usize) -> (Vec3, Vec3) {
        let (a, b) = self.struts[strut];
        (x[a], x[b])
    }

    pub fn share_node(&self, i: usize, j: usize) -> bool {
        let ((a, b), (c, d)) = (self.struts[i], self.struts[j]);
        a == c || a == d || b == c || b == d
    }

    /// The centre of mass.
    pub fn centre(&self, x: &[Vec3]) -> Vec3 {
        x.iter().zip(&self.shares).map(|(p, share)| p * *share).sum()
    }

    /// How fast each strut has to be for the nodes to go from `x` to `y` evenly in one second, at most: a
    /// strut's rate only grows while its nodes go straight on, so it is greatest at an end. m/s.
    pub fn rates(&self, x: &[Vec3], y: &[Vec3]) -> impl Iterator<Item = f64> {
        self.struts.iter().map(|&(a, b)| {
            let (from, to) = (x[a] - x[b], y[a] - y[b]);
            let change = to - from;
            let rate = |d: &Vec3| change.dot(d) / d.norm();
            rate(&from).abs().max(rate(&to).abs())
        })
    }
}
