--- a contract that holds is counted at each use, and a plan without contracts says nothing of them
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(a: Angle = 30deg) = {
    require abs(start.angle(c.m[1].tilt)) < 1deg, "it lies flat before"
    ensure abs(end.angle(c.m[1].tilt) - a) < 1e-9deg
    move(c.m[1].tilt, to: a)
  }
  behavior down = move(c.m[1].tilt, to: 0deg)
  behavior both = Sc(lift(), down())
}
let w = Worm()
let still = world(ground: held, gravity: off)
fn verdict(b: Behavior) -> Report = verify(b, world: still)
fn said(r: Report) -> List<Text> = [c for c in r.checks if split(c, on: ":")[0] == "contract"]
print(said(verdict(w.lift())), verdict(w.lift()).ok)
//> [contract: sampled(2)] true
print(said(verdict(repeat(w.both(), 3))), said(verdict(Sc(w.both(), w.lift(a: 20deg)))))
//> [contract: sampled(6)] [contract: sampled(4)]
print(said(verdict(w.down())))
//> []

--- a requirement that does not hold blames the use, in series, nested and in repetitions
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(a: Angle = 30deg) = {
    require abs(start.angle(c.m[1].tilt)) < 1deg, "it lies flat before"
//  ~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~ required here
    move(c.m[1].tilt, to: a)
  }
  behavior down = move(c.m[1].tilt, to: 0deg)
  behavior twice = Sc(lift(), lift(a: 40deg))
//                            ^^^^^^^^^^^^^^ E0613 it lies flat before: `lift` requires `abs(start.angle(c.m[1].tilt)) < 1deg` where it begins: 30deg < 1deg is false, at t =
//                            ~~~~~~~~~~~~~~ this use of `lift`
}
let w = Worm()
let still = world(ground: held, gravity: off)
emit(plan(w.twice(), world: still), "twice.plan.json")
//   ~~~~~~~~~~~~~~~~~~~~~~~~~~~~~ while this plan is verified
let r = verify(repeat(w.lift(), 3), world: still)
print(len(r.failures), r.ok, [c for c in r.checks if split(c, on: ":")[0] == "contract"])
//> 2 false [contract: failed]
print(verify(Sc(w.lift(), w.down(), w.lift()), world: still).ok)
//> true

--- what is not brought about blames the behaviour
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior bend(a: Angle = 30deg) = {
    ensure end.angle(c.m[1].tilt) > 20deg, "bent by {end.angle(c.m[1].tilt)} only"
//  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0614 bent by 10deg only: `bend` does not ensure `end.angle(c.m[1].tilt) > 20deg`: 10deg > 20deg is false, at t =
    move(c.m[1].tilt, to: a)
  }
}
let w = Worm()
let still = world(ground: held, gravity: off)
print(verify(w.bend(), world: still).ok)
//> true
let p = plan(w.bend(a: 10deg), world: still)
//           ~~~~~~~~~~~~~~~~ this use of `bend`
emit(p, "bend.plan.json")
//   ~ while this plan is verified

--- both are about the interval of the behaviour alone: in parallel, and after others
use std.smores.Driver1
config Two {
  part d: Driver1
  behavior forth(t: Time) = {
    ensure abs(report.duration - t) < 1ms
    ensure abs(norm(end.base.position - start.base.position) - report.travel) < 1mm
    ensure report.ok
    ensure end.time - start.time > 0.9 * t
    d.drive(t: t)
  }
}
let two = Two()
let p = plan(Sc(two.forth(1s), two.forth(2s)))
let r = verify(p)
print(r.ok, r.failures)
//> true []

--- what moves on at both ends of an interval fails in no report of it
use std.smores.Tank7
config Tank {
  part t: Tank7
  behavior pause(d: Time) = {
    ensure report.ok and report.torque_margin > 0.5, "{report.failures}"
    ensure report.travel > 50mm
    wait(d)
  }
}
let tank = Tank()
let r = verify(Pc(tank.t.drive(t: 3s), Sc(wait(1s), tank.pause(1s))))
print(r.ok, r.failures)
//> true []

--- the report of an interval is that of the plan cut there
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(most: Number) = {
    ensure report.torque_margin > most
    move(c.m[1].tilt, to: 60deg, in: 2s)
  }
  behavior down = move(c.m[1].tilt, to: 0deg, in: 1s)
}
let w = Worm()
let still = world(ground: held, dynamics: statics)
fn whole(most: Number) -> Plan = plan(Sc(wait(500ms), w.lift(most), w.down()), world: still)
let alone = verify(whole(-9).slice(500ms..2.5s)).torque_margin
fn holds(most: Number) -> Bool = verify(whole(most)).ok
print(holds(alone - 0.001), holds(alone + 0.001))
//> true false

