//! Collisions in the verdict: failures with the actions to blame.

use super::blame::{self, BLAMED_MAX};
use super::bodies::{Bodies, UnsoundLink};
use super::collision::{self, Collision, Findings, Span};
use super::docking;
use super::dynamics::{self, DeflectedMotion};
use super::polyline::Polyline;
use super::rollout_input::Rollout;
use super::tolerances::Tolerances;
use super::work_budget::work_max;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, DockingEvent, DockingKind, Failure, Status, Tracks};
use crate::robot::{Bond, JointId, Kinematics};

/// The collisions as planned, with the compiled bodies of the robot.
pub(super) struct PlannedCollisions {
    bodies: Bodies,
    found: Findings,
}

/// Returns the collisions of the whole plan. It needs the relative poses of links only, whatever the ground is.
///
/// # Errors
/// [`UnsoundLink`] for the first link whose shape is not sound.
pub(super) fn find(rollout: &Rollout) -> Result<PlannedCollisions, UnsoundLink> {
    let bodies = Bodies::of_plan(rollout.tracks)?;
    let precision = &rollout.tolerances.collision;
    let found = collision::planned(
        rollout.tracks,
        &bodies,
        rollout.settings,
        rollout.exemptions,
        (precision, span(rollout)),
    );
    Ok(PlannedCollisions { bodies, found })
}

/// Returns the interval of time of a rollout.
fn span(rollout: &Rollout) -> Span {
    Span { from: rollout.from(), to: rollout.tracks.duration, end: rollout.end }
}

/// Judges the collisions of the whole plan, those that [`find`] returned: records failures with the actions to blame,
/// the clearance, and the status of the check. `deflected`: the positions of the joints as soft servos yield, which are
/// judged besides; `None` where no loads were determined.
pub(super) fn judge(
    rollout: &Rollout,
    planned: Result<PlannedCollisions, UnsoundLink>,
    deflected: Option<DeflectedMotion>,
    ledger: &mut Ledger,
) {
    let tracks = rollout.tracks;
    let PlannedCollisions { bodies, found } = match planned {
        Ok(planned) => planned,
        Err(unsound) => {
            let message =
                format!("the shape of {}.{} can't be judged: {}", unsound.module, unsound.link, unsound.why);
            return ledger.fail(Failure::form(message));
        }
    };
    for index in &found.used {
        ledger.use_exemption(*index, CheckKind::Collision);
    }
    for meeting in found.collisions.iter().filter(|c| !c.exempt) {
        let mut failure = meeting.failure(&tracks.robot);
        match meeting.bond {
            Some(bond) => (failure.blame, failure.blames_start) = docked(tracks, bond, meeting.time),
            None => failure.blame = blamed(tracks, &bodies, meeting, |_| -meeting.allowed),
        }
        ledger.fail(failure);
    }
    if let Status::Sampled(samples) = found.status {
        let most = rollout.settings.samples_max;
        let modules = tracks.robot.modules.len();
        let within = if samples < most {
            let work = work_max(most, modules);
            format!("the work of {work} comparisons, for {most} samples of a robot of {modules} modules")
        } else {
            format!("{samples} stretches of time")
        };
        let message = format!("whether modules meet was not decided within {within}, the most allowed");
        ledger.fail(Failure { value: samples as f64, limit: most as f64, ..Failure::form(message) });
    }
    ledger.verdict.clearance = found.clearance;
    ledger.verdict.samples += found.samples;
    ledger.check(CheckKind::Collision, found.status);
    if let Some(deflected) = deflected.filter(|deflected| deflected.instants > 0) {
        judge_deflected(rollout, &bodies, deflected, &found.collisions, ledger);
    }
}

/// Judges whether links meet as servos yield that do not meet as planned; `planned`: the collisions as planned.
fn judge_deflected(
    rollout: &Rollout,
    bodies: &Bodies,
    deflected: DeflectedMotion,
    planned: &[Collision],
    ledger: &mut Ledger,
) {
    let (tracks, DeflectedMotion { along, instants }) = (rollout.tracks, deflected);
    let tolerances = rollout.tolerances;
    let along_span = (&along, span(rollout));
    let found = collision::deflected(tracks, bodies, rollout.settings, rollout.exemptions, along_span);
    for index in &found.used {
        ledger.use_exemption(*index, CheckKind::Deflection);
    }
    let meets = |c: &&Collision| {
        let deep = c.depth > c.allowed + tolerances.deflected_depth;
        let planned = planned.iter().any(|p| p.modules == c.modules);
        deep && !c.exempt && !planned && parts(tracks, bodies, c, &along, tolerances)
    };
    for meeting in found.collisions.iter().filter(meets) {
        let mut failure = meeting.failure(&tracks.robot);
        failure.kind = CheckKind::Deflection;
        failure.message += &format!(", as {} yield under their loads", dynamics::soft_servos());
        // A joint to blame parts them by as much as they meet.
        failure.blame = blamed(tracks, bodies, meeting, |apart| apart + meeting.depth);
        ledger.fail(failure);
    }
    let status = match found.status {
        Status::Sampled(_) => Status::NotChecked("the work of comparisons was spent".to_owned()),
        _ => Status::Sampled(instants),
    };
    ledger.check(CheckKind::Deflection, status);
}

