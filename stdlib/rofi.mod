//! RoFI: universal modules of two bodies with three joints and six docks.

/// A RoFI dock: genderless, in four turns. Turn k of 90 degrees is the orientation N, E, S or W of RoFI's files.
connector Dock { mates Dock, turns 4, capture 5mm 5deg }

/// The RoFI universal module.
///
/// Two shoes, A and B, carry three docks each: +X, -X and -Z in the shoe's own frame. Shoe A is the
/// body of the module. `alpha` and `beta` tilt the shoes against the two bodies, `gamma` turns the
/// bodies against each other. `pitch` is the distance between the centres of the two bodies, which
/// is also their diameter.
///
/// Kinematics are those of the RoFI project: from shoe A to shoe B, in units of the pitch,
/// Rx(alpha) Rz(gamma) T(0, 0, 1) Ry(180deg) Rx(-beta). Mass, speed and torque are round figures.
module Rofi(pitch: Length = 100mm) {
  let rate = 90deg/s

  mass 500g

  link shoe_a = sphere(radius: pitch / 2, mass: 125g)
  link body_a = sphere(radius: 0.45 * pitch, mass: 125g)
  link body_b = sphere(radius: 0.45 * pitch, mass: 125g) at [0mm, 0mm, pitch]
  link shoe_b = sphere(radius: pitch / 2, mass: 125g) at [0mm, 0mm, pitch] turned(Y, 180deg)

  joint alpha : shoe_a -> body_a = revolute(axis: X, range: -90deg..90deg, max_speed: rate, max_torque: 10N*m)
  joint gamma : body_a -> body_b = revolute(axis: Z, max_speed: rate, max_torque: 10N*m)
  joint beta : body_b -> shoe_b = revolute(axis: X, range: -90deg..90deg, max_speed: rate, max_torque: 10N*m) at [0mm, 0mm, pitch]

  // The two balls of a module touch in one point.
  touching shoe_a shoe_b
  touching shoe_a body_b
  touching body_a shoe_b

  port a_plus_x : Dock on shoe_a at [pitch / 2, 0mm, 0mm] facing +X up -Z
  port a_minus_x : Dock on shoe_a at [-pitch / 2, 0mm, 0mm] facing -X up +Z
  port a_minus_z : Dock on shoe_a at [0mm, 0mm, -pitch / 2] facing -Z up +X
  port b_plus_x : Dock on shoe_b at [pitch / 2, 0mm, 0mm] facing +X up -Z
  port b_minus_x : Dock on shoe_b at [-pitch / 2, 0mm, 0mm] facing -X up +Z
  port b_minus_z : Dock on shoe_b at [0mm, 0mm, -pitch / 2] facing -Z up +X
}

/// A chain of `n` modules, straight up, dock -Z on dock -Z: what `tosnake` unwinds to.
config Snake(n: Int = 8) {
  part m[n]: Rofi
  for i in 0..n - 1 { connect m[i].b_minus_z -- m[i + 1].a_minus_z }
  base m[0]
  port head = m[0].a_minus_z
  port tail = m[n - 1].b_minus_z
}

/// A chain of `n` modules that is closed to a ring, standing upright.
///
/// From one module to the next the x axis turns round, so that the joints bend by turns the one and the other way.
config Ring(n: Int = 8) closed {
  require n >= 4 and n % 2 == 0, "a ring has an even number of modules, four at least"
  part m[n]: Rofi
  for i in 0..n {
    let bend = if i % 2 == 0 { 180deg / n } else { -180deg / n }
    connect m[i].b_minus_z -- m[(i + 1) % n].a_minus_z
    set m[i].alpha = bend
    set m[i].beta = bend
  }
  base m[0]
}

/// What `load` makes of a file: the modules are named by their ids, the base is the first.
config _Loaded(file: Text) closed {
  part m: Rofi
}
