//! The turns of dockings between robots that stand by themselves, from how they stand then. Nothing is judged here.

use super::base_path::BasePath;
use super::cluster_paths::roll_out_path;
use super::clusters::Cluster;
use super::joining::pose_of_second;
use super::parted;
use super::placed_clusters::PlacedClusters;
use super::rollout_input::Rollout;
use super::succession;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::{Body, DockingKind, Plan, Tracks, validation};
use crate::robot::{Kinematics, mate, nearest_turn};

/// Returns the allowed turns of some bonds of an articulated robot's plan, by their indices, that are nearest to how their
/// ports stand as they dock for the first time, by the rollout that the judge makes, too. Bonds are left out that never dock,
/// or whose robots the rollout did not bring that far; none for a plan that is not valid.
pub fn dock_turns(plan: &Plan, bonds: &[usize]) -> Vec<(usize, u32)> {
    let Body::Tracks(tracks) = &plan.body else { return vec![] };
    if validation::check(plan).is_err() {
        return vec![];
    }
    let tolerances = Tolerances::default();
    let rollout = Rollout::of(plan, tracks, &tolerances);
    let Some(mut clusters) = parted::clusters(&rollout) else { return vec![] };
    let docks = |bond: usize| {
        let mut events = tracks.events.iter();
        events.find(|event| event.bond == bond && event.kind == DockingKind::Dock).map(|event| event.time)
    };
    let times: Vec<(usize, f64)> = bonds.iter().filter_map(|bond| Some((*bond, docks(*bond)?))).collect();
    let until = times.iter().map(|(_, time)| *time).fold(0.0, f64::max);
    let mut turns = Vec::new();
    succession::follow(&rollout, &mut clusters, until, &mut |begun| {
        for docked in &begun.beginning.joining.dockings {
            let (bond, error) = (&docked.bond, &docked.error);
            let X_PQ = mate(&tracks.robot, *bond) * error;
            turns.push((*bond, turn(tracks, *bond, &X_PQ)));
        }
        let path = roll_out_path(begun.rollout(&rollout), until);
        for &(bond, time) in &times {
            turns.extend(inside(&rollout, (begun.cluster(), &path), bond, time));
        }
        path
    });
    turns.retain(|(bond, _)| bonds.contains(bond));
    turns
}

/// Returns the bond with its turn if it docks at a time (s) at which both of its modules are of one cluster.
fn inside(
    rollout: &Rollout,
    (cluster, path): (&Cluster, &BasePath),
    bond: usize,
    time: f64,
) -> Option<(usize, u32)> {
    let tracks = rollout.tracks;
    if !(cluster.from < time && time <= cluster.tracks.duration && cluster.bonds.contains(&bond)) {
        return None;
    }
    let mut bonds = tracks.bonds(time);
    bonds[bond] = false;
    let numbers = Kinematics::new(&tracks.robot, &bonds, 0);
    let mut poses = vec![Pose::identity(); numbers.link_count()];
    let joints = tracks.state(time).joints;
    let mut placed = PlacedClusters::new(tracks, vec![(cluster, path)], rollout.tolerances);
    placed.place_one(0, time, (&joints, &bonds), &mut poses);
    Some((bond, turn(tracks, bond, &pose_of_second(tracks, &numbers, bond, &poses))))
}

fn turn(tracks: &Tracks, bond: usize, X_PQ: &Pose) -> u32 {
    nearest_turn(tracks.robot.connector(tracks.robot.bonds[bond].a), X_PQ).0
}
