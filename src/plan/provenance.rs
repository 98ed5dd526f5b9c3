//! The origin of a plan, and the changes to it since.

use super::fault::{PlanFault, need};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The origin of a plan: its planner and sources, and the changes since.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The name of the planner, such as `fold`; `behavior` for the plan of a behaviour.
    pub planner: String,
    /// The name and the SHA-256 (hexadecimal) of every source text, ascending by name.
    pub sources: Vec<(String, String)>,
    /// The names of what the robot is at the start and what it becomes, of a plan that turns one shape into another;
    /// `None` for other plans.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapes: Option<(String, String)>,
    /// The seed of the random numbers; `None` if the planner draws none.
    pub seed: Option<u64>,
    /// The limit that was set for the search, in the steps that the planner counts; `None` if none was.
    pub budget: Option<u64>,
    /// A lower bound that the planner proved for all plans that this one was chosen from; `None` if it proved none,
    /// and for a plan changed since.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<ObjectiveValue>,
    /// The value of the plan that the bound is about, not below it; `None` as for the bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reached: Option<ObjectiveValue>,
    /// The tool that planned the motion, with its version: `modl 0.1.0`.
    pub tool: String,
    /// The changes of the plan since it was made, in order of time.
    pub history: Vec<Change>,
}

/// A quantity that a planner minimised, with its value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ObjectiveValue {
    /// The sum of the mean torques of the hinges that fold, under the conventions of the call, N·m.
    FoldingEnergy(f64),
}

impl ObjectiveValue {
    /// Returns the value of the quantity, in its unit.
    pub fn value(self) -> f64 {
        let ObjectiveValue::FoldingEnergy(value) = self;
        value
    }
}

impl Provenance {
    /// Checks that the bound and the value reached are finite and not negative, and that the bound is not above the
    /// value.
    ///
    /// # Errors
    /// [`PlanFault::ObjectiveValue`] or [`PlanFault::BoundAbove`].
    pub(super) fn check(&self) -> Result<(), PlanFault> {
        let stated = [self.bound, self.reached].map(|stated| stated.map(ObjectiveValue::value));
        for value in stated.into_iter().flatten() {
            need(value.is_finite() && value >= 0.0, || PlanFault::ObjectiveValue { value })?;
        }
        let [Some(bound), Some(reached)] = stated else { return Ok(()) };
        need(bound <= reached, || PlanFault::BoundAbove { bound, reached })
    }
}

/// A change of a whole plan after it was made, as its history records it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Change {
    /// The plan runs from its end to its start.
    Reversed,
    /// The plan was cut to the interval between two times of the plan before.
    Sliced {
        /// The beginning of the interval, s.
        from: f64,
        /// The end of the interval, s.
        to: f64,
    },
    /// The motion goes along the same path in another time.
    Retimed {
        /// The duration of the plan before, s.
        before: f64,
        /// The fraction of the limits of torque that was to be left.
        reserve: f64,
    },
    /// Another plan was appended to this one.
    Joined {
        /// The time at which the other plan begins in this one, s.
        at: f64,
        /// The modules of the other plan with another name here: (name there, name here).
        renamed: Vec<(String, String)>,
        /// The changes that the other plan had undergone before.
        appended: Vec<Change>,
    },
    /// The program was dropped, for the reason given in words.
    ProgramDropped(String),
}
