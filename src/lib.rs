//! modl: a language for robots that change shape.
//!
//! The flow of data, and the rooms in reading order; each knows only those above it: text ([`source`],
//! [`units`], [`interrupt`]) → tree ([`syntax`], and back to text: [`format`](mod@format)) → types
//! ([`check`]) → values ([`interpret`]) → plan ([`behavior`], [`planners`]) → verdict ([`plan`]) → file or
//! picture ([`view`]). See `docs/architecture.md`.

#![warn(unreachable_pub)]

pub mod interrupt;
pub mod source;
#[warn(missing_docs)]
pub mod units;

pub mod syntax;

pub mod format;

pub mod check;

#[warn(missing_docs)]
pub mod behavior;
#[warn(missing_docs)]
pub mod geometry;
#[warn(missing_docs)]
pub mod optimize;
#[warn(missing_docs)]
pub mod plan;
#[warn(missing_docs)]
pub mod planners;
#[warn(missing_docs)]
pub mod robot;
#[warn(missing_docs)]
pub mod view;

pub mod interpret;

#[warn(missing_docs)]
pub mod formats;

pub mod elaborate;

pub mod display;

pub mod natives;

pub mod execute;

pub mod document;
pub mod session;

pub mod cli;
