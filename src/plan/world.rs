//! The world that a plan assumes, the settings of its judge, and its exemptions from checks.

use super::cause::CauseId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ground under the robot, and the way in which it holds the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ground {
    /// Quasi-static contact on the ground, level at height 0 or a slope: the robot rests, rolls, travels and tips.
    Settle,
    /// Level ground at height 0, onto which the robot is lowered at the start with its orientation; its base then
    /// keeps that pose. Contacts bear the weight; without gravity a fixture holds the base.
    Fixed,
    /// The base module's body is held fast, fixed in the world: its fixture takes any force and moment, and
    /// nothing else touches the robot.
    Held,
    /// No ground: the robot floats.
    Off,
}

/// The assumptions about the robot's surroundings: gravity, ground, friction, dynamics.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// The acceleration of gravity, m/s², downwards along -z of the world; 0 is weightless.
    pub gravity: f64,
    /// The ground under the robot, and how it holds the base.
    pub ground: Ground,
    /// The factor on the coefficient of friction of every link, without unit; not negative.
    pub friction: f64,
    /// The dynamics that articulated robots are judged under: statics or full, and full in all worlds of a plan if one
    /// asks for them. Whatever stands here, trusses are judged under statics, and lattices under kinodynamics
    /// ([`Body::dynamics`](super::Body::dynamics)).
    pub dynamics: DynamicsModel,
    /// The rise of the ground along x and along y of the world, m per m: a plane through the origin. Level ground has
    /// [0, 0]; any other needs a ground on which an articulated robot settles, and is the same in all worlds of a plan.
    #[serde(default, skip_serializing_if = "is_level")]
    pub slope: [f64; 2],
}

/// Returns true for the slope of level ground.
pub(super) fn is_level(slope: &[f64; 2]) -> bool {
    *slope == [0.0, 0.0]
}

/// The dynamics that a plan is judged under: the assumed relation of forces and motion. Later versions may add
/// models; none of these changes its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DynamicsModel {
    /// Statics: every instant is judged at rest; weight and contacts balance, inertia is left out.
    Statics,
    /// Full dynamics: inertia, friction of sliding contacts, and servos that yield decide forces and travel.
    Full,
    /// The dynamics of lattices: cells accelerate within their force along each axis, and momentum is kept; there is
    /// no weight.
    Kinodynamic,
}

impl DynamicsModel {
    /// Returns the name of the model as it stands in a sentence, such as `full dynamics`.
    pub fn words(self) -> &'static str {
        match self {
            DynamicsModel::Statics => "statics",
            DynamicsModel::Full => "full dynamics",
            DynamicsModel::Kinodynamic => "kinodynamics",
        }
    }
}

impl std::fmt::Display for DynamicsModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            DynamicsModel::Statics => "statics",
            DynamicsModel::Full => "full",
            DynamicsModel::Kinodynamic => "kinodynamic",
        })
    }
}

impl World {
    /// The world without gravity and without ground, under statics.
    pub const FREE: World = World {
        gravity: 0.0,
        ground: Ground::Off,
        friction: 1.0,
        dynamics: DynamicsModel::Statics,
        slope: [0.0; 2],
    };

    /// Returns true if there is ground under the robot: for [`Ground::Settle`] and [`Ground::Fixed`].
    pub fn has_floor(&self) -> bool {
        matches!(self.ground, Ground::Settle | Ground::Fixed)
    }

    /// Returns true if there is ground under the robot that carries its weight: [`Ground::Settle`] or
    /// [`Ground::Fixed`], with gravity.
    pub fn floor_bears(&self) -> bool {
        self.gravity > 0.0 && self.has_floor()
    }
}

impl Default for World {
    fn default() -> World {
        World { gravity: 9.80665, ground: Ground::Settle, dynamics: DynamicsModel::Full, ..World::FREE }
    }
}

/// A world that holds from a time on; the first begins at 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldFrom {
    /// The time from which the world holds, from the start of the plan, s.
    pub from: f64,
    /// The world that holds from that time on.
    pub world: World,
}

/// Returns true if articulated robots are judged under full dynamics: if one of the worlds of a plan asks for them,
/// then in all.
pub fn is_full(worlds: &[WorldFrom]) -> bool {
    worlds.iter().any(|from| from.world.dynamics == DynamicsModel::Full)
}

