//! Values of a running program.
//!
//! Types were settled by `check`, so a value carries only what printing and arithmetic need.
//! Values are immutable and shared; a copy costs a pointer.

use super::cells::Cells;
use super::design::{Instance, Subject};
use super::identity::Name;
use super::recalled::CallKey;
use super::record::Record;
use crate::check::typed::{Contract, DefId, Expr, Local};
use crate::geometry::{HeightField, Placed, Pose, Vec3};
use crate::plan::{self, CauseId};
use crate::robot::{JointKind, JointOwner, Limits, PortRef, Servo, Surface};
use crate::source::{Span, Symbol};
use crate::units::Dimension;
use num_bigint::BigInt;
use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

/// A value of a running program. Quantities are in SI units; copies of large values share them.
#[derive(Clone, Debug)]
pub enum Value {
    /// The value where an error was reported, or that only a run can know. Whatever is computed from it is
    /// unknown too, without another report. Lists, records and instances never contain it: they are unknown.
    Unknown,
    /// The result of what has none, such as `print`.
    Nothing,
    /// The missing value of an optional type.
    Missing,
    /// A truth value: `true` or `false`.
    Bool(bool),
    /// A whole number that fits in 64 bits.
    Int(i64),
    /// A whole number beyond `i64`; see [`Value::whole`].
    Big(Rc<BigInt>),
    /// A quantity in SI units, with its dimension.
    Quantity(f64, Dimension),
    /// A text of the type `Text`.
    Text(Rc<str>),
    /// A word of a choice, such as `auto`.
    Word(Symbol),
    /// A list of values, in order.
    List(Rc<Vec<Value>>),
    /// A vector in SI units, with the one dimension of its components.
    Vec3(Vec3, Dimension),
    /// A pose: position (m) and orientation, in the frame of the context.
    Pose(Rc<Pose>),
    /// A range `from..to` of two values.
    Range(Rc<(Value, Value)>),
    /// A function as a value: a lambda, a declared function or a behaviour.
    Fn(Rc<Callable>),
    /// An instance of a module, configuration, lattice or truss.
    Instance(Rc<Instance>),
    /// A joint of a robot, named by its owner.
    Joint(JointValue),
    /// A port of a robot, named by its module and index.
    Port(PortValue),
    /// A behaviour: an action graph with its robot.
    Behavior(Rc<Behavior>),
    /// A signal, a quantity that changes while a robot moves.
    Signal(Rc<SignalValue>),
    /// A condition that can end an action.
    Condition(Rc<ConditionValue>),
    /// A shape of a link, with what it declares about the link.
    Shape(Rc<Solid>),
    /// A kind of joint with its axis and limits: `revolute(...)`.
    JointKind(Rc<JointSpec>),
    /// An arrangement of cells of a lattice.
    Cells(Rc<Cells>),
    /// A polygon mesh: a surface of flat faces.
    Mesh(Rc<Mesh>),
    /// A point cloud: the positions of its points, m, in the frame of the context.
    Cloud(Rc<Vec<Vec3>>),
    /// A height field, which serves as terrain.
    Terrain(Rc<HeightField>),
    /// A record: a value with named fields.
    Record(Rc<Record>),
    /// A study, by its declaration.
    Study(DefId),
}

/// A value that is computed when it is first needed.
#[derive(Clone, Debug, Default)]
pub enum Lazy {
    /// The value was not asked for yet.
    #[default]
    Waiting,
    /// The value is being computed: asking for it now is a cycle.
    Running,
    /// The value was computed; it is unknown where that failed.
    Done(Value),
}

/// A function that is called through a value.
#[derive(Debug)]
pub enum Callable {
    /// A lambda, with the variables that it captured.
    Lambda {
        /// The expression that gives the result of the lambda.
        body: Arc<Expr>,
        /// The variables of the lambda's frame that come from outside, each with its value.
        captured: Vec<(Local, Value)>,
        /// The number of slots of the lambda's frame.
        frame: usize,
        /// The instance in whose body the lambda is written; `None` outside of such a body.
        this: Option<Rc<Instance>>,
    },
    /// A declared function or a built-in.
    Def(DefId),
    /// A behaviour of an instance, as a function of its parameters.
    Behavior {
        /// The instance whose behaviour is called.
        object: Rc<Instance>,
        /// The index of the behaviour in the declaration of the instance, from 0.
        behavior: usize,
    },
}

