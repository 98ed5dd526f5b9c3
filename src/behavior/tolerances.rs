//! The tolerances and thresholds of scheduling.

/// The tolerances with which behaviours are scheduled and transformed; those that a caller may set are in
/// [`Settings`](super::Settings).
pub(super) struct Tolerances {
    /// The greatest distance of an image from a joint in a mirrored robot, m: parts are placed with less care
    /// than this only by mistake, and the masses of the two halves of a module may differ a little.
    pub image_place: f64,
    /// The greatest sine of the angle between an axis and its image, without unit.
    pub image_direction: f64,
    /// The greatest difference of positions (rad or m) and times (s) of two schedules that count as the same:
    /// rounding.
    pub faithful: f64,
}

/// The tolerances with which every behaviour is scheduled and transformed.
pub(super) const TOLERANCES: Tolerances =
    Tolerances { image_place: 2e-3, image_direction: 1e-3, faithful: 1e-9 };
