//! Collisions in the verdict: failures with the actions to blame.

use super::blame::{self, BLAMED_MAX};
use super::bodies::{Bodies, UnsoundLink};
use super::collision::{self, Collision, Findings};
use super::dynamics::{self, DeflectedMotion};
use super::rollout::Rollout;
use super::work_budget::work_max;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, DockingEvent, DockingKind, Failure, Status, Tracks};
use crate::robot::{JointId, Kinematics};

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
    let found = collision::planned(rollout.tracks, &bodies, rollout.settings, rollout.exemptions, precision);
    Ok(PlannedCollisions { bodies, found })
}

/// Judges the collisions of the whole plan, those that [`find`] returned: records failures with the actions to blame, the
/// clearance, and the status of the check. `deflected`: the positions of the joints as soft servos yield, which are
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
    let found = collision::deflected(tracks, bodies, rollout.settings, rollout.exemptions, along);
    for index in &found.used {
        ledger.use_exemption(*index, CheckKind::Deflection);
    }
    let meets = |c: &&Collision| {
        let deep = c.depth > c.allowed + rollout.tolerances.deflected_depth;
        deep && !c.exempt && planned.iter().all(|p| p.modules != c.modules)
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
/// greatest depth; latest first. `needed`: the function that returns the signed distance that they must then have, m, from
/// that which they have as planned.
fn blamed(
    tracks: &Tracks,
    bodies: &Bodies,
    meeting: &Collision,
    needed: impl Fn(f64) -> f64,
) -> Vec<CauseId> {
    let state = tracks.state(meeting.deepest);
    let kinematics = Kinematics::new(&tracks.robot, &state.bonds, 0);
    let links = (
        kinematics.link(meeting.modules.0, meeting.links.0),
        kinematics.link(meeting.modules.1, meeting.links.1),
    );
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let distance = |poses: &[Pose]| {
        let [a, b] = [(meeting.modules.0, meeting.links.0), (meeting.modules.1, meeting.links.1)];
        let enclosed = bodies.enclosed_depth(a, b, &(poses[links.0].inverse() * poses[links.1]));
        let apart = bodies.distance(links.0, links.1, poses, f64::MAX);
        if enclosed > 0.0 { apart.min(-enclosed) } else { apart }
    };
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    let needed = needed(distance(&poses));
    let mut blamed = vec![];
    for suspect in blame::suspects(tracks, meeting.deepest) {
        if blamed.len() == BLAMED_MAX || blamed.contains(&suspect.cause) {
            continue;
        }
        let mut joints = state.joints.clone();
        let track = tracks.track(JointId(suspect.joint as u32)).expect("a suspect moves on a track");
        joints[suspect.joint] = track.position(tracks.start.joints[suspect.joint], suspect.start);
        kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
        if distance(&poses) >= needed {
            blamed.push(suspect.cause);
        }
    }
    blamed
}
