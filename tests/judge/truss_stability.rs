//! Static stability of trusses on flat ground, what feet slide, and rolls, against recounts of the support and of paths.

use super::truss_plans::*;
use modl::plan::{CheckKind, Ground, World};

/// Returns the signed distance of a point inside the hull of others: of all lines through two of them that have none on their
/// right, the nearest piece.
fn inside(points: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let cross =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (mut nearest, mut within) = (f64::INFINITY, true);
    for &a in points {
        for &b in points {
            let long = libm::hypot(b[0] - a[0], b[1] - a[1]);
            if long == 0.0 || points.iter().any(|&c| cross(a, b, c) < -1e-12) {
                continue;
            }
            within &= cross(a, b, at) >= 0.0;
            let along = ((at[0] - a[0]) * (b[0] - a[0]) + (at[1] - a[1]) * (b[1] - a[1])) / long;
            let along = along.clamp(0.0, long) / long;
            let near = [0, 1].map(|k| a[k] + (b[k] - a[k]) * along);
            nearest = nearest.min(libm::hypot(near[0] - at[0], near[1] - at[1]));
        }
    }
    if within { nearest } else { -nearest }
}

/// Returns the nodes and struts of feet on the ground, each with a strut to the top, the last node.
fn star(feet: &[[f64; 2]], top: Place) -> (Vec<Place>, Vec<(usize, usize)>) {
    let mut nodes: Vec<Place> = feet.iter().map(|p| [p[0], p[1], 0.0]).collect();
    nodes.push(top);
    (nodes, (0..feet.len()).map(|foot| (foot, feet.len())).collect())
}

/// Returns the centre of mass of a star: half of each strut is at its foot, the other half at the top.
fn centre(feet: &[[f64; 2]], top: Place) -> [f64; 2] {
    [0, 1].map(|k| (feet.iter().map(|p| p[k]).sum::<f64>() / feet.len() as f64 + top[k]) / 2.0)
}

#[test]
fn the_margin_is_the_distance_inside_the_hull_of_the_feet() {
    let mut number = dice(23);
    let (mut stands, mut falls) = (0, 0);
    for round in 0..200 {
        let count = 3 + round % 6;
        let mut feet: Vec<[f64; 2]> = (0..count).map(|_| [number(-1.0, 1.0), number(-1.0, 1.0)]).collect();
        match round % 4 {
            // One within an edge, and one where another is.
            0 => feet.extend([[0, 1].map(|k| (feet[0][k] + feet[1][k]) / 2.0), feet[2]]),
            // Corners of a grid.
            1 => feet.iter_mut().flatten().for_each(|x| *x = libm::round(*x * 2.0) / 2.0),
            _ => {}
        }
        let shift = [number(-5.0, 5.0), number(-5.0, 5.0)];
        feet.iter_mut().for_each(|p| *p = [p[0] + shift[0], p[1] + shift[1]]);
        let top = [shift[0] + number(-1.5, 1.5), shift[1] + number(-1.5, 1.5), 1.0];
        let expected = inside(&feet, centre(&feet, top));
        let (nodes, struts) = star(&feet, top);
        let verdict = judged(&plan(STANDING, &struts, vec![straight(0.0, &nodes)]));
        let margin = verdict.margin.as_ref().expect("told").value;
        if margin == f64::NEG_INFINITY {
            // On a grid they may lie in a row.
            assert!(round % 4 == 1, "round {round}");
            continue;
        }
        assert!((margin - expected).abs() < 1e-9, "round {round}: {margin} {expected} {feet:?}");
        // Legs that nothing ties together slide where they are flat, which is another question.
        let mut lost = of(CheckKind::Stability, &verdict);
        lost.retain(|failure| !failure.message.starts_with("no forces"));
        if expected > 0.0 {
            assert_eq!(lost, vec![], "round {round}");
            stands += 1;
        } else if expected < -1e-4 {
            let [failure] = &lost[..] else { panic!("round {round}: one failure: {lost:?}") };
            assert_eq!((failure.value, failure.time), (margin, 0.0));
            assert!(failure.message.contains("outside of the support"), "{failure:?}");
            falls += 1;
        }
    }
    assert!(stands > 40 && falls > 40, "{stands} stand, {falls} fall");
}

#[test]
fn feet_in_a_row_hold_nothing() {
    for feet in [vec![[0.0, 0.0], [1.0, 0.0]], vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.5, 0.5]]] {
        let top = [feet[1][0] / 2.0, feet[1][1] / 2.0, 1.0];
        let (nodes, struts) = star(&feet, top);
        let verdict = judged(&plan(STANDING, &struts, vec![straight(0.0, &nodes)]));
        let [failure] = &of(CheckKind::Stability, &verdict)[..] else { panic!("one failure") };
        assert!(failure.message.contains("does not stand on three nodes"), "{failure:?}");
        assert_eq!(failure.value, -f64::MAX);
    }
}

