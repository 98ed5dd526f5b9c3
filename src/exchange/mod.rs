//! Plans and robots in the formats of other programs, and robots of other programs as modules and configurations.
//!
//! A writer gets an [`Export`], a plan with its title and the stem of its file names, and returns whole files
//! ([`ExportFile`]), or the [`Refusal`] that says why there are none. To add a format, write its file and add its line to
//! [`PLAN_FORMATS`]: `save`, `modl export` and the bundle follow.
#![allow(non_snake_case)]

mod bundle;
mod cdr;
mod driving;
mod export;
mod gltf;
mod import_fault;
pub mod mapping;
mod module_text;
mod motion;
mod names;
mod pictures;
mod pieces;
mod plan_formats;
mod recording;
mod refusal;
mod ros_messages;
pub mod series;
mod smores;
mod trajectory;
mod urdf;
mod urdf_masses;
mod urdf_reader;
mod urdf_shapes;

pub use bundle::{FIRST_LINE, bundle};
pub use export::{Export, ExportFile};
pub use import_fault::ImportFault;
pub use module_text::{ImportFile, Imported};
pub use plan_formats::{PLAN_FORMATS, PlanFormat};
pub use refusal::Refusal;
pub use smores::{FaultIn, import};
pub use trajectory::{Trajectory, TrajectoryPoint, trajectories};
