--- a plan, its parts, its reverse
use std.smores.Smores
config C { part m: Smores
  behavior up = move(m.tilt, to: 30deg, in: 1s)
  behavior down = move(m.tilt, to: 0deg, in: 2s)
}
let c = C()
let p = plan(Sc(c.up(), c.down()))
print(p.duration, p.actions, p.at(1s).angle(c.m.tilt), p.slice(1s..2s).duration)
//> 3s 2 30deg 1s
print((plan(c.up()) ++ c.down()).duration, reverse(plan(c.up())).end.angle(c.m.tilt))
//> 3s 0deg

--- a plan that does not end at rest
use std.smores.Smores
config C { part m: Smores
  behavior b = spin(m.left, 1rad/s)
//             ^^^^^^^^^^^^^^^^^^^^ E0407 still turns at 1 per second | `for: 5s`
}
print(plan(C().b()).duration)
//    ~~~~~~~~~~~~~ planned here

--- output stays where it belongs
use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.tilt, to: 10deg)
}
emit(C().b(), "/tmp/out.json")
//            ^^^^^^^^^^^^^^^ E0701 output stays in the output folder
emit(C().b(), "a/../../out.json")
//            ^^^^^^^^^^^^^^^^^^ E0701

--- behaviours of two robots
use std.smores.Smores
config A { part m: Smores
  behavior b = move(m.tilt, to: 10deg)
}
config B { part m: Smores
  behavior b = move(m.tilt, to: 10deg)
}
print(plan(Pc(A().b(), B().b())).duration)
//         ^^^^^^^^^^^^^^^^^^^^ E0406 two robots: A and B

--- states are in the world
use std.smores.Smores
config D {
  part m: Smores
  behavior go = Pc(spin(m.left, 2rad/s, for: 2s), spin(m.right, 2rad/s, for: 2s))
}
let p = plan(D().go(), world: world(dynamics: statics))
let way = p.end.base.position - p.start.base.position
// Two wheels of 45.3 mm turn at 2 rad/s for 2 s, less two ramps of 2 rad/s at 12 rad/s^2.
expect abs(norm(way) - 2 * (2 - 1 / 6) * 45.3mm) < 0.01mm
expect norm(way - verify(p).displacement) < 0.001mm

--- what goes on after a robot has tipped begins as it lies
use std.smores.Grasper7
let x = Grasper7()
let lies = plan(x.squeeze())
let on = plan(x.open(), from: lies.end)
fn apart(a: State, b: State) -> Length = norm(a.pose(x.m.top).position - b.pose(x.m.top).position)
// It has rolled over by a quarter of a turn, and opening its arms moves nothing but them.
expect abs(lies.end.pose(x.m.top).position.z - lies.start.pose(x.m.top).position.z) > 30mm
expect apart(on.start, lies.end) < 0.1mm
expect verify(on).travel < 1mm
expect apart((lies ++ on).end, on.end) < 0.1mm
let whole = plan(Sc(x.squeeze(), x.open()))
expect apart(whole.slice(lies.duration..whole.duration).start, lies.end) < 0.1mm
expect apart(reverse(lies).start, lies.end) < 0.1mm
// A fixture holds it as drawn.
expect abs(plan(x.open(), from: lies.end, world: world(ground: held)).start.base.position.z) < 0.1mm

