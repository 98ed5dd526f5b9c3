//! SMORES: its two generations of modules, and the library of designs with their behaviours.
//!
//! Frames and signs. The chassis is the body: +x towards the top face at zero tilt, +y towards the
//! left face, +z up, the origin where the axle crosses the long axis. `left` and `right` both turn
//! about +y, so that equal speeds drive straight ahead. `front` (also called `pan`) turns the top
//! face about its outward normal. A positive `tilt` folds the top face up.
//!
//! Designs follow the tables of the compositional-design paper and the authors' published robots.
//! A chain joins the bottom of one module to the top of the next.
//!
//! Each behaviour states the reserve that it keeps under full dynamics with its default arguments: the part of its limit that
//! the joint with the greatest load has left (`torque_margin` of a report), rounded down to a twentieth.

// The simulated generation, 2012 to 2015. Figures are those of the authors' simulator: masses, centres
// of mass and limits from its model file, shapes from the envelopes of its meshes.

/// The magnetic face of SMORES: genderless, in four turns. The force that it holds is not published.
connector MagnetFace { mates MagnetFace, turns 4, capture 4mm 5deg }

/// A SMORES module of 2012 to 2015: a cube of 100 mm that drives on two wheels, tilts and pans.
///
/// Pan and tilt come from two motors through a differential: one turns with their sum, one with
/// their difference.
module Smores {
  let rate = 2.4086rad/s  // 23 rpm

  // An assumption, for nothing is published: full speed after 0.2 s. A tilt that carries two more modules
  // straight out needs a sixth of its torque for that.
  let surge = 12rad/s^2

  // An assumption, too: tilt and pan yield by 0.9 degrees under their greatest torque.
  let grip = 150N*m/rad

  mass 557.2924g  // the sum of the links

  // The wheels are the lowest parts; the holder's edges stay 1.3 mm, the top disc 3.3 mm above the ground.
  contact 4mm

  /// The U-shaped holder of the axle, with the bottom face. Its arms are rounded about the axle.
  link holder = union(
    placed(box(6.2mm, 85.4mm, 88mm), at: [-46.1mm, 0mm, 0mm]),
    placed(box(43mm, 6.1mm, 88mm), at: [-21.5mm, 39.65mm, 0mm]),
    placed(box(43mm, 6.1mm, 88mm), at: [-21.5mm, -39.65mm, 0mm]),
    placed(cylinder(radius: 44mm, length: 6.1mm, axis: Y), at: [0mm, 39.65mm, 0mm]),
    placed(cylinder(radius: 44mm, length: 6.1mm, axis: Y), at: [0mm, -39.65mm, 0mm]),
    mass: 127.498g, com: [-30.676mm, 0mm, 0mm], friction: 0.35,
  )
  /// The half with the motors, which tilts.
  link block = box(
    72.3mm,
    72.2mm,
    59.6mm,
    mass: 309.551g,
    com: [1.7906mm, 0mm, 0mm],
    friction: 0.35
  ) at [6.45mm, 0mm, 0mm]
  link top_disc = cylinder(
    radius: 42mm,
    length: 3.2mm,
    axis: X,
    mass: 45.716g,
    com: [-3.8mm, 0mm, 0mm],
    friction: 0.75
  ) at [47.5mm, 0mm, 0mm]
  link left_disc = cylinder(
    radius: 45.3mm,
    length: 6mm,
    axis: Y,
    mass: 37.2637g,
    com: [0mm, -0.3mm, 0mm],
    friction: 1.0
  ) at [0mm, 46.1mm, 0mm]
  link right_disc = cylinder(
    radius: 45.3mm,
    length: 6mm,
    axis: Y,
    mass: 37.2637g,
    com: [0mm, 0.3mm, 0mm],
    friction: 1.0
  ) at [0mm, -46.1mm, 0mm]

  joint tilt : holder -> block = revolute(
    axis: -Y,
    range: -90deg..90deg,
    max_speed: rate,
    max_accel: surge,
    max_torque: 2.3N*m,
    stiffness: grip
  )
  joint front : block -> top_disc = revolute(
    axis: X,
    max_speed: rate,
    max_accel: surge,
    max_torque: 2.3N*m,
    stiffness: grip
  )
  joint left : holder -> left_disc = revolute(
    axis: Y,
    max_speed: rate,
    max_accel: surge,
    max_torque: 1.2N*m,
    stiffness: grip
  )
  joint right : holder -> right_disc = revolute(
    axis: Y,
    max_speed: rate,
    max_accel: surge,
    max_torque: 1.2N*m,
    stiffness: grip
  )
  alias pan = front
  motor sum = tilt + front (max_speed: rate)
  motor difference = tilt - front (max_speed: rate)

  // These parts pass each other by 1 to 2 mm at any tilt; that is how the module is built, and no news.
  touching holder top_disc
  touching top_disc left_disc
  touching top_disc right_disc

