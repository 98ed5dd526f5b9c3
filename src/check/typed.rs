//! The typed tree, the result of `check` and the input of `interpret`. This file holds declarations,
//! `typed_module` the parts of modules, and `typed_expr` statements and expressions.
//!
//! Names are resolved, arguments are in the order of the parameters, quantities are in SI, and type names
//! used as instances are instantiations. An `Error` node marks what has been reported: the interpreter
//! evaluates it to an unknown value and reports nothing that follows from it.

use super::family::FactsFamily;
use super::types::Type;
use crate::source::{FileId, Span, Symbol};
use std::sync::Arc;

pub use super::typed_expr::{
    BinaryOp, Body, Clause, Contract, ContractKind, Expr, ExprKind, Stmt, StmtKind, Test, UnaryOp,
};
pub use super::typed_module::{
    JointBetween, JointDef, JointDefKind, Linear, LinkDef, ModuleClause, ModuleDef, MotorDef, Placement,
    PortClause, PortGroup,
};
pub use super::typed_study::{SamplerDef, StudyAxis, StudyDef};

/// The identity of a declaration: an index into [`Program::defs`], from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DefId(pub u32);

/// A local variable: the index, from 0, of a slot of the frame of its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Local(pub u32);

/// A member of a declaration with instances: an index into its `members`, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MemberId(pub u32);

/// A checked program: all its declarations with types, and what the file that is run does with them.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// All declarations, by [`DefId`], those of imported files and the standard library included; in a session
    /// also vacant ones, which are [`DefKind::Error`].
    pub defs: Vec<Def>,
    /// The statements of the file that is run; those of the newest entry in a session.
    pub statements: Body,
    /// The tests of the file that is run.
    pub tests: Vec<Test>,
    /// The declarations of the project's own files, sorted by [`DefId`], which `modl check` elaborates.
    pub own: Vec<DefId>,
}

impl Program {
    /// Returns a declaration. Panics if the program has none of this identity.
    pub fn def(&self, id: DefId) -> &Def {
        &self.defs[id.0 as usize]
    }

    /// Iterates over all declarations with their identities, in the order of these.
    pub fn identified(&self) -> impl Iterator<Item = (DefId, &Def)> {
        (0..).map(DefId).zip(&self.defs)
    }
}

/// A checked declaration of a program, or a method of a record; [`DefKind`] holds its body.
#[derive(Clone, Debug)]
pub struct Def {
    /// The name that is declared.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The span of the whole declaration, from its keyword; for a method, that of its record.
    pub whole: Span,
    /// The file that contains the declaration.
    pub file: FileId,
    /// The text of the declaration's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The typed body of the declaration, by its keyword.
    pub kind: DefKind,
}

/// The typed body of a declaration, by its keyword.
#[derive(Clone, Debug)]
pub enum DefKind {
    /// A constant, declared by `let`.
    Let(LetDef),
    /// A function with a body in the language: `fn`.
    Fn(FnDef),
    /// A built-in function, whose body is in Rust: `extern fn`.
    Native(NativeDef),
    /// A record: `record`, or `extern type`.
    Record(RecordDef),
    /// A kind of connector, by which ports mate: `connector`.
    Connector(ConnectorDef),
    /// A module type with links, joints and ports: `module`.
    Module(ModuleDef),
    /// A cell of a lattice or a strut of a truss: `cell`, `strut`.
    Facts(FactsDef),
    /// A configuration of connected modules: `config`.
    Config(ConfigDef),
    /// A lattice of cells: `lattice`.
    Lattice(LatticeDef),
    /// A truss of nodes and struts: `truss`.
    Truss(TrussDef),
    /// A study of designs: `study`.
    Study(StudyDef),
    /// A declaration that could not be understood, or a vacant one.
    Error,
}

/// A top-level `let`: a constant, whose value is evaluated once, when it is first needed.
#[derive(Clone, Debug)]
pub struct LetDef {
    /// The type of the constant, declared or inferred.
    pub ty: Type,
    /// The expression that gives the value of the constant.
    pub value: Expr,
    /// The number of slots of the frame in which the value is evaluated.
    pub frame: usize,
}

