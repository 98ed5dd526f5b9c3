//! The problem and the settings of [`plan`](super::plan()).

use super::inertia::Inertia;
use super::objective::{Conventions, Minimise};
use super::panel::Panels;
use super::simulation::Count;
use super::target::Target;
use crate::plan;

/// A folding problem: the surface, the panels that it is made of, and gravity.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The surface that is folded, a mesh in m.
    pub target: Target,
    /// The panels, one for each face of `target` in its order.
    pub panels: Panels,
    /// The face that keeps its pose, the root, as an index in [`Target::faces`]; `None` lets the planner choose.
    pub root: Option<usize>,
    /// The gravity towards the ground on which the root lies with its outside down, m/s²; 0 without gravity and
    /// ground.
    pub gravity: f64,
    /// The layout as pairs of faces (indices in [`Target::faces`]) that share a hinge, a spanning tree in any order;
    /// `None` lets the planner choose.
    pub hinges: Option<Vec<[usize; 2]>>,
}

impl Problem {
    /// Returns a problem without gravity whose root and layout the planner chooses. `panels`: one for each face of
    /// `target`, in its order.
    pub fn new(target: Target, panels: Panels) -> Problem {
        Problem { target, panels, root: None, gravity: 0.0, hinges: None }
    }
}

/// The method by which [`plan`](super::plan()) searches layouts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Branch and bound where the objective is a sum over faces
    /// ([`Objective::is_sum_over_faces`](super::Objective::is_sum_over_faces)), else enumeration of few layouts or
    /// local search among many.
    #[default]
    Exact,
    /// The layout that the measure of [Yao et al.](super) prefers (their Theorem 1), for targets of at most 64 faces.
    /// For energy without gravity and panels of equal masses and sides only.
    Heuristic,
    /// The enumeration of every layout with every root, for targets of at most 64 faces.
    Enumerate,
}

/// The order in which the hinges of a layout fold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// The order of least energy, sought together with the layout, where energy without gravity is minimised and moving
    /// joints count, and leaves first where it is not.
    #[default]
    Auto,
    /// Leaves first (Alg. 2 of [Yao et al.](super)): as many steps as the tree is high.
    LeavesFirst,
    /// The root's children first, then theirs; as many steps as the tree is high.
    RootFirst,
    /// The order of least work against standard gravity, also where the problem has none (Eq. 15 to 17 of [Yao et
    /// al.](super)).
    LeastWork,
    /// The order of least energy for the layout; without gravity, with moving joints counted, and for trees of at
    /// most 8 hinges on a path only.
    LeastEnergy,
}

/// The model of the distribution of a panel's mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassModel {
    /// Triangles of evenly spread mass without thickness.
    #[default]
    Lamina,
    /// Triangles of evenly spread mass with the panels' thickness.
    Prism,
    /// All mass at the centroid, to which the numbers of [Yao et al.](super) amount.
    Point,
}

/// The options of [`plan`](super::plan()).
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The method by which layouts are searched. Default [`Method::Exact`].
    pub method: Method,
    /// The quantity to minimise: energy, peak torque, or steps. Default [`Minimise::Energy`].
    pub minimise: Minimise,
    /// The order of folding that is tried first. Default [`Sequence::Auto`].
    pub sequence: Sequence,
    /// The duration of each step, s; `None`, the default: the least that the limits of all hinges allow for the
    /// greatest fold angle.
    pub step: Option<f64>,
    /// The model of the distribution of a panel's mass. Default [`MassModel::Lamina`].
    pub inertia: MassModel,
    /// The joints whose torques count: those that move, or all. Default [`Count::Moving`].
    pub count: Count,
    /// The radius of the hinges, m, for the report of panels that are too thick (Eq. 1 of [Yao et al.](super)); `None`,
    /// the default, leaves that report empty.
    pub hinge_radius: Option<f64>,
    /// The seed of choices among equal layouts and of random searches. Default 0.
    pub seed: u64,
    /// The greatest number of search steps. One is, in branch and bound, a node of the search tree, a face settled on a
    /// path, the evaluation of an exchange of two hinges, or as many sums as take that long; in local search, a layout
    /// measured with one root; in enumeration, a layout visited. Default 100 million, which take 3 to 5 s.
    pub budget: u64,
    /// The settings of the judge that every plan has to pass. Default [`plan::Settings::default`].
    pub judge: plan::Settings,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            method: Method::Exact,
            minimise: Minimise::Energy,
            sequence: Sequence::Auto,
            step: None,
            inertia: MassModel::Lamina,
            count: Count::Moving,
            hinge_radius: None,
            seed: 0,
            budget: 100_000_000,
            judge: plan::Settings::default(),
        }
    }
}

impl Settings {
    /// Returns the conventions under which foldings of a problem are measured.
    pub(crate) fn conventions(&self, problem: &Problem) -> Conventions {
        let panel = &problem.panels.weakest;
        let widest = problem.target.hinges.iter().map(|hinge| hinge.angle.abs()).fold(0.0, f64::max);
        Conventions {
            inertia: match self.inertia {
                MassModel::Lamina => Inertia::Lamina,
                MassModel::Prism => Inertia::Prism(panel.thickness),
                MassModel::Point => Inertia::Point,
            },
            count: self.count,
            gravity: problem.gravity,
            step: self.step.unwrap_or_else(|| panel.step_time(widest)),
        }
    }
}
