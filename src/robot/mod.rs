//! Modules, what they are made of, robots composed of them, and where everything is.
#![allow(non_snake_case)]

pub mod assembly;
pub mod library;
pub mod mass;
pub mod rofi;
pub mod rofi_assembly;
pub mod rofi_json;

pub mod inverse_kinematics;
pub mod jacobian;
pub mod kinematics;
pub mod matching;
pub mod step;
pub mod symmetry;
pub mod tree;
pub mod truss;
mod truss_band;

pub use assembly::{Assembly, Bond, JointId, JointOwner, ModuleInstance, PortRef, State};
pub use kinematics::{Kinematics, Residual};
pub use library::{
    Capture, Cell, Connector, Hinge, Joint, JointKind, Library, Limits, Link, ModuleType, Motor, Port, Strut,
};
pub use mass::Mass;
pub use matching::{Matching, Mismatch, matching};
pub use symmetry::{Symmetry, symmetries};
