//! The places of a scene's parts, its obstacles, and the world of its plans.

use crate::geometry::{Placed, Pose};
use crate::plan::World;
use crate::source::{Span, Symbol};
use std::cell::{Cell as Flag, RefCell};

/// The place of a part of a scene, with its position in the source.
#[derive(Clone)]
pub struct Place {
    /// The world pose of the body of the part's base module, before the robot settles, m.
    pub pose: Pose,
    /// The span of the clause `at`.
    pub span: Span,
}

/// A scene beside its parts and connections, filled in order while its body is elaborated.
#[derive(Default)]
pub struct SceneDesign {
    /// The obstacles, in the order of the clauses.
    pub obstacles: RefCell<Vec<ObstacleRecord>>,
    /// The world that plans of the scene assume; `None` where none is stated.
    pub world: Flag<Option<World>>,
}

/// An obstacle of a scene, with its position in the source.
#[derive(Clone)]
pub struct ObstacleRecord {
    /// The name of the obstacle: `wall`, or `post[3]` in an array.
    pub name: String,
    /// The shapes whose union the obstacle is, in the world's frame, m.
    pub shapes: Vec<Placed>,
    /// The name of the array, or of the single obstacle.
    pub group: Symbol,
    /// The index in the array, from 0; 0 for a single obstacle.
    pub index: i64,
    /// The span of the name in the clause.
    pub span: Span,
}