/// A function, `fn`. Its parameters are the first locals of the body, in order.
#[derive(Clone, Debug)]
pub struct FnDef {
    /// The parameters, in order: the first locals of the body.
    pub params: Vec<Param>,
    /// The declared or inferred type of the result.
    pub result: Type,
    /// The expression that gives the result of a call.
    pub body: Expr,
    /// The number of slots of the frame in which the body is evaluated.
    pub frame: usize,
}

/// A built-in function, `extern fn`, whose body is in Rust. A method of an `extern type` takes its object as first
/// parameter.
#[derive(Clone, Debug)]
pub struct NativeDef {
    /// The key of the Rust body: `move`, or `Plan.at` for a method.
    pub key: Symbol,
    /// The parameters; the object of a method is the first, `self`.
    pub params: Vec<Param>,
    /// The type of the value that a call gives.
    pub result: Type,
    /// The names of the type parameters, in order, for messages.
    pub type_params: Vec<Symbol>,
    /// The number of slots of the frame in which defaults are evaluated.
    pub frame: usize,
}

/// A parameter with its type and default.
#[derive(Clone, Debug)]
pub struct Param {
    /// The name of the parameter, by which calls may name the argument.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The type that arguments of the parameter must fit.
    pub ty: Type,
    /// The default value, evaluated in the frame of the callee after the parameters before it; `None` if an
    /// argument is needed.
    pub default: Option<Expr>,
    /// True if the parameter takes all remaining positional arguments as one list; `ty` is then that of an element.
    pub variadic: bool,
}

/// A record: `record`, or a type of the standard library (`extern type`).
#[derive(Clone, Debug)]
pub struct RecordDef {
    /// The record that this one extends, as a `Folding` is a `Plan`; `None` if it stands alone.
    pub is: Option<DefId>,
    /// The record's own fields, in the order of the text; inherited ones are in the record that it extends.
    pub fields: Vec<RecordField>,
    /// The record's own methods, in the order of the text: natives whose first parameter is the record.
    pub methods: Vec<DefId>,
    /// The fields as a call by name takes them; `None` for an `extern type`, which only built-ins build.
    pub build: Option<RecordBuild>,
}

/// The parameters of a call that builds a record.
#[derive(Clone, Debug)]
pub struct RecordBuild {
    /// The fields as parameters, in the order of [`RecordDef::fields`], with their defaults.
    pub params: Vec<Param>,
    /// The number of slots of the frame in which defaults are evaluated.
    pub frame: usize,
}

/// A field of a record that programs can read, `record.name`, with its type.
#[derive(Clone, Debug)]
pub struct RecordField {
    /// The name of the field, as in `record.name`.
    pub name: Symbol,
    /// The type of the value that the field has.
    pub ty: Type,
    /// The text of the field's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
}

/// A connector, `connector`, with its clauses as expressions not yet evaluated.
#[derive(Clone, Debug)]
pub struct ConnectorDef {
    /// The connectors that mate with this one, each with the span of its name in the clause, in the order of the
    /// text.
    pub mates: Vec<(DefId, Span)>,
    /// The number of turns at which the connector mates, evenly over a full turn; `None` if the clause is missing.
    pub turns: Option<Expr>,
    /// The greatest forces and torques that a bond of the connector holds; the type of an expression distinguishes a
    /// force from a torque.
    pub holds: Vec<Expr>,
    /// The tolerances of docking; `None` if the clause is missing.
    pub capture: Option<CaptureDef>,
    /// True if docking draws the ports together.
    pub snaps: bool,
    /// The joint of the bond, as (span of the word `hinge`, its arguments in the order of the parameters of the
    /// prelude's `revolute`, `None` for one left out); `None` for a rigid connector.
    pub hinge: Option<(Span, Vec<Option<Expr>>)>,
    /// The number of slots, for local variables, of the frame in which the clauses are evaluated.
    pub frame: usize,
}

