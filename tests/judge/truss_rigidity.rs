//! The least singular value of the rigidity matrix, against the eigenvalues of a dense one at many moments.

use super::truss_plans::*;
use modl::plan::{CheckKind, Failure, Status};
use nalgebra::DMatrix;

/// The struts of a triangular bipyramid with one more across: two nodes over and below a triangle.
const BIPYRAMID: [(usize, usize); 10] =
    [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3), (0, 4), (1, 4), (2, 4), (3, 4)];

/// Returns the seventh least singular value of the matrix whose rows are unit vectors along the struts: six belong to the motions
/// of the whole.
fn dense(nodes: &[Place], struts: &[(usize, usize)]) -> f64 {
    let mut matrix = DMatrix::zeros(struts.len(), 3 * nodes.len());
    for (row, &(a, b)) in struts.iter().enumerate() {
        let d = minus(nodes[b], nodes[a]);
        for k in 0..3 {
            matrix[(row, 3 * a + k)] = -d[k] / norm(d);
            matrix[(row, 3 * b + k)] = d[k] / norm(d);
        }
    }
    let mut values: Vec<f64> =
        (matrix.transpose() * &matrix).symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values[6].max(0.0).sqrt()
}

fn at(from: &[Place], to: &[Place], part: f64) -> Vec<Place> {
    from.iter().zip(to).map(|(p, q)| between(*p, *q, part)).collect()
}

#[test]
fn the_least_singular_value_is_that_of_a_dense_matrix() {
    let mut number = dice(17);
    let (mut kept, mut lost) = (0, 0);
    for round in 0..30 {
        let struts = if round % 2 == 0 { &TETRA[..] } else { &BIPYRAMID[..] };
        let mut nodes = || -> Vec<Place> {
            let near = [BASE[0], BASE[1], BASE[2], [0.5, 0.3, 0.8], [0.5, 0.3, -0.7]];
            let count = if struts.len() == 6 { 4 } else { 5 };
            near[..count].iter().map(|p| p.map(|x| x + number(-0.25, 0.25))).collect()
        };
        let (from, to) = (nodes(), nodes());
        // In some rounds it goes inside out.
        let to = if round % 3 == 0 { to.iter().map(|p| [p[0], p[1], 0.3 - p[2]]).collect() } else { to };
        let limit = 0.25;
        let plan = plan(FREE, struts, vec![straight(0.0, &from), straight(1.0, &to), straight(2.0, &from)]);
        let verdict = judged(&with(plan, |paths| paths.limits.rigidity = limit));
        let worst = verdict.rigidity.as_ref().expect("told");
        let there = at(&from, &to, if worst.time <= 1.0 { worst.time } else { 2.0 - worst.time });
        assert!((worst.value - dense(&there, struts)).abs() < 1e-6, "round {round}: {worst:?}");
        let looked = [0.0, 0.5, 1.0].map(|part| dense(&at(&from, &to, part), struts));
        let looked = looked.into_iter().fold(f64::INFINITY, f64::min);
        assert!(worst.value <= looked + 1e-6, "round {round}: {worst:?} {looked}");
        let least = (0..=400).map(|k| dense(&at(&from, &to, f64::from(k) / 400.0), struts));
        let least = least.fold(f64::INFINITY, f64::min);
        let failures = of(CheckKind::Rigidity, &verdict);
        // Both steps go the same way.
        if looked < limit - 1e-6 || least < limit / 2.0 - 1e-6 {
            assert!(failures.len() >= 2, "round {round}: {failures:?}");
            lost += 1;
        } else if least > limit / 2.0 * 1.01 {
            assert_eq!(failures, vec![], "round {round}: {least}");
            kept += 1;
        }
    }
    assert!(kept > 5 && lost > 5, "{kept} kept, {lost} lost");
}

