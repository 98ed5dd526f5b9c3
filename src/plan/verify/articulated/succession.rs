//! The clusters of a plan one after the other: each begins where those of whose modules it consists ended.

use super::base_path::BasePath;
use super::clusters::Cluster;
use super::entry::Entry;
use super::joining::Joining;
use super::placed_clusters::PlacedClusters;
use super::rollout::Rollout;
use crate::geometry::Pose;
use crate::plan::{CauseId, DockingKind};
use crate::robot::Kinematics;

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
    /// The paths of the bases of those before it.
    pub paths: &'a [BasePath],
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
    let mut past = Past::default();
    for index in 0..clusters.len() {
        let begun = past.begin(rollout, clusters).filter(|_| clusters[index].from <= until);
        let path = match &begun {
            Some(beginning) => {
                each(Begun { index, clusters: &clusters[..=index], paths: &past.paths, beginning })
            }
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
        self.misalignments.extend(&joining.misalignments);
        self.misalignments.sort_by_key(|(bond, _)| *bond);
        let entry = next.parents.first().map(|parent| entry(rollout, next, known[*parent]));
        next.misalign(&self.misalignments);
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
    Entry { time: cluster.from, base: numbers.module_pose(cluster.base(), &poses), causes }
}
