//! The attitudes of the robot along a rollout, at whose instants loads are determined.

use super::super::sample::Sample;
use super::tolerances::PARAMETERS;
use super::traction::TravelSummary;
use crate::geometry::Mat3;
use crate::plan::World;

/// The attitude of the robot at an instant of a rollout, as settling found it.
#[derive(Clone, Copy)]
pub(in super::super) struct Recorded {
    /// The time of the instant, s.
    pub time: f64,
    /// The orientation of the base in level axes.
    pub R: Mat3,
    /// The heading of the level axes in the world, rad.
    pub yaw: f64,
    /// The index of its bonds in [`Recorder::bonds`].
    pub bonds: usize,
    /// The world just after the instant.
    pub world: World,
    /// True if the robot tips over at the instant, or since the one before.
    pub tips: bool,
}

/// The attitudes of a rollout, recorded sample by sample: no two nearer in time than `spacing_least` of
/// [`PARAMETERS`], but where bonds or the world change.
#[derive(Default)]
pub(in super::super) struct Recorder {
    /// The attitudes, in order of time.
    pub recorded: Vec<Recorded>,
    /// The sets of bonds that held: a flag for each bond, true if it did.
    pub bonds: Vec<Vec<bool>>,
    /// The travel up to the last sample.
    pub travel: TravelSummary,
    /// True if the robot has tipped over since the last attitude that was recorded.
    tips: bool,
}

impl Recorder {
    /// Records the attitude of a sample, unless it is near the last one recorded, and its travel; samples come in
    /// order of time.
    pub(in super::super) fn observe(&mut self, sample: &Sample) {
        self.travel.clone_from(&sample.travel);
        self.tips |= sample.tip.is_some();
        let known = self.bonds.iter().position(|bonds| bonds == sample.bonds);
        let bonds = known.unwrap_or_else(|| {
            self.bonds.push(sample.bonds.to_vec());
            self.bonds.len() - 1
        });
        let near = |last: &Recorded| {
            sample.time - last.time < PARAMETERS.spacing_least
                && last.bonds == bonds
                && last.world == *sample.world
        };
        if !self.recorded.last().is_some_and(near) {
            self.recorded.push(Recorded {
                time: sample.time,
                R: sample.stance.R,
                yaw: sample.stance.planar_pose.yaw,
                bonds,
                world: *sample.world,
                tips: std::mem::take(&mut self.tips),
            });
        }
    }
}

/// Returns the recorded attitudes, in order of time, with further instants at those of `times` (s, ascending) that
/// lie between two of them; such an instant has the attitude of the one before it.
pub(super) fn with_instants(recorded: Vec<Recorded>, times: &[f64]) -> Vec<Recorded> {
    let mut all: Vec<Recorded> = Vec::with_capacity(recorded.len() + times.len());
    let mut times = times.iter().copied().peekable();
    for instant in recorded {
        while let Some(time) = times.next_if(|time| *time < instant.time) {
            if let Some(last) = all.last().filter(|last| last.time < time) {
                let between = Recorded { time, tips: false, ..*last };
                all.push(between);
            }
        }
        all.push(instant);
    }
    all
}
