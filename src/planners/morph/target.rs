//! The target of a morph: sample points of a surface, and the surface where it is known.

use super::surface::{Nearest, Surface};
use crate::geometry::Vec3;

/// The greatest number of sample points.
const POINTS_MAX: usize = 20_000;

/// A shape that a truss has to take on, as weighted sample points, and as a surface where one is known.
pub struct Target {
    /// The sample points of the shape, m.
    pub points: Vec<Vec3>,
    /// The fraction of the surface that each point stands for, in the order of `points`; they add up to 1.
    pub fractions: Vec<f64>,
    /// The surface of the shape; `None` for a cloud of points.
    pub surface: Option<Surface>,
}

impl Target {
    /// Returns a target of points (m) of equal weight, without a surface between them.
    pub fn cloud(points: Vec<Vec3>) -> Target {
        let fraction = 1.0 / points.len().max(1) as f64;
        Target { fractions: vec![fraction; points.len()], points, surface: None }
    }

    /// Returns a target of triangles, m, with a sample point for about every square of side `spacing`, m, and at least
    /// one for each triangle; the spacing is widened so that there are not many more than `POINTS_MAX`. The triangles
    /// together must have area.
    pub fn surface(triangles: Vec<[Vec3; 3]>, spacing: f64) -> Target {
        let area = |t: &[Vec3; 3]| (t[1] - t[0]).cross(&(t[2] - t[0])).norm() / 2.0;
        let whole: f64 = triangles.iter().map(area).sum();
        let spacing = spacing.max(libm::sqrt(whole / POINTS_MAX as f64));
        let (mut points, mut fractions) = (Vec::new(), Vec::new());
        for t in &triangles {
            let n = libm::ceil(libm::sqrt(area(t)) / spacing).max(1.0) as usize;
            let fraction = area(t) / whole / (n * n) as f64;
            for middle in centroids(n) {
                points.push(t[0] * middle[0] + t[1] * middle[1] + t[2] * middle[2]);
                fractions.push(fraction);
            }
        }
        Target { points, fractions, surface: Some(Surface::new(triangles)) }
    }

    /// Returns the mean of the sample points, m, each weighted by the fraction of the surface that it stands for.
    pub fn centroid(&self) -> Vec3 {
        self.points.iter().zip(&self.fractions).map(|(p, fraction)| p * *fraction).sum()
    }

    /// Returns the target with every point (m) mapped by `motion`, which has to be a rigid motion: weights and
    /// distances are kept.
    pub fn moved(&self, motion: impl Fn(&Vec3) -> Vec3) -> Target {
        let surface = self.surface.as_ref();
        let surface =
            surface.map(|s| Surface::new(s.triangles().iter().map(|t| t.each_ref().map(&motion)).collect()));
        let points = self.points.iter().map(&motion).collect();
        Target { points, fractions: self.fractions.clone(), surface }
    }

    /// Returns the point of the target closest to `p`, m: of the surface, or of the points of a cloud; of equal ones
    /// the first. `nearest`: what was found for a point no farther than `moved`, m, from `p`; it is renewed. Panics for a
    /// cloud without points.
    pub(super) fn follow(&self, p: Vec3, nearest: &mut Nearest, moved: f64) -> Vec3 {
        if let Some(surface) = &self.surface {
            return surface.follow(p, nearest, moved).at;
        }
        let apart = |q: &Vec3| (p - q).norm();
        nearest.others -= moved;
        if self.points.get(nearest.triangle).is_none_or(|q| apart(q) >= nearest.others) {
            let mut found = Nearest { triangle: 0, others: f64::INFINITY };
            let mut least = apart(self.points.first().expect("a target has points"));
            for (index, q) in self.points.iter().enumerate().skip(1) {
                let distance = apart(q);
                found.others = found.others.min(distance.max(least));
                if distance < least {
                    (found.triangle, least) = (index, distance);
                }
            }
            *nearest = found;
        }
        self.points[nearest.triangle]
    }
}

/// Returns the barycentric coordinates (each three sum to 1) of the centroids of the n² congruent triangles into which
/// a triangle is divided by n parts of each side; empty for 0.
pub(super) fn centroids(n: usize) -> Vec<[f64; 3]> {
    let mut found = Vec::new();
    for i in 0..n {
        for j in 0..n - i {
            let at = |u: f64, v: f64| {
                let (u, v) = (u / n as f64, v / n as f64);
                [1.0 - u - v, u, v]
            };
            let (i, j) = (i as f64, j as f64);
            found.push(at(i + 1.0 / 3.0, j + 1.0 / 3.0));
            if i + j + 2.0 <= n as f64 {
                found.push(at(i + 2.0 / 3.0, j + 2.0 / 3.0));
            }
        }
    }
    found
}
