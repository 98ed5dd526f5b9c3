//! Causes: the positions in the source that command a piece of motion or set a piece of the start pose.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a cause, from 0, in the list `causes` of its plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct CauseId(pub u32);

/// A position in the source that commands a piece of motion, or sets a piece of the start pose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cause {
    /// The path of the file, relative to the project root; `std/smores.mod` in the standard library.
    pub file: String,
    /// The line of the cause in its file, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
    /// The text of the cause's line, without the blanks around it.
    pub text: String,
    /// The instance of the command where one line commands several, such as `i = 3` or `leg[2].m[0].tilt`; empty if
    /// there is only one.
    pub instance: String,
    /// The call in the user's own file that led to this cause; `None` if `file` itself is the user's.
    pub caller: Option<Box<Cause>>,
}

impl Cause {
    /// Returns the cause that stands for the call of a planner until the caller, who alone knows its
    /// position, puts its own in.
    pub fn planner_call() -> Cause {
        Cause {
            file: String::new(),
            line: 1,
            column: 1,
            text: String::new(),
            instance: String::new(),
            caller: None,
        }
    }
}