  port top : MagnetFace on top_disc at [2.5mm, 0mm, 0mm] facing +X up +Z
  port bottom : MagnetFace on holder at [-50mm, 0mm, 0mm] facing -X up +Z
  port left : MagnetFace on left_disc at [0mm, 3.9mm, 0mm] facing +Y up +Z
  port right : MagnetFace on right_disc at [0mm, -3.9mm, 0mm] facing -Y up +Z
}

// The electro-permanent generation, from 2015.

/// The electro-permanent face of SMORES-EP: four magnets, genderless, in four turns.
connector EPFace {
  mates EPFace, turns 4
  holds 88.4N   // mean of the published pulls
  holds 1.9N*m  // that pull at the lever of the magnets about the face's edge
  capture 4mm 5deg
}

/// A SMORES-EP module: a cube of 80 mm with electro-permanent faces.
///
/// The split of the mass is an estimate.
module SmoresEP {
  let rate = 2.4086rad/s  // 23 rpm at no load
  let surge = 12rad/s^2   // an assumption, as that of `Smores`
  let grip = 150N*m/rad   // an assumption, as that of `Smores`

  mass 454g
  contact 4mm

  link holder = union(
    placed(box(4mm, 68mm, 60mm), at: [-32mm, 0mm, 0mm]),
    placed(box(30mm, 4mm, 60mm), at: [-15mm, 32mm, 0mm]),
    placed(box(30mm, 4mm, 60mm), at: [-15mm, -32mm, 0mm]),
    placed(cylinder(radius: 30mm, length: 4mm, axis: Y), at: [0mm, 32mm, 0mm]),
    placed(cylinder(radius: 30mm, length: 4mm, axis: Y), at: [0mm, -32mm, 0mm]),
    mass: 30g, com: [-22mm, 0mm, 0mm], friction: 0.02,
  )
  link block = box(54mm, 58mm, 38mm, mass: 314g, com: [-13mm, 0mm, 0mm], friction: 0.02) at [5mm, 0mm, 0mm]
  link top_disc = cylinder(radius: 31.4mm, length: 5mm, axis: X, mass: 40g, friction: 0.15) at [36.5mm, 0mm, 0mm]
  link left_disc = cylinder(radius: 31.25mm, length: 4.4mm, axis: Y, mass: 35g, friction: 1.0) at [0mm, 36.8mm, 0mm]
  link right_disc = cylinder(radius: 31.25mm, length: 4.4mm, axis: Y, mass: 35g, friction: 1.0) at [0mm, -36.8mm, 0mm]

  // The driver refuses tilts beyond 80 degrees.
  joint tilt : holder -> block = revolute(
    axis: -Y,
    range: -80deg..80deg,
    max_speed: rate,
    max_accel: surge,
    max_torque: 2.3N*m,
    stiffness: grip
  )
  joint front : block -> top_disc = revolute(
    axis: X,
    max_speed: rate,
    max_accel: surge,
    max_torque: 1.4N*m,
    stiffness: grip
  )
  joint left : holder -> left_disc = revolute(
    axis: Y,
    max_speed: rate,
    max_accel: surge,
    max_torque: 1.2N*m,
    stiffness: grip
  )
  joint right : holder -> right_disc = revolute(
    axis: Y,
    max_speed: rate,
    max_accel: surge,
    max_torque: 1.2N*m,
    stiffness: grip
  )
  alias pan = front
  motor sum = tilt + front (max_speed: rate)
  motor difference = tilt - front (max_speed: rate)

  touching holder top_disc
  touching top_disc left_disc
  touching top_disc right_disc

  port top : EPFace on top_disc at [3.5mm, 0mm, 0mm] facing +X up +Z
  port bottom : EPFace on holder at [-40mm, 0mm, 0mm] facing -X up +Z
  port left : EPFace on left_disc at [0mm, 3.2mm, 0mm] facing +Y up +Z
  port right : EPFace on right_disc at [0mm, -3.2mm, 0mm] facing -Y up +Z
}

// Order 1: designs of single modules.

/// One module that drives like a car: the paper's DRIVER1 with its DRIVE and TURN.
config Driver1 {
  part m: Smores
  port top = m.top
  port bottom = m.bottom
  port left = m.left
  port right = m.right

  // The wheels' contacts act as a track of 92.7 mm; wheel radius 45.3 mm.
  let spread = 92.7mm / (2 * 45.3mm)

  /// Drives straight: both wheels at speed `v` for time `t`.
  ///
  /// Keeps a reserve of 0.95 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Pc(spin(m.left, v, for: t), spin(m.right, v, for: t))

  /// Turns on the spot by angle `a`, to the left.
  ///
  /// Keeps a reserve of 0.95 on level ground with friction 1.
  behavior turn(a: Angle = 90deg) = Pc(move(m.left, by: -a * spread), move(m.right, by: a * spread))
}

