//! Travel over the ground with friction and momentum: the base moves by the twist that the friction of its loaded
//! contacts gives it.

use super::super::minimum_power::{PlanarPose, along_ground};
use super::super::model::Model;
use super::super::rollout_input::Rollout;
use super::equilibrium::{self, Equilibrium, Warm};
use super::posed::{Posed, Situation};
use super::slide;
use super::slip_spread::SlipSpread;
use super::tolerances::PARAMETERS;
use super::twist::{self, Momentum};
use crate::geometry::Mat3;
use crate::geometry::Vec3;
use crate::plan::{ExemptionKind, World};
use crate::robot::dynamics::{Dynamics, Twist, Wrench};
use crate::units::number;
use nalgebra::Vector3;
use std::collections::BTreeSet;

/// The travel over the ground by friction and momentum, followed from sample to sample of a rollout.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Traction {
    /// The forces and twist found last, as the guess of the next.
    warm: Warm,
    /// The instant at which forces were determined last; `None` before the first.
    last: Option<Last>,
    /// The travel of the samples at which no exemption `allows traction` holds.
    judged: TravelPoses,
    /// The travel of the samples at which one holds.
    allowed: TravelPoses,
    /// The exemptions `allows traction` that hold at a sample so far, by their indices in the plan's list.
    allowed_by: BTreeSet<usize>,
}

/// A variation of friction or servo stiffness under which the travel is computed once more, to find how much it
/// depends on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Variation {
    /// Friction is greater by the factor [`friction_more`](super::tolerances::Parameters::friction_more) where
    /// contacts slide, and less by [`friction_less`](super::tolerances::Parameters::friction_less) elsewhere.
    #[default]
    Friction,
    /// Servos are softer by the factor [`servo_softer`](super::tolerances::Parameters::servo_softer).
    Softer,
    /// Servos are stiffer by the factor [`servo_stiffer`](super::tolerances::Parameters::servo_stiffer).
    Stiffer,
}

impl Variation {
    const ALL: [Variation; 3] = [Variation::Friction, Variation::Softer, Variation::Stiffer];

    /// Returns the variation as a condition in a sentence, such as `if servos were 0.4 times as stiff`.
    pub(super) fn words(self) -> String {
        match self {
            Variation::Friction => format!(
                "if contacts that slide had {} times the friction and the others {} times",
                number(PARAMETERS.friction_more),
                number(PARAMETERS.friction_less)
            ),
            Variation::Softer => format!("if servos were {} times as stiff", number(PARAMETERS.servo_softer)),
            Variation::Stiffer => {
                format!("if servos were {} times as stiff", number(PARAMETERS.servo_stiffer))
            }
        }
    }
}

/// The pose that travel over the ground has reached, and those under each variation, in the order of
/// [`Variation::ALL`]; all begin at 0.
#[derive(Clone, Copy, Debug, Default)]
struct TravelPoses {
    own: PlanarPose,
    others: [PlanarPose; Variation::ALL.len()],
}

impl TravelPoses {
    /// Moves the pose on by a step, and those of the variations by theirs: x, y (m) and turn (rad) in their own frames.
    fn advance(&mut self, own: &Vec3, others: &[Vec3; Variation::ALL.len()]) {
        self.own = self.own.moved(own);
        for (other, shift) in self.others.iter_mut().zip(others) {
            *other = other.moved(shift);
        }
    }

    /// Returns the travel so far, with the variation that ends farthest from it.
    fn travel(&self) -> GroundTravel {
        let away = self.others.map(|other| libm::hypot(self.own.x - other.x, self.own.y - other.y));
        let farthest = (1..away.len()).fold(0, |most, i| if away[i] > away[most] { i } else { most });
        GroundTravel {
            length: libm::hypot(self.own.x, self.own.y),
            away: away[farthest],
            variation: Variation::ALL[farthest],
        }
    }
}

