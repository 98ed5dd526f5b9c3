//! The shape of trusses: angles and distances between struts against many moments, and the margins that plans state.

use super::truss_plans::*;
use crate::support::trusses::distance;
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Shape, Vec3};
use modl::plan::{CheckKind, LengthSum, Margins, Plan, TrussLimits};
use nalgebra::DMatrix;

fn at(from: &[Place], to: &[Place], part: f64) -> Vec<Place> {
    from.iter().zip(to).map(|(p, q)| between(*p, *q, part)).collect()
}

/// Returns the least angle between two struts that share a node, by the cosine.
fn least_angle(x: &[Place], struts: &[(usize, usize)]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, &(a, b)) in struts.iter().enumerate() {
        for &(c, d) in &struts[..i] {
            for (node, p) in [(a, b), (b, a)] {
                for (other, q) in [(c, d), (d, c)] {
                    if node == other {
                        let (u, v) = (minus(x[p], x[node]), minus(x[q], x[node]));
                        least = least.min(libm::acos(dot(u, v) / norm(u) / norm(v)));
                    }
                }
            }
        }
    }
    least
}

#[test]
fn the_least_angle_is_that_of_many_moments() {
    let mut number = dice(41);
    for round in 0..40 {
        let mut nodes = || -> Vec<Place> {
            tetra([0.5, 0.3, 0.8]).iter().map(|p| p.map(|x| x + number(-0.25, 0.25))).collect()
        };
        let from = nodes();
        let mut to = nodes();
        // In some rounds nothing moves, or one node passes by.
        match round % 4 {
            0 => to.clone_from(&from),
            1 => to[3] = [1.3 - from[3][0], 0.9 - from[3][1], from[3][2]],
            _ => {}
        }
        let looked = |k: u32| least_angle(&at(&from, &to, f64::from(k) / 2000.0), &TETRA);
        let angles: Vec<f64> = (0..=2000).map(looked).collect();
        let least = angles.iter().copied().fold(f64::INFINITY, f64::min);
        let plan = plan(FREE, &TETRA, vec![straight(0.0, &from), straight(1.0, &to)]);
        let kept = |angle: f64| judged(&with(plan.clone(), |paths| paths.limits.angle = angle));
        let (loose, strict) = (kept(least - 1e-4), kept(least + 1e-4));
        assert_eq!(of(CheckKind::JointRange, &loose), vec![], "round {round}");
        let told = loose.angle.expect("told");
        assert!(told.value <= angles[0].min(angles[2000]) + 1e-9, "round {round}: {told:?}");
        assert!((told.value - least_angle(&at(&from, &to, told.time), &TETRA)).abs() < 1e-6, "{told:?}");
        let failures = of(CheckKind::JointRange, &strict);
        assert!(!failures.is_empty(), "round {round}: {least}");
        for failure in failures {
            assert!(
                failure.value < failure.limit && failure.value > least - 1e-4,
                "round {round}: {failure:?}"
            );
            assert!(failure.message.contains("come to an angle of"), "{failure:?}");
        }
        // Without a limit none is told.
        assert_eq!(kept(0.0).angle, None);
        assert_eq!(of(CheckKind::JointRange, &kept(0.0)), vec![]);
    }
}

