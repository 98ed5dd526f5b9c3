//! Programs that are edited by their picture: changes of the text, and what is shown of it.

mod edits;
mod picture;
mod random;
