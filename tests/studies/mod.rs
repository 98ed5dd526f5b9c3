//! Studies: samplers beside other implementations, searches on functions whose best is known, and the command.

mod command;
mod sampling;
