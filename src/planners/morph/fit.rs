//! The fit of the outer surface of a truss to its target, and the Gauss-Newton model of the squared distances
//! with their closest points fixed (as in iterative closest point, ICP).
//!
//! The paper's energy (18) to (20) asks only that the target is near the surface; a node that is closest to
//! no sample is free, and stands off by whole struts. Here the surface has to be near the target, too.

use super::surface::{Nearest, Surface};
use super::target::{Target, centroids};
use crate::geometry::Vec3;
use crate::planners::truss::Structure;
use crate::planners::truss::step::QuadraticCost;
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Outer triangles are sampled at the centroids of the squares of this many smaller ones.
const PIECES: usize = 4;

/// The weights of the terms of the cost that a step of a morph minimises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weights {
    /// The weight of the squared distances from surface to target, relative to that of those from target to surface,
    /// without unit.
    pub surface_to_target: f64,
    /// The fraction, 0 to 1, of a squared distance that counts only across the surface (point to plane).
    pub point_to_plane: f64,
    /// The weight of the mean of the squared strut lengths (the springs of Hoppe et al., "Mesh optimization"),
    /// relative to that of the distances, without unit.
    pub springs: f64,
    /// The weight of the mean of the squared displacements of the nodes, relative to that of the distances, without
    /// unit.
    pub damping: f64,
}

/// The distances between the outer surface of a truss and its target, m, at sample points or over the whole of both.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// The root mean square distance of the target from the surface, m.
    pub target_to_surface: f64,
    /// The root mean square distance of the surface from the target, m.
    pub surface_to_target: f64,
    /// The greatest distance of a point in either direction (Hausdorff distance), m.
    pub worst: f64,
}

impl Distance {
    /// Returns the square root of the sum of the squares of the two root mean square distances, m.
    pub fn both(&self) -> f64 {
        libm::hypot(self.target_to_surface, self.surface_to_target)
    }

    /// Returns the distances times a factor.
    pub(super) fn scaled(&self, factor: f64) -> Distance {
        Distance {
            target_to_surface: self.target_to_surface * factor,
            surface_to_target: self.surface_to_target * factor,
            worst: self.worst * factor,
        }
    }

    /// Returns true if both root mean square distances are at most `tolerance` (m).
    pub fn within(&self, tolerance: f64) -> bool {
        self.target_to_surface <= tolerance && self.surface_to_target <= tolerance
    }
}

/// A residual: a point of the surface, with barycentric `weights` over the nodes of its triangle, that should be at `at`.
struct Residual {
    /// The index of the outer triangle that the point lies on.
    face: usize,
    weights: [f64; 3],
    /// The present position and the wanted one, m.
    from: Vec3,
    at: Vec3,
    fraction: f64,
}

/// The distances of a truss from its target, with the residuals that a least-squares step reduces.
pub(super) struct Fit {
    /// The distances between the outer surface of the truss and the target, m.
    pub distance: Distance,
    /// The outer triangles, as indices of nodes, and their unit normals.
    faces: Vec<([usize; 3], Vec3)>,
    forward: Vec<Residual>,
    backward: Vec<Residual>,
}

/// The triangles that were closest last, which spare searches for those that are closest now.
#[derive(Default)]
pub(super) struct Guesses {
    /// The positions of the nodes then, m; empty at first.
    x: Vec<Vec3>,
    /// The closest outer triangle, for each sample point of the target.
    faces: Vec<Nearest>,
    /// The closest triangle or point of the target, for each sample point of the surface.
    triangles: Vec<Nearest>,
}

