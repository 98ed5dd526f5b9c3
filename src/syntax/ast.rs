//! The syntax tree of one file. Every node carries its span; comments are kept beside the tree, by
//! position.
//!
//! The tree holds what was written: names are not resolved, units not looked up, numbers not scaled. A
//! piece of text that could not be parsed is an `Error` node, about which later rooms report nothing (the
//! parser has).

use crate::source::{FileId, Span, Symbol};

/// A name with its span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Name {
    /// The name.
    pub text: Symbol,
    /// Its span.
    pub span: Span,
}

/// The tree of one file.
#[derive(Clone, Debug)]
pub struct File {
    /// The identity of the file.
    pub id: FileId,
    /// The text of the `//!` lines, without the marks.
    pub doc: Option<String>,
    /// The items, in order.
    pub items: Vec<Item>,
    /// All comments, documentation included, in order of position.
    pub comments: Vec<Comment>,
    /// The names that unreadable pieces would have declared; they are not reported as unknown.
    pub unread: Vec<Symbol>,
}

/// A comment with its kind and span.
#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    /// Its span, marks included.
    pub span: Span,
    /// Its kind.
    pub kind: CommentKind,
}

/// The kinds of comments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommentKind {
    /// A line comment: `//`.
    Line,
    /// A block comment: `/* */`.
    Block,
    /// The documentation of an item: `///`.
    ItemDoc,
    /// The documentation of a file: `//!`.
    FileDoc,
}

/// An item with its documentation.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its span.
    pub span: Span,
    /// The text of the `///` lines before the item, without the marks.
    pub doc: Option<String>,
    /// Its kind.
    pub kind: ItemKind,
}

/// The kinds of items.
#[derive(Clone, Debug)]
pub enum ItemKind {
    /// An import: `use`.
    Use(Use),
    /// A constant: `let`.
    Let(Let),
    /// A function: `fn`.
    Fn(Fn),
    /// A built-in function: `extern fn`.
    ExternFn(ExternFn),
    /// A record type: `extern type`.
    ExternType(ExternType),
    /// A connector: `connector`.
    Connector(Connector),
    /// A module: `module`.
    Module(Module),
    /// A cell of a lattice or a strut of a truss: `cell`, `strut`.
    Facts(Facts),
    /// A configuration: `config`.
    Config(Config),
    /// A lattice: `lattice`.
    Lattice(Lattice),
    /// A truss: `truss`.
    Truss(Truss),
    /// A test: `test`.
    Test(Test),
    /// A statement at the top of the file.
    Statement(Stmt),
    /// An item that could not be parsed.
    Error,
}

impl ItemKind {
    /// Returns the name that the item declares; `None` for an import, a test, a statement.
    pub fn name(&self) -> Option<Name> {
        Some(match self {
            ItemKind::Let(x) => x.name,
            ItemKind::Fn(x) => x.name,
            ItemKind::ExternFn(x) => x.name,
            ItemKind::ExternType(x) => x.name,
            ItemKind::Connector(x) => x.name,
            ItemKind::Module(x) => x.name,
            ItemKind::Facts(x) => x.name,
            ItemKind::Config(x) => x.name,
            ItemKind::Lattice(x) => x.name,
            ItemKind::Truss(x) => x.name,
            ItemKind::Use(_) | ItemKind::Test(_) | ItemKind::Statement(_) | ItemKind::Error => return None,
        })
    }
}

/// An import: `use std.smores.{Smores, Chain3 as Chain}`, `use "parts/claw.mod".{Claw}`, `use std.gaits`.
#[derive(Clone, Debug)]
pub struct Use {
    /// The file, or the path that names it.
    pub source: UseSource,
    /// The imported names. `None`: a bare `use std.gaits`, which imports the last word of the path: a file,
    /// or an item of the file that the path before it names. `check` refuses `use "claw.mod"` without
    /// names.
    pub names: Option<Vec<UseName>>,
}

/// The source of an import.
#[derive(Clone, Debug)]
pub enum UseSource {
    /// A module path: `std.smores`.
    Path(Vec<Name>),
    /// A path relative to the importing file; the span covers the quotes.
    File { path: String, span: Span },
}

/// One imported name.
#[derive(Clone, Debug)]
pub struct UseName {
    /// The name in the imported file.
    pub name: Name,
    /// The name behind `as`.
    pub rename: Option<Name>,
}

/// A declaration of a value: `let name: type = value`.
#[derive(Clone, Debug)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// The declared type.
    pub ty: Option<TypeExpr>,
    /// The value.
    pub value: Expr,
}

