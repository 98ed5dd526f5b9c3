//! Checks of bonds: ports are within capture when they dock, loops stay closed, and the robot stays connected.

use super::in_force::positions;
use super::rollout_input::Rollout;
use super::sample::Sample;
use super::tolerances::Tolerances;
use crate::geometry::Pose;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, DockingEvent, DockingKind, Failure, Status, TOLERANCES, Tracks};
use crate::robot::{Assembly, Bond, Capture, Kinematics, Residual};
use crate::units::{Dimension, quantity};

/// Judges every docking of a robot, that the ports are then within capture of each other, and that bonds connect all
/// modules with the base at the start; records failures and the status of both checks. Returns the
/// indices in the assembly of the bonds whose ports missed, in order of time.
pub(super) fn judge(rollout: &Rollout, ledger: &mut Ledger) -> Vec<usize> {
    let tracks = rollout.tracks;
    let mut missed = Vec::new();
    let mut bonds = tracks.start.bonds.clone();
    in_one_piece(tracks, &bonds, ledger);
    for dock in &tracks.events {
        if dock.kind == DockingKind::Dock && !near_enough(rollout, &bonds, dock, ledger) {
            missed.push(dock.bond);
        }
        bonds[dock.bond] = dock.kind == DockingKind::Dock;
    }
    ledger.check(CheckKind::Docking, Status::Proved);
    ledger.check(CheckKind::Connectedness, Status::Proved);
    missed
}

/// Records a failure if the bonds that hold at the start leave modules without connection to the base.
fn in_one_piece(tracks: &Tracks, bonds: &[bool], ledger: &mut Ledger) {
    let robot = &tracks.robot;
    let tree = Kinematics::new(robot, bonds, robot.base).tree;
    if tree.loose.is_empty() {
        return;
    }
    let at: Vec<String> = tree.loose.iter().map(|&m| robot.modules[m].name.clone()).collect();
    let message = format!("{} of {} modules hang on nothing: {}", at.len(), robot.modules.len(), listed(&at));
    ledger.fail(Failure {
        kind: CheckKind::Connectedness,
        time: 0.0,
        until: None,
        value: at.len() as f64,
        at,
        message,
        limit: 0.0,
        blame: vec![],
        blames_start: true,
    });
}

/// The greatest number of names that a message shows.
const NAMES_SHOWN: usize = 4;

fn listed(names: &[String]) -> String {
    let shown = names.iter().take(NAMES_SHOWN).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > NAMES_SHOWN { format!("{shown}, ...") } else { shown }
}

/// Returns true if the ports of a dock are within capture, or have no connection with each other; records a failure
/// otherwise. `bonds`: for each bond, true if it holds before.
fn near_enough(rollout: &Rollout, bonds: &[bool], dock: &DockingEvent, ledger: &mut Ledger) -> bool {
    let robot = &rollout.tracks.robot;
    let Bond { a, b, .. } = robot.bonds[dock.bond];
    let kinematics = Kinematics::new(robot, bonds, a.module);
    // Links that nothing connects have no relative pose: that is another failure.
    if kinematics.tree.loose.contains(&b.module) {
        return true;
    }
    let mut joints = Vec::new();
    positions(rollout, dock.time, &mut joints);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
    let residual = kinematics.residual(robot, dock.bond, &joints, &poses);
    if within(robot, &residual, rollout.tolerances) {
        return true;
    }
    let message = format!("{} does not dock: {}", robot.bond_name(dock.bond), apart(&residual));
    ledger.fail(failure(CheckKind::Docking, robot, &residual, dock.time, message, vec![dock.cause], rollout));
    false
}

/// The monitor of the loops that bonds close, during a rollout: the two ports of such a bond must stay together.
pub(super) struct Monitor<'a> {
    rollout: &'a Rollout<'a>,
    /// The bonds that did not dock: that their loops are open is reported already.
    missed: Vec<usize>,
    /// The number of samples with a loop.
    samples: usize,
    /// The failures so far: one for each bond whose loop is open.
    open: Vec<Failure>,
}

