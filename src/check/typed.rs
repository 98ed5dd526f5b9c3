//! The typed tree: what `check` hands to `interpret`. Declarations stand here, what is in them in
//! `typed_expr`.
//!
//! Names are resolved, arguments are in the order of the parameters, quantities are in SI, type
//! names that stand for instances are instantiations. An `Error` node marks what has been reported;
//! the interpreter gives it an unknown value and stays silent about what follows from it.

use super::types::Type;
use crate::source::{FileId, Span, Symbol};
use crate::units::Dimension;
use std::sync::Arc;

pub use super::typed_expr::*;

/// A declaration of the program, an index into [`Program::defs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DefId(pub u32);

/// A variable of the body at hand: a slot of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Local(pub u32);

/// A member of a declaration with a body, an index into its `members`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MemberId(pub u32);

#[derive(Clone, Debug, Default)]
pub struct Program {
    pub defs: Vec<Def>,
    /// The statements and tests of the file that is run.
    pub statements: Body,
    pub tests: Vec<Test>,
    /// Declarations of the project's own files, in order: what `modl check` elaborates.
    pub own: Vec<DefId>,
}

impl Program {
    pub fn def(&self, id: DefId) -> &Def {
        &self.defs[id.0 as usize]
    }
}

#[derive(Clone, Debug)]
pub struct Def {
    pub name: Symbol,
    /// Of the name.
    pub span: Span,
    /// Of the whole declaration.
    pub whole: Span,
    pub file: FileId,
    pub doc: Option<Arc<str>>,
    pub kind: DefKind,
}

#[derive(Clone, Debug)]
pub enum DefKind {
    Let(LetDef),
    Fn(FnDef),
    Native(NativeDef),
    Record(RecordDef),
    Connector(ConnectorDef),
    Module(ModuleDef),
    Cell(FactsDef),
    Strut(FactsDef),
    Config(ConfigDef),
    Lattice(LatticeDef),
    Truss(TrussDef),
    /// A declaration that could not be understood.
    Error,
}

#[derive(Clone, Debug)]
pub struct LetDef {
    pub ty: Type,
    pub value: Expr,
    /// Slots that evaluating the value needs.
    pub frame: usize,
}

/// Parameters are the first locals of the body, in order.
#[derive(Clone, Debug)]
pub struct FnDef {
    pub params: Vec<Param>,
    pub result: Type,
    pub body: Expr,
    pub frame: usize,
}