/// Three modules in a row: CHAIN3, which is also SNAKE3.
config Chain3 {
  part m[3]: Smores
  for i in 0..2 { connect m[i].bottom -- m[i + 1].top }
  base m[1]
  port head = m[0].top
  port tail = m[2].bottom

  /// Half a wave in time `period`: the middle goes to `amplitude`, the ends to its opposite.
  ///
  /// Keeps a reserve of 0.70 on level ground with friction 1.
  behavior half_wave(amplitude: Angle = 30deg, period: Time = 1s) =
    Pc([move(m[i].tilt, to: if i == 1 { amplitude } else { -amplitude }, in: period) for i in 0..3])

  /// Goes back to a straight line; from half a wave that stands on its ends, faster than in 2 s it would tip.
  ///
  /// Keeps a reserve of 0.70 on level ground with friction 1, after `half_wave()`.
  behavior straight(period: Time = 2s) = Pc([move(x.tilt, to: 0deg, in: period) for x in m])

  /// A whole wave in time `period`, from straight to straight.
  ///
  /// Keeps a reserve of 0.65 on level ground with friction 1.
  behavior sine(amplitude: Angle = 30deg, period: Time = 4s) =
    Sc(half_wave(amplitude, period / 4), half_wave(-amplitude, period / 2), straight(period / 4))
}

/// Three modules in a row that steer: the outer ones are the axles of a car.
config Steer3 {
  part front: Smores
  part center: Smores
  part back: Smores
  connect front.bottom -- center.top
  connect center.bottom -- back.top
  base center
  port nose = front.top
  port tail = back.bottom
  port side[4] = [front.left, front.right, back.left, back.right]

  /// Lifts the middle off the ground (the published pose: 0.5, -0.5 and 0.7 rad).
  ///
  /// Keeps a reserve of 0.65 on level ground with friction 1.
  behavior stand =
    Pc(move(front.tilt, to: 0.5rad), move(center.tilt, to: -0.5rad), move(back.tilt, to: 0.7rad))

  /// Lies flat.
  ///
  /// Keeps a reserve of 0.70 on level ground with friction 1, after `stand()`.
  behavior flat = Pc([move(x.tilt, to: 0deg) for x in [front, center, back]])

  /// Steers: turns the two axles against each other by angle `a`.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1.
  behavior turn(a: Angle = 15deg) = Pc(move(back.pan, to: a), move(center.pan, to: -a))
}

// On which side of the body a leg hangs that is attached by `hip`: the factor that makes a positive
// turn of its first pan joint carry the foot forward, to the +x of the robot's base. Legs of the two
// sides see each other turned by half a turn, so that the same command moves their feet opposite ways.
fn _ahead(hip: Port) -> Number = dot(direction(pose(hip), X), Y)

/// A leg of three modules, LEG3, attached by its hip, hanging down and leaning in under the body.
///
/// `lean` is how far it leans. When two legs carry a walker, each bears half of the weight 100 mm beside the spine, which
/// is more than the spine's pans can hold alone: a foot farther in loads the spine less and the leg itself more.
///
/// `bend` is how far the leg bends to lift its foot.
config Leg3(bend: Angle = 30deg, lean: Angle = 22deg) {
  part thigh: Smores
  part shin: Smores
  part foot: Smores
  connect thigh.bottom -- shin.top
  connect shin.bottom -- foot.top
  set thigh.tilt = -90deg
  set shin.tilt = -lean
  set foot.tilt = lean
  base thigh
  port hip = thigh.top
  port toe = foot.bottom

  // The feet of two legs would meet farther in.
  let up = max(lean, min(lean + 3 / 4 * bend, 45deg))

  /// Lifts the foot in under the body and keeps the sole level, in time `t`.
  ///
  /// Outwards the same bend would load the body's joints by a seventh more.
  ///
  /// Keeps a reserve of 0.75 with its base held.
  behavior lift(t: Time = 0.8s) = Pc(move(shin.tilt, to: -up, in: t), move(foot.tilt, to: up, in: t))

  /// Stretches the leg down to the ground, with a level sole, in time `t`.
  ///
  /// Keeps a reserve of 0.75 with its base held, after `lift()`.
  behavior plant(t: Time = 0.8s) = Pc(
    move(thigh.tilt, to: -90deg, in: t),
    move(shin.tilt, to: -lean, in: t),
    move(foot.tilt, to: lean, in: t),
  )

  /// Carries the foot forward until the leg is turned by `swing`: 20 degrees in 0.8 s.
  ///
  /// Keeps a reserve of 0.75 with its base held.
  behavior reach(swing: Angle = 20deg) =
    move(thigh.pan, to: swing * _ahead(hip), in: max(0.8s, abs(swing) / 20deg * 0.8s))

  /// Pushes the body forward: turns the leg back by `swing`, in time `t`: unless said, 20 degrees in 1 s.
  ///
  /// Keeps a reserve of 0.75 with its base held.
  behavior push(swing: Angle = 20deg, t: Time = max(0.8s, abs(swing) / 20deg * 1s)) =
    move(thigh.pan, by: -swing * _ahead(hip), in: t)
}

/// A body of three modules, BODY3, with a place for a leg at each corner: front left and right, back left and right.
config Body3 {
  part front: Smores
  part core: Smores
  part back: Smores
  connect front.bottom -- core.top
  connect core.bottom -- back.top
  base core
  port nose = front.top
  port tail = back.bottom
  port side[4] = [front.left, front.right, back.left, back.right]
}

