//! The typed tree of modules: links, joints, ports and motors.

use super::typed::{DefId, Expr, Local, Member, Param, Require};
use crate::source::{Span, Symbol};
use crate::units::Dimension;
use std::sync::Arc;

/// A module with its links, joints and ports: `module`.
#[derive(Clone, Debug)]
pub struct ModuleDef {
    /// The parameters, in the order in which they are declared.
    pub params: Vec<Param>,
    /// The members of the declaration: its parameters and `let`s.
    pub members: Vec<Member>,
    /// The mass of the whole module; `None` if the clause is missing.
    pub mass: Option<Expr>,
    /// The depth beyond which penetration is a collision, a length; `None` if the clause `touch` is
    /// missing.
    pub touch: Option<Expr>,
    /// The gap up to which links touch the ground, a length; `None` if the clause `contact` is missing.
    pub contact: Option<Expr>,
    /// The links, in the order of the text; joints and ports refer to them by index, from 0.
    pub links: Vec<LinkDef>,
    /// The joints, in the order of the text; [`ExprKind::Joint`](super::typed_expr::ExprKind::Joint) is an index into
    /// them.
    pub joints: Vec<JointDef>,
    /// The ports by name, in order; an array is one entry.
    pub ports: Vec<PortGroup>,
    /// The motors, in the order of the text.
    pub motors: Vec<MotorDef>,
    /// The clauses `let`, `require`, `port` and `touching`, and conditions and loops over them, in order.
    pub clauses: Vec<ModuleClause>,
    /// Aliases of joints as (name, index in `joints`), sorted by name.
    pub joint_aliases: Vec<(Symbol, usize)>,
    /// Aliases of ports as (name, index in `ports`), sorted by name.
    pub port_aliases: Vec<(Symbol, usize)>,
    /// The number of slots, for local variables, of the frame in which the clauses are evaluated.
    pub frame: usize,
}

/// A `link` of a module, a rigid body: its shapes as expressions, with its pose; masses follow at elaboration.
#[derive(Clone, Debug)]
pub struct LinkDef {
    /// The name of the link, to which joints and ports refer.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The shape that is drawn, and that collides unless `collides` is given.
    pub shape: Expr,
    /// The shape for collisions; `None` if it is the one that is drawn.
    pub collides: Option<Expr>,
    /// The pose of the shape in the link's frame; `None` for the link's frame itself.
    pub at: Option<Placement>,
}

/// A `joint` of a module, by which programs name a position: it moves a link, or follows other joints.
#[derive(Clone, Debug)]
pub struct JointDef {
    /// The name of the joint, by which programs command it.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The dimension of the joint's position: length for a prismatic joint, angle for a revolute or fixed one, and
    /// for a mimic joint that of the first joint that it follows.
    pub dimension: Dimension,
    /// The text of the joint's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
    /// The kind of the joint: between two links, or a mimic joint.
    pub kind: JointDefKind,
}

/// A joint by what its declaration gives: two links between which it moves, or the joints that it follows.
#[derive(Clone, Debug)]
pub enum JointDefKind {
    /// A joint that moves a link against another.
    Declared(Box<JointBetween>),
    /// A mimic joint, which moves no link: a linear combination of other joints, `joint b = -a`.
    Mimic(Linear),
}

/// A joint between two links, which carries its child against its parent; kind and pose are not yet evaluated.
#[derive(Clone, Debug)]
pub struct JointBetween {
    /// The parent link, as an index into [`ModuleDef::links`].
    pub parent: usize,
    /// The child link, which the joint moves, as an index into [`ModuleDef::links`].
    pub child: usize,
    /// The expression of the kind of joint: a value of type `JointKind`.
    pub kind: Expr,
    /// The pose of the joint in the parent's frame; `None` for the parent's frame itself.
    pub at: Option<Placement>,
    /// The linear combination of joints that the joint follows, from a clause of its own; `None` if it moves freely.
    pub follows: Option<Linear>,
}

/// A linear combination: a sum of joints as (index into [`ModuleDef::joints`], factor). The factor is a plain number.
pub type Linear = Vec<(usize, Expr)>;

/// A port of a module, or an array of ports.
#[derive(Clone, Debug)]
pub struct PortGroup {
    /// The name of the port, or of the array of ports.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// True for an array of ports.
    pub array: bool,
    /// The text of the port's doc comment; `None` if there is none.
    pub doc: Option<Arc<str>>,
}

/// A `motor` of a module that drives several joints together: limits on a linear combination of their positions.
#[derive(Clone, Debug)]
pub struct MotorDef {
    /// The name of the motor, for messages and plans.
    pub name: Symbol,
    /// The span of the name in the declaration.
    pub span: Span,
    /// The linear combination of joints that the motor's limits are about, as (index into [`ModuleDef::joints`],
    /// factor).
    pub joints: Vec<(usize, Expr)>,
    /// The greatest speed of the motor, an angular speed; `None` if it is not stated.
    pub max_speed: Option<Expr>,
    /// The greatest acceleration of the motor, an angular acceleration; `None` if it is not stated.
    pub max_accel: Option<Expr>,
    /// The greatest torque of the motor; `None` if it is not stated.
    pub max_torque: Option<Expr>,
}

/// A pose: `at [x, y, z] turned(Z, 90deg)`. Turns apply in order, each in the frame turned so far.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The expression of the position: a vector of lengths.
    pub position: Expr,
    /// The turns as (axis, angle), in order, each about an axis of the frame turned so far; the axis is a vector of
    /// plain numbers.
    pub turned: Vec<(Expr, Expr)>,
    /// The span of the clause in the source text.
    pub span: Span,
}

/// A clause of a module that is elaborated in order, for each instance of the module: ports and pairs of links that
/// may touch can depend on values, so these clauses may stand in conditions and loops. Links, joints and motors may
/// not, and are listed in [`ModuleDef`].
#[derive(Clone, Debug)]
pub enum ModuleClause {
    /// A port, or one element of a port array.
    Port(Box<PortClause>),
    /// Two links (indices into [`ModuleDef::links`]) that are built to touch, so that the judge does not check them
    /// for collision with each other, and the span of the clause.
    Touching(usize, usize, Span),
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
        then: Vec<ModuleClause>,
        /// The clauses that are elaborated if the condition does not hold; empty without `else`.
        otherwise: Vec<ModuleClause>,
    },
    /// A loop: the clauses are elaborated for each element.
    For {
        /// The local variable that holds the element in each pass.
        binder: Local,
        /// The list or range whose elements the loop goes through.
        iterable: Expr,
        /// The clauses that are elaborated for each element, in order.
        body: Vec<ModuleClause>,
    },
}

/// A port, or one element of a port array.
#[derive(Clone, Debug)]
pub struct PortClause {
    /// The index of the port's name in [`ModuleDef::ports`].
    pub group: usize,
    /// The index of the port in its array, from 0; `None` for a single port.
    pub index: Option<Expr>,
    /// The declaration of the connector at the port.
    pub connector: DefId,
    /// The link that carries the port, as an index into [`ModuleDef::links`].
    pub link: usize,
    /// The pose of the port in the link's frame; `None` for the link's frame itself.
    pub at: Option<Placement>,
    /// The direction of the port's outward normal, a vector of plain numbers in the link's frame.
    pub facing: Expr,
    /// The direction from which turns of a bond are counted, as `facing`; `None` if it is not written.
    pub up: Option<Expr>,
    /// The span of the clause in the source text.
    pub span: Span,
}
