//! The judgement of one robot, whole or come off another: the checks from sample to sample, the collisions, and the blame.

use super::base_path::BasePath;
use super::decimated::Decimated;
use super::model::Model;
use super::rollout::{Checkpoint, RolloutEnd, roll_out};
use super::rollout_input::Rollout;
use super::{
    base_motion, blame, collision_report, docking, dynamics, fixed_base, sampling, slope, stability, torque,
};
use crate::interrupt;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{Failure, Settings};
use crate::units::{Dimension, quantity};

/// Judges a robot from sample to sample and its collisions, and finds the actions to blame. `missed`: the indices in the
/// assembly of the bonds whose ports missed when they docked. `path` takes the path of the base; `None` where nobody
/// needs it.
pub(super) fn judge(rollout: &Rollout, missed: Vec<usize>, ledger: &mut Ledger, path: Option<&mut BasePath>) {
    let samples = sampling::count(&rollout.instants(), rollout.tracks, rollout.settings, rollout.tolerances);
    let features = ground_features_of(rollout, samples);
    if samples > sampling::samples_max(rollout.settings, features) {
        ledger.fail(too_many_samples(samples, rollout.settings, features));
        return;
    }
    // The relative poses of links do not depend on the ground.
    let ((checkpoints, deflected), collisions) =
        interrupt::join(|| check_samples(rollout, missed, path, ledger), || collision_report::find(rollout));
    collision_report::judge(rollout, collisions, deflected, ledger);
    if rollout.is_full() {
        ledger.drop_consequences();
    }
    blame::blame(rollout, &checkpoints, ledger.failures_mut());
}

/// Returns the number of features of the robot of a rollout that can touch the ground; 0 where there is no ground, or
/// where the samples are so few that it need not be known beforehand.
fn ground_features_of(rollout: &Rollout, samples: usize) -> usize {
    let tracks = rollout.tracks;
    let few = samples.saturating_mul(tracks.robot.modules.len()) <= rollout.settings.samples_max;
    if few || !rollout.worlds.iter().any(|from| from.world.has_floor()) {
        return 0;
    }
    Model::new(&tracks.robot, &tracks.start.bonds).features.len()
}

/// The greatest number of checkpoints that are kept for rolling out parts of the plan again.
const CHECKPOINTS_MAX: usize = 16;

/// Makes all checks that are made from sample to sample. Returns checkpoints to roll out from, and, under full
/// dynamics, the positions of the joints as servos yield.
fn check_samples(
    rollout: &Rollout,
    missed: Vec<usize>,
    mut path: Option<&mut BasePath>,
    ledger: &mut Ledger,
) -> (Vec<Checkpoint>, Option<dynamics::DeflectedMotion>) {
    let mut loops = docking::Monitor::new(rollout, missed);
    let mut checkpoints = Decimated::new(CHECKPOINTS_MAX);
    let mut standing = stability::Monitor::new(rollout.settings, rollout.tolerances);
    let mut base_motion = base_motion::Monitor::new(rollout.settings, rollout.tolerances);
    let mut torque = torque::Monitor::new(rollout.tolerances);
    let mut slope = slope::Monitor::new(rollout.tolerances);
    let full = rollout.is_full();
    let mut recorder = dynamics::Recorder::default();
    let mut unrested = dynamics::UnrestedSlip::default();
    // One robot of several, whose path others need, is not played by itself.
    let mut placed = path.is_none().then(dynamics::PlacedBase::default);
    let ended = roll_out(*rollout, None, rollout.tracks.duration, &mut |sample, checkpoint| {
        if checkpoints.next_is_kept() {
            checkpoints.keep(checkpoint());
        }
        if let Some(path) = &mut path {
            path.observe(sample);
        }
        loops.observe(sample);
        if let Some(loss) = standing.observe(sample, ledger) {
            ledger.fail(loss.failure(rollout.subject));
        }
        base_motion.observe(sample, ledger);
        slope.observe(sample, ledger);
        if full {
            recorder.observe(sample);
            unrested.observe(sample);
            if let Some(placed) = &mut placed {
                placed.observe(sample);
            }
        } else {
            torque.observe(sample, ledger);
        }
        true
    });
    if let Some(loss) = standing.end(rollout.tracks.duration) {
        ledger.fail(loss.failure(rollout.subject));
    }
    if let RolloutEnd::Limit { time, features } = ended {
        ledger.fail(limit_reached(rollout.settings, features, time));
    }
    ledger.verdict.samples = checkpoints.seen();
    let (mut deflected, mut imbalance) = (None, None);
    if full {
        let (motion, found) = dynamics::RolloutLoads::judge(rollout, recorder, slope.free(), ledger);
        (deflected, imbalance) = (Some(motion), Some(found));
    } else {
        torque.between(&fixed_base::prove(rollout), rollout);
        torque.overloaded().iter().for_each(|over| ledger.fail(over.failure()));
        torque.finish(ledger);
    }
    slope.finish(full, ledger);
    standing.finish(ledger);
    let names = |link| rollout.tracks.robot.link_name(link);
    base_motion.finish(names, ledger);
    if let Some(imbalance) = imbalance {
        dynamics::judge_in_time(rollout, placed.as_ref(), &unrested, imbalance, ledger);
    }
    loops.finish(ledger);
    (checkpoints.into_kept(), deflected)
}

/// Returns in words why a large robot may take fewer samples than the settings allow; nothing of a small one.
fn counted(settings: &Settings, features: usize) -> String {
    let most = settings.samples_max;
    if sampling::samples_max(settings, features) == most {
        return String::new();
    }
    format!(" of a robot with {features} corners and rims that can touch the ground ({most} of a small one)")
}

fn limit_reached(settings: &Settings, features: usize, time: f64) -> Failure {
    let reached = quantity(time, Dimension::TIME);
    let most = sampling::samples_max(settings, features);
    let counted = counted(settings, features);
    let message =
        format!("the judge took {most} samples, the most allowed{counted}, and got to {reached} only");
    Failure { time, value: most as f64, limit: most as f64, ..Failure::form(message) }
}

fn too_many_samples(samples: usize, settings: &Settings, features: usize) -> Failure {
    let (most, counted) = (sampling::samples_max(settings, features), counted(settings, features));
    let message = format!(
        "at the stated time between samples the plan needs {samples} of them, and {most} are allowed{counted}"
    );
    Failure { value: samples as f64, limit: most as f64, ..Failure::form(message) }
}