--- what can't be worked out fails
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift = {
    let heights = [1mm, 2mm]
    ensure heights[round(end.angle(c.m[1].tilt) / 10deg)] > 0mm
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0501 index 3 is outside
    move(c.m[1].tilt, to: 30deg, in: 1s)
  }
}
let r = verify(Worm().lift(), world: world(ground: held, gravity: off))
//             ~~~~~~~~~~~~~ called from here: `lift`
print(r.ok, r.failures)
//> false [at 1s: `lift` does not ensure `heights[round(end.angle(c.m[1].tilt) / 10deg)] > 0mm`: this could not be judged]

--- plans that are joined, cut and retimed keep contracts; a reversed one says that it does not
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(a: Angle = 30deg) = {
    require abs(start.angle(c.m[1].tilt)) < 1deg
    move(c.m[1].tilt, to: a, in: 1s)
  }
  behavior down = move(c.m[1].tilt, to: 0deg, in: 1s)
}
let w = Worm()
let still = world(ground: held, gravity: off)
fn said(p: Plan) -> List<Text> = [c for c in verify(p).checks if split(c, on: ":")[0] == "contract"]
let up = plan(w.lift(), world: still)
let both = up ++ plan(w.down(), from: up.end, world: still)
let again = up ++ plan(w.lift(a: 40deg), from: up.end, world: still)
print(said(both), said(both ++ both), said(both.slice(0s..1s)), said(both.slice(500ms..1.5s)))
//> [contract: sampled(1)] [contract: sampled(2)] [contract: sampled(1)] [contract: not checked: the plan was changed, and behaviors with contracts in it with it]
print(said(reverse(up)))
//> [contract: not checked: the plan was changed, and behaviors with contracts in it with it]
print(verify(again).ok, verify(again).failures)
//> false [at 1s: `lift` requires `abs(start.angle(c.m[1].tilt)) < 1deg` where it begins: 30deg < 1deg is false]

--- cycles, mirror images and `avoid` have no contracts
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift = {
    ensure end.angle(c.m[1].tilt) == 0deg
    Sc(move(c.m[1].tilt, to: 30deg), move(c.m[1].tilt, to: 0deg))
  }
}
let w = Worm()
print(plan(phase(w.lift(), 0.5)).duration)
//    ~~~~~~~~~~~~~~~~~~~~~~~~~~ planned here
//         ^^^^^^^^^^^^^^^^^^^^ E0405 a behaviour with a contract cannot be part of a cycle
print(plan(avoid(w.lift())).duration)
//         ^^^^^^^^^^^^^^^ E0405 can't keep its contracts
print(verify(stretch(w.lift(), to: 5s), world: world(ground: held, gravity: off)).ok)
//> true

--- a use in a loop says which
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(a: Angle) = {
    require start.angle(c.m[1].tilt) < 25deg
//  ~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~ required here
    move(c.m[1].tilt, to: a)
  }
  behavior all = Sc([lift(i * 10deg) for i in 1..5])
//                   ^^^^^^^^^^^^^^^ E0613 30deg < 25deg is false | this use of `lift` [i = 4]
}
let p = plan(Worm().all(), world: world(ground: held, gravity: off))
emit(p, "all.plan.json")
//   ~ while this plan is verified

--- a goal in a behaviour, and a contract on where it comes
use std.smores.Arm
config Reacher {
  part arm: Arm(n: 5)
  behavior to(there: Vec3<Length>) = {
    require norm(start.pose(arm.hand).position - there) > 1mm, "it is there already"
    ensure norm(end.pose(arm.hand).position - there) < 1um
    reach(arm.hand, position: there)
  }
}
let r = Reacher()
let still = world(ground: held, gravity: off)
let first: Vec3<Length> = [150mm, 0mm, 300mm]
let second: Vec3<Length> = [-150mm, 50mm, 300mm]
print(verify(plan(Sc(r.to(first), r.to(second)), world: still)).failures)
//> []
print(len(verify(plan(Sc(r.to(first), r.to(first)), world: still)).failures))
//> 1

--- a scene has contracts of its own, and each robot its state in them
use std.smores.Tank7
scene Two {
  part a: Tank7
  part b: Tank7 at [700mm, 0m, 0m]
  behavior forth(t: Time = 1s) = {
    require abs(start.of(b).base.position.x - start.of(a).base.position.x) > 600mm
    ensure start.of(b).base.position.x - end.of(b).base.position.x < 1mm, "the other stands still"
    a.drive(t: t)
  }
}
print(verify(Two().forth()).ok)
//> true
