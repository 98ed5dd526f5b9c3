//! Contact points on the ground, and the distribution of normal forces over them.

use super::model::Model;
use super::tolerances::NUMERICS;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::geometry::ground_features::Feature;
use crate::plan::verify::support_polygon::{self, Margin};

/// A point of a ground feature that is near the ground, with its normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The index of the feature in [`Model::features`], from 0.
    pub feature: usize,
    /// The number of the point among those of the feature, from 0, as `Feature::point` counts.
    pub k: u8,
    /// The link of the feature, by its number among all links ([`Model::bodies`]).
    pub link: usize,
    /// The position of the point from the centre of mass, m, in level axes of the stance's heading: x forward, y
    /// left, z up.
    pub p: Vec3,
    /// The height of the point above the ground, m; negative below it.
    pub gap: f64,
    /// The normal force as a fraction of the robot's weight along the normal of the ground; all sum up to 1, or are 0.
    pub load: f64,
}

/// The contact of a link as a whole: its loaded contact points gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPatch {
    /// The link, by its number among all links ([`Model::bodies`]).
    pub link: usize,
    /// The normal force on the link as a fraction of the robot's weight.
    pub load: f64,
    /// The centre of pressure from the centre of mass along the stance's level forward axis, m.
    pub x: f64,
    /// The centre of pressure from the centre of mass along the stance's level left axis, m.
    pub y: f64,
    /// The load-weighted mean square distance of the points from the centre of pressure, m².
    pub spread: f64,
}

/// Returns all points no higher above the ground than the contact tolerance of their module, or `gap_loaded` if that
/// is more. With a `foot`, the point (x, y) at which the line of gravity meets the ground, from the centre of mass, m, those
/// within `gap_loaded` carry the weight as springs would whose stiffness falls with the gap; without one none carries any.
/// `features`: as [`Model::placed`] returns them; `height`: that of the centre of mass above the ground, m.
pub(super) fn contact_points(
    model: &Model,
    features: &[Feature],
    height: f64,
    foot: Option<[f64; 2]>,
    tolerances: &Tolerances,
) -> Vec<ContactPoint> {
    let up = Vec3::z();
    let mut found = Vec::new();
    let (mut plane, mut points) = (None, Vec::new());
    for (index, feature) in features.iter().enumerate() {
        let link = model.link_of[index];
        let limit = model.bodies[link].contact.max(tolerances.gap_loaded);
        points.clear();
        feature.points_below(&up, limit - height + NUMERICS.point_height, &mut plane, &mut points);
        let near = points.iter().map(|&(k, p)| (k, p, p.z + height)).filter(|(_, _, gap)| *gap <= limit);
        found.extend(near.map(|(k, p, gap)| ContactPoint { feature: index, k, link, p, gap, load: 0.0 }));
    }
    if let Some(foot) = foot {
        spread(&mut found, foot, tolerances);
    }
    found
}

/// Returns true if the gap of a contact point is at most the contact tolerance of its module.
pub(super) fn counts(model: &Model, contact_point: &ContactPoint) -> bool {
    contact_point.gap <= model.bodies[contact_point.link].contact
}

/// Returns the static stability margin (McGhee and Frank 1968), m: the distance of `foot`, where the line of gravity
/// through the centre of mass meets the ground, inside the hull of the contact points for which `chosen` returns true,
/// negative outside; its edge is given by indices in `contact_points`. `None` if they span no area.
pub(super) fn margin(
    contact_points: &[ContactPoint],
    foot: [f64; 2],
    chosen: impl Fn(&ContactPoint) -> bool,
) -> Option<Margin> {
    let indices: Vec<usize> = (0..contact_points.len()).filter(|&i| chosen(&contact_points[i])).collect();
    let points: Vec<_> = indices.iter().map(|&i| [contact_points[i].p.x, contact_points[i].p.y]).collect();
    let found = support_polygon::margin(&points, foot)?;
    Some(Margin { edge: (indices[found.edge.0], indices[found.edge.1]), ..found })
}

