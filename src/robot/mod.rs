//! Modules, what they are made of, robots composed of them, and where everything is.

pub mod assembly;
pub mod library;

pub use assembly::{Assembly, Bond, JointId, JointOwner, ModuleInstance, PortRef, State};
pub use library::{
    Capture, Cell, Connector, Hinge, Joint, JointKind, Library, Limits, Link, ModuleType, Motor, Port, Strut,
};
