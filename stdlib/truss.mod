//! Trusses of linear actuators.

/// A pneumatic reel actuator: an inflated tube that reels itself in and out, ten times as long as short.
///
/// Length range and the distance between struts are those of the linear-actuator-robots paper, with
/// its nominal length as one metre. Speed, force and mass are round figures: the paper states none.
strut PneumaticReel { length 300mm..3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm }
