//! Forces in the legs of tripods: the equilibrium of the top decides them, at every moment at which the judge looks.

use super::truss_plans::*;
use modl::plan::{CheckKind, Ramps, Status, World};
use nalgebra::{Matrix3, Vector3};

/// Friction that takes any thrust, so that the sides of the foot need not bear any.
const ROUGH: World = World { friction: 1000.0, ..STANDING };
const BUCKLING: f64 = 8.0;
const FORCE: f64 = 20.0;
const LONGEST: f64 = 2.0;
const NODE: f64 = 0.4;

/// Returns the forces in the legs with the top at a place, accelerated (m/s²), tension positive, and their lengths.
fn legs(top: Place, acceleration: Place) -> [(f64, f64); 3] {
    // Half of each of three struts of 1 kg, and the node.
    let mass = 1.5 + NODE;
    let felt = Vector3::from(acceleration.map(|a| -a)) - Vector3::new(0.0, 0.0, GRAVITY);
    let arms = BASE.map(|foot| minus(foot, top));
    let columns = arms.map(|arm| Vector3::from(arm).normalize());
    let forces = Matrix3::from_columns(&columns).lu().solve(&(felt * -mass)).expect("not flat");
    [0, 1, 2].map(|k| (forces[k], norm(arms[k])))
}

/// Returns the greatest part of what a leg bears: pulls up to a limit, pressure up to that at which it buckles, too.
fn part(legs: &[(f64, f64); 3]) -> f64 {
    let of = |&(force, length): &(f64, f64)| {
        if force >= 0.0 {
            force / FORCE
        } else {
            -force / FORCE.min(BUCKLING * LONGEST * LONGEST / (length * length))
        }
    };
    legs.iter().map(of).fold(0.0, f64::max)
}

/// Returns true if a foot weighs less than its leg pulls up.
fn lifts(top: Place, legs: &[(f64, f64); 3]) -> bool {
    legs.iter().any(|(force, length)| force * top[2] / length > (1.5 + NODE) * GRAVITY)
}

/// Returns the moments at which forces are looked for, as (part of the way, acceleration of progress): at rest at both ends
/// and in the middle, where the truss speeds up at the start, where it brakes at the end, and in the middle either if it is
/// never in between.
fn moments(seconds: f64, (up, down): (f64, f64)) -> Vec<(f64, f64)> {
    // The rate rises to one over the time that is left when half of the ramps is taken away.
    let rate = 1.0 / (seconds - (up + down) / 2.0);
    let mut moments = vec![(0.0, 0.0), (0.5, 0.0), (1.0, 0.0)];
    let meets = up + down > seconds * 0.999_999;
    if up > 0.0 {
        moments.push((0.0, rate / up));
        moments.extend(meets.then_some((0.5, rate / up)));
    }
    if down > 0.0 {
        moments.push((1.0, -rate / down));
        moments.extend(meets.then_some((0.5, -rate / down)));
    }
    moments
}

