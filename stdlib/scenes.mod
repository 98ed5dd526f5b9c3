//! Scenes: robots that drive to each other and dock, found from what their own behaviours do.
//!
//! `drive_to` knows no robot. It is given two behaviours, one that drives and one that turns on the spot, and measures
//! with `plan` what they do; so it is as exact as the judge's ground is. What the real ground is like, `simulate` with
//! its spreads tells.
use std.smores.{Chain3, MagnetFace, Tank7}

/// Where something stands on the ground and where it looks, seen from above.
record Stance {
  /// The position along x.
  x: Length
  /// The position along y.
  y: Length
  /// The angle to the left from the x axis to where it looks.
  heading: Angle
}

/// What the behaviours of a robot do, as they were measured.
record Gauge {
  /// How fast it drives.
  speed: Speed
  /// How much of the way it loses by speeding up and slowing down.
  lost: Length
  /// In which direction it drives, to the left from where the port looks.
  course: Angle
  /// How far it turns, in parts of the angle that is asked for.
  factor: Number
  /// How much farther it turns at each turn.
  offset: Angle
  /// The point about which it turns, as seen from the port.
  centre: Vec3<Length>
}

// The same direction as an angle from -180 to 180 degrees.
fn _wrapped(a: Angle) -> Angle = a - 360deg * round(a / 360deg)

// The turn on the spot to a direction: half a turn is to the left, however it was rounded.
fn _turn_to(a: Angle) -> Angle = _wrapped(a - 10deg) + 10deg

fn _ahead(a: Angle, way: Length) -> Vec3<Length> = [way * cos(a), way * sin(a), 0m]

fn _point(s: Stance) -> Vec3<Length> = [s.x, s.y, 0m]

fn _turned(v: Vec3<Length>, a: Angle) -> Vec3<Length> =
  [v.x * cos(a) - v.y * sin(a), v.x * sin(a) + v.y * cos(a), 0m]

// What is at `to`, as seen from `from`.
fn _seen(from: Stance, to: Stance) -> Stance = {
  let way = _turned(_point(to) - _point(from), -from.heading)
  Stance(x: way.x, y: way.y, heading: _wrapped(to.heading - from.heading))
}

/// Where a pose stands on the ground and where its x axis looks, as a port looks outwards, in the frame of the pose.
/// One that looks up or down is refused.
///
/// Example:
/// ```modl
/// use std.scenes.stance
/// use std.smores.Tank7
/// print(stance(pose(Tank7().nose)))
/// ```
fn stance(of: Pose) -> Stance = {
  let ahead = direction(of, X)
  require abs(ahead.z) < 0.7, "what looks up or down has no heading on the ground"
  Stance(x: of.position.x, y: of.position.y, heading: atan2(ahead.y, ahead.x))
}

// When a behaviour begins that comes after another, if there is one: not at once without it.
fn _begin(after: Behavior?) -> Time = if after == _ { 1ms } else { plan(after else wait(1ms)).duration }

// The plan of a behaviour that comes after another, if there is one.
fn _planned(b: Behavior, after: Behavior?) -> Plan = plan(Sc(after else wait(1ms), b))

// Where a port is after a behaviour, if there is one, or else at the start. `then` is what comes next.
fn _stands(p: Port, after: Behavior?, then: Behavior) -> Stance =
  stance(_planned(then, after).at(_begin(after)).pose(p))

// Where a port gets by a behaviour after another, as seen from where it was then, `begin`.
fn _moved(b: Behavior, p: Port, after: Behavior?, begin: Stance) -> Stance =
  _seen(begin, stance(_planned(b, after).end.pose(p)))

/// Measures what two behaviours of a robot do to one of its ports: `drive(v, t)`, which drives straight at speed `v` of
/// the wheels for time `t`, in 1 s and in 2 s, and `turn(a)`, which turns on the spot to the left, by 20 and by 60
/// degrees.
///
/// `after` is what comes before; without it, they begin at the start. How far `turn` really turns makes no
/// difference, only that it is in proportion.
///
/// Example:
/// ```modl
/// use std.scenes.{gauge, tank_turn}
/// use std.smores.Tank7
/// let t = Tank7()
/// print(gauge(t.nose, (v, time) => t.drive(v, time), a => tank_turn(t, a)))
/// ```
fn gauge(
  p: Port,
  drive: fn(AngularSpeed, Time) -> Behavior,
  turn: fn(Angle) -> Behavior,
  v: AngularSpeed = 2rad/s,
  after: Behavior?,
) -> Gauge = _gauge(p, drive, turn, v, after, _stands(p, after, drive(v, 1s)))

