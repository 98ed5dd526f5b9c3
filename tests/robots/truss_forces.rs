//! Forces of trusses under changing loads, and bounds on their singular values, against sums and decompositions of their own.

use modl::geometry::Vec3;
use modl::robot::truss_statics::{
    Contact, ForceModel, Forces, Layout, LinearMotion, LowerBound, Modes, ShiftedFactor, Weights,
};
use nalgebra::DMatrix;

/// A tower of storeys on the ground: four corners each, braced along all sides and diagonals, each corner moved a little.
fn tower(storeys: usize) -> (Vec<Vec3>, Vec<(usize, usize)>) {
    let moved = |k: usize| (k.wrapping_mul(2_654_435_761) % 1000) as f64 / 1000.0 * 0.1;
    let corner = |k: usize| {
        let (level, side) = (k / 4, k % 4);
        let height = if level == 0 { 0.0 } else { level as f64 + moved(3 * k) };
        Vec3::new((side % 2) as f64 + moved(3 * k + 1), (side / 2) as f64 + moved(3 * k + 2), height)
    };
    let nodes: Vec<Vec3> = (0..4 * (storeys + 1)).map(corner).collect();
    let near = |a: usize, b: usize| b / 4 - a / 4 <= 1 && (nodes[a] - nodes[b]).norm() < 1.6;
    let struts = (0..nodes.len()).flat_map(|b| (0..b).map(move |a| (a, b))).filter(|&(a, b)| near(a, b));
    let struts = struts.collect();
    (nodes, struts)
}

/// Contacts of the four lowest corners, on level ground.
fn feet() -> Vec<Contact> {
    (0..4).map(|node| Contact { node, normal: Vec3::z() }).collect()
}

/// Returns the greatest force that loads leave unbalanced at a node, N.
fn unbalanced(
    (nodes, struts): (&[Vec3], &[(usize, usize)]),
    loads: &[Vec3],
    forces: &[f64],
    pushes: &[Vec3],
) -> f64 {
    let mut rest = loads.to_vec();
    for (&(a, b), force) in struts.iter().zip(forces) {
        let e = (nodes[b] - nodes[a]).normalize();
        rest[a] += e * *force;
        rest[b] -= e * *force;
    }
    feet().iter().zip(pushes).for_each(|(foot, push)| rest[foot.node] += push);
    rest.iter().map(Vec3::norm).fold(0.0, f64::max)
}

#[test]
fn forces_bear_a_change_of_the_loads_up_to_the_multiple_that_is_found() {
    let (nodes, struts) = tower(6);
    let layout = Layout::new(nodes.len(), &struts);
    let weight = vec![Vec3::new(0.0, 0.0, -10.0); nodes.len()];
    let length = |strut: usize| (nodes[struts[strut].1] - nodes[struts[strut].0]).norm();
    // Sideways: friction or a foot that lifts is the first to fail; downwards: a strut is.
    let cases = [
        (Vec3::new(1.0, 0.0, 0.0), 0.05, 1e6),
        (Vec3::new(0.3, 1.0, 0.0), 0.8, 1e6),
        (Vec3::new(0.0, 0.1, -1.0), 0.8, 150.0),
    ];
    for (push, friction, force_max) in cases {
        let model = ForceModel { loads: weight.clone(), friction, force_max, buckling: f64::INFINITY };
        let mut weights = Weights::default();
        let found = weights.forces(&layout, &nodes, &struts, &feet(), &model).expect("it stands");
        let loads = vec![push; nodes.len()];
        let change = weights.response(&layout, &nodes, &struts, &feet(), &loads).expect("it is held");
        let truss = (&nodes[..], &struts[..]);
        assert!(unbalanced(truss, &weight, &found.struts, &found.contacts) < 1e-6);
        assert!(unbalanced(truss, &loads, &change.struts, &change.contacts) < 1e-6);
        let multiple = found.borne_multiple(&change, length, &feet(), &model);
        let bears = |k: f64| {
            let struts = found.struts.iter().zip(&change.struts).all(|(f, g)| (f + k * g).abs() <= force_max);
            let pushes = found.contacts.iter().zip(&change.contacts).map(|(f, g)| f + g * k);
            struts && pushes.into_iter().all(|p| p.z >= 0.0 && p.xy().norm() <= friction * p.z)
        };
        assert!(multiple > 0.0 && multiple.is_finite(), "{multiple}");
        // All the way, and no farther.
        assert!((0..=100).all(|part| bears(0.999_999 * multiple * f64::from(part) / 100.0)), "{multiple}");
        assert!(!bears(1.000_001 * multiple), "{multiple}");
    }
}

#[test]
fn a_change_that_unloads_nothing_is_borne_without_end() {
    let (nodes, struts) = tower(2);
    let layout = Layout::new(nodes.len(), &struts);
    let loads = vec![Vec3::new(0.0, 0.0, -10.0); nodes.len()];
    let model =
        ForceModel { loads: loads.clone(), friction: 0.8, force_max: f64::INFINITY, buckling: f64::INFINITY };
    let mut weights = Weights::default();
    let found: Forces = weights.forces(&layout, &nodes, &struts, &feet(), &model).expect("it stands");
    // More of the same weight.
    let change = weights.response(&layout, &nodes, &struts, &feet(), &loads).expect("it is held");
    assert_eq!(found.borne_multiple(&change, |_| 1.0, &feet(), &model), f64::INFINITY);
}

