//! A robot with loops of which one never closes, and one holds: the third is judged, and its blame found, by itself.

use crate::support::desk::run;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// A hub with a slide that docks with the cube ahead, to which the hub is connected twice. The cube ahead and the one beside can't
/// reach each other. As the slide draws back, its head turns by less than the connector tolerates.
const LOOPS: &str = "
connector Face { mates Face, turns 4, capture 4mm 5deg }
module Hub {
  link body = box(100mm, 100mm, 100mm, mass: 5kg)
  link slide = box(10mm, 40mm, 40mm, mass: 400g) at [65mm, 0mm, 30mm]
  link head = box(10mm, 40mm, 40mm, mass: 100g) at [75mm, 0mm, 30mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm) at [65mm, 0mm, 30mm]
  joint twist : slide -> head = revolute(axis: X) at [70mm, 0mm, 30mm]
  port tip: Face on head at [5mm, 0mm, 0mm] facing +X up +Z
  port low: Face on body at [50mm, 0mm, -30mm] facing +X up +Z
  port lower: Face on body at [50mm, 0mm, -40mm] facing +X up +Z
  port side: Face on body at [0mm, 50mm, 0mm] facing +Y up +Z
}
module Ahead {
  link body = box(100mm, 100mm, 100mm, mass: 1kg)
  port low: Face on body at [-90mm, 0mm, -30mm] facing -X up +Z
  port lower: Face on body at [-90mm, 0mm, -40mm] facing -X up +Z
  port face: Face on body at [-50mm, 0mm, 30mm] facing -X up +Z
  port flank: Face on body at [0mm, 50mm, 0mm] facing +Y up +Z
}
module Beside {
  link body = box(100mm, 100mm, 100mm, mass: 1kg)
  port root: Face on body at [0mm, -50mm, 0mm] facing -Y up +Z
  port flank: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
}
config Three closed {
  part h: Hub  part a: Ahead  part b: Beside
  connect h.low -- a.low
  connect h.lower -- a.lower
  connect h.side -- b.root
  base h
  behavior meet = Sc(
    move(h.out, to: 10mm, in: 1s), dock(h.tip, a.face), dock(a.flank, b.flank), wait(100ms),
    Pc(move(h.out, to: 0mm, in: 1s), move(h.twist, to: 2deg, in: 1s)),
  )
}
emit(plan(Three().meet(), world: world(gravity: off, ground: off)), \"p.json\")
";

#[test]
fn a_loop_that_is_driven_apart_is_told_beside_one_that_never_closed() {
    let (observed, ..) = run(&MapFiles::of(LOOPS), Mode::Run);
    let found: Vec<&str> = observed.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let [missed, apart] = found.as_slice() else { panic!("{found:#?}") };
    assert!(missed.contains("a.flank -- b.flank does not dock"), "{missed}");
    assert!(apart.contains("h.tip -- a.face is driven apart"), "{apart}");
    // The slide alone is to blame.
    let labels: Vec<&str> = observed.diagnostics[1].labels.iter().map(|label| label.text.as_str()).collect();
    let blamed: Vec<_> = labels.iter().filter(|text| text.contains("would")).collect();
    assert!(blamed.len() == 1 && blamed[0].contains("[h.out]"), "{labels:?}");
}
