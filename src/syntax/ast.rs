//! The syntax tree of one file. Every node carries its span; comments are kept beside the tree, by
//! position.
//!
//! The tree holds what was written: names are not resolved, units not looked up, numbers not scaled. A
//! piece of text that could not be parsed is an `Error` node, about which later rooms report nothing (the
//! parser has).

use crate::source::{FileId, Span, Symbol};

/// A name as written in the source: a word that stands for something, which is not looked up yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Name {
    /// The characters of the name, interned.
    pub text: Symbol,
    /// The span of the word in the source text.
    pub span: Span,
}

/// The syntax tree of one file: its items, documentation and comments.
#[derive(Clone, Debug)]
pub struct File {
    /// The identity of the file among the texts of the run.
    pub id: FileId,
    /// The text of the `//!` lines, without the marks; `None` if there are none.
    pub doc: Option<String>,
    /// The items of the file, in order; an unreadable one is an [`ItemKind::Error`].
    pub items: Vec<Item>,
    /// All comments, documentation included, in order of position.
    pub comments: Vec<Comment>,
    /// The names that unreadable pieces would have declared; `check` does not report them as unknown.
    pub unread: Vec<Symbol>,
}

/// A comment with its kind and span.
#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    /// The span from the first mark to the end; that of a line comment ends before the line break.
    pub span: Span,
    /// The kind of the comment, by its marks.
    pub kind: CommentKind,
}

/// The kind of a comment, which its first characters tell: what it belongs to and where it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommentKind {
    /// A line comment: `//`, also with four or more slashes.
    Line,
    /// A block comment, which may span lines: `/* */`.
    Block,
    /// The documentation of an item: `///`.
    ItemDoc,
    /// The documentation of a file: `//!`.
    FileDoc,
}

/// An item of a file with its span and documentation.
#[derive(Clone, Debug)]
pub struct Item {
    /// The span of the item from its keyword to its end, without the documentation.
    pub span: Span,
    /// The text of the `///` lines before the item, without the marks; `None` if there are none.
    pub doc: Option<String>,
    /// The kind of the item, with what was written after its keyword.
    pub kind: ItemKind,
}

/// An item at the top of a file, by its keyword, with what was written after it.
#[derive(Clone, Debug)]
pub enum ItemKind {
    /// An import of names from another file: `use`.
    Use(Use),
    /// A constant, declared by `let`.
    Let(Let),
    /// A function with a body in the language: `fn`.
    Fn(Fn),
    /// A built-in function, whose body is in Rust: `extern fn`.
    ExternFn(ExternFn),
    /// A record type with named fields: `record`.
    Record(Record),
    /// A record type of the standard library: `extern type`.
    ExternType(ExternType),
    /// A kind of connector, by which ports mate: `connector`.
    Connector(Connector),
    /// A module type with links, joints and ports: `module`.
    Module(Module),
    /// A cell of a lattice or a strut of a truss: `cell`, `strut`.
    Facts(Facts),
    /// A configuration of connected modules, `config`, or a scene of several robots, `scene`.
    Config(Config),
    /// A lattice of cells: `lattice`.
    Lattice(Lattice),
    /// A truss of nodes and struts: `truss`.
    Truss(Truss),
    /// A study of designs: `study`.
    Study(Study),
    /// A test with its statements: `test`.
    Test(Test),
    /// A statement at the top of the file.
    Statement(Stmt),
    /// An item that could not be parsed, and was reported.
    Error,
}

impl ItemKind {
    /// Returns the name that the item declares; `None` for an import, a test, a statement and an error.
    pub fn name(&self) -> Option<Name> {
        Some(match self {
            ItemKind::Let(x) => x.name,
            ItemKind::Fn(x) => x.name,
            ItemKind::ExternFn(x) => x.name,
            ItemKind::Record(x) => x.name,
            ItemKind::ExternType(x) => x.name,
            ItemKind::Connector(x) => x.name,
            ItemKind::Module(x) => x.name,
            ItemKind::Facts(x) => x.name,
            ItemKind::Config(x) => x.name,
            ItemKind::Lattice(x) => x.name,
            ItemKind::Truss(x) => x.name,
            ItemKind::Study(x) => x.name,
            ItemKind::Use(_) | ItemKind::Test(_) | ItemKind::Statement(_) | ItemKind::Error => return None,
        })
    }
}

