//! Documentation: declarations as a static site, and the examples in their comments.
//!
//! `examples` finds the programs in comments. `outline` makes pages of the files of a checked program,
//! `pictures` renders instances, `markdown` resolves links, `html` writes the pages.

pub(crate) mod examples;
mod html;
mod markdown;
mod outline;
mod pictures;
mod site;

pub use pictures::{Drawing, Sources, digest};
pub use site::{LinkFault, Request, Site, site};
