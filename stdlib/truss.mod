//! Trusses of linear actuators.

/// A pneumatic reel actuator: an inflated tube that reels itself in and out, ten times as long as short.
///
/// Length range and the distance between struts are those of the linear-actuator-robots paper, with
/// its nominal length as one metre. Speed, force and mass are round figures: the paper states none. The force
/// is 41 times the weight; the first reel actuator bore 28 times its own (Hammond and others 2017).
strut PneumaticReel { length 300mm..3m  max_speed 50mm/s  max_force 400N  mass 1kg  clearance 100mm }
