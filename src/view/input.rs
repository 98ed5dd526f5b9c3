//! The input of the renderers.

use crate::plan::Plan;

/// The input of all renderers: a plan with the texts around it.
#[derive(Clone, Copy, Debug)]
pub struct RenderInput<'a> {
    /// The name of the robot, or of the other moving thing.
    pub title: &'a str,
    /// The plan. One without a verdict is shown as "not judged".
    pub plan: &'a Plan,
    /// The user's source files that the causes name, as (name, text); may be empty.
    pub texts: &'a [(String, String)],
    /// The command line that makes the same plan again; may be empty.
    pub command: &'a str,
}
