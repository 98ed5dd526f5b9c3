//! The typed tree of statements and expressions.

use super::typed::{DefId, Local, MemberId};
use super::types::Type;
use crate::source::{Span, Symbol};
use std::sync::Arc;

pub use crate::syntax::ast::{BinaryOp, UnaryOp};

/// Statements, with the number of slots for local variables that they need.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// The statements, in the order in which they are executed.
    pub statements: Vec<Stmt>,
    /// The number of slots, each of which holds one local variable, in the frame in which the statements run.
    pub frame: usize,
}

/// A checked `test` of the file that is run.
#[derive(Clone, Debug)]
pub struct Test {
    /// The name of the test, as `modl test` shows it.
    pub name: String,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The statements that the test executes.
    pub body: Body,
}

/// A checked statement, with its span.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// The span of the statement in the source text.
    pub span: Span,
    /// The kind of the statement, with its parts.
    pub kind: StmtKind,
}

/// A statement by its keyword, checked: its locals have slots, and its expressions types.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A definition, which binds a local: `let name = value`.
    Let {
        /// The local that holds the value.
        local: Local,
        /// The expression that gives the value.
        value: Expr,
    },
    /// An expression; its value may be printed.
    Expr(Expr),
    /// A test of a condition: `expect condition, message`, or `require` among statements.
    Expect {
        /// The condition that the test expects to hold.
        condition: Expr,
        /// The message if the condition does not hold, a text; `None` if none is written.
        message: Option<Expr>,
    },
    /// A contract of a behaviour, in its own block, which is judged when the behaviour is used.
    Contract(Arc<Contract>),
    /// A branch of statements: `if condition { ... } else { ... }`.
    If {
        /// The condition, an expression of type `Bool`.
        condition: Expr,
        /// The statements that are executed if the condition holds, in order.
        then: Vec<Stmt>,
        /// The statements that are executed if the condition does not hold; empty without `else`.
        otherwise: Vec<Stmt>,
    },
    /// A loop of statements: `for name in iterable { ... }`.
    For {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The statements that each pass of the loop carries out, in order.
        body: Vec<Stmt>,
    },
}

/// A contract of a behaviour, judged at each of its uses: `require condition, message` on the state in which it begins, or
/// `ensure condition, message` on its end and its own interval.
#[derive(Clone, Debug)]
pub struct Contract {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The kind of the contract, which says who is to blame.
    pub kind: ContractKind,
    /// The condition that must hold, an expression of type `Bool`.
    pub condition: Expr,
    /// The message if the condition does not hold, a text; `None` if none is written.
    pub message: Option<Expr>,
    /// The local that holds the state in which the behaviour begins; `None` where a name of the program takes its place.
    pub start: Option<Local>,
    /// The local that holds the state in which the behaviour ends; `None` for a requirement.
    pub end: Option<Local>,
    /// The local that holds the report on the behaviour's own interval; `None` for a requirement.
    pub report: Option<Local>,
}

/// A kind of contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContractKind {
    /// A requirement on the state in which a behaviour begins: its caller is to blame.
    Require,
    /// A statement of what a behaviour brings about: the behaviour is to blame.
    Ensure,
}

impl ContractKind {
    /// Returns the keyword of the clause.
    pub fn word(self) -> &'static str {
        match self {
            ContractKind::Require => "require",
            ContractKind::Ensure => "ensure",
        }
    }
}

/// A checked expression, with its type and span.
#[derive(Clone, Debug)]
pub struct Expr {
    /// The span of the expression in the source text.
    pub span: Span,
    /// The type of the expression, fully resolved; [`Type::Error`] after a mistake.
    pub ty: Type,
    /// The kind of the expression, with its parts.
    pub kind: ExprKind,
}