/// The rule for the support polygon that the centre of mass must be over, for static stability: Definition IV.7 of
/// the compositional-design paper (Tosun, Jing, Kress-Gazit and Yim).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// The hull of the ground contacts (McGhee and Frank 1968).
    Footprint,
    /// The hull of the centres of the lowest modules, the rule of the compositional-design paper.
    Centres,
}

/// The settings of the judge. Settings looser than the default are stated in the source and in the plan. The default: a
/// sample every 0.01 s, no time without support, the rule [`Footprint`](Stability::Footprint), no reserve, any slip,
/// and two million samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The longest time between two samples, s.
    pub sample: f64,
    /// The longest continuous time without support, s: t_max of Definition V.3 of the compositional-design paper
    /// (Tosun, Jing, Kress-Gazit and Yim).
    pub unstable_for: f64,
    /// The rule for the support polygon of the check of stability.
    pub stability: Stability,
    /// The part of each limit of torque, force and bond load that must be left under full dynamics, as a fraction
    /// from 0 to 1.
    #[serde(default = "Settings::reserve_default")]
    pub reserve: f64,
    /// The greatest slip of a loaded link over the ground, summed over the plan, m; `None`: slip fails nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip_max: Option<f64>,
    /// The part of their own speed by which wheels and feet may slip under full dynamics, from 0 to 1: the spread of dockings
    /// between robots is stated for it.
    #[serde(default = "Settings::slip_default", skip_serializing_if = "Settings::is_slip_default")]
    pub slip: f64,
    /// The greatest number of samples of one verification, refinements included; a verification that needs more
    /// fails.
    pub samples_max: usize,
}

impl Settings {
    /// Returns the reserve where none is stated: 0, so that a load fails only beyond its limit. Of 200 random gaits
    /// those that pass so neither fell nor lagged by 10° in MuJoCo (`docs/dynamics.md`).
    pub fn reserve_default() -> f64 {
        0.0
    }

    /// Returns the slip where none is stated: 5 %.
    pub fn slip_default() -> f64 {
        0.05
    }

    fn is_slip_default(slip: &f64) -> bool {
        *slip == Settings::slip_default()
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            sample: 0.01,
            unstable_for: 0.0,
            stability: Stability::Footprint,
            reserve: Settings::reserve_default(),
            slip_max: None,
            slip: Settings::slip_default(),
            samples_max: 2_000_000,
        }
    }
}

/// The check that an interval of a plan is excused from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ExemptionKind {
    /// Stability: the centre of mass may be outside the support polygon, and no forces of the ground need hold the
    /// robot in its motion.
    Unstable,
    /// Slip: links in contact may slide over the ground.
    Slip,
    /// Collisions between two modules, by their indices in the assembly; `None`: between any two.
    Collision(Option<(usize, usize)>),
    /// Overload of one joint, by the number in its [`JointId`](crate::robot::JointId); `None`: of any joint.
    Overload(Option<u32>),
    /// Accelerations beyond the limits of joints, and steps of their velocities.
    Acceleration,
    /// Balance: no forces of the ground need hold the robot in its motion.
    Balance,
    /// Traction: friction need not determine the travel.
    Traction,
    /// Torque, where the robot sags by no more than 5° with its motors at their limits.
    Saturation,
}

impl ExemptionKind {
    /// Returns the word of the language for the check, such as `unstable` in `allows unstable`.
    pub fn name(&self) -> &'static str {
        match self {
            ExemptionKind::Unstable => "unstable",
            ExemptionKind::Slip => "slip",
            ExemptionKind::Collision(_) => "collision",
            ExemptionKind::Overload(_) => "overload",
            ExemptionKind::Acceleration => "acceleration",
            ExemptionKind::Balance => "balance",
            ExemptionKind::Traction => "traction",
            ExemptionKind::Saturation => "saturation",
        }
    }
}

/// An interval of a plan that is excused from a check. The end of the whole plan never is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exemption {
    /// The check that is excused, and for which parts of the robot.
    pub kind: ExemptionKind,
    /// The time from which the check is excused, s from the start of the plan; included.
    pub from: f64,
    /// The time up to which the check is excused, s from the start of the plan; included.
    pub to: f64,
    /// The index in the plan's causes of the source command that this exemption comes from.
    pub cause: CauseId,
}

impl Exemption {
    /// Returns true if the exemption excuses its check at a time, s from the start of the plan; both ends are included.
    pub fn covers(&self, time: f64) -> bool {
        self.from <= time && time <= self.to
    }
}
