//! The input of the renderers.

use crate::plan::Plan;

/// Returns the title of a plan of a robot with this name: the name, or what turns into what, `Em → Ow`.
pub fn title(plan: &Plan, name: &str) -> String {
    let shapes = plan.provenance.shapes.as_ref();
    shapes.map_or_else(|| name.to_owned(), |(from, to)| format!("{from} → {to}"))
}

/// The input of all renderers: a plan with the texts that are shown around it.
#[derive(Clone, Copy, Debug)]
pub struct RenderInput<'a> {
    /// The name of the robot, lattice or truss, which is the title of the picture.
    pub title: &'a str,
    /// The plan that is drawn. One without a verdict is shown as "not judged".
    pub plan: &'a Plan,
    /// The source files that the plan's causes name, as (name, text), for the page to show; may be empty.
    pub texts: &'a [(String, String)],
    /// The command line that makes the same plan again, for the page to show; may be empty.
    pub command: &'a str,
}