// What `gauge` returns, of a port that stands at `begin` after `after`.
fn _gauge(
  p: Port,
  drive: fn(AngularSpeed, Time) -> Behavior,
  turn: fn(Angle) -> Behavior,
  v: AngularSpeed,
  after: Behavior?,
  begin: Stance,
) -> Gauge = {
  let short = _moved(drive(v, 1s), p, after, begin)
  let long = _moved(drive(v, 2s), p, after, begin)
  let speed = (norm(_point(long)) - norm(_point(short))) / 1s
  require speed > 1mm/s, "`drive` does not get on: it gains {speed in mm/s:.2}"
  let little = _moved(turn(20deg), p, after, begin)
  let much = _moved(turn(60deg), p, after, begin)
  let factor = _wrapped(much.heading - little.heading) / 40deg
  require factor > 0.01, "`turn` does not turn to the left: {factor:.3} of what is asked"
  // The port goes from 0 to `much`: what stays in place is half of the way aside, and ahead of it by the half angle.
  let way = _point(much)
  let aside: Vec3<Length> = [-way.y, way.x, 0m]
  Gauge(
    speed: speed,
    lost: speed * 1s - norm(_point(short)),
    course: atan2(long.y, long.x),
    factor: factor,
    offset: little.heading - factor * 20deg,
    centre: way / 2 + aside / (2 * tan(much.heading / 2)),
  )
}

// A turn on the spot, to the left, and a straight drive after it; a negative way is driven backwards.
record _Leg {
  turn: Angle
  way: Length
}

// Where the middle of the robot, about which it turns, is when the port is at `goal` after it has driven `closing`
// straight.
fn _middle(goal: Stance, g: Gauge, closing: Length) -> Vec3<Length> =
  _point(goal) + _turned(g.centre, goal.heading) - _ahead(goal.heading, closing)

// The legs that bring the port to `goal` over `corners`, all as seen from where the port is. `side` is 1 to drive ahead
// and -1 to drive backwards up to the last turn.
fn _legs(goal: Stance, g: Gauge, corners: List<Vec3<Length>>, closing: Length, side: Int) -> List<_Leg> = {
  let points = [g.centre] ++ corners ++ [_middle(goal, g, closing)]
  let ways = [points[i + 1] - points[i] for i in 0..len(points) - 1]
  // A way of less than half a millimetre has no direction to turn to: it is left out.
  let headings = scan(
    [w for w in ways if norm(w) >= 0.5mm],
    (before, w) => before + _turn_to(atan2(side * w.y, side * w.x) - g.course - before),
    from: 0deg,
  )
  let lengths = [side * norm(w) for w in ways if norm(w) >= 0.5mm]
  let before = [0deg] ++ headings
  let close = if cos(g.course) < 0 { -closing } else { closing }
  let on = [_Leg(turn: headings[i] - before[i], way: lengths[i]) for i in 0..len(lengths)]
  on ++ [_Leg(turn: _turn_to(goal.heading - before[len(lengths)]), way: close)]
}

fn _whole_turn(legs: List<_Leg>) -> Angle = sum([abs(l.turn) for l in legs])

// What is aimed at, and what came of it, as seen from where the port is.
record _Trial {
  aim: Stance
  reached: Stance
}

// A robot that drives, and how.
record _Driver {
  port: Port
  drive: fn(AngularSpeed, Time) -> Behavior
  turn: fn(Angle) -> Behavior
  v: AngularSpeed
  after: Behavior?
  // Where the port stands after that.
  begin: Stance
  gauge: Gauge
  corners: List<Vec3<Length>>
  closing: Length
  side: Int
}

fn _legs_to(d: _Driver, goal: Stance) -> List<_Leg> = _legs(goal, d.gauge, d.corners, d.closing, d.side)

