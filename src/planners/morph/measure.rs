//! The distances between the outer surface of a truss and its target over the whole of both, not only at the points that a
//! descent fits: there they are least.

use super::fit::Distance;
use super::surface::{Nearest, Surface};
use super::target::{Target, centroids};
use crate::geometry::Vec3;
use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The relative change of a root mean square, with twice as many points along each side, up to which it counts as known.
const CHANGE: f64 = 0.01;
/// The part of the greatest distance by which one that is not found may be greater.
const WORST_EXCESS: f64 = 0.01;
/// The greatest number of points at which a mean is taken, and of pieces that are searched for the greatest distance.
const POINTS_MAX: usize = 100_000;
/// The number of pieces along the sides of a triangle of mean area, at first.
const PIECES: f64 = 8.0;

/// Returns the distances between the outer triangles `faces` (indices of nodes) with the nodes at `x` (m, by index) and the
/// target, in one frame: root mean squares over all of both to about a percent, and the greatest distance from below to a
/// percent (Hausdorff distance). Of a cloud of points, the points are all there is.
pub(super) fn measured(faces: &[[usize; 3]], x: &[Vec3], target: &Target) -> Distance {
    let surface = Surface::new(faces.iter().map(|face| face.map(|node| x[node])).collect());
    let to_surface = following(|p, nearest, moved| surface.follow(p, nearest, moved).distance);
    let to_target = following(|p, nearest, moved| (target.follow(p, nearest, moved) - p).norm());
    let (there, worst_there) = match &target.surface {
        Some(wanted) => (mean(wanted, &to_surface), worst(wanted, &to_surface)),
        None => {
            let squares = target.points.iter().zip(&target.fractions);
            let apart: Vec<(f64, f64)> = squares.map(|(p, part)| (to_surface(*p), *part)).collect();
            let mean = apart.iter().map(|(d, part)| d * d * part).sum::<f64>().sqrt();
            (mean, apart.iter().map(|(d, _)| *d).fold(0.0, f64::max))
        }
    };
    Distance {
        target_to_surface: there,
        surface_to_target: mean(&surface, &to_target),
        worst: worst_there.max(worst(&surface, &to_target)),
    }
}

/// Returns a distance that is asked for points near each other, one after the other: each search begins with what the last
/// one has found.
fn following(distance: impl Fn(Vec3, &mut Nearest, f64) -> f64) -> impl Fn(Vec3) -> f64 {
    let last = Cell::new((Vec3::zeros(), Nearest::UNKNOWN));
    move |p| {
        let (before, mut nearest) = last.get();
        let found = distance(p, &mut nearest, (p - before).norm());
        last.set((p, nearest));
        found
    }
}

/// Returns the root mean square of a distance over a surface, with ever more points until that changes little.
fn mean(surface: &Surface, distance: &dyn Fn(Vec3) -> f64) -> f64 {
    let area = |t: &[Vec3; 3]| (t[1] - t[0]).cross(&(t[2] - t[0])).norm() / 2.0;
    let triangles = surface.triangles();
    let whole: f64 = triangles.iter().map(area).sum();
    if whole <= 0.0 {
        return 0.0;
    }
    let mut spacing = libm::sqrt(whole / triangles.len() as f64) / PIECES;
    let mut before = f64::INFINITY;
    loop {
        let pieces = |t: &[Vec3; 3]| libm::ceil(libm::sqrt(area(t)) / spacing).max(1.0) as usize;
        let mut sum = 0.0;
        for t in triangles {
            let points = centroids(pieces(t));
            let part = area(t) / whole / points.len() as f64;
            for [a, b, c] in points {
                let apart = distance(t[0] * a + t[1] * b + t[2] * c);
                sum += part * apart * apart;
            }
        }
        let now = libm::sqrt(sum);
        let next: usize = triangles.iter().map(|t| 4 * pieces(t) * pieces(t)).sum();
        if (now - before).abs() <= CHANGE * now || next > POINTS_MAX {
            return now;
        }
        (before, spacing) = (now, spacing / 2.0);
    }
}

/// A part of a surface, with an upper bound on the distances of its points.
struct Piece {
    bound: f64,
    corners: [Vec3; 3],
}

impl PartialEq for Piece {
    fn eq(&self, other: &Piece) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Piece) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Piece) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Returns the greatest of a distance over a surface, by branch and bound: it changes no faster than the point moves.
fn worst(surface: &Surface, distance: &dyn Fn(Vec3) -> f64) -> f64 {
    let mut greatest = 0.0f64;
    let mut open = BinaryHeap::new();
    let add = |corners: [Vec3; 3], greatest: &mut f64, open: &mut BinaryHeap<Piece>| {
        let middle = corners.iter().sum::<Vec3>() / 3.0;
        let apart = distance(middle);
        *greatest = greatest.max(apart);
        let reach = corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        open.push(Piece { bound: apart + reach, corners });
    };
    for corners in surface.triangles() {
        greatest = corners.iter().map(|corner| distance(*corner)).fold(greatest, f64::max);
        add(*corners, &mut greatest, &mut open);
    }
    for _ in 0..POINTS_MAX {
        let Some(Piece { bound, corners: [a, b, c] }) = open.pop() else { break };
        if bound <= greatest * (1.0 + WORST_EXCESS) {
            break;
        }
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            add(corners, &mut greatest, &mut open);
        }
    }
    greatest
}
