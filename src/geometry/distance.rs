//! Signed distances between convex parts and between solids.
//!
//! Parts that are apart: the nearest points of their cores by the method of Gilbert, Johnson and Keerthi (GJK).
//! Parts that overlap: the penetration depth, the length of the shortest shift that separates them, by parry's
//! expanding polytope and by directions of our own, of which each is a valid bound; see [`separation_along`].

pub use super::gjk::Needed;
use super::gjk::closest_cores;
use super::part::Part;
use super::pose::{Pose, Vec3};
use super::solid::Solid;
use parry3d_f64::math::Vector;
use parry3d_f64::query::details::contact_support_map_support_map;
use parry3d_f64::shape::SupportMap;

/// The signed distance of two convex parts, with its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedDistance {
    /// The distance of the nearest points, m. If the parts overlap, minus the penetration depth, which is the length
    /// of the shortest shift that separates them; 0 if they touch.
    pub distance: f64,
    /// The direction of the distance: a unit vector from the first part towards the second, in the first one's
    /// frame; any one of several that are equally short.
    pub normal: Vec3,
}

/// Returns the signed distance of two parts, m; `X_AB` is the pose of b's frame in a's. The method is that of
/// Gilbert, Johnson and Keerthi (1988), and where parts overlap the expansion of a polytope (EPA). Distances of parts
/// that are apart are exact to about 1e-9 m and 1e-9 of the distance. Depths of round parts that overlap are exact to
/// about a micrometre, and no depth is too small by more than rounding.
pub fn signed_distance(a: &Part, b: &Part, X_AB: &Pose) -> SignedDistance {
    signed_distance_within(a, b, X_AB, None, f64::MAX)
}

/// Returns the signed distance (m) of two parts as [`signed_distance`] does, or, once it is known to be at least
/// `enough` (m), a lower bound on it of at least `enough`, with the direction in which it holds. `X_AB` is the pose
/// of b's frame in a's. `normal`: a direction from a to b in a's frame to begin with, such as that of an instant
/// before; `None` begins with the line of the centres. Any direction gives the same result to the tolerance.
pub fn signed_distance_within(
    a: &Part,
    b: &Part,
    X_AB: &Pose,
    normal: Option<Vec3>,
    enough: f64,
) -> SignedDistance {
    signed_distance_as_needed(a, b, X_AB, normal, &Needed::exact_up_to(enough))
}

/// Returns the signed distance (m) of two parts as well as it is `needed`; what is not exact is a lower bound, with the
/// direction in which it holds. Otherwise as [`signed_distance_within`].
pub fn signed_distance_as_needed(
    a: &Part,
    b: &Part,
    X_AB: &Pose,
    normal: Option<Vec3>,
    needed: &Needed,
) -> SignedDistance {
    apart_as_needed(a, b, X_AB, normal, needed).unwrap_or_else(|| penetration(a, b, X_AB))
}

/// Returns the distance by the nearest points of the cores ([`Part::rounding`]), m, or a lower bound of at least
/// `enough` (m); `None` where the cores overlap or touch. Arguments as for [`signed_distance_within`].
pub(super) fn distance_apart(
    a: &Part,
    b: &Part,
    X_AB: &Pose,
    normal: Option<Vec3>,
    enough: f64,
) -> Option<SignedDistance> {
    apart_as_needed(a, b, X_AB, normal, &Needed::exact_up_to(enough))
}

fn apart_as_needed(
    a: &Part,
    b: &Part,
    X_AB: &Pose,
    normal: Option<Vec3>,
    needed: &Needed,
) -> Option<SignedDistance> {
    let towards = normal.unwrap_or_else(|| X_AB.transform_point(&b.centre.into()).coords - a.centre);
    let found = closest_cores(a, b, X_AB, &towards, needed)?;
    Some(SignedDistance { distance: found.distance - a.rounding() - b.rounding(), normal: found.normal })
}

/// Returns the penetration of parts whose cores overlap: the least depth that two methods find, each of which misses
/// some cases: the expansion of a polytope misses bodies that only touch, the nearest points of shrunk bodies those
/// that are deep in each other. If even shrunk bodies overlap, about one centre, directions are searched.
fn penetration(a: &Part, b: &Part, X_AB: &Pose) -> SignedDistance {
    let expanded = expanding_polytope(a, b, X_AB);
    let deep = shrunk(a, b, X_AB).or_else(|| Some(direction_search(a, b, X_AB)));
    let found = [expanded, deep].into_iter().flatten().map(|n| refined(a, b, X_AB, n));
    found.max_by(|x, y| x.distance.total_cmp(&y.distance)).expect("directions are searched")
}

/// Returns the separation along the direction between the parts when shrunk until they are apart; `None` if they
/// overlap even at a fifth of their size.
fn shrunk(a: &Part, b: &Part, X_AB: &Pose) -> Option<SignedDistance> {
    const FACTORS: [f64; 4] = [0.95, 0.8, 0.5, 0.2];
    FACTORS.iter().find_map(|factor| {
        let (small_a, small_b) = (a.scaled(*factor), b.scaled(*factor));
        let found = distance_apart(&small_a, &small_b, X_AB, None, f64::MAX)?;
        Some(SignedDistance { distance: separation_along(a, b, X_AB, &found.normal), normal: found.normal })
    })
}

