//! Slip of links while little of the robot rests on the ground: where it goes is then the least certain.

use super::super::sample::Sample;
use super::tolerances::PARAMETERS;

/// The slip of links over the samples at which less than the part [`rest_share`](super::tolerances::Parameters::rest_share)
/// of the weight is on links that rest: that neither slide nor turn or slide on their own joints, as wheels do. Links that
/// rest hold the robot in place; where all that bears slides or rolls, a small force takes it anywhere.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct UnrestedSlip {
    /// The slip of each link, by its number, m.
    slips: Vec<f64>,
    /// The slip of each link while it bore next to nothing, however much rested, m.
    idle: Vec<f64>,
    /// The positions of the joints at the sample before, rad or m.
    before: Vec<f64>,
    /// The greatest distance (m) over which a link of the last sample would slide on until friction stops it, with its speed
    /// (m/s); zeros where enough of the robot rests.
    slide: (f64, f64),
}

impl UnrestedSlip {
    /// Adds the slip of a sample; samples come in order of time.
    pub(in super::super) fn observe(&mut self, sample: &Sample) {
        let before = std::mem::replace(&mut self.before, sample.joints.to_vec());
        self.slide = (0.0, 0.0);
        let span = sample.time - sample.before;
        self.idle.resize(sample.model.bodies.len(), 0.0);
        for &(link, slip, _) in sample.slips.iter().filter(|(_, _, load)| *load <= PARAMETERS.bearing_min) {
            self.idle[link] += slip;
        }
        let borne: f64 = sample.slips.iter().map(|(_, _, load)| load).sum();
        if span <= 0.0 || borne <= 0.0 || before.len() != sample.joints.len() {
            return;
        }
        let moves = |link: usize| {
            let Some(step) = sample.model.kinematics.step(link) else { return false };
            let terms = step.terms().iter();
            let change: f64 =
                terms.map(|(joint, factor)| factor * (sample.joints[*joint] - before[*joint])).sum();
            change.abs() > PARAMETERS.rolling_speed * span
        };
        let rests =
            |(link, slip, _): &&(usize, f64, f64)| *slip <= PARAMETERS.sliding_speed * span && !moves(*link);
        let resting: f64 = sample.slips.iter().filter(rests).map(|(_, _, load)| load).sum();
        if resting >= PARAMETERS.rest_share * borne {
            return;
        }
        self.slips.resize(sample.model.bodies.len(), 0.0);
        for &(link, slip, _) in sample.slips.iter().filter(|(_, _, load)| *load > PARAMETERS.bearing_min) {
            self.slips[link] += slip;
            let speed = slip / span;
            let friction = sample.world.friction * sample.model.bodies[link].friction;
            let distance = speed * speed / (2.0 * friction * sample.world.gravity);
            if distance > self.slide.0 {
                self.slide = (distance, speed);
            }
        }
    }

    /// Returns the speed (m/s) at which the robot slides as the rollout ends, if it then slides on by more than the least
    /// tolerance of travel.
    pub(super) fn slides_on(&self) -> Option<f64> {
        let (distance, speed) = self.slide;
        (distance > PARAMETERS.travel_tolerance_min).then_some(speed)
    }

    /// Returns the greatest slip of a link, m.
    pub(super) fn greatest(&self) -> f64 {
        self.slips.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the greatest distance over which a link slid on the ground, or just above it, while it bore next to nothing, m.
    pub(super) fn idle(&self) -> f64 {
        self.idle.iter().copied().fold(0.0, f64::max)
    }
}