/// An import: `use std.smores.{Smores, Chain3 as Chain}`, `use "parts/claw.mod".{Claw}`, `use std.gaits`.
#[derive(Clone, Debug)]
pub struct Use {
    /// The imported file, or the module path that names the file.
    pub source: UseSource,
    /// The imported names, in order. `None` for a bare `use std.gaits`, which imports the last word of the path: a
    /// file, or an item of the file that the path before it names. `check` refuses `use "claw.mod"` without names.
    pub names: Option<Vec<UseName>>,
}

/// The file that an import takes names from, as a module path or a path on disk.
#[derive(Clone, Debug)]
pub enum UseSource {
    /// A module path of names with dots between them: `std.smores`.
    Path(Vec<Name>),
    /// A path relative to the importing file; the span covers the quotes.
    File {
        /// The path as written, escapes resolved.
        path: String,
        /// The span of the path, quotes included.
        span: Span,
    },
}

/// A name between the braces of an import, with the one that it gets: `Chain3 as Chain`.
#[derive(Clone, Debug)]
pub struct UseName {
    /// The name that the declaration has in the imported file.
    pub name: Name,
    /// The name after `as`, which it has in the importing file; `None` if it keeps its own.
    pub rename: Option<Name>,
}

/// A declaration of a value: `let name: type = value`.
#[derive(Clone, Debug)]
pub struct Let {
    /// The name that the definition declares.
    pub name: Name,
    /// The declared type; `None` if it is to be inferred.
    pub ty: Option<TypeExpr>,
    /// The expression after `=`, which gives the value.
    pub value: Expr,
}

/// A function: `fn name(params) -> result = body`.
#[derive(Clone, Debug)]
pub struct Fn {
    /// The name that the declaration gives the function.
    pub name: Name,
    /// The type parameters, in order; empty if there are none.
    pub type_params: Vec<TypeParam>,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The declared type of the result; `None` if it is to be inferred.
    pub result: Option<TypeExpr>,
    /// The expression or block after `=`.
    pub body: Expr,
}

/// A native function, whose body is in Rust: `extern fn sqrt<D: Dimension>(x: Quantity<D^2>) -> Quantity<D>`.
#[derive(Clone, Debug)]
pub struct ExternFn {
    /// The name that the declaration gives the function.
    pub name: Name,
    /// The type parameters, in order; empty if there are none.
    pub type_params: Vec<TypeParam>,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The declared type of the result; `None` if there is no result.
    pub result: Option<TypeExpr>,
}

/// A type parameter of a function, `D: Dimension`, which each call determines by its arguments.
#[derive(Clone, Debug)]
pub struct TypeParam {
    /// The name of the type parameter, by which types in the signature refer to it.
    pub name: Name,
    /// The bound after `:`, one of `Dimension`, `Quantity`, `Module` and `Config` in a correct program; `None` if the
    /// parameter may be any type.
    pub bound: Option<Name>,
}

/// A record: `record Design { bend: Angle = 30deg, speed: Speed }`.
#[derive(Clone, Debug)]
pub struct Record {
    /// The name that the declaration gives the record.
    pub name: Name,
    /// The fields, in order; `docs` has one entry for each.
    pub fields: Vec<Param>,
    /// The text of the `///` lines before each field, without the marks, in the order of `fields`; `None` for a field
    /// without such lines.
    pub docs: Vec<Option<String>>,
}

/// A record type of the standard library: `extern type Folding is Plan { layout: Layout fn at(t: Time) -> State }`.
#[derive(Clone, Debug)]
pub struct ExternType {
    /// The name that the declaration gives the record type.
    pub name: Name,
    /// The record that the type extends; `None` if it stands alone.
    pub is: Option<Name>,
    /// The fields of the record, in order.
    pub fields: Vec<ExternField>,
    /// The methods, in order, as (text of the `///` lines before the method, method). The text is without the marks,
    /// and `None` if there are no such lines. The object that a method is called on is none of its parameters.
    pub methods: Vec<(Option<String>, ExternFn)>,
}

/// A field of a record type of the standard library (`extern type`), with its documentation.
#[derive(Clone, Debug)]
pub struct ExternField {
    /// The text of the `///` lines before the field, without the marks; `None` if there are none.
    pub doc: Option<String>,
    /// The name of the field, as the declaration states it.
    pub name: Name,
    /// The type of the field, as written.
    pub ty: TypeExpr,
}

/// A parameter. In an `extern fn` its name may be a reserved word (`for:`), and it may be variadic.
#[derive(Clone, Debug)]
pub struct Param {
    /// The name of the parameter, by which calls may name the argument.
    pub name: Name,
    /// The type of the parameter, as written.
    pub ty: TypeExpr,
    /// The default value; `None` if an argument is needed.
    pub default: Option<Expr>,
    /// True for a variadic parameter such as `b: Behavior...`, which takes all remaining arguments.
    pub variadic: bool,
}

