//! The typed tree of statements and expressions.

use super::typed::{DefId, Local, MemberId};
use super::types::Type;
use crate::source::{Span, Symbol};
use std::sync::Arc;

pub use crate::syntax::ast::{BinaryOp, UnaryOp};

/// Statements, with the number of slots for local variables that they need.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// The statements, in order.
    pub statements: Vec<Stmt>,
    /// The number of slots, each of which holds one local variable, in the frame in which the statements run.
    pub frame: usize,
}

/// A `test` of the file that is run.
#[derive(Clone, Debug)]
pub struct Test {
    /// The name of the test.
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
    /// The kind of statement.
    pub kind: StmtKind,
}

/// A statement by its keyword, checked: its locals have slots, and its expressions types.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A definition, which binds a local: `let name = value`.
    Let {
        /// The local that holds the value.
        local: Local,
        /// The value.
        value: Expr,
    },
    /// An expression; its value may be printed.
    Expr(Expr),
    /// A test of a condition: `expect condition, message`, or `require` among statements.
    Expect {
        /// The condition that the test expects to hold.
        condition: Expr,
        /// The message if it does not hold, a text; `None` if none is written.
        message: Option<Expr>,
    },
    /// A branch: `if`.
    If {
        /// The condition.
        condition: Expr,
        /// The statements if the condition holds.
        then: Vec<Stmt>,
        /// The statements if it does not; empty without `else`.
        otherwise: Vec<Stmt>,
    },
    /// A loop: `for`.
    For {
        /// The local that holds the element.
        binder: Local,
        /// The list or range that the loop goes through.
        iterable: Expr,
        /// The statements of the loop.
        body: Vec<Stmt>,
    },
}

/// An expression with its type.
#[derive(Clone, Debug)]
pub struct Expr {
    /// The span of the expression.
    pub span: Span,
    /// Its type, fully resolved; [`Type::Error`] after a mistake.
    pub ty: Type,
    /// The kind of expression.
    pub kind: ExprKind,
}