#[test]
fn the_legs_of_tripods_bear_what_the_equilibrium_of_their_top_says_at_every_moment() {
    let mut number = dice(3);
    let (mut falls, mut kinds) = (0, std::collections::BTreeSet::new());
    for round in 0..60 {
        let seconds = number(0.3, 1.2);
        let ramps = match round % 5 {
            0 => (0.0, 0.0),
            1 => (seconds / 2.0, seconds / 2.0),
            2 => (seconds * 0.2, seconds * 0.2),
            3 => (seconds * 0.4, 0.0),
            _ => (0.0, seconds * 0.4),
        };
        let mut top = || [0.5 + number(-0.2, 0.2), HIGH / 3.0 + number(-0.2, 0.2), number(0.6, 1.3)];
        // In some rounds from one side to the other, so that the middle may be worst.
        let from = top();
        let to = if round % 2 == 0 { top() } else { [1.0 - from[0], 0.6 - from[1], from[2] + 0.05] };
        let way = minus(to, from);
        let found: Vec<_> = moments(seconds, ramps)
            .into_iter()
            .map(|(at, rate)| {
                let place = between(from, to, at);
                (at, rate, place, legs(place, way.map(|w| w * rate)))
            })
            .collect();
        let plan = plan(ROUGH, &TETRA, vec![straight(0.0, &tetra(from)), ramped(seconds, ramps, &tetra(to))]);
        let verdict = judged(&of_strut(plan, |strut| {
            (strut.force, strut.buckling, strut.node_mass) = (FORCE, Some(BUCKLING), Some(NODE));
            strut.length = (0.1, LONGEST);
        }));
        if found.iter().any(|(_, _, place, legs)| lifts(*place, legs)) {
            falls += 1;
            let lost = of(CheckKind::Stability, &verdict);
            assert!(
                lost[0].message.contains("no forces of its struts and of the ground hold it"),
                "{lost:?}"
            );
            continue;
        }
        let parts: Vec<f64> = found.iter().map(|(.., legs)| part(legs)).collect();
        let worst = (0..parts.len()).max_by(|&a, &b| parts[a].total_cmp(&parts[b])).expect("some");
        let margin = verdict.force_margin.as_ref().expect("told");
        assert!((margin.value - (1.0 - parts[worst])).abs() < 1e-4, "round {round}: {margin:?} {parts:?}");
        let time = Ramps { up: ramps.0, down: ramps.1, ..Ramps::NONE }.progress(seconds).time(found[worst].0);
        assert!((margin.time - time).abs() < 1e-9, "round {round}: {margin:?}");
        kinds.insert((found[worst].0 > 0.4, found[worst].1.total_cmp(&0.0)));
        // Elastic struts bear no less in the worst of them.
        let elastic = verdict.elastic_margin.as_ref().expect("told").value;
        assert!(elastic < margin.value + 1e-4, "round {round}: {elastic}");
        let loads = of(CheckKind::StrutLoad, &verdict);
        assert_eq!(loads.len(), usize::from(parts[worst] > 1.0), "round {round}: {loads:?}");
        if let [failure] = &loads[..] {
            assert!((failure.value - parts[worst]).abs() < 1e-4 * parts[worst] && failure.limit == 1.0);
        } else {
            assert_eq!(status(&verdict, CheckKind::StrutLoad), Status::Sampled(parts.len()));
        }
    }
    assert!((1..20).contains(&falls), "{falls}");
    assert!(kinds.len() > 3, "the worst is at either end, at rest, speeding up and braking: {kinds:?}");
}

/// A shove aside that the feet cannot take for lack of friction, and can at another pace.
#[test]
fn ice_takes_no_shove() {
    let shoved = |seconds: f64, friction: f64| {
        let aside = |x: f64| tetra([0.5, HIGH / 3.0, 0.8]).iter().map(|p| [p[0] + x, p[1], p[2]]).collect();
        let places: [Vec<Place>; 2] = [aside(0.0), aside(0.5)];
        let ramps = (seconds / 2.0, seconds / 2.0);
        let keyframes = vec![straight(0.0, &places[0]), ramped(seconds, ramps, &places[1])];
        let verdict = judged(&plan(World { friction, ..STANDING }, &TETRA, keyframes));
        of(CheckKind::Stability, &verdict).len()
    };
    // It accelerates by four times the way over the square of the time, which friction of 0.8 times the factor has to
    // give to all of it; a pyramid inside the cone of eight edges gives between 0.92 and 1 of that.
    let needed = |seconds: f64| 4.0 * 0.5 / (seconds * seconds) / GRAVITY / 0.8;
    for seconds in [0.5, 1.0, 2.0] {
        assert_eq!(shoved(seconds, needed(seconds) * 1.1), 0, "{seconds}");
        assert_eq!(shoved(seconds, needed(seconds) * 0.99), 1, "{seconds}");
    }
}

/// A tall tripod that gets taller, fast: its legs bear most where they are most inclined, at the start.
#[test]
fn a_constant_rate_takes_no_force() {
    for seconds in [0.1, 1.0, 10.0] {
        let [from, to] = [1.3, 1.7].map(|height| [0.5, HIGH / 3.0, height]);
        let plan = plan(ROUGH, &TETRA, vec![straight(0.0, &tetra(from)), straight(seconds, &tetra(to))]);
        let verdict = judged(&of_strut(plan, |strut| strut.force = FORCE));
        let leg = 1.5 * GRAVITY / 3.0 * libm::sqrt(1.3 * 1.3 + 1.0 / 3.0) / 1.3;
        let margin = verdict.force_margin.expect("told");
        assert!((margin.value - (1.0 - leg / FORCE)).abs() < 1e-5 && margin.time == 0.0, "{margin:?}");
    }
}

