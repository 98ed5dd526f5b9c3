//! Faults of declarations: the reasons why a module, a connector, a cell or a strut is not sound.

use crate::geometry::Unsound;
use std::fmt;

/// The first fault that was found in a library or in one of its declarations. Lengths are in m, masses in kg.
#[derive(Clone, Debug, PartialEq)]
pub enum LibraryFault {
    /// A fault of a declaration, named by its kind and name.
    Declaration {
        /// The kind of declaration: `connector`, `module`, `cell` or `strut`.
        kind: &'static str,
        /// The name of the declaration that has the fault.
        name: String,
        /// The fault that the declaration has.
        fault: Box<LibraryFault>,
    },
    /// A fault of a part of a module, named by its sort, index and name.
    Inside {
        /// The part of the module, by its sort and index.
        part: ModulePart,
        /// The declared name of the part.
        name: String,
        /// The fault that the part has.
        fault: Box<LibraryFault>,
    },
    /// An index into a list of things of one sort that is too large for the list.
    Index {
        /// The sort of things in the list, as a word: `link`.
        what: &'static str,
        /// The index that is too large, from 0.
        index: usize,
        /// The length of the list that the index is into.
        count: usize,
    },
    /// A quantity that must be positive, and is zero, negative or no number.
    NotPositive {
        /// The name of the quantity in words, such as `mass`.
        what: &'static str,
        /// The value that was found, in SI units.
        value: f64,
    },
    /// A quantity that must not be negative, and is so or is not a number.
    Negative {
        /// The name of the quantity in words, such as `mass`.
        what: &'static str,
        /// The value that was found, in SI units.
        value: f64,
    },
    /// A quantity whose absolute value is above its limit, or that is not a number.
    Bound {
        /// The name of the quantity in words, such as `speed`.
        what: &'static str,
        /// The value that was found, in SI units.
        value: f64,
        /// The greatest absolute value that is allowed, in SI units.
        most: f64,
    },
    /// A connector whose number of allowed turns is 0, or too large.
    Turns {
        /// The number of turns that was found.
        turns: u32,
        /// The greatest number that is allowed.
        most: u32,
    },
    /// A connector that states to mate with another, which does not state to mate with it.
    OneWayMate {
        /// The declared name of the other connector.
        other: String,
    },
    /// Two connectors that mate and have different numbers of turns.
    MateTurns {
        /// The declared name of the other connector.
        other: String,
    },
    /// A module without any link, so that it has no body.
    NoLink,
    /// A shape that is not a solid, or a pose that is not rigid.
    Shape(Unsound),
    /// A drawn shape that sticks out of the shape that is judged, farther than the link states.
    LeftOut {
        /// A lower bound on the distance by which the drawn shape sticks out, m.
        found: f64,
        /// The distance that the link states as left out, m.
        stated: f64,
    },
    /// A centre of mass outside the axis-aligned box around its module.
    MassOutside {
        /// The greatest distance from the box along one of the axes of the module's frame, m.
        outside: f64,
    },
    /// An inertia of a link without mass.
    InertiaWithoutMass,
    /// An inertia with a principal moment that is not positive.
    InertiaNotPositive {
        /// The least principal moment that was found, kg·m².
        least: f64,
    },
    /// Principal moments of which one is more than the other two together.
    InertiaTriangle {
        /// The principal moments in ascending order, kg·m².
        moments: [f64; 3],
    },
    /// A principal moment that no body of this mass within the module has.
    InertiaExtent {
        /// The greatest principal moment that was found, kg·m².
        most: f64,
        /// The moment of all of the mass at the farthest corner of the module, kg·m².
        bound: f64,
    },
    /// A joint that carries a link that another joint of the module carries, or the body, which none may.
    SharedLink,
    /// A link that no joints connect with the body.
    LooseLink,
    /// An axis that is not a unit vector: its norm differs from 1 by more than 1e-6.
    Axis,
    /// A range that ends before it begins.
    RangeOrder,
    /// A joint of a module that follows itself, directly or over other joints.
    MimicCycle,
    /// A joint that follows others over too many steps.
    MimicDepth {
        /// The greatest number of steps, from a joint to the last one that it follows, that is allowed.
        most: usize,
    },
    /// A cell whose contracted edge is not shorter than its expanded one.
    NoShrinking,
    /// A strut whose greatest length is not larger than its least.
    NoLengthRange,
}

/// A part of a module, by its index, from 0, among those of its sort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModulePart {
    /// A link, by its index in [`ModuleType::links`](super::ModuleType::links).
    Link(usize),
    /// A joint, by its index in [`ModuleType::joints`](super::ModuleType::joints).
    Joint(usize),
    /// A motor, by its index in [`ModuleType::motors`](super::ModuleType::motors).
    Motor(usize),
    /// A port, by its index in [`ModuleType::ports`](super::ModuleType::ports).
    Port(usize),
}