/// An arm of `n` modules that stands up from its foot: waist, shoulder, elbow and so on.
config Arm(n: Int = 4) {
  require n >= 2, "an arm has a waist and a shoulder"
  part m[n]: Smores
  for i in 0..n - 1 { connect m[i].top -- m[i + 1].bottom }
  set m[0].tilt = 90deg
  base m[0]
  port foot = m[0].bottom
  port hand = m[n - 1].top

  /// Points straight up.
  ///
  /// Keeps a reserve of 0.15 with its base held, after `dig()`.
  behavior stow = Pc([move(m[i].tilt, to: 0deg) for i in 1..n])

  /// Bends forward at the shoulder, by `shoulder` from upright.
  ///
  /// Keeps a reserve of 0.15 with its base held.
  behavior dig(shoulder: Angle = 90deg) = move(m[1].tilt, to: -shoulder)

  /// Turns at the waist.
  ///
  /// Keeps a reserve of 0.95 with its base held.
  behavior turn(a: Angle = 90deg) = move(m[0].pan, to: a)
}

/// The arm PUMA4, with the five joints of its namesake.
config Puma4 {
  part waist: Smores
  part upper: Smores
  part fore: Smores
  part hand: Smores
  connect waist.top -- upper.bottom
  connect upper.top -- fore.bottom
  connect fore.top -- hand.bottom
  set waist.tilt = 90deg
  base waist
  port foot = waist.bottom
  port tool = hand.top

  /// Moves all five joints at once, each to its angle.
  ///
  /// Keeps a reserve of 0.30 with its base held.
  behavior posture(
    waist_to: Angle = 0deg, shoulder: Angle = -30deg, elbow: Angle = -60deg, wrist: Angle = 30deg, roll: Angle = 0deg,
  ) = Pc(
    move(waist.pan, to: waist_to),
    move(upper.tilt, to: shoulder),
    move(fore.tilt, to: elbow),
    move(hand.tilt, to: wrist),
    move(hand.pan, to: roll),
  )

  /// Points straight up.
  ///
  /// Keeps a reserve of 0.30 with its base held, after `posture()`.
  behavior stow = Pc([move(x.tilt, to: 0deg) for x in [upper, fore, hand]])
}

/// Two arms of three modules at the sides of a seventh: GRASPER7.
config Grasper7 {
  part m: Smores
  part l[3]: Smores
  part r[3]: Smores
  connect m.left -- l[0].top
  connect m.right -- r[0].top
  for i in 0..2 {
    connect l[i].bottom -- l[i + 1].top
    connect r[i].bottom -- r[i + 1].top
  }
  base m

  /// Turns the arms so that they bend along the ground.
  ///
  /// On the ground they roll over their edges on the way.
  ///
  /// Keeps a reserve of 0.25 on level ground with friction 1.
  behavior neutral allows unstable = Pc(move(m.left, to: 90deg), move(m.right, to: 90deg))

  /// Closes the arms around something in front (the published angles; the wrists stay 141 mm apart).
  ///
  /// Keeps a reserve of 0.15 on level ground with friction 1.
  behavior squeeze = Sc(
    neutral(),
    Pc([
      Pc(move(a[0].tilt, to: 90deg), move(a[1].tilt, to: 17.188734deg), move(a[2].tilt, to: 72.811266deg))
      for a in [l, r]
    ]),
  )

  /// Opens the arms.
  ///
  /// Keeps a reserve of 0.20 on level ground with friction 1, after `squeeze()`.
  behavior open = Pc([move(x.tilt, to: 0deg) for x in l ++ r])
}

/// Four modules in a row that climb steps: CLIMBER4.
config Climber4 {
  part c[4]: Smores
  for i in 0..3 { connect c[i].bottom -- c[i + 1].top }
  base c[1]

  /// Gets up (the published pose).
  ///
  /// Keeps a reserve of 0.75 on level ground with friction 1.
  behavior stand = Pc(move(c[0].tilt, to: 80deg), move(c[1].tilt, to: -40deg), move(c[2].tilt, to: 40deg))

  /// Lies flat.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1, after `stand()`.
  behavior flat = Pc([move(x.tilt, to: 0deg) for x in c])

  /// Raises the front by a step, while the wheels drive on at speed `v`. A negative `a` steps down.
  ///
  /// Keeps a reserve of 0.70 on level ground with friction 1.
  behavior step(a: Angle = 70deg, v: AngularSpeed = 1rad/s) = Pc(
    move(c[1].tilt, to: a, in: 2s),
    move(c[2].tilt, to: -a, in: 2s),
    drive(v, 2s),
  )

  /// Drives all wheels at speed `v` for time `t`.
  ///
  /// Keeps a reserve of 0.95 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 2s) =
    Pc([Pc(spin(x.left, v, for: t), spin(x.right, v, for: t)) for x in c])
}

/// Twelve modules in a closed ring, which stands upright like a wheel: RING12.
config Ring12 closed {
  part m[12]: Smores
  for i in 0..12 {
    connect m[i].bottom -- m[(i + 1) % 12].top
    set m[i].tilt = 30deg
  }
  base m[0]
}

