//! Programs that are edited by their picture: changes of the text, what is shown of it, and the page's server.

mod edits;
mod picture;
mod random;
mod served;
mod server;