/// A joint of a robot. The robot is the outermost one, so that the joints of a part are joints of
/// the whole.
#[derive(Clone, Debug)]
pub struct JointValue {
    /// The outermost robot that the joint belongs to.
    pub robot: Subject,
    /// The module or the connection that has the joint.
    pub owner: JointOwner,
    /// The dimension of the joint's position: an angle or a length.
    pub dimension: Dimension,
}

/// A port of a robot, given by the indices of its module and of itself. The robot is the outermost one, so that a
/// port of a part is a port of the whole: `leg[2].m[0].top`.
#[derive(Clone, Debug)]
pub struct PortValue {
    /// The outermost robot that the port belongs to.
    pub robot: Subject,
    /// The index of the module, from 0, among the modules of that robot in the order in which its parts list them.
    pub module: usize,
    /// The index of the port, from 0, among the ports of the module's type, in the order of the declaration.
    pub port: usize,
}

/// A behaviour: an action graph with the robot that it moves.
#[derive(Debug)]
pub struct Behavior {
    /// The robot that the behaviour moves; `None` where no action names one, as in `wait(1s)`.
    pub robot: Option<Subject>,
    /// The series-parallel graph of actions that the robot carries out.
    pub node: Arc<plan::Node>,
}

/// A call of a behaviour, remembered with its result, so that a later call that [is the same](BehaviorCall::is_same)
/// takes that result instead of running the body again.
#[derive(Clone, Debug)]
pub struct BehaviorCall {
    /// The instance whose behaviour is called.
    pub object: Rc<Instance>,
    /// The index of the behaviour among those of the declaration, from 0.
    pub behavior: usize,
    /// The arguments, in the order of the parameters; `None` where the default is wanted.
    pub args: Vec<Option<Value>>,
    /// The user's call that led into the library, if the behaviour is declared there, since causes name it; the call itself if
    /// the behaviour has contracts, which blame it; otherwise `None`.
    pub caller: Option<Span>,
}

impl BehaviorCall {
    /// Returns the key of the call: the address of the object, and the index of the behaviour.
    pub fn key(&self) -> CallKey {
        (Rc::as_ptr(&self.object).addr(), self.behavior)
    }

