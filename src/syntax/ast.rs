//! The tree of one file. Every node carries its span; comments stand beside the tree, by position.
//!
//! The tree keeps what was written: names are not resolved, units not looked up, numbers not scaled.
//! Where a piece of text could not be parsed there is an `Error` node, which later rooms pass over
//! in silence (the parser has already said what is wrong).

use crate::source::{FileId, Span, Symbol};

/// A name where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Name {
    pub text: Symbol,
    pub span: Span,
}

/// One parsed file.
#[derive(Clone, Debug)]
pub struct File {
    pub id: FileId,
    /// Text of the `//!` lines, without the marks.
    pub doc: Option<String>,
    pub items: Vec<Item>,
    /// All comments, documentation included, in order of position.
    pub comments: Vec<Comment>,
    /// Names that pieces would have declared which could not be read: that they are unknown is no news.
    pub unread: Vec<Symbol>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    pub span: Span,
    pub kind: CommentKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommentKind {
    Line,
    Block,
    /// `///`
    ItemDoc,
    /// `//!`
    FileDoc,
}

#[derive(Clone, Debug)]
pub struct Item {
    pub span: Span,
    /// Text of the `///` lines before the item, without the marks.
    pub doc: Option<String>,
    pub kind: ItemKind,
}

#[derive(Clone, Debug)]
pub enum ItemKind {
    Use(Use),
    Let(Let),
    Fn(Fn),
    ExternFn(ExternFn),
    ExternType(ExternType),
    Connector(Connector),
    Module(Module),
    Cell(Facts),
    Strut(Facts),
    Config(Config),
    Lattice(Lattice),
    Truss(Truss),
    Test(Test),
    Statement(Stmt),
    Error,
}

/// `use std.smores.{Smores, Chain3 as Chain}`, `use "parts/claw.mod".{Claw}`, `use std.gaits`.
#[derive(Clone, Debug)]
pub struct Use {
    pub source: UseSource,
    /// `None`: a bare `use std.gaits`, which names the last word of the path: a file, or an item of
    /// the file that the path before it names. `use "claw.mod"` without names is refused by `check`.
    pub names: Option<Vec<UseName>>,
}

#[derive(Clone, Debug)]
pub enum UseSource {
    /// `std.smores`
    Path(Vec<Name>),
    /// A path relative to the importing file; the span covers the quotes.
    File { path: String, span: Span },
}

#[derive(Clone, Debug)]
pub struct UseName {
    pub name: Name,
    pub rename: Option<Name>,
}

#[derive(Clone, Debug)]
pub struct Let {
    pub name: Name,
    pub ty: Option<TypeExpr>,
    pub value: Expr,
}

#[derive(Clone, Debug)]
pub struct Fn {
    pub name: Name,
    pub params: Vec<Param>,
    pub result: Option<TypeExpr>,
    pub body: Expr,
}

/// `extern fn clamp<D: Dimension>(x: Quantity<D>, to: Range<Quantity<D>>) -> Quantity<D>`
#[derive(Clone, Debug)]
pub struct ExternFn {
    pub name: Name,
    /// At most one type or dimension parameter is meant, but the tree keeps what was written.
    pub type_params: Vec<TypeParam>,
    pub params: Vec<Param>,
    pub result: Option<TypeExpr>,
}

#[derive(Clone, Debug)]
pub struct TypeParam {
    pub name: Name,
    pub bound: Option<Name>,
}

/// `extern type Folding is Plan { /// doc
///   layout: Layout
///   fn at(t: Time) -> State }`
#[derive(Clone, Debug)]
pub struct ExternType {
    pub name: Name,
    pub is: Option<Name>,
    pub fields: Vec<ExternField>,
    pub methods: Vec<(Option<String>, ExternFn)>,
}

#[derive(Clone, Debug)]
pub struct ExternField {
    pub doc: Option<String>,
    pub name: Name,
    pub ty: TypeExpr,
}

/// A parameter; in `extern fn` its name may be a reserved word (`for:`) and it may be variadic.
#[derive(Clone, Debug)]
pub struct Param {
    pub name: Name,
    pub ty: TypeExpr,
    pub default: Option<Expr>,
    /// `b: Behavior...`
    pub variadic: bool,
}

#[derive(Clone, Debug)]
pub struct TypeExpr {
    pub span: Span,
    pub kind: TypeKind,
}

#[derive(Clone, Debug)]
pub enum TypeKind {
    /// `Length`, `std.smores.Smores`, `List<Length>`, `Vec3<Length>`
    Named {
        path: Vec<Name>,
        args: Vec<TypeExpr>,
    },
    /// `Quantity<kg*m^2>`: the unit as written (a lone name may be a dimension parameter).
    Quantity(UnitExpr),
    /// `T?`
    Optional(Box<TypeExpr>),
    /// `fn(A, B) -> C`
    Fn {
        params: Vec<TypeExpr>,
        result: Box<TypeExpr>,
    },
    /// `exact | enumerate | heuristic`, `auto | Int`, `Mesh | Cloud`; at least two.
    Choice(Vec<TypeExpr>),
    Error,
}

/// A product of powers: `N*m`, `m/s^2`. Exponents behind `/` are already negative.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitExpr {
    pub span: Span,
    pub factors: Vec<(Name, i32)>,
}

