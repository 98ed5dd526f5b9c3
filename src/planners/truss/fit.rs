//! How well a truss fits its goal, both ways, and the step that fits it better: Gauss and Newton's for
//! the squared distances, with the feet of the distances held.
//!
//! The paper's energy (18) to (20) asks only that the goal is near the surface; a node that is nobody's
//! foot is free, and stands off by whole struts. Here the surface is asked to be near the goal, too.

use super::goal::{Goal, middles};
use super::step::Objective;
use super::structure::Structure;
use super::surface::Surface;
use crate::geometry::Vec3;
use std::collections::BTreeMap;

/// Pieces of each side of an outer triangle, each a point from which the goal is looked for.
const PIECES: usize = 4;

/// What is weighed, with what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// The surface's distance to the goal, beside the goal's to the surface.
    pub back: f64,
    /// The part of a distance that counts only across the surface: along it points may slide.
    pub across: f64,
    /// The squared lengths of the struts (Hoppe's springs), mean of all.
    pub springs: f64,
    /// The squared displacements, mean of all nodes.
    pub still: f64,
}

/// Root mean squares, and the farthest, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// From the goal to the surface.
    pub there: f64,
    /// From the surface to the goal.
    pub back: f64,
    /// The farthest of both.
    pub worst: f64,
}

impl Distance {
    pub fn both(&self) -> f64 {
        libm::hypot(self.there, self.back)
    }
}

/// A residual: the point with these weights over nodes should be at `at`; `normal` of the surface there.
struct Pull {
    nodes: [usize; 3],
    weights: [f64; 3],
    /// Where it is, and where it should be.
    from: Vec3,
    at: Vec3,
    normal: Vec3,
    share: f64,
}

pub struct Fit {
    pub distance: Distance,
    pulls: Vec<Pull>,
    back: Vec<Pull>,
}

/// Measures; `guesses` are the triangles on which the feet were last.
pub fn fit(faces: &[[usize; 3]], x: &[Vec3], goal: &Goal, guesses: &mut Vec<usize>) -> Fit {
    let corners: Vec<[Vec3; 3]> = faces.iter().map(|f| f.map(|node| x[node])).collect();
    let normals: Vec<Vec3> =
        corners.iter().map(|t| (t[1] - t[0]).cross(&(t[2] - t[0])).normalize()).collect();
    let area = |t: &[Vec3; 3]| (t[1] - t[0]).cross(&(t[2] - t[0])).norm();
    let whole: f64 = corners.iter().map(area).sum();
    let surface = Surface::new(corners);
    guesses.resize(goal.points.len(), 0);
    let mut distance = Distance::default();
    let mut pulls = Vec::with_capacity(goal.points.len());
    for (i, (point, share)) in goal.points.iter().zip(&goal.shares).enumerate() {
        let foot = surface.nearest(*point, Some(guesses[i]));
        guesses[i] = foot.triangle;
        distance.there += share * foot.distance * foot.distance;
        distance.worst = distance.worst.max(foot.distance);
        pulls.push(Pull {
            nodes: faces[foot.triangle],
            weights: foot.weights,
            from: foot.at,
            at: *point,
            normal: normals[foot.triangle],
            share: *share,
        });
    }
    let pieces = middles(PIECES);
    let mut back = Vec::with_capacity(faces.len() * pieces.len());
    for (triangle, corners) in surface.triangles().iter().enumerate() {
        let share = area(corners) / whole / pieces.len() as f64;
        for weights in &pieces {
            let from: Vec3 = (0..3).map(|k| corners[k] * weights[k]).sum();
            let at = goal.nearest(from);
            let apart = (from - at).norm();
            distance.back += share * apart * apart;
            distance.worst = distance.worst.max(apart);
            let normal = normals[triangle];
            back.push(Pull { nodes: faces[triangle], weights: *weights, from, at, normal, share });
        }
    }
    distance.there = libm::sqrt(distance.there);
    distance.back = libm::sqrt(distance.back);
    Fit { distance, pulls, back }
}

impl Fit {
    pub fn objective(&self, truss: &Structure, x: &[Vec3], weights: &Weights) -> Objective {
        let mut sums = Sums { hessian: BTreeMap::new(), linear: vec![0.0; 3 * truss.nodes] };
        for (pulls, weight) in [(&self.pulls, 1.0), (&self.back, weights.back)] {
            for pull in pulls.iter().filter(|_| weight > 0.0) {
                sums.pull(pull, weight, weights.across);
            }
        }
        let spring = weights.springs / truss.struts.len() as f64;
        for &(a, b) in &truss.struts {
            let d = x[a] - x[b];
            sums.add(&[(a, 1.0), (b, -1.0)], &d, spring, 0.0, &Vec3::z());
        }
        for node in 0..truss.nodes {
            sums.add(&[(node, 1.0)], &Vec3::zeros(), weights.still / truss.nodes as f64, 0.0, &Vec3::z());
        }
        Objective {
            hessian: sums.hessian.into_iter().map(|((i, j), v)| (i, j, v)).collect(),
            linear: sums.linear,
        }
    }
}

struct Sums {
    hessian: BTreeMap<(usize, usize), f64>,
    linear: Vec<f64>,
}

impl Sums {
    fn pull(&mut self, pull: &Pull, weight: f64, across: f64) {
        let terms: [(usize, f64); 3] = std::array::from_fn(|k| (pull.nodes[k], pull.weights[k]));
        self.add(&terms, &(pull.from - pull.at), weight * pull.share, across, &pull.normal);
    }

    /// `½ weight rᵀ M r` with r = residual + Σ factor u, M = (1 - across) + across normal normalᵀ.
    fn add(&mut self, terms: &[(usize, f64)], residual: &Vec3, weight: f64, across: f64, normal: &Vec3) {
        let metric =
            |i: usize, j: usize| (if i == j { 1.0 - across } else { 0.0 }) + across * normal[i] * normal[j];
        for &(a, p) in terms.iter().filter(|(_, p)| *p != 0.0) {
            for i in 0..3 {
                let pushed: f64 = (0..3).map(|j| metric(i, j) * residual[j]).sum();
                self.linear[3 * a + i] += weight * p * pushed;
                for &(b, q) in terms.iter().filter(|(b, q)| *b >= a && *q != 0.0) {
                    for j in 0..3 {
                        let value = metric(i, j);
                        if 3 * b + j >= 3 * a + i && value != 0.0 {
                            *self.hessian.entry((3 * a + i, 3 * b + j)).or_default() +=
                                weight * p * q * value;
                        }
                    }
                }
            }
        }
    }
}
