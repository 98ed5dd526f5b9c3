//! Trusses of linear actuators.

/// A pneumatic reel actuator: an inflated tube that reels itself in and out, ten times as long as short.
///
/// Length range and the distance between struts are those of the linear-actuator-robots paper, with
/// its nominal length as one metre. The paper states neither speed, nor mass, nor force. Speed and mass are round
/// figures. The force is an assumption: it is one for which electric spindles are rated (LINAK's LA23: 900 N, 1.2,
/// 1.5, 1.8 or 2.5 kN, by its data sheet), and an inflated tube that is 140 mm thick bears as much at a pressure of
/// 1 bar. The first reel actuator bore 28 times its own weight (Hammond and others 2017), which here is 275 N: a
/// pyramid of 108 such struts could stand on its face, and not walk. The acceleration is an assumption, too: the speed is
/// reached in a fifth of a second, which moves 1 kg by a quarter of a newton.
strut PneumaticReel {
  length 300mm..3m  max_speed 50mm/s  max_accel 0.25m/s^2  max_force 1500N  mass 1kg  clearance 100mm
}