/// Measures the fit of the outer triangles `faces` (indices of nodes) with the nodes at `x` (m, by index) to the
/// target, in one frame. `guesses` are those of the last measurement of these faces and this target, and are renewed.
/// Panics if there is no triangle.
pub(super) fn fit(faces: &[[usize; 3]], x: &[Vec3], target: &Target, guesses: &mut Guesses) -> Fit {
    let corners: Vec<[Vec3; 3]> = faces.iter().map(|f| f.map(|node| x[node])).collect();
    let normals: Vec<Vec3> =
        corners.iter().map(|t| (t[1] - t[0]).cross(&(t[2] - t[0])).normalize()).collect();
    let area = |t: &[Vec3; 3]| (t[1] - t[0]).cross(&(t[2] - t[0])).norm();
    let whole: f64 = corners.iter().map(area).sum();
    let surface = Surface::new(corners);
    guesses.faces.resize(target.points.len(), Nearest::UNKNOWN);
    // The distance by which each node has moved, and the greatest.
    let moved: Vec<f64> =
        x.iter().enumerate().map(|(i, p)| guesses.x.get(i).map_or(0.0, |q| (p - q).norm())).collect();
    let farthest = moved.iter().copied().fold(0.0, f64::max);
    guesses.x = x.to_vec();
    let mut distance = Distance::default();
    let mut forward = Vec::with_capacity(target.points.len());
    // From each sample point of the target to the surface.
    let samples = target.points.iter().zip(&target.fractions);
    for ((point, fraction), nearest) in samples.zip(&mut guesses.faces) {
        let foot = surface.follow(*point, nearest, farthest);
        distance.target_to_surface += fraction * foot.distance * foot.distance;
        distance.worst = distance.worst.max(foot.distance);
        forward.push(Residual {
            face: foot.triangle,
            weights: foot.weights,
            from: foot.at,
            at: *point,
            fraction: *fraction,
        });
    }
    // From points of the surface to the target.
    let pieces = centroids(PIECES);
    let mut backward = Vec::with_capacity(faces.len() * pieces.len());
    guesses.triangles.resize(faces.len() * pieces.len(), Nearest::UNKNOWN);
    let mut nearest = guesses.triangles.iter_mut();
    for (triangle, corners) in surface.triangles().iter().enumerate() {
        let fraction = area(corners) / whole / pieces.len() as f64;
        let moved = faces[triangle].map(|node| moved[node]).into_iter().fold(0.0, f64::max);
        for weights in &pieces {
            let from: Vec3 = (0..3).map(|k| corners[k] * weights[k]).sum();
            let at = target.follow(from, nearest.next().expect("each point has one"), moved);
            let apart = (from - at).norm();
            distance.surface_to_target += fraction * apart * apart;
            distance.worst = distance.worst.max(apart);
            backward.push(Residual { face: triangle, weights: *weights, from, at, fraction });
        }
    }
    distance.target_to_surface = libm::sqrt(distance.target_to_surface);
    distance.surface_to_target = libm::sqrt(distance.surface_to_target);
    let faces = faces.iter().copied().zip(normals).collect();
    Fit { distance, faces, forward, backward }
}

impl Fit {
    /// Returns the Gauss-Newton model of the weighted squared distances, with springs and damping, as a quadratic cost
    /// of displacements (m) of the nodes from `x` (m, by index). `weights`: those of the terms.
    pub(super) fn cost(&self, truss: &Structure, x: &[Vec3], weights: &Weights) -> QuadraticCost {
        let mut sums = Sums { blocks: BTreeMap::new(), linear: vec![Vec3::zeros(); truss.nodes] };
        // All residuals of one face have the same metric, so their weights can be added up first.
        let mut faces = vec![Face::default(); self.faces.len()];
        for (residuals, weight) in [(&self.forward, 1.0), (&self.backward, weights.surface_to_target)] {
            for residual in residuals.iter().filter(|_| weight > 0.0) {
                faces[residual.face].add(residual, weight * residual.fraction);
            }
        }
        let mut order: Vec<usize> = (0..faces.len()).collect();
        order.sort_unstable_by_key(|face| self.faces[*face].0);
        for face in order {
            let ((nodes, normal), face) = (&self.faces[face], &faces[face]);
            let metric = Matrix3::identity() * (1.0 - weights.point_to_plane)
                + normal * normal.transpose() * weights.point_to_plane;
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
            sums.block(node, node, Matrix3::identity() * (weights.damping / truss.nodes as f64));
        }
        sums.cost()
    }
}

/// The residuals r whose points are on one face: `½ Σ weight rᵀ M r`.
#[derive(Clone, Default)]
struct Face {
    /// The sum of weight times the outer product of barycentric weights.
    weights: Matrix3<f64>,
    /// The sum of weight times barycentric weight times residual, by corner.
    pushed: [Vec3; 3],
}

impl Face {
    fn add(&mut self, residual: &Residual, weight: f64) {
        let corners = Vec3::from(residual.weights);
        self.weights += corners * corners.transpose() * weight;
        for k in 0..3 {
            self.pushed[k] += (residual.from - residual.at) * (weight * corners[k]);
        }
    }
}

/// The Hessian in blocks of 3 by 3 on and above the diagonal, by pairs of nodes, and the linear term.
struct Sums {
    blocks: BTreeMap<(usize, usize), Matrix3<f64>>,
    linear: Vec<Vec3>,
}

impl Sums {
    fn block(&mut self, a: usize, b: usize, value: Matrix3<f64>) {
        *self.blocks.entry((a, b)).or_insert_with(Matrix3::zeros) += value;
    }

    fn cost(&self) -> QuadraticCost {
        let mut hessian = Vec::with_capacity(9 * self.blocks.len());
        for ((a, b), block) in &self.blocks {
            for i in 0..3 {
                let above = if a == b { i } else { 0 };
                let entries = (above..3).map(|j| (3 * a + i, 3 * b + j, block[(i, j)]));
                hessian.extend(entries.filter(|(_, _, value)| *value != 0.0));
            }
        }
        let linear = self.linear.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        QuadraticCost { hessian, linear, absolutes: Vec::new() }
    }
}
