//! Text to tree. Parsing never fails: it returns a tree, the comments and diagnostics.

pub mod ast;
mod build;
mod build_config;
mod build_expr;
mod build_items;
mod build_module;
mod build_statements;
mod build_text;
mod build_truss;
mod build_types;
mod characters;
mod explain;
mod failure;
mod habits;
mod highlight;
mod lex;
mod outline;
mod parse;
mod quotient;
mod record_mistakes;
mod recover;
mod scan;
mod split;
mod text_mistakes;
mod words;

pub use highlight::{Class, classes};
pub use lex::{Token, TokenKind};
pub use outline::{Chunk, Outline, Role, Skeleton, skeleton};
pub use parse::{DIAGNOSTICS_MAX, HEIGHT_MAX, NESTING_MAX, Parsed, TEXT_MAX, breaks_off, parse, too_large};
pub use words::{CONFIG, DECLARING, ITEMS, MODULE, RESERVED, STATEMENTS, TRUSS};