/// Returns a penetration with its normal refined, for the expansion of a polytope misses it where bodies only touch:
/// the parts are pulled apart along the normal, and the direction in which they then are nearest is taken, as long
/// as that makes the depth less.
fn refined(a: &Part, b: &Part, X_AB: &Pose, mut best: SignedDistance) -> SignedDistance {
    const ROUNDS_MAX: usize = 20;
    const PULL: f64 = 0.01;
    // Threshold: a round that lessens the depth by no more, in metres, is the last; less is rounding.
    const TOL_DEPTH: f64 = 1e-9;
    let pull = PULL * (a.radius + b.radius);
    for _ in 0..ROUNDS_MAX {
        let mut pulled = *X_AB;
        pulled.translation.vector += best.normal * (pull - best.distance);
        let Some(found) = distance_apart(a, b, &pulled, Some(best.normal), f64::MAX) else { break };
        let distance = separation_along(a, b, X_AB, &found.normal);
        if distance <= best.distance + TOL_DEPTH {
            break;
        }
        best = SignedDistance { distance, normal: found.normal };
    }
    best
}

/// Returns the penetration by parry's expanding polytope algorithm (van den Bergen 2001), measured anew along the
/// normal that it finds; `None` where it gives up.
fn expanding_polytope(a: &Part, b: &Part, X_AB: &Pose) -> Option<SignedDistance> {
    let contact = contact_support_map_support_map(&(*X_AB).into(), &Whole(a), &Whole(b), f64::MAX)?;
    let normal = Vec3::from(contact.normal1).try_normalize(0.5)?;
    normal
        .iter()
        .all(|c| c.is_finite())
        .then(|| SignedDistance { distance: separation_along(a, b, X_AB, &normal), normal })
}

struct Whole<'a>(&'a Part);

impl SupportMap for Whole<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.0.support(&direction.into()).into()
    }
}

/// Returns the width of the slab between two parts across a unit vector `normal` of a's frame (from a to b), m:
/// negative where they overlap along it. It is never more than their signed distance, and equal to it for the best
/// direction (the separating axis theorem). `X_AB` is the pose of b's frame in a's.
#[inline]
pub fn separation_along(a: &Part, b: &Part, X_AB: &Pose, normal: &Vec3) -> f64 {
    let backward = X_AB.rotation.inverse() * -normal;
    let between = X_AB.transform_point(&b.centre.into()).coords - a.centre;
    between.dot(normal) - a.reach(normal) - b.reach(&backward)
}

/// Returns the signed distance of two solids at their poses `X_WA` and `X_WB` in the world, m: the least of their
/// parts; if negative, minus the penetration depth of the deepest pair of parts. A solid inside a closed mesh that is
/// not convex, but not in its hollow, is at minus a lower bound on its depth: its distance from the surface, or the
/// depth of an inner point if that is more. Infinite if one of the solids is empty. `a` and `b`: the solids, each in
/// the frame of its link.
pub fn distance_of_solids(a: &Solid, X_WA: &Pose, b: &Solid, X_WB: &Pose) -> f64 {
    let X_AB = X_WA.inverse() * X_WB;
    let mut least = f64::INFINITY;
    for p in &a.parts {
        for q in &b.parts {
            let centre = X_AB.transform_point(&q.centre.into()).coords;
            if (centre - p.centre).norm() - p.radius - q.radius < least {
                least = least.min(signed_distance(p, q, &X_AB).distance);
            }
        }
    }
    let enclosed = enclosed_depth(a, b, &X_AB);
    if enclosed > 0.0 { -enclosed.max(least.abs()) } else { least }
}

/// Returns a lower bound, m, on the depth to which one of two solids is inside the meshes of the other that are not
/// convex (see [`Solid::enclosed_point`]): not negative; 0 if no probe point of either is inside the other. `X_AB` is
/// the pose of b's frame in a's.
pub fn enclosed_depth(a: &Solid, b: &Solid, X_AB: &Pose) -> f64 {
    enclosed_point(a, b, X_AB).map_or(0.0, |(depth, _)| depth)
}

/// Returns a lower bound on the depth to which one of two solids is inside the meshes of the other that are not
/// convex, as [`enclosed_depth`] does, with a point that is as deep: as (depth, point), m, the point in a's frame.
/// `None` if no probe point of either solid is inside the other's meshes ([`Solid::enclosed_point`]). `X_AB` is the
/// pose of b's frame in a's.
pub fn enclosed_point(a: &Solid, b: &Solid, X_AB: &Pose) -> Option<(f64, Vec3)> {
    let in_a = a.enclosed_point(b, X_AB);
    let in_b = b.enclosed_point(a, &X_AB.inverse());
    let in_b = in_b.map(|(depth, point)| (depth, X_AB.transform_point(&point.into()).coords));
    in_a.into_iter().chain(in_b).max_by(|x, y| x.0.total_cmp(&y.0))
}

/// Returns the penetration of parts about one centre (on which parry's expansion gives up, or takes the first
/// direction): the best of the directions of a cube's faces, edges and corners, refined by pattern search with steps
/// that shrink by halves.
fn direction_search(a: &Part, b: &Part, X_AB: &Pose) -> SignedDistance {
    const FIRST_STEP: f64 = 0.5;
    const HALVINGS: usize = 30;
    let separation = |n: &Vec3| separation_along(a, b, X_AB, n);
    let mut best = SignedDistance { distance: f64::NEG_INFINITY, normal: Vec3::x() };
    let mut offer = |normal: Vec3| {
        let distance = separation(&normal);
        let better = distance > best.distance;
        if better {
            best = SignedDistance { distance, normal };
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
