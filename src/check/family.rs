//! The families of declarations with instances, and the facts that cells and struts state.

use super::typed::{DefKind, Member, Param};
pub use crate::syntax::ast::FactsFamily;
use crate::units::Dimension;

/// A family of declarations with instances, by the keyword that begins them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The family of `module` declarations: modules with links, joints and ports.
    Module,
    /// The family of `config` declarations: configurations of modules.
    Config,
    /// The family of `cell` declarations, of which lattices are made.
    Cell,
    /// The family of `strut` declarations, of which trusses are made.
    Strut,
    /// The family of `lattice` declarations: arrangements of cells.
    Lattice,
    /// The family of `truss` declarations: nodes with struts between them.
    Truss,
}

/// A fact that the declarations of a family state.
#[derive(Debug)]
pub struct Fact {
    /// The word for the fact in the declaration, such as `size`.
    pub name: &'static str,
    /// The dimension of the fact's value.
    pub dimension: Dimension,
    /// The form that the fact's value must have.
    pub form: FactForm,
    /// True for a fact that none may leave out.
    pub required: bool,
}

/// The form that the value of a fact must have: `check` asks for its type, elaboration for its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactForm {
    /// A single quantity above zero.
    Positive,
    /// A range from a quantity above zero to a larger one.
    PositiveRange,
    /// A truth value, which has no dimension.
    Truth,
}

const fn positive(name: &'static str, dimension: Dimension) -> Fact {
    Fact { name, dimension, form: FactForm::Positive, required: true }
}

const fn optional(name: &'static str, dimension: Dimension) -> Fact {
    Fact { name, dimension, form: FactForm::Positive, required: false }
}

/// The facts of a cell.
const CELL: &[Fact] = &[
    positive("size", Dimension::LENGTH),
    positive("shrinks_to", Dimension::LENGTH),
    positive("mass", Dimension::MASS),
    positive("max_force", Dimension::FORCE),
    positive("max_speed", Dimension::SPEED),
    Fact { name: "slides", dimension: Dimension::NUMBER, form: FactForm::Truth, required: false },
];

/// The facts of a strut.
const STRUT: &[Fact] = &[
    Fact { name: "length", dimension: Dimension::LENGTH, form: FactForm::PositiveRange, required: true },
    positive("max_speed", Dimension::SPEED),
    positive("max_force", Dimension::FORCE),
    positive("mass", Dimension::MASS),
    positive("clearance", Dimension::LENGTH),
    optional("max_accel", Dimension::ACCELERATION),
    optional("buckling", Dimension::FORCE),
    optional("node_mass", Dimension::MASS),
];

impl Family {
    /// All families, in the order in which [`Family`] lists them.
    pub const ALL: [Family; 6] =
        [Family::Module, Family::Config, Family::Cell, Family::Strut, Family::Lattice, Family::Truss];

    /// Returns the name of the supertype of the family's declarations, such as `Module`.
    pub fn name(self) -> &'static str {
        match self {
            Family::Module => "Module",
            Family::Config => "Config",
            Family::Cell => "Cell",
            Family::Strut => "Strut",
            Family::Lattice => "Lattice",
            Family::Truss => "Truss",
        }
    }

    /// Returns the keyword of the family's declarations, such as `module`.
    pub fn word(self) -> &'static str {
        match self {
            Family::Module => "module",
            Family::Config => "config",
            Family::Cell => FactsFamily::Cell.word(),
            Family::Strut => FactsFamily::Strut.word(),
            Family::Lattice => "lattice",
            Family::Truss => "truss",
        }
    }

    /// Returns the family whose robots are made of instances of this one, as lattices of cells; `None` for those that
    /// stand alone or are parts of a configuration.
    pub fn container(self) -> Option<Family> {
        match self {
            Family::Cell => Some(Family::Lattice),
            Family::Strut => Some(Family::Truss),
            Family::Module | Family::Config | Family::Lattice | Family::Truss => None,
        }
    }

    /// Returns the facts that the declarations of the family state, in a fixed order; empty for families with a body
    /// of clauses.
    pub fn facts(self) -> &'static [Fact] {
        match self {
            Family::Cell => CELL,
            Family::Strut => STRUT,
            Family::Module | Family::Config | Family::Lattice | Family::Truss => &[],
        }
    }
}

impl From<FactsFamily> for Family {
    fn from(family: FactsFamily) -> Family {
        match family {
            FactsFamily::Cell => Family::Cell,
            FactsFamily::Strut => Family::Strut,
        }
    }
}

/// The parts that the declarations of all families of instances have in common: parameters, members, and the size of
/// the frame of locals.
pub struct Instantiable<'p> {
    /// The family of the declaration.
    pub family: Family,
    /// The keyword of the declaration: that of its family, or `scene`.
    pub word: &'static str,
    /// The parameters, in the order in which they are declared.
    pub params: &'p [Param],
    /// The parameters, and what the body names; a [`MemberId`](super::typed::MemberId) is an index into them.
    pub members: &'p [Member],
    /// The number of slots of the frame in which the expressions of the body and of defaults run.
    pub frame: usize,
}

impl DefKind {
    /// Returns true for a scene.
    pub fn is_scene(&self) -> bool {
        matches!(self, DefKind::Config(config) if config.scene)
    }

    /// Returns the parts that the declarations of all families of instances have; `None` for a declaration without
    /// instances.
    pub fn instantiable(&self) -> Option<Instantiable<'_>> {
        let (family, params, members, frame) = match self {
            DefKind::Module(d) => (Family::Module, &d.params, &d.members, d.frame),
            DefKind::Config(d) => (Family::Config, &d.params, &d.members, d.frame),
            DefKind::Facts(d) => (d.family.into(), &d.params, &d.members, d.frame),
            DefKind::Lattice(d) => (Family::Lattice, &d.params, &d.members, d.frame),
            DefKind::Truss(d) => (Family::Truss, &d.params, &d.members, d.frame),
            DefKind::Let(_)
            | DefKind::Fn(_)
            | DefKind::Native(_)
            | DefKind::Record(_)
            | DefKind::Connector(_)
            | DefKind::Study(_)
            | DefKind::Error => return None,
        };
        let word = if self.is_scene() { "scene" } else { family.word() };
        Some(Instantiable { family, word, params, members, frame })
    }
}
