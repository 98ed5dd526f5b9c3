//! Signed distances between solids.

use super::approach::approach;
use super::{Part, Pose, Solid, Vec3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::details::contact_support_map_support_map;
use parry3d_f64::shape::SupportMap;

/// How near two convex parts are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearness {
    /// Between nearest points; negative where the parts overlap: the least shift that parts them. m
    pub distance: f64,
    /// From the first towards the second, in the first one's frame: the direction of the distance.
    pub normal: Vec3,
}

/// Between two parts; `X_AB` is the pose of b's frame in a's. Apart: to 1e-8 m. Where round parts
/// overlap: to about a micrometre, and never too small a depth.
pub fn between_parts(a: &Part, b: &Part, X_AB: &Pose) -> Nearness {
    near(a, b, X_AB, None, f64::MAX)
}

/// As [`between_parts`], but begun with a normal that was good before, and stopped as soon as the
/// distance is known to be more than `enough`: then the gap along the normal is.
pub fn near(a: &Part, b: &Part, X_AB: &Pose, normal: Option<Vec3>, enough: f64) -> Nearness {
    apart(a, b, X_AB, normal, enough).unwrap_or_else(|| overlap(a, b, X_AB))
}

/// By the nearest points of the cores, where the cores are apart.
pub(super) fn apart(a: &Part, b: &Part, X_AB: &Pose, normal: Option<Vec3>, enough: f64) -> Option<Nearness> {
    let rounding = a.rounding() + b.rounding();
    let towards = normal.unwrap_or_else(|| X_AB.transform_point(&b.centre.into()).coords - a.centre);
    let found = approach(a, b, X_AB, &towards, enough + rounding)?;
    Some(Nearness { distance: found.distance - rounding, normal: found.normal })
}

/// The depth of parts that meet: the least of what two methods find, each of which has its blind
/// spots: the expansion of a polytope where bodies touch, the nearest points of shrunk bodies where
/// they are deep in each other.
fn overlap(a: &Part, b: &Part, X_AB: &Pose) -> Nearness {
    let expanded = overlapping(a, b, X_AB);
    let found = [expanded, shrunk(a, b, X_AB)].into_iter().flatten().map(|n| pulled_apart(a, b, X_AB, n));
    found.max_by(|x, y| x.distance.total_cmp(&y.distance)).unwrap_or_else(|| search(a, b, X_AB))
}

/// The direction between parts shrunk until they are apart.
fn shrunk(a: &Part, b: &Part, X_AB: &Pose) -> Option<Nearness> {
    const FACTORS: [f64; 4] = [0.95, 0.8, 0.5, 0.2];
    FACTORS.iter().find_map(|factor| {
        let (small_a, small_b) = (a.scaled(*factor), b.scaled(*factor));
        let found = apart(&small_a, &small_b, X_AB, None, f64::MAX)?;
        Some(Nearness { distance: gap_along(a, b, X_AB, &found.normal), normal: found.normal })
    })
}

/// Mends the normal of an overlap, which the expansion of a polytope misses where bodies only touch:
/// pulls the parts apart along the normal and takes the direction in which they then are nearest, as
/// long as that makes the depth less.
fn pulled_apart(a: &Part, b: &Part, X_AB: &Pose, mut best: Nearness) -> Nearness {
    const ROUNDS_MAX: usize = 20;
    const PULL: f64 = 0.01;
    const TOL_DEPTH: f64 = 1e-9;
    let pull = PULL * (a.radius + b.radius);
    for _ in 0..ROUNDS_MAX {
        let mut pulled = *X_AB;
        pulled.translation.vector += best.normal * (pull - best.distance);
        let Some(found) = apart(a, b, &pulled, Some(best.normal), f64::MAX) else { break };
        let distance = gap_along(a, b, X_AB, &found.normal);
        if distance <= best.distance + TOL_DEPTH {
            break;
        }
        best = Nearness { distance, normal: found.normal };
    }
    best
}

/// By expanding a polytope, where the parts overlap or touch. No direction tells less than the
/// depth, so that the depth found is never too small.
fn overlapping(a: &Part, b: &Part, X_AB: &Pose) -> Option<Nearness> {
    let contact = contact_support_map_support_map(&(*X_AB).into(), &Whole(a), &Whole(b), f64::MAX)?;
    let normal = Vec3::from(contact.normal1).try_normalize(0.5)?;
    normal
        .iter()
        .all(|c| c.is_finite())
        .then(|| Nearness { distance: gap_along(a, b, X_AB, &normal), normal })
}

struct Whole<'a>(&'a Part);

impl SupportMap for Whole<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.0.support(&direction.into()).into()
    }
}

/// The gap between two parts along a unit vector of a's frame: never more than their distance.
#[inline]
pub fn gap_along(a: &Part, b: &Part, X_AB: &Pose, normal: &Vec3) -> f64 {
    let backward = X_AB.rotation.inverse() * -normal;
    let between = X_AB.transform_point(&b.centre.into()).coords - a.centre;
    between.dot(normal) - a.reach(normal) - b.reach(&backward)
}

/// Between two solids, m: negative is the depth of penetration of the deepest pair of parts. Two
/// solids of which one is empty are infinitely far apart.
pub fn between(a: &Solid, X_WA: &Pose, b: &Solid, X_WB: &Pose) -> f64 {
    let X_AB = X_WA.inverse() * X_WB;
    let mut least = f64::INFINITY;
    for p in &a.parts {
        for q in &b.parts {
            let centre = X_AB.transform_point(&q.centre.into()).coords;
            if (centre - p.centre).norm() - p.radius - q.radius < least {
                least = least.min(between_parts(p, q, &X_AB).distance);
            }
        }
    }
    if inside(a, b, &X_AB) || inside(b, a, &X_AB.inverse()) { -least.abs() } else { least }
}

/// Whether some part of b is inside a hollow of a that only a's surface knows. The centre of a part
/// tells for all of it, unless it crosses the surface, which shows as an overlap.
fn inside(a: &Solid, b: &Solid, X_AB: &Pose) -> bool {
    b.parts.iter().any(|q| a.encloses(&X_AB.transform_point(&q.centre.into()).coords))
}

/// Where the general method found no answer (it gives up on some deep overlaps): the best of the
/// directions of a cube's faces, edges and corners, refined by steps that shrink by halves.
fn search(a: &Part, b: &Part, X_AB: &Pose) -> Nearness {
    const FIRST_STEP: f64 = 0.5;
    const HALVINGS: usize = 30;
    let gap = |n: &Vec3| gap_along(a, b, X_AB, n);
    let mut best = Nearness { distance: f64::NEG_INFINITY, normal: Vec3::x() };
    let mut offer = |normal: Vec3| {
        let distance = gap(&normal);
        let better = distance > best.distance;
        if better {
            best = Nearness { distance, normal };
        }
        better.then_some(normal)
    };
    let around: Vec<Vec3> = (0..27)
        .filter(|i| *i != 13)
        .map(|i| Vec3::new(f64::from(i / 9 - 1), f64::from(i / 3 % 3 - 1), f64::from(i % 3 - 1)).normalize())
        .collect();
    let mut at = Vec3::x();
    around.iter().for_each(|n| at = offer(*n).unwrap_or(at));
    let mut step = FIRST_STEP;
    for _ in 0..HALVINGS {
        let here = at;
        around.iter().for_each(|n| at = offer((here + n * step).normalize()).unwrap_or(at));
        if at == here {
            step /= 2.0;
        }
    }
    best
}
