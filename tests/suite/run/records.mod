--- a record is printed as it is written
record Design { bend: Angle = 30deg, speed: Speed, name: Text = "a leg", turns: Int = 2 }
let d = Design(speed: 2m/s)
print(d)
//> Design(bend: 30deg, speed: 2m/s, name: "a leg", turns: 2)
print([d with { name: "a \"b\"", turns: 3 }], d.name)
//> [Design(bend: 30deg, speed: 2m/s, name: "a \"b\"", turns: 3)] a leg
print("{d with { name: "" }}")
//> Design(bend: 30deg, speed: 2m/s, name: "", turns: 2)
record Empty {}
print(Empty(), Empty)
//> Empty() Empty()

--- the original stays as it was
record Design { bend: Angle, speed: Speed = 1m/s }
let d = Design(bend: 30deg)
let e = d with { bend: 40deg, speed: 2 * d.speed }
print(d.bend, e.bend, e.speed, (e with {}) == e)
//> 30deg 40deg 2m/s true

--- defaults are worked out of the fields before them
record Box { width: Length, height: Length = 2 * width, label: Text = "{width} by {height}" }
print(Box(width: 2m).label, Box(width: 1m, height: 3m).label)
//> 2m by 4m 1m by 3m
print((Box(width: 2m) with { width: 5m }).height)
//> 4m

--- records are compared by what they hold
record Point { x: Length, y: Length = 0m }
record Path { name: Text, points: List<Point>, end: Point? }
let p = Path(name: "p", points: [Point(x: 1m), Point(x: 2m, y: 1m)])
print(p == p, p == p with { end: Point(x: 3m) }, p == Path(name: "p", points: [Point(x: 1m), Point(x: 2m, y: 1m)]))
//> true false true
print(contains(p.points, Point(x: 1m)), p.points[0] != Point(x: 1m, y: 1mm), p.end == _)
//> true true true

--- records in functions, lists and each other
record Leg { bend: Angle, at: Length }
record Body { legs: List<Leg>, gait: fn(Int) -> Angle }
fn lifted(leg: Leg, by: Angle = 10deg) -> Leg = leg with { bend: leg.bend + by }
let body = Body(legs: [Leg(bend: i * 10deg, at: i * 1m) for i in 0..3], gait: i => i * 5deg)
print([lifted(l).bend for l in body.legs], body.gait(3), sum([l.at for l in body.legs]))
//> [10deg, 20deg, 30deg] 15deg 3m
print((body with { legs: [lifted(body.legs[2], by: 1deg)] }).legs[0].bend)
//> 21deg
let best = first([l for l in body.legs if l.bend > 5deg]) else Leg(bend: 0deg, at: 0m)
print(best)
//> Leg(bend: 10deg, at: 1m)

--- robots, plans and behaviours as fields
use std.smores.{Chain3, Driver1}
record Trial { robot: Driver1, time: Time = 1s }
record Result { trial: Trial, plan: Plan, ok: Bool }
fn tried(trial: Trial) -> Result = {
  let p = plan(trial.robot.drive(t: trial.time))
  Result(trial: trial, plan: p, ok: verify(p).ok)
}
let r = tried(Trial(robot: Driver1()))
print(r.ok, r.plan.duration, r.trial, (r.plan ++ reverse(r.plan)).duration)
//> true 1s Trial(robot: Driver1, time: 1s) 2s

--- a configuration takes a record, and one with equal fields makes an equal robot
use std.smores.Chain3
record Pose3 { bend: Angle = 20deg }
config Bent(p: Pose3) {
  part c: Chain3
  set c.m[1].tilt = p.bend
}
print(Bent(Pose3(bend: 5deg)) == Bent(Pose3(bend: 5deg)), Bent(Pose3()) == Bent(Pose3(bend: 5deg)))
//> true false

--- equal robots in two fields are two robots
use std.smores.Driver1
record Team { a: Driver1, b: Driver1 }
let t = Team(a: Driver1(), b: Driver1())
emit(Pc(t.a.drive(t: 1s), t.b.drive(t: 1s)), "both.plan.json")
//   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406 under two names

--- what fails in a field is told once
record A { n: Int, m: Int = [1, 2][n] }
//                          ^^^^^^^^^ E0501 index 5 of 2 elements
let a = A(n: 5)
//      ~~~~~~~ called from here: `A`
print(a.m, a with { n: 1 })