// Order 2: designs of designs.

// One stride of a walker: two legs lift, reach forward and are put down, then all push, 20 degrees in time `pace`.
fn _stride(legs: List<Leg3>, a: Int, b: Int, swing: Angle, pace: Time = 1s) -> Behavior = Sc(
  Pc(legs[a].lift(), legs[b].lift()),
  Pc(legs[a].reach(swing), legs[b].reach(swing)),
  Pc(legs[a].plant(), legs[b].plant()),
  Pc([l.push(swing, max(0.8s, abs(swing) / 20deg * pace)) for l in legs]),
)

/// A body with four legs that walks: WALK4.
config Walk4(bend: Angle = 30deg) {
  part body: Body3
  part leg[4]: Leg3(bend: bend)
  for i in 0..4 { connect body.side[i] -- leg[i].hip }
  base body.core

  /// Stands on its four legs.
  ///
  /// Keeps a reserve of 0.85 on level ground with friction 1.
  behavior stand = Pc([l.plant() for l in leg])

  /// Legs `a` and `b`, a diagonal, step forward by `swing`; then all push.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior stride(a: Int = 0, b: Int = 3, swing: Angle = 20deg) = _stride(leg, a, b, swing)

  /// Walks forward in steps of the one and the other diagonal.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior walk(steps: Int = 2, swing: Angle = 20deg) = repeat(Sc(stride(0, 3, swing), stride(1, 2, swing)), steps)
}

/// A spine of five modules with four legs at its ends: FOURLEG17.
///
/// Two legs that carry it on a diagonal bear 46 N each, 100 mm beside the spine: 4.65 N*m, shared by the spine's pans and a
/// leg's tilt, which hold 2.3 N*m each. So the spine is arched by `arch`: its pans take cos(arch) of a moment about its length.
/// With a straight spine at least 1.05 of the torque is needed, however much the legs lean.
config FourLeg17(bend: Angle = 30deg, lean: Angle = 10deg, arch: Angle = 30deg) {
  part spine[5]: Smores
  part leg[4]: Leg3(bend: bend, lean: lean)
  for i in 0..4 { connect spine[i].bottom -- spine[i + 1].top }
  connect spine[0].left -- leg[0].hip
  connect spine[0].right -- leg[1].hip
  connect spine[4].left -- leg[2].hip
  connect spine[4].right -- leg[3].hip

  // The front half slopes down to the front, the back half down to the back; the hips stay upright.
  set spine[2].tilt = -2 * arch
  set spine[4].tilt = arch
  set spine[0].left = -arch
  set spine[0].right = -arch
  base spine[4]

  /// Stands on its four legs.
  ///
  /// Keeps a reserve of 0.75 on level ground with friction 1.
  behavior stand = Pc([l.plant() for l in leg])

  /// Legs `a` and `b` step forward by `swing`; then all push, slowly, for the wheels of the hips are weak.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior stride(a: Int = 0, b: Int = 3, swing: Angle = 20deg) = _stride(leg, a, b, swing, pace: 2s)

  /// Walks forward in steps of the one and the other diagonal.
  ///
  /// With a `swing` of 20 degrees legs that reach forward, on their heels, are as high as those that stand on flat soles.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior walk(steps: Int = 2, swing: Angle = 20deg) = repeat(Sc(stride(0, 3, swing), stride(1, 2, swing)), steps)
}

/// A spine of two modules with four legs: WALKER14. Its front half is a grasper.
///
/// The legs of a side stand too close to swing past each other: it treads on the spot. They lean in as far as they can without
/// meeting those of the other side, since the spine has but one pan.
config Walker14(bend: Angle = 10deg) {
  part spine[2]: Smores
  part leg[4]: Leg3(bend: bend, lean: 28deg)
  connect spine[0].bottom -- spine[1].top
  for i in 0..2 {
    connect spine[i].left -- leg[2 * i].hip
    connect spine[i].right -- leg[2 * i + 1].hip
  }
  base spine[0]

  /// Stands on its four legs.
  ///
  /// Keeps a reserve of 0.85 on level ground with friction 1.
  behavior stand = Pc([l.plant() for l in leg])

  /// Lifts the one and the other diagonal in turn.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior tread(steps: Int = 2) = repeat(
    Sc(
      Pc(leg[0].lift(), leg[3].lift()),
      Pc(leg[0].plant(), leg[3].plant()),
      Pc(leg[1].lift(), leg[2].lift()),
      Pc(leg[1].plant(), leg[2].plant()),
    ),
    steps,
  )
}

