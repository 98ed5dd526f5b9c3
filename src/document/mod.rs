//! Documentation: declarations as a static site, and the examples in their comments.
//!
//! [`examples`] finds the programs that comments contain. [`outline`] makes of a checked program the pages
//! of its files, [`pictures`] draws what has instances, [`markdown`] resolves links, [`html`] writes it all
//! down.

pub(crate) mod examples;
mod html;
mod markdown;
mod outline;
mod pictures;
mod site;

pub use site::{Fault, Request, Site, site};
