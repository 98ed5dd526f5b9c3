//! Travel in time: a robot whose contacts scrub is played by rigid bodies, whose loads are in motion.
//!
//! Loads that swing decide within some 30 ms of a touch-down which of two feet slides; the travel of a rollout is found with
//! loads at rest. So where contacts slide so far that the travel would not be known within a tenth of it, or 5 mm,
//! it is that of [`forward_dynamics`](crate::plan::forward_dynamics), for servos as stiff as stated, softer, and stiffer on
//! stiffer ground: the middle of the two ends that are farthest apart. So it is where what bears nothing would slide so far if
//! it did bear: wheels a tenth of a millimetre above the ground touch it or not as servos and contacts yield. A robot on softer
//! servos may bounce while so little rests that what slides takes it along: one more motion has stiff ground with little
//! damping. More than three links share the weight of a robot as their surfaces and joints happen to be, by tenths of a
//! millimetre: other motions, in which every second module has stiffer contacts, tell if the travel depends on that.
//!
//! Feet that rough ground holds against each other bend soft servos, and turn the robot: on ground rougher than that on which
//! rollouts were compared with simulations the travel is that in time, too.
//!
//! Loads that the ground balances only once a robot leans may make it lean far, or little before they pass: the motions in time tell
//! that, too; and whether a robot that nothing balances for a moment falls. They tell the travel of a robot that
//! tips, and may, as well: at rest at every instant it rolls over its edge without the impact that ends the fall.

use super::super::rollout_input::Rollout;
use super::super::sample::Sample;
use super::balance::Imbalance;
use super::tolerances::PARAMETERS;
use super::unrested::UnrestedSlip;
use crate::geometry::pose::turn_about_vertical;
use crate::geometry::{Pose, Vec3};
use crate::interrupt;
use crate::plan::forward_dynamics::{
    Couplings, GroundContacts, LinkContacts, Model, PARAMETERS as TIMED, Planned, ServoGains, Settings,
    Stepper,
};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Exemption, ExemptionKind, Failure, Ground, Tracks, Verdict, World};
use crate::robot::{Bond, Kinematics};
use crate::units::{Dimension, number, quantity, rounded_up};

/// The circumstances of a motion in time: the stiffness of servos and contacts, and the damping of these.
#[derive(Clone, Debug)]
struct Circumstances {
    /// The factor on the stiffness of servos.
    servos: f64,
    /// The factor on the stiffness of the contacts of each module, by its index; empty: as stated.
    contacts: Vec<f64>,
    /// The factor on the damping of contacts.
    damping: f64,
}

impl Circumstances {
    /// Returns those in which servos are as stated, softer, and stiffer; the stiffer ones are on stiffer contacts, so that links
    /// a tenth of a millimetre above those that bear stay there.
    fn of_servos(tracks: &Tracks) -> Vec<Circumstances> {
        let on_ground = |servos| Circumstances { servos, contacts: vec![], damping: 1.0 };
        let stiffer = Circumstances::on_stiff_ground(tracks, PARAMETERS.servo_stiffer, 1.0);
        vec![on_ground(1.0), on_ground(PARAMETERS.servo_softer), stiffer]
    }

    /// Returns those with these factors on stiffer contacts.
    fn on_stiff_ground(tracks: &Tracks, servos: f64, damping: f64) -> Circumstances {
        let contacts = vec![PARAMETERS.timed_sharing; tracks.robot.modules.len()];
        Circumstances { servos, contacts, damping }
    }

    /// Returns those in which a robot bounces the most: on softer servos, and on stiffer ground with little damping.
    fn bouncing(tracks: &Tracks) -> Circumstances {
        Circumstances::on_stiff_ground(tracks, PARAMETERS.servo_softer, PARAMETERS.timed_bounce)
    }