/// Returns the action that docked two links, and false; or the line that connects them from the start, and true.
fn docked(tracks: &Tracks, bond: usize, time: f64) -> (Vec<CauseId>, bool) {
    let docks =
        |dock: &&DockingEvent| dock.kind == DockingKind::Dock && dock.bond == bond && dock.time <= time;
    if let Some(dock) = tracks.events.iter().rfind(docks) {
        return (vec![dock.cause], false);
    }
    let causes = tracks.bond_causes.iter().filter(|(connected, _)| *connected == bond);
    (causes.map(|(_, cause)| *cause).collect(), true)
}

/// Returns the actions whose joint, held still from its start, keeps the two links apart at the instant of their
/// greatest depth; latest first. `needed`: the function that returns the signed distance that they must then have, m,
/// from that which they have as planned.
fn blamed(
    tracks: &Tracks,
    bodies: &Bodies,
    meeting: &Collision,
    needed: impl Fn(f64) -> f64,
) -> Vec<CauseId> {
    let state = tracks.state(meeting.deepest);
    let mut links = MeetingLinks::new(tracks, bodies, meeting, state.bonds);
    let needed = needed(links.distance(&state.joints));
    let mut blamed = vec![];
    for suspect in blame::suspects(tracks, meeting.deepest) {
        if blamed.len() == BLAMED_MAX || blamed.contains(&suspect.cause) {
            continue;
        }
        let mut joints = state.joints.clone();
        let track = tracks.track(JointId(suspect.joint as u32)).expect("a suspect moves on a track");
        joints[suspect.joint] = track.position(tracks.start.joints[suspect.joint], suspect.start);
        if links.distance(&joints) >= needed {
            blamed.push(suspect.cause);
        }
    }
    blamed
}

/// Returns true if two links meet with the joints `along` at an instant at which their modules are not face to face as
/// planned. Modules whose ports are within capture of each other, about to dock or just undocked, may press on each
/// other.
fn parts(
    tracks: &Tracks,
    bodies: &Bodies,
    meeting: &Collision,
    along: &Polyline,
    tolerances: &Tolerances,
) -> bool {
    let mut links = MeetingLinks::new(tracks, bodies, meeting, tracks.start.bonds.clone());
    let allowed = meeting.allowed + tolerances.deflected_depth;
    along.instants().any(|(time, deflected)| {
        let state = tracks.state(time);
        if links.bonds != state.bonds {
            links = MeetingLinks::new(tracks, bodies, meeting, state.bonds);
        }
        links.distance(deflected) < -allowed && !links.face(&state.joints, tolerances)
    })
}

/// The two links of a collision, with the kinematics of the robot.
struct MeetingLinks<'a> {
    tracks: &'a Tracks,
    bodies: &'a Bodies,
    /// A flag for each bond, true if it holds.
    bonds: Vec<bool>,
    kinematics: Kinematics,
    /// The links, each by its module's index in the assembly and its own in the module.
    links: [(usize, usize); 2],
    /// A buffer for the poses of all links.
    poses: Vec<Pose>,
}

impl<'a> MeetingLinks<'a> {
    /// Returns the links of a collision of the plan's robot with these bonds, a flag for each, true if it holds.
    fn new(
        tracks: &'a Tracks,
        bodies: &'a Bodies,
        meeting: &Collision,
        bonds: Vec<bool>,
    ) -> MeetingLinks<'a> {
        let kinematics = Kinematics::new(&tracks.robot, &bonds, 0);
        let links = [(meeting.modules.0, meeting.links.0), (meeting.modules.1, meeting.links.1)];
        let poses = vec![Pose::identity(); kinematics.link_count()];
        MeetingLinks { tracks, bodies, bonds, kinematics, links, poses }
    }

    /// Returns the signed distance of the links (m) with the joints at these positions (rad or m), by the number in
    /// their [`JointId`].
    fn distance(&mut self, joints: &[f64]) -> f64 {
        self.kinematics.link_poses(joints, &Pose::identity(), &mut self.poses);
        self.between(self.links[0], self.links[1])
    }

    /// Returns true if the modules have ports face to face that an open bond could join: within capture of each other
    /// with the joints at these positions, as in [`distance`](Self::distance).
    fn face(&mut self, joints: &[f64], tolerances: &Tolerances) -> bool {
        self.kinematics.link_poses(joints, &Pose::identity(), &mut self.poses);
        let (robot, [a, b]) = (&self.tracks.robot, self.links);
        let join = |bond: &Bond| [(a.0, b.0), (b.0, a.0)].contains(&(bond.a.module, bond.b.module));
        let open = (0..self.bonds.len()).filter(|&bond| !self.bonds[bond] && join(&robot.bonds[bond]));
        let residual = |bond| self.kinematics.residual(robot, bond, joints, &self.poses);
        open.map(residual).any(|residual| docking::within(robot, &residual, tolerances))
    }

    /// Returns the signed distance of two links (m) at the present poses, each given by its module's index and its own.
    fn between(&self, a: (usize, usize), b: (usize, usize)) -> f64 {
        self.bodies.signed_distance(&self.kinematics, (a, b), &self.poses, f64::MAX)
    }
}
