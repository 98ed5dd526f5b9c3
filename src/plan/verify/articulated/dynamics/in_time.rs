//! Travel in time: a robot whose contacts scrub is played by rigid bodies, whose loads are in motion.
//!
//! Loads that swing decide within some 30 ms of a touch-down which of two feet slides; the travel of a rollout is found with
//! loads at rest. So where contacts slide so far that the travel would not be known within a tenth of it, or 5 mm,
//! it is that of [`forward_dynamics`](crate::plan::forward_dynamics), for servos as stiff as stated, softer and stiffer:
//! the middle of the two ends that are farthest apart.

use super::super::rollout_input::Rollout;
use super::tolerances::PARAMETERS;
use super::unrested::UnrestedSlip;
use crate::geometry::{Pose, Vec3};
use crate::interrupt;
use crate::plan::forward_dynamics::{
    Couplings, GroundContacts, LinkContacts, Model, PARAMETERS as TIMED, Planned, ServoGains, Settings,
    Stepper,
};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Exemption, ExemptionKind, Failure, Ground, Tracks, Verdict, World};
use crate::units::{Dimension, number, quantity};

/// The motion of a robot in time.
#[derive(Clone, Copy, Debug)]
struct TimedMotion {
    /// The factor on the stiffness of its servos.
    stiffness: f64,
    /// The displacement of the base over the ground in the world, x and y, m, and its turn, whole turns counted, rad.
    travel: Vec3,
    /// The time at which its centre of mass sinks so fast that it falls, s; `None`: it does not.
    falls: Option<f64>,
}

impl TimedMotion {
    /// Returns the distance over the ground between the ends of two motions, m.
    fn away(&self, other: &TimedMotion) -> f64 {
        (self.travel - other.travel).xy().norm()
    }

    /// Returns the factor on the stiffness in words: `servos 0.4 times as stiff`.
    fn servos(&self) -> String {
        format!("servos {} times as stiff", number(self.stiffness))
    }
}

/// Returns the distance within which the travel of a verdict is taken to be certain: a part of it, or a length, m.
fn certain(verdict: &Verdict) -> f64 {
    let [x, y, _] = verdict.travel;
    PARAMETERS.travel_tolerance_min.max(PARAMETERS.travel_share * libm::hypot(x, y))
}

/// Judges the travel of a robot that was rolled out on the ground, and writes it anew where its contacts scrub. Returns a
/// note that says within what distance it is known; `None` where nothing stands on the ground. `start`: the world pose of the
/// base as the plan begins; `unrested`: the slip while little of the robot rests.
pub(in super::super) fn judge_travel(
    rollout: &Rollout,
    start: &Pose,
    unrested: &UnrestedSlip,
    ledger: &mut Ledger,
) -> Option<String> {
    let slip = ledger.verdict.slip.as_ref()?.value;
    let scrubs = PARAMETERS.slip_share * slip > certain(&ledger.verdict);
    match scrubs.then(|| motions(rollout, start, ledger)).flatten() {
        Some(motions) => Some(state(&motions, unrested.greatest(), rollout.exemptions, ledger)),
        None => Some(travel_tolerance(&ledger.verdict)),
    }
}

/// Returns a note that says within what distance the travel of a verdict is known without motion in time, as simulations of
/// random gaits showed it.
pub(in super::super) fn travel_tolerance(verdict: &Verdict) -> String {
    let slip = verdict.slip.as_ref().map_or(0.0, |worst| worst.value);
    let within = certain(verdict).max(PARAMETERS.slip_share * slip);
    format!(
        "the travel is known within {}: a tenth of it, 5mm or a fifth of the slip, whichever is most",
        rounded_up(within)
    )
}

