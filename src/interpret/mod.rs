//! Typed tree to values, effects and plans.
//!
//! The way through this room: [`run`] puts an evaluator on a stage of its own ([`stage`]), which
//! walks expressions ([`eval`], [`operators`], [`call`], [`statements`]) to values ([`value`]).
//! Declarations become designs ([`elaborate`], [`module`], [`config`], [`connect`], [`lattice`],
//! [`truss`]) and, for the right wing, robots ([`robot_of`]); behaviours become plans
//! ([`behavior`], [`planning`]), and what is wrong with these goes back to the lines that caused it
//! ([`causes`], [`verdicts`]). The built-ins ([`natives`]) are the only bridge between the wings.

pub mod host;

mod stage;
mod stop;
mod unwindings;
mod value;

mod eval;
mod interpreter;
mod operators;

mod call;
mod statements;

mod design;
mod elaborate;

mod cells;
mod connector;
mod facts;
mod hinge;
mod lattice;
mod module;
mod sweep;
mod truss;
mod truss_around;
mod truss_limits;

mod mesh_file;
mod obj;
mod off;
mod ply;
mod stl;
mod xyz;

mod config;
mod connect;
mod robot_of;

mod behavior;
mod causes;
mod joining;
mod planning;
mod record;
mod verdicts;

mod fold_clear;
mod fold_method;
mod fold_options;
mod fold_orders;
mod fold_panel;
mod fold_plan;
mod fold_sheet;
mod fold_supply;
mod folding;

mod natives;
mod natives_action;
mod natives_family;
mod natives_fold;
mod natives_list;
mod natives_math;
mod natives_plan;
mod natives_refold;
mod natives_robot;
mod natives_rofi;
mod natives_save;
mod natives_shape;
mod natives_show;
mod natives_squeeze;
mod natives_tosnake;
mod natives_truss;
mod show_value;

mod run;

mod portrait;
mod portrait_motion;
mod portrait_robot;
mod portrait_shape;
mod portrait_truss;
pub mod session;

pub use host::{Host, Limits, Mode, Options, Outcome, TestResult, WriteError};
pub use natives::{Native, all as all_natives};
pub use record::fields_of;
pub use run::run;