    /// Returns those in which every second module has stiffer contacts, and the others softer ones: by their place along the
    /// tree of bonds from the base, and by the number of modules on the way from the base. None of a single module.
    fn of_sharing(tracks: &Tracks) -> Vec<Circumstances> {
        let robot = &tracks.robot;
        if robot.modules.len() < 2 {
            return vec![];
        }
        let tree = Kinematics::new(robot, &tracks.start.bonds, robot.base).tree;
        let mut places = vec![[0; 2]; robot.modules.len()];
        for (place, &(module, bond)) in tree.order.iter().enumerate() {
            let Some(Bond { a, b, .. }) = bond.map(|bond| robot.bonds[bond]) else { continue };
            let carrier = if a.module == module { b.module } else { a.module };
            places[module] = [place, places[carrier][1] + 1];
        }
        let stiffer = PARAMETERS.timed_sharing;
        let factors = |by: usize, odd: usize| {
            let factor = |place: &[usize; 2]| if place[by] % 2 == odd { stiffer } else { 1.0 / stiffer };
            Circumstances { servos: 1.0, contacts: places.iter().map(factor).collect(), damping: 1.0 }
        };
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(by, odd)| factors(by, odd)).to_vec()
    }
}

/// The base of a robot as its rollout places it.
#[derive(Debug, Default)]
pub(in super::super) struct PlacedBase {
    /// The world pose of the base module's body at the start, m; `None` before that.
    start: Option<Pose>,
    /// The vertical in the axes of the base, by its time, s; in order of time.
    ups: Vec<(f64, Vec3)>,
}

impl PlacedBase {
    /// Keeps the attitude at a sample; samples come in order of time.
    pub(in super::super) fn observe(&mut self, sample: &Sample) {
        let base = *self.start.get_or_insert_with(|| sample.stance.base_pose(sample.model));
        let now = if self.ups.is_empty() { base } else { sample.stance.base_pose(sample.model) };
        self.ups.push((sample.time, now.rotation.inverse() * Vec3::z()));
    }

    /// Returns the least angle by which a base with this vertical in its axes leans away from where the rollout places it within
    /// `lag` (s) of a time (s), rad.
    fn lean(&self, up: &Vec3, time: f64, lag: f64) -> f64 {
        let from = self.ups.partition_point(|(t, _)| *t < time - lag).saturating_sub(1);
        let near = self.ups[from..].iter().take_while(|(t, _)| *t <= time + lag);
        let most = near.map(|(_, placed)| placed.dot(up)).fold(-1.0, f64::max);
        libm::acos(most.min(1.0))
    }
}

