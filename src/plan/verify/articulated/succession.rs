//! The clusters of a plan one after the other: each begins where those of whose modules it consists ended.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::entry::Entry;
use super::floating;
use super::joining::Joining;
use super::model::Model;
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use crate::geometry::{Pose, Vec3};
use crate::plan::{CauseId, DockingKind, Ground};
use crate::robot::Kinematics;
use crate::robot::dynamics::{Dynamics, Twist, Wrench, twists};

/// The beginning of a cluster.
pub(super) struct Beginning {
    /// The beginning of its rollout; `None` for a cluster of the start.
    pub entry: Option<Entry>,
    /// The docking of its parents with each other.
    pub joining: Joining,
}

/// A cluster that begins, with what was before it.
pub(super) struct Begun<'a> {
    /// Its number.
    pub index: usize,
    /// The clusters up to it, itself the last.
    pub clusters: &'a [Cluster],
    /// Its beginning.
    pub beginning: &'a Beginning,
}

impl<'a> Begun<'a> {
    /// Returns the cluster that begins.
    pub(super) fn cluster(&self) -> &'a Cluster {
        &self.clusters[self.index]
    }

    /// Returns the rollout of the cluster. `whole`: that of the plan.
    pub(super) fn rollout<'b>(&self, whole: &Rollout<'b>) -> Rollout<'b>
    where
        'a: 'b,
    {
        self.cluster().rollout(whole, self.beginning.entry.as_ref())
    }
}

/// Hands the clusters of a plan that begin up to a time (s) to `each` in their order, which returns the path of the base;
/// gives them the misalignments of their bonds, and returns all paths. The path of a cluster that begins later has no samples,
/// nor has that of one of whose parents a path does not reach up to it. `rollout`: that of the whole plan.
pub(super) fn follow(
    rollout: &Rollout,
    clusters: &mut [Cluster],
    until: f64,
    each: &mut dyn FnMut(Begun) -> BasePath,
) -> Vec<BasePath> {
    let errors = rollout.tracks.start.misalignments.iter().map(|error| (error.bond, error.pose));
    let mut past = Past { misalignments: errors.collect(), ..Past::default() };
    for index in 0..clusters.len() {
        let begun = past.begin(rollout, clusters).filter(|_| clusters[index].from <= until);
        let path = match &begun {
            Some(beginning) => each(Begun { index, clusters: &clusters[..=index], beginning }),
            None => BasePath::default(),
        };
        past.paths.push(path);
    }
    past.paths
}

/// The clusters of a plan as far as they have been rolled out, in their order.
#[derive(Default)]
struct Past {
    /// The path of the base of each.
    paths: Vec<BasePath>,
    /// The bonds by which robots docked that stood by themselves, and that hold since, with their misalignments, by their
    /// indices in the plan's robot, ascending.
    misalignments: Vec<(usize, Pose)>,
    /// The momentum with which each floats, as in [`Entry`].
    momenta: Vec<Wrench>,
}

impl Past {
    /// Returns the beginning of the next of some clusters, to which it gives the misalignments of its bonds; `None` where a
    /// parent has no path up to there.
    fn begin(&mut self, rollout: &Rollout, clusters: &mut [Cluster]) -> Option<Beginning> {
        let index = self.paths.len();
        let (before, rest) = clusters.split_at_mut(index);
        let next = &mut rest[0];
        let reaches =
            |parent: &usize| self.paths[*parent].poses.last().is_some_and(|last| last.0 >= next.from);
        if !next.parents.iter().all(reaches) {
            self.momenta.push(Wrench::default());
            return None;
        }
        let known: Vec<(&Cluster, &BasePath)> = before.iter().zip(&self.paths).collect();
        let joining = match next.joins.is_empty() {
            true => Joining::default(),
            false => Joining::of(rollout, next, &known),
        };
        let holds =
            |bond: usize| next.bonds.binary_search(&bond).map_or(true, |own| next.tracks.start.bonds[own]);
        self.misalignments.retain(|(bond, _)| holds(*bond));
        let kept = joining.dockings.iter().filter_map(|docked| Some((docked.bond, docked.misalignment?)));
        self.misalignments.extend(kept);
        self.misalignments.sort_by_key(|(bond, _)| *bond);
        let mut entry = next.parents.first().map(|parent| entry(rollout, next, known[*parent]));
        let base = next.base();
        for snap in joining.snaps.iter().filter(|snap| snap.modules.contains(&base)) {
            if let Some(entry) = &mut entry {
                entry.base = snap.motion * entry.base;
            }
        }
        if let Some(entry) = entry.as_mut().filter(|_| rollout.is_full()) {
            let ends = next.parents.iter().map(|parent| (known[*parent], self.momenta[*parent]));
            (entry.momentum, entry.twist) = carried_over(rollout, next, ends);
        }
        self.momenta.push(entry.as_ref().map_or_else(Wrench::default, |entry| entry.momentum));
        next.misalign(&self.misalignments);
        next.snaps.clone_from(&joining.snaps);
        Some(Beginning { entry, joining })
    }
}