/// The published walkbot: a spine of five modules and four chains as legs, wheel face on wheel face.
///
/// Its legs hang from the wheels of the spine: both turntables of a hip swing the leg. Below the hips they lean in by `lean`,
/// and the spine between them is arched by `arch`, steeper at the hind legs, for the reasons of `FourLeg17`.
config Walkbot17(lean: Angle = 23deg, arch: Angle = 26deg) {
  part spine[5]: Smores
  part leg[4]: Chain3
  for i in 0..4 { connect spine[i].bottom -- spine[i + 1].top }
  connect spine[1].left -- leg[0].m[0].left turn 270deg
  connect spine[1].right -- leg[1].m[0].right turn 90deg
  connect spine[4].left -- leg[2].m[0].left turn 270deg
  connect spine[4].right -- leg[3].m[0].right turn 90deg
  base spine[4]

  // Two modules go down as far as one goes up, so that the hips are at one height. The head is thrown back: the less of the
  // weight is in front of the legs.
  let rise = asin(2 * sin(arch))

  set spine[4].tilt = rise
  set spine[3].tilt = -arch - rise
  set spine[1].tilt = 90deg
  set spine[0].tilt = 80deg

  // Upright, but for a third of a degree: so the feet bear farther in front, and all of them the same.
  let upright = [-arch + 0.3deg, -arch + 0.3deg, 0.3deg, 0.3deg]
  let hip: List<Joint<Angle>> = [spine[1].left, spine[1].right, spine[4].left, spine[4].right]
  let inwards = [1, -1, 1, -1]

  set spine[1].left = upright[0]
  set spine[1].right = upright[1]
  set spine[4].left = upright[2]
  set spine[4].right = upright[3]
  for i in 0..4 {
    set leg[i].m[1].pan = 90deg
    set leg[i].m[1].tilt = lean * inwards[i]
    set leg[i].m[2].tilt = -lean * inwards[i]
  }

  // Leans a leg in by angle `a`, with a level sole.
  behavior _lean(i: Int, a: Angle) =
    Pc(move(leg[i].m[1].tilt, to: a * inwards[i], in: 1s), move(leg[i].m[2].tilt, to: -a * inwards[i], in: 1s))

  /// Lifts the foot of a leg (0 to 3: front left, front right, back left, back right) in under the body by `bend`.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1, as `lift(0)`.
  behavior lift(i: Int, bend: Angle = 17deg) = _lean(i, lean + bend)

  /// Stretches a leg down to the ground.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1, as `plant(0)`, after `lift(0)`.
  behavior plant(i: Int) = _lean(i, lean)

  // Leg `i` steps forward by `swing`. If it stepped alone, one of three legs would bear half of the weight, with 1.05 of its
  // torque.
  behavior _step(i: Int, swing: Angle) =
    Sc(lift(i), move(hip[i], to: upright[i] - swing, in: max(0.8s, abs(swing) / 20deg * 0.8s)), plant(i))

  /// Legs `a` and `b`, a diagonal, step at once; then all push, slowly.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior stride(a: Int = 0, b: Int = 3, swing: Angle = 20deg) = Sc(
    Pc(_step(a, swing), _step(b, swing)),
    Pc([move(h, by: swing, in: max(0.8s, abs(swing) / 20deg * 2s)) for h in hip]),
  )

  /// Walks forward in steps of the one and the other diagonal.
  ///
  /// Keeps a reserve of 0 on level ground with friction 1.
  behavior walk(steps: Int = 2, swing: Angle = 20deg) = repeat(Sc(stride(0, 3, swing), stride(1, 2, swing)), steps)
}

/// A snake of eighteen modules, SNAKE18: six chains end to end.
config Snake18 {
  part seg[6]: Chain3
  for i in 0..5 { connect seg[i].tail -- seg[i + 1].head }
  base seg[2].m[2]

  /// The chains' half waves, side by side in opposite phase.
  ///
  /// It hardly gets on: 12 mm in one cycle as judged, 10 mm as simulated. A wave along the ground carries a snake where it slips
  /// along itself more easily than aside, as on passive wheels or scales; the friction of these modules is the same in all
  /// directions.
  ///
  /// Keeps a reserve of 0.25 on level ground with friction 1.
  behavior slither(amplitude: Angle = 30deg, period: Time = 2s, cycles: Int = 3) =
    repeat(Pc([_two_halves(seg[i], if i % 2 == 0 { amplitude } else { -amplitude }, period) for i in 0..6]), cycles)
}

fn _two_halves(c: Chain3, amplitude: Angle, period: Time) -> Behavior =
  Sc(c.half_wave(amplitude, period / 2), c.half_wave(-amplitude, period / 2))

/// A car of seven modules, CAR: a steering chain with a driver at each end of both axles.
config Car {
  part steer: Steer3
  part wheel[4]: Driver1
  connect steer.side[0] -- wheel[0].right
  connect steer.side[1] -- wheel[1].left
  connect steer.side[2] -- wheel[2].right
  connect steer.side[3] -- wheel[3].left
  base steer.center
  port nose = steer.nose
  port tail = steer.tail
  port side[4] = [wheel[0].left, wheel[1].right, wheel[2].left, wheel[3].right]

  /// Drives straight: the wheels of both axles at speed `v` for time `t`.
  ///
  /// Wheels that are docked to each other must turn alike, so all twelve of them drive.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Pc([
    Pc(spin(m.left, v, for: t), spin(m.right, v, for: t))
    for m in [steer.front, steer.back, wheel[0].m, wheel[1].m, wheel[2].m, wheel[3].m]
  ])

  /// Lifts the middle, so that turning the axles steers.
  ///
  /// Keeps a reserve of 0.35 on level ground with friction 1.
  behavior stand = steer.stand()

  /// Steers: turns the axles against each other by angle `a`.
  ///
  /// Keeps a reserve of 0.30 on level ground with friction 1, after `stand()`.
  behavior turn(a: Angle = 15deg) = steer.turn(a)
}

