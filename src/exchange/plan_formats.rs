//! The formats in which plans are exported.

use super::export::{Export, ExportFile};
use super::refusal::Refusal;
use super::{driving, gltf, pictures, recording, series, trajectory, urdf};
use crate::formats::mjcf;
use crate::plan::validation;

/// A format in which plans are exported, with its writer.
pub struct PlanFormat {
    /// The name of the format, as after `--to`.
    pub name: &'static str,
    /// The ending of the names of its files, without the first dot.
    pub ending: &'static str,
    /// The contents of the files, in a few words.
    pub says: &'static str,
    /// True if the files state a motion that a robot could execute: of a plan that failed there are none.
    pub is_motion: bool,
    write: fn(&Export) -> Result<Vec<ExportFile>, Refusal>,
}

/// The formats in which plans are exported, in the order of the bundle.
pub const PLAN_FORMATS: &[PlanFormat] = &[
    PlanFormat {
        name: "mjcf",
        ending: mjcf::ENDING,
        says: "a model for MuJoCo, with its controls and docking events as tables",
        is_motion: false,
        write: driving::write,
    },
    PlanFormat {
        name: "urdf",
        ending: "urdf",
        says: "a robot description for ROS, one for each topology",
        is_motion: false,
        write: urdf::write,
    },
    PlanFormat {
        name: "trajectory",
        ending: "trajectory.yaml",
        says: "trajectory_msgs/JointTrajectory as YAML, one for each topology",
        is_motion: true,
        write: trajectory::write_yaml,
    },
    PlanFormat {
        name: "trajectory-json",
        ending: "trajectory.json",
        says: "trajectory_msgs/JointTrajectory as JSON, one for each topology",
        is_motion: true,
        write: trajectory::write_json,
    },
    PlanFormat {
        name: "csv",
        ending: "csv",
        says: "the positions of all joints over time",
        is_motion: true,
        write: series::write,
    },
    PlanFormat {
        name: "glb",
        ending: "glb",
        says: "an animated scene in glTF, for Blender",
        is_motion: false,
        write: gltf::write,
    },
    PlanFormat {
        name: "mcap",
        ending: "mcap",
        says: "a recording of ROS messages, for Foxglove and Rerun",
        is_motion: true,
        write: recording::write,
    },
    PlanFormat {
        name: "gif",
        ending: "gif",
        says: "a moving picture",
        is_motion: false,
        write: pictures::write_gif,
    },
    PlanFormat {
        name: "frames",
        ending: "frames",
        says: "numbered pictures in PNG, 10 for each second",
        is_motion: false,
        write: pictures::write_frames,
    },
];

impl PlanFormat {
    /// Returns the files of a plan in this format; the same plan gives the same files.
    ///
    /// # Errors
    /// The [`Refusal`] that keeps the plan from the format.
    pub fn write(&self, export: &Export) -> Result<Vec<ExportFile>, Refusal> {
        validation::check(export.plan).map_err(Refusal::Invalid)?;
        (self.write)(export)
    }

    /// Returns the format of this name; `None` if none has it.
    pub fn named(name: &str) -> Option<&'static PlanFormat> {
        PLAN_FORMATS.iter().find(|format| format.name == name)
    }

    /// Returns (format, stem) of the format whose ending a file name has, and the name without it: that of the longest
    /// ending; `None` if no format has it.
    pub fn of_file(name: &str) -> Option<(&'static PlanFormat, &str)> {
        let stem = |format: &PlanFormat| name.strip_suffix(format.ending)?.strip_suffix('.');
        let fits = PLAN_FORMATS.iter().filter_map(|format| Some((format, stem(format)?)));
        fits.min_by_key(|(_, stem)| stem.len())
    }
}
