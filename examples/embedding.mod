//! A robot contains smaller ones, and does what they do: the walker WALKER14 has a grasper in its front half and another in
//! its back half.
use std.smores.{Grasper7, Walker14}

let walker = Walker14()
let halves = embed(Grasper7, in: walker)
print(halves)

/// Closes the arms of a grasper, and opens them again.
fn grasp(g: Grasper7) -> Behavior = Sc(g.squeeze(), wait(1s), g.open())

// Without gravity: the spine would not hold the legs of a half that is turned out of the other's way.
let floating = world(ground: off, gravity: off)

// The legs of a side are too close to swing past each other, unless the spine is twisted by a quarter turn.
let both = plan(
  Sc(
    walker.stand(),
    Pc([half.open() for half in halves]),
    move(walker.spine[1].pan, to: 90deg),
    grasp(halves[0]),
    grasp(halves[1]),
  ),
  world: floating,
)
emit(both, "embedding.plan.json")

/// The distance between the wrists of a grasper at the end of a plan.
fn gap(p: Plan, g: Grasper7) -> Length =
  norm(p.end.pose(g.l[2].bottom).position - p.end.pose(g.r[2].bottom).position)

test "the walker grasps with its front half and with its back half" {
  expect len(halves) == 2
  expect halves[0].m == walker.spine[0]
  expect halves[1].m == walker.spine[1]
  expect verify(both).ok
  let alone = Grasper7()
  let closed = gap(plan(alone.squeeze(), world: floating), alone)
  for half in halves {
    let p = plan(Sc(half.open(), half.squeeze()), world: floating)
    expect abs(gap(p, half) - closed) < 1nm
  }
}

test "one half grasps while a leg of the other is planted" {
  let p = plan(Pc(halves[0].open(), walker.leg[2].plant()), world: floating)
  expect verify(p).ok
}