// The turns on the spot that make one by `a`, to the left. One that is smaller than what was measured, where wheels
// hardly get up to speed, is made of two in opposite directions; one of less than a hundredth of a degree is left out.
fn _turns(d: _Driver, a: Angle) -> List<Behavior> = {
  let g = d.gauge
  let least = g.offset + g.factor * 20deg
  let asked = (abs(a) - g.offset) / g.factor
  if abs(a) < 0.01deg {
    []
  } else if abs(a) < least {
    [d.turn(sign(a) * (asked + least / g.factor)), d.turn(-sign(a) * 20deg)]
  } else {
    [d.turn(sign(a) * asked)]
  }
}

// What a leg commands.
fn _commands(d: _Driver, l: _Leg) -> List<Behavior> = {
  let driving = if l.way == 0mm {
    []
  } else {
    [d.drive(sign(l.way) * d.v, (abs(l.way) + d.gauge.lost) / d.gauge.speed)]
  }
  _turns(d, l.turn) ++ driving
}

fn _way(d: _Driver, goal: Stance) -> Behavior =
  Sc(flatten([_commands(d, l) for l in _legs_to(d, goal)]) ++ [wait(200ms)])

fn _tried(d: _Driver, aim: Stance) -> _Trial = _Trial(aim: aim, reached: _moved(_way(d, aim), d.port, d.after, d.begin))

// How far a stance is from where it should be, in parts of what is allowed: 1 % of the way or 1 mm, 0.2 degrees.
fn _off(reached: Stance, goal: Stance) -> Number = {
  let allowed = max(1mm, norm(_point(goal)) / 100)
  max(norm(_point(reached) - _point(goal)) / allowed, abs(_wrapped(reached.heading - goal.heading)) / 0.2deg)
}

// What to aim at instead when `t` was off.
fn _past(t: _Trial, goal: Stance) -> Stance = Stance(
  x: t.aim.x + goal.x - t.reached.x,
  y: t.aim.y + goal.y - t.reached.y,
  heading: t.aim.heading + _wrapped(goal.heading - t.reached.heading),
)

// The corners of the way of the middle among the obstacles of the port's scene, as seen from the port's stance `begin`.
fn _corners(d: _Driver, begin: Stance, goal: Stance, clearance: Length) -> List<Vec3<Length>> = {
  let centre = _point(begin) + _turned(d.gauge.centre, begin.heading)
  let last = _point(begin) + _turned(_middle(goal, d.gauge, d.closing), begin.heading)
  let way = waypoints(d.port, from: centre, to: last, clearance: clearance)
  [_turned(w - _point(begin), -begin.heading) for w in slice(way, 1..len(way) - 1)]
}

/// The motion that brings a port to a place on the ground: it turns on the spot, drives straight, backwards where that
/// saves turning, turns again, drives the last `closing` straight to where the port looks (or away from there, with a
/// port behind), and waits for 0.2 s.
///
/// `drive` and `turn` are the robot's behaviours, as `gauge` measures them. The motion is planned as a whole; what it
/// is off by is aimed past, up to four times. Where it then still is off by more than 1 % of the way (or 1 mm) or 0.2
/// degrees, the behaviours do not repeat what they do, and it is refused.
///
/// With `avoiding` the middle of the robot, about which it turns, keeps `clearance` from the obstacles of the port's
/// scene: how far the robot reaches from there, and some more. Other robots are no obstacles, since they move; the
/// judge looks at everything. `after` is what comes before; without it, the motion begins at the start.
///
/// Example:
/// ```modl
/// use std.scenes.{Stance, drive_to, stance, tank_turn}
/// use std.smores.Tank7
/// let t = Tank7()
/// let there = Stance(x: 600mm, y: 200mm, heading: 90deg)
/// let way = drive_to(t.nose, there, (v, time) => t.drive(v, time), a => tank_turn(t, a))
/// print(stance(plan(way).end.pose(t.nose)))
/// ```
fn drive_to(
  port: Port,
  goal: Stance,
  drive: fn(AngularSpeed, Time) -> Behavior,
  turn: fn(Angle) -> Behavior,
  v: AngularSpeed = 2rad/s,
  closing: Length = 0mm,
  avoiding: Bool = false,
  clearance: Length = 300mm,
  after: Behavior?,
) -> Behavior = {
  let begin = _stands(port, after, drive(v, 1s))
  let g = _gauge(port, drive, turn, v, after, begin)
  let aside = asin(abs(sin(g.course)))
  require closing == 0mm or aside < 0.5deg,
  "the port looks {aside in deg:.1} aside from where the robot drives: it can't close in"
  let aim = _seen(begin, goal)
  let straight = _Driver(
    port: port,
    drive: drive,
    turn: turn,
    v: v,
    after: after,
    begin: begin,
    gauge: g,
    corners: [],
    closing: closing,
    side: 1,
  )
  let corners = if avoiding { _corners(straight, begin, aim, clearance) } else { [] }
  let ahead = straight with { corners: corners }
  let back = ahead with { side: -1 }
  // Backwards only where that saves turning.
  let saves = _whole_turn(_legs_to(back, aim)) < _whole_turn(_legs_to(ahead, aim)) - 1deg
  let driver = if saves { back } else { ahead }
  // What a motion is off by is aimed past the next time.
  let best = reduce(
    [i for i in 0..4],
    (t, i) => if _off(t.reached, aim) < 0.02 { t } else { _tried(driver, _past(t, aim)) },
    from: _tried(driver, aim),
  )
  let way = norm(_point(best.reached) - _point(aim))
  let angle = abs(_wrapped(best.reached.heading - aim.heading))
  require _off(best.reached, aim) <= 1,
  "the robot stops {way in mm:.1} and {angle in deg:.2} off: its behaviours do not repeat"
  _way(driver, best.aim)
}

