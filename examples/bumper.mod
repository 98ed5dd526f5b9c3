//! A cart that feels its way: it drives until its bumper touches a post, backs off, and turns.

connector Latch { mates Latch, turns 4, capture 5mm 5deg }

/// A cart on two wheels and two skids.
module Cart {
  mass 2kg
  link body = union(
    placed(box(160mm, 90mm, 40mm), at: [0mm, 0mm, 45mm]),
    placed(sphere(15mm), at: [60mm, 0mm, 15mm]),
    placed(sphere(15mm), at: [-60mm, 0mm, 15mm]),
    mass: 1.6kg, com: [0mm, 0mm, 35mm], friction: 0.1,
  )
  link left = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.9) at [0mm, 60mm, 40mm]
  link right = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.9) at [0mm, -60mm, 40mm]
  joint l : body -> left = revolute(
    axis: Y,
    max_speed: 8rad/s,
    max_accel: 20rad/s^2,
    max_torque: 1N*m,
    no_load_speed: 12rad/s
  ) at [0mm, 60mm, 40mm]
  joint r : body -> right = revolute(
    axis: Y,
    max_speed: 8rad/s,
    max_accel: 20rad/s^2,
    max_torque: 1N*m,
    no_load_speed: 12rad/s
  ) at [0mm, -60mm, 40mm]
  port nose : Latch on body at [80mm, 0mm, 45mm] facing +X up +Z
}

/// A plate in front of the cart.
module Bumper {
  mass 100g
  link plate = box(10mm, 120mm, 30mm)
  port back : Latch on plate at [-5mm, 0mm, 0mm] facing -X up +Z
  port front : Latch on plate at [5mm, 0mm, 0mm] facing +X up +Z
}

/// A post that the cart leaves, and comes back to.
module Post {
  mass 5kg
  link foot = box(60mm, 60mm, 90mm, friction: 0.8)
  port side : Latch on foot at [-30mm, 0mm, 0mm] facing -X up +Z
}

config Parked {
  part cart: Cart
  part bumper: Bumper
  part post: Post
  connect cart.nose -- bumper.back
  connect bumper.front -- post.side
  base cart
  behavior drive(v: AngularSpeed, t: Time) = Pc(spin(cart.l, v, for: t), spin(cart.r, v, for: t))
  behavior turn(v: AngularSpeed, t: Time) = Pc(spin(cart.l, -v, for: t), spin(cart.r, v, for: t))
  behavior feel(v: AngularSpeed) = Sc(
    Pc(
      spin(cart.l, v, until: touching(bumper), timeout: 9s),
      spin(cart.r, v, until: touching(bumper), timeout: 9s),
    ),
    Pc(spin(cart.l, 0rad/s), spin(cart.r, 0rad/s)),
  )
}

// The plan knows of no touch: its undisturbed run drives on for 9 s, into the post, and is not verified.
let x = Parked()
let away = Sc(undock(x.bumper.front), x.drive(-4rad/s, 2s))
let p = plan(Sc(away, x.feel(3rad/s), x.drive(-3rad/s, 1s), x.turn(2rad/s, 1s)))
let real = simulate(p)
print(real)

test "it comes back to where it started, and no farther" {
  let there = simulate(Sc(away, x.feel(3rad/s)))
  expect not there.fell and there.failures == []
  // Braking takes 3 rad/s of a wheel of 40 mm in 20 rad/s^2, 9 mm, in which it pushes the post.
  expect abs(there.displacement.x) < 15mm
  expect there.duration < p.duration - 2s
}

test "it turns away at last" {
  expect real.heading > 60deg and real.displacement.x < -50mm
}