/// A function: `fn name(params) -> result = body`.
#[derive(Clone, Debug)]
pub struct Fn {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The declared type of the result.
    pub result: Option<TypeExpr>,
    /// The body.
    pub body: Expr,
}

/// A native function: `extern fn clamp<D: Dimension>(x: Quantity<D>, to: Range<Quantity<D>>) ->
/// Quantity<D>`
#[derive(Clone, Debug)]
pub struct ExternFn {
    /// Its name.
    pub name: Name,
    /// The type parameters. The checker takes at most one.
    pub type_params: Vec<TypeParam>,
    /// The parameters.
    pub params: Vec<Param>,
    /// The declared type of the result.
    pub result: Option<TypeExpr>,
}

/// A type parameter of an `extern fn`.
#[derive(Clone, Debug)]
pub struct TypeParam {
    /// Its name.
    pub name: Name,
    /// The bound: a supertype, or `Dimension`.
    pub bound: Option<Name>,
}

/// A record: `extern type Folding is Plan { layout: Layout fn at(t: Time) -> State }`
#[derive(Clone, Debug)]
pub struct ExternType {
    /// Its name.
    pub name: Name,
    /// The record that it extends.
    pub is: Option<Name>,
    /// The fields.
    pub fields: Vec<ExternField>,
    /// The methods with their documentation.
    pub methods: Vec<(Option<String>, ExternFn)>,
}

/// A field of a record.
#[derive(Clone, Debug)]
pub struct ExternField {
    /// The text of the `///` lines before it.
    pub doc: Option<String>,
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: TypeExpr,
}

/// A parameter. In an `extern fn` its name may be a reserved word (`for:`), and it may be variadic.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: TypeExpr,
    /// The default value.
    pub default: Option<Expr>,
    /// True for `b: Behavior...`, which takes all remaining arguments.
    pub variadic: bool,
}

/// A type as written.
#[derive(Clone, Debug)]
pub struct TypeExpr {
    /// Its span.
    pub span: Span,
    /// Its kind.
    pub kind: TypeKind,
}

/// The kinds of types as written.
#[derive(Clone, Debug)]
pub enum TypeKind {
    /// A type by its name: `Length`, `std.smores.Smores`, `List<Length>`, `Vec3<Length>`.
    Named { path: Vec<Name>, args: Vec<TypeExpr> },
    /// `Quantity<kg*m^2>`: the unit as written (a lone name may be a dimension parameter).
    Quantity(UnitExpr),
    /// A type whose value may be missing: `T?`.
    Optional(Box<TypeExpr>),
    /// A function type: `fn(A, B) -> C`.
    Fn { params: Vec<TypeExpr>, result: Box<TypeExpr> },
    /// `exact | enumerate | heuristic`, `auto | Int`, `Mesh | Cloud`; at least two.
    Choice(Vec<TypeExpr>),
    /// A type that could not be parsed.
    Error,
}

/// A unit: a product of powers such as `N*m` or `m/s^2`. Exponents behind `/` are negative.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitExpr {
    /// Its span.
    pub span: Span,
    /// The units with their exponents, in order.
    pub factors: Vec<(Name, i32)>,
}

// Connectors, modules, cells and struts.

/// A connector: `connector Name { clauses }`.
#[derive(Clone, Debug)]
pub struct Connector {
    /// Its name.
    pub name: Name,
    /// The clauses, in order.
    pub clauses: Vec<ConnectorClause>,
}

/// A clause of a connector.
#[derive(Clone, Debug)]
pub enum ConnectorClause {
    /// `mates Socket`, `mates Plug, Socket` is two clauses' worth of names.
    Mates(Vec<Name>),
    /// `turns 4`: the number of turns at which it mates.
    Turns(Expr),
    /// The greatest force or torque that it holds: `holds 88N`, `holds 1.9N*m`.
    Holds(Expr),
    /// The error that docking tolerates: `capture 4mm 5deg`.
    Capture { keyword: Span, distance: Expr, angle: Option<Expr> },
    /// The joint of the bond: `hinge(axis: Z, range: ...)`.
    Hinge { keyword: Span, args: Vec<Arg> },
    /// A piece that could not be parsed.
    Error,
}

/// A module: `module Name(params) { clauses }`.
#[derive(Clone, Debug)]
pub struct Module {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The clauses, in order.
    pub clauses: Vec<ModuleClause>,
}

/// A clause of a module with its documentation.
#[derive(Clone, Debug)]
pub struct ModuleClause {
    /// Its span.
    pub span: Span,
    /// The text of the `///` lines before it.
    pub doc: Option<String>,
    /// Its kind.
    pub kind: ModuleClauseKind,
}

