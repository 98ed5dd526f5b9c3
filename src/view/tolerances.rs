//! The tolerances and thresholds of pictures and pages.

/// The tolerances with which pictures and pages are made.
pub(super) struct Tolerances {
    /// The tolerance of a panel's corner above or below the sheet, m: rounding of poses.
    pub flat: f64,
    /// The distance of midpoints below which two edges coincide in the end, m.
    pub meet: f64,
    /// The fold angle below which creases are level, rad.
    pub crease: f64,
    /// The distance of a base pose from interpolation between its neighbours within which it is left out: m for
    /// positions, 1 for quaternion components.
    pub base: f64,
    /// The tolerance within which a picture's time is that of a failure, s.
    pub picture_time: f64,
    /// The rounding step of lengths (m), angles (rad), directions and times (s) in a page: finer than any screen.
    pub rounding: f64,
    /// The rounding step of what is measured in simulations: positions (m), joints (rad or m), quaternions (1) and times
    /// (s).
    pub measured: f64,
    /// The rounding step of ways over the ground, m.
    pub way: f64,
    /// The least half of the size of a module by which arrows are scaled, m: that of points.
    pub module: f64,
    /// The least size, m, by which a drawing is scaled: smaller ones are points.
    pub size: f64,
    /// The least radius, m, of the scene of a picture.
    pub radius: f64,
    /// The height above a surface, as a fraction of the scene's radius, at which the shadow map is read for it, so
    /// that it does not shade itself.
    pub shadow: f64,
    /// The depth below the surface in the shadow map, as a fraction of the scene's radius, from which a point is in the
    /// shade.
    pub shadow_depth: f64,
    /// The height by which a dock stands out of its face, as a part of the width of the link there: what lies in one plane
    /// would flicker.
    pub fitting: f64,
    /// The part of a step between ticks within which a value lies on a tick: rounding.
    pub tick: f64,
    /// The least step between ticks that is written without an exponent, in the unit of the axis.
    pub plain_step: f64,
    /// The least coverage of a pixel of a plot that shows.
    pub coverage: f64,
}

/// The values of the tolerances with which every picture and page is made.
pub(super) const TOLERANCES: Tolerances = Tolerances {
    flat: 1e-6,
    meet: 1e-5,
    crease: 1e-6,
    base: 1e-4,
    picture_time: 1e-3,
    rounding: 1e-7,
    measured: 1e-5,
    way: 1e-4,
    module: 1e-3,
    size: 1e-9,
    radius: 1e-6,
    shadow: 0.004,
    shadow_depth: 0.006,
    fitting: 0.004,
    tick: 1e-9,
    plain_step: 1e-4,
    coverage: 0.002,
};