/// The distance travelled over the ground, with its sensitivity to friction and servo stiffness.
#[derive(Clone, Copy, Debug, Default)]
pub struct GroundTravel {
    /// The horizontal distance of the travel's end from its start, m.
    pub length: f64,
    /// The horizontal distance of the travel's end from the farthest end under a variation, m.
    pub away: f64,
    /// The variation with that farthest end.
    pub variation: Variation,
}

/// The travel of a rollout up to a sample, in two parts: without and with an exemption `allows traction`.
#[derive(Clone, Debug, Default)]
pub struct TravelSummary {
    /// The travel during the samples at which no such exemption holds, which is judged.
    pub judged: GroundTravel,
    /// The travel during the samples at which one holds.
    pub allowed: GroundTravel,
    /// The exemptions that hold at one of them, by their indices in the plan's list.
    pub allowed_by: BTreeSet<usize>,
}

/// The velocities at the last instant at which forces were determined, in level axes.
#[derive(Clone, Debug)]
struct Last {
    /// The time of the instant, s.
    time: f64,
    /// A flag for every bond of the robot, true if it held.
    bonds: Vec<bool>,
    /// The planar momentum of the joints' motion with the base still: x and y (N·s), and yaw about the centre of mass
    /// (N·m·s).
    carried: Vector3<f64>,
    /// The twist of the base at the centre of mass.
    twist: Twist,
    /// The velocity of the centre of mass (x and y, m/s) and the yaw rate of the base (rad/s).
    rate: Vector3<f64>,
    /// The difference of `rate` under each variation from `rate`, in the order of [`Variation::ALL`].
    others: [Vector3<f64>; Variation::ALL.len()],
    /// The time at which the rates with softer and stiffer servos were determined, s.
    varied_at: f64,
    /// The slip of each loaded link, as (number of the link, m/s, load as a part of the weight).
    slips: Vec<(usize, f64, f64)>,
    /// The rates at which the robot goes astray if contacts slip.
    spread: SlipSpread,
}

/// A step of the rollout on the ground, from one sample to the next.
pub(in super::super) struct GroundStep<'a> {
    /// The rollout that the step belongs to.
    pub rollout: &'a Rollout<'a>,
    /// A flag for every bond of the robot, true if it holds.
    pub bonds: &'a [bool],
    /// The robot with the bonds that hold.
    pub model: &'a Model<'a>,
    /// The masses of the robot's links.
    pub dynamics: &'a Dynamics,
    /// The world during the step.
    pub world: &'a World,
    /// The time of the sample before, s.
    pub before: f64,
    /// The time of this sample, s.
    pub time: f64,
    /// The attitude of the base in level axes at the time `before`.
    pub R_before: &'a Mat3,
    /// The attitude of the base in level axes at this sample.
    pub R: &'a Mat3,
}

impl<'a> GroundStep<'a> {
    /// Returns the robot at the end of the step; `yaw`: the heading there, rad.
    fn posed(&self, yaw: f64) -> Posed<'a> {
        let at = (self.time, PARAMETERS.window);
        Posed::new(self.model, self.dynamics, self.rollout, at, (self.R, yaw))
    }
}

impl Traction {
    /// Advances the travel by a step of the rollout from the planar pose `pose`. Returns (pose, slips): the pose after
    /// it, and for each loaded link (number of the link, its slip in m, its load as a fraction of the weight). The
    /// robot stays in place, without slips, as long as no loads have been found.
    pub(in super::super) fn advance(
        &mut self,
        step: &GroundStep,
        pose: &PlanarPose,
    ) -> (PlanarPose, Vec<(usize, f64, f64)>) {
        let stale =
            |last: &Last| step.time - last.time >= PARAMETERS.spacing_least || last.bonds != step.bonds;
        if self.last.as_ref().is_none_or(stale) {
            self.determine(step, pose.yaw);
        }
        let Some(last) = &self.last else { return (*pose, vec![]) };
        let dt = step.time - step.before;
        let drift = yaw_between(step.R_before, step.R);
        let shift = |rate: Vector3<f64>| Vec3::new(rate.x * dt, rate.y * dt, rate.z * dt - drift);
        let slips = last.slips.iter().map(|&(link, speed, load)| (link, speed * dt, load)).collect();
        let mut poses = &mut self.judged;
        for (index, exemption) in step.rollout.exemptions.iter().enumerate() {
            if exemption.kind == ExemptionKind::Traction && exemption.covers(step.time) {
                self.allowed_by.insert(index);
                poses = &mut self.allowed;
            }
        }
        poses.advance(&shift(last.rate), &last.others.map(|more| shift(last.rate + more)));
        (pose.moved(&shift(last.rate)), slips)
    }

