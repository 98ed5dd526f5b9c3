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
    /// The type of a mistake that has been reported; it fits everywhere.
    Error,
    /// The type of what has no value, such as `print(...)`.
    Nothing,
    /// The type of a parameter of a built-in that takes any value.
    Any,
    /// The type of quantities of this dimension; `Number` is the one without dimension.
    Quantity(Dimension),
    /// The type of whole numbers, `Int`, which are `Number`s too.
    Int,
    /// The type of truth values: `Bool`.
    Bool,
    /// The type of texts: `Text`.
    Text,
    /// The type of lists, with elements of the given type: `List<T>`.
    List(Arc<Type>),
    /// The type of vectors of three quantities, `Vec3<T>`; a direction is three plain numbers.
    Vec3(Arc<Type>),
    /// The type of poses, position and orientation: `Pose`.
    Pose,
    /// The type of ranges, with ends of the given type: `Range<T>`.
    Range(Arc<Type>),
    /// The type of values that may be missing: `T?`.
    Optional(Arc<Type>),
    /// The type of functions, by parameters and result: `fn(A, B) -> C`.
    Fn(Arc<FnType>),
    /// The type of a choice of words, types, or both: `auto | Int`.
    Choice(Arc<Choice>),
    /// The type of joints, by the dimension of their position: `Joint<Angle>`, `Joint<Length>`.
    Joint(Arc<Type>),
    /// The type of ports of modules: `Port`.
    Port,
    /// The type of behaviours: `Behavior`.
    Behavior,
    /// The type of values that change during a behaviour: `Signal<T>`.
    Signal(Arc<Type>),
    /// The type of studies, with rows of the given type: `Study<Row>`.
    Study(Arc<Type>),
    /// The type of truth values that change during a behaviour: `Condition`.
    Condition,
    /// The type of shapes of links: `Shape`.
    Shape,
    /// The type of kinds of joints, which only a `joint` clause takes: `revolute(...)`, `prismatic(...)`, `fixed()`.
    JointKind,
    /// The type of arrangements of cells: `Cells`.
    Cells,
    /// The type of meshes: `Mesh`.
    Mesh,
    /// The type of point clouds: `Cloud`.
    Cloud,
    /// The type of height fields: `Terrain`.
    Terrain,
    /// The type of instances of one `module`, `cell`, `strut`, `config`, `lattice` or `truss` declaration.
    Instance(DefId),
    /// The type of instances of all declarations of a family: `Module`, `Config` (every module is one), `Lattice`,
    /// ...
    AnyOf(Family),
    /// The type of a record, declared by `record` or `extern type`.
    Record(DefId),
    /// A type parameter in the signature of a function, by index from 0.
    Param(u8),
    /// A type parameter in the body of its function, a type of which nothing is known: its index, from 0, and name.
    Opaque(u8, Symbol),
    /// A quantity in a power of a dimension parameter, times a dimension that is known: `Quantity<D>`,
    /// `Quantity<D^2>`, `Quantity<D/s>`.
    QuantityParam {
        /// The index of the type parameter in the function's signature, from 0.
        param: u8,
        /// The power of the dimension parameter.
        power: i8,
        /// The other factor of the dimension; [`Dimension::NUMBER`] where there is none.
        times: Dimension,
    },
}

/// The type of a function value; its parameters have no names and no defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct FnType {
    /// The types of the parameters, in order.
    pub params: Vec<Type>,
    /// The type of the value that a call gives.
    pub result: Type,
}

/// A choice: `exact | enumerate`, `auto | Int`, `Mesh | Cloud`: words, types, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The words of the choice, in the order in which they are written.
    pub words: Vec<Symbol>,
    /// The types of the choice, in the order in which they are written.
    pub types: Vec<Type>,
}

impl Type {
    /// The type `Number`: the quantity without dimension.
    pub const NUMBER: Type = Type::Quantity(Dimension::NUMBER);

