//! The validation of tracks: references, orders and ranges.

use super::motion::{DockingEvent, DockingKind, Track, Tracks};
use super::obstacle::Obstacle;
use crate::geometry::soundness::{check_placed, check_pose};
use crate::plan::cause::CauseId;
use crate::plan::fault::{PlanFault, TracksFault, need, need_bounded, need_finite, need_index};
use crate::plan::polynomial::DEGREE_MAX;
use crate::plan::tolerances::TOLERANCES;
use crate::robot::validation::{MODULE_EXTENT_MAX, POSITION_MAX, check_library};
use crate::robot::{Assembly, JointOwner, Kinematics, Library, PortRef};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Tracks {
    /// Checks that the tracks are well formed: that every index is within its list, that modules have different names,
    /// that the start has a position for every joint and a state for every bond, that tracks, segments and dockings
    /// are in order and within the duration, that segments have 2 to [`DEGREE_MAX`] + 1 control points and begin where
    /// the joint is, and that a bond is closed before it opens and open before it closes. `causes`: the number of
    /// causes of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(in crate::plan) fn validate(&self, causes: usize) -> Result<(), PlanFault> {
        robot(&self.robot)?;
        let (joints, bonds) = (self.robot.joints().count(), self.robot.bonds.len());
        need(self.start.joints.len() == joints, || TracksFault::StartJoints { joints })?;
        need(self.start.bonds.len() == bonds, || TracksFault::StartBonds { bonds })?;
        self.clusters()?;
        let ascending = self.tracks.windows(2).all(|w| w[0].joint < w[1].joint);
        need(ascending, || TracksFault::TrackOrder)?;
        for track in &self.tracks {
            let joint = track.joint.0;
            need_index(joint as usize, joints, "joint")?;
            self.segments(track, causes)
                .map_err(|fault| PlanFault::InTrack { joint, fault: Box::new(fault) })?;
        }
        self.events(causes)?;
        for &(joint, id) in &self.start_causes {
            need_index(joint.0 as usize, joints, "joint").and(cause(id, causes))?;
        }
        let known = |&(bond, id): &(usize, CauseId)| need_index(bond, bonds, "bond").and(cause(id, causes));
        self.bond_causes.iter().try_for_each(known)
    }

    /// Checks that each cluster stated at the start is one by itself, and obstacles have names of their own.
    fn clusters(&self) -> Result<(), PlanFault> {
        let references = self.start.clusters.iter().map(|cluster| cluster.reference);
        let mut known = BTreeSet::new();
        for reference in std::iter::once(self.robot.base).chain(references) {
            need_index(reference, self.robot.modules.len(), "module")?;
            let new = !known.contains(&reference);
            need(new, || TracksFault::OneCluster { reference: self.robot.modules[reference].name.clone() })?;
            if !self.start.clusters.is_empty() {
                let tree = Kinematics::new(&self.robot, &self.start.bonds, reference).tree;
                known.extend(tree.order.iter().map(|(module, _)| *module));
            }
        }
        let mut before = None;
        for error in &self.start.misalignments {
            need_index(error.bond, self.robot.bonds.len(), "bond")?;
            let sound = self.start.bonds[error.bond] && before < Some(error.bond);
            need(sound, || TracksFault::Misalignment { bond: self.robot.bond_name(error.bond) })?;
            before = Some(error.bond);
        }
        let mut names: BTreeSet<&String> = self.robot.modules.iter().map(|module| &module.name).collect();
        for Obstacle { name, .. } in &*self.obstacles {
            need(names.insert(name), || TracksFault::SharedName { name: name.clone() })?;
        }
        Ok(())
    }

    fn segments(&self, track: &Track, causes: usize) -> Result<(), PlanFault> {
        let mut now = 0.0;
        let mut at = self.start.joints[track.joint.0 as usize];
        for segment in &track.segments {
            cause(segment.cause, causes)?;
            let (start, end, count) = (segment.start, segment.end, segment.control.len());
            let degree = (2..=DEGREE_MAX + 1).contains(&count);
            need(degree, || TracksFault::ControlPoints { time: start, count })?;
            let in_order = now <= start && start < end && end <= self.duration;
            need(in_order, || TracksFault::SegmentOrder { start, end })?;
            need((segment.control[0] - at).abs() <= TOLERANCES.joint_jump, || TracksFault::Jump {
                time: start,
            })?;
            (now, at) = (end, segment.last());
        }
        Ok(())
    }

    fn events(&self, causes: usize) -> Result<(), PlanFault> {
        let mut now = 0.0;
        let mut holds = self.start.bonds.clone();
        for &DockingEvent { time, kind, bond, cause: id } in &self.events {
            cause(id, causes)?;
            need_index(bond, holds.len(), "bond")?;
            need(now <= time && time <= self.duration, || TracksFault::EventOrder { time })?;
            let docks = kind == DockingKind::Dock;
            need(holds[bond] != docks, || TracksFault::BondUnchanged { time, bond, holds: docks })?;
            holds[bond] = docks;
            now = time;
        }
        Ok(())
    }

    /// Checks that all numbers are finite.
    ///
    /// # Errors
    /// [`PlanFault::Unwritable`] for the first number that is not finite.
    pub(in crate::plan) fn check_numbers(&self) -> Result<(), PlanFault> {
        need_finite("the start", &self.start)?;
        need_finite("the tracks", &self.tracks)?;
        need_finite("the docks", &self.events)?;
        need_finite("the obstacles", &self.obstacles)?;
        need_finite("the robot", &*self.robot.library)
    }

    /// Checks that joints can be moved and stay in their bounds, and that ports which are docked mate. The references
    /// must have been checked, or it panics. `library`: that of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(in crate::plan) fn check_ranges(&self, library: &Arc<Library>) -> Result<(), PlanFault> {
        // The library of the plan has been checked, and is that of its robot, as a rule.
        if !Arc::ptr_eq(library, &self.robot.library) {
            check_library(&self.robot.library).map_err(PlanFault::Library)?;
        }
        check_pose(&self.start.base).map_err(|fault| PlanFault::Pose { of: "the base", fault })?;
        for error in &self.start.misalignments {
            check_pose(&error.pose).map_err(|fault| PlanFault::Pose { of: "a misalignment", fault })?;
        }
        for cluster in &self.start.clusters {
            check_pose(&cluster.pose).map_err(|fault| PlanFault::Pose { of: "a cluster", fault })?;
        }
        for Obstacle { name, shapes } in &*self.obstacles {
            let sound = shapes.iter().try_for_each(check_placed);
            sound.map_err(|fault| TracksFault::Obstacle { name: name.clone(), fault })?;
        }
        let owners: Vec<JointOwner> = self.robot.joints().collect();
        let farthest =
            |owner: JointOwner| if self.robot.slides(owner) { MODULE_EXTENT_MAX } else { POSITION_MAX };
        for (&position, &owner) in self.start.joints.iter().zip(&owners) {
            need_bounded(position, farthest(owner), "the start position of a joint")?;
        }
        for track in &self.tracks {
            let owner = owners[track.joint.0 as usize];
            let limit = farthest(owner);
            let far = track.segments.iter().flat_map(|s| &s.control).any(|q| q.abs() > limit);
            need(!far, || TracksFault::FarJoint { limit })?;
            need(self.robot.takes_commands(owner), || TracksFault::NoCommands {
                joint: self.robot.joint_name(owner),
            })?;
        }
        ports(&self.robot, &self.start.bonds)?;
        let mut bonds = self.start.bonds.clone();
        self.events.iter().try_for_each(|dock| {
            bonds[dock.bond] = !bonds[dock.bond];
            ports(&self.robot, &bonds)
                .map_err(|fault| PlanFault::After { time: dock.time, fault: Box::new(fault) })
        })
    }
}

