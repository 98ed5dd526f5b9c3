//! Forward dynamics of articulated robots: rigid bodies whose servos follow commands, with contact and friction, step by
//! step. `simulate` plays plans with it; the judge takes from it the travel of robots that scrub.
//!
//! In reading order: the robot as trees of bodies with servos (`model`), what a plan commands (`planned`), the time steps
//! (`stepper`), the force of a contact (`contact`), contacts with the ground (`ground_contact`) and between links
//! (`link_contact`), and what couples bodies besides joints (`coupling`). The method is that of articulated bodies
//! ([`crate::robot::articulated_bodies`]) with all springs and dampers at the end of the step.
#![allow(non_snake_case)]

mod contact;
mod coupling;
mod ground_contact;
mod link_contact;
mod model;
mod parameters;
mod planned;
mod settings;
mod stepper;

pub(crate) use coupling::Couplings;
pub(crate) use ground_contact::GroundContacts;
pub(crate) use link_contact::{LinkContacts, ShapeFault};
pub(crate) use model::{Joint, Model};
pub(crate) use parameters::PARAMETERS;
pub(crate) use planned::Planned;
pub use settings::{ServoGains, Settings};
pub(crate) use stepper::Stepper;
