//! Types of the language, as the checker and messages use them.

use super::family::Family;
use super::typed::DefId;
use crate::source::Symbol;
use crate::units::Dimension;
use std::sync::Arc;

/// The type of an expression. Types are erased at run time: only choices and optional values are
/// distinguished there.
#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    /// Something that was wrong and has been reported; it fits everywhere.
    Error,
    /// No value: `print(...)`.
    Nothing,
    /// A parameter of a built-in that takes any value.
    Any,
    /// `Number` is the quantity without dimension.
    Quantity(Dimension),
    /// A whole number; it is a `Number`.
    Int,
    /// A truth value: `Bool`.
    Bool,
    /// A text: `Text`.
    Text,
    /// A list: `List<T>`.
    List(Arc<Type>),
    /// Three quantities; a direction is three numbers.
    Vec3(Arc<Type>),
    /// A pose: `Pose`.
    Pose,
    /// A range: `Range<T>`.
    Range(Arc<Type>),
    /// A value that may be missing: `T?`.
    Optional(Arc<Type>),
    /// A function: `fn(A, B) -> C`.
    Fn(Arc<FnType>),
    /// A choice of words and types.
    Choice(Arc<Choice>),
    /// A joint, by the dimension of its position: `Joint<Angle>`, `Joint<Length>`.
    Joint(Arc<Type>),
    /// A port of a module: `Port`.
    Port,
    /// A behaviour: `Behavior`.
    Behavior,
    /// `Signal<T>`: a value that changes during a behaviour.
    Signal(Arc<Type>),
    /// `Condition`: a truth that changes during a behaviour.
    Condition,
    /// A shape: `Shape`.
    Shape,
    /// `revolute(...)`, `prismatic(...)`, `fixed()`: only a `joint` clause takes it.
    JointKind,
    /// `Cells`: the cells of a lattice.
    Cells,
    /// `Mesh`: a triangle mesh.
    Mesh,
    /// `Cloud`: a point cloud.
    Cloud,
    /// `Terrain`: a height field.
    Terrain,
    /// The instances of a `module`, `cell`, `strut`, `config`, `lattice` or `truss` declaration.
    Instance(DefId),
    /// The supertypes: `Module`, `Config` (a module is the smallest one), `Lattice`, ...
    AnyOf(Family),
    /// A record, declared by `extern type`.
    Record(DefId),
    /// A type parameter of the `extern fn` at hand.
    Param(u8),
    /// A quantity in a dimension parameter raised to a power: `Quantity<D>`, `Quantity<D^2>`.
    QuantityParam { param: u8, power: i8 },
}

/// The type of a function value.
#[derive(Clone, Debug, PartialEq)]
pub struct FnType {
    /// The types of the parameters, in order.
    pub params: Vec<Type>,
    /// The type of the result.
    pub result: Type,
}

/// A choice: `exact | enumerate`, `auto | Int`, `Mesh | Cloud`: words, types, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The words, in the order as written.
    pub words: Vec<Symbol>,
    /// The types, in the order as written.
    pub types: Vec<Type>,
}

impl Type {
    /// The type `Number`: the quantity without dimension.
    pub const NUMBER: Type = Type::Quantity(Dimension::NUMBER);

    /// Returns the type `List<element>`.
    pub fn list(element: Type) -> Type {
        Type::List(Arc::new(element))
    }

    /// Returns the optional type of `inner`; an optional or erroneous type stays itself.
    pub fn optional(inner: Type) -> Type {
        match inner {
            Type::Optional(_) | Type::Error => inner,
            inner => Type::Optional(Arc::new(inner)),
        }
    }

    /// Returns the type of vectors of three quantities.
    pub fn vec3(dimension: Dimension) -> Type {
        Type::Vec3(Arc::new(Type::Quantity(dimension)))
    }

    /// Returns the type of joints with positions of this dimension.
    pub fn joint(dimension: Dimension) -> Type {
        Type::Joint(Arc::new(Type::Quantity(dimension)))
    }

    /// Returns the dimension of an `Int` or a quantity; `None` for other types.
    pub fn dimension(&self) -> Option<Dimension> {
        match self {
            Type::Quantity(d) => Some(*d),
            Type::Int => Some(Dimension::NUMBER),
            _ => None,
        }
    }

    /// Returns true if the type stands for a reported mistake.
    pub fn is_error(&self) -> bool {
        *self == Type::Error
    }
}
