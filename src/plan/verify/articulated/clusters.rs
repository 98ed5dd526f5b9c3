//! The clusters of a plan: the sets of modules that bonds connect, each from the instant at which it comes to be, at the
//! start or by docking and undocking, until it does not hold any more.
//!
//! The events of one instant act together: two bonds that are undone at once may cut a loop, a module may be handed over.
//! A cluster becomes a robot of its own, with its modules, bonds and joints alone and the times of the plan, so that all
//! that judges a robot judges it, and as fast.

use super::entry::Entry;
use super::rollout_input::{Rollout, is_surrounded};
use super::snapping::Snap;
use crate::geometry::Pose;
use crate::plan::{CauseId, DockingEvent, DockingKind, Exemption, ExemptionKind, Track, Tracks, WorldFrom};
use crate::robot::{Assembly, Bond, JointId, JointOwner, PortRef, State};
use std::collections::BTreeSet;

/// Modules that bonds connect over an interval of time.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// The time from which the cluster is there, s from the start of the plan.
    pub from: f64,
    /// The numbers of the clusters whose modules it has, that of its base first; none for one of the start.
    pub parents: Vec<usize>,
    /// The events at `from` by which modules of different parents dock, in the order of the plan.
    pub joins: Vec<DockingEvent>,
    /// The motions by which its parents snap to each other as it begins, in their order; none before it has been followed.
    pub snaps: Vec<Snap>,
    /// The modules, by their indices in the plan's robot, ascending.
    pub modules: Vec<usize>,
    /// The bonds between them, by their indices in the plan's robot, ascending.
    pub bonds: Vec<usize>,
    /// The cluster as a robot of its own, with its motion from the start of the plan up to the time at which it no longer
    /// is one, its `duration`. The bonds of its start hold just after `from`; its events are those between.
    pub tracks: Tracks,
    /// The exemptions of the plan, by the same indices, with the parts of this robot; one about other parts is never in
    /// force.
    pub exemptions: Vec<Exemption>,
    /// True if the cluster is there to the end of the plan: no event ends it, not one at that very time either.
    pub lasts: bool,
    /// The worlds of the plan as they are for the cluster; `None` where they are no others.
    pub worlds: Option<Vec<WorldFrom>>,
    /// The cluster in words, by its base.
    pub name: String,
}

impl Cluster {
    /// Returns the base by its index in the plan's robot.
    pub(super) fn base(&self) -> usize {
        self.modules[self.tracks.robot.base]
    }

    /// Returns true if the cluster is there just after a time (s), or at the end of the plan.
    pub(super) fn exists(&self, time: f64) -> bool {
        self.from <= time && (time < self.tracks.duration || self.lasts)
    }

    /// Returns the rollout of the cluster. `whole`: that of the plan; `begin`: where it comes to be, `None` for one of the
    /// start.
    pub(super) fn rollout<'a>(&'a self, whole: &Rollout<'a>, begin: Option<&'a Entry>) -> Rollout<'a> {
        let as_placed = is_surrounded(whole.tracks);
        let (tracks, exemptions) = (&self.tracks, self.exemptions.as_slice());
        let floats = whole.is_full();
        let worlds = self.worlds.as_deref().unwrap_or(whole.worlds);
        Rollout { tracks, exemptions, worlds, begin, subject: &self.name, as_placed, floats, ..*whole }
    }

    /// Gives bonds of the cluster the misalignments that they docked with, as (index in the plan's robot, misalignment),
    /// ascending; those of bonds of other clusters are left out.
    pub(super) fn misalign(&mut self, known: &[(usize, Pose)]) {
        let own = |(bond, error): &(usize, Pose)| Some((self.bonds.binary_search(bond).ok()?, *error));
        self.tracks.robot.misalignments = known.iter().filter_map(own).collect();
    }

    /// Returns the misalignments of the cluster's bonds, as (index in the plan's robot, misalignment), ascending.
    pub(super) fn misalignments(&self) -> Vec<(usize, Pose)> {
        self.tracks.robot.misalignments.iter().map(|(bond, error)| (self.bonds[*bond], *error)).collect()
    }
}

