//! The typed tree of statements and expressions.

use super::typed::{DefId, Local, MemberId};
use super::types::Type;
use crate::source::{Span, Symbol};
use std::sync::Arc;

pub use crate::syntax::ast::{BinaryOp, UnaryOp};

/// Statements with the frame in which they run.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// The statements, in order.
    pub statements: Vec<Stmt>,
    /// The number of slots of the frame.
    pub frame: usize,
}

/// A `test` of the file that is run.
#[derive(Clone, Debug)]
pub struct Test {
    /// Its name.
    pub name: String,
    /// The span of the name.
    pub span: Span,
    /// Its statements.
    pub body: Body,
}

/// A statement with its span.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// The span of the statement.
    pub span: Span,
    /// Its kind.
    pub kind: StmtKind,
}

/// The kinds of statements.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// `let`; binds a local.
    Let { local: Local, value: Expr },
    /// An expression; its value may be printed.
    Expr(Expr),
    /// A test of a condition: `expect condition, message`.
    Expect { condition: Expr, message: Option<Expr> },
    /// A branch: `if`.
    If { condition: Expr, then: Vec<Stmt>, otherwise: Vec<Stmt> },
    /// A loop: `for`.
    For { binder: Local, iterable: Expr, body: Vec<Stmt> },
}

/// An expression with its type.
#[derive(Clone, Debug)]
pub struct Expr {
    /// The span of the expression.
    pub span: Span,
    /// Its type, fully resolved; [`Type::Error`] after a mistake.
    pub ty: Type,
    /// Its kind.
    pub kind: ExprKind,
}

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A mistake that has been reported.
    Error,
    /// A number in SI units; its dimension is in `ty`.
    Number(f64),
    /// A whole number that fits.
    Int(i64),
    /// A whole number of more digits.
    BigInt(Symbol),
    /// A truth value: `true`, `false`.
    Bool(bool),
    /// A text without interpolation.
    Text(Arc<str>),
    /// Pieces to be joined; values are shown as `print` shows them.
    Interpolation(Vec<Expr>),
    /// A word of a choice.
    Word(Symbol),
    /// `_`, or an argument left out that has no default: the missing value of an optional type.
    Missing,
    /// A local variable.
    Local(Local),
    /// A top-level `let`.
    Global(DefId),
    /// A function used as a value.
    FnValue(DefId),
    /// A behaviour used as a value: a function of its parameters.
    BehaviorValue { object: Box<Expr>, behavior: usize },
    /// The instance whose body this is.
    This,
    /// A member of an instance.
    Member { object: Box<Expr>, member: MemberId },
    /// A joint of a module instance; `joint` indexes [`ModuleDef::joints`](super::typed::ModuleDef::joints).
    Joint { object: Box<Expr>, joint: usize },
    /// A port or a port array of a module instance; `port` indexes
    /// [`ModuleDef::ports`](super::typed::ModuleDef::ports).
    Port { object: Box<Expr>, port: usize },
    /// The joint of the connection at a port.
    Hinge(Box<Expr>),
    /// A field of a record.
    Field { object: Box<Expr>, field: Symbol },
    /// A list: `[a, b]`.
    List(Vec<Expr>),
    /// A list comprehension: `[body for x in xs if c]`.
    Comprehension { body: Box<Expr>, clauses: Vec<Clause> },
    /// A vector: `[x, y, z]` where one is expected.
    Vec3(Box<[Expr; 3]>),
    /// A range: `from..to`.
    Range { from: Box<Expr>, to: Box<Expr> },
    /// A prefix operator with its operand.
    Unary { op: UnaryOp, operand: Box<Expr> },
    /// An infix operator with its operands.
    Binary { op: BinaryOp, left: Box<Expr>, right: Box<Expr> },
    /// `x else y` for an optional `x`.
    OrElse { value: Box<Expr>, otherwise: Box<Expr> },
    /// `move(..., timeout: 2s) else b` for behaviours.
    TimeoutElse { action: Box<Expr>, otherwise: Box<Expr> },
    /// Drops radians, so that the dimension is that of `ty`.
    DropRadians(Box<Expr>),
    /// An element of a list: `object[index]`.
    Index { object: Box<Expr>, index: Box<Expr> },
    /// A conditional expression: `if condition { then } else { otherwise }`.
    If { condition: Box<Expr>, then: Box<Expr>, otherwise: Option<Box<Expr>> },
    /// `{ statements value }`: a block; without `value` it has none.
    Block { statements: Vec<Stmt>, value: Option<Box<Expr>> },
    /// Runs in a frame of its own: the parameters are its first slots, and each capture copies a
    /// local of the frame where the lambda stands (first) to a slot of the new one (second).
    Lambda { captures: Vec<(Local, Local)>, params: usize, body: Arc<Expr>, frame: usize },
    /// A call of a user's function or a built-in; arguments in the order of the parameters. `None`:
    /// take the default.
    Call { def: DefId, args: Vec<Option<Expr>> },
    /// A call of a function value.
    CallValue { callee: Box<Expr>, args: Vec<Expr> },
    /// A call of a behaviour of an instance of a configuration.
    CallBehavior { object: Box<Expr>, behavior: usize, args: Vec<Option<Expr>> },
    /// An instance of a module, cell, strut, config, lattice or truss.
    Instance { def: DefId, args: Vec<Option<Expr>> },
}

/// A clause of a comprehension.
#[derive(Clone, Debug)]
pub enum Clause {
    /// A loop of a comprehension: `for x in iterable`.
    For { binder: Local, iterable: Expr },
    /// A filter of a comprehension: `if condition`.
    If(Expr),
}
