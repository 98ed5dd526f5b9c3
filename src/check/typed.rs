//! The typed tree, the result of `check` and the input of `interpret`. This file holds declarations,
//! `typed_expr` statements and expressions.
//!
//! Names are resolved, arguments are in the order of the parameters, quantities are in SI, and type names
//! used as instances are instantiations. An `Error` node marks what has been reported: the interpreter
//! evaluates it to an unknown value and reports nothing that follows from it.

use super::family::FactsFamily;
use super::types::Type;
use crate::source::{FileId, Span, Symbol};
use crate::units::Dimension;
use std::sync::Arc;

pub use super::typed_expr::{BinaryOp, Body, Clause, Expr, ExprKind, Stmt, StmtKind, Test, UnaryOp};

/// The identity of a declaration: an index into [`Program::defs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DefId(pub u32);

/// A local variable: a slot of the frame of its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Local(pub u32);

/// A member of a declaration with instances: an index into its `members`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MemberId(pub u32);

/// A checked program.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// All declarations, by [`DefId`], those of imported files and the standard library included.
    pub defs: Vec<Def>,
    /// The statements of the file that is run.
    pub statements: Body,
    /// The tests of the file that is run.
    pub tests: Vec<Test>,
    /// The declarations of the project's own files, in order; `modl check` elaborates them.
    pub own: Vec<DefId>,
}

impl Program {
    /// Returns a declaration. Panics if the identity is of another program.
    pub fn def(&self, id: DefId) -> &Def {
        &self.defs[id.0 as usize]
    }
}

/// A declaration of a program, checked.
#[derive(Clone, Debug)]
pub struct Def {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The span of the whole declaration.
    pub whole: Span,
    /// The file that it is in.
    pub file: FileId,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
    /// Its typed body.
    pub kind: DefKind,
}

/// The typed body of a declaration, by its keyword.
#[derive(Clone, Debug)]
pub enum DefKind {
    /// A constant: `let`.
    Let(LetDef),
    /// A function: `fn`.
    Fn(FnDef),
    /// A built-in function: `extern fn`.
    Native(NativeDef),
    /// A record type: `extern type`.
    Record(RecordDef),
    /// A connector: `connector`.
    Connector(ConnectorDef),
    /// A module: `module`.
    Module(ModuleDef),
    /// A cell of a lattice or a strut of a truss: `cell`, `strut`.
    Facts(FactsDef),
    /// A configuration: `config`.
    Config(ConfigDef),
    /// A lattice: `lattice`.
    Lattice(LatticeDef),
    /// A truss: `truss`.
    Truss(TrussDef),
    /// A declaration that could not be understood, or a vacant one.
    Error,
}

/// A top-level `let`.
#[derive(Clone, Debug)]
pub struct LetDef {
    /// The declared or inferred type.
    pub ty: Type,
    /// The value.
    pub value: Expr,
    /// The number of slots of the frame in which the value is evaluated.
    pub frame: usize,
}

/// A `fn`. Its parameters are the first locals of the body, in order.
#[derive(Clone, Debug)]
pub struct FnDef {
    /// The parameters.
    pub params: Vec<Param>,
    /// The declared or inferred type of the result.
    pub result: Type,
    /// The body.
    pub body: Expr,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// An `extern fn`, whose body is in Rust. A method of an `extern type` takes its object as first parameter.
#[derive(Clone, Debug)]
pub struct NativeDef {
    /// The key of the Rust body: `move`, or `Plan.at` for a method.
    pub key: Symbol,
    /// The parameters, those of a method behind its object.
    pub params: Vec<Param>,
    /// The type of the result.
    pub result: Type,
    /// The names of the type parameters, for messages.
    pub type_params: Vec<Symbol>,
    /// The number of slots of the frame in which defaults are evaluated.
    pub frame: usize,
}

/// A parameter with its type and default.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// Its type.
    pub ty: Type,
    /// The default value, evaluated in the frame of the callee after the parameters before it.
    pub default: Option<Expr>,
    /// True if it takes all remaining positional arguments as one list.
    pub variadic: bool,
}

/// A record type: `extern type`.
#[derive(Clone, Debug)]
pub struct RecordDef {
    /// The record that this one extends: a `Folding` is a `Plan`.
    pub is: Option<DefId>,
    /// Its own fields; inherited ones are in the record it extends.
    pub fields: Vec<RecordField>,
    /// The natives whose first parameter is the record.
    pub methods: Vec<DefId>,
}