/// Returns the clusters of a plan, each after those of whose modules it consists; `None` for one robot that stays one in an
/// empty world, with all bonds perfect, and where modules are connected with nothing that stands for them at the start. `reference` chooses the
/// base of a cluster with none of the bases that are stated, by its index in the cluster.
pub(super) fn of(
    tracks: &Tracks,
    exemptions: &[Exemption],
    reference: impl Fn(&Cluster) -> usize,
) -> Option<Vec<Cluster>> {
    let mut timeline = Timeline::begin(tracks)?;
    for events in tracks.events.chunk_by(|a, b| a.time == b.time) {
        timeline.pass(events);
    }
    let Timeline { found, ends, now, .. } = timeline;
    if found.len() == 1 && tracks.obstacles.is_empty() && tracks.start.misalignments.is_empty() {
        return None;
    }
    let stated: Vec<usize> = stated_bases(tracks).collect();
    let mut clusters: Vec<Cluster> = Vec::with_capacity(found.len());
    for (index, (mut part, to)) in found.into_iter().zip(ends).enumerate() {
        let mut bases =
            part.parents.iter().map(|parent| clusters[*parent].base()).chain(stated.iter().copied());
        let known = bases.find_map(|base| part.modules.binary_search(&base).ok());
        let mut cluster = part.cluster(tracks, exemptions, (to, now.contains(&index)));
        cluster.tracks.robot.base = known.unwrap_or_else(|| reference(&cluster));
        let base = cluster.base();
        let holds = |parent: &usize| clusters[*parent].modules.binary_search(&base).is_ok();
        part.parents.sort_by_key(|parent| !holds(parent));
        cluster.parents = part.parents;
        if let Some(start) = tracks.start.clusters.iter().find(|start| start.reference == base) {
            cluster.tracks.start.base = start.pose;
        }
        let word = if tracks.start.clusters.is_empty() { "part" } else { "robot" };
        cluster.name = format!("the {word} with `{}`", tracks.robot.modules[base].name);
        clusters.push(cluster);
    }
    Some(clusters)
}

/// Returns the modules whose poses are stated at the start, by their indices, that of the plan's base first.
fn stated_bases(tracks: &Tracks) -> impl Iterator<Item = usize> + '_ {
    let further = tracks.start.clusters.iter().map(|cluster| cluster.reference);
    std::iter::once(tracks.robot.base).chain(further)
}

/// The clusters of a plan from its start up to an event.
struct Timeline<'a> {
    tracks: &'a Tracks,
    /// Flags for all bonds of the robot, true if they hold now.
    bonds: Vec<bool>,
    /// The bonds that hold, and by which robots docked that stood by themselves.
    joining: BTreeSet<usize>,
    /// All clusters so far.
    found: Vec<Part>,
    /// The end of each of them, s: that of the plan as long as it is there.
    ends: Vec<f64>,
    /// The clusters that are there now, by their numbers, in the order of their first modules.
    now: Vec<usize>,
}