impl ModulePart {
    /// Returns the word for the sort of the part: `link`, `joint`, `motor` or `port`.
    pub fn word(self) -> &'static str {
        match self {
            ModulePart::Link(_) => "link",
            ModulePart::Joint(_) => "joint",
            ModulePart::Motor(_) => "motor",
            ModulePart::Port(_) => "port",
        }
    }
}

impl LibraryFault {
    /// Returns this fault as one of the declaration of a `kind`, such as `module`, with this name.
    pub(super) fn of(self, kind: &'static str, name: &str) -> LibraryFault {
        LibraryFault::Declaration { kind, name: name.to_owned(), fault: Box::new(self) }
    }

    /// Returns this fault as one of a part of a module, with the name of the part.
    pub(super) fn inside(self, part: ModulePart, name: &str) -> LibraryFault {
        LibraryFault::Inside { part, name: name.to_owned(), fault: Box::new(self) }
    }

    /// Returns the part of a module that has the fault, if this is a [`LibraryFault::Inside`]; `None` for a fault of
    /// a module as a whole, and for one wrapped in a [`LibraryFault::Declaration`].
    pub fn part(&self) -> Option<ModulePart> {
        match self {
            LibraryFault::Inside { part, .. } => Some(*part),
            _ => None,
        }
    }
}

impl From<Unsound> for LibraryFault {
    fn from(unsound: Unsound) -> LibraryFault {
        LibraryFault::Shape(unsound)
    }
}

impl fmt::Display for LibraryFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LibraryFault::Declaration { kind, name, fault } => write!(f, "in {kind} `{name}`: {fault}"),
            LibraryFault::Inside { part, name, fault } => write!(f, "the {} `{name}`: {fault}", part.word()),
            LibraryFault::Index { what, index, count } => {
                write!(f, "there is no {what} {index}: there are {count}")
            }
            LibraryFault::NotPositive { what, value } => write!(f, "{what} must be positive, and is {value}"),
            LibraryFault::Negative { what, value } => {
                write!(f, "{what} must not be negative, and is {value}")
            }
            LibraryFault::Bound { what, value, most } => {
                write!(f, "{what} is {value} in SI units; the limit is {most}")
            }
            LibraryFault::Turns { turns, most } => write!(f, "it has {turns} turns, not 1 to {most}"),
            LibraryFault::OneWayMate { other } => write!(f, "it mates `{other}`, which does not mate it"),
            LibraryFault::MateTurns { other } => write!(f, "it mates `{other}`, which has other turns"),
            LibraryFault::NoLink => write!(f, "it has no link"),
            LibraryFault::Shape(unsound) => write!(f, "a shape or pose: {unsound}"),
            LibraryFault::LeftOut { found, stated } => write!(
                f,
                "what is drawn sticks at least {found:.6} m out of what is judged, and {stated} m are stated"
            ),
            LibraryFault::MassOutside { outside } => {
                write!(f, "its centre of mass is {outside} m outside of the module")
            }
            LibraryFault::InertiaWithoutMass => write!(f, "it has inertia and no mass"),
            LibraryFault::InertiaNotPositive { least } => {
                write!(f, "its least principal moment of inertia is {least} kg*m^2, not positive")
            }
            LibraryFault::InertiaTriangle { moments: [a, b, c] } => write!(
                f,
                "no body has the principal moments of inertia {a}, {b} and {c} kg*m^2: the greatest is more \
                 than the other two together"
            ),
            LibraryFault::InertiaExtent { most, bound } => write!(
                f,
                "no body of its mass within the module has a moment of inertia of {most} kg*m^2: at most \
                 {bound} kg*m^2"
            ),
            LibraryFault::SharedLink => {
                write!(f, "it carries the body, or a link that another joint carries")
            }
            LibraryFault::LooseLink => write!(f, "no joints connect it with the body"),
            LibraryFault::Axis => write!(f, "its axis is no unit vector"),
            LibraryFault::RangeOrder => write!(f, "its range ends before it begins"),
            LibraryFault::MimicCycle => write!(f, "it follows itself, over the joints that it follows"),
            LibraryFault::MimicDepth { most } => {
                write!(f, "it follows joints that follow others, over more than {most} steps")
            }
            LibraryFault::NoShrinking => write!(f, "`shrinks_to` must be less than `size`"),
            LibraryFault::NoLengthRange => write!(f, "`length` is a range from a length to a larger one"),
        }
    }
}

impl std::error::Error for LibraryFault {}
