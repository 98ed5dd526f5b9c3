//! Collisions between clusters, and of clusters with obstacles.
//!
//! The base of each cluster moves over the ground by itself: it is taken to stay as near to the straight line and one turn
//! from sample to sample as these are long. With that, and bounds on the joints' motion, pairs are separated between samples;
//! where they are not, what is said is said of the samples.

use super::base_path::BasePath;
use super::blame::{Candidate, distinct, suspects};
use super::bodies::Bodies;
use super::cluster_balls::ClusterBalls;
use super::clusters::Cluster;
use super::collision::Collision;
use super::docking;
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use super::snapping::{Snap, links};
use super::tolerances::Tolerances;
use crate::geometry::{Pose, Vec3};
use crate::interrupt;
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, ExemptionKind, Status, Tracks};
use crate::robot::{JointOwner, Kinematics, Link, ModuleInstance, ModuleType, Surface, mate};
use crate::units::{Dimension, quantity};
use nalgebra::{Point3 as Point, UnitQuaternion};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// Judges whether links of two clusters meet that are there at the same time, or of a cluster and an obstacle, at all samples
/// of either and between them: records collisions, the least distance, and the number of samples. `rollout`: that of the
/// whole plan; `paths`: those of the clusters' bases, one for each. `ended`: the time from which a cluster no longer moves as
/// planned (s) and the check that says so; `None` if all do.
pub(super) fn judge(
    rollout: &Rollout,
    (clusters, paths): (&[Cluster], &[BasePath]),
    ended: Option<(f64, CheckKind)>,
    ledger: &mut Ledger,
) {
    let surrounded = with_obstacles(rollout.tracks);
    let tracks = &surrounded;
    // An unsound shape is a failure of the cluster that has it.
    let Ok(bodies) = Bodies::of_plan(tracks) else { return };
    let alone = |time: f64| {
        tracks.obstacles.is_empty() && clusters.iter().filter(|cluster| cluster.exists(time)).count() < 2
    };
    let mut times: Vec<f64> = paths
        .iter()
        .flat_map(|path| path.poses.iter().map(|pose| pose.0))
        .filter(|t| ended.is_none_or(|(end, _)| *t < end))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times.retain(|time| !alone(*time));
    let pairs_of: Vec<(&Cluster, &BasePath)> = clusters.iter().zip(paths).collect();
    let mut placed = PlacedClusters::new(tracks, pairs_of, rollout.tolerances);
    let mut links =
        PlacedLinks::new(tracks, &bodies, explained(tracks, clusters, &bodies), rollout.tolerances);
    let mut balls = ClusterBalls::new(tracks, clusters, paths, &bodies);
    let mut unproved = 0;
    for &time in &times {
        interrupt::checkpoint();
        let existing = placed.place(time, &mut links.poses);
        balls.place(&existing, time, &bodies, &links.numbers, &links.poses);
        for (i, &a) in existing.iter().enumerate() {
            for &b in existing[i + 1..].iter().chain(&balls.obstacles()) {
                // The motion of both until half way to the next sample, and from half way from the one before.
                let moved = balls.motion(a) + balls.motion(b);
                let enough =
                    ledger.verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value.max(0.0));
                if balls.distance(a, b) > enough.max(moved) {
                    continue;
                }
                let mut nearest = f64::INFINITY;
                for &x in balls.modules(a) {
                    for &y in balls.modules(b) {
                        nearest = nearest.min(links.observe((x, y), time, moved, ledger));
                    }
                }
                unproved += usize::from(nearest < moved);
            }
        }
    }
    // Two robots that snap are one afterwards, and no samples of theirs are left.
    for cluster in clusters.iter().filter(|cluster| ended.is_none_or(|(end, _)| cluster.from < end)) {
        unproved += links.observe_snaps(cluster, (clusters, &mut placed), ledger);
    }
    let found = std::mem::take(&mut links.found);
    report(rollout, (tracks, clusters), found, ledger);
    ledger.verdict.samples += times.len();
    let status = match ended {
        Some((time, kind)) => Status::NotChecked(format!(
            "between robots, from {} on: {} fails",
            quantity(time, Dimension::TIME),
            kind.name()
        )),
        None if unproved == 0 => Status::Proved,
        None => Status::Sampled(times.len()),
    };
    ledger.check(CheckKind::Collision, status);
}