#[test]
fn the_least_distance_of_two_struts_is_that_of_many_moments() {
    let mut number = dice(43);
    let (mut kept, mut met) = (0, 0);
    for round in 0..80 {
        let mut nodes =
            || -> Vec<Place> { (0..4).map(|_| std::array::from_fn(|_| number(-1.0, 1.0))).collect() };
        let (from, to) = (nodes(), nodes());
        let to = if round % 8 == 0 { from.clone() } else { to };
        let apart = |part: f64| {
            let x: Vec<Vec3> = at(&from, &to, part).into_iter().map(Vec3::from).collect();
            distance([x[0], x[1]], [x[2], x[3]])
        };
        let least = (0..=1000).map(|k| apart(f64::from(k) / 1000.0)).fold(f64::INFINITY, f64::min);
        let judge = |clearance: f64| {
            let plan = plan(FREE, &[(0, 1), (2, 3)], vec![straight(0.0, &from), straight(1.0, &to)]);
            judged(&of_strut(plan, |strut| strut.clearance = clearance))
        };
        let clearance = 0.1;
        let verdict = judge(clearance);
        let failures = of(CheckKind::Collision, &verdict);
        if let Some(told) = &verdict.clearance {
            assert!((told.value - apart(told.time)).abs() < 1e-6, "round {round}: {told:?}");
            assert!(told.value <= apart(0.0).min(apart(1.0)) + 1e-6, "round {round}: {told:?}");
        } else {
            assert!(least > clearance, "round {round}: {least}");
        }
        if least > clearance + 1e-9 {
            assert_eq!(failures, vec![], "round {round}: {least}");
            kept += 1;
        } else if least < clearance - 0.01 {
            let [failure] = &failures[..] else { panic!("round {round}: one failure: {failures:?}") };
            assert!(failure.value < clearance && (failure.value - apart(failure.time)).abs() < 1e-6);
            met += 1;
        }
    }
    assert!(kept > 20 && met > 20, "{kept} kept apart, {met} met");
}

/// Returns the margins at a keyframe by their definitions: a limit of lengths, of one strut that has failed, and of a sum of two;
/// balls as obstacles.
fn margins(x: &[Place], balls: &[(Place, f64)], limits: &TrussLimits, clearance: f64) -> Margins {
    let length = |strut: usize| norm(minus(x[TETRA[strut].0], x[TETRA[strut].1]));
    let inside = |length: f64, (low, high): (f64, f64)| (length - low).min(high - length);
    let one = |strut: usize| {
        let failed = limits.sums.iter().find(|sum| sum.struts == [strut]);
        inside(length(strut), failed.map_or((0.4, 1.7), |sum| sum.range))
    };
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let v: Vec<Vec3> = x.iter().map(|p| Vec3::from(*p)).collect();
    let opposite = [[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2]];
    let apart = opposite.map(|[a, b, c, d]| distance([v[a], v[b]], [v[c], v[d]]));
    let beside = balls.iter().flat_map(|(centre, radius)| {
        let v = &v;
        TETRA.map(move |(a, b)| distance([Vec3::from(*centre); 2], [v[a], v[b]]) - radius)
    });
    // The distances of the centre of mass from the sides of the foot.
    let mean = [0, 1].map(|k| x.iter().map(|p| p[k]).sum::<f64>() / 4.0);
    let sides = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| {
        let (p, q) = (x[a], x[b]);
        let across = (q[0] - p[0]) * (mean[1] - p[1]) - (q[1] - p[1]) * (mean[0] - p[0]);
        across / norm(minus(q, p))
    });
    let mut matrix = DMatrix::zeros(6, 12);
    for (row, &(a, b)) in TETRA.iter().enumerate() {
        for k in 0..3 {
            matrix[(row, 3 * a + k)] = (x[a][k] - x[b][k]) / length(row);
            matrix[(row, 3 * b + k)] = (x[b][k] - x[a][k]) / length(row);
        }
    }
    let sum = |sum: &LengthSum| inside(sum.struts.iter().map(|&strut| length(strut)).sum(), sum.range);
    Margins {
        length: Some(least(&mut (0..6).map(one))),
        clearance: Some(least(&mut apart.into_iter()) - clearance),
        obstacle: Some(least(&mut beside.into_iter()) - clearance),
        support: Some(least(&mut sides.into_iter())),
        angle: Some(least_angle(x, &TETRA) - limits.angle),
        rigidity: Some(matrix.singular_values().min() - limits.rigidity),
        sum: Some(least(&mut limits.sums.iter().map(sum))),
    }
}

