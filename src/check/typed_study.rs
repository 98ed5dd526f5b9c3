//! Studies of the typed tree.

use super::typed::{DefId, Expr};
use super::types::Type;
use crate::source::{Span, Symbol};

/// A study, `study`. Its axes are the first locals of the body: those in parentheses, then those after `each`.
#[derive(Clone, Debug)]
pub struct StudyDef {
    /// The axes that the sampler chooses, in order.
    pub axes: Vec<StudyAxis>,
    /// The axes after `each`, in order.
    pub each: Vec<StudyAxis>,
    /// The sampler with its settings.
    pub sampler: SamplerDef,
    /// The span of the sampler, from its name to the end of its settings.
    pub sampler_span: Span,
    /// The expression that gives the row of a point.
    pub body: Expr,
    /// The record that the rows are; `None` after a mistake.
    pub row: Option<DefId>,
    /// The number of slots of the frame in which body, domains and settings are evaluated.
    pub frame: usize,
}

/// An axis of a study.
#[derive(Clone, Debug)]
pub struct StudyAxis {
    /// The name of the axis, the first of its column in the table.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The type of a value of the axis.
    pub ty: Type,
    /// The list or range of the values, an expression.
    pub domain: Expr,
}

/// The sampler of a study, with its settings as expressions not yet evaluated.
#[derive(Clone, Debug)]
pub enum SamplerDef {
    /// All combinations: `grid(amplitude: 9)`, with the number of points of each axis that is a range, by the index of
    /// the axis.
    Grid(Vec<(usize, Expr)>),
    /// The points of a Sobol sequence: `sobol(256)`, with their number.
    Sobol(Expr),
    /// Independent points, evenly distributed: `random(256)`, with their number.
    Random(Expr),
    /// A search for the best row: `cmaes(maximise: speed, budget: 200)`.
    Cmaes {
        /// The field of the row that is sought, by its index among the fields of the record.
        objective: usize,
        /// True if the greatest value is best, false if the least is.
        maximise: bool,
        /// The number of points, an expression.
        budget: Expr,
    },
    /// A sampler with a reported mistake.
    Error,
}
