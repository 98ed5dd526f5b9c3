//! Documentation: declarations as a static site, and the examples in their comments.
//!
//! `examples` finds the programs in comments. `outline` makes pages of the files of a checked program,
//! `pictures` renders instances, `manual` makes pages of the texts about modl itself, `markdown` resolves links, `html` and `front`
//! write the pages, `search` the index of their words.

pub(crate) mod examples;
mod front;
mod html;
mod manual;
mod markdown;
mod outline;
mod pictures;
mod search;
mod site;

pub use manual::{Manual, page_of_code};
pub use pictures::{Drawing, Sources, digest};
pub use site::{LinkFault, Request, Site, site};
