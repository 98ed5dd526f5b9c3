//! RoFI: universal modules of two bodies with three joints and six docks.

/// A RoFI dock: genderless, in four turns. Turn k of 90 degrees is the orientation N, E, S or W of RoFI's files.
connector Dock { mates Dock, turns 4, capture 5mm 5deg }

/// Half the bracket of a shoe, as it is drawn: part of a shell about the body's ball, from the angle `start` on about Y,
/// from +X towards -Z.
fn _bracket(pitch: Length, start: Angle) -> Shape = {
  let across = [-0.26, -0.14, 0, 0.14, 0.26]
  let around = [start + 10deg * i for i in 0..13]
  let outside = [[sqrt(0.2475 - y^2) * cos(a), y, -sqrt(0.2475 - y^2) * sin(a)] for y in across for a in around]
  let inside = [[0.35 * cos(a), y, -0.35 * sin(a)] for y in [-0.24, 0.24] for a in [start, start + 120deg]]
  hull([[pitch * p[0], pitch * p[1], pitch * p[2]] for p in outside ++ inside])
}

/// A shoe of a module, as it is drawn: a bracket from the dock +X round the body to the dock -X. It weighs as a ball does.
fn _shoe(pitch: Length, weight: Mass) -> Shape = {
  let moment = 0.1 * weight * pitch^2
  union(
    _bracket(pitch, -30deg),
    _bracket(pitch, 90deg),
    mass: weight,
    com: [0mm, 0mm, 0mm],
    inertia: [moment, moment, moment],
  )
}

/// The RoFI universal module.
///
/// Two shoes, A and B, carry three docks each: +X, -X and -Z in the shoe's own frame. Shoe A is the
/// body of the module. `alpha` and `beta` tilt the shoes against the two bodies, `gamma` turns the
/// bodies against each other. `pitch` is the distance between the centres of the two bodies, which
/// is also their diameter.
///
/// Kinematics are those of the RoFI project: from shoe A to shoe B, in units of the pitch,
/// Rx(alpha) Rz(gamma) T(0, 0, 1) Ry(180deg) Rx(-beta). Mass, speed and torque are round figures.
/// The acceleration is an assumption, for the project's firmware and simulator state none: full speed after an eighth
/// of a second.
module Rofi(pitch: Length = 100mm) {
  let rate = 90deg/s
  let surge = 720deg/s^2

  mass 500g

  // A shoe is drawn as a bracket; what is judged and weighed is the ball that it turns in.
  link shoe_a = _shoe(pitch, weight: 125g) collides sphere(radius: pitch / 2)
  link body_a = sphere(radius: 0.45 * pitch, mass: 125g)
  link body_b = sphere(radius: 0.45 * pitch, mass: 125g) at [0mm, 0mm, pitch]
  link shoe_b = _shoe(pitch, weight: 125g)
    collides sphere(radius: pitch / 2)
    at [0mm, 0mm, pitch] turned(Y, 180deg)