/// An expression by what is to be evaluated: names are resolved to locals, declarations and members, numbers are in SI
/// units.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A mistake that has been reported.
    Error,
    /// A finite number in SI units; its dimension is in `ty`.
    Number(f64),
    /// A whole number that fits in 64 bits.
    Int(i64),
    /// A whole number that does not fit, by its decimal digits.
    BigInt(Symbol),
    /// A truth value: `true`, `false`.
    Bool(bool),
    /// A text without interpolation.
    Text(Arc<str>),
    /// A text with values: its pieces in order, texts and values, which are shown as `print` shows them.
    Interpolation(Vec<Expr>),
    /// A quantity, or a list or vector of them, as text.
    Shown {
        /// The quantities.
        value: Box<Expr>,
        /// The unit, by its name and its factor to SI; `None`: one that suits the value.
        unit: Option<(Arc<str>, f64)>,
        /// The number of decimals; `None`: as `print` shows them.
        decimals: Option<usize>,
    },
    /// A word of a choice.
    Word(Symbol),
    /// The missing value of an optional type: `_`.
    Missing,
    /// A local variable.
    Local(Local),
    /// The value of a top-level `let`.
    Global(DefId),
    /// A function used as a value.
    FnValue(DefId),
    /// A behaviour used as a value: a function of its parameters.
    BehaviorValue {
        /// The instance of a configuration.
        object: Box<Expr>,
        /// The index in [`ConfigDef::behaviors`](super::typed::ConfigDef::behaviors).
        behavior: usize,
    },
    /// The instance whose body this is.
    This,
    /// A member of an instance.
    Member {
        /// The instance.
        object: Box<Expr>,
        /// The member of its declaration.
        member: MemberId,
    },
    /// A joint of a module instance.
    Joint {
        /// The module instance.
        object: Box<Expr>,
        /// The index in [`ModuleDef::joints`](super::typed::ModuleDef::joints).
        joint: usize,
    },
    /// A port or a port array of a module instance.
    Port {
        /// The module instance.
        object: Box<Expr>,
        /// The index in [`ModuleDef::ports`](super::typed::ModuleDef::ports).
        port: usize,
    },
    /// The joint of the connection at a port.
    Hinge(Box<Expr>),
    /// A field of a record, or the part of a vector (`x`), a range (`from`) or a pose (`position`).
    Field {
        /// The value.
        object: Box<Expr>,
        /// The name of the field; that of a record may be inherited.
        field: Symbol,
    },
    /// A record that is built of its fields.
    Record {
        /// The declaration.
        def: DefId,
        /// The values of the fields, in the order of the declaration; `None`: the default.
        fields: Vec<Option<Expr>>,
    },
    /// A changed copy of a record: `d with { bend: 40deg }`.
    With {
        /// The record.
        object: Box<Expr>,
        /// The fields that change as (index in the declaration, value), in the order of the text.
        fields: Vec<(usize, Expr)>,
    },
    /// A list: `[a, b]`.
    List(Vec<Expr>),
    /// A list comprehension: `[body for x in xs if c]`.
    Comprehension {
        /// The expression for each element.
        body: Box<Expr>,
        /// The clauses, in order; the first is a loop.
        clauses: Vec<Clause>,
    },
    /// A vector: `[x, y, z]` where one is expected.
    Vec3(Box<[Expr; 3]>),
    /// A range: `from..to`.
    Range {
        /// The first end.
        from: Box<Expr>,
        /// The second end.
        to: Box<Expr>,
    },
    /// A prefix operator with its operand.
    Unary {
        /// The operator.
        op: UnaryOp,
        /// The operand.
        operand: Box<Expr>,
    },
    /// An infix operator with its operands.
    Binary {
        /// The operator.
        op: BinaryOp,
        /// The left operand.
        left: Box<Expr>,
        /// The right operand.
        right: Box<Expr>,
    },
    /// An optional value with one for the case that it is missing: `x else y`.
    OrElse {
        /// The value that may be missing.
        value: Box<Expr>,
        /// The value in its place; it is evaluated only then.
        otherwise: Box<Expr>,
    },
    /// An action with a behaviour for the case that its time runs out: `move(..., timeout: 2s) else b`.
    TimeoutElse {
        /// The action with a timeout.
        action: Box<Expr>,
        /// The behaviour that follows if the time runs out.
        otherwise: Box<Expr>,
    },
    /// A value whose quantities get the dimensions of `ty`, those in lists, vectors and ranges, too: radians are
    /// dropped, and an energy becomes a torque or a torque an energy; the numbers stay.
    SetDimension(Box<Expr>),
    /// An element of a list or a vector: `object[index]`.
    Index {
        /// The list or vector.
        object: Box<Expr>,
        /// The index, a whole number counted from 0.
        index: Box<Expr>,
    },
    /// A conditional expression: `if condition { then } else { otherwise }`.
    If {
        /// The condition.
        condition: Box<Expr>,
        /// The value if the condition holds.
        then: Box<Expr>,
        /// The value if it does not; the checker refuses an `if` without one.
        otherwise: Option<Box<Expr>>,
    },
    /// A block of statements that may end with a value: `{ statements value }`.
    Block {
        /// The statements before the value, in order.
        statements: Vec<Stmt>,
        /// The expression that ends the block; `None` if a statement does, or if it is empty.
        value: Option<Box<Expr>>,
    },
    /// An anonymous function, `x => e`. It runs in a frame of its own, whose first slots are the
    /// parameters.
    Lambda {
        /// The captured variables: each first local, of the frame around the lambda, is copied to the
        /// second.
        captures: Vec<(Local, Local)>,
        /// The number of parameters.
        params: usize,
        /// The result.
        body: Arc<Expr>,
        /// The number of slots of its frame.
        frame: usize,
    },
    /// A call of a user's function or a built-in.
    Call {
        /// The function.
        def: DefId,
        /// The arguments in the order of the parameters. `None`: take the default.
        args: Vec<Option<Expr>>,
    },
    /// A call of a function value.
    CallValue {
        /// The function value.
        callee: Box<Expr>,
        /// The arguments, in order, one for each parameter.
        args: Vec<Expr>,
    },
    /// A call of a behaviour of an instance of a configuration.
    CallBehavior {
        /// The instance of a configuration.
        object: Box<Expr>,
        /// The index in [`ConfigDef::behaviors`](super::typed::ConfigDef::behaviors).
        behavior: usize,
        /// The arguments in the order of the parameters. `None`: take the default.
        args: Vec<Option<Expr>>,
    },
    /// An instance of a module, cell, strut, config, lattice or truss.
    Instance {
        /// The declaration.
        def: DefId,
        /// The arguments in the order of the parameters. `None`: take the default.
        args: Vec<Option<Expr>>,
    },
}

/// A clause of a list comprehension: a loop over a list or range, or a filter.
#[derive(Clone, Debug)]
pub enum Clause {
    /// A loop of a comprehension: `for x in iterable`.
    For {
        /// The local that holds the element.
        binder: Local,
        /// The list or range that the loop goes through.
        iterable: Expr,
    },
    /// A filter of a comprehension: `if condition`.
    If(Expr),
}
