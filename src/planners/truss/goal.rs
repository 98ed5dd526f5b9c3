//! What a truss is to look like: points of a surface, and the surface where it is known.

use super::surface::Surface;
use crate::geometry::Vec3;

/// Points in all.
const POINTS_MAX: usize = 20_000;

pub struct Goal {
    pub points: Vec<Vec3>,
    /// The parts of the surface that the points stand for; their sum is 1.
    pub shares: Vec<f64>,
    pub surface: Option<Surface>,
}

impl Goal {
    /// Points that count alike.
    pub fn cloud(points: Vec<Vec3>) -> Goal {
        let share = 1.0 / points.len().max(1) as f64;
        Goal { shares: vec![share; points.len()], points, surface: None }
    }

    /// A surface with a point for about every square of side `apart`, m.
    pub fn surface(triangles: Vec<[Vec3; 3]>, apart: f64) -> Goal {
        let area = |t: &[Vec3; 3]| (t[1] - t[0]).cross(&(t[2] - t[0])).norm() / 2.0;
        let whole: f64 = triangles.iter().map(area).sum();
        let apart = apart.max(libm::sqrt(whole / POINTS_MAX as f64));
        let (mut points, mut shares) = (Vec::new(), Vec::new());
        for t in &triangles {
            let n = libm::ceil(libm::sqrt(area(t)) / apart).max(1.0) as usize;
            let share = area(t) / whole / (n * n) as f64;
            for middle in middles(n) {
                points.push(t[0] * middle[0] + t[1] * middle[1] + t[2] * middle[2]);
                shares.push(share);
            }
        }
        Goal { points, shares, surface: Some(Surface::new(triangles)) }
    }

    pub fn centre(&self) -> Vec3 {
        self.points.iter().zip(&self.shares).map(|(p, share)| p * *share).sum()
    }

    /// Every point moved.
    pub fn moved(&self, motion: impl Fn(&Vec3) -> Vec3) -> Goal {
        let surface = self.surface.as_ref();
        let surface =
            surface.map(|s| Surface::new(s.triangles().iter().map(|t| t.each_ref().map(&motion)).collect()));
        Goal { points: self.points.iter().map(&motion).collect(), shares: self.shares.clone(), surface }
    }

    /// The point of the goal nearest to `p`.
    pub fn nearest(&self, p: Vec3) -> Vec3 {
        match &self.surface {
            Some(surface) => surface.nearest(p, None).at,
            None => {
                let apart = |q: &&Vec3| (p - **q).norm_squared();
                *self.points.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("a goal has points")
            }
        }
    }
}

/// Weights of the middles of the n² equal triangles that a triangle is divided into.
pub fn middles(n: usize) -> Vec<[f64; 3]> {
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