  joint alpha : shoe_a -> body_a = revolute(
    axis: X,
    range: -90deg..90deg,
    max_speed: rate,
    max_accel: surge,
    max_torque: 10N*m
  )
  joint gamma : body_a -> body_b = revolute(axis: Z, max_speed: rate, max_accel: surge, max_torque: 10N*m)
  joint beta : body_b -> shoe_b = revolute(
    axis: X,
    range: -90deg..90deg,
    max_speed: rate,
    max_accel: surge,
    max_torque: 10N*m
  ) at [0mm, 0mm, pitch]

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

/// A ring of four modules, lying flat; the docks +X of their B shoes face inwards.
config Wheel closed {
  part m[4]: Rofi
  for i in 0..4 {
    connect m[i].b_minus_z -- m[(i + 1) % 4].a_minus_z turn 270deg
    set m[i].alpha = 90deg
    set m[i].gamma = 90deg
  }
}

/// Two wheels, one upon the other, each on an axle.
config Ball closed {
  part lower: Wheel
  part upper: Wheel
  part axle[2]: Rofi
  for i in 0..4 { connect lower.m[i].a_plus_x -- upper.m[i].a_minus_x turn 180deg }
  connect lower.m[0].b_plus_x -- axle[0].a_plus_x turn 90deg
  connect lower.m[2].b_plus_x -- axle[0].a_minus_x turn 270deg
  connect upper.m[0].b_plus_x -- axle[1].a_plus_x turn 270deg
  connect upper.m[2].b_plus_x -- axle[1].a_minus_x turn 90deg
}

/// Two wheels at the ends of a bar of two modules.
config Dumbbell closed {
  part wheel[2]: Wheel
  part bar[2]: Rofi
  connect bar[0].a_minus_z -- bar[1].a_minus_z
  connect wheel[0].m[0].b_plus_x -- bar[0].b_plus_x turn 90deg
  connect wheel[0].m[2].b_plus_x -- bar[0].b_minus_x turn 270deg
  connect wheel[1].m[0].b_plus_x -- bar[1].b_plus_x turn 270deg
  connect wheel[1].m[2].b_plus_x -- bar[1].b_minus_x turn 90deg
}

/// A wheel on a bent handle, whose other end holds a chain of three modules and a single one.
config Fan closed {
  part wheel: Wheel
  part handle[2]: Rofi
  part blade[3]: Rofi
  part stub: Rofi
  connect handle[0].a_minus_z -- handle[1].a_minus_z
  connect wheel.m[0].b_plus_x -- handle[1].b_plus_x turn 270deg
  connect wheel.m[2].b_plus_x -- handle[1].b_minus_x turn 90deg
  connect blade[1].b_plus_x -- handle[0].b_plus_x turn 90deg
  connect stub.b_plus_x -- handle[0].b_minus_x turn 270deg
  for i in 0..2 { connect blade[i].b_minus_z -- blade[i + 1].a_minus_z turn 270deg }
  set handle[0].alpha = 60deg
  set blade[0].beta = -90deg
  set blade[2].alpha = -90deg
  set stub.alpha = 90deg
  set stub.gamma = 90deg
}

/// A ring of two modules.
config Hoop closed {
  part m[2]: Rofi
  for i in 0..2 {
    connect m[i].b_minus_z -- m[1 - i].a_minus_z turn 180deg
    set m[i].alpha = 90deg
    set m[i].beta = 90deg
  }
}

/// Hoops side by side, connected wherever docks meet.
config Column(hoops: Int = 5) closed {
  part hoop[hoops]: Hoop
  for i in 0..hoops - 1 {
    for k in 0..2 {
      connect hoop[i].m[k].b_minus_x -- hoop[i + 1].m[k].b_plus_x turn 180deg
      connect hoop[i].m[k].a_plus_x -- hoop[i + 1].m[k].a_minus_x turn 180deg
    }
  }
}

/// A ring of ten modules.
config Circle closed { part ring: Ring(n: 10) }

/// Two rings of five modules side by side.
config DoubleWheel closed {
  part left[5]: Rofi
  part right[5]: Rofi
  for i in 0..5 {
    let turn_over = if i == 4 { 180deg } else { 0deg }
    let bend = if i % 2 == 0 { 36deg } else { -36deg }
    connect left[i].b_minus_z -- left[(i + 1) % 5].a_minus_z turn turn_over
    connect right[i].b_minus_z -- right[(i + 1) % 5].a_minus_z turn turn_over
    if i % 2 == 0 { connect left[i].b_minus_x -- right[i].b_minus_x }
    if i % 2 == 1 { connect left[i].b_plus_x -- right[i].b_plus_x }
    set left[i].alpha = bend
    set left[i].beta = bend
    set right[i].alpha = -bend
    set right[i].beta = -bend
  }
}

/// A ring of ten modules with four sharp corners.
config Rectangle closed {
  part m[10]: Rofi
  for i in 0..10 { connect m[i].b_minus_z -- m[(i + 1) % 10].a_minus_z }
  for i in [0, 8] { set m[i].alpha = 90deg }
  for i in [3, 5] { set m[i].alpha = -90deg }
}

/// A ring of ten modules with four round corners.
config RoundRectangle closed {
  part m[10]: Rofi
  for i in 0..10 { connect m[i].b_minus_z -- m[(i + 1) % 10].a_minus_z }
  for i in [0, 8] {
    set m[i].alpha = 45deg
    set m[i].beta = 45deg
  }
  for i in [3, 5] {
    set m[i].alpha = -45deg
    set m[i].beta = -45deg
  }
}

/// A ring of eight modules that crosses over itself, with a strut in each of its loops.
config Eight closed {
  part m[8]: Rofi
  part strut[2]: Rofi
  for i in 0..8 { connect m[i].b_minus_z -- m[(i + 1) % 8].a_minus_z }
  connect m[1].b_minus_x -- strut[0].b_minus_z turn 180deg
  connect m[6].a_minus_x -- strut[0].a_minus_z
  connect m[2].a_minus_x -- strut[1].b_minus_z
  connect m[5].b_minus_x -- strut[1].a_minus_z turn 180deg
  for i in [0, 4] {
    set m[i].beta = 90deg
    set m[i + 1].gamma = 90deg
    set m[i + 2].gamma = -90deg
    set m[i + 3].alpha = -90deg
  }
}

/// Four hips in a ring, each with a foot. With `gap` the ring is open; with `straight` no joint is bent.
config Spider(gap: Bool = false, straight: Bool = false) closed {
  part hip[4]: Rofi
  part foot[4]: Rofi
  for i in 0..4 {
    if not (gap and i == 1) { connect hip[i].a_plus_x -- hip[(i + 1) % 4].a_minus_z }
    connect hip[i].b_minus_z -- foot[i].a_minus_z
    if not straight {
      set hip[i].alpha = -30deg
      set hip[i].beta = 50deg
      set foot[i].alpha = -60deg
    }
  }

  /// One foot is lifted, swung with its hip, and put down again. Where the body then stands is not determined: by some 14 mm it
  /// depends on how the feet share the weight.
  ///
  /// Keeps a reserve of 0.90 on level ground with friction 1, as `step(0, 30deg, 20deg)`.
  behavior step(leg: Int, swing: Angle, lift: Angle) allows traction = Sc(
    move(foot[leg].alpha, by: lift),
    move(hip[leg].gamma, by: swing),
    move(foot[leg].alpha, by: -lift),
  )

  /// Two opposite feet step forward, one after the other; then both push the body after them. The
  /// other two feet carry their part of the weight and slip. All feet scrub, so that the travel is not determined: servos 0.4
  /// and 3.3 times as stiff take the robot some 18 mm apart.
  ///
  /// Keeps a reserve of 0.90 on level ground with friction 1.
  behavior crawl(steps: Int = 2, swing: Angle = 30deg, lift: Angle = 20deg) allows traction = repeat(
    Sc(
      step(0, swing, lift),
      step(2, -swing, lift),
      Pc(move(hip[0].gamma, by: -swing), move(hip[2].gamma, by: swing)),
    ),
    steps,
  )
}

/// Four legs of two modules: two pairs hold each other by their feet, one pair by its hips. With
/// `folded` the knees are bent, and the other hips hold each other, too.
config Crab(folded: Bool = false) closed {
  part hip[4]: Rofi
  part foot[4]: Rofi
  for i in 0..4 {
    connect hip[i].b_minus_z -- foot[i].a_minus_z
    if folded { set foot[i].alpha = 90deg }
  }
  connect hip[2].a_plus_x -- hip[3].a_minus_z
  connect foot[1].b_plus_x -- foot[3].b_plus_x turn 180deg
  connect foot[0].b_plus_x -- foot[2].b_plus_x turn 180deg
  if folded { connect hip[0].a_minus_z -- hip[1].a_plus_x }
}

/// Three arches one behind the other, with links between them.
config Caterpillar closed {
  part fore[3]: Rofi
  part hind[3]: Rofi
  part link_after[3]: Rofi
  part head: Rofi
  for i in 0..3 {
    connect fore[i].b_minus_z -- hind[i].a_minus_z
    connect fore[i].b_plus_x -- link_after[i].a_minus_x
    connect hind[i].a_plus_x -- link_after[i].b_plus_x turn 180deg
    if i < 2 {
      connect link_after[i].a_plus_x -- fore[i + 1].b_minus_x
      connect link_after[i].b_minus_x -- hind[i + 1].a_minus_x turn 180deg
    }
    set fore[i].alpha = -45deg
    set fore[i].beta = 45deg
    set hind[i].alpha = -45deg
    set hind[i].beta = 45deg
  }
  connect fore[0].b_minus_x -- head.a_plus_x
  connect hind[0].a_minus_x -- head.b_minus_x turn 180deg
}

/// Two straight chains that hold each other crosswise at all their sides.
config Chain(length: Int = 5) closed {
  part left: Snake(n: length)
  part right: Snake(n: length)
  for i in 0..length {
    if i % 2 == 0 { connect left.m[i].a_minus_x -- right.m[i].b_minus_x turn 180deg }
    if i % 2 == 1 { connect left.m[i].a_plus_x -- right.m[i].b_plus_x turn 180deg }
    if i + 1 < length and i % 2 == 0 { connect left.m[i].b_plus_x -- right.m[i + 1].a_minus_x }
    if i + 1 < length and i % 2 == 1 { connect left.m[i].b_minus_x -- right.m[i + 1].a_plus_x }
  }
}

/// A board: four modules side by side, framed by six.
config Board closed {
  part plank[4]: Rofi
  part fore[2]: Rofi
  part hind[2]: Rofi
  part side[2]: Rofi
  for i in 0..3 {
    connect plank[i].a_plus_x -- plank[i + 1].a_minus_x turn 180deg
    connect plank[i].b_minus_x -- plank[i + 1].b_plus_x turn 180deg
  }
  for i in 0..2 {
    connect plank[2 * i].a_minus_z -- fore[i].a_minus_x
    connect plank[2 * i + 1].a_minus_z -- fore[i].b_plus_x
    connect plank[2 * i].b_minus_z -- hind[i].a_plus_x
    connect plank[2 * i + 1].b_minus_z -- hind[i].b_minus_x
  }
  connect fore[0].b_minus_z -- fore[1].a_minus_z turn 180deg
  connect hind[0].b_minus_z -- hind[1].a_minus_z turn 180deg
  connect fore[1].b_minus_z -- side[0].a_minus_x
  connect plank[3].a_plus_x -- side[0].b_plus_x turn 180deg
  connect plank[3].b_minus_x -- side[1].a_minus_x turn 180deg
  connect hind[1].b_minus_z -- side[1].b_plus_x
  connect side[0].b_minus_z -- side[1].a_minus_z turn 180deg
}

/// A chair of eight modules: a seat of three, one upon the other, between two legs; posts behind them
/// hold the back.
config Chair closed {
  part leg[2]: Rofi
  part seat[3]: Rofi
  part post[2]: Rofi
  part back: Rofi
  connect leg[0].a_minus_z -- seat[0].a_minus_x
  connect leg[1].a_minus_z -- seat[0].b_plus_x
  connect leg[0].a_minus_x -- post[0].a_minus_z turn 90deg
  connect leg[1].a_plus_x -- post[1].a_minus_z turn 90deg
  connect post[0].b_minus_z -- back.a_plus_x
  connect post[1].b_minus_z -- back.b_minus_x turn 180deg
  connect seat[0].b_minus_x -- seat[1].a_plus_x turn 180deg
  connect seat[0].a_plus_x -- seat[1].b_minus_x turn 180deg
  connect seat[1].b_plus_x -- seat[2].a_minus_x turn 180deg
  connect seat[1].a_minus_x -- seat[2].b_plus_x turn 180deg
  for i in 0..3 {
    set seat[i].alpha = 90deg
    set seat[i].beta = 90deg
  }
  set post[0].beta = -90deg
  set post[1].beta = 90deg
}

/// A chair with a rung between its legs and a second module on its back.
config HighChair closed {
  part chair: Chair
  part top: Rofi
  part rung: Rofi
  connect chair.back.a_minus_x -- top.b_plus_x turn 180deg
  connect chair.back.b_plus_x -- top.a_minus_x turn 180deg
  connect chair.leg[0].b_minus_z -- rung.a_minus_x turn 270deg
  connect chair.leg[1].b_minus_z -- rung.b_plus_x turn 90deg
}

/// A stool: a seat of two modules in a rim of four, on four legs.
config Stool closed {
  part seat[2]: Rofi
  part rim[4]: Rofi
  part leg[4]: Rofi
  connect seat[0].a_plus_x -- seat[1].a_minus_x turn 180deg
  connect seat[0].b_minus_x -- seat[1].b_plus_x turn 180deg
  connect seat[0].a_minus_z -- rim[0].a_minus_z turn 270deg
  connect seat[0].b_minus_z -- rim[2].a_minus_z turn 90deg
  connect seat[1].a_minus_z -- rim[0].b_plus_x
  connect seat[1].b_minus_z -- rim[2].b_minus_x
  connect seat[1].a_plus_x -- rim[1].b_plus_x turn 180deg
  connect seat[1].b_minus_x -- rim[3].b_plus_x
  connect rim[0].b_minus_z -- rim[1].a_minus_z turn 270deg
  connect rim[2].b_minus_z -- rim[3].a_minus_z turn 90deg
  connect rim[1].b_minus_z -- rim[3].b_minus_z
  connect leg[0].a_minus_z -- rim[0].a_plus_x turn 180deg
  connect leg[1].a_minus_z -- rim[1].a_plus_x turn 90deg
  connect leg[2].a_minus_z -- rim[2].a_minus_x turn 180deg
  connect leg[3].a_minus_z -- rim[3].a_minus_x turn 90deg
  for i in 0..4 { set rim[i].alpha = 90deg }
  for i in [0, 1, 3] { set rim[i].gamma = 90deg }
  set rim[2].gamma = -90deg
}

/// A human: two legs of two modules on a hip, two modules of a chest with an arm each, and a head.
config Human closed {
  part thigh[2]: Rofi
  part shin[2]: Rofi
  part hip: Rofi
  part chest[2]: Rofi
  part head: Rofi
  part arm[2]: Rofi
  for i in 0..2 {
    connect thigh[i].b_minus_z -- shin[i].a_minus_z turn 180deg
    set thigh[i].alpha = -30deg
    set thigh[i].beta = 30deg
    set shin[i].alpha = 90deg
    set shin[i].beta = -90deg
  }
  connect hip.b_minus_x -- thigh[0].a_minus_x turn 180deg
  connect hip.b_plus_x -- thigh[1].a_plus_x turn 180deg
  connect hip.a_plus_x -- chest[0].b_plus_x turn 180deg
  connect hip.a_minus_x -- chest[1].b_minus_x turn 180deg
  connect chest[0].a_minus_x -- head.b_minus_x turn 180deg
  connect chest[1].a_plus_x -- head.b_plus_x turn 180deg
  connect chest[0].a_plus_x -- arm[0].b_plus_x
  connect chest[1].a_minus_x -- arm[1].b_plus_x turn 180deg
  set head.alpha = 60deg
  set arm[0].alpha = -45deg
  set arm[0].beta = -45deg
  set arm[1].alpha = 45deg
  set arm[1].beta = 45deg
}

/// An infant on its knees: a trunk of two modules, an arch of two at either end, arms of two.
config Infant closed {
  part trunk[2]: Rofi
  part fore[2]: Rofi
  part hind[2]: Rofi
  part arm[2]: Rofi
  part hand[2]: Rofi
  connect fore[0].b_minus_z -- fore[1].a_minus_z
  connect hind[0].b_minus_z -- hind[1].a_minus_z
  connect fore[0].b_plus_x -- trunk[0].a_plus_x turn 270deg
  connect fore[1].a_plus_x -- trunk[0].b_minus_x turn 270deg
  connect trunk[0].a_minus_x -- trunk[1].b_minus_x
  connect trunk[0].b_plus_x -- trunk[1].a_plus_x
  connect trunk[1].a_minus_x -- hind[0].b_minus_x turn 270deg
  connect trunk[1].b_plus_x -- hind[1].a_minus_x turn 270deg
  connect trunk[0].a_minus_z -- arm[0].b_minus_z
  connect trunk[0].b_minus_z -- arm[1].a_minus_z
  connect arm[0].b_plus_x -- hand[0].a_minus_x turn 180deg
  connect arm[1].a_minus_x -- hand[1].b_plus_x turn 180deg
  for i in 0..2 {
    set fore[i].alpha = -60deg
    set fore[i].beta = 60deg
    set hind[i].alpha = 60deg
    set hind[i].beta = -60deg
  }
  set trunk[0].alpha = -90deg
  set trunk[0].beta = -90deg
  set trunk[1].alpha = 90deg
  set trunk[1].beta = 90deg
}

/// A puppy: a ring of four modules on four legs, with a neck and a bent head.
config Puppy closed {
  part body[4]: Rofi
  part leg[4]: Rofi
  part neck: Rofi
  part head: Rofi
  for i in 0..4 { connect body[i].a_minus_z -- body[(i + 1) % 4].b_minus_x }
  connect body[0].b_minus_z -- leg[0].a_plus_x turn 270deg
  connect body[1].b_plus_x -- leg[1].a_minus_x turn 270deg
  connect body[2].b_minus_z -- leg[2].a_plus_x turn 270deg
  connect body[3].b_plus_x -- leg[3].a_minus_x turn 270deg
  connect body[0].a_minus_x -- neck.b_plus_x turn 270deg
  connect neck.a_minus_z -- head.b_minus_z turn 270deg
  set head.alpha = 45deg
  set head.beta = 90deg
}

/// A straight snake of `n` modules after so many random actions, to be unwound again.
///
/// An action is a quarter turn of a joint that is free on the way, the docking of two docks that meet, or
/// the letting go of a connection without which the robot is still in one piece. The same seed gives the
/// same tangle.
///
/// Example:
/// ```modl
/// use std.rofi.{Rofi, tangle}
/// let wild = tangle(12, 200, seed: 1)
/// print(count(wild), tosnake(wild).docks > 0)
/// ```
extern fn tangle(n: Int, actions: Int, seed: Int = 0) -> Config

/// What `load` makes of a file: the modules are named by their ids, the base is the first.
config _Loaded(file: Text) closed {
  part m: Rofi
}
