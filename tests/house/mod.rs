//! Documents and the rules of the house.

pub mod docs;
pub mod figures;
pub mod library_guide;
pub mod pages;
pub mod readme;
pub mod reference;
pub mod tidy;
pub mod tour;
pub mod words;
