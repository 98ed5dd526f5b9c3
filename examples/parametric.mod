//! Parameters, loops and requirements: one declaration, a family of robots.
use std.smores.Smores

/// A comb: a spine of `n` modules with a tooth on both sides of every `every`-th one.
config Comb(n: Int = 5, every: Int = 2) {
  require n >= 2, "a spine has two modules at least"
  require every >= 2, "teeth on neighbours would meet"
  let teeth = div(n - 1, every) + 1
  part spine[n]: Smores
  part tooth[k in 0..2 * teeth]: Smores
  for i in 0..n - 1 { connect spine[i].bottom -- spine[i + 1].top }
  for i in 0..teeth {
    connect spine[every * i].left -- tooth[2 * i].bottom
    connect spine[every * i].right -- tooth[2 * i + 1].bottom
  }

  behavior wave(a: Angle = 20deg) = Sc(
    Pc([move(t.pan, to: a) for t in tooth]),
    Pc([move(t.pan, to: 0deg) for t in tooth]),
  )
}

for n in [3, 5, 9] {
  let c = Comb(n: n)
  print("{n} in the spine: {count(c)} modules, {mass(c)}, {len(ports(c))} free ports")
}

test "every second module has two teeth" {
  expect count(Comb(n: 5)) == 5 + 2 * 3
  expect count(Comb(n: 9, every: 4)) == 9 + 2 * 3
}

test "it waves where it lies" {
  let r = verify(Comb().wave())
  expect r.ok
  expect r.travel < 1mm
}
