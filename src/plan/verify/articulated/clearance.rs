//! Clearance curves and collision points for those who draw them. Nothing is judged here.

use super::advancement::Advancement;
use super::base_path::BasePath;
use super::between_clusters;
use super::bodies::{Bodies, Body};
use super::bonded::{BondedLinks, NominalOverlaps};
use super::cluster_paths::roll_out_path;
use super::clusters::Cluster;
use super::history::base_at;
use super::parted;
use super::rollout_input::Rollout;
use super::succession;
use super::tolerances::{Precision, Tolerances};
use crate::geometry::distance::signed_distance;
use crate::geometry::{Pose, Vec3, contact_point};
use crate::interrupt;
use crate::plan::{Body as Form, Plan, Tracks, validation};
use crate::robot::Kinematics;

/// The greatest number of pairs of modules that are examined for one curve of clearances, if that leaves it enough
/// points.
const PAIRS_MAX: usize = 4_000_000;

/// The number of points of a curve below which no points are left out to save work.
const POINTS_MIN: usize = 20;

/// Returns the clearance over time: (time, s; least signed distance of links that may not touch, m) at evenly spaced
/// times from the start to `until` (s), both included, in order of time. There are `count` + 1 of them, or fewer for
/// robots of more than a few hundred modules, but not fewer than `POINTS_MIN` + 1 for that reason. Empty if there are
/// no two such links, if `until` is not positive, for a plan that is not of an articulated robot or not valid, and for
/// a robot with a shape that is not sound.
pub fn clearances(plan: &Plan, until: f64, count: usize) -> Vec<(f64, f64)> {
    let Form::Tracks(tracks) = &plan.body else { return vec![] };
    if until <= 0.0 || validation::check(plan).is_err() {
        return vec![];
    }
    let modules = tracks.robot.modules.len();
    let afforded = PAIRS_MAX / (modules * modules).max(1);
    let count = count.min(afforded.max(POINTS_MIN)).max(1);
    let times: Vec<f64> = (0..=count).map(|i| until * i as f64 / count as f64).collect();
    let found = at_times(plan, tracks, &times, None).into_iter().flatten();
    times.iter().zip(found).filter_map(|(time, distance)| Some((*time, distance?))).collect()
}

/// Returns the least signed distance of links that may not touch, m, for each of `times` (s) in their order, `None`
/// if there are no two such links. `None` instead of the list for a plan that is not of an articulated robot or not
/// valid, and for a robot with a shape that is not sound. Of several robots and obstacles it is the least of all, or with
/// `reference`, a module by its index in the plan's robot, of the robot that has it, with what is docked with it.
pub fn clearances_at(plan: &Plan, times: &[f64], reference: Option<usize>) -> Option<Vec<Option<f64>>> {
    let Form::Tracks(tracks) = &plan.body else { return None };
    validation::check(plan).ok()?;
    at_times(plan, tracks, times, reference)
}

/// As [`clearances_at`], of a valid plan, whose body is `tracks`.
fn at_times(
    plan: &Plan,
    tracks: &Tracks,
    times: &[f64],
    reference: Option<usize>,
) -> Option<Vec<Option<f64>>> {
    let tolerances = Tolerances::default();
    let rollout = Rollout::of(plan, tracks, &tolerances);
    let Some(mut clusters) = parted::clusters(&rollout) else { return of_one(tracks, times) };
    let until = times.iter().copied().fold(0.0, f64::max);
    let paths = succession::follow(&rollout, &mut clusters, until, &mut |begun| {
        roll_out_path(begun.rollout(&rollout), until)
    });
    let followed = clusters.into_iter().zip(paths).filter(|(_, path)| !path.poses.is_empty());
    let (clusters, paths): (Vec<Cluster>, Vec<BasePath>) = followed.unzip();
    let meant = |cluster: &Cluster| reference.is_none_or(|module| cluster.modules.contains(&module));
    let mut found = between_clusters::distances_at(&rollout, (&clusters, &paths), times, meant)?;
    for cluster in clusters.iter().filter(|cluster| meant(cluster)) {
        let its: Vec<usize> = (0..times.len()).filter(|index| cluster.exists(times[*index])).collect();
        let at: Vec<f64> = its.iter().map(|index| times[*index]).collect();
        for (index, own) in its.into_iter().zip(of_one(&cluster.tracks, &at)?) {
            found[index] = found[index].into_iter().chain(own).reduce(f64::min);
        }
    }
    Some(found)
}

/// Returns the distances of [`clearances_at`] of the robot with the base of `tracks`.
fn of_one(tracks: &Tracks, times: &[f64]) -> Option<Vec<Option<f64>>> {
    let bodies = Bodies::of_plan(tracks).ok()?;
    let mut advancement = Advancement::new(tracks, &bodies, Precision::default(), usize::MAX);
    let at = |time: &f64| {
        interrupt::checkpoint();
        advancement.clearance_at(&tracks.state(*time).bonds, *time)
    };
    Some(times.iter().map(at).collect())
}