/// The kinds of clauses of a module.
#[derive(Clone, Debug)]
pub enum ModuleClauseKind {
    /// The mass of the module: `mass 0.4kg`.
    Mass(Expr),
    /// `touch 0.2mm`: penetration deeper than this is a collision.
    Touch(Expr),
    /// `contact 4mm`: links within this of the ground touch it.
    Contact(Expr),
    /// A link: `link body = shape collides shape at [...]`.
    Link { name: Name, shape: Expr, collides: Option<Expr>, at: Option<Placement> },
    /// `joint bend : base -> tip = revolute(...) at [...]`; `kind` is a call.
    Joint { name: Name, parent: Name, child: Name, kind: Expr, at: Option<Placement> },
    /// A joint that follows others: `joint b = -a`.
    Mimic { name: Name, value: Expr },
    /// A port or an array of ports: `port side[4] : Face on base at ... facing +X up +Z`.
    Port(ModulePort),
    /// A motor that drives several joints: `motor p = tilt + pan (max_speed: ..., max_torque: ...)`.
    Motor { name: Name, value: Expr, args: Vec<Arg> },
    /// Two links that meet by design: `touching a b`.
    Touching(Name, Name),
    /// `alias pan = front`: another name for a joint or a port.
    Alias { name: Name, target: Name },
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement: `require condition`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If { condition: Expr, then: Vec<ModuleClause>, otherwise: Vec<ModuleClause> },
    /// The ports of an array are declared in a loop: `for i in 0..4 { port side[i] : ... }`.
    For { binder: Name, iterable: Expr, body: Vec<ModuleClause> },
    /// A piece that could not be parsed.
    Error,
}

/// A port of a module, or one element of a port array.
#[derive(Clone, Debug)]
pub struct ModulePort {
    /// Its name.
    pub name: Name,
    /// The index in the port array, inside a `for`.
    pub index: Option<Expr>,
    /// The path of the connector.
    pub connector: Vec<Name>,
    /// The link that carries it.
    pub link: Name,
    /// The pose in the link's frame.
    pub at: Option<Placement>,
    /// The direction of its outward normal.
    pub facing: Expr,
    /// The direction from which turns are counted.
    pub up: Option<Expr>,
}

/// A pose: `at [x, y, z] turned(Z, 90deg) turned(X, 10deg)`
#[derive(Clone, Debug)]
pub struct Placement {
    /// Its span.
    pub span: Span,
    /// The position.
    pub position: Expr,
    /// The arguments of each `turned`, in order.
    pub turned: Vec<Vec<Arg>>,
}

/// The families whose declarations state facts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactsFamily {
    /// Cells of lattices: `cell`.
    Cell,
    /// Struts of trusses: `strut`.
    Strut,
}

impl FactsFamily {
    /// Returns the keyword: `cell`.
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
    /// Its family.
    pub family: FactsFamily,
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The facts as (name, value), in order.
    pub facts: Vec<(Name, Expr)>,
}

// Configurations.

/// A configuration: `config Name(params) closed { clauses }`.
#[derive(Clone, Debug)]
pub struct Config {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The span of the word `closed`, if it is written.
    pub closed: Option<Span>,
    /// The clauses, in order.
    pub clauses: Vec<ConfigClause>,
}

/// A clause of a configuration with its documentation.
#[derive(Clone, Debug)]
pub struct ConfigClause {
    /// Its span.
    pub span: Span,
    /// The text of the `///` lines before it.
    pub doc: Option<String>,
    /// Its kind.
    pub kind: ConfigClauseKind,
}

/// The kinds of clauses of a configuration.
#[derive(Clone, Debug)]
pub enum ConfigClauseKind {
    /// A part: `part name: Type`.
    Part(Part),
    /// A port or an array of ports of the whole: `port head = body.head`, `port side[4] = [...]`.
    Port { name: Name, count: Option<Expr>, value: Expr },
    /// The base module: `base path`.
    Base(Path),
    /// A behaviour: `behavior name = body`.
    Behavior(Behavior),
    /// A connection: `connect a -- b turn angle`.
    Connect { a: Path, b: Path, turn: Option<Expr> },
    /// A start position: `set joint = value`.
    Set { joint: Path, value: Expr },
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement: `require condition`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If { condition: Expr, then: Vec<ConfigClause>, otherwise: Vec<ConfigClause> },
    /// A loop: `for name in iterable { ... }`.
    For { binder: Name, iterable: Expr, body: Vec<ConfigClause> },
    /// A piece that could not be parsed.
    Error,
}

