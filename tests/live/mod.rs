//! Programs that are edited by their picture: changes of the text, the page's server, the page in a browser.

mod browser;
mod edits;
mod picture;
mod random;
mod served;
mod server;