    /// Returns true if two calls of one behaviour of one object surely give the same: they have the same
    /// caller, and their arguments are equal or one shared value. Lists and other compound values are not
    /// compared in depth.
    pub fn is_same(&self, other: &BehaviorCall) -> bool {
        let same = |a: &Option<Value>, b: &Option<Value>| match (a, b) {
            (Some(a), Some(b)) => a.identical(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.caller == other.caller
            && self.args.len() == other.args.len()
            && self.args.iter().zip(&other.args).all(|(a, b)| same(a, b))
    }
}

/// A contract with the values of the block in which it was stated.
#[derive(Clone, Debug)]
pub struct ContractValue {
    /// The clause.
    pub clause: Arc<Contract>,
    /// The variables of the block, by their slots.
    pub slots: Vec<Value>,
    /// The instance whose behaviour it is.
    pub this: Option<Rc<Instance>>,
}

/// A contract of a behaviour that a call gave.
#[derive(Debug)]
pub struct ContractUse {
    /// The contract with its values.
    pub stated: ContractValue,
    /// The name of the behaviour.
    pub behavior: Symbol,
    /// The cause that is the call of the behaviour.
    pub called: CauseId,
    /// The cause that is the clause.
    pub clause: CauseId,
}

/// A signal of a sensor, with the robot that gives it.
#[derive(Debug)]
pub struct SignalValue {
    /// The robot that gives the signal; `None` where nothing names one.
    pub robot: Option<Subject>,
    /// The quantity that the signal measures.
    pub measure: Measure,
}

/// A quantity of a robot that changes while it moves.
#[derive(Clone, Debug)]
pub enum Measure {
    /// A quantity that the robot senses by itself; conditions can wait for it. Over a plan, efforts are as the judge
    /// computes them.
    Sensed(plan::Signal),
    /// The static stability margin (McGhee and Frank 1968): the distance of the centre of mass inside the support
    /// polygon, m; negative outside.
    Margin,
    /// The least signed distance of links that may not touch, m.
    Clearance,
    /// The normal force of the ground on the modules of these indices, ascending, together, N.
    GroundForce(Rc<[usize]>),
    /// The pose of a port or of a module's body in the world.
    Pose(MovingFrame),
    /// The origin of a port or of a module's body in the world, m.
    Position(MovingFrame),
}

/// A frame that moves with a robot, of which a signal gives the pose.
#[derive(Clone, Copy, Debug)]
pub enum MovingFrame {
    /// The frame of the body of a module, by its index in the whole robot.
    Module(usize),
    /// The frame of a port: origin on the mating face, +x outward, +z up.
    Port(PortRef),
}

/// A condition, with the robot that it is about.
#[derive(Debug)]
pub struct ConditionValue {
    /// The robot that the condition is about; `None` where nothing names one.
    pub robot: Option<Subject>,
    /// The condition, in the form that plans have.
    pub condition: plan::Condition,
}

/// A shape as a program states it, with what it declares about its link.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// The shapes, each with its pose in the frame of the whole shape.
    pub parts: Vec<Placed>,
    /// The mass, kg; `None` if none is stated.
    pub mass: Option<f64>,
    /// The centre of mass, m, in the frame of the whole shape; `None` if none is stated.
    pub com: Option<Vec3>,
    /// The inertia xx, yy, zz, xy, xz, yz about the centre of mass, kg·m², along the axes of the whole shape; `None`
    /// if none is stated.
    pub inertia: Option<[f64; 6]>,
    /// The coefficient of friction against the ground, without unit; `None` if none is stated.
    pub friction: Option<f64>,
    /// The facts of the surface that only simulations know.
    pub surface: Surface,
}

/// A kind of joint with its axis and limits: `revolute(...)`, `prismatic(...)`, `fixed()`.
#[derive(Debug)]
pub struct JointSpec {
    /// The degree of freedom: revolute, prismatic or fixed.
    pub kind: JointKind,
    /// The axis as a vector in the joint's frame, as written; it need not be of unit length.
    pub axis: Vec3,
    /// The limits of position, speed, acceleration and effort, in rad or m, s, and N·m or N.
    pub limits: Limits,
    /// True if no motor drives the joint.
    pub passive: bool,
    /// The facts of its servo.
    pub servo: Servo,
}

impl JointSpec {
    /// Returns the kind of a joint that does not move.
    pub fn fixed() -> JointSpec {
        JointSpec {
            kind: JointKind::Fixed,
            axis: Vec3::z(),
            limits: Limits::default(),
            passive: true,
            servo: Servo::default(),
        }
    }
}

/// A polygon mesh: a surface of flat faces over shared vertices.
#[derive(Debug)]
pub struct Mesh {
    /// The positions of the vertices, m, in the frame of the mesh.
    pub vertices: Vec<Vec3>,
    /// The indices of each face's corners in `vertices`, counterclockwise from outside; at least three each.
    pub faces: Vec<Vec<usize>>,
}

impl Value {
    /// Returns a text as a value.
    pub fn text(text: impl AsRef<str>) -> Value {
        Value::Text(text.as_ref().into())
    }

    /// Returns a number without unit as a value.
    pub fn number(x: f64) -> Value {
        Value::Quantity(x, Dimension::NUMBER)
    }

    /// Returns a length, given in m, as a value.
    pub fn length(x: f64) -> Value {
        Value::Quantity(x, Dimension::LENGTH)
    }

    /// Returns a time, given in s, as a value.
    pub fn time(x: f64) -> Value {
        Value::Quantity(x, Dimension::TIME)
    }

    /// Returns a count as a value, a whole number. Panics if it is 2⁶³ or more.
    pub fn count(n: usize) -> Value {
        Value::Int(i64::try_from(n).expect("counts are far below 2^63"))
    }