/// The motion of a robot in time.
#[derive(Clone, Copy, Debug)]
struct TimedMotion {
    /// The factor on the stiffness of its servos.
    stiffness: f64,
    /// True if contacts have little damping.
    bounces: bool,
    /// The displacement of the base over the ground in the world, x and y, m, and its turn, whole turns counted, rad.
    travel: Vec3,
    /// The time at which its centre of mass sinks so fast that it falls, s; `None`: it does not.
    falls: Option<f64>,
    /// The greatest angle (rad) by which its base leans away from where the rollout places it, with the time, s.
    leans: (f64, f64),
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

/// Returns the distance (m) and the angle (rad) within which the travel and the turn of a verdict are taken to be certain.
fn certain(verdict: &Verdict) -> [f64; 2] {
    let [x, y, _] = verdict.travel;
    certain_of(libm::hypot(x, y), verdict.heading)
}

/// Returns the distance (m) and the angle (rad) within which a travel (m) and a turn (rad) are taken to be certain: a part of them, or a
/// length and an angle.
fn certain_of(travel: f64, turn: f64) -> [f64; 2] {
    let part = |value: f64| PARAMETERS.travel_share * value.abs();
    [PARAMETERS.travel_tolerance_min.max(part(travel)), PARAMETERS.turn_tolerance_min.max(part(turn))]
}

/// Judges by motions in time what a rollout leaves open. Of a robot on the ground it states within what the travel is known,
/// and writes the travel anew, with a note, where contacts scrub; and it fails a robot that the ground does not balance at every
/// instant, unless it stays upright in motion. `base`: the base as the rollout places it; `None` for a robot that is not played by
/// itself. `unrested`: the slip while little of the robot rests.
pub(in super::super) fn judge_in_time(
    rollout: &Rollout,
    base: Option<&PlacedBase>,
    unrested: &UnrestedSlip,
    imbalance: Imbalance,
    ledger: &mut Ledger,
) {
    let Imbalance { leans, unbalanced } = imbalance;
    if let Some(speed) = base.and_then(|_| unrested.slides_on()) {
        ledger.fail_checked(still_slides(speed, ledger.verdict.duration));
    }
    let slip = ledger.verdict.slip.as_ref().map(|worst| worst.value);
    let Some((base, slip)) = base.zip(slip) else {
        unbalanced.into_iter().for_each(|unbalanced| ledger.fail_checked(unbalanced.failure()));
        return;
    };
    let known = certain(&ledger.verdict)[0];
    let scrubs = PARAMETERS.timed_slip_share * slip.max(unrested.idle()) > known;
    let dragged = PARAMETERS.slip_share * unrested.greatest();
    let rough = rollout.worlds.iter().any(|from| from.world.friction > PARAMETERS.friction_rough);
    let excused = ledger.needed(excuses_tip);
    let why = match (excused, scrubs, rough) {
        (true, ..) => Some("the robot tips, which is allowed"),
        (false, true, _) => Some("contacts scrub"),
        (false, false, true) => Some("feet wedge on rough ground"),
        (false, false, false) => {
            unbalanced.as_ref().map(|_| "the ground does not balance it at every instant")
        }
    };
    let tips = unbalanced.as_ref().is_some_and(|unbalanced| unbalanced.longest > PARAMETERS.unbalanced_time);
    let motions = (!tips && (why.is_some() || leans))
        .then(|| motions(rollout, base, dragged > known, ledger))
        .flatten();
    if let Some(unbalanced) = unbalanced {
        if !motions.as_ref().is_some_and(Motions::go_on) {
            // The imbalance is the cause of what motions in time show.
            ledger.fail_checked(unbalanced.failure());
            return bound_travel(&mut ledger.verdict);
        }
        ledger.note(unbalanced.note());
    }
    if !excused {
        motions.iter().flat_map(upset).for_each(|failure| ledger.fail_checked(failure));
    }
    match motions.zip(why) {
        Some((motions, why)) => {
            let note = state(&motions, dragged, rollout.exemptions, ledger);
            ledger.note(format!("{why}: {note}"));
        }
        None => bound_travel(&mut ledger.verdict),
    }
    if excused {
        bound_tipping(&mut ledger.verdict);
    }
}

/// States within what the travel of a robot is known that tips: where it comes to rest depends on its impact on the ground, and simulators
/// differ in that by as much.
fn bound_tipping(verdict: &mut Verdict) {
    let part = |value: f64| PARAMETERS.tip_share * value.abs();
    let [x, y, _] = verdict.travel;
    let length = part(libm::hypot(x, y)).max(PARAMETERS.tip_tolerance_min);
    let angle = part(verdict.heading).max(PARAMETERS.tip_turn_tolerance_min);
    bound(verdict, length, angle.max(verdict.heading_within.unwrap_or(0.0)));
}

/// Returns true of an exemption that excuses a robot which tips.
fn excuses_tip(kind: &ExemptionKind) -> bool {
    matches!(kind, ExemptionKind::Unstable | ExemptionKind::Balance)
}

/// Returns the failure of a robot that slides at a speed (m/s) as its plan ends, after a duration (s).
fn still_slides(speed: f64, duration: f64) -> Failure {
    let at = quantity(speed, Dimension::SPEED);
    Failure {
        kind: CheckKind::Rest,
        time: duration,
        until: None,
        at: vec![],
        message: format!("the robot still slides at {at} as the plan ends; `wait` lets it come to rest"),
        value: speed,
        limit: PARAMETERS.sliding_speed,
        blame: vec![],
        blames_start: false,
    }
}

/// States within what the travel of a verdict is known without motion in time, as simulations of random gaits showed it: a
/// tenth of it, 5 mm or a quarter of the slip, whichever is most, and a tenth of the turn, or 3 degrees. Nothing is stated where
/// no slip was measured.
pub(in super::super) fn bound_travel(verdict: &mut Verdict) {
    let Some(slip) = verdict.slip.as_ref().map(|worst| worst.value) else { return };
    let [length, angle] = certain(verdict);
    bound(verdict, length.max(PARAMETERS.slip_share * slip), angle);
}

/// States that the travel of a verdict is known within a length (m), or within the more that is stated already, and its turn
/// within an angle, rad.
fn bound(verdict: &mut Verdict, length: f64, angle: f64) {
    verdict.travel_within = Some(length.max(verdict.travel_within.unwrap_or(0.0)));
    verdict.heading_within = Some(angle);
}

/// The motions of a robot in time under different circumstances.
#[derive(Debug)]
struct Motions {
    /// Those with servos as stiff as stated, softer and stiffer, and one in which the robot bounces, if it may.
    servos: Vec<TimedMotion>,
    /// Those in which links share the weight otherwise.
    sharing: Vec<TimedMotion>,
}

impl Motions {
    /// Returns true if the robot stays upright in all of them, and they determine its travel.
    fn go_on(&self) -> bool {
        let is_upright =
            |motion: &TimedMotion| motion.falls.is_none() && motion.leans.0 <= PARAMETERS.timed_lean;
        self.servos.iter().chain(&self.sharing).all(is_upright) && Spread::of(self).undetermined().is_none()
    }
}

/// Plays the robot of a rollout under all circumstances; `None` where its motion is not that of one robot from the
/// beginning to the end of a plan on level ground, something has failed, or it would take too long. `bounces`: what slides takes
/// the robot along.
fn motions(rollout: &Rollout, base: &PlacedBase, bounces: bool, ledger: &Ledger) -> Option<Motions> {
    let tracks = rollout.tracks;
    let [world] = rollout.worlds else { return None };
    let world = &world.world;
    let alone = tracks.events.is_empty()
        && tracks.start.clusters.is_empty()
        && tracks.obstacles.is_empty()
        && rollout.begin.is_none();
    let stands = world.ground == Ground::Settle && world.gravity > 0.0 && !world.is_sloped();
    if !alone || !stands || !ledger.verdict.failures.is_empty() {
        return None;
    }
    let mut of_servos = Circumstances::of_servos(tracks);
    of_servos.extend(bounces.then(|| Circumstances::bouncing(tracks)));
    let count = of_servos.len();
    let all = [of_servos, Circumstances::of_sharing(tracks)].concat();
    let played = |these: &[Circumstances]| -> Option<Vec<TimedMotion>> {
        these.iter().map(|circumstances| motion(tracks, base, world, circumstances)).collect()
    };
    let (some, others) = all.split_at(all.len() / 2);
    let (first, second) = interrupt::join(|| played(some), || played(others));
    let mut servos = [first?, second?].concat();
    let sharing = servos.split_off(count);
    Some(Motions { servos, sharing })
}

/// Plays a robot under circumstances: as in a simulation, it stands before it begins and after it has
/// ended. `None` where it can't be played, or would take more than the greatest number of steps. Bonds do not break here.
fn motion(
    tracks: &Tracks,
    placed: &PlacedBase,
    world: &World,
    circumstances: &Circumstances,
) -> Option<TimedMotion> {
    let start = placed.start.as_ref()?;
    let step = PARAMETERS.timed_step;
    let servo = ServoGains { factor: circumstances.servos, ..ServoGains::default() };
    let settings = Settings { step, servo, ..Settings::default() };
    let mut model = Model::new(tracks, (start, &[]), world, &settings, &[]);
    model.scale_contacts(&circumstances.contacts, circumstances.damping);
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
    let mut leans = (0.0, 0.0);
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
        turn += turn_about_vertical(&(now.rotation * base.rotation.inverse()));
        base = now;
        let lean = placed.lean(&(now.rotation.inverse() * Vec3::z()), time, PARAMETERS.spacing_least);
        if lean > leans.0 {
            leans = (lean, time);
        }
    }
    let shift = base.translation.vector - begun.translation.vector;
    Some(TimedMotion {
        stiffness: circumstances.servos,
        bounces: circumstances.damping < 1.0,
        travel: Vec3::new(shift.x, shift.y, turn),
        falls,
        leans,
    })
}