/// Returns the loaded contact points gathered by link, in ascending order of link. A wheel that touches with both
/// rims has one patch so: two patches that each stuck would make it turn as a wheel as far out as its outer rim.
pub(super) fn patches(contact_points: &[ContactPoint]) -> Vec<ContactPatch> {
    let mut found: Vec<ContactPatch> = Vec::new();
    let loaded = || contact_points.iter().filter(|t| t.load > 0.0);
    for contact_point in loaded() {
        let at = match found.binary_search_by_key(&contact_point.link, |patch| patch.link) {
            Ok(at) => at,
            Err(at) => {
                found.insert(
                    at,
                    ContactPatch { link: contact_point.link, load: 0.0, x: 0.0, y: 0.0, spread: 0.0 },
                );
                at
            }
        };
        let patch = &mut found[at];
        patch.load += contact_point.load;
        patch.x += contact_point.load * contact_point.p.x;
        patch.y += contact_point.load * contact_point.p.y;
    }
    for patch in &mut found {
        patch.x /= patch.load;
        patch.y /= patch.load;
    }
    for contact_point in loaded() {
        if let Ok(at) = found.binary_search_by_key(&contact_point.link, |patch| patch.link) {
            let patch = &mut found[at];
            let (dx, dy) = (contact_point.p.x - patch.x, contact_point.p.y - patch.y);
            patch.spread += contact_point.load * (dx * dx + dy * dy) / patch.load;
        }
    }
    found
}

/// The numbers of rounds: of the proximal method, of Newton's method in one of them, and of halvings of one step.
const PROXIMAL_ROUNDS: usize = 3;
const NEWTON_ROUNDS_MAX: usize = 60;
const HALVINGS_MAX: usize = 40;

/// Sets the loads: `min Σ N²/κ` with the sum of all N the weight, no moment about the `foot` of gravity's line and N ≥ 0,
/// where κ falls with the gap. Solved by its Lagrangian dual in three unknowns: `N = κ max(0, λ·g)` with `g = (1, x,
/// y)`. If no such loads exist, the moment left is least.
fn spread(contact_points: &mut [ContactPoint], foot: [f64; 2], tolerances: &Tolerances) {
    let near = |t: &ContactPoint| t.gap <= tolerances.gap_loaded;
    let from_foot = |t: &ContactPoint| [t.p.x - foot[0], t.p.y - foot[1]];
    let size = contact_points
        .iter()
        .filter(|t| near(t))
        .map(from_foot)
        .fold(0.0_f64, |s, [x, y]| s.max(x.abs()).max(y.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    let springs: Vec<(f64, Vec3, usize)> = contact_points
        .iter()
        .enumerate()
        .filter(|(_, t)| near(t))
        .map(|(i, t)| {
            let stiffness = (1.0 - t.gap / tolerances.gap_loaded).max(tolerances.stiffness_min);
            let [x, y] = from_foot(t);
            (stiffness * stiffness, Vec3::new(1.0, x / size, y / size), i)
        })
        .collect();
    let total: f64 = springs.iter().map(|s| s.0).sum();
    if springs.is_empty() {
        return;
    }
    let mut lambda = Vec3::new(1.0 / total, 0.0, 0.0);
    for _ in 0..PROXIMAL_ROUNDS {
        lambda = newton(&springs, lambda);
    }
    let loads = springs.iter().map(|(kappa, g, _)| kappa * lambda.dot(g).max(0.0));
    let sum: f64 = loads.clone().sum();
    for (load, (_, _, i)) in loads.zip(&springs) {
        contact_points[*i].load = if sum > 0.0 { load / sum } else { 0.0 };
    }
}

/// Minimizes `½ Σ κ max(0, λ·g)² - λ₀ + δ/2 |λ - λ'|²` by Newton's method with halving: it is convex
/// and made of quadratic pieces, so it ends exactly.
fn newton(springs: &[(f64, Vec3, usize)], before: Vec3) -> Vec3 {
    let value = |lambda: &Vec3| {
        let bent: f64 =
            springs.iter().map(|(k, g, _)| k * lambda.dot(g).max(0.0) * lambda.dot(g).max(0.0)).sum();
        0.5 * bent - lambda.x + 0.5 * NUMERICS.proximal_weight * (lambda - before).norm_squared()
    };
    let mut lambda = before;
    for _ in 0..NEWTON_ROUNDS_MAX {
        let mut gradient = (lambda - before) * NUMERICS.proximal_weight - Vec3::x();
        let mut hessian = crate::geometry::Mat3::from_diagonal_element(NUMERICS.proximal_weight);
        for (kappa, g, _) in springs {
            let pressed = lambda.dot(g);
            if pressed > 0.0 {
                gradient += g * (kappa * pressed);
                hessian += g * g.transpose() * *kappa;
            }
        }
        if gradient.norm() < NUMERICS.dual_gradient {
            break;
        }
        let Some(step) = hessian.cholesky().map(|c| c.solve(&gradient)) else { break };
        let now = value(&lambda);
        let mut part = 1.0;
        let shortened = (0..HALVINGS_MAX).find_map(|_| {
            let next = lambda - step * part;
            part *= 0.5;
            (value(&next) <= now).then_some(next)
        });
        let Some(next) = shortened else { break };
        if next == lambda {
            break;
        }
        lambda = next;
    }
    lambda
}