    /// Begins with a robot in motion, at the time of a step that lasts no time. `momentum`: its momentum (N·s) and angular
    /// momentum about its centre of mass (N·m·s) in the world, of which what is along the ground and about its normal counts;
    /// `yaw`: the heading then, rad.
    pub(in super::super) fn begin(&mut self, step: &GroundStep, momentum: &Wrench, yaw: f64) {
        if *momentum == Wrench::default() {
            return;
        }
        let posed = step.posed(yaw);
        let to_ground = step.world.ground_pose().rotation.inverse();
        let level = |v: &Vec3| along_ground(&(to_ground * v), -yaw);
        let (force, moment) = (level(&momentum.force), level(&momentum.moment));
        let whole = Vector3::new(force.x, force.y, moment.z);
        // The share of the joints is a mean over a window, here and in the steps to come; the whole is that of this instant.
        let (inertia, carried) = planar(&posed);
        let base = per(&(whole - carried), &inertia);
        self.last = Some(Last {
            time: step.time,
            bonds: step.bonds.to_vec(),
            carried,
            rate: Vector3::new(whole.x / inertia.x, whole.y / inertia.y, base.z),
            others: [Vector3::zeros(); Variation::ALL.len()],
            varied_at: f64::NEG_INFINITY,
            twist: Twist { linear: Vec3::new(base.x, base.y, 0.0), angular: Vec3::z() * base.z },
            slips: vec![],
            spread: SlipSpread::default(),
        });
    }

    /// Returns true if the robot slides on even if its joints are at rest.
    pub(in super::super) fn coasts(&self) -> bool {
        let rate = self.last.as_ref().map_or_else(Vector3::zeros, |last| last.rate);
        rate.norm() > PARAMETERS.coasting_speed
    }

    /// Returns the rates at which the robot goes astray if contacts slip, as found last.
    pub(in super::super) fn spread(&self) -> SlipSpread {
        self.last.as_ref().map_or_else(SlipSpread::default, |last| last.spread)
    }

    /// Returns the travel from the start of the rollout to the last step.
    pub(in super::super) fn travel(&self) -> TravelSummary {
        let (judged, allowed) = (self.judged.travel(), self.allowed.travel());
        TravelSummary { judged, allowed, allowed_by: self.allowed_by.clone() }
    }