    /// Returns the type of lists with elements of this type, `List<element>`.
    pub fn list(element: Type) -> Type {
        Type::List(Arc::new(element))
    }

    /// Returns the type of a value of the type `inner` that may be missing, `inner?`; an optional or erroneous type
    /// stays itself.
    pub fn optional(inner: Type) -> Type {
        match inner {
            Type::Optional(_) | Type::Error => inner,
            inner => Type::Optional(Arc::new(inner)),
        }
    }

    /// Returns the type of vectors of three quantities of this dimension.
    pub fn vec3(dimension: Dimension) -> Type {
        Type::Vec3(Arc::new(Type::Quantity(dimension)))
    }

    /// Returns the type of joints with positions of this dimension.
    pub fn joint(dimension: Dimension) -> Type {
        Type::Joint(Arc::new(Type::Quantity(dimension)))
    }

    /// Returns the dimension of the type if it is `Int` or a quantity; `None` for other types.
    pub fn dimension(&self) -> Option<Dimension> {
        match self {
            Type::Quantity(d) => Some(*d),
            Type::Int => Some(Dimension::NUMBER),
            _ => None,
        }
    }

    /// Returns the type, which fits `want`, with the dimensions of `want`: without the radians that are dropped there,
    /// and with energies and torques named as there. `None` if nothing changes.
    pub(super) fn in_dimensions_of(&self, want: &Type) -> Option<Type> {
        let inner = |a: &Type, b: &Type| a.in_dimensions_of(b).map(Arc::new);
        match (self, want) {
            (Type::Quantity(a), Type::Quantity(b)) => {
                (a.fits(*b) && !a.is_shown_as(*b)).then_some(Type::Quantity(*b))
            }
            (Type::List(a), Type::List(b)) => inner(a, b).map(Type::List),
            (Type::Vec3(a), Type::Vec3(b)) => inner(a, b).map(Type::Vec3),
            (Type::Range(a), Type::Range(b)) => inner(a, b).map(Type::Range),
            (Type::Optional(a), Type::Optional(b)) => inner(a, b).map(Type::Optional),
            (_, Type::Optional(b)) => self.in_dimensions_of(b),
            (_, Type::Choice(choice)) => match choice.types.as_slice() {
                [one] => self.in_dimensions_of(one),
                _ => None,
            },
            _ => None,
        }
    }

    /// Returns true for torques and energies, which are of one dimension, and for lists, vectors, ranges and optional
    /// values of them.
    pub(super) fn holds_torques(&self) -> bool {
        match self {
            Type::Quantity(d) => *d == Dimension::TORQUE,
            Type::List(inner) | Type::Vec3(inner) | Type::Range(inner) | Type::Optional(inner) => {
                inner.holds_torques()
            }
            _ => false,
        }
    }

    /// Returns the type, which `other` fits, as the type of values of both: a quantity in N·m counts as an energy only
    /// if both are energies, else as a torque.
    pub(super) fn shown_beside(&self, other: &Type) -> Type {
        let inner = |a: &Type, b: &Type| Arc::new(a.shown_beside(b));
        match (self, other) {
            (Type::Quantity(a), Type::Quantity(b)) => Type::Quantity(a.common(*b).unwrap_or(*a)),
            (Type::List(a), Type::List(b)) => Type::List(inner(a, b)),
            (Type::Vec3(a), Type::Vec3(b)) => Type::Vec3(inner(a, b)),
            (Type::Range(a), Type::Range(b)) => Type::Range(inner(a, b)),
            (Type::Optional(a), Type::Optional(b)) => Type::Optional(inner(a, b)),
            (Type::Optional(a), b) => Type::Optional(inner(a, b)),
            _ => self.clone(),
        }
    }

    /// Returns true if the type stands for a reported mistake.
    pub fn is_error(&self) -> bool {
        *self == Type::Error
    }
}