/// A part of a configuration: `part leg[i in 0..4]: Leg(left: i < 2)`
#[derive(Clone, Debug)]
pub struct Part {
    /// Its name.
    pub name: Name,
    /// The length of a list of parts.
    pub count: Option<PartCount>,
    /// The path of the type.
    pub ty: Vec<Name>,
    /// The arguments; `None` if no parentheses are written.
    pub args: Option<Vec<Arg>>,
    /// The span of the type and its arguments.
    pub ty_span: Span,
}

/// The length of a list of parts.
#[derive(Clone, Debug)]
pub enum PartCount {
    /// A number of equal parts: `leg[4]`.
    Number(Expr),
    /// One part for each element of a range, which its arguments can refer to: `leg[i in 0..4]`.
    Each { binder: Name, range: Expr },
}

/// A behaviour of a configuration: `behavior name(params) allows exemptions = body`.
#[derive(Clone, Debug)]
pub struct Behavior {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The exemptions, in order.
    pub allows: Vec<Exemption>,
    /// The body.
    pub body: Expr,
}

/// An exemption of a behaviour: `unstable`, `slip`, `collision(a, b)`, `overload(j)`
#[derive(Clone, Debug)]
pub struct Exemption {
    /// Its name.
    pub name: Name,
    /// Its arguments.
    pub args: Vec<Expr>,
    /// Its span.
    pub span: Span,
}

/// A requirement: `require condition, message`.
#[derive(Clone, Debug)]
pub struct Require {
    /// Its span.
    pub span: Span,
    /// The condition that must hold.
    pub condition: Expr,
    /// The message if it does not.
    pub message: Option<Expr>,
}

/// A path `body.side[i]`, `m[0].left`: a name, then steps `.name` and `[index]`.
#[derive(Clone, Debug)]
pub struct Path {
    /// Its span.
    pub span: Span,
    /// The first name.
    pub root: Name,
    /// The steps, in order.
    pub steps: Vec<PathStep>,
}

/// A step of a path.
#[derive(Clone, Debug)]
pub enum PathStep {
    /// A member: `.name`.
    Field(Name),
    /// An element: `[index]`.
    Index { index: Expr, span: Span },
}

// Lattices and trusses.

/// A lattice: `lattice Name(params) of cell = value`.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The path of the cell.
    pub of: Vec<Name>,
    /// The cells.
    pub value: Expr,
}

/// A truss: `truss Name(params) of strut { clauses }`, or `= value` instead of clauses.
#[derive(Clone, Debug)]
pub struct Truss {
    /// Its name.
    pub name: Name,
    /// The parameters.
    pub params: Vec<Param>,
    /// The path of the strut.
    pub of: Vec<Name>,
    /// The nodes and struts.
    pub body: TrussBody,
}

/// The nodes and struts of a truss.
#[derive(Clone, Debug)]
pub enum TrussBody {
    /// `= value`, a value of the prelude's record `Frame`.
    Value(Expr),
    /// Clauses: `{ clauses }`.
    Clauses(Vec<TrussClause>),
}

/// A clause of a truss.
#[derive(Clone, Debug)]
pub struct TrussClause {
    /// Its span.
    pub span: Span,
    /// Its kind.
    pub kind: TrussClauseKind,
}

/// The kinds of clauses of a truss.
#[derive(Clone, Debug)]
pub enum TrussClauseKind {
    /// `node a = [0m, 0m, 0m]`, in a loop `node ring[i] = ...`
    Node { name: Name, index: Option<Expr>, value: Expr },
    /// A strut between two nodes: `strut a -- b`.
    Strut { a: Path, b: Path },
    /// A definition: `let name = value`.
    Let(Let),
    /// A requirement: `require condition`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If { condition: Expr, then: Vec<TrussClause>, otherwise: Vec<TrussClause> },
    /// A loop: `for name in iterable { ... }`.
    For { binder: Name, iterable: Expr, body: Vec<TrussClause> },
    /// A piece that could not be parsed.
    Error,
}

// Statements and expressions.

/// A test: `test "name" { statements }`.
#[derive(Clone, Debug)]
pub struct Test {
    /// The name, a text without interpolation.
    pub name: String,
    /// The span of the name, quotes included.
    pub name_span: Span,
    /// The statements.
    pub body: Vec<Stmt>,
}

/// A statement with its span.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// Its span.
    pub span: Span,
    /// Its kind.
    pub kind: StmtKind,
}

