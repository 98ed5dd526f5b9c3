//! Folding: from a triangle mesh to the flat pattern that folds into it for the least energy, with
//! proof, and the order of folding. After "A Reconfiguration Strategy for Modular Robots using
//! Origami Folding" (Yao, Belke, Cui, Paik); where it differs, the files say so.
//!
//! A *target* is a mesh that was checked, with its hinges. A *layout* is a spanning tree of the
//! faces, hung up at a root face that stays where it is. Units: metres, kilograms, radians; an
//! energy is the paper's sum of mean torques (N·m) for steps of one second, and goes with the
//! inverse square of the step's time.
#![allow(non_snake_case)]

mod observer;
mod progress_text;
mod tolerances;

pub mod inertia;
pub mod layout;
pub mod spanning_trees;
pub mod target;
pub mod unfoldable;
pub mod weights;

pub mod branch_and_bound;
pub mod edge_exchange;
pub mod lagrangian;
pub mod shortest_paths;
pub mod symmetry;

pub mod net;
pub mod pattern;
pub mod tabu_unfolding;

pub mod enumerate;
pub mod heuristic;
pub mod local_search;
pub mod spectrum;

pub mod energy_order;
pub mod kinematics;
pub mod random_orders;
pub mod steps;
pub mod work_order;

pub mod dynamics;
pub mod gravity_bounds;
pub mod legendre;
pub mod objective;
pub mod peak_torque;
pub mod simulation;

pub mod collision_free_order;
pub mod ground_faces;
pub mod load_limits;
pub mod strip_layouts;
pub mod sweep_collision;
pub mod thickness;

mod panel;
mod plate;
pub(crate) mod sheet;

mod evaluation;
pub(crate) mod judgement;
mod plan;
mod proposals;
mod refusal;
mod reordering;
mod report;
mod settings;
mod task;

pub use branch_and_bound::{Optimum, Proof};
pub use layout::Layout;
pub use net::Net;
pub use objective::{Conventions, Effort, Minimise};
pub use observer::Observer;
pub use panel::{NotAPanel, Panel, Panels, equal_sides};
pub use plan::plan;
pub use plate::Plate;
pub use random_orders::Sample;
pub use refusal::{BestPattern, NoFolding, Refusal, Rejection, TorqueNeed};
pub use report::Report;
pub use settings::{MassModel, Method, Problem, Sequence, Settings};
pub use sheet::{NoHinge, Sheet};
pub use simulation::Count;
pub use target::{Hinge, Target};
pub use tolerances::{TOLERANCES, Tolerances};
pub use unfoldable::Unfoldable;
pub use weights::Weights;