/// A type as written, with its span; its names are not resolved.
#[derive(Clone, Debug)]
pub struct TypeExpr {
    /// The span of the type in the source text.
    pub span: Span,
    /// The kind of the type, by the form in which it is written.
    pub kind: TypeKind,
}

/// A type by the form in which it is written; whether its names exist is not known yet.
#[derive(Clone, Debug)]
pub enum TypeKind {
    /// A type by its name: `Length`, `std.smores.Smores`, `List<Length>`, `Vec3<Length>`.
    Named {
        /// The name, with those before its dots: at least one.
        path: Vec<Name>,
        /// The arguments in `< >`; empty if there are none.
        args: Vec<TypeExpr>,
    },
    /// `Quantity<kg*m^2>`: the unit as written (a lone name may be a dimension parameter).
    Quantity(UnitExpr),
    /// A type whose value may be missing: `T?`.
    Optional(Box<TypeExpr>),
    /// A function type: `fn(A, B) -> C`.
    Fn {
        /// The types of the parameters, in order.
        params: Vec<TypeExpr>,
        /// The type of the result, as written.
        result: Box<TypeExpr>,
    },
    /// A choice of two or more words and types: `exact | heuristic`, `auto | Int`, `Mesh | Cloud`.
    Choice(Vec<TypeExpr>),
    /// A type that could not be parsed, and was reported.
    Error,
}

/// A unit: a product of powers such as `N*m` or `m/s^2`.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitExpr {
    /// The span of the unit in the source text.
    pub span: Span,
    /// The units with their exponents, in order; the exponent of one after `/` is negative. Exponents are from -99 to
    /// 99.
    pub factors: Vec<(Name, i32)>,
}

// Connectors, modules, cells and struts.

/// A connector: `connector Name { clauses }`.
#[derive(Clone, Debug)]
pub struct Connector {
    /// The name that the declaration gives the connector.
    pub name: Name,
    /// The clauses between the braces, in the order of the text.
    pub clauses: Vec<ConnectorClause>,
}

