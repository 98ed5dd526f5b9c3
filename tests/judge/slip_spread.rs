//! The spread of a docking if wheels slip: beside drives whose wheels run faster and slower by that part.

use crate::support::desk::{run_clean, stated};

/// A car on two wheels, 160 mm apart, and a skid with little friction, with a port ahead; and a block with a port.
const CAR: &str = "
connector Face { mates Face, turns 1, capture 100mm 90deg }
module Car {
  link body = box(80mm, 100mm, 40mm, mass: 1kg) at [0mm, 0mm, 0mm]
  link skid = sphere(10mm, mass: 10g, friction: 0.01) at [-30mm, 0mm, -20mm]
  joint under : body -> skid = fixed() at [-30mm, 0mm, -20mm]
  link l = cylinder(30mm, 10mm, mass: 50g, friction: 0.9) at [30mm, 80mm, 0mm] turned(X, 90deg)
  link r = cylinder(30mm, 10mm, mass: 50g, friction: 0.9) at [30mm, -80mm, 0mm] turned(X, 90deg)
  joint left : body -> l = revolute(axis: Y, max_speed: 360deg/s, max_accel: 1500deg/s^2, max_torque: 2N*m) at [30mm, 80mm, 0mm]
  joint right : body -> r = revolute(axis: Y, max_speed: 360deg/s, max_accel: 1500deg/s^2, max_torque: 2N*m) at [30mm, -80mm, 0mm]
  port nose : Face on body at [60mm, 0mm, 0mm] facing +X up +Z
}
module Block {
  link body = box(60mm, 60mm, 60mm, mass: 1kg)
  port face : Face on body at [-30mm, 0mm, 0mm] facing -X up +Z
}
config C { part m: Car }
config B { part m: Block }
";

/// The way of a drive: the turns of the left and the right wheel in 2 s, deg, ten times one after the other; and the place of
/// the block, so that its face is where the nose comes to.
struct Drive {
    left: f64,
    right: f64,
}

/// Returns what a scene prints in which the car drives with its wheels' turns scaled by these factors, and docks if it
/// `docks`.
fn drive(drive: &Drive, turned: f64, [l, r]: [f64; 2], block: Option<&str>) -> Vec<String> {
    let (place, dock) = match block {
        Some(place) => (format!("part b: B at {place}"), "dock(a.m.nose, b.m.face),"),
        None => ("part b: B at [3m, 3m, 0m]".to_owned(), ""),
    };
    run_clean(&format!(
        "{CAR}
scene S {{
  part a: C at [0mm, 0mm, 0mm] turned(Z, {turned}deg)
  {place}
  behavior go = Sc(
    Sc([Pc(move(a.m.left, by: {}deg, in: 2s), move(a.m.right, by: {}deg, in: 2s)) for k in 0..3]),
    wait(200ms), {dock} wait(100ms),
  )
}}
let c = S()
let p = plan(c.go())
let r = verify(p, slip: 0.04)
let at = p.end.pose(c.a.m.nose)
print(position(at).x / 1mm, position(at).y / 1mm, atan2(direction(at, X).y, direction(at, X).x) / 1deg)
print(join(r.notes, with: \"\\n\"))
",
        drive.left * l,
        drive.right * r
    ))
    .printed
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

#[test]
fn no_slip_of_wheels_leads_farther_astray_than_is_stated() {
    let straight = || Drive { left: 300.0, right: 300.0 };
    // The heading in the world makes no difference.
    for (way, turned) in [(straight(), 0.0), (straight(), 130.0), (Drive { left: 300.0, right: 200.0 }, 0.0)]
    {
        let drive = |way: &Drive, scale, block| drive(way, turned, scale, block);
        let end = numbers(&drive(&way, [1.0, 1.0], None)[0]);
        let [x, y, heading]: [f64; 3] = end.clone().try_into().expect("three numbers");
        let (s, c) = libm::sincos(heading.to_radians());
        let place = format!("[{}mm, {}mm, 0mm] turned(Z, {heading}deg)", x + 30.0 * c, y + 30.0 * s);
        let notes = drive(&way, [1.0, 1.0], Some(&place));
        let note =
            notes.iter().find(|note| note.contains("if wheels slip by 4 %")).expect("the spread is stated");
        let from = "of their speed, up to";
        let (distance, angle) = (stated(note, from, "mm"), stated(note, from, "deg"));
        // Of a track of 160 mm: the ways of both wheels add up in the heading.
        let astray = 0.04 * 3.0 * 30.0 * (way.left + way.right) / 160.0;
        assert!((angle / astray - 1.0).abs() < 0.05, "{angle} deg of {astray}");
        let corners = [[1.04, 0.96], [0.96, 1.04], [1.04, 1.04], [0.96, 0.96]];
        let mut farthest: (f64, f64) = (0.0, 0.0);
        for corner in corners {
            let off = numbers(&drive(&way, corner, None)[0]);
            let away = libm::hypot(off[0] - x, off[1] - y);
            farthest = (farthest.0.max(away), farthest.1.max((off[2] - heading).abs()));
        }
        // Nothing leads farther, and something nearly as far.
        assert!(farthest.0 <= distance && farthest.0 > 0.6 * distance, "{farthest:?} of {distance}");
        assert!(farthest.1 <= angle * 1.02 && farthest.1 > 0.9 * angle, "{farthest:?} of {angle}");
    }
}
