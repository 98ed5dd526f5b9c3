//! How values are displayed: on one line, as `print` shows them ([`value`]), and as a session shows a result,
//! on several lines ([`pretty`]).

pub mod motion;
pub mod pretty;
pub mod robot;
pub mod shape;
pub mod truss;
pub mod value;
