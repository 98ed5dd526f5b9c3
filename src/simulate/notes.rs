//! Notes on a simulation: what half the step changes, where the verdict on the plan says otherwise, and what happens in
//! further runs.

use super::{Factors, FailureCounts, Run, Settings, Simulation, Spread};
use crate::plan::forward_dynamics::Planned;
use crate::plan::{Plan, Verdict};
use crate::units::{Dimension, fixed, quantity, rounded};
use std::f64::consts::FRAC_PI_4;

/// The travel or turn, as a part of it, by which a verdict and a simulation may differ before that is noted.
const NOTED_SHARE: f64 = 0.1;
/// The difference of their travels up to which none is noted, m.
const NOTED_LENGTH: f64 = 5e-3;
/// The difference of their turns up to which none is noted, rad: 3°.
const NOTED_TURN: f64 = std::f64::consts::PI / 60.0;
/// The lag of a joint from which on it is noted, rad: 10°.
const NOTED_LAG: f64 = std::f64::consts::PI / 18.0;
/// The time over which an acceleration of the plan is a mean, s.
const ACCELERATION_STEP: f64 = 5e-3;

/// A plan that was played, with what is known of it besides.
#[derive(Clone, Copy, Debug)]
pub struct Played<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The settings that it was played with.
    pub settings: &'a Settings,
    /// The result.
    pub outcome: &'a Simulation,
    /// The change that half the step makes, in words.
    pub halving: &'a str,
    /// The verdict on the plan, where it is about what was played.
    pub verdict: Option<&'a Verdict>,
    /// The spread of further runs, and those runs; there may be none.
    pub runs: (&'a Spread, &'a [Run]),
}

/// Returns true if a verdict on a plan is about what is played with these settings: it knows no program that senses, and no
/// friction, servos, ground and obstacles but its own.
pub fn is_judged(plan: &Plan, settings: &Settings) -> bool {
    !plan.nominal && *settings == Settings { step: settings.step, ..Settings::default() }
}

impl Played<'_> {
    /// Returns what is worth saying beside the numbers.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![self.halving.to_owned()];
        let mut note = |said: bool, words: &str| notes.extend(said.then(|| words.to_owned()));
        let executed = self.plan.program.is_some();
        note(
            self.plan.nominal && executed,
            "its program was executed with sensors: the plan is what happens if nothing disturbs it",
        );
        note(
            self.plan.nominal && !executed,
            "the plan holds no program, so that its conditions are as planned",
        );
        note(
            self.settings.terrain.is_some(),
            "the plan is made for level ground, and no verdict is on this one",
        );
        note(
            !self.settings.obstacles.is_empty(),
            "the plan knows no obstacles, and no verdict is about them",
        );
        let (spread, runs) = self.runs;
        let varies = *spread != Spread::default();
        note(varies && runs.is_empty(), "without `runs` nothing is drawn from a spread");
        note(!varies && runs.len() > 1, "without a spread all runs are alike");
        notes.extend(self.verdict.and_then(|verdict| disagreement(self.outcome, verdict)));
        notes.extend(heavy_rotor(self.plan, self.outcome));
        notes.extend(summary(self.outcome, spread, runs));
        notes
    }
}

/// Returns, in words, that the rotor which is assumed of the joint that lags most is too heavy for its motor as the plan
/// accelerates it; `None` where nothing lags, or that is not why.
fn heavy_rotor(plan: &Plan, outcome: &Simulation) -> Option<String> {
    let lag = outcome.lag.filter(|lag| lag.value > NOTED_LAG)?;
    let tracks = plan.body.tracks()?;
    let robot = &tracks.robot;
    let owner = robot.joints().nth(lag.of)?;
    let servo = robot.servo(owner);
    let limit = robot.effort_limit(owner).filter(|_| servo.armature.is_none())?;
    let rotor = servo.armature_with(robot.servo_stiffness(owner));
    let mut planned = Planned::new(tracks);
    let mut joints: Vec<(f64, f64)> = tracks.start.joints.iter().map(|joint| (*joint, 0.0)).collect();
    let (mut before, mut greatest) = (0.0, 0.0_f64);
    for number in 0..=libm::ceil(tracks.duration / ACCELERATION_STEP) as u64 {
        planned.advance(number as f64 * ACCELERATION_STEP, &mut joints);
        let rate = joints[lag.of].1;
        greatest = greatest.max((rate - before).abs() / ACCELERATION_STEP);
        before = rate;
    }
    let needed = rotor * greatest;
    (needed > limit).then(|| {
        format!(
            "the rotor that is assumed of `{}`, {}kg*m^2 for its stiffness, takes {}N*m to accelerate as planned, and the motor has {}: \
             state `armature`",
            robot.joint_name(owner),
            rounded(rotor, 4),
            rounded(needed, 1),
            quantity(limit, Dimension::TORQUE)
        )
    })
}

