//! The points of studies.

use modl::optimize::CmaEs;
use modl::study::{COORDINATES_MAX, Coordinate, Design, Domain, Goal, Sampler, Search, sobol};

/// Points of the sequence as SciPy gives them: `scipy.stats.qmc.Sobol(d=21, scramble=False, bits=32).random(1024)`.
const SCIPY: &[(u64, [f64; 21])] = &[
    (
        100,
        [
            0.4140625, 0.2578125, 0.7734375, 0.7265625, 0.8828125, 0.7421875, 0.0234375, 0.4765625,
            0.6328125, 0.6953125, 0.4609375, 0.6796875, 0.4765625, 0.8515625, 0.3203125, 0.4921875,
            0.6796875, 0.7421875, 0.8359375, 0.3359375, 0.7578125,
        ],
    ),
    (
        777,
        [
            0.6923828125,
            0.9365234375,
            0.1630859375,
            0.2744140625,
            0.6357421875,
            0.3564453125,
            0.1904296875,
            0.7626953125,
            0.3486328125,
            0.3232421875,
            0.7451171875,
            0.6962890625,
            0.3837890625,
            0.4736328125,
            0.5693359375,
            0.5146484375,
            0.4033203125,
            0.8642578125,
            0.3701171875,
            0.7529296875,
            0.2373046875,
        ],
    ),
    (
        1023,
        [
            0.0009765625,
            0.7529296875,
            0.6123046875,
            0.1455078125,
            0.1865234375,
            0.4384765625,
            0.1396484375,
            0.6181640625,
            0.3447265625,
            0.8505859375,
            0.6787109375,
            0.0361328125,
            0.1298828125,
            0.6650390625,
            0.3623046875,
            0.4638671875,
            0.3134765625,
            0.8759765625,
            0.5849609375,
            0.3193359375,
            0.8662109375,
        ],
    ),
];

#[test]
fn the_sobol_sequence_is_that_of_scipy() {
    for (index, point) in SCIPY {
        let own: Vec<f64> = (0..COORDINATES_MAX).map(|coordinate| sobol(*index, coordinate)).collect();
        assert_eq!(own, point, "point {index}");
    }
}

/// A power of two of points has one in each interval of as many equal ones, in every coordinate; and the last points of
/// the sequence are no repetition of the first.
#[test]
fn every_coordinate_is_stratified() {
    for coordinate in 0..COORDINATES_MAX {
        for (power, first) in [(6, 0), (10, 0), (10, 5 << 10)] {
            let count = 1u64 << power;
            let mut cells: Vec<u64> = (first..first + count)
                .map(|index| (sobol(index, coordinate) * count as f64) as u64)
                .collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..count).collect::<Vec<_>>(), "coordinate {coordinate}");
        }
    }
}

fn random(seed: u64) -> Design {
    let axes = vec![Domain::Range(0.0, 1.0), Domain::Range(0.0, 1.0)];
    Design { axes, each: vec![], sampler: Sampler::Random(5000), seed }
}

fn numbers(point: &[Coordinate]) -> Vec<f64> {
    point
        .iter()
        .map(|coordinate| match coordinate {
            Coordinate::Number(x) => *x,
            Coordinate::Index(index) => *index as f64,
        })
        .collect()
}

/// Neighbouring points, axes and seeds are not correlated: their coefficients are within 5 standard errors of 0.
#[test]
fn random_points_are_independent() {
    let points = |seed: u64| -> Vec<Vec<f64>> {
        (0..5000).map(|i| numbers(&random(seed).point(i).expect("no search"))).collect()
    };
    let (a, b) = (points(1), points(2));
    let of = |points: &[Vec<f64>], axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<f64>>();
    let (x, y, other) = (of(&a, 0), of(&a, 1), of(&b, 0));
    for (one, two) in [(&x[..], &y[..]), (&x[1..], &x[..4999]), (&x[..], &other[..]), (&x[1..], &y[..4999])] {
        let product: f64 = one.iter().zip(two).map(|(x, y)| (x - 0.5) * (y - 0.5)).sum();
        let coefficient = product / one.len() as f64 * 12.0;
        assert!(coefficient.abs() < 5.0 / 70.7, "{coefficient}");
    }
    assert_ne!(x, other);
    assert_eq!(points(1), a);
}

