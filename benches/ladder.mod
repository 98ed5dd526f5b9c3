//! Eighteen docked modules with a loop, which arch and stretch for 33 s: the judge at work on a robot of its size.
use std.smores.Smores
config Ladder closed {
  part a[9]: Smores
  part b[9]: Smores
  for i in 0..8 {
    connect a[i].bottom -- a[i + 1].top
    connect b[i].bottom -- b[i + 1].top
  }
  connect a[0].right -- b[0].left
  connect a[8].right -- b[8].left
  base a[4]
  behavior arch(x: Angle, t: Time) = Pc([
    Pc(move(c[2].tilt, by: x, in: t), move(c[4].tilt, by: -2 * x, in: t), move(c[6].tilt, by: x, in: t)) for c in [a, b]
  ])
  behavior go(n: Int) = repeat(Sc(arch(10deg, 1.5s), arch(-10deg, 1.5s)), n)
}
let l = Ladder()
let r = verify(l.go(11))
print(r.ok, r.samples)
