//! Folding: from a mesh of flat convex faces to the flat pattern that folds into it for the least energy, with
//! proof, and the order of folding. After "A Reconfiguration Strategy for Modular Robots using
//! Origami Folding" (Yao, Belke, Cui, Paik, IJRR); where it differs, the files say so.
//!
//! The entry is [`plan()`]. A *target* is a mesh that was checked, with its hinges. A *layout* is a spanning
//! tree of the faces, rooted at a face that keeps its pose. Units: metres, kilograms, radians, newtons; an
//! energy is the paper's sum of mean torques (N·m) for steps of one second, and goes with the inverse square
//! of the step's time.
//!
//! The stages of a plan: the task checks the problem; *proposals* are layouts from branch and bound
//! ([`branch_and_bound`], [`lagrangian`]), enumeration ([`enumerate`]), local search ([`local_search`]) or the
//! paper's heuristic ([`heuristic`]); the *evaluation* puts them before the judge in order of their value; where
//! none passes, layouts of strips ([`strip_layouts`]) and other orders ([`collision_free_order`]) are tried, and at last
//! orders in which hinges stop on their way.
#![allow(non_snake_case)]

// The problem and the answer.
mod observer;
mod open_node;
mod panel;
mod plan;
mod plate;
mod progress_text;
mod refusal;
mod report;
mod settings;
pub(crate) mod sheet;
mod tolerances;

// The target, its layouts and their costs.
pub mod inertia;
mod layout;
mod layout_sample;
mod objective;
pub mod polygon;
pub mod spanning_trees;
pub mod symmetry;
mod target;
mod unfoldable;
mod weights;

// Searches for layouts.
pub mod branch_and_bound;
pub mod edge_exchange;
pub mod enumerate;
mod frontier;
pub mod heuristic;
mod joint_search;
pub mod lagrangian;
pub mod local_search;
mod peak_torque;
pub mod shortest_paths;
mod spectrum;
pub mod strip_layouts;
mod tabu_unfolding;

// The flat pattern.
mod net;
pub mod pattern;

// Orders of folding.
mod carried_moments;
pub mod collision_free_order;
pub mod energy_order;
mod order_bounds;
mod order_descent;
pub mod random_orders;
pub mod steps;
pub mod turns;
pub mod work_order;

// Motion: kinematics, dynamics, collisions, the ground.
pub mod dynamics;
mod gravity_bounds;
mod ground_faces;
pub mod kinematics;
mod legendre;
mod load_limits;
pub mod simulation;
pub mod sweep_collision;
pub mod thickness;

// From proposals to a plan that the judge lets through.
mod evaluation;
mod joint_choice;
pub(crate) mod judgement;
mod proposals;
mod reordering;
mod stations;
mod task;

pub use branch_and_bound::{Optimum, Proof};
pub use ground_faces::Protrusion;
pub use layout::{Across, Layout};
pub use layout_sample::LayoutSample;
pub use legendre::Size;
pub use load_limits::{LoadLimits, Violation};
pub use net::{Edge, Net};
pub use objective::{Conventions, Effort, Minimise, Objective};
pub use observer::Observer;
pub use order_bounds::Orders;
pub use panel::{NotAPanel, Panel, Panels};
pub use plan::plan;
pub use plate::Plate;
pub use random_orders::Sample;
pub use refusal::{BestPattern, NoFolding, Refusal, Rejection, TorqueNeed};
pub use report::Report;
pub use settings::{MassModel, Method, Problem, Sequence, Settings};
pub use sheet::{NoHinge, Sheet};
pub use simulation::Count;
pub use spectrum::Spectrum;
pub use target::{Arc, FACES_MAX, Hinge, SIDES_MAX, Target};
pub use tolerances::{TOLERANCES, Tolerances};
pub use turns::Stop;
pub use unfoldable::Unfoldable;
pub use weights::Weights;