/// Returns the point, in the world, m, at which two modules penetrate each other at a time (s); for one module given
/// twice, at which two of its links do. `modules`: their indices in the assembly; it panics if there are none. Of
/// several pairs of links it is that which exceeds its allowed depth most. If a link is wholly inside another's mesh
/// that is not convex, the point is one within it, far from the mesh's surface. `None` if none overlap, for a plan
/// that is not of an articulated robot or not valid, and for a shape that is not sound.
pub fn collision_point(plan: &Plan, modules: (usize, usize), time: f64) -> Option<Vec3> {
    let Form::Tracks(tracks) = &plan.body else { return None };
    if validation::check(plan).is_err() {
        return None;
    }
    let bodies = Bodies::of_plan(tracks).ok()?;
    let state = tracks.state(time);
    let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let base = base_at(plan, time).unwrap_or(state.base);
    kinematics.link_poses(&state.joints, &base, &mut poses);
    let relative = |a: &Body, b: &Body| poses[a.carrier].inverse() * poses[b.carrier];
    let depth = |(a, b, allowed): &(usize, usize, f64)| {
        let (a, b) = (&bodies.bodies[*a], &bodies.bodies[*b]);
        -signed_distance(&a.part, &b.part, &relative(a, b)).distance - allowed
    };
    let mut overlaps = NominalOverlaps::default();
    let bonded = BondedLinks::new(&tracks.robot, &state.bonds, &kinematics, &bodies, &mut overlaps);
    let pairs = pairs(tracks, &bodies, &bonded, modules);
    let deepest = pairs.iter().map(|pair| (depth(pair), *pair)).max_by(|x, y| x.0.total_cmp(&y.0));
    let deepest = deepest.filter(|(depth, (.., allowed))| depth + allowed >= 0.0);
    let enclosed = enclosed_point(&bodies, &kinematics, &poses, &pairs);
    if let Some((depth, point)) = enclosed
        && deepest.is_none_or(|(known, _)| depth > known)
    {
        return Some(point);
    }
    let (_, (a, b, _)) = deepest?;
    let (a, b) = (&bodies.bodies[a], &bodies.bodies[b]);
    let met = contact_point(&a.part, &b.part, &relative(a, b));
    Some(poses[a.carrier].transform_point(&met.into()).coords)
}

/// Returns by how much the link that is deepest inside another's mesh that is not convex exceeds its allowed depth, m,
/// and a point that is as deep, in the world, m; `None` if there is no such link. `pairs`: as of [`pairs`]; `poses`:
/// the world poses of all links.
fn enclosed_point(
    bodies: &Bodies,
    kinematics: &Kinematics,
    poses: &[Pose],
    pairs: &[(usize, usize, f64)],
) -> Option<(f64, Vec3)> {
    // One pair of bodies stands for its two links.
    let first = |body: usize| bodies.first_of_link(bodies.bodies[body].link) == Some(body);
    let of_links = pairs.iter().filter(|(a, b, _)| first(*a) && first(*b));
    let found = of_links.filter_map(|&(a, b, allowed)| {
        let (a, b) = (&bodies.bodies[a], &bodies.bodies[b]);
        let local = |body: &Body| (body.module, body.link - kinematics.link(body.module, 0));
        let X_AB = poses[a.link].inverse() * poses[b.link];
        let (depth, point) = bodies.enclosed_point(local(a), local(b), &X_AB)?;
        Some((depth - allowed, poses[a.link].transform_point(&point.into()).coords))
    });
    found.max_by(|x, y| x.0.total_cmp(&y.0))
}

/// Returns the pairs of bodies of two modules, or within one given twice, by their indices in [`Bodies::bodies`],
/// with the penetration depth that each may have, m.
fn pairs(
    tracks: &Tracks,
    bodies: &Bodies,
    bonded: &BondedLinks,
    (m, n): (usize, usize),
) -> Vec<(usize, usize, f64)> {
    debug_assert!(m < tracks.robot.modules.len() && n < tracks.robot.modules.len());
    if m == n {
        let first = bodies.of(m).start;
        return bodies.inner(m).iter().map(|i| (first + i.a, first + i.b, i.allowed)).collect();
    }
    let touch = bodies.allowed_depth(m, n);
    let all = bodies.of(m).flat_map(|a| bodies.of(n).map(move |b| (a, b)));
    let allowed = |(a, b): (usize, usize)| {
        let (x, y) = (&bodies.bodies[a], &bodies.bodies[b]);
        (a, b, bonded.get(x.link, y.link).map_or(touch, |pair| pair.allowed(x, y, touch)))
    };
    all.map(allowed).collect()
}