/// Plays the robot of a rollout with all three kinds of servos; `None` where its motion is not that of one robot from the
/// beginning to the end of a plan on level ground, something has failed, or it would take too long.
fn motions(rollout: &Rollout, start: &Pose, ledger: &Ledger) -> Option<[TimedMotion; 3]> {
    let tracks = rollout.tracks;
    let [world] = rollout.worlds else { return None };
    let world = &world.world;
    let alone = tracks.events.is_empty()
        && tracks.start.clusters.is_empty()
        && tracks.obstacles.is_empty()
        && rollout.begin.is_none();
    let stands = world.ground == Ground::Settle && world.gravity > 0.0 && !world.is_sloped();
    // Nothing is told of what follows a tip.
    let open = [ExemptionKind::Unstable, ExemptionKind::Balance];
    let excused = rollout.exemptions.iter().any(|exemption| open.contains(&exemption.kind));
    if !alone || !stands || excused || !ledger.verdict.failures.is_empty() {
        return None;
    }
    let factors = [1.0, PARAMETERS.servo_softer, PARAMETERS.servo_stiffer];
    let played = |factor: f64| motion(tracks, start, world, factor);
    let (first, (second, third)) =
        interrupt::join(|| played(factors[0]), || (played(factors[1]), played(factors[2])));
    Some([first?, second?, third?])
}

/// Plays a robot with servos whose stiffness has a factor: as in a simulation, it stands before it begins and after it has
/// ended. `None` where it can't be played, or would take more than the greatest number of steps. Bonds do not break here.
fn motion(tracks: &Tracks, start: &Pose, world: &World, stiffness: f64) -> Option<TimedMotion> {
    let step = PARAMETERS.timed_step;
    let servo = ServoGains { factor: stiffness, ..ServoGains::default() };
    let settings = Settings { step, servo, ..Settings::default() };
    let model = Model::new(tracks, (start, &[]), world, &settings, &[]);
    let steps = |time: f64| libm::ceil(time / step - PARAMETERS.timed_count);
    let (first, last) = (-steps(TIMED.settle), steps(tracks.duration + TIMED.rest));
    if (last - first) * model.bodies.len() as f64 > PARAMETERS.timed_steps_max {
        return None;
    }
    let links = LinkContacts::new(&model, &tracks.robot, &[]).ok()?;
    let couplings = Couplings::new(&model, &tracks.robot, &tracks.start.bonds, Some(links));
    let ground = GroundContacts::new(&model, None, step);
    let mut stepper =
        Stepper::new(&model, couplings, &tracks.start.joints, world.gravity, Some(ground), step);
    let mut planned = Planned::new(tracks);
    let mut commands: Vec<(f64, f64)> = tracks.start.joints.iter().map(|joint| (*joint, 0.0)).collect();
    let (mut begun, mut base) = (*start, *start);
    let (mut turn, mut falls, mut height) = (0.0, None, f64::NEG_INFINITY);
    for number in first as i64..last as i64 {
        interrupt::checkpoint();
        let time = number as f64 * step;
        planned.advance(time + step, &mut commands);
        stepper.take(&commands, time).ok()?;
        let now = *stepper.base(0);
        let sinks = height - stepper.centre_height() > PARAMETERS.timed_fall * step;
        height = stepper.centre_height();
        if number < 0 {
            (begun, base) = (now, now);
            continue;
        }
        if sinks && falls.is_none() {
            falls = Some(time);
        }
        let x = (now.rotation * base.rotation.inverse()) * Vec3::x();
        turn += libm::atan2(x.y, x.x);
        base = now;
    }
    let shift = base.translation.vector - begun.translation.vector;
    Some(TimedMotion { stiffness, travel: Vec3::new(shift.x, shift.y, turn), falls })
}