fn cause(id: CauseId, causes: usize) -> Result<(), PlanFault> {
    need_index(id.0 as usize, causes, "cause")
}

/// Checks that the indices of an assembly are within their lists, the turns of its bonds among those of their
/// connectors, and that no two of its modules have one name.
///
/// # Errors
/// The first [`PlanFault`] found.
pub(super) fn robot(robot: &Assembly) -> Result<(), PlanFault> {
    need_index(robot.base, robot.modules.len(), "module")?;
    let mut names = BTreeSet::new();
    for module in &robot.modules {
        need_index(module.kind, robot.library.modules.len(), "module type")?;
        let new = names.insert(&module.name);
        need(new, || TracksFault::SharedName { name: module.name.clone() })?;
    }
    for bond in &robot.bonds {
        port(bond.a, robot)?;
        port(bond.b, robot)?;
        need_index(bond.turn as usize, robot.connector(bond.a).turns as usize, "turn")?;
    }
    Ok(())
}

fn port(port: PortRef, robot: &Assembly) -> Result<(), PlanFault> {
    need_index(port.module, robot.modules.len(), "module")?;
    need_index(port.port, robot.module_type(port.module).ports.len(), "port")
}

/// Checks that the connectors of bonds which hold mate, and that no port is held twice.
fn ports(robot: &Assembly, holds: &[bool]) -> Result<(), PlanFault> {
    let mut taken = BTreeSet::new();
    let connector = |port: PortRef| robot.module_type(port.module).ports[port.port].connector;
    for (bond, _) in robot.bonds.iter().zip(holds).filter(|(_, holds)| **holds) {
        for port in [bond.a, bond.b] {
            need(taken.insert(port), || TracksFault::PortTaken { port: robot.port_name(port) })?;
        }
        let mates = &robot.library.connectors[connector(bond.a)].mates;
        need(mates.contains(&connector(bond.b)), || TracksFault::NoMate {
            a: robot.port_name(bond.a),
            b: robot.port_name(bond.b),
        })?;
    }
    Ok(())
}
