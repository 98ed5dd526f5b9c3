//! Arguments of built-ins: the Rust types that they are read as, and the words of choices.
//!
//! A native names its parameters with Rust types, in a list made by `parameters!` or in a struct
//! made by `arguments!`. A test compares these lists with the declarations in `stdlib/prelude.mod`: names,
//! types, what may be left out, and the words of choices. The top of [`crate::natives`] shows how they are
//! used.

use super::cells::Cells;
use super::design::Instance;
use super::record::{Record, StateValue};
use super::value::{Behavior, Callable, ConditionValue, JointValue, Mesh, PortValue, Solid, Value};
use crate::geometry::{HeightField, Pose, Vec3};
use crate::plan::{DynamicsModel, Ground, Verdict, World};
use std::rc::Rc;

/// The type of a parameter as its built-in reads it; a test compares it with the type that the declaration states.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A value of any type: the declaration has a type parameter there, or several types.
    Value,
    /// A truth value: `true` or `false`.
    Bool,
    /// A whole number of the type `Int`.
    Int,
    /// A quantity of any dimension, in SI units.
    Number,
    /// A text of the type `Text`.
    Text,
    /// A list, `List`, or a variadic parameter.
    List,
    /// A vector of three components, `Vec3`.
    Vec3,
    /// A range of two ends, `Range`.
    Range,
    /// A pose of position and orientation, `Pose`.
    Pose,
    /// A function, given as a value.
    Fn,
    /// An instance of a module, configuration, lattice or truss.
    Instance,
    /// A joint of a robot, `Joint`.
    Joint,
    /// A port of a robot, `Port`.
    Port,
    /// A behaviour of a robot, `Behavior`.
    Behavior,
    /// A condition of an action, `Condition`.
    Condition,
    /// A shape of a link, of the type `Shape`.
    Shape,
    /// A polygon mesh of vertices and faces, `Mesh`.
    Mesh,
    /// An arrangement of cells, `Cells`.
    Cells,
    /// A height field, as the ground is given: `Terrain`.
    Terrain,
    /// A record, by the name of its type.
    Record(&'static str),
    /// A word of a choice, one of those that the function returns.
    Choice(fn() -> Vec<&'static str>),
    /// A word of a choice, one of those that the function returns, or a value of another type.
    WordOr(fn() -> Vec<&'static str>, &'static Kind),
    /// A value of the given type that may be missing.
    Optional(&'static Kind),
}

/// The reason that a value is not what a native asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentError {
    /// The value has another type than the native reads, which `check` excludes.
    Type,
    /// The value is out of range; the text follows the description of the parameter in the message.
    Range(&'static str),
}

/// A Rust type as which a built-in can read an argument.
pub trait Argument<'c>: Sized {
    /// The type in the language that a parameter of this Rust type has.
    const KIND: Kind;

    /// Returns a value of the language as this Rust type.
    ///
    /// # Errors
    /// [`ArgumentError::Type`] where the value has another type, [`ArgumentError::Range`] where it is out of range.
    fn read(value: &'c Value) -> Result<Self, ArgumentError>;
}

/// An enum whose values a program writes as words. The words stand here and in the declarations, which
/// a test compares, and nowhere else.
pub trait Choice: Copy + PartialEq + 'static {
    /// The words of the choice, each with its value, in the order of the declaration.
    const WORDS: &'static [(&'static str, Self)];

    /// Returns the word of the choice for this value. Panics if [`WORDS`](Choice::WORDS) leaves the value out.
    fn word(self) -> &'static str {
        let found = Self::WORDS.iter().find(|(_, value)| *value == self);
        found.map(|(word, _)| *word).expect("every value has a word")
    }

    /// Returns all words of the choice, in the order of the declaration.
    fn words() -> Vec<&'static str> {
        Self::WORDS.iter().map(|(word, _)| *word).collect()
    }
}

/// A number above zero, in SI units; any other is refused as out of range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Positive(pub f64);

/// An argument that is a word of a choice or a value of another type, which may be a choice of other words: `auto | Int`,
/// `auto | three | all`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WordOr<W, T> {
    /// A word, one of those of the choice.
    Word(W),
    /// A value of the other type that the argument may have.
    Value(T),
}

/// The word `auto`, which leaves the choice of a value to the called function, as in `bins: auto`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Auto;

impl Choice for Auto {
    const WORDS: &'static [(&'static str, Auto)] = &[("auto", Auto)];
}

/// The word `off`, by which a program does without what an argument would otherwise state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Off;

impl Choice for Off {
    const WORDS: &'static [(&'static str, Off)] = &[("off", Off)];
}

impl Choice for Ground {
    const WORDS: &'static [(&'static str, Ground)] =
        &[("settle", Ground::Settle), ("fixed", Ground::Fixed), ("held", Ground::Held), ("off", Ground::Off)];
}