/// The motion that docks a port to another robot's: `drive_to` where that robot stands, the last `closing` straight,
/// then `dock`, and a wait of 0.1 s. The parameters are those of `drive_to`.
///
/// Example:
/// ```modl
/// use std.scenes.{drive_and_dock, tank_turn}
/// use std.smores.Tank7
/// scene Two { part a: Tank7  part b: Tank7 at [700mm, 0m, 0m] turned(Z, 180deg) }
/// let two = Two()
/// let meet = drive_and_dock(two.a.nose, two.b.nose, (v, t) => two.a.drive(v, t), x => tank_turn(two.a, x))
/// print(plan(meet).duration)
/// ```
fn drive_and_dock(
  port: Port,
  to: Port,
  drive: fn(AngularSpeed, Time) -> Behavior,
  turn: fn(Angle) -> Behavior,
  v: AngularSpeed = 2rad/s,
  closing: Length = 100mm,
  avoiding: Bool = false,
  clearance: Length = 300mm,
  after: Behavior?,
) -> Behavior = {
  let there = _stands(to, after, drive(v, 1s))
  let goal = there with { heading: there.heading + 180deg }
  Sc(
    drive_to(
      port,
      goal,
      drive,
      turn,
      v: v,
      closing: closing,
      avoiding: avoiding,
      clearance: clearance,
      after: after,
    ),
    dock(port, to),
    wait(100ms),
  )
}

/// A turn of a tank on the spot, to the left, as `drive_to` wants it: its discs turn by angle `a` at 1 rad/s.
///
/// Example:
/// ```modl
/// use std.scenes.tank_turn
/// use std.smores.Tank7
/// print(verify(tank_turn(Tank7(), a: 90deg)).heading)
/// ```
fn tank_turn(t: Tank7, a: Angle) -> Behavior = t.turn(sign(a) * 1rad/s, t: abs(a) / 1rad/s)

/// A chain of modules that lies flat drives on all its wheels.
///
/// Example:
/// ```modl
/// use std.scenes.chain_drive
/// use std.smores.Chain3
/// print(verify(chain_drive(Chain3(), 2rad/s, 1s)).displacement)
/// ```
fn chain_drive(c: Chain3, v: AngularSpeed, t: Time) -> Behavior =
  Pc([Pc(spin(m.left, v, for: t), spin(m.right, v, for: t)) for m in c.m])

