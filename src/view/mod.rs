//! Plans as pictures: a page that plays a plan, and still pictures.
//!
//! The room is handed a plan with its verdict and gives back text or bytes; it writes no files. What
//! a page needs is gathered by [`data`] (the plan's own numbers, thinned where there are too many)
//! and put between the style and the scripts of `page/` by [`page`]. The page computes the poses
//! itself, from the same steps of kinematics that the judge uses; only where the ground carries the
//! robot is sampled, from the judge's own walk.

mod page;

mod data;
mod findings;
mod number;

mod primitives;

mod ground_pose;
mod robot;
mod solids;

mod lattice;
mod truss;

mod picture;

mod bodies;
mod colour;
mod mesh;
mod palette;
mod raster;

mod fold_format;

mod surroundings;
mod svg;

mod graph;
mod layers;
mod pattern;
mod program;

use crate::plan::Plan;

pub use fold_format::{Crease, CreasePattern, fold_file};
pub use page::{page, page_name};
pub use picture::{Side, StillOptions, png};
pub use svg::svg;

/// What is shown.
#[derive(Clone, Copy, Debug)]
pub struct RenderInput<'a> {
    /// Name of the robot, or of what else moves.
    pub title: &'a str,
    /// With the verdict it was given; `None` there is shown as "not judged".
    pub plan: &'a Plan,
    /// Texts of the user's own files that the causes name, as (name, text); may be empty.
    pub texts: &'a [(String, String)],
    /// The command that makes the same again; may be empty.
    pub command: &'a str,
}