/// A car of five modules, DRIVER5: a steering chain with two drivers at its back axle.
config Driver5 {
  part steer: Steer3
  part wheel[2]: Driver1
  connect steer.side[2] -- wheel[0].right
  connect steer.side[3] -- wheel[1].left
  base steer.center
  port nose = steer.nose
  port tail = steer.tail

  /// Drives straight: the wheels of both axles at speed `v` for time `t`.
  ///
  /// Keeps a reserve of 0.85 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Pc([
    Pc(spin(m.left, v, for: t), spin(m.right, v, for: t)) for m in [steer.front, steer.back, wheel[0].m, wheel[1].m]
  ])

  /// Lifts the middle, so that turning the axles steers.
  ///
  /// Keeps a reserve of 0.50 on level ground with friction 1.
  behavior stand = steer.stand()

  /// Steers: turns the axles against each other by angle `a`.
  ///
  /// Keeps a reserve of 0.40 on level ground with friction 1.
  behavior turn(a: Angle = 15deg) = steer.turn(a)
}

/// A tank of seven modules, TANK7: four arms whose top discs are its wheels.
config Tank7 {
  part steer: Steer3
  part arm[4]: Smores
  for i in 0..4 {
    connect steer.side[i] -- arm[i].bottom
    set arm[i].tilt = -45deg
  }
  base steer.center
  port nose = steer.nose
  port tail = steer.tail

  /// Drives straight. The discs of the two sides face away from each other, and so do their signs.
  ///
  /// Keeps a reserve of 0.85 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) =
    Pc([spin(arm[i].pan, if i % 2 == 0 { v } else { -v }, for: t) for i in 0..4])

  /// Turns on the spot, to the left where `v` is positive.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1.
  behavior turn(v: AngularSpeed = 2rad/s, t: Time = 2s) = Pc([spin(a.pan, -v, for: t) for a in arm])
}

/// A car of eight modules on the top discs of four arms: RCCAR8.
config RcCar8 {
  part spine[4]: Smores
  part arm[4]: Smores
  for i in 0..3 { connect spine[i].bottom -- spine[i + 1].top }
  connect spine[0].left -- arm[0].bottom
  connect spine[0].right -- arm[1].bottom
  connect spine[3].left -- arm[2].bottom
  connect spine[3].right -- arm[3].bottom
  for a in arm { set a.tilt = -45deg }
  base spine[1]

  /// Drives straight.
  ///
  /// Keeps a reserve of 0.75 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) =
    Pc([spin(arm[i].pan, if i % 2 == 0 { v } else { -v }, for: t) for i in 0..4])
}

/// A driving base with a trunk of four modules in front: PROBOSCIS7.
config Proboscis7 {
  part back: Smores
  part side[2]: Smores
  part trunk[4]: Smores
  connect back.left -- side[0].bottom
  connect back.right -- side[1].bottom
  connect back.top -- trunk[0].bottom
  for i in 0..3 { connect trunk[i].top -- trunk[i + 1].bottom }
  base back
  port tip = trunk[3].top

  /// Raises the trunk by angle `a` at its root, in time `t`. 60 degrees are the edge of what stands; in the least time there is
  /// too little torque for 30.
  ///
  /// Keeps a reserve of 0.15 on level ground with friction 1.
  behavior raise(a: Angle = 30deg, t: Time = 2s) = move(trunk[0].tilt, to: a, in: t)

  /// Reaches over a step: the tip down, the next module up, then the one behind it.
  ///
  /// Keeps a reserve of 0.40 on level ground with friction 1.
  behavior climb = Sc(
    Pc(move(trunk[3].tilt, to: -80deg), move(trunk[2].tilt, to: 80deg)),
    move(trunk[1].tilt, to: 80deg),
  )
}

/// A chain of four with two arms at its front: SCORPION6.
config Scorpion6 {
  part s[4]: Smores
  part arm[2]: Smores
  for i in 0..3 { connect s[i].bottom -- s[i + 1].top }
  connect s[0].left -- arm[0].bottom
  connect s[0].right -- arm[1].bottom
  base s[0]

  /// Rises on its arms (the published pose).
  ///
  /// Keeps a reserve of 0.45 on level ground with friction 1.
  behavior rise = Pc(
    move(s[0].tilt, to: 30deg),
    move(s[1].tilt, to: -20deg),
    move(s[2].tilt, to: 20deg),
    move(arm[0].tilt, to: -40deg),
    move(arm[1].tilt, to: -40deg),
  )
}

