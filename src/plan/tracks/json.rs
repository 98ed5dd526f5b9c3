//! Tracks as they stand in a plan file: beside every index the name of what it stands for. The library
//! stands once, beside the body.

use super::motion::{DockingEvent, DockingKind, Segment, Track, Tracks};
use super::names::RobotNames;
use super::obstacle::Obstacle;
use crate::plan::cause::CauseId;
use crate::plan::stated::Stated;
use crate::robot::{Assembly, Bond, JointId, Kinematics, Library, ModuleInstance, PortRef, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// The joint trajectories of an articulated robot over time, piecewise polynomials in Bernstein form, and the
/// bonds that hold.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Tracks", deny_unknown_fields)]
pub(in crate::plan) struct TracksJson<'a> {
    robot: RobotJson<'a>,
    /// The connected parts of the robot at the start, that of its base first: each is a robot by itself.
    clusters: Vec<ClusterJson>,
    /// The pose before the first motion; positions are in the order of `robot.joints`, flags in the order
    /// of `robot.bonds`.
    start: Cow<'a, State>,
    /// The duration, s.
    duration: f64,
    /// The joint trajectories, at most one a joint, ascending by joint. A joint without a track keeps its start
    /// position.
    tracks: Vec<TrackJson<'a>>,
    /// Changes of which bonds hold, in order of time.
    events: Vec<EventJson>,
    /// The solids that stand fast among the robots.
    #[serde(default, skip_serializing_if = "<[Obstacle]>::is_empty")]
    obstacles: Cow<'a, [Obstacle]>,
    /// The causes of the start pose, each as (joint, cause).
    start_causes: Cow<'a, [(JointId, CauseId)]>,
    /// The causes of bonds, each as (index of the bond in the robot, cause); a bond may have none.
    bond_causes: Cow<'a, [(usize, CauseId)]>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Robot", deny_unknown_fields)]
struct RobotJson<'a> {
    name: Cow<'a, str>,
    modules: Vec<ModuleJson>,
    /// The path name of every joint, by index: the joints of the modules in order, as their types list
    /// them, and then the hinges of the bonds that have one.
    joints: Vec<String>,
    /// Every bond that exists at some time.
    bonds: Vec<BondJson>,
    /// The index of the base module: its body's pose is part of the state, and is reported.
    base: usize,
    /// The name of that module.
    base_name: String,
    /// True if the connections may close loops.
    closed: bool,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Module", deny_unknown_fields)]
struct ModuleJson {
    /// Path name, such as `leg[2].m[0]`; unique in the robot.
    name: String,
    /// Index in the library's `modules`.
    kind: usize,
    /// The name of that type.
    kind_name: String,
}

/// A bond: port `b` is docked to port `a`. With P at `a` and Q at `b`, `X_PQ = Rz(180°) · Rx(turn · 360° / turns)`
/// with the `turns` of the connector; if that has a hinge at q, `Rot(axis, q)` stands before it.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Bond", deny_unknown_fields)]
struct BondJson {
    /// The names of its ports: `m[0].top -- m[1].bottom`; also the name of its hinge, if it has one.
    name: String,
    a: PortJson,
    b: PortJson,
    turn: u32,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "PortOfModule", deny_unknown_fields)]
struct PortJson {
    module: usize,
    port: usize,
    /// Path name, such as `m[0].top`.
    name: String,
}

/// Modules that hold together, moved and judged as one robot.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Cluster", deny_unknown_fields)]
struct ClusterJson {
    /// The name of the module whose pose stands for that of the cluster.
    reference: String,
    /// The names of its modules.
    modules: Vec<String>,
}

/// The trajectory of one joint: segments in order of time that do not overlap. Between two segments and after
/// the last, the joint holds the end position of the segment before.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Track", deny_unknown_fields)]
struct TrackJson<'a> {
    joint: JointId,
    /// The path name of the joint.
    name: String,
    segments: Cow<'a, [Segment]>,
}

/// A bond begins or ends to hold.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Event", deny_unknown_fields)]
struct EventJson {
    /// The time, s.
    time: f64,
    kind: DockingKind,
    /// Index in the robot's bonds.
    bond: usize,
    /// The name of that bond.
    name: String,
    /// The names of its ports.
    ports: [String; 2],
    cause: CauseId,
}