/// The tolerances of docking, as expressions not yet evaluated; `None` for what is not written.
#[derive(Clone, Debug)]
pub struct CaptureDef {
    /// The greatest distance between the ports, a length.
    pub distance: Expr,
    /// The greatest angle between them.
    pub angle: Option<Expr>,
    /// The greatest speed of the one against the other, of two robots.
    pub speed: Option<Expr>,
    /// The greatest angular speed, likewise.
    pub rate: Option<Expr>,
}

/// A named member of a declaration with instances. The expressions of members and of parameters' defaults
/// each run in a fresh frame of the declaration's `frame` slots, all clauses together in one frame. `This`
/// is the current instance in all of them; from outside a member is `object.name`.
#[derive(Clone, Debug)]
pub struct Member {
    /// The name of the member, as in `object.name`.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The type of the value that the member has.
    pub ty: Type,
    /// The kind of the member, with the expression that gives its value.
    pub kind: MemberKind,
    /// The text of the member's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
}

/// The meaning of a member, with the expression that gives its value or the index of its declaration.
#[derive(Clone, Debug)]
pub enum MemberKind {
    /// A parameter of the declaration, by its index in the declaration's `params`.
    Param(usize),
    /// A `let` at the top of the body with its value, which is evaluated when first needed.
    Let(Expr),
    /// A part, or a list of parts: an index into [`ConfigDef::parts`].
    Part(usize),
    /// A port or a list of ports of a configuration.
    Port {
        /// The declared length of a list of ports; `None` for a single port, and where no length is
        /// written.
        count: Option<Expr>,
        /// The expression of the port, or of the list of ports, that the member names.
        value: Expr,
    },
    /// A behaviour: an index into [`ConfigDef::behaviors`].
    Behavior(usize),
    /// A node of a truss, or a list of nodes.
    Node,
    /// An obstacle of a scene, or a list of obstacles.
    Obstacle,
}

/// A requirement: `require condition, message`. A configuration or a truss checks it after all its clauses have run, a
/// module at once, in the order of its clauses.
#[derive(Clone, Debug)]
pub struct Require {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The condition that must hold, an expression of type `Bool`.
    pub condition: Expr,
    /// The message if the condition does not hold, a text; `None` if none is written.
    pub message: Option<Expr>,
}

/// The body of a `cell` or a `strut`: its facts as expressions not yet evaluated.
#[derive(Clone, Debug)]
pub struct FactsDef {
    /// The family that the keyword names: cell or strut.
    pub family: FactsFamily,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The members of the declaration, which are its parameters, in order.
    pub members: Vec<Member>,
    /// The values of [`Family::facts`](super::family::Family::facts), in their order; `None` where one is
    /// missing.
    pub facts: Vec<Option<Expr>>,
    /// The number of slots, for local variables, of the frame in which the facts are evaluated.
    pub frame: usize,
}

/// A configuration or a scene, with its parts and clauses: `config`, `scene`.
#[derive(Clone, Debug)]
pub struct ConfigDef {
    /// True for a scene: its parts need not be connected.
    pub scene: bool,
    /// The world of plans of a scene, a call of the built-in `world`; `None` where none is stated.
    pub world: Option<Expr>,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The span of the word `closed`, if connections may close loops; `None` if it is not written.
    pub closed: Option<Span>,
    /// The parameters, `let`s, parts, ports and behaviours by name.
    pub members: Vec<Member>,
    /// The parts, in the order of the text.
    pub parts: Vec<PartDef>,
    /// The behaviours, in the order of the text.
    pub behaviors: Vec<BehaviorDef>,
    /// The clauses `connect`, `set` and `require`, and branches and loops over them, in order.
    pub clauses: Vec<ConfigClause>,
    /// The base: an instance of a module or configuration among the parts; `None` if the clause is missing or
    /// wrong.
    pub base: Option<Expr>,
    /// The number of slots of the frame in which the body outside of behaviours is evaluated: loop variables and
    /// nested `let`s. Parameters are members.
    pub frame: usize,
}