/// Returns the beginning of a cluster where the one that holds its base ended. `before`: the other, with its path.
fn entry(rollout: &Rollout, cluster: &Cluster, (before, path): (&Cluster, &BasePath)) -> Entry {
    let tracks = rollout.tracks;
    let state = tracks.state(cluster.from);
    let mut bonds = tracks.start.bonds.clone();
    for event in tracks.events.iter().take_while(|event| event.time < cluster.from) {
        bonds[event.bond] = event.kind == DockingKind::Dock;
    }
    let numbers = Kinematics::new(&tracks.robot, &bonds, 0);
    let mut poses = vec![Pose::identity(); numbers.link_count()];
    let mut placed = PlacedClusters::new(tracks, vec![(before, path)], rollout.tolerances);
    placed.place_one(0, cluster.from, (&state.joints, &bonds), &mut poses);
    let own = |bond: usize| {
        let ends = [tracks.robot.bonds[bond].a.module, tracks.robot.bonds[bond].b.module];
        ends.iter().any(|module| cluster.modules.binary_search(module).is_ok())
    };
    let causes: Vec<CauseId> = tracks
        .events
        .iter()
        .filter(|event| event.time == cluster.from && own(event.bond))
        .map(|event| event.cause)
        .collect();
    let base = numbers.module_pose(cluster.base(), &poses);
    let (momentum, twist) = (Wrench::default(), Twist::default());
    Entry { time: cluster.from, base, momentum, twist, causes }
}

/// Returns (momentum, twist) of a cluster as it begins, as in [`Entry`]: those of its links in the clusters of which it consists,
/// as they end. `ends`: these, each with the path of its base and the momentum with which it floats.
fn carried_over<'a>(
    rollout: &Rollout,
    cluster: &Cluster,
    ends: impl Iterator<Item = ((&'a Cluster, &'a BasePath), Wrench)>,
) -> (Wrench, Twist) {
    let moving: Vec<LinkMotion> = ends
        .flat_map(|((parent, path), momentum)| links_at_end(rollout, parent, path, &momentum))
        .filter(|link| cluster.modules.binary_search(&link.module).is_ok())
        .collect();
    let mass: f64 = moving.iter().map(|link| link.mass).sum();
    let moment: Vec3 = moving.iter().map(|link| link.centre * link.mass).sum();
    let centre = if mass > 0.0 { moment / mass } else { Vec3::zeros() };
    let mut whole = Wrench::default();
    for link in &moving {
        whole.force += link.momentum.force;
        whole.moment += link.momentum.moment + (link.centre - centre).cross(&link.momentum.force);
    }
    let base = moving.iter().find(|link| link.module == cluster.base());
    (whole, base.map_or_else(Twist::default, |base| base.twist))
}

/// A link in motion.
struct LinkMotion {
    /// Its module, by the index in the plan's robot; of each module the first link comes first.
    module: usize,
    /// The twist of its frame in the world, m/s and rad/s.
    twist: Twist,
    /// Its mass, kg.
    mass: f64,
    /// Its centre of mass in the world, m.
    centre: Vec3,
    /// Its momentum (N·s), and its angular momentum about its centre of mass (N·m·s), in the world.
    momentum: Wrench,
}

/// Returns the motion of all links of a cluster just before it ends, ascending by their numbers. `momentum`: that with which it
/// floats, if it does.
fn links_at_end(rollout: &Rollout, cluster: &Cluster, path: &BasePath, momentum: &Wrench) -> Vec<LinkMotion> {
    let (tracks, end) = (&cluster.tracks, cluster.tracks.duration);
    let state = tracks.state(end);
    let mut rates = vec![0.0; state.joints.len()];
    for track in &tracks.tracks {
        let last = track.segments.iter().rfind(|segment| segment.start < end && end <= segment.end);
        rates[track.joint.0 as usize] = last.map_or(0.0, |segment| segment.velocity(end));
    }
    let model = Model::new(&tracks.robot, &state.bonds);
    let dynamics = Dynamics::new(&tracks.robot);
    let mut poses = vec![Pose::identity(); model.bodies.len()];
    model.kinematics.link_poses(&state.joints, &path.at(end, rollout.tolerances), &mut poses);
    let worlds = cluster.rollout(rollout, None).worlds;
    let world = worlds.iter().take_while(|from| from.from < end).last().map(|from| from.world.ground);
    let base = match world {
        Some(Ground::Off) => floating::twist(&model, &dynamics, momentum, (&poses, &rates)),
        Some(Ground::Held | Ground::Fixed) => Twist::default(),
        Some(Ground::Settle) | None => path.end_twist(),
    };
    let motion = twists(&model.kinematics, &poses, &base, &rates);
    let link_motion = |link: usize| {
        let body = &model.bodies[link];
        let centre = poses[link].transform_point(&body.com.into()).coords;
        let momentum = dynamics.momentum_of_links(std::iter::once(link), (&poses, &motion), &centre);
        let module = cluster.modules[body.module];
        LinkMotion { module, twist: motion[link], mass: body.mass, centre, momentum }
    };
    model.attached.iter().map(|link| link_motion(*link)).collect()
}
