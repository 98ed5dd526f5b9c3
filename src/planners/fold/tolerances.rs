//! Tolerances and thresholds of folding.

/// The tolerances and thresholds of folding; [`TOLERANCES`] has the values.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// Sides of a face and of its panel, and directions of ports and edges, differ by less than this fraction:
    /// rounding in files and in the language.
    pub side: f64,
    /// Faces whose sides differ by less than this fraction of the longest share a type of panel: rounding of
    /// double arithmetic.
    pub same_panel: f64,
    /// Masses that differ by less than this fraction are equal: what [`Tolerances::side`] lets pass.
    pub mass: f64,
    /// The least height of a face as a fraction of its longest side; lower ones have no area.
    pub flat_face: f64,
    /// Two faces whose absolute fold angle is nearer than this to π lie on each other, rad.
    pub back_to_back: f64,
    /// Lengths, weights (as a part) and angles (rad) that differ by less are equal by symmetry: far below the
    /// part of the energy to which optima are proved.
    pub symmetry: f64,
    /// All sides are of one length where they differ by less than this fraction: the pattern then lies on the
    /// triangular lattice.
    pub equal_sides: f64,
    /// Triangles of unequal sides overlap where no line separates all but this fraction of a side: the rounding
    /// of corners that were laid side by side.
    pub overlap: f64,
    /// A separating axis shorter than this fraction of the square of a side is rounding.
    pub axis: f64,
    /// The part of the energy that perturbations of costs may come to in all; proofs hold up to it.
    pub perturbation: f64,
    /// Layouts whose values differ by less than this fraction are equally good.
    pub tie: f64,
    /// A folding is optimal where the bound is below its value by less than this fraction: what perturbations, ties
    /// and rounding come to together.
    pub proof: f64,
    /// The fraction by which bounds are lowered, and within which they reach the best energy: rounding of sums.
    pub bound: f64,
    /// Arcs are removed where they would cost this much more than the cutoff, as a fraction of it: what rounding
    /// may add up to.
    pub fixing: f64,
    /// The least gain of an exchange of hinges, as a fraction of the energy: less is rounding, which would go
    /// round in circles.
    pub gain: f64,
    /// The fraction by which the least moment of inertia of a panel is lowered: rounding of its eigenvalues.
    pub moment: f64,
    /// The fraction by which bounds under gravity are lowered: rounding and the quadrature over a step.
    pub gravity_bound: f64,
    /// Orders whose work differs by less than this fraction are equally good: rounding of sums.
    pub work: f64,
    /// A fold angle beyond the limit of thick panels by less than this is rounding, rad.
    pub closing: f64,
    /// A hinge that folds less than this is level, rad.
    pub level: f64,
    /// Weights of hinges that differ by less are equal, so that rounding does not choose among trees.
    pub worth: f64,
    /// Corners nearer to the line of a hinge than this fraction of a side rest on the hinge itself.
    pub hinge_line: f64,
    /// The step length, as a fraction of the gap between bound and goal, at which an ascent of multipliers ends:
    /// shorter steps do not raise the bound any more.
    pub ascent_step: f64,
    /// The least progress of a round of ascent, as a fraction of the gap, that counts as any.
    pub ascent_progress: f64,
    /// Energies of layouts are counted in grains of this fraction of the unit of energy: finer than
    /// [`Tolerances::tie`], so that ties and levels can be distinguished.
    pub energy_grain: f64,
}

impl Tolerances {
    /// Returns true if a lower bound proves that nothing is better than `value` by more than the part `proof` of it;
    /// both in one unit.
    pub fn prove(&self, value: f64, bound: f64) -> bool {
        bound >= value * (1.0 - self.proof)
    }
}

/// The tolerances with which every search of this planner computes.
pub const TOLERANCES: Tolerances = Tolerances {
    side: 1e-6,
    same_panel: 1e-9,
    mass: 1e-5,
    flat_face: 1e-9,
    back_to_back: 1e-6,
    symmetry: 1e-10,
    equal_sides: 1e-6,
    overlap: 1e-9,
    axis: 1e-9,
    perturbation: 1e-9,
    tie: 1e-9,
    proof: 4e-9,
    bound: 1e-12,
    fixing: 1e-11,
    gain: 1e-11,
    moment: 1e-9,
    gravity_bound: 1e-7,
    work: 1e-12,
    closing: 1e-9,
    level: 1e-6,
    worth: 1e-6,
    hinge_line: 0.05,
    ascent_step: 1e-3,
    ascent_progress: 1e-4,
    energy_grain: 1e-11,
};
