//! Declarations to designs and robots.
//!
//! A declaration with its arguments is elaborated once to a design ([`instance`]): modules with their links,
//! joints and ports ([`module`]), configurations of modules ([`config`], [`connect`]), lattices of cells
//! ([`lattice`], [`facts`]), trusses ([`truss`]). The right wing gets them as robots ([`robot_of`]).

pub mod config;
pub mod connect;
pub mod connector;
pub mod facts;
pub mod hinge;
pub mod instance;
pub mod lattice;
pub mod module;
pub mod robot_of;
pub mod sweep;
pub mod truss;