/// An expression by what is to be evaluated: names are resolved to locals, declarations and members, numbers are in SI
/// units.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A mistake in the source that has been reported.
    Error,
    /// A finite number in SI units; its dimension is in `ty`.
    Number(f64),
    /// A whole number that fits in 64 bits.
    Int(i64),
    /// A whole number that does not fit in 64 bits, by its decimal digits.
    BigInt(Symbol),
    /// A truth value: `true` or `false`.
    Bool(bool),
    /// A text without interpolated values.
    Text(Arc<str>),
    /// A text with values: its pieces in order, texts and values, which are shown as `print` shows them.
    Interpolation(Vec<Expr>),
    /// A quantity, or a list or vector of them, shown as text in a stated form.
    Shown {
        /// The expression of the quantity, or of the list or vector of quantities.
        value: Box<Expr>,
        /// The unit in which the quantities are shown, as (name, factor to SI); `None`: one that suits the value.
        unit: Option<(Arc<str>, f64)>,
        /// The number of decimals; `None`: as `print` shows them.
        decimals: Option<usize>,
    },
    /// A word of a choice, such as `auto`.
    Word(Symbol),
    /// The missing value of an optional type: `_`.
    Missing,
    /// The value of a local variable, by its slot in the frame.
    Local(Local),
    /// The value of a top-level `let`, by the identity of its declaration.
    Global(DefId),
    /// A declared function used as a value, by the identity of its declaration.
    FnValue(DefId),
    /// A behaviour used as a value: a function of its parameters.
    BehaviorValue {
        /// The expression of the instance of a configuration.
        object: Box<Expr>,
        /// The index of the behaviour in [`ConfigDef::behaviors`](super::typed::ConfigDef::behaviors).
        behavior: usize,
    },
    /// The instance whose body the expression is in: `This`.
    This,
    /// A member of an instance, named in its declaration.
    Member {
        /// The expression of the instance.
        object: Box<Expr>,
        /// The member, by its index in the declaration of the instance.
        member: MemberId,
    },
    /// A joint of a module instance, by its index in the module's declaration.
    Joint {
        /// The expression of the module instance.
        object: Box<Expr>,
        /// The index of the joint in [`ModuleDef::joints`](super::typed::ModuleDef::joints).
        joint: usize,
    },
    /// A port or a port array of a module instance.
    Port {
        /// The expression of the module instance.
        object: Box<Expr>,
        /// The index of the port in [`ModuleDef::ports`](super::typed::ModuleDef::ports).
        port: usize,
    },
    /// The joint of the connection at a port.
    Hinge(Box<Expr>),
    /// A field of a record, or the part of a vector (`x`), a range (`from`) or a pose (`position`).
    Field {
        /// The expression of the record, vector, range or pose.
        object: Box<Expr>,
        /// The name of the field; that of a record may be inherited.
        field: Symbol,
    },
    /// A record that is built of its fields.
    Record {
        /// The declaration of the record that is built.
        def: DefId,
        /// The values of the fields, in the order of the declaration; `None`: the default.
        fields: Vec<Option<Expr>>,
    },
    /// A changed copy of a record: `d with { bend: 40deg }`.
    With {
        /// The expression of the record.
        object: Box<Expr>,
        /// The fields that change as (index in the declaration, value), in the order of the text.
        fields: Vec<(usize, Expr)>,
    },
    /// A list of its elements, in order: `[a, b]`.
    List(Vec<Expr>),
    /// A list comprehension: `[body for x in xs if c]`.
    Comprehension {
        /// The expression that is evaluated for each element.
        body: Box<Expr>,
        /// The clauses, in order; the first is a loop.
        clauses: Vec<Clause>,
    },
    /// A vector: `[x, y, z]` where one is expected.
    Vec3(Box<[Expr; 3]>),
    /// A range of numbers or quantities: `from..to`.
    Range {
        /// The expression of the first end.
        from: Box<Expr>,
        /// The expression of the second end.
        to: Box<Expr>,
    },
    /// A prefix operator, such as `-` or `not`, with its operand.
    Unary {
        /// The operator between or before the operands.
        op: UnaryOp,
        /// The expression of the operand.
        operand: Box<Expr>,
    },
    /// An infix operator, such as `+` or `and`, with its two operands.
    Binary {
        /// The operator between or before the operands.
        op: BinaryOp,
        /// The expression of the operand before the operator.
        left: Box<Expr>,
        /// The expression of the operand after the operator.
        right: Box<Expr>,
    },
    /// An optional value with one for the case that it is missing: `x else y`.
    OrElse {
        /// The expression whose value may be missing.
        value: Box<Expr>,
        /// The expression of the value in its place, which is evaluated only then.
        otherwise: Box<Expr>,
    },
    /// An action with a behaviour for the case that its time runs out: `move(..., timeout: 2s) else b`.
    TimeoutElse {
        /// The expression of the action, which has a timeout.
        action: Box<Expr>,
        /// The behaviour that follows if the time runs out.
        otherwise: Box<Expr>,
    },
    /// A value whose quantities get the dimensions of the expression's type, those in lists, vectors and ranges, too:
    /// radians are dropped, and an energy becomes a torque or a torque an energy; the numbers stay.
    SetDimension(Box<Expr>),
    /// An element of a list or a vector: `object[index]`.
    Index {
        /// The expression of the list or vector.
        object: Box<Expr>,
        /// The expression of the index, a whole number counted from 0.
        index: Box<Expr>,
    },
    /// A conditional expression: `if condition { then } else { otherwise }`.
    If {
        /// The condition, an expression of type `Bool`.
        condition: Box<Expr>,
        /// The expression of the value if the condition holds.
        then: Box<Expr>,
        /// The expression of the value if the condition does not hold; the checker refuses an `if` without one.
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
        /// The number of parameters of the lambda.
        params: usize,
        /// The expression that gives the result of the lambda.
        body: Arc<Expr>,
        /// The number of slots, for local variables, of the frame in which the lambda's body is evaluated.
        frame: usize,
    },
    /// A call of a user's function or a built-in.
    Call {
        /// The declaration of the function that is called.
        def: DefId,
        /// The arguments in the order of the parameters; `None` where the default is taken.
        args: Vec<Option<Expr>>,
    },
    /// A call of a function value, such as a lambda.
    CallValue {
        /// The expression of the function value.
        callee: Box<Expr>,
        /// The arguments, in order, one for each parameter.
        args: Vec<Expr>,
    },
    /// A call of a behaviour of an instance of a configuration.
    CallBehavior {
        /// The expression of the instance of a configuration.
        object: Box<Expr>,
        /// The index of the behaviour in [`ConfigDef::behaviors`](super::typed::ConfigDef::behaviors).
        behavior: usize,
        /// The arguments in the order of the parameters; `None` where the default is taken.
        args: Vec<Option<Expr>>,
    },
    /// An instance of a module, cell, strut, config, lattice or truss.
    Instance {
        /// The declaration that is instantiated.
        def: DefId,
        /// The arguments in the order of the parameters; `None` where the default is taken.
        args: Vec<Option<Expr>>,
    },
}

/// A clause of a list comprehension: a loop over a list or range, or a filter.
#[derive(Clone, Debug)]
pub enum Clause {
    /// A loop of a comprehension: `for x in iterable`.
    For {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
    },
    /// A filter of a comprehension: `if condition`.
    If(Expr),
}