impl Choice for DynamicsModel {
    const WORDS: &'static [(&'static str, DynamicsModel)] =
        &[("statics", DynamicsModel::Statics), ("full", DynamicsModel::Full)];
}

/// A parameter of a native: its name, and the type that it is read as.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// The name of the parameter in the declaration.
    pub name: &'static str,
    /// The type to be compared with that in the declaration.
    pub kind: Kind,
    /// The function that returns the name of the Rust type, to be compared with the type as which the native reads
    /// the argument.
    pub rust_type: fn() -> &'static str,
}

impl Parameter {
    /// Returns a parameter that is read as `T`.
    pub const fn new<'c, T: Argument<'c>>(name: &'static str) -> Parameter {
        Parameter { name, kind: T::KIND, rust_type: std::any::type_name::<T> }
    }

    /// Concatenates a built-in's own parameters and those that it shares with others: `part` holds one such list or
    /// none. `N` is the number of all: the build fails if it is greater, and parameters are lost if it is less.
    pub const fn concatenated<const N: usize>(own: &[Parameter], part: &[&[Parameter]]) -> [Parameter; N] {
        let mut all = [Parameter::new::<bool>(""); N];
        let mut i = 0;
        while i < N {
            all[i] = if i < own.len() { own[i] } else { part[0][i - own.len()] };
            i += 1;
        }
        all
    }
}

/// Lists the parameters of a native: `parameters![list: &[Value], places: (f64, f64)]`.
macro_rules! parameters {
    ($($name:ident: $type:ty),* $(,)?) => {
        const { &[$($crate::interpret::argument::Parameter::new::<$type>(stringify!($name))),*] }
    };
}