// Connectors, modules, cells and struts.

#[derive(Clone, Debug)]
pub struct Connector {
    pub name: Name,
    pub clauses: Vec<ConnectorClause>,
}

#[derive(Clone, Debug)]
pub enum ConnectorClause {
    /// `mates Socket`, `mates Plug, Socket` is two clauses' worth of names.
    Mates(Vec<Name>),
    Turns(Expr),
    /// `holds 88N`, `holds 1.9N*m`
    Holds(Expr),
    /// `capture 4mm 5deg`
    Capture {
        keyword: Span,
        distance: Expr,
        angle: Option<Expr>,
    },
    /// `hinge(axis: Z, range: ...)`: the joint lives in the bond.
    Hinge {
        keyword: Span,
        args: Vec<Arg>,
    },
    Error,
}

#[derive(Clone, Debug)]
pub struct Module {
    pub name: Name,
    pub params: Vec<Param>,
    pub clauses: Vec<ModuleClause>,
}

#[derive(Clone, Debug)]
pub struct ModuleClause {
    pub span: Span,
    pub doc: Option<String>,
    pub kind: ModuleClauseKind,
}

#[derive(Clone, Debug)]
pub enum ModuleClauseKind {
    Mass(Expr),
    /// `touch 0.2mm`: penetration deeper than this is a collision.
    Touch(Expr),
    /// `contact 4mm`: links within this of the ground touch it.
    Contact(Expr),
    Link {
        name: Name,
        shape: Expr,
        collides: Option<Expr>,
        at: Option<Placement>,
    },
    /// `joint bend : base -> tip = revolute(...) at [...]`; `kind` is a call.
    Joint {
        name: Name,
        parent: Name,
        child: Name,
        kind: Expr,
        at: Option<Placement>,
    },
    /// `joint b = -a`
    Mimic {
        name: Name,
        value: Expr,
    },
    /// `port side[4] : Face on base at ... facing +X up +Z`
    Port(ModulePort),
    /// `motor p = tilt + pan (max_speed: ..., max_torque: ...)`
    Motor {
        name: Name,
        value: Expr,
        args: Vec<Arg>,
    },
    /// `touching a b`
    Touching(Name, Name),
    /// `alias pan = front`: another name for a joint or a port.
    Alias {
        name: Name,
        target: Name,
    },
    Let(Let),
    Require(Require),
    If {
        condition: Expr,
        then: Vec<ModuleClause>,
        otherwise: Vec<ModuleClause>,
    },
    /// The ports of an array are declared in a loop: `for i in 0..4 { port side[i] : ... }`.
    For {
        binder: Name,
        iterable: Expr,
        body: Vec<ModuleClause>,
    },
    Error,
}

