//! The program as its users meet it: command line, session, pages, sites.

pub mod acceptance;
pub mod browser;
pub mod cli;
pub mod documentation;
pub mod documentation_again;
pub mod folders;
pub mod interrupt;
pub mod json;
pub mod plots;
pub mod repl;
pub mod scenes;
pub mod simulate;
pub mod simulation_page;
pub mod system;
pub mod tables;
pub mod transcripts;
pub mod view;
pub mod what;
