//! Walls in the bends of a motion: an interval is judged by the speeds in its middle, and a mover that speeds up, or turns
//! round, is elsewhere at its ends than these tell. Each motion meets a wall in one short stretch alone, and has a twin that
//! passes it.

use crate::support::desk::run_clean;
use crate::support::verdicts::failures_of;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Failure, Plan};

/// Returns the plan of a mover whose head slides along x and z with these control points (m), each list over its own equal part
/// of 2 s, with a wall of 200 mm whose middle is at (x, z). Only a spacer joins them, and all but the wall stays beneath the
/// head. A lug 5 mm above the mover's body keeps the clearance small.
fn plan(x: &[&[f64]], z: &[&[f64]], wall: (f64, f64)) -> Plan {
    let (beside, above) = wall;
    let program = format!(
        "connector Face {{ mates Face, turns 4 }}
         module Mover {{
           link body = box(40mm, 40mm, 40mm, mass: 1kg)
           link lug = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 35mm]
           link carriage = box(2mm, 2mm, 2mm, mass: 100g) at [0mm, 3m, 0mm]
           link head = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 2m, 0mm]
           joint lift : body -> lug = prismatic(axis: Z, range: 0mm..100mm)
           joint along : body -> carriage = prismatic(axis: X, range: -3m..3m)
           joint up : carriage -> head = prismatic(axis: Z, range: -3m..3m)
           port side: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
         }}
         module Spacer {{
           link body = box(40mm, 40mm, 40mm, mass: 1kg)
           port near: Face on body at [20mm, 0mm, 0mm] facing +X up +Z
           port far: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
         }}
         module Wall {{
           link body = box(200mm, 200mm, 200mm, mass: 1kg)
           port side: Face on body at [{}m, -2m, {}m] facing +X up +Z
         }}
         config Both {{
           part a: Mover  part s: Spacer  part b: Wall
           connect a.side -- s.near  connect s.far -- b.side
           base a
         }}
         let c = Both()
         emit(plan(Pc(move(c.a.along, to: 1mm, in: 2s), move(c.a.up, to: 1mm, in: 2s)), world: world(gravity: off, ground: off)), \"p.json\")
",
        -0.06 - beside, -above
    );
    let mut plan = run_clean(&program).plan("p.json");
    let modl::plan::Body::Tracks(tracks) = &mut plan.body else { panic!("a robot") };
    for (track, pieces) in tracks.tracks.iter_mut().zip([x, z]) {
        let known = track.segments[0].clone();
        tracks.start.joints[track.joint.0 as usize] = pieces[0][0];
        let length = 2.0 / pieces.len() as f64;
        track.segments = pieces
            .iter()
            .enumerate()
            .map(|(i, control)| modl::plan::Segment {
                start: length * i as f64,
                end: length * (i + 1) as f64,
                control: control.to_vec(),
                ..known.clone()
            })
            .collect();
    }
    plan
}

/// Returns the collisions of a plan.
fn collisions(plan: &Plan) -> Vec<Failure> {
    failures_of(CheckKind::Collision, &verify(plan))
}

/// The head is at x = 0.4 (t - 1.5)²: by its speed at 1 s it was at 0.5 m at the start, but it was at 0.9 m, in the wall.
#[test]
fn a_head_that_brakes_has_been_farther_than_its_speed_tells() {
    let along: &[f64] = &[0.9, -0.3, 0.1];
    let of = |reach: f64| collisions(&plan(&[along], &[&[0.0, 0.0]], (reach + 0.1, 0.0)));
    // They touch where the middle of the head is 10 mm before the near side of the wall.
    for near in [0.82, 0.85, 0.88] {
        let found = of(near);
        assert_eq!(found.len(), 1, "{near}: {found:?}");
        assert!((found[0].value - (0.9 + 0.01 - near)).abs() < 1e-3, "{near}: {}", found[0].value);
    }
    assert_eq!(of(0.93), []);
}

/// The head runs along a V, from one wall's place down and up again: seen from the second half it would have come from above.
#[test]
fn a_head_that_turns_round_is_on_both_sides_of_the_bend() {
    let along: &[f64] = &[-1.0, 1.0];
    let of = |wall: (f64, f64)| collisions(&plan(&[along], &[&[-1.0, 0.0], &[0.0, -1.0]], wall));
    for t in [0.0, 0.2, 0.4, 1.6, 1.8, 2.0] {
        let on_the_way = (-1.0 + t, -f64::abs(t - 1.0));
        assert_eq!(of(on_the_way).len(), 1, "{t} s");
        // It would be there had it not turned.
        assert_eq!(of((on_the_way.0, -on_the_way.1)), [], "{t} s");
    }
}