/// A clause between the braces of a connector, by its keyword, with what was written after it.
#[derive(Clone, Debug)]
pub enum ConnectorClause {
    /// The connectors that the declared one mates with, by name: `mates Plug, Socket`.
    Mates(Vec<Name>),
    /// The number of turns at which the connector mates, evenly over a full turn: `turns 4`.
    Turns(Expr),
    /// The greatest force or torque that a bond of the connector holds: `holds 88N`, `holds 1.9N*m`.
    Holds(Expr),
    /// The error of position and angle that docking tolerates, and the speeds: `capture 4mm 5deg 10mm/s 5deg/s`.
    Capture {
        /// The span of the word `capture`.
        keyword: Span,
        /// The greatest distance of the ports, a length.
        distance: Expr,
        /// The bounds that are written after it: the greatest angle between the ports, and their greatest speed and angular
        /// speed against each other.
        more: Vec<Expr>,
    },
    /// Docking draws the ports together: `snap`.
    Snap,
    /// The joint of the bond: `hinge(axis: Z, range: ...)`.
    Hinge {
        /// The span of the word `hinge`.
        keyword: Span,
        /// The arguments in the parentheses, in order.
        args: Vec<Arg>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

/// A module: `module Name(params) { clauses }`.
#[derive(Clone, Debug)]
pub struct Module {
    /// The name that the declaration gives the module type.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The clauses between the braces, in the order of the text.
    pub clauses: Vec<ModuleClause>,
}

/// A clause of a module with its documentation.
#[derive(Clone, Debug)]
pub struct ModuleClause {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The text of the `///` lines before the clause, without the marks; `None` if there are none.
    pub doc: Option<String>,
    /// The kind of the clause, with what was written after its keyword.
    pub kind: ModuleClauseKind,
}

/// A clause between the braces of a module, by its keyword, with what was written after it; names are not resolved.
#[derive(Clone, Debug)]
pub enum ModuleClauseKind {
    /// The mass of the module: `mass 0.4kg`.
    Mass(Expr),
    /// The penetration depth beyond which links collide: `touch 0.2mm`.
    Touch(Expr),
    /// The greatest gap at which links touch the ground: `contact 4mm`.
    Contact(Expr),
    /// A link: `link body = shape collides shape at [...]`.
    Link {
        /// The name of the link, to which joints and ports refer.
        name: Name,
        /// The shape that is drawn, and that collides unless `collides` is written.
        shape: Expr,
        /// The shape after `collides`; `None` if the word is not written.
        collides: Option<Expr>,
        /// The pose of the shape in the link's frame; `None` for the link's frame itself.
        at: Option<Placement>,
    },
    /// A joint between two links: `joint bend : base -> tip = revolute(...) at [...]`.
    Joint {
        /// The name of the joint, by which programs command it.
        name: Name,
        /// The name of the link before `->`, which carries the joint.
        parent: Name,
        /// The name of the link after `->`, which the joint moves.
        child: Name,
        /// The expression for the kind of joint, such as `revolute(axis: Y)`.
        kind: Expr,
        /// The pose of the joint in the parent's frame; `None` for the parent's frame itself.
        at: Option<Placement>,
    },
    /// A joint that follows others: `joint b = -a`.
    Mimic {
        /// The name of the joint, by which programs command it.
        name: Name,
        /// The linear combination of joints that the joint follows.
        value: Expr,
    },
    /// A port or an array of ports: `port side[4] : Face on base at ... facing +X up +Z`.
    Port(ModulePort),
    /// A motor that drives several joints: `motor p = tilt + pan (max_speed: ..., max_torque: ...)`.
    Motor {
        /// The name of the motor, for messages and plans.
        name: Name,
        /// The linear combination of the joints that the motor drives.
        value: Expr,
        /// The limits in the parentheses; empty if there are none.
        args: Vec<Arg>,
    },
    /// Two links that may touch by design: `touching a b`.
    Touching(Name, Name),
    /// Another name for a joint, a port, or a joint and a port of one name: `alias pan = front`.
    Alias {
        /// The new name, which stands for the target.
        name: Name,
        /// The name of the joint or port.
        target: Name,
    },
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement on the declared values: `require condition, message`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If {
        /// The condition, an expression that has to be of type `Bool`.
        condition: Expr,
        /// The clauses that count if the condition holds, in order.
        then: Vec<ModuleClause>,
        /// The clauses that count if the condition does not hold; one `If` for `else if`, empty without `else`.
        otherwise: Vec<ModuleClause>,
    },
    /// A loop, such as one over the ports of an array: `for i in 0..4 { port side[i] : ... }`.
    For {
        /// The variable that holds the element in each pass of the loop.
        binder: Name,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that each pass of the loop carries out, in order.
        body: Vec<ModuleClause>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

/// A port of a module, or one element of a port array.
#[derive(Clone, Debug)]
pub struct ModulePort {
    /// The name of the port, or of the array that it belongs to.
    pub name: Name,
    /// The index in the port array, from 0; `None` for a single port.
    pub index: Option<Expr>,
    /// The name of the port's connector, with the module path before it, if any.
    pub connector: Vec<Name>,
    /// The name of the link that carries the port.
    pub link: Name,
    /// The pose of the port in the link's frame; `None` for the link's frame itself.
    pub at: Option<Placement>,
    /// The direction of the port's outward normal, in the link's frame.
    pub facing: Expr,
    /// The direction from which turns of a bond are counted, in the link's frame; `None` if it is not written.
    pub up: Option<Expr>,
}

/// A pose: `at [x, y, z] turned(Z, 90deg) turned(X, 10deg)`.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The position in the frame of the context, a vector of lengths.
    pub position: Expr,
    /// The arguments of each `turned`, in order; empty without one. Each turn is about an axis of the frame turned so
    /// far.
    pub turned: Vec<Vec<Arg>>,
}

/// The families whose declarations state facts and have no body of clauses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactsFamily {
    /// The family of cells, of which lattices are made: `cell`.
    Cell,
    /// The family of struts, of which trusses are made: `strut`.
    Strut,
}

impl FactsFamily {
    /// Returns the keyword of its declarations: `cell` or `strut`.
    pub fn word(self) -> &'static str {
        match self {
            FactsFamily::Cell => "cell",
            FactsFamily::Strut => "strut",
        }
    }
}

/// The body of a `cell` or a `strut`: `size 100mm  shrinks_to 50mm`.
#[derive(Clone, Debug)]
pub struct Facts {
    /// The family that the keyword names: cell or strut.
    pub family: FactsFamily,
    /// The name that the declaration gives the cell or strut.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The facts of the declaration as (name, value), in the order of the text.
    pub facts: Vec<(Name, Expr)>,
}

// Configurations.

/// A configuration, `config Name(params) closed { clauses }`, or a scene: the same with `scene`.
#[derive(Clone, Debug)]
pub struct Config {
    /// True for a scene: its parts need not be connected, and it has places, obstacles and a world.
    pub scene: bool,
    /// The name that the declaration gives the configuration.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The span of the word `closed`; `None` if it is not written.
    pub closed: Option<Span>,
    /// The clauses between the braces, in the order of the text.
    pub clauses: Vec<ConfigClause>,
}

/// A clause of a configuration with its documentation.
#[derive(Clone, Debug)]
pub struct ConfigClause {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The text of the `///` lines before the clause, without the marks; `None` if there are none.
    pub doc: Option<String>,
    /// The kind of the clause, with what was written after its keyword.
    pub kind: ConfigClauseKind,
}

/// A clause between the braces of a configuration, by its keyword, with what was written after it; names are not
/// resolved.
#[derive(Clone, Debug)]
pub enum ConfigClauseKind {
    /// A part, an instance of a module or configuration: `part name: Type`.
    Part(Part),
    /// A port or an array of ports of the whole: `port head = body.head`, `port side[4] = [...]`.
    Port {
        /// The name of the port or of the array.
        name: Name,
        /// The declared length of an array; `None` for a single port.
        count: Option<Expr>,
        /// The expression of the port, or of the list of ports, that the clause names.
        value: Expr,
    },
    /// The path of the base module, whose pose is that of the robot: `base path`.
    Base(Path),
    /// A behaviour: `behavior name = body`.
    Behavior(Behavior),
    /// A connection: `connect a -- b turn angle`.
    Connect {
        /// The path of the first port.
        a: Path,
        /// The path of the second port.
        b: Path,
        /// The angle after `turn`; `None` if the word is not written.
        turn: Option<Expr>,
    },
    /// A start position: `set joint = value`.
    Set {
        /// The path of the joint.
        joint: Path,
        /// The position of the joint at the start, an angle or a length.
        value: Expr,
    },
    /// An obstacle, or one element of an array: `obstacle wall = box(...) at [...]`, `obstacle post[i] = ...`.
    Obstacle {
        /// The name of the obstacle or of the array.
        name: Name,
        /// The index in the array, from 0; `None` for a single obstacle.
        index: Option<Expr>,
        /// The solid.
        value: Expr,
        /// The pose of the solid in the world; `None` where it stays as it is.
        at: Option<Placement>,
    },
    /// The world of plans of a scene, as a call of the built-in `world`: `world(terrain: ..., friction: ...)`.
    World(Expr),
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement on the declared values: `require condition, message`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If {
        /// The condition, an expression that has to be of type `Bool`.
        condition: Expr,
        /// The clauses that count if the condition holds, in order.
        then: Vec<ConfigClause>,
        /// The clauses that count if the condition does not hold; one `If` for `else if`, empty without `else`.
        otherwise: Vec<ConfigClause>,
    },
    /// A loop: `for name in iterable { ... }`.
    For {
        /// The variable that holds the element in each pass of the loop.
        binder: Name,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that each pass of the loop carries out, in order.
        body: Vec<ConfigClause>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

/// A part of a configuration: `part leg[i in 0..4]: Leg(left: i < 2)`.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name of the part, or of the list of parts.
    pub name: Name,
    /// The length of a list of parts; `None` for a single part.
    pub count: Option<PartCount>,
    /// The path of the module or configuration that the part is an instance of.
    pub ty: Vec<Name>,
    /// The arguments, in order; `None` if no parentheses are written.
    pub args: Option<Vec<Arg>>,
    /// The pose of the part's base in a scene; `None` if it is not written.
    pub at: Option<Placement>,
    /// The span of the path of the type, without its arguments.
    pub ty_span: Span,
}

/// The length of a list of parts.
#[derive(Clone, Debug)]
pub enum PartCount {
    /// A number of equal parts: `leg[4]`.
    Number(Expr),
    /// One part for each element of a list or range, which its arguments can refer to: `leg[i in 0..4]`.
    Each {
        /// The variable that holds the element.
        binder: Name,
        /// The list or range whose elements the parts are made for.
        range: Expr,
    },
}

/// A behaviour of a configuration: `behavior name(params) allows exemptions = body`.
#[derive(Clone, Debug)]
pub struct Behavior {
    /// The name that the declaration gives the behaviour.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The checks that the behaviour is excused from, in the order of the text.
    pub allows: Vec<Exemption>,
    /// The expression after `=`, which gives the behaviour.
    pub body: Expr,
}

/// An exemption of a behaviour: `unstable`, `slip`, `collision(a, b)`, `overload(j)`.
#[derive(Clone, Debug)]
pub struct Exemption {
    /// The word for the check that is excused, such as `slip`.
    pub name: Name,
    /// The arguments of the exemption in parentheses, in order; empty without.
    pub args: Vec<Expr>,
    /// The span of the exemption in the source text.
    pub span: Span,
}

/// A requirement, `require condition, message`, or a statement of what a behaviour brings about, `ensure condition, message`.
#[derive(Clone, Debug)]
pub struct Require {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The condition that must hold, an expression of type `Bool`.
    pub condition: Expr,
    /// The message if the condition does not hold, a text; `None` if none is written.
    pub message: Option<Expr>,
}

/// A path `body.side[i]`, `m[0].left`: a name, then steps `.name` and `[index]`.
#[derive(Clone, Debug)]
pub struct Path {
    /// The span of the whole path in the source text.
    pub span: Span,
    /// The first name of the path, which the steps begin at.
    pub root: Name,
    /// The steps after `root`, in order; empty for a single name.
    pub steps: Vec<PathStep>,
}

/// A step of a [`Path`] from a thing to one in it: to a member by name, or to an element by index.
#[derive(Clone, Debug)]
pub enum PathStep {
    /// A step to a member by its name: `.name`.
    Field(Name),
    /// A step to an element by its index: `[index]`.
    Index {
        /// The expression for the index, counted from 0.
        index: Expr,
        /// The span of the step, brackets included.
        span: Span,
    },
}

// Lattices and trusses.

/// A lattice: `lattice Name(params) of cell = value`.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// The name that the declaration gives the lattice.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The path of the cell that the lattice is made of: a name, or several with dots between them.
    pub of: Vec<Name>,
    /// The expression of type `Cells` that gives the places of the cells.
    pub value: Expr,
}

/// A truss: `truss Name(params) of strut { clauses }`, or `= value` instead of clauses.
#[derive(Clone, Debug)]
pub struct Truss {
    /// The name that the declaration gives the truss.
    pub name: Name,
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The path of the strut that the truss is made of: a name, or several with dots between them.
    pub of: Vec<Name>,
    /// The nodes and struts, as a value or as clauses.
    pub body: TrussBody,
}

/// The nodes and struts of a truss.
#[derive(Clone, Debug)]
pub enum TrussBody {
    /// A value of the prelude's record `Frame`: `= value`.
    Value(Expr),
    /// The clauses that declare nodes and struts, in the order of the text: `{ clauses }`.
    Clauses(Vec<TrussClause>),
}

/// A clause between the braces of a truss, with its span; unlike other clauses it has no documentation.
#[derive(Clone, Debug)]
pub struct TrussClause {
    /// The span of the clause in the source text.
    pub span: Span,
    /// The kind of the clause, with what was written after its keyword.
    pub kind: TrussClauseKind,
}

/// A clause of a truss by its keyword, with what was written after it; names are not resolved.
#[derive(Clone, Debug)]
pub enum TrussClauseKind {
    /// A node: `node a = [0m, 0m, 0m]`, or one of an array, `node ring[i] = ...`.
    Node {
        /// The name of the node or of the array of nodes.
        name: Name,
        /// The index in the array; `None` for a single node.
        index: Option<Expr>,
        /// The position of the node, a vector of lengths.
        value: Expr,
    },
    /// A strut between two nodes: `strut a -- b`.
    Strut {
        /// The path of the first node.
        a: Path,
        /// The path of the second node.
        b: Path,
    },
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement on the declared values: `require condition, message`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If {
        /// The condition, an expression that has to be of type `Bool`.
        condition: Expr,
        /// The clauses that count if the condition holds, in order.
        then: Vec<TrussClause>,
        /// The clauses that count if the condition does not hold; one `If` for `else if`, empty without `else`.
        otherwise: Vec<TrussClause>,
    },
    /// A loop: `for name in iterable { ... }`.
    For {
        /// The variable that holds the element in each pass of the loop.
        binder: Name,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that each pass of the loop carries out, in order.
        body: Vec<TrussClause>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

// Statements and expressions.

/// A study: `study name(axis in values, ...) by sampler(...) each axis in values = body`.
#[derive(Clone, Debug)]
pub struct Study {
    /// The name that the declaration gives the study.
    pub name: Name,
    /// The axes between the parentheses, in order: what the sampler chooses.
    pub axes: Vec<StudyAxis>,
    /// The name of the sampler after `by`.
    pub sampler: Name,
    /// The arguments of the sampler.
    pub settings: Vec<Arg>,
    /// The axes after `each`, in order: every point is evaluated for each of their values.
    pub each: Vec<StudyAxis>,
    /// The expression or block after `=`, which gives the row of a point.
    pub body: Expr,
}

/// An axis of a study: `amplitude in 8deg..40deg`.
#[derive(Clone, Debug)]
pub struct StudyAxis {
    /// The name of the axis, a variable of the body.
    pub name: Name,
    /// The list or range of the values of the axis.
    pub domain: Expr,
}

/// A test: `test "name" { statements }`.
#[derive(Clone, Debug)]
pub struct Test {
    /// The name of the test, a text without interpolation.
    pub name: String,
    /// The span of the name, quotes included.
    pub name_span: Span,
    /// The statements between the braces of the test, in order.
    pub body: Vec<Stmt>,
}

/// A statement as written, with its span; it is not checked yet.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// The span of the statement in the source text.
    pub span: Span,
    /// The kind of the statement, with what was written after its keyword.
    pub kind: StmtKind,
}

/// A statement by its keyword, with what was written after it; without one it is an expression.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A definition: `let name = value`.
    Let(Let),
    /// An expression as a statement, whose value may be printed.
    Expr(Expr),
    /// A test of a condition: `expect condition, message`.
    Expect {
        /// The condition that the test expects to hold.
        condition: Expr,
        /// The message if the condition does not hold, a text; `None` if none is written.
        message: Option<Expr>,
    },
    /// A requirement on the declared values, or on the state in which a behaviour begins: `require condition, message`.
    Require(Require),
    /// A statement of what a behaviour brings about: `ensure condition, message`.
    Ensure(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If {
        /// The condition, an expression that has to be of type `Bool`.
        condition: Expr,
        /// The statements that are executed if the condition holds, in order.
        then: Vec<Stmt>,
        /// The statements that are executed if the condition does not hold; one `If` for `else if`, empty without
        /// `else`.
        otherwise: Vec<Stmt>,
    },
    /// A loop: `for name in iterable { ... }`.
    For {
        /// The variable that holds the element in each pass of the loop.
        binder: Name,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The statements that each pass of the loop carries out, in order.
        body: Vec<Stmt>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

/// An expression as written, with its span; its type is found by `check`.
#[derive(Clone, Debug)]
pub struct Expr {
    /// The span of the expression in the source text.
    pub span: Span,
    /// The kind of the expression, by its form.
    pub kind: ExprKind,
}

/// An expression by its form, with its parts; names are not resolved, and numbers not scaled by their units.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A number, perhaps with a unit: `12`, `1_000`, `90deg`.
    Number {
        /// The digits with point and exponent, without underscores.
        digits: Symbol,
        /// The unit attached to the digits; `None` for a plain number.
        unit: Option<UnitExpr>,
    },
    /// A truth value: `true` or `false`.
    Bool(bool),
    /// A text, perhaps with `{expr}` in it; a plain text is one `Literal`, an empty one none.
    Text(Vec<TextPart>),
    /// A name, which is not looked up yet.
    Name(Symbol),
    /// A coordinate axis: `X`, `Y`, `Z`; `-X` is a `Unary`.
    Axis(Axis),
    /// The missing value, as in the rows of a gait table, or the last value of a session: `_`.
    Hole,
    /// A list of its elements, in order: `[a, b]`.
    List(Vec<Expr>),
    /// A list comprehension: `[e for x in xs if c for y in ys]`.
    Comprehension {
        /// The expression that is evaluated for each element.
        body: Box<Expr>,
        /// The clauses, in order; the first is a loop.
        clauses: Vec<ComprehensionClause>,
    },
    /// A prefix operator, such as `-` or `not`, with its operand.
    Unary {
        /// The operator between or before the operands.
        op: UnaryOp,
        /// The span of the operator alone in the source text.
        op_span: Span,
        /// The operand after the operator.
        operand: Box<Expr>,
    },
    /// An infix operator, such as `+` or `and`, with its two operands.
    Binary {
        /// The operator between or before the operands.
        op: BinaryOp,
        /// The span of the operator alone in the source text.
        op_span: Span,
        /// The operand before the operator.
        left: Box<Expr>,
        /// The operand after the operator.
        right: Box<Expr>,
    },
    /// A range of numbers or quantities: `a..b`.
    Range {
        /// The expression for the first end.
        from: Box<Expr>,
        /// The expression for the second end.
        to: Box<Expr>,
    },
    /// A value with one for the case that it is missing: `x else y`. It binds like `or`.
    Otherwise {
        /// The expression whose value may be missing.
        value: Box<Expr>,
        /// The expression for the value in its place.
        otherwise: Box<Expr>,
    },
    /// A call of a function, a behaviour, or a type for an instance: `callee(args)`.
    Call {
        /// The expression for the function, or the type of an instance.
        callee: Box<Expr>,
        /// The arguments in the parentheses, in order.
        args: Vec<Arg>,
    },
    /// An element of a list or a vector: `object[index]`.
    Index {
        /// The expression for the list or vector.
        object: Box<Expr>,
        /// The expression for the index, counted from 0.
        index: Box<Expr>,
    },
    /// A member of a value: `object.field`.
    Field {
        /// The expression before the dot.
        object: Box<Expr>,
        /// The name of the member, after the dot.
        field: Name,
    },
    /// A changed copy of a record: `object with { bend: 40deg }`.
    With {
        /// The expression for the record.
        object: Box<Expr>,
        /// The fields that change, in order; each has a name.
        fields: Vec<Arg>,
    },
    /// A conditional expression, whose branches are blocks: `if c { a } else { b }`.
    If {
        /// The condition, an expression that has to be of type `Bool`.
        condition: Box<Expr>,
        /// The block that gives the value if the condition holds.
        then: Box<Expr>,
        /// The block, or the next `If`, after `else`; `None` without `else`.
        otherwise: Option<Box<Expr>>,
    },
    /// A block of statements that may end with a value: `{ let a = ... newline expr }`.
    Block {
        /// The statements before the value, in order.
        statements: Vec<Stmt>,
        /// The expression that ends the block; `None` if a statement does, or if it is empty.
        value: Option<Box<Expr>>,
    },
    /// An anonymous function: `x => e`, `(a, b) => e`.
    Lambda {
        /// The names of the parameters, in order.
        params: Vec<Name>,
        /// The expression or block that gives the result.
        body: Box<Expr>,
    },
    /// A piece of text that could not be parsed, and was reported.
    Error,
}

/// A piece of a text between quotes: characters as they are, or `{…}` with an expression in it.
#[derive(Clone, Debug)]
pub enum TextPart {
    /// Text as it is, with escapes resolved.
    Literal(String),
    /// An interpolated value, shown as `print` shows it: `{expr}`.
    Value(Expr),
    /// An interpolated quantity in a stated unit, or with a stated number of decimals: `{expr in mm:.2}`.
    Shown {
        /// The expression for the quantity.
        value: Expr,
        /// The unit in which the quantity is shown, if one is stated.
        unit: Option<UnitExpr>,
        /// The number of decimals, as written, with its span, if one is stated.
        decimals: Option<(Symbol, Span)>,
    },
}

/// A clause of a list comprehension, after the expression for each element: a loop or a filter.
#[derive(Clone, Debug)]
pub enum ComprehensionClause {
    /// A loop: `for name in iterable`.
    For {
        /// The variable that holds the element in each pass of the loop.
        binder: Name,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
    },
    /// A filter, which leaves out elements for which the condition is false: `if condition`.
    If(Expr),
}

/// An argument in parentheses or braces, perhaps with a name: of a call, a motor, a hinge, or of `with`.
#[derive(Clone, Debug)]
pub struct Arg {
    /// The name in front of the argument, `name: value`; `None` for an argument by position.
    pub name: Option<Name>,
    /// The expression for the value of the argument.
    pub value: Expr,
}

/// A coordinate axis of the frame, as a unit vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The unit vector along the x axis: `X`.
    X,
    /// The unit vector along the y axis: `Y`.
    Y,
    /// The unit vector along the z axis: `Z`.
    Z,
}

/// A prefix operator, in front of its one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    /// The negative of a number, quantity or vector: `-a`.
    Neg,
    /// The operand itself, unchanged: `+a`.
    Plus,
    /// The logical negation of a truth value or condition: `not a`.
    Not,
}

/// An infix operator, between its two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// The logical disjunction: `a or b`.
    Or,
    /// The logical conjunction: `a and b`.
    And,
    /// The comparison for equality: `a == b`.
    Eq,
    /// The comparison for inequality: `a != b`.
    Ne,
    /// The comparison less than: `a < b`.
    Lt,
    /// The comparison at most: `a <= b`.
    Le,
    /// The comparison greater than: `a > b`.
    Gt,
    /// The comparison at least: `a >= b`.
    Ge,
    /// The condition that two ports are mated: `a <-> b`.
    Mated,
    /// Concatenation of lists or texts, or plans one after another: `++`.
    Join,
    /// The sum of the operands: `a + b`.
    Add,
    /// The difference of the operands: `a - b`.
    Sub,
    /// The product of the operands: `a * b`.
    Mul,
    /// The quotient of the operands: `a / b`.
    Div,
    /// The remainder of a division of the operands: `a % b`.
    Rem,
    /// The power of the left operand with the right one as exponent: `a ^ b`.
    Pow,
}