impl<'a> Monitor<'a> {
    /// Returns a monitor before the first sample; `missed`: the indices in the assembly of the bonds whose ports
    /// missed when they docked, whose loops are not reported again.
    pub(super) fn new(rollout: &'a Rollout<'a>, missed: Vec<usize>) -> Monitor<'a> {
        Monitor { rollout, missed, samples: 0, open: vec![] }
    }

    /// Takes a sample, in order of time: each bond that closes a loop whose ports are farther apart than its
    /// connector tolerates fails, once.
    pub(super) fn observe(&mut self, sample: &Sample) {
        if sample.model.kinematics.tree.closing.is_empty() {
            return;
        }
        self.samples += 1;
        if !sample.moved && sample.time > sample.before {
            return;
        }
        for residual in residuals(sample) {
            let fits = within(sample.model.robot, &residual, self.rollout.tolerances);
            if fits || self.missed.iter().any(|&missed| on_loop(sample, residual.bond, missed)) {
                continue;
            }
            let name = sample.model.robot.bond_name(residual.bond);
            match self.open.iter_mut().find(|f| f.at[0] == name) {
                Some(failure) => failure.until = Some(sample.time),
                None => {
                    let message = format!("{name} is driven apart: {}", apart(&residual));
                    let robot = sample.model.robot;
                    let kind = CheckKind::Closure;
                    let found = failure(kind, robot, &residual, sample.time, message, vec![], self.rollout);
                    self.open.push(found);
                }
            }
        }
    }

    /// Records the failures of open loops, and the status of the check of closure, which is proved if there were no
    /// loops.
    pub(super) fn finish(self, ledger: &mut Ledger) {
        self.open.into_iter().for_each(|failure| ledger.fail(failure));
        let status = if self.samples == 0 { Status::Proved } else { Status::Sampled(self.samples) };
        ledger.check(CheckKind::Closure, status);
    }
}

/// Returns true if a bond is part of the loop that another closes.
fn on_loop(sample: &Sample, closing: usize, bond: usize) -> bool {
    let (robot, kinematics) = (sample.model.robot, &sample.model.kinematics);
    let ends = |bond: usize| {
        let Bond { a, b, .. } = robot.bonds[bond];
        [a, b].map(|port| kinematics.port_link(robot, port))
    };
    let [from, to] = ends(closing);
    let path = kinematics.path(from, to).unwrap_or_default();
    bond == closing || ends(bond).iter().all(|link| path.contains(link))
}

/// Returns true if the bond of this name closes a loop in a sample and its ports are farther apart than is tolerated.
pub(super) fn is_open(sample: &Sample, name: &str, tolerances: &Tolerances) -> bool {
    residuals(sample)
        .iter()
        .any(|r| sample.model.robot.bond_name(r.bond) == name && !within(sample.model.robot, r, tolerances))
}

/// Returns the residuals of the bonds that close loops in a sample.
fn residuals(sample: &Sample) -> Vec<Residual> {
    let kinematics = &sample.model.kinematics;
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(sample.joints, &Pose::identity(), &mut poses);
    kinematics.residuals(sample.model.robot, sample.joints, &poses)
}

/// Returns true if a residual is within the error that its bond tolerates.
pub(super) fn within(robot: &Assembly, residual: &Residual, tolerances: &Tolerances) -> bool {
    let error = tolerated(robot, residual.bond, tolerances);
    residual.distance <= error.distance && residual.angle <= error.angle
}

/// Returns the greatest distance (m) and angle (rad) between the two ports of a bond, given by its index, with which
/// it docks and holds: the capture that the connector of its port `a` states, or else the tolerances for loops.
pub(super) fn tolerated(robot: &Assembly, bond: usize, tolerances: &Tolerances) -> Capture {
    let capture = robot.connector(robot.bonds[bond].a).capture;
    capture.unwrap_or(Capture::at_rest(tolerances.closure_distance, tolerances.closure_angle))
}

/// Returns the distance and the angle between two ports, in words.
pub(super) fn apart(residual: &Residual) -> String {
    let seen = |value: f64| if value < TOLERANCES.reported_zero { 0.0 } else { value };
    let distance = quantity(seen(residual.distance), Dimension::LENGTH);
    format!("the ports are {distance} and {} apart", quantity(seen(residual.angle), Dimension::ANGLE))
}

/// Returns the failure of a check of a bond, whose ports are as far apart as `residual` says, in the words of `message`.
pub(super) fn failure(
    kind: CheckKind,
    robot: &Assembly,
    residual: &Residual,
    time: f64,
    message: String,
    blame: Vec<CauseId>,
    rollout: &Rollout,
) -> Failure {
    let limit = tolerated(robot, residual.bond, rollout.tolerances).distance;
    Failure {
        kind,
        time,
        until: None,
        at: vec![robot.bond_name(residual.bond)],
        message,
        value: residual.distance,
        limit,
        blame,
        blames_start: false,
    }
}