impl<'a> TracksJson<'a> {
    /// Returns tracks as they stand in a plan file, with the names of the robot; long lists are borrowed.
    pub(in crate::plan) fn of(tracks: &'a Tracks) -> TracksJson<'a> {
        let names = RobotNames::of(&tracks.robot);
        let event = |dock: &DockingEvent| EventJson {
            time: dock.time,
            kind: dock.kind,
            bond: dock.bond,
            name: names.bond(dock.bond),
            ports: names.ends(dock.bond),
            cause: dock.cause,
        };
        let track = |track: &'a Track| TrackJson {
            joint: track.joint,
            name: names.joint(track.joint),
            segments: Cow::Borrowed(&track.segments),
        };
        TracksJson {
            robot: RobotJson::of(&tracks.robot, &names),
            clusters: clusters(tracks, &names),
            start: Cow::Borrowed(&tracks.start),
            duration: tracks.duration,
            tracks: tracks.tracks.iter().map(track).collect(),
            events: tracks.events.iter().map(event).collect(),
            obstacles: Cow::Borrowed(&tracks.obstacles),
            start_causes: Cow::Borrowed(&tracks.start_causes),
            bond_causes: Cow::Borrowed(&tracks.bond_causes),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(in crate::plan) fn names(&self, stated: &mut Stated) {
        let robot = &self.robot;
        robot.modules.iter().for_each(|module| stated.add("the type of module", &module.kind_name));
        stated.add("base", &robot.base_name);
        stated.add_all("joint", &robot.joints);
        for bond in &robot.bonds {
            stated.add("bond", &bond.name);
            stated.add("port `a` of bond", &bond.a.name);
            stated.add("port `b` of bond", &bond.b.name);
        }
        for cluster in &self.clusters {
            stated.add("the reference of cluster", &cluster.reference);
            stated.add_all("cluster member", &cluster.modules);
        }
        self.tracks.iter().for_each(|track| stated.add("the joint of track", &track.name));
        for event in &self.events {
            stated.add("the bond of event", &event.name);
            stated.add("port `a` of event", &event.ports[0]);
            stated.add("port `b` of event", &event.ports[1]);
        }
    }

    /// Returns the tracks that stand in a file, of a robot of this library; nothing is checked.
    pub(in crate::plan) fn into_tracks(self, library: &Arc<Library>) -> Tracks {
        let track = |track: TrackJson| Track { joint: track.joint, segments: track.segments.into_owned() };
        let dock = |e: EventJson| DockingEvent { time: e.time, kind: e.kind, bond: e.bond, cause: e.cause };
        Tracks {
            robot: self.robot.into_assembly(library),
            start: self.start.into_owned(),
            tracks: self.tracks.into_iter().map(track).collect(),
            events: self.events.into_iter().map(dock).collect(),
            duration: self.duration,
            obstacles: self.obstacles.into_owned().into(),
            start_causes: self.start_causes.into_owned(),
            bond_causes: self.bond_causes.into_owned(),
        }
    }
}

/// Returns the clusters of a plan at its start; one of all modules where no others are stated.
fn clusters(tracks: &Tracks, names: &RobotNames) -> Vec<ClusterJson> {
    let robot = &tracks.robot;
    if tracks.start.clusters.is_empty() {
        let modules = robot.modules.iter().map(|module| module.name.clone()).collect();
        return vec![ClusterJson { reference: names.module(robot.base), modules }];
    }
    let references = std::iter::once(robot.base).chain(tracks.start.clusters.iter().map(|c| c.reference));
    let cluster = |reference: usize| {
        let tree = Kinematics::new(robot, &tracks.start.bonds, reference).tree;
        let mut modules: Vec<usize> = tree.order.iter().map(|(module, _)| *module).collect();
        modules.sort_unstable();
        ClusterJson {
            reference: names.module(reference),
            modules: modules.into_iter().map(|module| robot.modules[module].name.clone()).collect(),
        }
    };
    references.map(cluster).collect()
}

impl<'a> RobotJson<'a> {
    fn of(robot: &'a Assembly, names: &RobotNames) -> RobotJson<'a> {
        let module = |(index, module): (usize, &ModuleInstance)| ModuleJson {
            name: module.name.clone(),
            kind: module.kind,
            kind_name: names.module_type(index),
        };
        let port = |p: PortRef| PortJson { module: p.module, port: p.port, name: names.port(p) };
        let bond = |(index, bond): (usize, &Bond)| BondJson {
            name: names.bond(index),
            a: port(bond.a),
            b: port(bond.b),
            turn: bond.turn,
        };
        RobotJson {
            name: Cow::Borrowed(&robot.name),
            modules: robot.modules.iter().enumerate().map(module).collect(),
            joints: names.joints().to_vec(),
            bonds: robot.bonds.iter().enumerate().map(bond).collect(),
            base: robot.base,
            base_name: names.module(robot.base),
            closed: robot.closed,
        }
    }

    fn into_assembly(self, library: &Arc<Library>) -> Assembly {
        let port = |p: PortJson| PortRef { module: p.module, port: p.port };
        let bond = |bond: BondJson| Bond { a: port(bond.a), b: port(bond.b), turn: bond.turn };
        let module = |module: ModuleJson| ModuleInstance { name: module.name, kind: module.kind };
        Assembly {
            name: self.name.into_owned(),
            library: library.clone(),
            modules: self.modules.into_iter().map(module).collect(),
            bonds: self.bonds.into_iter().map(bond).collect(),
            base: self.base,
            closed: self.closed,
            misalignments: vec![],
        }
    }
}
