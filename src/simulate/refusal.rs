//! The reasons why a plan can't be simulated.

use super::Settings;
use crate::geometry::Unsound;
use crate::plan::PlanFault;
use crate::plan::forward_dynamics::ShapeFault;

/// The reason why a plan can't be simulated.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The plan is of a lattice or truss.
    Family,
    /// The plan is not valid.
    Invalid(PlanFault),
    /// The plan's program makes another motion than the plan; the first difference, in words.
    Unfaithful(String),
    /// The shape of a link is not sound.
    Shape(Unsound),
    /// The time step is not from [`Settings::STEP_MIN`] to [`Settings::STEP_MAX`].
    Step,
    /// The setting of this name is negative or not finite, or zero where it must be positive.
    Setting(&'static str),
    /// The ground can't be that of the simulation, for this reason in words.
    Terrain(&'static str),
    /// The obstacle of this number, from 1, can't be there, for this reason in words.
    Obstacle(usize, String),
    /// A joint or a base has no inertia to move, or values are no longer finite.
    NoInertia {
        /// The time from the start of the plan, s.
        time: f64,
    },
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Refusal::Family => f.write_str("only robots with joints are simulated, no lattices and trusses"),
            Refusal::Invalid(fault) => write!(f, "the plan is not sound: {fault}"),
            Refusal::Unfaithful(difference) => write!(f, "the plan is not sound: {difference}"),
            Refusal::Shape(fault) => write!(f, "the shape of a link is not sound: {fault}"),
            Refusal::Step => write!(
                f,
                "a time step must be from {}us to {}ms",
                Settings::STEP_MIN * 1e6,
                Settings::STEP_MAX * 1e3
            ),
            Refusal::Setting(name) => write!(f, "the {name} must be a number, and not below zero"),
            Refusal::Obstacle(number, why) => write!(f, "obstacle {number} {why}"),
            Refusal::Terrain(why) => f.write_str(why),
            Refusal::NoInertia { time } => {
                write!(f, "at {time:.3}s something moves that has no mass, or moves beyond all bounds")
            }
        }
    }
}

impl From<ShapeFault> for Refusal {
    fn from(fault: ShapeFault) -> Refusal {
        match fault {
            ShapeFault::Shape(fault) => Refusal::Shape(fault),
            ShapeFault::Obstacle(number, why) => Refusal::Obstacle(number, why),
        }
    }
}
