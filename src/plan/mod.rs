//! What a plan is, and the one judge of plans.
//!
//! A plan stands alone: the library it uses, its start, its body (one of three forms behind one
//! interface), its program, its events and causes, and the world it is judged under. The judge,
//! [`verify`](crate::plan), knows no planner.

pub mod polynomial;
pub mod time;

pub mod body;
pub mod lattice;
pub mod node_paths;
pub mod program;
pub mod ratio;
pub mod stages;
pub mod stretches;
pub mod tracks;
pub mod verdict;
pub mod verify;
pub mod visit;
pub mod world;

pub mod carry;
pub mod concat;
pub mod operation_error;
pub mod reverse;
mod seam;
pub mod slice;
pub mod timeline;

pub mod file;
mod finite;
mod form;
pub mod sound;
pub mod validate;

use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

pub use body::{Body, Snapshot};
pub use carry::Carrier;
pub use concat::joined;
pub use node_paths::{Interpolation, Keyframe, LengthSum, Margins, NodePaths, Surroundings, TrussLimits};
pub use operation_error::OperationError;
pub use program::{Action, Command, Compare, Condition, Node, Otherwise, Profile, Program, Signal, Target};
pub use ratio::Ratio;
pub use reverse::reversed;
pub use slice::sliced;
pub use stages::{CellBox, CellLimits, Counter, Law, Model, Run, Stage, Stages};
pub use timeline::timeline;
pub use tracks::{Dock, DockKind, Segment, Track, Tracks};
pub use verdict::{Check, CheckKind, Dynamics, Failure, Status, Verdict, Worst};
pub use world::{Exemption, ExemptionKind, Ground, Settings, Stability, World};

/// Names a cause in [`Plan::causes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct CauseId(pub u32);

/// What in the source commands a piece of motion, or sets a piece of the start pose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cause {
    /// Relative to the project root; `std/smores.mod` in the standard library.
    pub file: String,
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// The text of the line, without the blanks around it.
    pub text: String,
    /// Which instance, such as `i = 3` or `leg[2].m[0].tilt`; empty where there is only one.
    pub instance: String,
    /// The call in the user's own file that led here, where `file` is the library's.
    pub caller: Option<Box<Cause>>,
}

/// A verified motion of a robot, whatever made it.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub provenance: Provenance,
    /// In order of time; each part of a concatenation keeps the world it was planned for.
    pub worlds: Vec<WorldFrom>,
    pub settings: Settings,
    pub library: Arc<Library>,
    pub body: Body,
    /// What a position-servo robot executes; `None` for planned bodies without one.
    pub program: Option<Program>,
    /// Whether times depend on what sensors would say: then they hold for the undisturbed run.
    pub nominal: bool,
    pub causes: Vec<Cause>,
    pub exemptions: Vec<Exemption>,
    /// Of the last verification; recomputed whenever it matters.
    pub verdict: Option<Verdict>,
}

/// From when on which world holds; the first begins at 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldFrom {
    pub from: f64,
    pub world: World,
}

/// What made the plan.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// `behavior`, or the planner's name.
    pub planner: String,
    /// Name and SHA-256 of every source text, in order of name.
    pub sources: Vec<(String, String)>,
    pub seed: Option<u64>,
    pub budget: Option<u64>,
    /// What the planner proved of every plan for the same task; nothing of a plan changed since.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<Bound>,
    /// The tool that planned it, with its version: `modl 0.1.0`.
    pub tool: String,
    /// What was done to the plan since, in order.
    pub history: Vec<Change>,
}

/// A value that no plan for the same task is below.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Bound {
    /// Of the hinges that fold, J.
    FoldingEnergy(f64),
}

/// A change of a whole plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Change {
    Reversed,
    /// Only what lay between these times (s) was kept.
    Sliced {
        from: f64,
        to: f64,
    },
    /// Another plan was appended at a time (s).
    Joined {
        at: f64,
        /// What of the other plan's modules had another name here: (its name there, its name here).
        renamed: Vec<(String, String)>,
        /// How the other plan had been changed before.
        appended: Vec<Change>,
    },
    /// The program was given up, and why.
    ProgramDropped(String),
}