impl<'a> Timeline<'a> {
    /// Returns the clusters at the start; `None` where a set of connected modules has not one module whose pose is stated.
    fn begin(tracks: &'a Tracks) -> Option<Timeline<'a>> {
        let bonds = tracks.start.bonds.clone();
        let sets = components(&tracks.robot, &bonds);
        let stands = |set: &Vec<usize>| {
            stated_bases(tracks).filter(|base| set.binary_search(base).is_ok()).count() == 1
        };
        if !sets.iter().all(stands) {
            return None;
        }
        let part =
            |modules| Part { from: 0.0, parents: vec![], joins: vec![], modules, bonds: bonds.clone() };
        let found: Vec<Part> = sets.into_iter().map(part).collect();
        let now = (0..found.len()).collect();
        let ends = vec![tracks.duration; found.len()];
        let joining = tracks.start.misalignments.iter().map(|error| error.bond).collect();
        Some(Timeline { tracks, bonds, joining, found, ends, now })
    }

    /// Takes the events of one instant: clusters whose modules change end, and so do those in which a bond is undone that
    /// joined two, whose error of docking is forgotten.
    fn pass(&mut self, events: &[DockingEvent]) {
        let mut forgets: BTreeSet<usize> = BTreeSet::new();
        for event in events {
            let docks = event.kind == DockingKind::Dock;
            self.bonds[event.bond] = docks;
            if !docks && self.joining.remove(&event.bond) {
                forgets.insert(self.tracks.robot.bonds[event.bond].a.module);
            }
        }
        let mut owner = vec![0; self.tracks.robot.modules.len()];
        for &index in &self.now {
            self.found[index].modules.iter().for_each(|module| owner[*module] = index);
        }
        let ends_of = |bond: usize| {
            let Bond { a, b, .. } = self.tracks.robot.bonds[bond];
            (owner[a.module], owner[b.module])
        };
        let joined = |event: &&DockingEvent| {
            let (a, b) = ends_of(event.bond);
            event.kind == DockingKind::Dock && a != b
        };
        let joins: Vec<DockingEvent> = events.iter().filter(joined).cloned().collect();
        let time = events[0].time;
        let mut next = Vec::new();
        for modules in components(&self.tracks.robot, &self.bonds) {
            let first = owner[modules[0]];
            let forgotten = forgets.iter().any(|module| modules.binary_search(module).is_ok());
            if self.found[first].modules == modules && !forgotten {
                next.push(first);
                continue;
            }
            let own = |event: &&DockingEvent| {
                modules.binary_search(&self.tracks.robot.bonds[event.bond].a.module).is_ok()
            };
            let joins: Vec<DockingEvent> = joins.iter().filter(own).cloned().collect();
            // The cluster of the first port of the first docking carries the others.
            let mut parents: Vec<usize> = joins.iter().map(|event| ends_of(event.bond).0).take(1).collect();
            for module in &modules {
                if !parents.contains(&owner[*module]) {
                    parents.push(owner[*module]);
                }
            }
            parents.iter().for_each(|parent| self.ends[*parent] = time);
            self.joining.extend(joins.iter().map(|event| event.bond));
            next.push(self.found.len());
            self.found.push(Part { from: time, parents, joins, modules, bonds: self.bonds.clone() });
            self.ends.push(self.tracks.duration);
        }
        self.now = next;
    }
}

/// A cluster as it is found: the indices of its modules, and flags for all bonds of the robot just after it begins.
struct Part {
    from: f64,
    parents: Vec<usize>,
    joins: Vec<DockingEvent>,
    modules: Vec<usize>,
    bonds: Vec<bool>,
}

impl Part {
    /// Returns the cluster that this part is until `to` (s), with its first module as its base. `lasts`: true if nothing ends
    /// it.
    fn cluster(&self, tracks: &Tracks, exemptions: &[Exemption], (to, lasts): (f64, bool)) -> Cluster {
        let robot = &tracks.robot;
        let module = |module: usize| self.modules.binary_search(&module).ok();
        let port = |port: PortRef| Some(PortRef { module: module(port.module)?, ..port });
        let image = |bond: &Bond| Some(Bond { a: port(bond.a)?, b: port(bond.b)?, ..*bond });
        let kept: Vec<(usize, Bond)> =
            robot.bonds.iter().enumerate().filter_map(|(index, bond)| Some((index, image(bond)?))).collect();
        let bonds: Vec<usize> = kept.iter().map(|(index, _)| *index).collect();
        let bond = |bond: usize| bonds.binary_search(&bond).ok();
        let owned = |owner: &JointOwner| match *owner {
            JointOwner::Module { module: owner, .. } => module(owner).is_some(),
            JointOwner::Bond(index) => bond(index).is_some(),
        };
        let joints: Vec<usize> =
            robot.joints().enumerate().filter(|(_, owner)| owned(owner)).map(|(index, _)| index).collect();
        let joint =
            |id: JointId| joints.binary_search(&(id.0 as usize)).ok().map(|index| JointId(index as u32));
        let own = Assembly {
            modules: self.modules.iter().map(|&module| robot.modules[module].clone()).collect(),
            bonds: kept.iter().map(|(_, bond)| *bond).collect(),
            base: 0,
            name: robot.name.clone(),
            library: robot.library.clone(),
            closed: robot.closed,
            misalignments: vec![],
        };
        let start = State {
            joints: joints.iter().map(|&joint| tracks.start.joints[joint]).collect(),
            bonds: bonds.iter().map(|&bond| self.bonds[bond]).collect(),
            base: tracks.start.base,
            clusters: vec![],
            misalignments: vec![],
        };
        let between = |event: &&DockingEvent| {
            (event.time > self.from || self.parents.is_empty()) && (event.time < to || lasts)
        };
        let events = tracks
            .events
            .iter()
            .filter(between)
            .filter_map(|event| Some(DockingEvent { bond: bond(event.bond)?, ..event.clone() }));
        let exempt = |exemption: &Exemption| {
            let kind = match exemption.kind.clone() {
                ExemptionKind::Collision(Some((a, b))) => {
                    module(a).zip(module(b)).map(|pair| ExemptionKind::Collision(Some(pair)))
                }
                ExemptionKind::Overload(Some(id)) => {
                    joint(JointId(id)).map(|id| ExemptionKind::Overload(Some(id.0)))
                }
                kind => Some(kind),
            };
            match kind {
                Some(kind) => Exemption { kind, ..exemption.clone() },
                None => Exemption { from: f64::INFINITY, to: f64::INFINITY, ..exemption.clone() },
            }
        };
        let motion = |track: &Track| Some(Track { joint: joint(track.joint)?, ..track.clone() });
        let start_cause = |(id, cause): &(JointId, CauseId)| Some((joint(*id)?, *cause));
        let bond_cause = |(index, cause): &(usize, CauseId)| Some((bond(*index)?, *cause));
        Cluster {
            from: self.from,
            parents: vec![],
            joins: self.joins.clone(),
            snaps: vec![],
            lasts,
            worlds: None,
            name: String::new(),
            modules: self.modules.clone(),
            tracks: Tracks {
                robot: own,
                start,
                tracks: tracks.tracks.iter().filter_map(motion).collect(),
                events: events.collect(),
                duration: to,
                obstacles: tracks.obstacles.clone(),
                start_causes: tracks.start_causes.iter().filter_map(start_cause).collect(),
                bond_causes: tracks.bond_causes.iter().filter_map(bond_cause).collect(),
            },
            bonds,
            exemptions: exemptions.iter().map(exempt).collect(),
        }
    }
}

/// Returns the sets of modules that the bonds that hold connect, each ascending, in the order of their first modules.
fn components(robot: &Assembly, bonds: &[bool]) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..robot.modules.len()).collect();
    let find = |root: &mut Vec<usize>, mut at: usize| {
        while root[at] != at {
            root[at] = root[root[at]];
            at = root[at];
        }
        at
    };
    for (bond, _) in robot.bonds.iter().zip(bonds).filter(|(_, holds)| **holds) {
        let (a, b) = (find(&mut root, bond.a.module), find(&mut root, bond.b.module));
        // The least module of a set is its root.
        root[a.max(b)] = a.min(b);
    }
    let mut sets: Vec<Vec<usize>> = Vec::new();
    let mut set_of = vec![usize::MAX; robot.modules.len()];
    for module in 0..robot.modules.len() {
        let first = find(&mut root, module);
        if first == module {
            set_of[module] = sets.len();
            sets.push(Vec::new());
        }
        sets[set_of[first]].push(module);
    }
    sets
}
