//! The configurations of the library that a robot holds, whose behaviours it can therefore execute.

use crate::check::typed::DefId;

/// A configuration that embeds in a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capability {
    /// The declaration of the configuration.
    pub def: DefId,
    /// The name of the configuration, with the arguments that differ from its defaults: `Walker14(bend: 5deg)`.
    pub name: String,
    /// The number of its embeddings in the robot, at least 1.
    pub embeddings: usize,
}

/// The answer to the question what the library can do with a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The name of the robot's design, with the arguments that differ from its defaults.
    pub robot: String,
    /// The number of modules of the robot.
    pub modules: usize,
    /// The configurations that embed: first the robot's own, then those of the standard library, by file and in the
    /// order of their declarations.
    pub configurations: Vec<Capability>,
}