    /// Determines the velocities at the end of a step from the equilibrium of forces there, and those under the
    /// variations; the former ones stay where no forces are found. `yaw`: the heading there, rad.
    fn determine(&mut self, step: &GroundStep, yaw: f64) {
        let posed = step.posed(yaw);
        let mut situation = Situation::at_rest(&posed, step.world);
        let (inertia, carried) = planar(&posed);
        let since = self.last.as_ref().map(|last| step.time - last.time);
        // After a rest there is no momentum left.
        let moving = since.is_some_and(|since| since <= PARAMETERS.window);
        let (was, had) = match &self.last {
            Some(last) if moving => {
                let twist = Vector3::new(last.twist.linear.x, last.twist.linear.y, last.twist.angular.z);
                (twist, last.carried)
            }
            _ => (Vector3::zeros(), Vector3::zeros()),
        };
        // Without friction momentum stays: what the joints gain, the base loses.
        let free = was - per(&(carried - had), &inertia);
        let [least, most] = PARAMETERS.momentum_step;
        let duration = since.filter(|_| moving).unwrap_or(least).clamp(least, most);
        let momentum = Momentum { inertia, free, step: duration };
        if self.last.as_ref().is_some_and(|last| last.bonds != step.bonds) {
            self.warm = Warm::default();
        }
        let found = equilibrium::solve(&situation, Some(momentum), &mut self.warm);
        let Some(Equilibrium { mut twist, loads, mut friction, .. }) = found else { return };
        // Friction is viscous at low speed, so that a robot would creep down a slope on which it stands.
        if slide::stands(&situation, &loads.normal, &friction) {
            twist = Twist::default();
            friction.iter_mut().for_each(|(slip, _)| *slip = Vec3::zeros());
        }
        let by_joints = carried / step.model.mass;
        let rate = |twist: &Twist| {
            Vector3::new(twist.linear.x + by_joints.x, twist.linear.y + by_joints.y, twist.angular.z)
        };
        let factors = friction.iter().map(|(slip, _)| {
            if slip.norm() > PARAMETERS.sliding_speed {
                PARAMETERS.friction_more
            } else {
                PARAMETERS.friction_less
            }
        });
        let factors: Vec<f64> = factors.collect();
        let varied = (&loads.normal[..], &factors[..]);
        let other = equilibrium::twist_under(&situation, varied, Some(momentum), &twist);
        let mut others = [rate(&other) - rate(&twist), Vector3::zeros(), Vector3::zeros()];
        let mut varied_at = step.time;
        match &self.last {
            // The effect of softer and stiffer servos changes slowly, and is kept for some instants.
            Some(last)
                if step.time - last.varied_at < PARAMETERS.variation_spacing && last.bonds == step.bonds =>
            {
                others[1..].copy_from_slice(&last.others[1..]);
                varied_at = last.varied_at;
            }
            _ => {
                let stiffness = situation.stiffness.clone();
                let factors = [PARAMETERS.servo_softer, PARAMETERS.servo_stiffer];
                for (other, factor) in others[1..].iter_mut().zip(factors) {
                    situation.stiffness = stiffness.iter().map(|stiffness| stiffness * factor).collect();
                    let mut warm = self.warm.clone();
                    let found = equilibrium::solve(&situation, Some(momentum), &mut warm);
                    *other = found.map_or_else(Vector3::zeros, |found| rate(&found.twist) - rate(&twist));
                }
            }
        }
        let weight = situation.weight;
        self.last = Some(Last {
            time: step.time,
            bonds: step.bonds.to_vec(),
            carried,
            rate: rate(&twist),
            others,
            varied_at,
            twist,
            slips: twist::slips_by_link(&situation.candidates, &loads.normal, &friction, weight),
            spread: SlipSpread::of(&situation.candidates, &loads.normal, &friction),
        });
    }
}

/// Returns the name of the servos of the softer variation in a sentence: `servos 0.4 times as stiff as stated`.
pub(in super::super) fn soft_servos() -> String {
    format!("servos {} times as stiff as stated", number(PARAMETERS.servo_softer))
}

/// Returns the turn about the vertical from one attitude to another, rad.
fn yaw_between(from: &Mat3, to: &Mat3) -> f64 {
    let turn = to * from.transpose();
    libm::atan2(turn[(1, 0)] - turn[(0, 1)], turn[(0, 0)] + turn[(1, 1)])
}

/// Returns velocities from momenta and inertia, x, y and yaw. A single point has no inertia in yaw, and gains no turn.
fn per(momentum: &Vector3<f64>, inertia: &Vector3<f64>) -> Vector3<f64> {
    momentum.zip_map(inertia, |momentum, inertia| if inertia > 0.0 { momentum / inertia } else { 0.0 })
}

/// Returns the composite inertia in x, y (kg) and yaw about the centre of mass (kg·m²), and the planar momentum of the
/// joints' motion with the base still: x, y (N·s) and yaw about the centre of mass (N·m·s).
fn planar(posed: &Posed) -> (Vector3<f64>, Vector3<f64>) {
    let momentum = posed.momentum();
    let inertia = Vector3::new(posed.model.mass, posed.model.mass, posed.yaw_inertia());
    (inertia, Vector3::new(momentum.force.x, momentum.force.y, momentum.moment.z))
}
