//! modl: a language for robots that change shape.
//!
//! The flow of data, and the rooms in reading order; each knows only those above it: text ([`source`],
//! [`units`], [`interrupt`]) → tree ([`syntax`], and back to text: [`format`](mod@format)) → types
//! ([`check`]) → values ([`interpret`]) → plan ([`behavior`], [`planners`]) → verdict ([`plan`]) → file or
//! picture ([`view`]). See `docs/architecture.md`.

#![warn(unreachable_pub)]

pub mod interrupt;
pub mod source;
pub mod units;

pub mod syntax;

pub mod format;

pub mod check;

pub mod behavior;
pub mod geometry;
pub mod optimize;
pub mod plan;
pub mod planners;
pub mod robot;
pub mod simulate;
pub mod study;
pub mod view;

pub mod interpret;

pub mod formats;

pub mod exchange;

pub mod elaborate;

pub mod display;

pub mod natives;

pub mod execute;

pub mod document;
pub mod language_server;
pub mod live;
pub mod session;

pub mod cli;
