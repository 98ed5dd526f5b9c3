//! Modules and their parts, robots composed of them, and the kinematics and mass of robots.
//!
//! In reading order: declarations ([`Library`]) and the rules of sound ones ([`validation`]), robots and their
//! states ([`Assembly`], [`State`]), mass ([`mass`]), forward kinematics ([`Kinematics`]), the geometric Jacobian
//! ([`jacobian`]), inverse kinematics ([`inverse_kinematics`], and of one [`chain`]), inverse dynamics ([`dynamics`]) and forward dynamics
//! ([`articulated_bodies`], on [`spatial`] vectors), the isomorphism of two robots ([`matching()`]), embeddings of one in
//! another ([`embeddings`]), rigidity of trusses ([`truss`]) and the forces that hold them ([`truss_statics`]), and files of
//! RoFI modules ([`rofi`]).
#![allow(non_snake_case)]

mod assembly;
mod drive;
mod fault;
mod library;
pub mod mass;
pub mod validation;

pub mod chain;
mod kinematics;
mod step;
mod tree;

pub mod inverse_kinematics;
pub mod jacobian;

pub mod articulated_bodies;
pub mod dynamics;
pub mod spatial;

mod embedding;
mod matching;
mod mating;
mod symmetry;

mod banded_qr;
mod pinned_nodes;
mod rigidity_bounds;
mod sparse_rigidity;
pub mod truss;
mod truss_forces;
mod truss_layout;
mod truss_modes;
pub mod truss_statics;
mod truss_stiffness;

pub mod rofi;
pub mod rofi_assembly;
pub mod rofi_json;

pub use assembly::{
    Assembly, Bond, ClusterPose, JointId, JointOwner, Misalignment, ModuleInstance, PortRef, State,
};
pub use drive::{Drive, drives, motor_efforts};
pub use embedding::{EmbeddingAttempt, embeddings};
pub use fault::{LibraryFault, ModulePart};
pub use kinematics::{Kinematics, Residual, mate};
pub use library::{
    Capture, Cell, Connector, Hinge, Joint, JointKind, Library, Limits, Link, ModuleType, Motor, Port, Servo,
    Strut, Surface,
};
pub use mass::Mass;
pub use matching::{Matching, Mismatch, matching};
pub use mating::nearest_turn;
pub use step::{Motion, Step, driven};
pub use symmetry::{Symmetry, symmetries};
pub use tree::Tree;
