//! A sample of a rollout, for those who watch it.

use super::dynamics::{SlipSpread, TravelSummary};
use super::model::Model;
use super::stance::Stance;
use crate::plan::World;

/// The robot at one sample of a rollout, with what changed since the sample before.
pub struct Sample<'a> {
    /// The time of the sample from the start of the plan, s.
    pub time: f64,
    /// The time of the sample before, s; the same as `time` at the start.
    pub before: f64,
    /// The positions of all joints, by the number in their `JointId`, rad or m.
    pub joints: &'a [f64],
    /// A flag for every bond of the robot, by its index, true if it holds.
    pub bonds: &'a [bool],
    /// The model of the robot with those bonds.
    pub model: &'a Model<'a>,
    /// The stance of the robot: its posture and attitude, its place in the world, and its contacts.
    pub stance: &'a Stance,
    /// The world that the plan assumes just after that time.
    pub world: &'a World,
    /// True if anything moved since the sample before.
    pub moved: bool,
    /// The fall of the centre of mass as the robot settles with the joints held, m, also where the base is held so that
    /// it does not; 0 off the ground.
    pub fall: f64,
    /// An upper bound on the motion of the robot's points about the centre of mass since the sample before, m; 0 off
    /// the ground.
    pub motion: f64,
    /// The loss of support since the sample before; `None` if there was none.
    pub tip: Option<&'a TipOver>,
    /// The slip of each loaded link since the sample before, as (number of the link, slip in m, load as a fraction of
    /// the weight), and under full dynamics that of links which are about to bear, with a load of 0. Under statics half of the slip comes with the contact patches of the sample before, the other half
    /// with those of this one, so that a link may occur twice.
    pub slips: &'a [(usize, f64, f64)],
    /// The rates at which the robot went astray since the sample before if contacts slip; zero under statics, and where nothing
    /// moved.
    pub spread: SlipSpread,
    /// The angle by which the robot turned to settle, rad, at the start, and when a ground begins; `None` at other
    /// samples.
    pub settling: Option<f64>,
    /// The travel over the ground since the start, with its sensitivity to friction and servo stiffness; all 0 under
    /// statics.
    pub travel: TravelSummary,
}

/// A loss of support: the robot tips over an edge of its support polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct TipOver {
    /// The time at which the robot begins to fall over the edge, s, found by bisection up to the tolerance `time`.
    pub time: f64,
    /// The fall of the centre of mass, m, as the robot settles with the joints held at the sample that showed it.
    pub fall: f64,
    /// An upper bound on the motion of points about the centre of mass in the step that showed it, m.
    pub motion: f64,
    /// The numbers of the links at the two ends of the edge, one if they are the same; all supporting links if the
    /// support has no area.
    pub edge: Vec<usize>,
    /// True if an exemption excuses it.
    pub excused: bool,
    /// True if the robot falls onto the ground and not over an edge: it came off another above it.
    pub in_air: bool,
}