/// The centre of mass goes out of the support by some micrometres at the end of a step, and in a truss at rest.
#[test]
fn ten_micrometres_outside_of_the_support_are_none() {
    for away in [5e-6, 8e-6, 12e-6, 20e-6] {
        // The mean of the four nodes is over the edge at y = 0 with the top at minus the height of the triangle.
        let out = tetra([0.5, -HIGH - 4.0 * away, 0.5]);
        let begins = tetra([0.5, -HIGH + 0.1, 0.5]);
        for keyframes in [vec![straight(0.0, &out)], vec![straight(0.0, &begins), straight(1.0, &out)]] {
            let verdict = judged(&plan(STANDING, &TETRA, keyframes));
            let mut lost = of(CheckKind::Stability, &verdict);
            // So near to the rim no forces may be found.
            lost.retain(|failure| failure.message.contains("support"));
            assert_eq!(lost.is_empty(), away < 1e-5, "{away}: {lost:?}");
        }
    }
}

#[test]
fn a_step_falls_when_many_moments_say_so() {
    let mut number = dice(29);
    let (mut stands, mut falls) = (0, 0);
    for round in 0..60 {
        let mut places = |count: usize| -> Vec<[f64; 2]> {
            (0..count).map(|_| [number(-1.0, 1.0), number(-1.0, 1.0)]).collect()
        };
        let (from, to) = (places(5), places(5));
        let (from, to): (Vec<[f64; 2]>, Vec<[f64; 2]>) = if round % 2 == 0 {
            (from, to)
        } else {
            let to = from.iter().zip(&to).map(|(p, q)| [0, 1].map(|k| p[k] + q[k] / 4.0)).collect();
            (from, to)
        };
        let tops = places(2);
        let least = (0..=2000).map(|k| {
            let part = f64::from(k) / 2000.0;
            let mix = |p: &[f64; 2], q: &[f64; 2]| [0, 1].map(|k| p[k] * (1.0 - part) + q[k] * part);
            let feet: Vec<[f64; 2]> = from.iter().zip(&to).map(|(p, q)| mix(p, q)).collect();
            let top = mix(&tops[0], &tops[1]);
            inside(&feet, centre(&feet, [top[0], top[1], 1.0]))
        });
        let least = least.fold(f64::INFINITY, f64::min);
        let keyframe = |feet: &[[f64; 2]], top: [f64; 2]| star(feet, [top[0], top[1], 1.0]);
        let ((begins, struts), (ends, _)) = (keyframe(&from, tops[0]), keyframe(&to, tops[1]));
        let verdict = judged(&plan(STANDING, &struts, vec![straight(0.0, &begins), straight(1.0, &ends)]));
        let lost: Vec<_> = of(CheckKind::Stability, &verdict);
        let toppled = lost.iter().any(|failure| failure.message.contains("support"));
        if least > 1e-3 {
            assert!(!toppled, "round {round}: {least} {lost:?}");
            stands += 1;
        } else if least < -1e-3 {
            assert!(toppled, "round {round}: {least}");
            falls += 1;
        }
        // Each foot slides its way, which is the same whether or not it falls.
        let ways: Vec<f64> =
            from.iter().zip(&to).map(|(p, q)| libm::hypot(q[0] - p[0], q[1] - p[1])).collect();
        let most = (0..5).max_by(|&a, &b| ways[a].total_cmp(&ways[b])).expect("five");
        let slip = verdict.slip.as_ref().expect("told");
        assert!((slip.value - ways[most]).abs() < 1e-12 && slip.at == [format!("n{most}")], "{slip:?}");
        let whole: f64 = ways.iter().sum();
        let slides = |limit: f64| {
            let keyframes = vec![straight(0.0, &begins), straight(1.0, &ends)];
            let plan = plan(STANDING, &struts, keyframes);
            let verdict = judged(&with(plan, |paths| paths.limits.slip = limit));
            of(CheckKind::Slip, &verdict).len()
        };
        assert_eq!((slides(whole - 0.5e-6), slides(whole - 1.5e-6), slides(whole + 1.0)), (0, 1, 0));
    }
    assert!(stands > 5 && falls > 5, "{stands} stand, {falls} fall");
}

/// Nothing slides: the first node is named. Less than a nanometre is nothing.
#[test]
fn what_hardly_moves_is_told_as_nothing() {
    let nodes = tetra([0.5, 0.3, 0.8]);
    let mut after = nodes.clone();
    after[2][0] += 4e-10;
    after[3][1] += 3e-10;
    for to in [&nodes, &after] {
        let verdict = judged(&plan(STANDING, &TETRA, vec![straight(0.0, &nodes), straight(1.0, to)]));
        assert_eq!(verdict.failures, vec![]);
        assert_eq!(verdict.travel, [0.0; 3]);
        let slip = verdict.slip.expect("told");
        assert_eq!((slip.value, slip.at), (0.0, vec![if *to == nodes { "n0" } else { "n2" }.to_owned()]));
    }
}