    /// Returns a list as a value; [`Value::Unknown`] if an element is unknown.
    pub fn list(elements: Vec<Value>) -> Value {
        if elements.iter().any(Value::is_unknown) { Value::Unknown } else { Value::List(Rc::new(elements)) }
    }

    /// Returns a whole number as a value in its shortest form: [`Value::Int`] where it fits.
    pub fn whole(n: BigInt) -> Value {
        i64::try_from(&n).map_or_else(|_| Value::Big(Rc::new(n)), Value::Int)
    }

    /// Gives a name to a robot, and to each robot of a list its own, with its index; other values have no
    /// names.
    pub fn bind(&self, name: Name) {
        match self {
            Value::Instance(instance) => instance.bind(name),
            Value::List(elements) if name.index.is_none() => {
                for (index, element) in elements.iter().enumerate() {
                    // Elements of a list are of one type.
                    let Value::Instance(instance) = element else { break };
                    instance.bind(Name { index: Some(index), ..name });
                }
            }
            _ => {}
        }
    }

    /// Returns the value, or the missing value of the language for `None`.
    pub fn optional(value: Option<Value>) -> Value {
        value.unwrap_or(Value::Missing)
    }

    /// Returns true if the value is [`Value::Unknown`], the result of a fault.
    pub fn is_unknown(&self) -> bool {
        matches!(self, Value::Unknown)
    }