/// A field of a record.
#[derive(Clone, Debug)]
pub struct RecordField {
    /// Its name.
    pub name: Symbol,
    /// Its type.
    pub ty: Type,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
}

/// A connector with its clauses: `connector`.
#[derive(Clone, Debug)]
pub struct ConnectorDef {
    /// The connectors that mate with it, with the spans of their names.
    pub mates: Vec<(DefId, Span)>,
    /// The number of turns at which it mates, evenly over a full turn; `None` if the clause is missing.
    pub turns: Option<Expr>,
    /// The greatest forces and torques that it holds; the type of an expression distinguishes a force from a
    /// torque.
    pub holds: Vec<Expr>,
    /// The tolerances of docking: distance and angle.
    pub capture: Option<(Expr, Option<Expr>)>,
    /// The span of `hinge`, and its arguments in the order of the parameters of the prelude's `revolute`.
    pub hinge: Option<(Span, Vec<Option<Expr>>)>,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// A named member of a declaration with instances. The expressions of members and of parameters' defaults
/// each run in a fresh frame of the declaration's `frame` slots, all clauses together in one frame. `This`
/// is the current instance in all of them; from outside a member is `object.name`.
#[derive(Clone, Debug)]
pub struct Member {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// Its type.
    pub ty: Type,
    /// Its kind, with the expression that gives its value.
    pub kind: MemberKind,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
}

/// The kinds of members.
#[derive(Clone, Debug)]
pub enum MemberKind {
    /// The parameter at this index.
    Param(usize),
    /// A `let` at the top of the body; evaluated when first needed.
    Let(Expr),
    /// A part, or a list of parts ([`ConfigDef::parts`]).
    Part(usize),
    /// A port of a configuration: a port or a list of ports; `count` is the declared length.
    Port { count: Option<Expr>, value: Expr },
    /// [`ConfigDef::behaviors`]; only ever called.
    Behavior(usize),
    /// A node of a truss, or a list of nodes.
    Node,
}

/// A module with its links, joints and ports: `module`.
#[derive(Clone, Debug)]
pub struct ModuleDef {
    /// The parameters.
    pub params: Vec<Param>,
    /// The parameters and `let`s.
    pub members: Vec<Member>,
    /// The mass of the whole module (`mass`), if it is stated.
    pub mass: Option<Expr>,
    /// `touch`: the depth beyond which penetration is a collision, a length.
    pub touch: Option<Expr>,
    /// `contact`: the gap up to which links touch the ground, a length.
    pub contact: Option<Expr>,
    /// The links, in order.
    pub links: Vec<LinkDef>,
    /// The joints, in order.
    pub joints: Vec<JointDef>,
    /// The names of ports; an array is one entry.
    pub ports: Vec<PortGroup>,
    /// The motors, in order.
    pub motors: Vec<MotorDef>,
    /// The clauses `let`, `require`, `port` and `touching`, and conditions and loops over them, in order.
    pub clauses: Vec<ModuleClause>,
    /// Aliases of joints as (name, index in `joints`), by name.
    pub joint_aliases: Vec<(Symbol, usize)>,
    /// Aliases of ports as (name, index in `ports`), by name.
    pub port_aliases: Vec<(Symbol, usize)>,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// A `link` of a module.
#[derive(Clone, Debug)]
pub struct LinkDef {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The shape that is drawn, and that collides unless `collides` is given.
    pub shape: Expr,
    /// The shape for collisions, if it is another.
    pub collides: Option<Expr>,
    /// The pose of the shape in the link's frame.
    pub at: Option<Placement>,
}

/// A `joint` of a module.
#[derive(Clone, Debug)]
pub struct JointDef {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The dimension of its position: angle for a revolute joint, length for a prismatic one, number for a
    /// fixed one.
    pub dimension: Dimension,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
    /// A joint between links, or a coordinate.
    pub kind: JointDefKind,
}

/// The kinds of joints of a module.
#[derive(Clone, Debug)]
pub enum JointDefKind {
    /// A joint between two links.
    Declared(Box<JointBetween>),
    /// A coordinate that moves no link: a linear combination of other joints (`joint b = -a`).
    Mimic(Linear),
}

/// A joint between two links.
#[derive(Clone, Debug)]
pub struct JointBetween {
    /// The parent link, an index into `links`.
    pub parent: usize,
    /// The child link, an index into `links`.
    pub child: usize,
    /// The kind of joint: a value of type `JointKind`.
    pub kind: Expr,
    /// The pose of the joint in the parent's frame.
    pub at: Option<Placement>,
    /// The linear combination of joints that it follows, from a clause of its own.
    pub follows: Option<Linear>,
}

/// A linear combination: a sum of joints (indices into `joints`), each times a factor.
pub type Linear = Vec<(usize, Expr)>;

/// A port of a module, or an array of ports.
#[derive(Clone, Debug)]
pub struct PortGroup {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// True for an array.
    pub array: bool,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
}

/// A `motor` of a module.
#[derive(Clone, Debug)]
pub struct MotorDef {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The joints that it drives (indices into `joints`), each with its transmission factor.
    pub joints: Vec<(usize, Expr)>,
    /// The greatest speed.
    pub max_speed: Option<Expr>,
    /// The greatest acceleration.
    pub max_accel: Option<Expr>,
    /// The greatest torque or force.
    pub max_torque: Option<Expr>,
}

/// A pose: `at [x, y, z] turned(Z, 90deg)`. Turns apply in order, each in the frame turned so far.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The position: a vector of lengths.
    pub position: Expr,
    /// The turns as (axis, angle).
    pub turned: Vec<(Expr, Expr)>,
    /// The span of the clause.
    pub span: Span,
}

/// A clause of a module that depends on values.
#[derive(Clone, Debug)]
pub enum ModuleClause {
    /// A port, or one element of a port array.
    Port(Box<PortClause>),
    /// Two links (indices into `links`) that may touch, and the span of the clause.
    Touching(usize, usize, Span),
    /// A local definition: `let name = value`.
    Let { local: Local, value: Expr },
    /// A requirement: `require condition`.
    Require(Require),
    /// `if`; only the clauses of one branch are elaborated.
    If { condition: Expr, then: Vec<ModuleClause>, otherwise: Vec<ModuleClause> },
    /// `for`; the clauses are elaborated for each element.
    For { binder: Local, iterable: Expr, body: Vec<ModuleClause> },
}

/// A port, or one element of a port array.
#[derive(Clone, Debug)]
pub struct PortClause {
    /// The index of its name in [`ModuleDef::ports`].
    pub group: usize,
    /// Its index in an array.
    pub index: Option<Expr>,
    /// The connector at the port.
    pub connector: DefId,
    /// The link that carries it, an index into `links`.
    pub link: usize,
    /// The pose of the port in the link's frame.
    pub at: Option<Placement>,
    /// The direction of its outward normal.
    pub facing: Expr,
    /// The direction from which turns are counted.
    pub up: Option<Expr>,
    /// The span of the clause.
    pub span: Span,
}

/// A requirement that is checked when the body is complete: `require condition`.
#[derive(Clone, Debug)]
pub struct Require {
    /// The span of the clause.
    pub span: Span,
    /// The condition that must hold.
    pub condition: Expr,
    /// The message if it does not.
    pub message: Option<Expr>,
}

/// The body of a `cell` or a `strut`.
#[derive(Clone, Debug)]
pub struct FactsDef {
    /// The family.
    pub family: FactsFamily,
    /// The parameters.
    pub params: Vec<Param>,
    /// The parameters and `let`s.
    pub members: Vec<Member>,
    /// The values of [`Family::facts`](super::family::Family::facts), in their order; `None` where one is
    /// missing.
    pub facts: Vec<Option<Expr>>,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// A configuration with its parts and clauses: `config`.
#[derive(Clone, Debug)]
pub struct ConfigDef {
    /// The parameters.
    pub params: Vec<Param>,
    /// The span of the word `closed`, if connections may close loops.
    pub closed: Option<Span>,
    /// The parameters, `let`s, parts, ports and behaviours by name.
    pub members: Vec<Member>,
    /// The parts, in order.
    pub parts: Vec<PartDef>,
    /// The behaviours, in order.
    pub behaviors: Vec<BehaviorDef>,
    /// The other clauses, in order.
    pub clauses: Vec<ConfigClause>,
    /// The base: an instance of a module or configuration, or one of its parts.
    pub base: Option<Expr>,
    /// The number of slots of the body outside of behaviours: loop variables and nested `let`s. Parameters
    /// are members.
    pub frame: usize,
}

/// A `part` of a configuration.
#[derive(Clone, Debug)]
pub struct PartDef {
    /// The member that it is.
    pub member: MemberId,
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The module or configuration of which it is an instance.
    pub of: DefId,
    /// The number of parts, for a list of parts.
    pub count: Option<PartCount>,
    /// The arguments, in the order of the parameters of `of`; `None`: the default.
    pub args: Vec<Option<Expr>>,
    /// The span of the type and its arguments.
    pub ty_span: Span,
}

/// The length of a list of parts.
#[derive(Clone, Debug)]
pub enum PartCount {
    /// A number of equal parts: `part m[n]: ...`.
    Number(Expr),
    /// One part for each element of a range, which its arguments can refer to: `part m[i in range]: ...`.
    Each { binder: Local, range: Expr },
}

/// A `behavior` of a configuration. Its parameters are the first locals of the body.
#[derive(Clone, Debug)]
pub struct BehaviorDef {
    /// Its name.
    pub name: Symbol,
    /// The span of the name.
    pub span: Span,
    /// The text of its doc comment.
    pub doc: Option<Arc<str>>,
    /// The parameters.
    pub params: Vec<Param>,
    /// The exemptions from verification.
    pub allows: Vec<Exemption>,
    /// The body.
    pub body: Expr,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// An exemption of a behaviour (`allows`): a check of the judge that may fail.
#[derive(Clone, Debug)]
pub struct Exemption {
    /// The check, with what it is restricted to.
    pub kind: ExemptionKind,
    /// The span of the clause.
    pub span: Span,
}

/// The kinds of exemptions.
#[derive(Clone, Debug)]
pub enum ExemptionKind {
    /// The robot may be unstable.
    Unstable,
    /// The robot may slip.
    Slip,
    /// Two instances, or none: any two.
    Collision(Option<(Expr, Expr)>),
    /// A joint, or none: any.
    Overload(Option<Expr>),
}

/// A clause of a configuration that depends on values.
#[derive(Clone, Debug)]
pub enum ConfigClause {
    /// `connect a -- b turn angle`: bonds two ports.
    Connect { a: Expr, b: Expr, turn: Option<Expr>, span: Span },
    /// `set joint = value`: a joint position at the start.
    Set { joint: Expr, value: Expr, span: Span },
    /// A local definition: `let name = value`.
    Let { local: Local, value: Expr },
    /// A requirement: `require condition`.
    Require(Require),
    /// `if`; only the clauses of one branch are elaborated.
    If { condition: Expr, then: Vec<ConfigClause>, otherwise: Vec<ConfigClause> },
    /// `for`; the clauses are elaborated for each element.
    For { binder: Local, iterable: Expr, body: Vec<ConfigClause> },
}

/// A lattice with its cell and arrangement: `lattice`.
#[derive(Clone, Debug)]
pub struct LatticeDef {
    /// The parameters.
    pub params: Vec<Param>,
    /// The parameters and `let`s.
    pub members: Vec<Member>,
    /// The cell that it is made of.
    pub of: DefId,
    /// The cells: an expression of type `Cells`.
    pub value: Expr,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// A truss with its strut and clauses: `truss`.
#[derive(Clone, Debug)]
pub struct TrussDef {
    /// The parameters.
    pub params: Vec<Param>,
    /// The parameters, `let`s and nodes.
    pub members: Vec<Member>,
    /// The strut that it is made of.
    pub of: DefId,
    /// Its nodes and struts.
    pub body: TrussBody,
    /// The number of slots of its frame.
    pub frame: usize,
}

/// The nodes and struts of a truss.
#[derive(Clone, Debug)]
pub enum TrussBody {
    /// A value of the prelude's record `Frame`.
    Value(Box<Expr>),
    /// Clauses that name nodes and struts.
    Clauses(Vec<TrussClause>),
}

/// A clause of a truss.
#[derive(Clone, Debug)]
pub enum TrussClause {
    /// A node; its name is the member's, `index` its index in an array of nodes.
    Node { member: MemberId, index: Option<Expr>, value: Expr, span: Span },
    /// Nodes by member and index.
    Strut { a: NodeRef, b: NodeRef, span: Span },
    /// A local definition: `let name = value`.
    Let { local: Local, value: Expr },
    /// A requirement: `require condition`.
    Require(Require),
    /// `if`; only the clauses of one branch are elaborated.
    If { condition: Expr, then: Vec<TrussClause>, otherwise: Vec<TrussClause> },
    /// `for`; the clauses are elaborated for each element.
    For { binder: Local, iterable: Expr, body: Vec<TrussClause> },
}

/// A reference to a node: a member, with its index in an array of nodes.
#[derive(Clone, Debug)]
pub struct NodeRef {
    /// The member.
    pub member: MemberId,
    /// The index in an array.
    pub index: Option<Expr>,
    /// The span of the reference.
    pub span: Span,
}