/// Declares a struct with one field for each parameter of a native, with `PARAMETERS` for its table and
/// `read(call)`. `as "a budget"` is what messages call the argument. Parameters that several natives have are
/// a struct of their own, which each of them names last: `..search: SearchArguments`.
macro_rules! arguments {
    ($(#[$meta:meta])* $vis:vis struct $Name:ident $(<$c:lifetime>)? {
        $($(#[$doc:meta])* $field:ident: $type:ty $(as $what:literal)?,)*
        $(..$part:ident: $Part:ident $(<$p:lifetime>)?,)?
    }) => {
        $(#[$meta])*
        $vis struct $Name $(<$c>)? {
            $($(#[$doc])* pub $field: $type,)*
            $(pub $part: $Part $(<$p>)?,)?
        }

        impl $(<$c>)? $Name $(<$c>)? {
            /// The parameters, as the declaration lists them.
            $vis const PARAMETERS: &'static [$crate::interpret::argument::Parameter] =
                &$crate::interpret::argument::Parameter::concatenated::<{
                    <[&str]>::len(&[$(stringify!($field)),*]) $(+ $Part::PARAMETERS.len())?
                }>(
                    &[$($crate::interpret::argument::Parameter::new::<$type>(stringify!($field))),*],
                    &[$($Part::PARAMETERS)?],
                );

            /// Reads all arguments of a call; an argument out of range is a fault.
            $vis fn read(
                call: &$crate::interpret::native::Call$(<$c>)?,
            ) -> $crate::interpret::stop::Eval<Self> {
                Ok($Name {
                    $($field: call.get_named(
                        stringify!($field),
                        [$($what,)? stringify!($field)][0],
                    )?,)*
                    $($part: $Part::read(call)?,)?
                })
            }
        }
    };
}

pub(crate) use {arguments, parameters};

/// Implements [`Argument`] for types whose values are one variant of [`Value`] each.
macro_rules! arguments_of_variants {
    ($($type:ty: $kind:ident = $pattern:pat => $result:expr;)*) => {$(
        impl<'c> Argument<'c> for $type {
            const KIND: Kind = Kind::$kind;

            fn read(value: &'c Value) -> Result<Self, ArgumentError> {
                match value {
                    $pattern => Ok($result),
                    _ => Err(ArgumentError::Type),
                }
            }
        }
    )*};
}

arguments_of_variants! {
    bool: Bool = Value::Bool(b) => *b;
    &'c str: Text = Value::Text(text) => text;
    &'c [Value]: List = Value::List(list) => list;
    Vec3: Vec3 = Value::Vec3(v, _) => *v;
    Pose: Pose = Value::Pose(pose) => **pose;
    &'c Rc<Callable>: Fn = Value::Fn(function) => function;
    &'c Rc<Instance>: Instance = Value::Instance(instance) => instance;
    &'c JointValue: Joint = Value::Joint(joint) => joint;
    &'c PortValue: Port = Value::Port(port) => port;
    &'c Rc<Behavior>: Behavior = Value::Behavior(behavior) => behavior;
    &'c ConditionValue: Condition = Value::Condition(condition) => condition;
    &'c Solid: Shape = Value::Shape(shape) => shape;
    &'c Mesh: Mesh = Value::Mesh(mesh) => mesh;
    &'c Rc<Cells>: Cells = Value::Cells(cells) => cells;
    &'c HeightField: Terrain = Value::Terrain(field) => field;
}

impl<'c> Argument<'c> for &'c Value {
    const KIND: Kind = Kind::Value;

    fn read(value: &'c Value) -> Result<&'c Value, ArgumentError> {
        Ok(value)
    }
}

impl<'c> Argument<'c> for f64 {
    const KIND: Kind = Kind::Number;

    fn read(value: &'c Value) -> Result<f64, ArgumentError> {
        value.as_number().ok_or(ArgumentError::Type)
    }
}

impl<'c> Argument<'c> for Positive {
    const KIND: Kind = Kind::Number;

    fn read(value: &'c Value) -> Result<Positive, ArgumentError> {
        let x = f64::read(value)?;
        if x > 0.0 { Ok(Positive(x)) } else { Err(ArgumentError::Range("must be positive")) }
    }
}

impl<'c> Argument<'c> for usize {
    const KIND: Kind = Kind::Int;

    fn read(value: &'c Value) -> Result<usize, ArgumentError> {
        match value {
            Value::Int(n) => usize::try_from(*n).map_err(|_| ArgumentError::Range("must not be negative")),
            Value::Big(_) => Err(ArgumentError::Range("is too large")),
            _ => Err(ArgumentError::Type),
        }
    }
}

/// The ends of a range of quantities as they are written, in SI units; the first may be the greater.
impl<'c> Argument<'c> for (f64, f64) {
    const KIND: Kind = Kind::Range;

    fn read(value: &'c Value) -> Result<(f64, f64), ArgumentError> {
        let Value::Range(ends) = value else { return Err(ArgumentError::Type) };
        Ok((f64::read(&ends.0)?, f64::read(&ends.1)?))
    }
}

/// The ends of a range as they are written.
impl<'c> Argument<'c> for (&'c Value, &'c Value) {
    const KIND: Kind = Kind::Range;

    fn read(value: &'c Value) -> Result<(&'c Value, &'c Value), ArgumentError> {
        let Value::Range(ends) = value else { return Err(ArgumentError::Type) };
        Ok((&ends.0, &ends.1))
    }
}

impl<'c> Argument<'c> for &'c StateValue {
    const KIND: Kind = Kind::Record("State");

    fn read(value: &'c Value) -> Result<&'c StateValue, ArgumentError> {
        match value {
            Value::Record(record) => match &**record {
                Record::State(state) => Ok(state),
                _ => Err(ArgumentError::Type),
            },
            _ => Err(ArgumentError::Type),
        }
    }
}

/// A report's verdict.
impl<'c> Argument<'c> for &'c Rc<Verdict> {
    const KIND: Kind = Kind::Record("Report");

    fn read(value: &'c Value) -> Result<&'c Rc<Verdict>, ArgumentError> {
        match value {
            Value::Record(record) => match &**record {
                Record::Report(verdict, _) => Ok(verdict),
                _ => Err(ArgumentError::Type),
            },
            _ => Err(ArgumentError::Type),
        }
    }
}

impl<'c> Argument<'c> for World {
    const KIND: Kind = Kind::Record("World");

    fn read(value: &'c Value) -> Result<World, ArgumentError> {
        match value {
            Value::Record(record) => match &**record {
                Record::World(world) => Ok(*world),
                _ => Err(ArgumentError::Type),
            },
            _ => Err(ArgumentError::Type),
        }
    }
}

impl<'c, T: Argument<'c>> Argument<'c> for Option<T> {
    const KIND: Kind = Kind::Optional(&T::KIND);

    fn read(value: &'c Value) -> Result<Option<T>, ArgumentError> {
        match value {
            Value::Missing => Ok(None),
            value => T::read(value).map(Some),
        }
    }
}

impl<'c, C: Choice> Argument<'c> for C {
    const KIND: Kind = Kind::Choice(C::words);

    fn read(value: &'c Value) -> Result<C, ArgumentError> {
        let Value::Word(word) = value else { return Err(ArgumentError::Type) };
        let found = C::WORDS.iter().find(|(known, _)| *known == word.as_str());
        found.map(|(_, value)| *value).ok_or(ArgumentError::Type)
    }
}

impl<'c, C: Choice, T: Argument<'c>> Argument<'c> for WordOr<C, T> {
    const KIND: Kind = Kind::WordOr(C::words, &T::KIND);

    fn read(value: &'c Value) -> Result<WordOr<C, T>, ArgumentError> {
        C::read(value).map(WordOr::Word).or_else(|_| T::read(value).map(WordOr::Value))
    }
}