/// `extern fn`: Rust supplies the body. A method of an `extern type` takes its object first.
#[derive(Clone, Debug)]
pub struct NativeDef {
    /// The name under which Rust supplies the body: `move`, or `Plan.at` for a method.
    pub key: Symbol,
    pub params: Vec<Param>,
    pub result: Type,
    /// Names of the type parameters, for messages.
    pub type_params: Vec<Symbol>,
    /// Slots that evaluating the defaults needs.
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct Param {
    pub name: Symbol,
    pub span: Span,
    pub ty: Type,
    /// Evaluated in the frame of the callee, after the parameters before it.
    pub default: Option<Expr>,
    /// Takes all remaining positional arguments as one list.
    pub variadic: bool,
}

#[derive(Clone, Debug)]
pub struct RecordDef {
    /// A `Folding` is a `Plan`.
    pub is: Option<DefId>,
    pub fields: Vec<RecordField>,
    /// Natives whose first parameter is the record.
    pub methods: Vec<DefId>,
}

#[derive(Clone, Debug)]
pub struct RecordField {
    pub name: Symbol,
    pub ty: Type,
    pub doc: Option<Arc<str>>,
}

#[derive(Clone, Debug)]
pub struct ConnectorDef {
    pub mates: Vec<(DefId, Span)>,
    pub turns: Option<Expr>,
    /// Forces and torques, told apart by their type.
    pub holds: Vec<Expr>,
    pub capture: Option<(Expr, Option<Expr>)>,
    /// Arguments of `hinge`, in the order of the parameters of the prelude's `revolute`.
    pub hinge: Option<(Span, Vec<Option<Expr>>)>,
    pub frame: usize,
}

/// What can be reached by a name inside a body with instances. The expressions of members and of
/// parameters' defaults each run in a fresh frame of the declaration's `frame` slots, clauses
/// together in one; `This` is the instance at hand in all of them, and from outside by `object.name`.
#[derive(Clone, Debug)]
pub struct Member {
    pub name: Symbol,
    pub span: Span,
    pub ty: Type,
    pub kind: MemberKind,
    pub doc: Option<Arc<str>>,
}

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

#[derive(Clone, Debug)]
pub struct ModuleDef {
    pub params: Vec<Param>,
    /// Parameters and lets.
    pub members: Vec<Member>,
    pub mass: Option<Expr>,
    pub touch: Option<Expr>,
    pub contact: Option<Expr>,
    pub links: Vec<LinkDef>,
    pub joints: Vec<JointDef>,
    /// Names of ports; an array is one entry.
    pub ports: Vec<PortGroup>,
    pub motors: Vec<MotorDef>,
    /// `let`, `require`, `port`, `touching` and loops over them, in order.
    pub clauses: Vec<ModuleClause>,
    /// Other names: (name, index in `joints`) and (name, index in `ports`).
    pub joint_aliases: Vec<(Symbol, usize)>,
    pub port_aliases: Vec<(Symbol, usize)>,
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct LinkDef {
    pub name: Symbol,
    pub span: Span,
    pub shape: Expr,
    pub collides: Option<Expr>,
    pub at: Option<Placement>,
}

#[derive(Clone, Debug)]
pub struct JointDef {
    pub name: Symbol,
    pub span: Span,
    /// Angle for revolute, length for prismatic; a number for fixed.
    pub dimension: Dimension,
    pub doc: Option<Arc<str>>,
    pub kind: JointDefKind,
}

#[derive(Clone, Debug)]
pub enum JointDefKind {
    Declared(Box<JointBetween>),
    /// Moves no link: another coordinate of those that it follows.
    Mimic(Linear),
}

/// A joint between two links.
#[derive(Clone, Debug)]
pub struct JointBetween {
    /// Indices of `links`.
    pub parent: usize,
    pub child: usize,
    pub kind: Expr,
    pub at: Option<Placement>,
    /// What a clause of its own says of a joint that follows others.
    pub follows: Option<Linear>,
}

/// A sum of joints, each times a factor.
pub type Linear = Vec<(usize, Expr)>;

#[derive(Clone, Debug)]
pub struct PortGroup {
    pub name: Symbol,
    pub span: Span,
    pub array: bool,
    pub doc: Option<Arc<str>>,
}

#[derive(Clone, Debug)]
pub struct MotorDef {
    pub name: Symbol,
    pub span: Span,
    pub joints: Vec<(usize, Expr)>,
    pub max_speed: Option<Expr>,
    pub max_accel: Option<Expr>,
    pub max_torque: Option<Expr>,
}

/// `at [x, y, z] turned(Z, 90deg)`: turns apply in order, each in the frame turned so far.
#[derive(Clone, Debug)]
pub struct Placement {
    pub position: Expr,
    /// Axis and angle.
    pub turned: Vec<(Expr, Expr)>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum ModuleClause {
    Port(Box<PortClause>),
    Touching(usize, usize, Span),
    Let { local: Local, value: Expr },
    Require(Require),
    If { condition: Expr, then: Vec<ModuleClause>, otherwise: Vec<ModuleClause> },
    For { binder: Local, iterable: Expr, body: Vec<ModuleClause> },
}

/// A port, or one element of a port array.
#[derive(Clone, Debug)]
pub struct PortClause {
    /// Index in [`ModuleDef::ports`].
    pub group: usize,
    pub index: Option<Expr>,
    pub connector: DefId,
    pub link: usize,
    pub at: Option<Placement>,
    pub facing: Expr,
    pub up: Option<Expr>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Require {
    pub span: Span,
    pub condition: Expr,
    pub message: Option<Expr>,
}

/// The body of a `cell` or a `strut`: the facts that its family asks for, in this order.
/// cell: size, shrinks_to, mass, max_force, max_speed.
/// strut: length (a range), max_speed, max_force, mass, clearance.
#[derive(Clone, Debug)]
pub struct FactsDef {
    pub params: Vec<Param>,
    pub members: Vec<Member>,
    pub facts: Vec<Option<Expr>>,
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct ConfigDef {
    pub params: Vec<Param>,
    pub closed: Option<Span>,
    pub members: Vec<Member>,
    pub parts: Vec<PartDef>,
    pub behaviors: Vec<BehaviorDef>,
    /// In order.
    pub clauses: Vec<ConfigClause>,
    /// An instance of a module or configuration, or one of its parts.
    pub base: Option<Expr>,
    /// Slots of the body outside behaviours (loop variables, nested lets); parameters are members.
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct PartDef {
    pub member: MemberId,
    pub name: Symbol,
    pub span: Span,
    pub of: DefId,
    pub count: Option<PartCount>,
    /// In the order of the parameters of `of`.
    pub args: Vec<Option<Expr>>,
    /// Of the type and its arguments.
    pub ty_span: Span,
}

#[derive(Clone, Debug)]
pub enum PartCount {
    Number(Expr),
    Each { binder: Local, range: Expr },
}

/// Parameters are the first locals of the body.
#[derive(Clone, Debug)]
pub struct BehaviorDef {
    pub name: Symbol,
    pub span: Span,
    pub doc: Option<Arc<str>>,
    pub params: Vec<Param>,
    pub allows: Vec<Exemption>,
    pub body: Expr,
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct Exemption {
    pub kind: ExemptionKind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum ExemptionKind {
    Unstable,
    Slip,
    /// Two instances, or none: any two.
    Collision(Option<(Expr, Expr)>),
    /// A joint, or none: any.
    Overload(Option<Expr>),
}

#[derive(Clone, Debug)]
pub enum ConfigClause {
    Connect { a: Expr, b: Expr, turn: Option<Expr>, span: Span },
    Set { joint: Expr, value: Expr, span: Span },
    Let { local: Local, value: Expr },
    Require(Require),
    If { condition: Expr, then: Vec<ConfigClause>, otherwise: Vec<ConfigClause> },
    For { binder: Local, iterable: Expr, body: Vec<ConfigClause> },
}

#[derive(Clone, Debug)]
pub struct LatticeDef {
    pub params: Vec<Param>,
    pub members: Vec<Member>,
    pub of: DefId,
    /// Of type `Cells`.
    pub value: Expr,
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub struct TrussDef {
    pub params: Vec<Param>,
    pub members: Vec<Member>,
    pub of: DefId,
    pub body: TrussBody,
    pub frame: usize,
}

#[derive(Clone, Debug)]
pub enum TrussBody {
    /// Of the prelude's record `Frame`: nodes and struts.
    Value(Box<Expr>),
    Clauses(Vec<TrussClause>),
}

#[derive(Clone, Debug)]
pub enum TrussClause {
    /// `name` is the member's; `index` its place in an array of nodes.
    Node {
        member: MemberId,
        index: Option<Expr>,
        value: Expr,
        span: Span,
    },
    /// Nodes by member and index.
    Strut {
        a: NodeRef,
        b: NodeRef,
        span: Span,
    },
    Let {
        local: Local,
        value: Expr,
    },
    Require(Require),
    If {
        condition: Expr,
        then: Vec<TrussClause>,
        otherwise: Vec<TrussClause>,
    },
    For {
        binder: Local,
        iterable: Expr,
        body: Vec<TrussClause>,
    },
}

#[derive(Clone, Debug)]
pub struct NodeRef {
    pub member: MemberId,
    pub index: Option<Expr>,
    pub span: Span,
}