/// Returns the least signed distance of links of two clusters, or of a cluster and an obstacle, m, for each of `times` (s);
/// `None` where there are no two. Only those pairs count of which one cluster is `meant`. `None` instead of the list for a shape
/// that is not sound. `rollout`: that of the whole plan; `paths`: those of the clusters' bases, one for each, with samples.
pub(super) fn distances_at(
    rollout: &Rollout,
    (clusters, paths): (&[Cluster], &[BasePath]),
    times: &[f64],
    meant: impl Fn(&Cluster) -> bool,
) -> Option<Vec<Option<f64>>> {
    let tracks = &with_obstacles(rollout.tracks);
    let bodies = Bodies::of_plan(tracks).ok()?;
    let pairs_of: Vec<(&Cluster, &BasePath)> = clusters.iter().zip(paths).collect();
    let mut placed = PlacedClusters::new(tracks, pairs_of, rollout.tolerances);
    let mut links = PlacedLinks::new(tracks, &bodies, BTreeMap::new(), rollout.tolerances);
    let obstacles: Vec<usize> = (rollout.tracks.robot.modules.len()..tracks.robot.modules.len()).collect();
    let mut at = |time: f64| {
        interrupt::checkpoint();
        let existing = placed.place(time, &mut links.poses);
        let mut ledger = Ledger::new(&[], rollout.end);
        for (i, &a) in existing.iter().enumerate() {
            let a = &clusters[a];
            let others = existing[i + 1..].iter().map(|b| &clusters[*b]);
            let others = others.filter(|b| meant(a) || meant(b)).flat_map(|b| &b.modules);
            let solid = obstacles.iter().filter(|_| meant(a));
            for &y in others.chain(solid) {
                a.modules.iter().for_each(|x| {
                    links.observe((*x, y), time, 0.0, &mut ledger);
                });
            }
        }
        ledger.verdict.clearance.map(|worst| worst.value)
    };
    Some(times.iter().map(|time| at(*time)).collect())
}

/// Returns a plan's tracks whose robot has one more module for each obstacle, after all others: one link without joints.
fn with_obstacles(tracks: &Tracks) -> Tracks {
    let mut all = tracks.clone();
    if all.obstacles.is_empty() {
        return all;
    }
    let library = Arc::make_mut(&mut all.robot.library);
    for obstacle in &*tracks.obstacles {
        let link = Link {
            name: "body".to_owned(),
            pose: Pose::identity(),
            shape: vec![],
            collides: obstacle.shapes.clone(),
            left_out: 0.0,
            mass: 0.0,
            com: Vec3::zeros(),
            inertia: [0.0; 6],
            friction: Link::FRICTION_DEFAULT,
            surface: Surface::default(),
        };
        all.robot.modules.push(ModuleInstance { name: obstacle.name.clone(), kind: library.modules.len() });
        library.modules.push(ModuleType {
            name: obstacle.name.clone(),
            links: vec![link],
            joints: vec![],
            ports: vec![],
            motors: vec![],
            touching: vec![],
            touch: f64::INFINITY,
            contact: ModuleType::CONTACT_DEFAULT,
        });
    }
    all
}

/// Returns the depths to which modules that dock with each other may overlap while they are of different clusters, as far
/// as the error of docking explains the overlap that their bond has, m, by the indices of the two modules.
fn explained(tracks: &Tracks, clusters: &[Cluster], bodies: &Bodies) -> BTreeMap<(usize, usize), f64> {
    let mut depths = BTreeMap::new();
    let robot = &tracks.robot;
    for cluster in clusters {
        for &bond in &cluster.bonds {
            let own = cluster.bonds.binary_search(&bond).expect("the bond is one of the cluster's");
            let declared = robot.bonds[bond];
            let [a, b] = [declared.a, declared.b]
                .map(|port| (port.module, &robot.module_type(port.module).ports[port.port]));
            let X_AB = a.1.pose * mate(&cluster.tracks.robot, own) * b.1.pose.inverse();
            let overlap = bodies.overlap((a.0, a.1.link), (b.0, b.1.link), &X_AB);
            let tolerances = Tolerances::default();
            let depth = overlap.min(docking::tolerated(robot, bond, &tolerances).distance);
            let known: &mut f64 = depths.entry((a.0.min(b.0), a.0.max(b.0))).or_insert(0.0);
            *known = known.max(depth);
        }
    }
    depths
}