/// Returns the singular values of the rigidity matrix but for the six of rigid motions, ascending.
fn singular_values(nodes: &[Vec3], struts: &[(usize, usize)]) -> Vec<f64> {
    let mut matrix = DMatrix::zeros(struts.len(), 3 * nodes.len());
    for (row, &(a, b)) in struts.iter().enumerate() {
        let e = (nodes[b] - nodes[a]).normalize();
        for k in 0..3 {
            (matrix[(row, 3 * a + k)], matrix[(row, 3 * b + k)]) = (-e[k], e[k]);
        }
    }
    let mut values: Vec<f64> =
        (matrix.transpose() * &matrix).symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values[6..].iter().map(|value| value.sqrt()).collect()
}

/// Returns nodes moved by up to so much each, m, in directions of their own.
fn displaced(nodes: &[Vec3], by: f64, seed: usize) -> Vec<Vec3> {
    let part = |k: usize| ((k + seed).wrapping_mul(2_246_822_519) % 1000) as f64 / 500.0 - 1.0;
    let moved = |(k, p): (usize, &Vec3)| p + Vec3::new(part(3 * k), part(3 * k + 1), part(3 * k + 2)) * by;
    nodes.iter().enumerate().map(moved).collect()
}

#[test]
fn a_lower_bound_leads_to_the_least_singular_value() {
    let (nodes, struts) = tower(6);
    let layout = Layout::new(nodes.len(), &struts);
    let least = singular_values(&nodes, &struts)[0];
    // Bounds are proved below the value, and not above it.
    assert!(LowerBound::new(&layout, &nodes, &struts, 0.999 * least).is_some());
    assert!(LowerBound::new(&layout, &nodes, &struts, 1.001 * least).is_none());
    let near = LowerBound::near(&layout, &nodes, &struts, least).expect("it is no less than before");
    let found = Modes::default().least_above(&layout, &nodes, &struts, &near).expect("it is near");
    assert!((found / least - 1.0).abs() < 1e-6, "{found}, {least}");
    // From far below nothing is proved of what lies between.
    let far = LowerBound::new(&layout, &nodes, &struts, 0.5 * least).expect("it is below");
    assert_eq!(Modes::default().least_above(&layout, &nodes, &struts, &far), None);
}

#[test]
fn decompositions_at_these_positions_and_nearby_lead_to_the_same_modes() {
    let (nodes, struts) = tower(6);
    let layout = Layout::new(nodes.len(), &struts);
    let values = singular_values(&nodes, &struts);
    let factors = [(0.0, 0.9), (0.002, 0.9), (0.01, 0.8)].map(|(by, part)| {
        let at = displaced(&nodes, by, 1);
        ShiftedFactor::new(&layout, &at, &struts, part * values[0]).expect("no pivot is next to nothing")
    });
    for near in [None, Some(&factors[0]), Some(&factors[1]), Some(&factors[2])] {
        let within = (4, f64::INFINITY);
        let modes = Modes::default().weakest_coarse(&layout, &nodes, &struts, within, near);
        assert_eq!(modes.len(), 4);
        for (mode, value) in modes.iter().zip(&values) {
            assert!((mode.value / value - 1.0).abs() < 1e-6, "{} of {value}", mode.value);
            let size: f64 = mode.nodes.iter().map(|v| v.norm_squared()).sum();
            assert!((size - 1.0).abs() < 1e-6, "{size}");
            // The square of the singular value is what the displacement does to the lengths of the struts.
            let stretch = |&(a, b): &(usize, usize)| {
                let rate = (mode.nodes[b] - mode.nodes[a]).dot(&(nodes[b] - nodes[a]).normalize());
                rate * rate
            };
            let square: f64 = struts.iter().map(stretch).sum();
            assert!((square.sqrt() / value - 1.0).abs() < 1e-6, "{square}, {value}");
        }
    }
}

#[test]
fn no_singular_value_on_a_way_is_less_than_the_bound_between_its_ends() {
    let (nodes, struts) = tower(3);
    let begin = singular_values(&nodes, &struts)[0];
    let mut tightest: f64 = 0.0;
    for (seed, by) in [0.01, 0.03, 0.1, 0.2, 0.3].into_iter().cycle().take(30).enumerate() {
        let to = displaced(&nodes, by, 17 * seed);
        let end = singular_values(&to, &struts)[0];
        let motion = LinearMotion::new(&struts, &nodes, &to);
        let bound = motion.least([begin, end]);
        let at = |k: usize| -> Vec<Vec3> {
            nodes.iter().zip(&to).map(|(p, q)| p + (q - p) * (k as f64 / 20.0)).collect()
        };
        let least = (0..=20).map(|k| singular_values(&at(k), &struts)[0]).fold(f64::INFINITY, f64::min);
        assert!(bound <= least * (1.0 + 1e-9), "{bound}, {least}");
        if by <= 0.01 {
            assert!(bound > 0.9 * least, "{bound}, {least}");
        }
        tightest = tightest.max(bound / least);
        // The bound needed at one end proves the floor, and nothing less does; the better the other end is known, the less it is.
        for floor in [0.3, 0.6, 0.9].map(|part| part * begin.min(end)) {
            let needed = [motion.end_needed(begin, floor), motion.start_needed(end, floor)];
            for (ends, short) in [
                ([begin, needed[0]], [begin, 0.999 * needed[0]]),
                ([needed[1], end], [0.999 * needed[1], end]),
            ] {
                assert!((motion.least(ends) / floor - 1.0).abs() < 1e-9 || needed.contains(&f64::INFINITY));
                assert!(motion.least(short) < floor, "{short:?}, {floor}");
            }
            assert!(motion.end_needed(2.0 * begin, floor) <= needed[0]);
        }
    }
    assert!(tightest > 0.95, "{tightest}");
}
