//! Folding: from a triangle mesh to the flat pattern that folds into it for the least energy, with
//! proof, and the order of folding. After "A Reconfiguration Strategy for Modular Robots using
//! Origami Folding" (Yao, Belke, Cui, Paik); where it differs, the files say so.
//!
//! A *target* is a mesh that was checked, with its hinges. A *layout* is a spanning tree of the
//! faces, hung up at a root face that stays where it is. Units: metres, kilograms, radians; an
//! energy is the paper's sum of mean torques (N·m) for steps of one second, and goes with the
//! inverse square of the step's time.
#![allow(non_snake_case)]

pub mod target;
pub mod unfoldable;

pub mod count;
pub mod inertia;
pub mod layout;
pub mod weights;

pub mod lagrange;
pub mod local;
pub mod routes;
pub mod symmetry;

pub mod flatten;
pub mod pattern;

pub mod exact;

pub mod enumerate;
pub mod spectrum;

pub mod heuristic;

pub mod folded;
pub mod order;
pub mod order_energy;
pub mod steps;

pub mod dynamics;
pub mod series;
pub mod simulation;

pub mod lift;
pub mod peak;

pub mod objective;
pub mod survey;

pub mod burden;
pub mod clearing;
pub mod closing;
pub mod meeting;
pub mod passage;
pub mod sampling;
pub mod standing;

pub mod net;
pub mod plane;
pub mod rearrange;
pub mod refold;

mod words;

pub use exact::{Optimum, Proof};
pub use layout::Layout;
pub use net::Net;
pub use target::{Hinge, Target};
pub use unfoldable::Unfoldable;
pub use weights::Weights;