/// Returns where a verdict and a simulation disagree, in words; `None` where they agree.
fn disagreement(outcome: &Simulation, verdict: &Verdict) -> Option<String> {
    if !verdict.ok() {
        return Some("the verdict on the plan is that it fails".to_owned());
    }
    let [x, y, _] = verdict.travel;
    let off = libm::hypot(outcome.travel.x - x, outcome.travel.y - y);
    let way = libm::hypot(x, y);
    let turned_off = (outcome.heading - verdict.heading).abs();
    let mut words = Vec::new();
    let mut note = |differs: bool, said: &dyn Fn() -> String| words.extend(differs.then(said));
    note(outcome.fall.is_some(), &|| "it does not fall".to_owned());
    note(outcome.breaks(), &|| "its bonds hold".to_owned());
    note(outcome.misses(), &|| "its ports dock".to_owned());
    note(off > (NOTED_SHARE * way).max(NOTED_LENGTH), &|| {
        format!("it travels {}", quantity(way, Dimension::LENGTH))
    });
    // Of a base that has rolled over, the judge adds up what it turns, and a simulation compares its ends.
    let upright = outcome.lean_max < FRAC_PI_4;
    note(upright && turned_off > (NOTED_SHARE * verdict.heading.abs()).max(NOTED_TURN), &|| {
        let tenths = libm::round(verdict.heading.to_degrees() * 10.0) / 10.0;
        format!("it turns by {}deg", fixed(tenths + 0.0, 1))
    });
    note(outcome.lag.is_some_and(|lag| lag.value > NOTED_LAG), &|| "its joints follow".to_owned());
    (!words.is_empty()).then(|| format!("the verdict on the plan says otherwise: {}", words.join(", ")))
}

/// Returns how many of the further runs fail, in what way, and the mildest of them, in words; `None` without such runs.
fn summary(outcome: &Simulation, spread: &Spread, runs: &[Run]) -> Option<String> {
    if runs.is_empty() {
        return None;
    }
    let failing = runs.iter().filter(|run| run.outcome.fails());
    let Some(first) = failing.min_by(|a, b| spread.size(&a.factors).total_cmp(&spread.size(&b.factors)))
    else {
        return Some(format!("none of {} runs fails", runs.len()));
    };
    let Factors { friction, mass, effort, stiffness, .. } = first.factors;
    let varied = spread.parts().into_iter().zip([friction, mass, effort, stiffness]);
    let varied = varied.filter(|((_, spread), _)| *spread > 0.0);
    let named: Vec<String> =
        varied.map(|((name, _), factor)| format!("{name} x {}", fixed(factor, 2))).collect();
    // Errors of zeros are many numbers in a run, none of which is its size. No run is the first one that
    // fails where the plan fails as it is.
    let first = match (outcome.fails(), named.is_empty()) {
        (true, _) => ", as it does as planned".to_owned(),
        (false, true) => String::new(),
        (false, false) => format!(", first at {}", named.join(", ")),
    };
    let counts = FailureCounts::of(runs);
    let ways = [
        (counts.falls, "with a fall"),
        (counts.breaks, "with a bond that breaks"),
        (counts.misses, "with ports that do not dock"),
        (counts.stops, "with a program that is stopped"),
    ];
    let ways: Vec<String> =
        ways.iter().filter(|(n, _)| *n > 0).map(|(n, way)| format!("{n} {way}")).collect();
    Some(format!("{} of {} runs fail{first}: {}", counts.fails, runs.len(), ways.join(", ")))
}
