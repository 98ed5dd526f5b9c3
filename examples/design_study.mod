//! A design study: six walkers as a table, a file and a plot, and the walk of the fastest as a plan.
use std.lists
use std.smores.Walk4

/// A walker with what the verifier says of its walk.
record Design { bend: Angle, swing: Angle, ok: Bool, speed: Speed, torque_margin: Number }

/// Verifies one step of a walker.
fn tried(bend: Angle, swing: Angle) -> Design = {
  let r = verify(Walk4(bend: bend).walk(steps: 1, swing: swing))
  Design(bend: bend, swing: swing, ok: r.ok, speed: r.travel / r.duration, torque_margin: r.torque_margin)
}

let designs = [tried(bend, swing) for bend in [25deg, 30deg, 35deg] for swing in [12deg, 20deg]]
print(designs)
save(designs, "designs.csv")
show(plot([d.speed for d in designs], x: [d.torque_margin for d in designs], kind: scatter), "designs.svg")

let best = lists.argmax([d for d in designs if d.ok], by: d => d.speed)
print("the best bends {best.bend in deg:.0} and swings {best.swing in deg:.0}: {best.speed in mm/s:.1}")
emit(Walk4(bend: best.bend).walk(steps: 1, swing: best.swing), "best.plan.json")
