//! Plans and simulations as pictures: a page that plays them, still pictures and drawings.
//!
//! The room receives a plan with its verdict, or with a simulation of it, and returns text or bytes; it writes no files. The
//! data of a page is collected by `data` (the plan's own trajectories, thinned where there are too many), with what was
//! measured by `simulation`, and inserted between the style and the scripts of `page/` by [`page`]. The page computes the poses itself, by the
//! same kinematics as the judge; only the base pose on the ground is sampled, from the judge's own rollout.

mod input;
mod page;

mod columns;
mod data;
mod findings;
mod number;
mod simulation;
mod tolerances;

mod primitives;

mod fittings;
mod ground_pose;

mod models;
mod robot;
mod solids;

mod lattice;
mod truss;

mod framing;
mod light;
mod openness;
mod picture;
mod scene;

mod bodies;
mod colour;
mod mesh;
mod palette;
mod raster;

mod drawing;
mod markup;
mod surroundings;
mod svg;

mod graph;
mod layers;
mod pattern;
mod program;

pub mod plot;

pub use input::{RenderInput, title};

pub use models::{Triangle, link_colours, triangles};
pub use page::{live_page, page, page_name, simulation_page, still_data, target_page};
pub use picture::{PictureStyle, Side, StillOptions, frames, indexed_png, png};
pub use primitives::{Primitive, primitives};
pub use simulation::SimulationInput;
pub use surroundings::solids as surrounding_solids;
pub use svg::svg;