/// Writes the travel and the turn of motions in time into the verdict, fails where they fall or end too far from each other,
/// and returns the note on them. The first has servos as stiff as stated. `unrested`: the slip while little of the robot
/// rests, m. An exemption `allows traction` anywhere in the plan excuses ends that are far from each other.
fn state(motions: &[TimedMotion; 3], unrested: f64, exemptions: &[Exemption], ledger: &mut Ledger) -> String {
    if let Some((motion, time)) = motions.iter().find_map(|motion| Some((motion, motion.falls?))) {
        ledger.fail_checked(Failure {
            kind: CheckKind::Balance,
            time,
            until: None,
            at: vec![],
            message: format!(
                "in motion, with {}, the robot falls at {}",
                motion.servos(),
                quantity(time, Dimension::TIME)
            ),
            value: PARAMETERS.timed_fall,
            limit: PARAMETERS.timed_fall,
            blame: vec![],
            blames_start: false,
        });
    }
    let stated = &motions[0];
    let farthest =
        if stated.away(&motions[2]) > stated.away(&motions[1]) { &motions[2] } else { &motions[1] };
    let (away, length) = (stated.away(farthest), stated.travel.xy().norm());
    if away > PARAMETERS.travel_undetermined_min && away > PARAMETERS.travel_undetermined * length {
        let of_traction = |(_, exemption): &(usize, &Exemption)| exemption.kind == ExemptionKind::Traction;
        let allowed: Vec<usize> =
            exemptions.iter().enumerate().filter(of_traction).map(|(index, _)| index).collect();
        allowed.iter().for_each(|&index| ledger.use_exemption(index, CheckKind::Traction));
        if allowed.is_empty() {
            ledger.fail_checked(undetermined(length, away, farthest, ledger.verdict.duration));
        }
    }
    let pairs = [(0, 1), (0, 2), (1, 2)].map(|(a, b)| (&motions[a], &motions[b]));
    let apart = |(a, b): &(&TimedMotion, &TimedMotion)| a.away(b);
    let [first, rest @ ..] = pairs;
    let (a, b) =
        rest.into_iter().fold(first, |most, pair| if apart(&pair) > apart(&most) { pair } else { most });
    let turns = motions.map(|motion| motion.travel.z);
    let (least, most) = turns.iter().fold((turns[0], turns[0]), |(l, m), turn| (l.min(*turn), m.max(*turn)));
    let middle = (a.travel + b.travel) / 2.0;
    let verdict = &mut ledger.verdict;
    (verdict.travel[0], verdict.travel[1], verdict.heading) = (middle.x, middle.y, (least + most) / 2.0);
    let apart = a.away(b);
    let spread = PARAMETERS.timed_spread * apart / 2.0 + PARAMETERS.timed_error;
    let within = certain(verdict).max(spread).max(PARAMETERS.slip_share * unrested);
    let factors = [PARAMETERS.servo_softer, 1.0, PARAMETERS.servo_stiffer].map(number);
    format!(
        "contacts scrub: the travel is the middle of motions in time with servos {}, {} and {} times as stiff, {} apart, and \
         known within {}",
        factors[0],
        factors[1],
        factors[2],
        rounded_up(apart),
        rounded_up(within)
    )
}

/// Returns the failure of a travel that servos do not determine: its length (m), and the distance of its end (m) from that of
/// the motion that ends farthest from it. `duration`: that of the plan, s.
fn undetermined(length: f64, away: f64, farthest: &TimedMotion, duration: f64) -> Failure {
    Failure {
        kind: CheckKind::Traction,
        time: 0.0,
        until: Some(duration),
        at: vec![],
        message: format!(
            "the travel is not determined: {} in motion, but {} elsewhere with {}",
            quantity(length, Dimension::LENGTH),
            quantity(away, Dimension::LENGTH),
            farthest.servos()
        ),
        value: away,
        limit: PARAMETERS.travel_undetermined * length,
        blame: vec![],
        blames_start: false,
    }
}

/// Returns a length (m) in whole millimetres, rounded up, in words.
fn rounded_up(length: f64) -> String {
    quantity(libm::ceil(length * 1e3) / 1e3, Dimension::LENGTH)
}