/// The kinds of statements.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A definition: `let name = value`.
    Let(Let),
    /// An expression.
    Expr(Expr),
    /// A test of a condition: `expect condition, message`.
    Expect { condition: Expr, message: Option<Expr> },
    /// A requirement: `require condition`.
    Require(Require),
    /// A branch: `if condition { ... } else { ... }`.
    If { condition: Expr, then: Vec<Stmt>, otherwise: Vec<Stmt> },
    /// A loop: `for name in iterable { ... }`.
    For { binder: Name, iterable: Expr, body: Vec<Stmt> },
    /// A piece that could not be parsed.
    Error,
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Its span.
    pub span: Span,
    /// Its kind.
    pub kind: ExprKind,
}

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// `12`, `1_000`, `90deg`: the digits as written without underscores, and the unit attached to them.
    Number { digits: Symbol, unit: Option<UnitExpr> },
    /// A truth value: `true`, `false`.
    Bool(bool),
    /// Text with `{expr}` in it; a plain text is one `Literal` (or none, when empty).
    Text(Vec<TextPart>),
    /// A name.
    Name(Symbol),
    /// A coordinate axis: `X`, `Y`, `Z`; `-X` is a `Unary`.
    Axis(Axis),
    /// `_`: the missing value, as in the rows of a gait table.
    Hole,
    /// A list: `[a, b]`.
    List(Vec<Expr>),
    /// A list comprehension: `[e for x in xs if c for y in ys]`.
    Comprehension { body: Box<Expr>, clauses: Vec<ComprehensionClause> },
    /// A prefix operator with its operand.
    Unary { op: UnaryOp, op_span: Span, operand: Box<Expr> },
    /// An infix operator with its operands.
    Binary { op: BinaryOp, op_span: Span, left: Box<Expr>, right: Box<Expr> },
    /// A range: `a..b`.
    Range { from: Box<Expr>, to: Box<Expr> },
    /// `x else y`: `y` if `x` is missing. It binds like `or`.
    Otherwise { value: Box<Expr>, otherwise: Box<Expr> },
    /// A call: `callee(args)`.
    Call { callee: Box<Expr>, args: Vec<Arg> },
    /// An element of a list: `object[index]`.
    Index { object: Box<Expr>, index: Box<Expr> },
    /// A member of a value: `object.field`.
    Field { object: Box<Expr>, field: Name },
    /// `if c { a } else { b }`; the branches are blocks.
    If { condition: Box<Expr>, then: Box<Expr>, otherwise: Option<Box<Expr>> },
    /// A block: `{ let a = ... newline expr }`; without `value` it has none.
    Block { statements: Vec<Stmt>, value: Option<Box<Expr>> },
    /// An anonymous function: `x => e`, `(a, b) => e`.
    Lambda { params: Vec<Name>, body: Box<Expr> },
    /// A piece that could not be parsed.
    Error,
}

/// A piece of a text.
#[derive(Clone, Debug)]
pub enum TextPart {
    /// Escapes already resolved.
    Literal(String),
    /// An interpolated value: `{expr}`.
    Value(Expr),
}

/// A clause of a comprehension.
#[derive(Clone, Debug)]
pub enum ComprehensionClause {
    /// A loop: `for name in iterable`.
    For { binder: Name, iterable: Expr },
    /// A filter: `if condition`.
    If(Expr),
}

/// An argument of a call.
#[derive(Clone, Debug)]
pub struct Arg {
    /// The name in front of it: `name: value`.
    pub name: Option<Name>,
    /// The value.
    pub value: Expr,
}

/// An axis of the frame: a unit vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The x axis: `X`.
    X,
    /// The y axis: `Y`.
    Y,
    /// The z axis: `Z`.
    Z,
}

/// The unary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    /// Negation: `-a`.
    Neg,
    /// The value itself: `+a`.
    Plus,
    /// Logical negation: `not a`.
    Not,
}

/// The binary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// Disjunction: `or`.
    Or,
    /// Conjunction: `and`.
    And,
    /// Equal: `==`.
    Eq,
    /// Not equal: `!=`.
    Ne,
    /// Less than: `<`.
    Lt,
    /// At most: `<=`.
    Le,
    /// Greater than: `>`.
    Gt,
    /// At least: `>=`.
    Ge,
    /// `a <-> b`: the two ports are mated.
    Mated,
    /// Concatenation of lists or texts, or plans one after another: `++`.
    Join,
    /// Addition: `+`.
    Add,
    /// Subtraction: `-`.
    Sub,
    /// Multiplication: `*`.
    Mul,
    /// Division: `/`.
    Div,
    /// The remainder of a division: `%`.
    Rem,
    /// Power: `^`.
    Pow,
}