/// The top goes through the plane of its feet after any part of the way: nothing holds it there.
#[test]
fn rigidity_that_is_lost_anywhere_is_found() {
    for tenths in [1, 2, 3, 4, 6, 7, 8, 9] {
        let part = f64::from(tenths) / 10.0;
        let (high, low) = (1.6 * part, -1.6 * (1.0 - part));
        let keyframes =
            vec![straight(0.0, &tetra([0.5, 0.3, high])), straight(10.0, &tetra([0.5, 0.3, low]))];
        let plan = plan(FREE, &TETRA, keyframes);
        let judged = judged(&with(plan, |paths| paths.limits.rigidity = 0.04));
        let found: Vec<Failure> = of(CheckKind::Rigidity, &judged);
        let [failure] = &found[..] else { panic!("{part}: one failure: {found:?}") };
        assert!((failure.time / 10.0 - part).abs() < 0.06, "{part}: {failure:?}");
    }
}

/// Without a limit in the plan it is 0.05, or an eighth of what there is at the start if that is less.
#[test]
fn the_limit_of_a_plan_that_states_none_is_a_part_of_what_there_is_at_first() {
    let to = |height: f64, start: f64| {
        let keyframes =
            vec![straight(0.0, &tetra([0.5, 0.3, start])), straight(10.0, &tetra([0.5, 0.3, height]))];
        judged(&plan(FREE, &TETRA, keyframes))
    };
    let value = |height: f64| dense(&tetra([0.5, 0.3, height]), &TETRA);
    // The height at which there is so much left.
    let height = |wanted: f64| {
        let (mut low, mut high) = (0.0, 0.8);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if value(middle) < wanted { low = middle } else { high = middle }
        }
        high
    };
    for start in [0.8, 0.1] {
        let limit = f64::min(0.05, value(start) / 8.0);
        assert_eq!(to(height(limit * 1.001), start).failures, vec![], "{start}");
        let lost = to(height(limit * 0.999), start);
        assert_eq!(of(CheckKind::Rigidity, &lost).len(), 1, "{start}");
        assert!((lost.failures[0].limit - limit).abs() < 1e-6, "{start}: {:?}", lost.failures);
        assert_eq!(lost.failures[0].at, ["n3"]);
    }
}

/// Rings of four struts, and bipyramids that turn about the edge between their halves: none is asked to stay rigid.
#[test]
fn what_is_not_rigid_at_first_is_not_judged() {
    let square = [(0, 1), (1, 2), (2, 3), (3, 0)];
    let hinge = [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3), (0, 4), (1, 4), (2, 4)]
        .map(|(a, b)| if b == 4 && a == 2 { (4, 5) } else { (a, b) });
    let mut number = dice(37);
    for round in 0..20 {
        let (count, struts) = if round % 2 == 0 { (4, &square[..]) } else { (6, &hinge[..]) };
        let nodes: Vec<Place> = (0..count).map(|_| std::array::from_fn(|_| number(-1.0, 1.0))).collect();
        let mut after = nodes.clone();
        after[2][2] += 0.1;
        let keyframes = vec![straight(0.0, &nodes), straight(1.0, &after)];
        let verdict = judged(&plan(FREE, struts, keyframes));
        assert_eq!(of(CheckKind::Rigidity, &verdict), vec![], "round {round}");
        assert_eq!(verdict.rigidity, None);
        let not = Status::NotChecked("it is not rigid where it begins".into());
        assert_eq!(status(&verdict, CheckKind::Rigidity), not);
    }
}

/// The start, the middle and the end of a step, of whose start the step before has taken care; a truss that rests once.
#[test]
fn the_moments_looked_at_are_counted() {
    let places = [0.8, 0.81, 0.8].map(|height| tetra([0.5, 0.3, height]));
    let keyframes = |count: usize| (0..count).map(|k| straight(k as f64, &places[k])).collect::<Vec<_>>();
    let told = |count: usize| status(&judged(&plan(FREE, &TETRA, keyframes(count))), CheckKind::Rigidity);
    assert_eq!(told(1), Status::Sampled(1));
    assert_eq!(told(2), Status::Sampled(3));
    assert_eq!(told(3), Status::Sampled(5));
}