#[derive(Clone, Debug)]
pub struct ModulePort {
    pub name: Name,
    /// Inside a `for`: which element of the port array.
    pub index: Option<Expr>,
    pub connector: Vec<Name>,
    pub link: Name,
    pub at: Option<Placement>,
    pub facing: Expr,
    pub up: Option<Expr>,
}

/// `at [x, y, z] turned(Z, 90deg) turned(X, 10deg)`
#[derive(Clone, Debug)]
pub struct Placement {
    pub span: Span,
    pub position: Expr,
    pub turned: Vec<Vec<Arg>>,
}

/// The body of a `cell` or a `strut`: `size 100mm  shrinks_to 50mm`.
#[derive(Clone, Debug)]
pub struct Facts {
    pub name: Name,
    pub params: Vec<Param>,
    pub facts: Vec<(Name, Expr)>,
}

// Configurations.

#[derive(Clone, Debug)]
pub struct Config {
    pub name: Name,
    pub params: Vec<Param>,
    /// The span of `closed`, where it is written.
    pub closed: Option<Span>,
    pub clauses: Vec<ConfigClause>,
}

#[derive(Clone, Debug)]
pub struct ConfigClause {
    pub span: Span,
    pub doc: Option<String>,
    pub kind: ConfigClauseKind,
}

#[derive(Clone, Debug)]
pub enum ConfigClauseKind {
    Part(Part),
    /// `port head = body.head`, `port side[4] = [...]`
    Port {
        name: Name,
        count: Option<Expr>,
        value: Expr,
    },
    Base(Path),
    Behavior(Behavior),
    Connect {
        a: Path,
        b: Path,
        turn: Option<Expr>,
    },
    Set {
        joint: Path,
        value: Expr,
    },
    Let(Let),
    Require(Require),
    If {
        condition: Expr,
        then: Vec<ConfigClause>,
        otherwise: Vec<ConfigClause>,
    },
    For {
        binder: Name,
        iterable: Expr,
        body: Vec<ConfigClause>,
    },
    Error,
}

/// `part leg[i in 0..4]: Leg(left: i < 2)`
#[derive(Clone, Debug)]
pub struct Part {
    pub name: Name,
    pub count: Option<PartCount>,
    pub ty: Vec<Name>,
    /// `None`: no brackets were written.
    pub args: Option<Vec<Arg>>,
    pub ty_span: Span,
}

#[derive(Clone, Debug)]
pub enum PartCount {
    /// `leg[4]`
    Number(Expr),
    /// `leg[i in 0..4]`
    Each { binder: Name, range: Expr },
}

#[derive(Clone, Debug)]
pub struct Behavior {
    pub name: Name,
    pub params: Vec<Param>,
    pub allows: Vec<Exemption>,
    pub body: Expr,
}

