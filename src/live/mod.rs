//! Programs that are edited by their picture: what a page shows of a program while it is typed, and how a change that is made
//! in the picture becomes a change of the text.
//!
//! A [`Model`] is what a text shows: the robot as it is declared with the places of its parts in the text (`robot`), the values
//! that can be set (`parameter`, `joint`), the free ports with what mates there (`ports`), and the diagnostics. An [`Edit`] asks for a change: `edit`
//! answers with the replaced bytes, or with the reason why the text can't be changed in this way. A [`Document`] is a text with the model
//! of it, and the changes that can be undone. Nothing here touches files.

mod document;
mod edit;
mod history;
mod joint;
mod literal;
mod model;
mod parameter;
mod ports;
mod robot;

pub use document::{Document, Refusal};
pub use edit::{Edit, Setting};
pub use joint::Joint;
pub use literal::Written;
pub use model::Model;
pub use parameter::Parameter;
pub use ports::{FreePort, Offer};
pub use robot::{Mark, Module, Place, Robot};
