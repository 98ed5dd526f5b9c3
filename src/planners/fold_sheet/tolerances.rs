//! Tolerances and thresholds of sheets that fold without cuts.

/// The tolerances and thresholds of sheets that fold without cuts; [`TOLERANCES`] has the values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances {
    /// The greatest difference of the angles of the faces at a vertex from a full turn, rad: what coordinates with six
    /// digits leave open.
    pub flat_vertex: f64,
    /// The square of a derivative of the loops by an angle below which there is none, against those of directions that
    /// open them.
    pub regular: f64,
    /// The part of the greatest square of a singular value below which a direction leaves the loops closed.
    pub free: f64,
    /// The least part of the square of the direction to flat that leaves the loops closed: a way that gains less does not
    /// lead there.
    pub gain: f64,
    /// The part of its own proportions in which a pattern can fold further, below which it can't.
    pub growth: f64,
    /// The part of the widest angle that a mountain or valley has at least: what rounding leaves is no fold.
    pub folds: f64,
    /// The rotation that may be left over round a vertex after a step, rad.
    pub closed: f64,
    /// The part of the norm of all angles to which a place of the way is reached.
    pub place: f64,
    /// The part by which limits of hinges are kept away from, for rounding.
    pub limits: f64,
    /// The greatest change of a stated angle for the loops to close, rad: a degree, for what is rounded or measured.
    pub stated: f64,
}

/// The values of the tolerances of this planner.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    flat_vertex: 1e-4,
    regular: 1e-10,
    free: 1e-6,
    gain: 0.02,
    growth: 1e-3,
    folds: 1e-6,
    closed: 1e-10,
    place: 1e-9,
    limits: 1e-6,
    stated: 0.0175,
};
