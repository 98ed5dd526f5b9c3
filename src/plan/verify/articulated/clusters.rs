//! The clusters of a plan: the parts of a robot that bonds connect, each from the instant at which it comes off another
//! until it comes apart itself.
//!
//! The events of one instant act together: two bonds that are undone at once may cut a loop. A part becomes a robot of
//! its own, with its modules, bonds and joints alone and the times of the plan, so that all that judges a robot judges
//! it, and as fast.

use super::entry::Entry;
use super::rollout::Rollout;
use crate::plan::{CauseId, DockingEvent, DockingKind, Exemption, ExemptionKind, Track, Tracks};
use crate::robot::{Assembly, Bond, JointId, JointOwner, PortRef, State};

/// A part of a robot that bonds connect over an interval of time.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// The time from which the part is by itself, s from the start of the plan.
    pub from: f64,
    /// The number of the cluster of which it was a part before; `None` for the whole robot at the start.
    pub parent: Option<usize>,
    /// The modules, by their indices in the plan's robot, ascending.
    pub modules: Vec<usize>,
    /// The bonds between them, by their indices in the plan's robot, ascending.
    pub bonds: Vec<usize>,
    /// The part as a robot of its own, with its motion from the start of the plan up to the time at which it comes apart
    /// itself, its `duration`. The bonds of its start hold just after `from`; its events are those between.
    pub tracks: Tracks,
    /// The exemptions of the plan, by the same indices, with the parts of this robot; one about other parts is never in
    /// force.
    pub exemptions: Vec<Exemption>,
}

impl Cluster {
    /// Returns the base by its index in the plan's robot.
    pub(super) fn base(&self) -> usize {
        self.modules[self.tracks.robot.base]
    }

    /// Returns true if the part is by itself just after a time (s), or at the end of the plan, at `end` (s).
    pub(super) fn exists(&self, time: f64, end: f64) -> bool {
        let to = self.tracks.duration;
        self.from <= time && (time < to || to == end)
    }

    /// Returns the rollout of the part. `whole`: that of the plan; `begin`: where the part comes off another, `None` for
    /// the whole robot at the start.
    pub(super) fn rollout<'a>(&'a self, whole: &Rollout<'a>, begin: Option<&'a Entry>) -> Rollout<'a> {
        Rollout { tracks: &self.tracks, exemptions: &self.exemptions, begin, ..*whole }
    }
}

/// Returns the clusters of a plan whose robot comes apart, each after the one of which it was a part, with the first
/// event that joins two of them again, at which all end; `None` where the robot stays one, or is not one at the start.
/// `reference` chooses the base of a part that the base of its parent does not belong to, by its index in the part.
pub(super) fn of(
    tracks: &Tracks,
    exemptions: &[Exemption],
    reference: impl Fn(&Cluster) -> usize,
) -> Option<(Vec<Cluster>, Option<DockingEvent>)> {
    let mut bonds = tracks.start.bonds.clone();
    let whole = components(&tracks.robot, &bonds);
    if whole.len() != 1 {
        return None;
    }
    let mut now = vec![(0, whole.into_iter().next()?)];
    let mut found = vec![Part { from: 0.0, parent: None, modules: now[0].1.clone(), bonds: bonds.clone() }];
    let mut ends = vec![tracks.duration];
    let mut joins = None;
    for events in tracks.events.chunk_by(|a, b| a.time == b.time) {
        let time = events[0].time;
        events.iter().for_each(|event| bonds[event.bond] = event.kind == DockingKind::Dock);
        let after = components(&tracks.robot, &bonds);
        if after.iter().eq(now.iter().map(|(_, modules)| modules)) {
            continue;
        }
        let before = |module: usize| now.iter().find(|(_, modules)| modules.binary_search(&module).is_ok());
        let joined = |event: &&DockingEvent| {
            let Bond { a, b, .. } = tracks.robot.bonds[event.bond];
            let docks = event.kind == DockingKind::Dock;
            docks && before(a.module).map(|part| part.0) != before(b.module).map(|part| part.0)
        };
        if let Some(event) = events.iter().find(joined) {
            joins = Some(event.clone());
            now.iter().for_each(|(index, _)| ends[*index] = time);
            break;
        }
        let mut next = Vec::new();
        for modules in after {
            let (parent, known) = before(modules[0]).expect("each module belonged to a cluster");
            if *known == modules {
                next.push((*parent, modules));
                continue;
            }
            ends[*parent] = time;
            next.push((found.len(), modules.clone()));
            found.push(Part { from: time, parent: Some(*parent), modules, bonds: bonds.clone() });
            ends.push(tracks.duration);
        }
        now = next;
    }
    if found.len() == 1 && joins.is_none() {
        return None;
    }
    let mut clusters: Vec<Cluster> = Vec::with_capacity(found.len());
    for (part, to) in found.into_iter().zip(ends) {
        let mut cluster = part.cluster(tracks, exemptions, to);
        let held = part.parent.map(|parent| clusters[parent].base());
        let bases = [held, Some(tracks.robot.base)];
        let own = bases.into_iter().flatten().find_map(|base| cluster.modules.binary_search(&base).ok());
        cluster.tracks.robot.base = own.unwrap_or_else(|| reference(&cluster));
        clusters.push(cluster);
    }
    Some((clusters, joins))
}

/// A part as it is found: the indices of its modules, and flags for all bonds of the robot just after it begins.
struct Part {
    from: f64,
    parent: Option<usize>,
    modules: Vec<usize>,
    bonds: Vec<bool>,
}

impl Part {
    /// Returns the cluster that this part is until `to` (s), with its first module as its base.
    fn cluster(&self, tracks: &Tracks, exemptions: &[Exemption], to: f64) -> Cluster {
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
        };
        let between = |event: &&DockingEvent| {
            (event.time > self.from || self.parent.is_none()) && (event.time < to || to == tracks.duration)
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
            parent: self.parent,
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
