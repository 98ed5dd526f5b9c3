//! A truss as its planners see it: who is joined to whom, and what its struts allow.

use crate::geometry::Vec3;
use crate::robot::Strut;

/// Lengths in metres; `unit` is the mean length of a strut at the start, by which steps are measured.
#[derive(Clone, Debug)]
pub struct Structure {
    pub nodes: usize,
    pub struts: Vec<(usize, usize)>,
    /// Of each strut.
    pub length: (f64, f64),
    /// Of each strut, m/s.
    pub speed: f64,
    /// Between struts that share no node.
    pub clearance: f64,
    /// The part of the whole mass that each node carries: half of each of its struts.
    pub shares: Vec<f64>,
    pub unit: f64,
}

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
            length: strut.length,
            speed: strut.speed,
            clearance: strut.clearance,
            shares,
            unit: struts.iter().map(length).sum::<f64>() / struts.len().max(1) as f64,
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
