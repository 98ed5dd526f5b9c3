//! Tolerances and thresholds of folding.

/// The tolerances and thresholds of folding; [`TOLERANCES`] has the values.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// The fraction by which sides of a panel may differ from each other and from those of its face, and the length of
    /// the difference of the unit vectors of a port from those of its edge, without unit: rounding in files and in the
    /// language.
    pub side: f64,
    /// The fraction of the longest side by which the sides of faces that share a type of panel may differ: rounding
    /// of double arithmetic.
    pub same_panel: f64,
    /// The fraction below which a difference of masses counts as none: what [`Tolerances::side`] lets pass.
    pub mass: f64,
    /// The least height of a face as a fraction of its longest side; lower ones have no area.
    pub flat_face: f64,
    /// The distance of a corner from the mean plane of its face, as a fraction of the longest side, up to which the face is
    /// flat: rounding of coordinates with six digits.
    pub planar: f64,
    /// The angle by which an outline of more than three corners turns at each of them at least, rad; less is a straight
    /// corner, or one that turns back.
    pub corner: f64,
    /// The difference of a fold angle from π, rad, below which two faces lie on each other.
    pub back_to_back: f64,
    /// The difference of lengths, weights (as a fraction) and angles (rad) below which they are equal by symmetry:
    /// far below the part of the energy to which optima are proved.
    pub symmetry: f64,
    /// The fraction by which sides may differ and count as of one length: the pattern then lies on the triangular
    /// lattice.
    pub equal_sides: f64,
    /// The fraction of a side by which faces other than equal triangles may enter each other without an overlap: the
    /// rounding of corners that were laid side by side.
    pub overlap: f64,
    /// The length of a separating axis, as a fraction of the square of a side, below which the axis is rounding.
    pub axis: f64,
    /// The part of the energy that perturbations of costs may come to in all; proofs hold up to it.
    pub perturbation: f64,
    /// The fraction of their value below which a difference of layouts counts as none, so that they are equally good.
    pub tie: f64,
    /// The fraction of the value of an optimal folding by which the bound may be below it: what perturbations, ties
    /// and rounding come to together.
    pub proof: f64,
    /// The fraction by which bounds are lowered, and within which they reach the best energy: rounding of sums.
    pub bound: f64,
    /// The fraction of the cutoff by which the cost of an arc has to be above it for the arc to be removed: what
    /// rounding may add up to.
    pub fixing: f64,
    /// The least gain of an exchange of hinges, as a fraction of the energy: less is rounding, which would go
    /// round in circles.
    pub gain: f64,
    /// The fraction by which the least moment of inertia of a panel is lowered: rounding of its eigenvalues.
    pub moment: f64,
    /// The fraction by which bounds under gravity are lowered: rounding and the quadrature over a step.
    pub gravity_bound: f64,
    /// The fraction of their work below which a difference of orders counts as none: rounding of sums.
    pub work: f64,
    /// The excess of a fold angle over the limit of thick panels, rad, below which the excess is rounding.
    pub closing: f64,
    /// The fold angle below which a hinge is level, rad.
    pub level: f64,
    /// The difference of weights of hinges below which they are equal, so that rounding does not choose among trees.
    pub worth: f64,
    /// The distance from the line of a hinge, as a fraction of a side, below which corners rest on the hinge itself.
    pub hinge_line: f64,
    /// The step length, as a fraction of the gap between bound and goal, at which an ascent of multipliers ends:
    /// shorter steps do not raise the bound any more.
    pub ascent_step: f64,
    /// The least progress of a round of ascent, as a fraction of the gap, that counts as any.
    pub ascent_progress: f64,
    /// The width of a bin in which energies of layouts are counted, as a fraction of the unit of energy: finer than
    /// [`Tolerances::tie`], so that ties and levels can be distinguished.
    pub energy_grain: f64,
}

impl Tolerances {
    /// Returns true if a lower bound proves that nothing is better than `value` by more than the fraction
    /// [`proof`](Tolerances::proof) of it; both in one unit.
    pub fn prove(&self, value: f64, bound: f64) -> bool {
        bound >= value * (1.0 - self.proof)
    }
}

/// The values of the tolerances that every search of this planner uses.
pub const TOLERANCES: Tolerances = Tolerances {
    side: 1e-6,
    same_panel: 1e-9,
    mass: 1e-5,
    flat_face: 1e-9,
    planar: 1e-5,
    corner: 1e-6,
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
