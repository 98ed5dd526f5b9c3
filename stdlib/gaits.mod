//! Gaits: ways to move that work on any robot, as functions of joints and behaviours.

// Rises from 0 to 1 in the first half period, stays, and falls back in the last half period.
fn _envelope(t: Time, period: Time, cycles: Int) -> Number = {
  let ends = min(t, cycles * period - t)
  if ends < period / 2 { (1 - cos(360deg * (ends / period))) / 2 } else { 1 }
}

/// Moves all joints to the same position at once.
///
/// Example:
/// ```modl
/// use std.gaits
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(gaits.together([x.tilt for x in c.m], to: 10deg)).duration)
/// ```
fn together(joints: List<Joint<Angle>>, to: Angle) -> Behavior = Pc([move(j, to: to) for j in joints])

/// A wave that runs along a list of joints: `waves` of them over the whole list.
///
/// The joints begin and end at zero. A positive `waves` runs from the last joint to the first.
///
/// Example:
/// ```modl
/// use std.gaits
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(gaits.wave([x.tilt for x in c.m], amplitude: 20deg)).duration)
/// ```
fn wave(
  joints: List<Joint<Angle>>,
  amplitude: Angle = 30deg,
  period: Time = 4s,
  waves: Number = 1,
  cycles: Int = 2,
) -> Behavior = Pc([
  follow(
    joints[i],
    t => amplitude * _envelope(t, period, cycles) * sin(360deg * (t / period + waves * i / len(joints))),
    for: cycles * period,
  )
  for i in 0..len(joints)
])

/// The caterpillar's gait: a short wave that lifts a chain and carries it along.
///
/// Example:
/// ```modl
/// use std.gaits
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(gaits.caterpillar([x.tilt for x in c.m], amplitude: 15deg)).duration)
/// ```
fn caterpillar(joints: List<Joint<Angle>>, amplitude: Angle = 30deg, period: Time = 4s, cycles: Int = 2) -> Behavior =
  wave(joints, amplitude, period, waves: len(joints) / 3, cycles: cycles)

/// Rolls on wheels: all joints at one speed, for some time.
///
/// Example:
/// ```modl
/// use std.gaits
/// use std.smores.Car
/// let c = Car()
/// print(plan(gaits.rolling([c.wheel[0].m.right, c.steer.front.left], speed: 1rad/s, time: 2s)).duration)
/// ```
fn rolling(wheels: List<Joint<Angle>>, speed: AngularSpeed = 2rad/s, time: Time = 5s) -> Behavior =
  Pc([spin(w, speed, for: time) for w in wheels])

/// Two behaviours in turns, several times: the left step and the right step of a walk.
///
/// Example:
/// ```modl
/// use std.gaits
/// use std.smores.Walk4
/// let w = Walk4()
/// print(plan(gaits.alternating(w.stride(0, 3), w.stride(1, 2), times: 2)).duration)
/// ```
fn alternating(a: Behavior, b: Behavior, times: Int = 1) -> Behavior = repeat(Sc(a, b), times)
