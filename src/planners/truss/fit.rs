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
use nalgebra::Matrix3;
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
        let mut sums = Sums { blocks: BTreeMap::new(), linear: vec![Vec3::zeros(); truss.nodes] };
        // Of one face all residuals have one metric, so that their weights can be added up first.
        let mut faces: BTreeMap<[usize; 3], Face> = BTreeMap::new();
        for (pulls, weight) in [(&self.pulls, 1.0), (&self.back, weights.back)] {
            for pull in pulls.iter().filter(|_| weight > 0.0) {
                faces
                    .entry(pull.nodes)
                    .or_insert_with(|| Face::new(pull.normal))
                    .add(pull, weight * pull.share);
            }
        }
        for (nodes, face) in &faces {
            let metric = Matrix3::identity() * (1.0 - weights.across)
                + face.normal * face.normal.transpose() * weights.across;
            for k in 0..3 {
                sums.linear[nodes[k]] += metric * face.pushed[k];
                for l in (0..3).filter(|l| nodes[*l] >= nodes[k]) {
                    sums.block(nodes[k], nodes[l], metric * face.weights[(k, l)]);
                }
            }
        }
        let spring = weights.springs / truss.struts.len() as f64;
        for &(a, b) in &truss.struts {
            let pushed = (x[a] - x[b]) * spring;
            sums.linear[a] += pushed;
            sums.linear[b] -= pushed;
            sums.block(a, a, Matrix3::identity() * spring);
            sums.block(b, b, Matrix3::identity() * spring);
            sums.block(a.min(b), a.max(b), -Matrix3::identity() * spring);
        }
        for node in 0..truss.nodes {
            sums.block(node, node, Matrix3::identity() * (weights.still / truss.nodes as f64));
        }
        sums.objective()
    }
}

/// The residuals whose points are on one face: `½ Σ weight rᵀ M r`.
struct Face {
    normal: Vec3,
    /// Sums of weight times the points' weights over the corners, two at a time.
    weights: Matrix3<f64>,
    /// Of weight times a point's weight times its residual, by corner.
    pushed: [Vec3; 3],
}

impl Face {
    fn new(normal: Vec3) -> Face {
        Face { normal, weights: Matrix3::zeros(), pushed: [Vec3::zeros(); 3] }
    }

    fn add(&mut self, pull: &Pull, weight: f64) {
        let corners = Vec3::from(pull.weights);
        self.weights += corners * corners.transpose() * weight;
        for k in 0..3 {
            self.pushed[k] += (pull.from - pull.at) * (weight * corners[k]);
        }
    }
}

/// Of H the blocks on and above the diagonal, by nodes.
struct Sums {
    blocks: BTreeMap<(usize, usize), Matrix3<f64>>,
    linear: Vec<Vec3>,
}

impl Sums {
    fn block(&mut self, a: usize, b: usize, value: Matrix3<f64>) {
        *self.blocks.entry((a, b)).or_insert_with(Matrix3::zeros) += value;
    }

    fn objective(&self) -> Objective {
        let mut hessian = Vec::with_capacity(9 * self.blocks.len());
        for ((a, b), block) in &self.blocks {
            for i in 0..3 {
                let above = if a == b { i } else { 0 };
                let entries = (above..3).map(|j| (3 * a + i, 3 * b + j, block[(i, j)]));
                hessian.extend(entries.filter(|(_, _, value)| *value != 0.0));
            }
        }
        let linear = self.linear.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        Objective { hessian, linear, sizes: Vec::new() }
    }
}