/// A cross of nine modules that stands on four feet: CROSS9. Its inner modules are the knees.
config Cross9(stance: Angle = 90deg) {
  part m: Smores
  part inner[4]: Smores
  part outer[4]: Smores
  connect m.top -- inner[0].top
  connect m.bottom -- inner[1].top
  connect m.left -- inner[2].top
  connect m.right -- inner[3].top
  for i in 0..4 {
    connect inner[i].bottom -- outer[i].top
    set inner[i].tilt = -stance
  }
  base m

  /// Squats and rises again: all knees bend by `a` and come back.
  ///
  /// Keeps a reserve of 0.25 on level ground with friction 1.
  behavior squat(a: Angle = 10deg) =
    Sc(Pc([move(k.tilt, by: a) for k in inner]), Pc([move(k.tilt, by: -a) for k in inner]))
}

/// A mobile manipulator of eight modules, MOBMANIP8: two drivers, a front support, and an arm behind.
config MobManip8 {
  part m: Smores
  part wheel[2]: Smores
  part support: Smores
  part arm[4]: Smores
  connect m.left -- wheel[0].bottom
  connect m.right -- wheel[1].bottom
  connect m.top -- support.bottom
  connect m.bottom -- arm[0].top
  for i in 0..3 { connect arm[i].bottom -- arm[i + 1].top }
  base m
  port hand = arm[3].bottom

  /// Raises the arm: its hand first, as the arm is too heavy to be lifted straight. The wheels yield by some 30 mm,
  /// which is not determined better than within 6 mm.
  ///
  /// Keeps a reserve of 0.15 on level ground with friction 1.
  behavior raise allows traction = Sc(
    move(arm[2].tilt, to: 80deg, in: 1.5s),
    Pc(move(arm[1].tilt, to: 43deg, in: 2s), move(arm[2].tilt, to: 37deg, in: 2s)),
  )

  /// Holds the arm out.
  ///
  /// Keeps a reserve of 0.30 on level ground with friction 1, after `raise()`.
  behavior forward = Pc(move(arm[1].tilt, to: 26deg, in: 2s), move(arm[2].tilt, to: -20deg, in: 2s))
}

// Order 3.

/// A car with an arm of `n` modules on its nose: BACKHOE. With 6 it cannot lift its arm, with 8 it falls over it.
config Backhoe(n: Int = 4) {
  part car: Car
  part arm: Arm(n: n)
  connect car.nose -- arm.foot
  base car.steer.center

  /// Drives with the arm leant back and its foot off the ground, where its wheels, at right angles to those of the car, would
  /// drag.
  ///
  /// Keeps a reserve of 0.45 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Sc(carry(), car.drive(v, t))

  /// Leans the arm back over the car, then lifts its foot; straight up it is too heavy for the nose.
  ///
  /// Keeps a reserve of 0.45 on level ground with friction 1.
  behavior carry =
    Sc(move(arm.m[1].tilt, to: 40deg, in: 1s), move(car.steer.front.tilt, to: 4deg, in: 1s))

  /// Reaches forward and comes back.
  ///
  /// Keeps a reserve of 0.15 on level ground with friction 1.
  behavior dig(shoulder: Angle = 90deg) = Sc(arm.dig(shoulder), arm.stow())

  /// Turns the arm at its waist.
  ///
  /// Keeps a reserve of 0.95 on level ground with friction 1.
  behavior swing(a: Angle = 90deg) = arm.turn(a)
}

/// A car of five with an arm: DRIVER5 and PUMA4. Its base is small: it can reach forward, less so to the side.
config Driver5Puma4 {
  part car: Driver5
  part arm: Puma4
  connect car.nose -- arm.foot
  base car.steer.center

  /// Drives with the arm leant back and its foot off the ground, where its wheels, at right angles to those of the car, would
  /// drag.
  ///
  /// Keeps a reserve of 0.45 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Sc(carry(), car.drive(v, t))

  /// Leans the arm back over the car, then lifts its foot.
  ///
  /// Keeps a reserve of 0.45 on level ground with friction 1.
  behavior carry = Sc(move(arm.upper.tilt, to: 40deg, in: 1s), move(car.steer.front.tilt, to: 4deg, in: 1s))

  /// Reaches out in the direction `to` of the waist.
  ///
  /// Keeps a reserve of 0.15 on level ground with friction 1.
  behavior reach_out(to: Angle = 0deg) = Sc(
    arm.posture(waist_to: to, shoulder: 0deg, elbow: 0deg, wrist: 0deg),
    arm.posture(to, shoulder: -90deg, elbow: 0deg, wrist: 0deg),
  )
}

/// Two cars side by side, docked at both axles: a robot with a closed loop.
config TwoCars closed {
  part a: Car
  part b: Car
  connect a.side[1] -- b.side[0]
  connect a.side[3] -- b.side[2]
  base a.steer.center

  /// Both cars drive as one.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1.
  behavior drive(v: AngularSpeed = 2rad/s, t: Time = 5s) = Pc(a.drive(v, t), b.drive(v, t))

  /// Lets go at the back axle: what is left is a tree.
  ///
  /// Keeps a reserve of 0.95 on level ground with friction 1.
  behavior open = undock(a.side[3])
}