/// A `part` of a configuration: one instance of a module or configuration, or a list of them.
#[derive(Clone, Debug)]
pub struct PartDef {
    /// The member of the configuration that stands for the part: an index into [`ConfigDef::members`].
    pub member: MemberId,
    /// The name of the part, or of the list of parts.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The module or configuration of which the part is an instance; after a mistake the configuration itself, and
    /// the type of the member is then an error.
    pub of: DefId,
    /// The length of a list of parts; `None` for a single part.
    pub count: Option<PartCount>,
    /// The arguments, in the order of the parameters of `of`; `None` for one that is left out, whose default is taken.
    pub args: Vec<Option<Expr>>,
    /// The pose of the part's base in a scene, before it settles; `None` if the part is not placed.
    pub at: Option<Placement>,
    /// The span of the path of the type, without its arguments.
    pub ty_span: Span,
}

/// An `obstacle` of a scene, a single one or an element of an array.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// The member that names the obstacle or the array.
    pub member: MemberId,
    /// The name of the obstacle or of the array.
    pub name: Symbol,
    /// The index of the obstacle in its array, from 0; `None` for a single one.
    pub index: Option<Expr>,
    /// The solid, an expression of type `Shape`.
    pub value: Expr,
    /// The pose of the solid in the world; `None` where it stays as it is.
    pub at: Option<Placement>,
    /// The span of the name in the declaration.
    pub span: Span,
}

/// The length of a list of parts.
#[derive(Clone, Debug)]
pub enum PartCount {
    /// A number of equal parts: `part m[n]: ...`.
    Number(Expr),
    /// One part for each element of a list or range, which its arguments can refer to: `part m[i in 0..4]`.
    Each {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list, or the range of whole numbers.
        range: Expr,
    },
}

/// A `behavior` of a configuration. Its parameters are the first locals of the body.
#[derive(Clone, Debug)]
pub struct BehaviorDef {
    /// The name of the behaviour, as in `object.name()`.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The text of the behaviour's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The parameters, in order: the first locals of the body.
    pub params: Vec<Param>,
    /// The exemptions from verification, in order.
    pub allows: Vec<Exemption>,
    /// The spans of its requirements and contracts, in the order of the text: those of their whole clauses, with true for
    /// contracts, which are judged when the behaviour is used.
    pub contracts: Vec<(Span, bool)>,
    /// The expression that gives the behaviour.
    pub body: Expr,
    /// The number of slots, for local variables, of the frame in which the body is evaluated.
    pub frame: usize,
}

/// An exemption of a behaviour (`allows`): a check of the judge that may fail.
#[derive(Clone, Debug)]
pub struct Exemption {
    /// The check that may fail, with what that is restricted to.
    pub kind: ExemptionKind,
    /// The span of the clause in the source text.
    pub span: Span,
}

/// The check of the judge that may fail, and what that is restricted to, as expressions not yet evaluated.
#[derive(Clone, Debug)]
pub enum ExemptionKind {
    /// The check of stability: the robot may be unstable.
    Unstable,
    /// The check of slip: links may slip over the ground.
    Slip,
    /// The check of collisions: the two instances may collide; `None`: any two.
    Collision(Option<(Expr, Expr)>),
    /// The check of torques: the joint may be overloaded; `None`: any joint.
    Overload(Option<Expr>),
    /// The check of accelerations: joints may exceed their limits, and change their speed at once.
    Acceleration,
    /// The check of balance: the ground's forces need not balance the robot.
    Balance,
    /// The check of traction: friction need not determine the travel.
    Traction,
    /// The check of torque, where the robot sags little with its motors at their limits.
    Saturation,
}

