//! Tables of designs: a gait that is searched for, and what the papers tabulate, as studies.
//! `modl study examples/studies.mod gait -o sweep` computes one on all processors; docs/studies.md tells more.
use std.mori.Mori
use std.rofi.tangle
use std.smores.{Chain3, Walk4}

/// A snake whose joints follow a wave that runs along it.
config Snake(n: Int = 2) {
  part seg[n]: Chain3
  for i in 0..n - 1 { connect seg[i].head -- seg[i + 1].tail }

  behavior wave(amplitude: Angle = 15deg, period: Time = 2s, lag: Angle = 0deg, cycles: Int = 4) =
    Pc([
      follow(seg[div(i, 3)].m[i % 3].tilt, t => swing(t, amplitude, period, lag * i, cycles), for: cycles * period)
      for i in 0..3 * n
    ])
}

/// A sine that swells over its first period and dies away over its last.
fn swing(t: Time, amplitude: Angle, period: Time, lag: Angle, cycles: Int) -> Angle = {
  let e = max(0, min(1, t / period, cycles - t / period))
  amplitude * e^3 * (10 - 15 * e + 6 * e^2) * sin(t / period * 1turn - lag)
}

record Gait { speed: Speed, torque: Number }

/// The fastest wave that the judge accepts under full dynamics, in 70 evaluations.
study gait(amplitude in 4deg..20deg, period in 0.8s..4s, lag in -180deg..180deg)
  by cmaes(maximise: speed, budget: 70) = {
    let r = verify(Snake(2).wave(amplitude, period, lag), unstable_for: 10s)
    require r.ok
    Gait(speed: abs(r.displacement.x) / r.duration, torque: r.torque_margin)
  }

record Folding { energy: Energy, steps: Int, proved: Bool }

/// Origami folding: the layout of least energy, over the face that stays on the ground.
study foldings(root in 0..8) by grid() = {
  let f = fold(load_mesh("gem.obj", scale: 80mm), module: Mori, root: root)
  Folding(energy: f.energy, steps: len(f.order), proved: f.optimal)
}

record Unwound { docks: Int, undocks: Int, joint_travel: Angle, work: Int }

/// Tentacles: random shapes of RoFI modules to the snake, over their size.
study unwinding(modules in [5, 10, 15, 20]) by grid() each shape in 0..5 = {
  let s = tosnake(tangle(modules, 10 * modules, seed: shape), seed: 1)
  Unwound(docks: s.docks, undocks: s.undocks, joint_travel: s.joint_travel, work: s.work)
}

record Walked { fell: Bool, travel: Length }
let walker = Walk4()
let walk = plan(Sc(walker.stand(), walker.walk(steps: 1)))

/// The verified walk on rigid bodies, where friction and motors are not as stated.
study robust(friction in 0.3..1.1) by grid(friction: 5) each seed in 0..4 = {
  let s = simulate(walk, friction: friction, runs: 1, seed: seed, mass_spread: 0.1, torque_spread: 0.1)
  Walked(fell: s.falls > 0, travel: min(s.travels))
}

let energies = rows(foldings)
print(energies)

test "each face may stay on the ground" {
  expect len(energies) == 8 and all([row.proved for row in energies])
  expect max([row.energy for row in energies]) - min([row.energy for row in energies]) < 1e-9J
}