/// The distances between the ends of motions in time.
struct Spread<'a> {
    /// The two motions with different servos whose ends are farthest apart.
    ends: [&'a TimedMotion; 2],
    /// The distance of these ends, m.
    apart: f64,
    /// The least and the greatest turn with different servos, rad.
    turns: [f64; 2],
    /// The greatest distance (m) and turn (rad) from the end with servos as stiff as stated to one where links share the
    /// weight otherwise.
    shared: [f64; 2],
}

impl<'a> Spread<'a> {
    fn of(Motions { servos: motions, sharing }: &'a Motions) -> Spread<'a> {
        let stated = &motions[0];
        let apart = |[a, b]: [&TimedMotion; 2]| a.away(b);
        let farther = |most, pair| if apart(pair) > apart(most) { pair } else { most };
        let pairs = (1..motions.len()).flat_map(|b| (0..b).map(move |a| [&motions[a], &motions[b]]));
        let ends = pairs.fold([stated; 2], farther);
        let turns = motions.iter().map(|motion| motion.travel.z);
        let turns = turns.fold([stated.travel.z; 2], |[least, most], turn| [least.min(turn), most.max(turn)]);
        let greatest = |of: &dyn Fn(&TimedMotion) -> f64| sharing.iter().map(of).fold(0.0, f64::max);
        let shared = [
            greatest(&|other| stated.away(other)),
            greatest(&|other| (stated.travel.z - other.travel.z).abs()),
        ];
        Spread { ends, apart: apart(ends), turns, shared }
    }

    /// Returns the displacement in the middle of the ends, x and y, m, with the turn in the middle of the least and the greatest, rad.
    fn middle(&self) -> Vec3 {
        let middle = (self.ends[0].travel + self.ends[1].travel) / 2.0;
        Vec3::new(middle.x, middle.y, (self.turns[0] + self.turns[1]) / 2.0)
    }

    /// Returns the bounds on the travel (m) and the turn (rad) about the middle of the ends, as servos leave them.
    fn of_servos(&self) -> [f64; 2] {
        [self.apart, self.turns[1] - self.turns[0]].map(|apart| PARAMETERS.timed_spread * apart / 2.0)
    }

    /// Returns the bounds on the travel (m) and the turn (rad) about the middle of the ends, as servos and the sharing of the
    /// weight leave them.
    fn bounds(&self) -> [f64; 2] {
        let servos = self.of_servos();
        [0, 1].map(|of| servos[of].max(PARAMETERS.timed_spread * self.shared[of]))
    }

    /// Returns why motions in time do not determine the travel, with the value that is beyond a limit (m or rad), and that limit;
    /// `None` if they do. Servos must leave them certain; another sharing of the weight may change as much as a variation of friction.
    fn undetermined(&self) -> Option<(String, f64, f64)> {
        let middle = self.middle();
        let length = middle.xy().norm();
        let (certain, [bound, turn]) = (certain_of(length, middle.z), self.of_servos());
        if bound > certain[0] {
            let apart = quantity(self.apart, Dimension::LENGTH);
            let [a, b] = self.ends.map(|motion| number(motion.stiffness));
            let bounces = self.ends.iter().any(|motion| motion.bounces);
            let ground = if bounces { ", one of them on ground on which it bounces," } else { "" };
            let what =
                format!("in motion, servos {a} and {b} times as stiff{ground} take the robot {apart} apart");
            return Some((what, bound, certain[0]));
        }
        if turn > certain[1] {
            let apart = quantity(self.turns[1] - self.turns[0], Dimension::ANGLE);
            let what = format!("in motion, servos of other stiffness turn the robot {apart} apart");
            return Some((what, turn, certain[1]));
        }
        let shared = PARAMETERS.timed_spread * self.shared[0];
        let limit = PARAMETERS.travel_undetermined_min.max(PARAMETERS.travel_undetermined * length);
        (shared > limit).then(|| {
            let what = format!(
                "in motion, with contacts {} times as stiff under every second module, and softer ones under the others, it ends \
                 {} elsewhere: so much depends on how its links share the weight",
                number(PARAMETERS.timed_sharing),
                quantity(self.shared[0], Dimension::LENGTH)
            );
            (what, shared, limit)
        })
    }
}

/// Returns the failures of a robot that falls in motions in time, or leans away from where the rollout places it.
fn upset(motions: &Motions) -> Vec<Failure> {
    let failure = |motion: &TimedMotion, time: f64, what: String, [value, limit]: [f64; 2]| Failure {
        kind: CheckKind::Balance,
        time,
        until: None,
        at: vec![],
        message: format!("in motion, with {}, {what}", motion.servos()),
        value,
        limit,
        blame: vec![],
        blames_start: false,
    };
    let falls = motions.servos.iter().find_map(|motion| Some((motion, motion.falls?)));
    let falls = falls.map(|(motion, time)| {
        let what = format!("the robot falls at {}", quantity(time, Dimension::TIME));
        failure(motion, time, what, [PARAMETERS.timed_fall; 2])
    });
    let farther = |a: &&TimedMotion, b: &&TimedMotion| a.leans.0.total_cmp(&b.leans.0);
    let standing = motions.servos.iter().filter(|motion| !motion.bounces && motion.falls.is_none());
    let leaning = standing.max_by(farther).filter(|motion| motion.leans.0 > PARAMETERS.timed_lean);
    let leans = leaning.map(|motion| {
        let (lean, time) = motion.leans;
        let angle = quantity(lean, Dimension::ANGLE);
        let what = format!("the robot leans by {angle} from where it would stand at rest");
        failure(motion, time, what, [lean, PARAMETERS.timed_lean])
    });
    falls.into_iter().chain(leans).collect()
}

/// Writes the travel and the turn of motions in time into the verdict, fails where they do not determine these, and returns the
/// note on them. The first has servos as stiff as stated. `dragged`: within what the travel is known by the slip while little of
/// the robot rests, m. An exemption `allows traction` anywhere in the plan excuses a travel that is not determined, and so does one
/// that a robot needs which tips.
fn state(motions: &Motions, dragged: f64, exemptions: &[Exemption], ledger: &mut Ledger) -> String {
    let spread = Spread::of(motions);
    let middle = spread.middle();
    let verdict = &mut ledger.verdict;
    (verdict.travel[0], verdict.travel[1], verdict.heading) = (middle.x, middle.y, middle.z);
    let ([length, angle], [away, turn]) = (certain(verdict), spread.bounds());
    let away = away + PARAMETERS.timed_error;
    bound(verdict, length.max(away).max(dragged), angle.max(turn + PARAMETERS.timed_turn_error));
    if let Some((what, value, limit)) = spread.undetermined() {
        let of_traction = |(_, exemption): &(usize, &Exemption)| exemption.kind == ExemptionKind::Traction;
        let allowed: Vec<usize> =
            exemptions.iter().enumerate().filter(of_traction).map(|(index, _)| index).collect();
        allowed.iter().for_each(|&index| ledger.use_exemption(index, CheckKind::Traction));
        if allowed.is_empty() && ledger.needed(excuses_tip) {
            ledger.note(format!("the travel is not determined: {what}"));
        } else if allowed.is_empty() {
            ledger.fail_checked(Failure {
                kind: CheckKind::Traction,
                time: 0.0,
                until: Some(ledger.verdict.duration),
                at: vec![],
                message: format!("the travel is not determined: {what}"),
                value,
                limit,
                blame: vec![],
                blames_start: false,
            });
        }
    }
    let factors = [PARAMETERS.servo_softer, 1.0, PARAMETERS.servo_stiffer].map(number);
    format!(
        "the travel is the middle of motions in time with servos {}, {} and {} times as stiff, {} apart",
        factors[0],
        factors[1],
        factors[2],
        rounded_up(spread.apart, "mm")
    )
}