/// A clause of a configuration that is elaborated for each instance, in the order of the text.
#[derive(Clone, Debug)]
pub enum ConfigClause {
    /// A connection that bonds two ports: `connect a -- b turn angle`.
    Connect {
        /// The expression of the first port.
        a: Expr,
        /// The expression of the second port.
        b: Expr,
        /// The angle at which they mate; `None` if it is not written.
        turn: Option<Expr>,
        /// The span of the clause in the source text.
        span: Span,
    },
    /// The position of a joint at the start: `set joint = value`.
    Set {
        /// The expression of the joint.
        joint: Expr,
        /// The position of the joint at the start, of the joint's dimension.
        value: Expr,
        /// The span of the clause in the source text.
        span: Span,
    },
    /// A local definition: `let name = value`.
    Let {
        /// The local that holds the value.
        local: Local,
        /// The expression that gives the value.
        value: Expr,
    },
    /// A requirement on the values: `require condition, message`.
    Require(Require),
    /// An obstacle of a scene: `obstacle wall = box(...) at [...]`.
    Obstacle(Obstacle),
    /// A branch: only the clauses of one side are elaborated.
    If {
        /// The condition, an expression of type `Bool`.
        condition: Expr,
        /// The clauses that are elaborated if the condition holds, in order.
        then: Vec<ConfigClause>,
        /// The clauses that are elaborated if the condition does not hold; empty without `else`.
        otherwise: Vec<ConfigClause>,
    },
    /// A loop: the clauses are elaborated for each element.
    For {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that are elaborated for each element, in order.
        body: Vec<ConfigClause>,
    },
}

/// A lattice with its cell and arrangement: `lattice`.
#[derive(Clone, Debug)]
pub struct LatticeDef {
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The members of the declaration, which are its parameters, in order.
    pub members: Vec<Member>,
    /// The declaration of the cell that the lattice is made of.
    pub of: DefId,
    /// The cells: an expression of type `Cells`.
    pub value: Expr,
    /// The number of slots, for local variables, of the frame in which the value is evaluated.
    pub frame: usize,
}

/// A truss with its strut and clauses: `truss`.
#[derive(Clone, Debug)]
pub struct TrussDef {
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The members of the declaration: its parameters, `let`s and nodes.
    pub members: Vec<Member>,
    /// The declaration of the strut that the truss is made of.
    pub of: DefId,
    /// The nodes and struts of the truss.
    pub body: TrussBody,
    /// The number of slots, for local variables, of the frame in which the clauses are evaluated.
    pub frame: usize,
}

/// The nodes and struts of a truss.
#[derive(Clone, Debug)]
pub enum TrussBody {
    /// A value of the prelude's record `Frame`.
    Value(Box<Expr>),
    /// The clauses that name nodes and struts, in the order of the text.
    Clauses(Vec<TrussClause>),
}

/// A clause of a truss that is carried out in order when an instance is elaborated; `let`s at its top are members.
#[derive(Clone, Debug)]
pub enum TrussClause {
    /// A node, or one of an array of nodes.
    Node {
        /// The member that names the node or the array of nodes.
        member: MemberId,
        /// The index of the node in its array, from 0; `None` for a single node.
        index: Option<Expr>,
        /// The position of the node, a vector of lengths.
        value: Expr,
        /// The span of the name in the declaration.
        span: Span,
    },
    /// A strut between two nodes of the truss.
    Strut {
        /// The reference to the first node.
        a: NodeRef,
        /// The reference to the second node.
        b: NodeRef,
        /// The span of the clause in the source text.
        span: Span,
    },
    /// A local definition: `let name = value`.
    Let {
        /// The local that holds the value.
        local: Local,
        /// The expression that gives the value.
        value: Expr,
    },
    /// A requirement on the values: `require condition, message`.
    Require(Require),
    /// A branch: only the clauses of one side are elaborated.
    If {
        /// The condition, an expression of type `Bool`.
        condition: Expr,
        /// The clauses that are elaborated if the condition holds, in order.
        then: Vec<TrussClause>,
        /// The clauses that are elaborated if the condition does not hold; empty without `else`.
        otherwise: Vec<TrussClause>,
    },
    /// A loop: the clauses are elaborated for each element.
    For {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that are elaborated for each element, in order.
        body: Vec<TrussClause>,
    },
}

/// A reference to a node: a member, with its index in an array of nodes.
#[derive(Clone, Debug)]
pub struct NodeRef {
    /// The member of the truss that names the node or the array of nodes.
    pub member: MemberId,
    /// The index of the node in its array, from 0; `None` for a single node.
    pub index: Option<Expr>,
    /// The span of the reference in the source text.
    pub span: Span,
}