#[test]
fn margins_are_what_their_definitions_say_and_no_others_may_be_stated() {
    let mut number = dice(47);
    let limits = TrussLimits {
        angle: 0.3,
        rigidity: 0.1,
        slip: 0.0,
        sums: vec![
            LengthSum { struts: vec![2, 4], range: (1.0, 4.0) },
            LengthSum { struts: vec![1], range: (0.5, 1.3) },
        ],
    };
    let clearance = 0.4;
    let begins = |stated: &Margins, which: usize, by: f64| {
        let mut stated = *stated;
        let field = match which {
            0 => &mut stated.length,
            1 => &mut stated.clearance,
            2 => &mut stated.obstacle,
            3 => &mut stated.support,
            4 => &mut stated.angle,
            5 => &mut stated.rigidity,
            _ => &mut stated.sum,
        };
        *field = field.map(|value| value + by);
        stated
    };
    for round in 0..15 {
        let mut nodes = || -> Vec<Place> {
            let moved = |p: &Place| [p[0] + number(-0.2, 0.2), p[1] + number(-0.2, 0.2), p[2]];
            let mut nodes: Vec<Place> = tetra([0.5, 0.3, 0.9]).iter().map(moved).collect();
            nodes[3][2] += number(-0.2, 0.2);
            nodes
        };
        let (from, to) = (nodes(), nodes());
        let balls: Vec<(Place, f64)> = (0..3)
            .map(|_| ([number(1.0, 2.5), number(1.0, 2.5), number(0.0, 2.0)], number(0.1, 0.3)))
            .collect();
        let judge = |stated: [Margins; 2]| {
            let mut plan = plan(STANDING, &TETRA, vec![straight(0.0, &from), straight(1.0, &to)]);
            plan = of_strut(plan, |strut| (strut.length, strut.clearance) = ((0.4, 1.7), clearance));
            plan = with(plan, |paths| {
                paths.limits = limits.clone();
                let ball = |(centre, radius): &(Place, f64)| {
                    let shape = Shape::Sphere { radius: *radius };
                    vec![Placed { pose: shifted(Vec3::from(*centre)), shape }]
                };
                paths.surroundings.obstacles = balls.iter().map(ball).collect();
                paths
                    .keyframes
                    .iter_mut()
                    .zip(stated)
                    .for_each(|(keyframe, stated)| keyframe.margins = stated);
            });
            of(CheckKind::Form, &judged(&plan))
        };
        let found = [&from, &to].map(|x| margins(x, &balls, &limits, clearance));
        assert_eq!(judge(found), vec![], "round {round}: {found:?}");
        let words =
            ["lengths", "between struts", "beside obstacles", "of the support", "of angles", "of rigidity"];
        for which in 0..7 {
            for by in [1e-5, -1e-5, 0.3] {
                let keyframe = round % 2;
                let mut stated = found;
                stated[keyframe] = begins(&found[keyframe], which, by);
                let failures = judge(stated);
                let [failure] = &failures[..] else { panic!("round {round}: one failure: {failures:?}") };
                assert!((failure.value - failure.limit - by).abs() < 1e-6, "{failure:?}");
                assert_eq!(failure.time, keyframe as f64);
                let what = words.get(which).copied().unwrap_or("of sums");
                assert!(failure.message.contains(what), "{failure:?}");
            }
        }
        // Half of the tolerance of rounding is none.
        for which in 0..7 {
            let stated = [begins(&found[0], which, 0.2e-7), found[1]];
            assert!(judge(stated).is_empty() || which == 2, "round {round}: {which}");
        }
    }
}

/// Margins of limits that a truss doesn't have.
#[test]
fn no_margin_may_be_stated_of_what_there_is_not() {
    let plan = || -> Plan { plan(FREE, &[(0, 1), (1, 2), (2, 0)], vec![straight(0.0, &BASE)]) };
    let none = Margins::default();
    for stated in [
        Margins { clearance: Some(0.5), ..none },
        Margins { obstacle: Some(0.5), ..none },
        Margins { angle: Some(0.5), ..none },
        Margins { sum: Some(0.5), ..none },
    ] {
        let plan = with(plan(), |paths| paths.keyframes[0].margins = stated);
        let failures = judged(&plan).failures;
        let [failure] = &failures[..] else { panic!("one failure of {stated:?}: {failures:?}") };
        assert_eq!((failure.kind, failure.limit), (CheckKind::Form, f64::INFINITY));
    }
}