/// Records the collisions found, each blamed on what moves then in the clusters concerned, or on the event that brought
/// them to be. `tracks`: those with obstacles.
fn report(
    rollout: &Rollout,
    (tracks, clusters): (&Tracks, &[Cluster]),
    found: BTreeMap<(usize, usize), Collision>,
    ledger: &mut Ledger,
) {
    let joints: Vec<JointOwner> = tracks.robot.joints().collect();
    // Robots that begin in each other are said to once: what meets later follows from it.
    let robot_of = |module: usize| {
        let own = clusters.iter().position(|c| c.from == 0.0 && c.modules.contains(&module));
        own.map_or((module, true), |own| (own, false))
    };
    let robots = |collision: &Collision| {
        let (a, b) = (robot_of(collision.modules.0), robot_of(collision.modules.1));
        (a.min(b), a.max(b))
    };
    let begun: BTreeSet<_> = found.values().filter(|c| c.time == 0.0).map(robots).collect();
    for collision in found.into_values().filter(|c| c.time == 0.0 || !begun.contains(&robots(c))) {
        let mut failure = collision.failure(&tracks.robot);
        let cluster_of = |module: usize| {
            clusters.iter().rposition(|c| c.from <= failure.time && c.modules.contains(&module))
        };
        let both: Vec<usize> =
            [collision.modules.0, collision.modules.1].into_iter().filter_map(cluster_of).collect();
        let concerned = |s: &Candidate| {
            cluster_of(tracks.robot.module_of(joints[s.joint])).is_some_and(|own| both.contains(&own))
        };
        let suspects = suspects(tracks, failure.time);
        let moving = suspects.iter().filter(|s| s.moving && concerned(s)).map(|s| s.cause);
        let mut blame = distinct(moving);
        if blame.is_empty() {
            let event = rollout.tracks.events.iter().rfind(|event| event.time <= failure.time);
            blame.extend(event.map(|event| event.cause));
        }
        failure.blames_start = blame.is_empty();
        failure.blame = blame;
        ledger.fail(failure);
    }
}

/// The links of the plan's robot where they are at a time.
struct PlacedLinks<'a> {
    tracks: &'a Tracks,
    bodies: &'a Bodies,
    /// The depths to which modules may overlap beyond what all may, m.
    explained: BTreeMap<(usize, usize), f64>,
    /// The kinematics of the whole robot, which gives its links their numbers.
    numbers: Kinematics,
    /// The world poses of all links (`X_WL`), by their numbers, m.
    poses: Vec<Pose>,
    /// The indices of the modules that stand for obstacles.
    obstacles: Range<usize>,
    tolerances: &'a Tolerances,
    /// The deepest collision of each pair of modules so far.
    found: BTreeMap<(usize, usize), Collision>,
}