/// `unstable`, `slip`, `collision(a, b)`, `overload(j)`
#[derive(Clone, Debug)]
pub struct Exemption {
    pub name: Name,
    pub args: Vec<Expr>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub struct Require {
    pub span: Span,
    pub condition: Expr,
    pub message: Option<Expr>,
}

/// `body.side[i]`, `m[0].left`: a name, then `.name` and `[index]`.
#[derive(Clone, Debug)]
pub struct Path {
    pub span: Span,
    pub root: Name,
    pub steps: Vec<PathStep>,
}

#[derive(Clone, Debug)]
pub enum PathStep {
    Field(Name),
    Index { index: Expr, span: Span },
}

// Lattices and trusses.

#[derive(Clone, Debug)]
pub struct Lattice {
    pub name: Name,
    pub params: Vec<Param>,
    pub of: Vec<Name>,
    pub value: Expr,
}

#[derive(Clone, Debug)]
pub struct Truss {
    pub name: Name,
    pub params: Vec<Param>,
    pub of: Vec<Name>,
    pub body: TrussBody,
}

#[derive(Clone, Debug)]
pub enum TrussBody {
    Value(Expr),
    Clauses(Vec<TrussClause>),
}

#[derive(Clone, Debug)]
pub struct TrussClause {
    pub span: Span,
    pub kind: TrussClauseKind,
}

#[derive(Clone, Debug)]
pub enum TrussClauseKind {
    /// `node a = [0m, 0m, 0m]`, in a loop `node ring[i] = ...`
    Node {
        name: Name,
        index: Option<Expr>,
        value: Expr,
    },
    Strut {
        a: Path,
        b: Path,
    },
    Let(Let),
    Require(Require),
    If {
        condition: Expr,
        then: Vec<TrussClause>,
        otherwise: Vec<TrussClause>,
    },
    For {
        binder: Name,
        iterable: Expr,
        body: Vec<TrussClause>,
    },
    Error,
}

// Statements and expressions.

#[derive(Clone, Debug)]
pub struct Test {
    /// Text without interpolation; the span covers the quotes.
    pub name: String,
    pub name_span: Span,
    pub body: Vec<Stmt>,
}

#[derive(Clone, Debug)]
pub struct Stmt {
    pub span: Span,
    pub kind: StmtKind,
}

#[derive(Clone, Debug)]
pub enum StmtKind {
    Let(Let),
    Expr(Expr),
    Expect { condition: Expr, message: Option<Expr> },
    Require(Require),
    If { condition: Expr, then: Vec<Stmt>, otherwise: Vec<Stmt> },
    For { binder: Name, iterable: Expr, body: Vec<Stmt> },
    Error,
}

#[derive(Clone, Debug)]
pub struct Expr {
    pub span: Span,
    pub kind: ExprKind,
}

#[derive(Clone, Debug)]
pub enum ExprKind {
    /// `12`, `1_000`, `90deg`: the digits as written (underscores removed) and the unit that sticks.
    Number {
        digits: Symbol,
        unit: Option<UnitExpr>,
    },
    Bool(bool),
    /// Text with `{expr}` in it; a plain text is one `Literal` (or none, when empty).
    Text(Vec<TextPart>),
    Name(Symbol),
    /// `X`, `Y`, `Z`; `-X` is a `Unary`.
    Axis(Axis),
    /// `_`: leave it, in the rows of a gait table.
    Hole,
    List(Vec<Expr>),
    /// `[e for x in xs if c for y in ys]`
    Comprehension {
        body: Box<Expr>,
        clauses: Vec<ComprehensionClause>,
    },
    Unary {
        op: UnaryOp,
        op_span: Span,
        operand: Box<Expr>,
    },
    Binary {
        op: BinaryOp,
        op_span: Span,
        left: Box<Expr>,
        right: Box<Expr>,
    },
    /// `a..b`
    Range {
        from: Box<Expr>,
        to: Box<Expr>,
    },
    /// `x else y`: `y` where `x` is missing. Binds like `or`, and is written behind a whole operand.
    Otherwise {
        value: Box<Expr>,
        otherwise: Box<Expr>,
    },
    Call {
        callee: Box<Expr>,
        args: Vec<Arg>,
    },
    Index {
        object: Box<Expr>,
        index: Box<Expr>,
    },
    Field {
        object: Box<Expr>,
        field: Name,
    },
    /// `if c { a } else { b }`; the branches are blocks.
    If {
        condition: Box<Expr>,
        then: Box<Expr>,
        otherwise: Option<Box<Expr>>,
    },
    /// `{ let a = ... newline expr }`
    Block {
        statements: Vec<Stmt>,
        value: Option<Box<Expr>>,
    },
    /// `x => e`, `(a, b) => e`
    Lambda {
        params: Vec<Name>,
        body: Box<Expr>,
    },
    Error,
}

#[derive(Clone, Debug)]
pub enum TextPart {
    /// Escapes already resolved.
    Literal(String),
    Value(Expr),
}

#[derive(Clone, Debug)]
pub enum ComprehensionClause {
    For { binder: Name, iterable: Expr },
    If(Expr),
}

#[derive(Clone, Debug)]
pub struct Arg {
    pub name: Option<Name>,
    pub value: Expr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    X,
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    Neg,
    Plus,
    Not,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    Or,
    And,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    /// `a <-> b`: the two ports are mated.
    Mated,
    /// `++`
    Join,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    Pow,
}