    /// Returns a quantity in SI units, or a whole number, as a double: rounded, and infinite beyond 1.8e308; `None`
    /// for other values.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Value::Quantity(x, _) => Some(*x),
            Value::Int(n) => Some(*n as f64),
            Value::Big(n) => num_traits::ToPrimitive::to_f64(n.as_ref()),
            _ => None,
        }
    }

    /// Returns the dimension of a number or a vector, that of its components; `None` for other values.
    pub fn as_dimension(&self) -> Option<Dimension> {
        match self {
            Value::Quantity(_, d) | Value::Vec3(_, d) => Some(*d),
            Value::Int(_) | Value::Big(_) => Some(Dimension::NUMBER),
            _ => None,
        }
    }

    /// Returns the whole number that the value is, however large; `None` for other values.
    pub fn as_big(&self) -> Option<BigInt> {
        match self {
            Value::Int(n) => Some(BigInt::from(*n)),
            Value::Big(n) => Some(n.as_ref().clone()),
            _ => None,
        }
    }

    /// Returns true if two values are surely the same: equal simple values of one type, or one shared value.
    fn identical(&self, other: &Value) -> bool {
        use Value::*;
        match (self, other) {
            (Missing, Missing) => true,
            (Bool(a), Bool(b)) => a == b,
            (Int(a), Int(b)) => a == b,
            (Quantity(a, d), Quantity(b, e)) => a.to_bits() == b.to_bits() && d == e,
            (Text(a), Text(b)) => a == b,
            (Word(a), Word(b)) => a == b,
            (List(a), List(b)) => Rc::ptr_eq(a, b),
            (Fn(a), Fn(b)) => Rc::ptr_eq(a, b),
            (Instance(a), Instance(b)) => Rc::ptr_eq(a, b),
            (Behavior(a), Behavior(b)) => Rc::ptr_eq(a, b),
            (Record(a), Record(b)) => Rc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// Returns true if two values are equal, as `==` says, false if they are not; `None` where one is unknown, or
    /// where values of these types can't be compared. Elements of lists and fields of records that can't be compared
    /// count as different.
    pub fn same(&self, other: &Value) -> Option<bool> {
        Comparison::default().same(self, other)
    }
}

/// Returns a number that is the same for arguments that are equal: that of their numbers and texts, in which those of the
/// designs of one declaration, of which there may be thousands, mostly differ.
pub fn arguments_key(args: &[Value]) -> u64 {
    const PRIME: u64 = 0x0100_0000_01b3;
    let mixed = |key: u64, word: u64| (key ^ word).wrapping_mul(PRIME).rotate_left(29);
    args.iter().fold(0xcbf2_9ce4_8422_2325, |key, arg| match (arg, arg.as_number()) {
        // Zero has two signs and is one number.
        (_, Some(number)) => mixed(key, (number + 0.0).to_bits()),
        (Value::Text(text), _) => text.bytes().fold(key, |key, byte| mixed(key, u64::from(byte))),
        _ => mixed(key, 0),
    })
}

/// A comparison of two values. Lists and records may share what they hold over and over, so each pair of them is
/// compared once.
#[derive(Default)]
struct Comparison {
    /// The pairs of lists that were found to be equal.
    equal: HashSet<(*const Vec<Value>, *const Vec<Value>)>,
    /// The pairs of records that were found to be equal.
    equal_records: HashSet<(*const Record, *const Record)>,
}

impl Comparison {
    /// Compares two lists, element by element.
    fn lists(&mut self, a: &Rc<Vec<Value>>, b: &Rc<Vec<Value>>) -> bool {
        let pair = (Rc::as_ptr(a), Rc::as_ptr(b));
        if a.len() != b.len() || self.equal.contains(&pair) {
            return a.len() == b.len();
        }
        let equal = a.iter().zip(b.iter()).all(|(x, y)| self.same(x, y) == Some(true));
        if equal {
            self.equal.insert(pair);
        }
        equal
    }

    /// Compares two records: declared ones by their fields, all others by what they are.
    fn records(&mut self, a: &Rc<Record>, b: &Rc<Record>) -> bool {
        let pair = (Rc::as_ptr(a), Rc::as_ptr(b));
        if Rc::ptr_eq(a, b) || self.equal_records.contains(&pair) {
            return true;
        }
        let (Record::Declared(x), Record::Declared(y)) = (&**a, &**b) else { return false };
        let mut fields = x.fields.iter().zip(&y.fields);
        let equal = x.def == y.def && fields.all(|(x, y)| self.same(x, y) == Some(true));
        if equal {
            self.equal_records.insert(pair);
        }
        equal
    }

    /// Returns true if two values are the same; `None` where one is unknown, or they are of kinds that can't be
    /// compared.
    fn same(&mut self, a: &Value, b: &Value) -> Option<bool> {
        use Value::*;
        Some(match (a, b) {
            (Unknown, _) | (_, Unknown) => return None,
            (Nothing, Nothing) | (Missing, Missing) => true,
            (Missing, _) | (_, Missing) => false,
            (Bool(a), Bool(b)) => a == b,
            (Int(a), Int(b)) => a == b,
            (Big(a), Big(b)) => a == b,
            (Int(_), Big(_)) | (Big(_), Int(_)) => false,
            (Text(a), Text(b)) => a == b,
            (Word(a), Word(b)) => a == b,
            (Vec3(a, _), Vec3(b, _)) => a == b,
            (Pose(a), Pose(b)) => a == b,
            (List(a), List(b)) => self.lists(a, b),
            (Range(a), Range(b)) => self.same(&a.0, &b.0)? && self.same(&a.1, &b.1)?,
            (Fn(a), Fn(b)) => {
                Rc::ptr_eq(a, b) || matches!((&**a, &**b), (Callable::Def(x), Callable::Def(y)) if x == y)
            }
            (Instance(a), Instance(b)) => {
                Rc::ptr_eq(&a.design, &b.design)
                    && Rc::ptr_eq(&*a.robot, &*b.robot)
                    && a.modules.is_same(&b.modules, a.design.module_count())
            }
            (Joint(a), Joint(b)) => Rc::ptr_eq(&*a.robot, &*b.robot) && a.owner == b.owner,
            (Port(a), Port(b)) => {
                Rc::ptr_eq(&*a.robot, &*b.robot) && (a.module, a.port) == (b.module, b.port)
            }
            (Behavior(a), Behavior(b)) => Rc::ptr_eq(a, b) || plan::visit::equal(&a.node, &b.node),
            (Cells(a), Cells(b)) => a == b,
            (Shape(a), Shape(b)) => a.parts == b.parts,
            (Mesh(a), Mesh(b)) => a.vertices == b.vertices && a.faces == b.faces,
            (Cloud(a), Cloud(b)) => a == b,
            (Terrain(a), Terrain(b)) => a == b,
            (Record(a), Record(b)) => self.records(a, b),
            (a, b) => a.as_number()? == b.as_number()?,
        })
    }
}