impl<'a> PlacedLinks<'a> {
    /// Returns the links of a plan's robot before they have a place. `explained`: the depths to which modules may overlap
    /// beyond what all may, m, by their indices.
    fn new(
        tracks: &'a Tracks,
        bodies: &'a Bodies,
        explained: BTreeMap<(usize, usize), f64>,
        tolerances: &'a Tolerances,
    ) -> PlacedLinks<'a> {
        let count = tracks.robot.modules.len();
        let obstacles = count - tracks.obstacles.len()..count;
        let numbers = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
        let poses = vec![Pose::identity(); numbers.link_count()];
        PlacedLinks {
            tracks,
            bodies,
            explained,
            numbers,
            poses,
            obstacles,
            tolerances,
            found: BTreeMap::new(),
        }
    }

    /// Takes the distances of what moves as the parents of a cluster snap to each other, on its way, to all that stands around.
    /// Returns the number of places on it between which nothing is proved.
    fn observe_snaps(
        &mut self,
        cluster: &Cluster,
        (clusters, placed): (&[Cluster], &mut PlacedClusters),
        ledger: &mut Ledger,
    ) -> usize {
        let (robot, time) = (&self.tracks.robot, cluster.from);
        let snaps: Vec<&Snap> = cluster.snaps.iter().filter(|snap| snap.stands.is_none()).collect();
        if snaps.is_empty() {
            return 0;
        }
        let existing = placed.place(time, &mut self.poses);
        let others = existing.iter().flat_map(|index| clusters[*index].modules.iter().copied());
        let around: Vec<usize> = others.chain(self.obstacles.clone()).collect();
        let mut unproved = 0;
        for snap in snaps.into_iter().rev() {
            let centre = self.poses[self.numbers.link(snap.modules[0], 0)].translation.vector;
            let distance = |module: &usize| {
                (self.numbers.module_pose(*module, &self.poses).translation.vector - centre).norm()
                    + self.bodies.reach[*module]
            };
            let reach = snap.modules.iter().map(distance).fold(0.0, f64::max);
            let back = snap.motion.inverse();
            let shift = (back * Point::from(centre)).coords - centre;
            let way = shift.norm() + snap.motion.rotation.angle() * reach;
            let steps = libm::ceil(way / self.tolerances.snap_step).max(1.0) as usize;
            let moved = way / steps as f64;
            let after = self.poses.clone();
            for step in 0..steps {
                // Backwards from the pose after, about the body that moves.
                let part = (step + 1) as f64 / steps as f64;
                let turn = UnitQuaternion::from_scaled_axis(back.rotation.scaled_axis() * part);
                let motion = Pose::from_parts((centre + shift * part - turn * centre).into(), turn);
                for link in snap.modules.iter().flat_map(|module| links(robot, &self.numbers, *module)) {
                    self.poses[link] = motion * after[link];
                }
                for &x in &snap.modules {
                    for &y in around.iter().filter(|module| !snap.modules.contains(module)) {
                        unproved += usize::from(self.observe((x, y), time, moved, ledger) < moved);
                    }
                }
            }
        }
        unproved
    }

    /// Takes the distances of the links of two modules at a time (s): keeps the least in the verdict, and the deepest
    /// collision that no exemption excuses. Returns the least, m, exact if it is less than `moved` (m).
    fn observe(&mut self, (x, y): (usize, usize), time: f64, moved: f64, ledger: &mut Ledger) -> f64 {
        let bodies = self.bodies;
        let origin = |module: usize| self.numbers.module_pose(module, &self.poses).translation.vector;
        let known = ledger.verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value);
        let enough = known.max(moved).max(0.0);
        let balls = (origin(x) - origin(y)).norm() - bodies.reach[x] - bodies.reach[y];
        if balls >= enough {
            return balls;
        }
        let links = |module: usize| bodies.first_of_links(module).map(|body| bodies.bodies[body].link);
        let own = |module: usize, link: usize| (module, link - self.numbers.link(module, 0));
        let allowed = bodies.allowed_depth(x, y) + self.explained.get(&(x.min(y), x.max(y))).unwrap_or(&0.0);
        let mut nearest = enough;
        for (a, b) in links(x).flat_map(|a| links(y).map(move |b| (own(x, a), own(y, b)))) {
            let distance = bodies.signed_distance(&self.numbers, (a, b), &self.poses, enough);
            nearest = nearest.min(distance);
            if distance < known {
                let names = || [x, y].map(|module| self.tracks.robot.modules[module].name.clone()).into();
                keep_least(&mut ledger.verdict.clearance, distance, time, names);
            }
            let excuse = |kind: &ExemptionKind| match kind {
                ExemptionKind::Collision(modules) => {
                    modules.is_none_or(|pair| pair == (x, y) || pair == (y, x))
                }
                _ => false,
            };
            if distance >= -allowed || ledger.excuses(CheckKind::Collision, time, excuse) {
                continue;
            }
            let collision = self.found.entry((x, y)).or_insert(Collision {
                modules: (x, y),
                links: (a.1, b.1),
                time,
                depth: 0.0,
                deepest: time,
                allowed,
                exempt: false,
                bond: None,
            });
            if -distance > collision.depth {
                (collision.depth, collision.deepest) = (-distance, time);
            }
        }
        nearest
    }
}