/// A chain of modules that lies flat turns on the spot, to the left: its wheels turn by angle `a` at 1 rad/s, and those
/// of the ends slip.
///
/// Example:
/// ```modl
/// use std.scenes.chain_turn
/// use std.smores.Chain3
/// print(verify(chain_turn(Chain3(), a: 90deg)).heading)
/// ```
fn chain_turn(c: Chain3, a: Angle) -> Behavior = {
  let v = sign(a) * 1rad/s
  let t = abs(a) / 1rad/s
  Pc([Pc(spin(m.left, -v, for: t), spin(m.right, v, for: t)) for m in c.m])
}

/// Two tanks: the one drives to the other and docks, they drive as one robot, and part.
scene Rendezvous(gap: Length = 1m, aside: Length = 200mm, turned: Angle = 150deg) {
  part a: Tank7
  part b: Tank7 at [gap, aside, 0m] turned(Z, turned)

  /// Drives the first tank's nose to the second's, and docks.
  ///
  /// Simulated 100 times with frictions and masses spread by a tenth, it docks each time, and so do tanks that begin
  /// head on, 600 mm apart: `simulate(Rendezvous().meet(), runs: 100, friction_spread: 0.1, mass_spread: 0.1).misses`
  /// is 0. The ports of the undisturbed run are 0.8 mm and 0.2 degrees off, where they catch at 4 mm and 5 degrees.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1.
  behavior meet = drive_and_dock(a.nose, b.nose, (v, t) => a.drive(v, t), x => tank_turn(a, x))

  /// Both drive as one: the second backwards.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1, after `meet()`.
  behavior together(v: AngularSpeed = 2rad/s, t: Time = 2s) = Pc(a.drive(v, t), b.drive(-v, t))

  /// They let go of each other, and the first drives back.
  ///
  /// Keeps a reserve of 0.50 on level ground with friction 1, after `meet()`.
  behavior leave(t: Time = 1s) = Sc(wait(200ms), undock(a.nose), a.drive(-2rad/s, t))
}

/// Three chains of three modules, which build one chain of nine.
scene ThreeInOne {
  part a: Chain3
  part b: Chain3 at [-600mm, 300mm, 0m] turned(Z, -30deg)
  part c: Chain3 at [-900mm, -200mm, 0m] turned(Z, 60deg)

  /// The second chain docks behind the first.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1.
  behavior second = drive_and_dock(b.head, a.tail, (v, t) => chain_drive(b, v, t), x => chain_turn(b, x))

  /// The second chain docks behind the first, and the third behind the second.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1.
  behavior build = {
    let first = second()
    Sc(
      first,
      drive_and_dock(
        c.head,
        b.tail,
        (v, t) => chain_drive(c, v, t),
        x => chain_turn(c, x),
        after: first,
      ),
    )
  }

  /// All nine modules drive as one.
  ///
  /// Keeps a reserve of 0.80 on level ground with friction 1, after `build()`.
  behavior drive(v: AngularSpeed = 1rad/s, t: Time = 2s) = Pc([chain_drive(x, v, t) for x in [a, b, c]])
}

/// A crate to be carried: it has no joints, and a port at the height of a tank's nose.
module Crate {
  mass 300g
  link body = box(100mm, 100mm, 120mm, friction: 0.5)
  port front : MagnetFace on body at [-50mm, 0mm, 4.4mm] facing -X up +Z
}

/// A tank that takes up a crate, carries it off and puts it down.
scene Carrier(gap: Length = 800mm, aside: Length = 300mm, turned: Angle = 40deg) {
  part tank: Tank7
  part crate: Crate at [gap, aside, 0m] turned(Z, turned)

  /// Drives to the crate, docks, and lifts it by a tilt of the front module.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1.
  behavior take(lift: Angle = 15deg) = Sc(
    drive_and_dock(tank.nose, crate.front, (v, t) => tank.drive(v, t), x => tank_turn(tank, x)),
    move(tank.steer.front.tilt, to: lift, in: 1s),
  )

  /// Drives backwards with the crate in front.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1, after `take()`.
  behavior carry(t: Time = 2s) = tank.drive(-2rad/s, t)

  /// Puts the crate down, lets go of it and leaves.
  ///
  /// Keeps a reserve of 0.60 on level ground with friction 1, after `take()`.
  behavior put = Sc(
    move(tank.steer.front.tilt, to: 0deg, in: 1s),
    wait(200ms),
    undock(tank.nose),
    tank.drive(-2rad/s, 1s),
  )
}