/// Rolls over edges that lie anywhere, both ways, by up to almost a whole turn: the lowest point of the node that comes
/// lowest, against many moments.
#[test]
fn a_roll_goes_as_deep_as_many_moments_say() {
    let mut number = dice(31);
    let (mut deep, mut between_ends) = (0, 0);
    for round in 0..80 {
        let heading = number(-3.1, 3.1);
        let (sine, cosine) = libm::sincos(heading);
        let origin = [number(-3.0, 3.0), number(-3.0, 3.0), 0.0];
        let end = [origin[0] + cosine, origin[1] + sine, 0.0];
        let mut nodes = vec![[7.0, 7.0, 0.5]; 4];
        (nodes[1], nodes[3]) = (origin, end);
        for node in [0, 2] {
            nodes[node] = [origin[0] + number(-1.0, 1.0), origin[1] + number(-1.0, 1.0), number(0.0, 1.0)];
        }
        let angle = number(0.2, 6.0) * if round % 2 == 0 { 1.0 } else { -1.0 };
        let axis = minus(end, origin);
        let at = |part: f64, p: Place| turned(p, (origin, axis), angle * part);
        let after: Vec<Place> = nodes.iter().map(|p| at(1.0, *p)).collect();
        let mut lowest = (0.0, 0.0, 0);
        for k in 0..=20_000 {
            let part = f64::from(k) / 20_000.0;
            for node in [0, 2] {
                let height = at(part, nodes[node])[2];
                if height < lowest.0 {
                    lowest = (height, part, node);
                }
            }
        }
        let keyframes = vec![straight(0.0, &nodes), roll(1.0, (1, 3), angle, &after)];
        let verdict = judged(&plan(STANDING, &TETRA, keyframes));
        let ground = of(CheckKind::Ground, &verdict);
        assert_eq!(ground.len(), usize::from(lowest.0 < -1e-6), "round {round}: {ground:?} {lowest:?}");
        if let [failure] = &ground[..] {
            assert!((failure.value + lowest.0).abs() < 1e-6, "round {round}: {failure:?} {lowest:?}");
            assert!((failure.time - lowest.1).abs() < 2e-3, "round {round}: {failure:?} {lowest:?}");
            assert_eq!(failure.at, [format!("n{}", lowest.2)]);
            deep += 1;
            between_ends += usize::from(lowest.1 > 0.01 && lowest.1 < 0.99);
        }
        // A roll to where the plan doesn't have it.
        let elsewhere = |message: &str| {
            of(CheckKind::Stability, &verdict).iter().any(|failure| failure.message.contains(message))
        };
        assert!(!elsewhere("elsewhere"), "round {round}: {:?}", verdict.failures);
    }
    assert!(deep > 40 && between_ends > 15, "{deep} of 80, {between_ends} between the ends");
}

/// A node below the ground at the start of a step that goes up: told at the start.
#[test]
fn a_node_below_the_ground_is_told_when_it_is_lowest() {
    let place = |height: f64| {
        let mut nodes = tetra([0.5, 0.3, 0.8]);
        nodes[1][2] = height;
        nodes
    };
    for (from, to, time) in [(-0.2, 0.1, 5.0), (0.1, -0.2, 6.0), (-0.2, -0.1, 5.0)] {
        let last = ramped(6.0, (0.5, 0.5), &place(to));
        let keyframes = vec![straight(0.0, &place(0.1)), straight(5.0, &place(from)), last];
        let verdict = judged(&plan(World { gravity: 0.0, ..STANDING }, &TETRA, keyframes));
        let ground = of(CheckKind::Ground, &verdict);
        assert!(ground.iter().all(|failure| (failure.value - 0.2).abs() < 1e-12 || from == -0.2));
        let told: Vec<f64> = ground.iter().map(|failure| failure.time).collect();
        assert!(told.iter().all(|told| *told == time), "{from} {to}: {ground:?}");
        assert!(!told.is_empty());
    }
}

/// Over an edge with the centre of mass beyond it: only weight on a ground turns it.
#[test]
fn only_weight_on_a_ground_makes_a_truss_roll() {
    let top = [0.5, -HIGH, 0.5];
    let angle = libm::atan2(0.5, HIGH);
    let before = tetra(top);
    let after: Vec<Place> = before.iter().map(|p| turned(*p, ([0.0; 3], [1.0, 0.0, 0.0]), angle)).collect();
    let rolls = |world: World| {
        let keyframes = vec![straight(0.0, &before), roll(1.0, (0, 1), angle, &after)];
        judged(&plan(world, &TETRA, keyframes))
    };
    let rolled = rolls(STANDING);
    assert_eq!(rolled.failures, vec![]);
    assert_eq!(rolled.events.len(), 1);
    assert_eq!(rolled.events[0].0, 0.0);
    for world in [World { gravity: 0.0, ..STANDING }, FREE, World { ground: Ground::Off, ..STANDING }] {
        let failures = rolls(world).failures;
        let [failure] = &failures[..] else { panic!("one failure: {failures:?}") };
        assert_eq!((failure.kind, failure.time), (CheckKind::Ground, 0.0));
        assert!(failure.message.contains("nothing makes it roll"), "{failure:?}");
    }
}