/// Evaluations until a function of `n` coordinates is below the target, from (3, ..., 3) with σ = 1; `None` beyond the
/// budget.
fn evaluations(f: fn(&[f64]) -> f64, n: usize, seed: u64) -> Option<usize> {
    let mut search = CmaEs::new(vec![3.0; n], 1.0, &vec![0.0; n], seed, None);
    let mut count = 0;
    while count < 20_000 {
        let points = search.ask();
        let values: Vec<f64> = points.iter().map(|x| f(x)).collect();
        if let Some(at) = values.iter().position(|value| *value < 1e-9) {
            return Some(count + at + 1);
        }
        count += points.len();
        search.tell(&points, &values);
    }
    None
}

fn square(x: f64) -> f64 {
    x * x
}

fn median(f: fn(&[f64]) -> f64, n: usize) -> usize {
    // Rosenbrock's function has a second minimum, where the reference ends now and then, too.
    let mut all: Vec<usize> = (1..=9).map(|seed| evaluations(f, n, seed).unwrap_or(usize::MAX)).collect();
    all.sort_unstable();
    all[4]
}

/// The median number of evaluations over 21 seeds of `cma` 4.5 (Hansen, Akimoto and Baudis 2019), from the same point, with
/// its default options but no early end: `.ci/full studies` computes them anew, for ten functions.
#[test]
fn the_evolution_strategy_needs_no_more_evaluations_than_the_reference() {
    let sphere = |x: &[f64]| x.iter().map(|x| x * x).sum();
    let rosenbrock = |x: &[f64]| -> f64 {
        x.windows(2).map(|w| 100.0 * square(w[0] * w[0] - w[1]) + square(w[0] - 1.0)).sum()
    };
    let ellipsoid = |x: &[f64]| -> f64 {
        x.iter().enumerate().map(|(i, x)| libm::pow(1e6, i as f64 / 4.0) * x * x).sum()
    };
    for (name, f, reference) in [
        ("sphere", sphere as fn(&[f64]) -> f64, 773),
        ("rosenbrock", rosenbrock, 1876),
        ("ellipsoid", ellipsoid, 1620),
    ] {
        let own = median(f, 5);
        assert!(own as f64 <= 1.1 * reference as f64, "{name}: {own} evaluations, the reference {reference}");
    }
}

/// A search over a choice and whole numbers finds, on 8 of 10 seeds within 200 points, the best of 24 cells and there the
/// best twentieth of the continuous axis. Of 200 random points one is there with probability 1 - 0.95^8 = 0.34: then 8 of 10
/// are as rare as 1 in 170.
#[test]
fn a_search_goes_over_choices() {
    let axes = vec![Domain::Values(4), Domain::Values(6), Domain::Range(-1.0, 1.0)];
    let cost = |x: &[f64]| square(x[0] - 2.0) + (x[1] - 4.0).abs() + (x[2] - 0.3).abs();
    let mut found = 0;
    for seed in 0..10 {
        let design = Design { axes: axes.clone(), each: vec![], sampler: Sampler::Search(200), seed };
        let mut search = Search::new(&design, Goal::Least).expect("it is a search with axes");
        let (mut best, mut asked) = (f64::INFINITY, 0);
        loop {
            let points = search.ask();
            if points.is_empty() {
                break;
            }
            asked += points.len();
            let values: Vec<Option<f64>> = points.iter().map(|p| Some(cost(&numbers(p)))).collect();
            best = values.iter().flatten().copied().fold(best, f64::min);
            search.tell(&values);
        }
        assert_eq!(asked, 200);
        found += usize::from(best < 0.05);
    }
    assert!(found >= 8, "{found} of 10");
}

/// Points without values are the worst, and a search of which all points fail still ends.
#[test]
fn a_search_bears_failures() {
    let design =
        Design { axes: vec![Domain::Range(0.0, 1.0)], each: vec![], sampler: Sampler::Search(103), seed: 3 };
    let mut search = Search::new(&design, Goal::Greatest).expect("it is a search");
    let mut count = 0;
    loop {
        let points = search.ask();
        if points.is_empty() {
            break;
        }
        count += points.len();
        search.tell(&vec![None; points.len()]);
    }
    assert_eq!(count, 103);
}