/// A tripod that stands low, where its legs bear most, rises, and is shoved aside, in the direction in which the pyramids
/// inside the cones of friction hold least: friction holds it that is a little more than the shove needs.
#[test]
fn a_shove_within_the_cones_of_friction_is_held() {
    let seconds = 2.0;
    // Across the direction in the middle between two of eight edges.
    let (sine, cosine) = libm::sincos(std::f64::consts::PI / 8.0);
    let place = |height: f64, way: f64| -> Vec<Place> {
        tetra([0.5, HIGH / 3.0, height])
            .iter()
            .map(|p| [p[0] + way * cosine, p[1] + way * sine, p[2]])
            .collect()
    };
    let shoved = |friction: f64| {
        let keyframes = vec![
            straight(0.0, &place(0.3, 0.0)),
            straight(10.0, &place(1.0, 0.0)),
            ramped(10.0 + seconds, (seconds / 2.0, seconds / 2.0), &place(1.0, 0.5)),
        ];
        judged(&plan(World { friction, ..STANDING }, &TETRA, keyframes))
    };
    // It accelerates by four times the way over the square of the time.
    let needed = 4.0 * 0.5 / (seconds * seconds) / GRAVITY / 0.8;
    assert_eq!(shoved(needed * 1.05).failures, vec![]);
    assert_eq!(of(CheckKind::Stability, &shoved(needed * 0.98)).len(), 1);
}

/// A node on a mast whose three struts are all but in one plane, on ice that holds nothing: what is told is whether they
/// lie in one plane, which a sum of squared sines of 1e-12 decides.
#[test]
fn struts_lie_in_one_plane_where_the_squares_of_their_sines_sum_to_less_than_a_millionth_of_a_millionth() {
    let top = [0.5, HIGH / 3.0, 0.8];
    let struts = [&TETRA[..], &[(4, 0), (4, 1), (4, 3)]].concat();
    // The plane of the nodes 0, 1 and 3 meets the mast at this y.
    let flat = HIGH / 3.0 * 1.364 / 0.8;
    let mast = |off: f64| [0.5, flat + off, 1.364];
    // The least sum of squared sines from a plane, the least eigenvalue of the sum of the squares of directions.
    let sines = |off: f64| {
        let directions = [BASE[0], BASE[1], top].map(|p| Vector3::from(minus(p, mast(off))).normalize());
        directions.iter().map(|e| e * e.transpose()).sum::<Matrix3<f64>>().symmetric_eigenvalues().min()
    };
    for (wanted, in_plane) in [(0.7e-12, true), (1.4e-12, false)] {
        let (mut low, mut high) = (0.0, 1e-3);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if sines(middle) < wanted { low = middle } else { high = middle }
        }
        let places = |way: f64| -> Vec<Place> {
            [BASE[0], BASE[1], BASE[2], top, mast(low)].map(|p| [p[0] + way, p[1], p[2]]).to_vec()
        };
        let keyframes = vec![straight(0.0, &places(0.0)), ramped(1.0, (0.5, 0.5), &places(1.0))];
        let lost = of(
            CheckKind::Stability,
            &judged(&plan(World { friction: 1e-9, ..STANDING }, &struts, keyframes)),
        );
        let [failure] = &lost[..] else { panic!("one failure: {lost:?}") };
        assert_eq!(failure.message.contains("lie in one plane"), in_plane, "{wanted}: {failure:?}");
        assert_eq!(failure.at == ["n4"], in_plane, "{wanted}: {failure:?}");
    }
}

/// A tripod whose legs buckle the more the longer they are, and that rises fast: it bears most in the middle, where it
/// still speeds up.
#[test]
fn the_middle_is_looked_at_with_the_inertia_of_both_halves() {
    let (seconds, buckling) = (0.6, 4.0);
    let acceleration = 4.0 * 0.7 / (seconds * seconds);
    let part = |height: f64, acceleration: f64| {
        let length = libm::sqrt(height * height + 1.0 / 3.0);
        let force = 1.5 * (GRAVITY + acceleration) / 3.0 * length / height;
        force * length * length / (buckling * LONGEST * LONGEST)
    };
    let all = [
        (0.0, part(0.9, acceleration)),
        (0.5, part(1.25, acceleration)),
        (0.5, part(1.25, -acceleration)),
        (1.0, part(1.6, -acceleration)),
        (1.0, part(1.6, 0.0)),
    ];
    let worst = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("some");
    assert_eq!(worst.0, 0.5);
    let keyframes = vec![
        straight(0.0, &tetra([0.5, HIGH / 3.0, 0.9])),
        ramped(seconds, (seconds / 2.0, seconds / 2.0), &tetra([0.5, HIGH / 3.0, 1.6])),
    ];
    let verdict = judged(&of_strut(plan(ROUGH, &TETRA, keyframes), |strut| {
        (strut.length, strut.buckling) = ((0.1, LONGEST), Some(buckling));
    }));
    let margin = verdict.force_margin.expect("told");
    assert!((margin.value - (1.0 - worst.1)).abs() < 1e-4, "{margin:?} {all:?}");
    assert!((margin.time - seconds / 2.0).abs() < 1e-9, "{margin:?}");
}
