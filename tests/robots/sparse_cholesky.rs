//! Cholesky's decomposition of sparse matrices against nalgebra's dense one, and the fill of its order.

use modl::interrupt::second_thread;
use modl::optimize::SymbolicFactor;
use modl::optimize::cholesky::PivotRule;
use modl::optimize::cuthill_mckee::{neighbours, reverse_order};
use modl::optimize::minimum_degree::minimum_degree;
use modl::optimize::nested_dissection::nested_dissection;
use modl::optimize::sparse_cholesky::SparseMatrix;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::sync::Arc;

/// A symmetric matrix in blocks with entries where the graph has edges, once dense and once sparse; its diagonal is
/// `diagonal` greater than that of a matrix that its diagonal dominates.
fn matrix(
    count: usize,
    size: usize,
    edges: &[(usize, usize)],
    numbers: &[f64],
    diagonal: f64,
) -> (DMatrix<f64>, SparseMatrix) {
    let symbolic = Arc::new(SymbolicFactor::new(size, &neighbours(count, edges.iter().copied())));
    let mut sparse = SparseMatrix::new(&symbolic);
    let n = count * size;
    let mut dense: DMatrix<f64> = DMatrix::zeros(n, n);
    let mut next = numbers.iter().cycle();
    let mut number = || *next.next().expect("there are numbers");
    for &(a, b) in edges.iter().filter(|(a, b)| a != b) {
        for i in size * a..size * (a + 1) {
            for j in size * b..size * (b + 1) {
                let value = number();
                dense[(i, j)] += value;
                dense[(j, i)] += value;
                sparse.add(i, j, value);
            }
        }
    }
    for i in 0..n {
        let row: f64 = dense.row(i).iter().map(|v| v.abs()).sum();
        let value = row + diagonal + number().abs();
        dense[(i, i)] += value;
        sparse.add(i, i, value);
    }
    (dense, sparse)
}

proptest! {
    #![proptest_config(crate::support::properties::cases(200))]

    #[test]
    fn solutions_are_those_of_nalgebra(
        count in 1usize..25, size in 1usize..4,
        edges in proptest::collection::vec((0usize..25, 0usize..25), 0..70),
        numbers in proptest::collection::vec(-1.0f64..1.0, 150),
    ) {
        let edges: Vec<(usize, usize)> = edges.iter().map(|(a, b)| (a % count, b % count)).collect();
        let (dense, sparse) = matrix(count, size, &edges, &numbers, 0.5);
        let factor = sparse.cholesky(PivotRule::Refuse(1e-14)).expect("the diagonal dominates");
        let right = DVector::from_iterator(count * size, numbers.iter().cycle().copied().take(count * size));
        let wanted = dense.cholesky().expect("the diagonal dominates").solve(&right);
        let mut x = right.as_slice().to_vec();
        factor.solve(&mut x);
        prop_assert!((DVector::from_vec(x) - &wanted).amax() < 1e-11);
        // The square of L⁻¹ b is b A⁻¹ b, also of a right side of a single entry.
        for b in [right, DVector::from_fn(count * size, |i, _| f64::from(u8::from(i == count * size / 2)))] {
            let mut y = factor.permuted(b.as_slice());
            factor.solve_lower(&mut y);
            let mut x = b.as_slice().to_vec();
            factor.solve(&mut x);
            let square: f64 = y.iter().map(|y| y * y).sum();
            prop_assert!((square - b.dot(&DVector::from_vec(x))).abs() < 1e-11);
        }
        let names: Vec<f64> = (0..count * size).map(|i| i as f64).collect();
        prop_assert_eq!(factor.restored(&factor.permuted(&names)), names);
    }

    /// The number of negative eigenvalues, by nalgebra's eigenvalues, of matrices that are not definite.
    #[test]
    fn negative_pivots_are_as_many_as_negative_eigenvalues(
        count in 1usize..15, size in 1usize..4,
        edges in proptest::collection::vec((0usize..15, 0usize..15), 0..40),
        numbers in proptest::collection::vec(-1.0f64..1.0, 150), lower in 0.0f64..4.0,
    ) {
        let edges: Vec<(usize, usize)> = edges.iter().map(|(a, b)| (a % count, b % count)).collect();
        let (dense, sparse) = matrix(count, size, &edges, &numbers, -lower);
        let eigenvalues = dense.symmetric_eigenvalues();
        prop_assume!(eigenvalues.iter().all(|value| value.abs() > 1e-6));
        let wanted = eigenvalues.iter().filter(|value| **value < 0.0).count();
        prop_assert!(sparse.indefinite().is_none_or(|found| found.negative_pivots() == wanted));
    }

    #[test]
    fn the_order_has_every_row_once(
        n in 1usize..40, edges in proptest::collection::vec((0usize..40, 0usize..40), 0..90),
    ) {
        let list = neighbours(n, edges.iter().map(|(a, b)| (a % n, b % n)));
        for mut order in [minimum_degree(&list), nested_dissection(&list)] {
            order.sort_unstable();
            prop_assert_eq!(order, (0..n).collect::<Vec<_>>());
        }
    }
}

/// Full matrices, of one supernode, and arrows, whose last rows every column changes: columns and rows in all numbers beside
/// those that a processor handles together.
#[test]
fn full_matrices_and_arrows_are_solved_as_nalgebra_does() {
    let numbers: Vec<f64> = (0..97).map(|i| libm::sin(f64::from(i * i))).collect();
    for (count, size) in (1..40).map(|count| (count, 1)).chain([(17, 2), (21, 3)]) {
        let full = (0..count).flat_map(|a| (0..a).map(move |b| (a, b)));
        let tips = count.min(5);
        let arrow = (tips..count).flat_map(|a| (0..tips).map(move |b| (a, b)));
        for edges in [full.collect::<Vec<_>>(), arrow.collect()] {
            let (dense, sparse) = matrix(count, size, &edges, &numbers, 0.5);
            let right = DVector::from_fn(count * size, |i, _| numbers[i % 97]);
            let mut x = right.as_slice().to_vec();
            sparse.cholesky(PivotRule::Refuse(1e-14)).expect("the diagonal dominates").solve(&mut x);
            let wanted = dense.cholesky().expect("the diagonal dominates").solve(&right);
            assert!((DVector::from_vec(x) - wanted).amax() < 1e-12, "{count} blocks of {size}");
        }
    }
}

/// The edges of a lattice of cubes with one diagonal in each square across the last axis, and of a second one beside it if `twice`.
fn lattice([width, depth, height]: [usize; 3], twice: bool) -> (usize, Vec<(usize, usize)>) {
    let count = width * depth * height;
    let at = |x: usize, y: usize, z: usize| (x * depth + y) * height + z;
    let mut edges = Vec::new();
    for (x, y, z) in (0..count).map(|i| (i / height / depth, i / height % depth, i % height)) {
        let next = [(x + 1, y, z), (x, y + 1, z), (x, y, z + 1), (x + 1, y + 1, z)];
        let inside = next.into_iter().filter(|&(a, b, c)| a < width && b < depth && c < height);
        edges.extend(inside.map(|(a, b, c)| (at(x, y, z), at(a, b, c))));
    }
    if twice {
        let second: Vec<(usize, usize)> = edges.iter().map(|(a, b)| (a + count, b + count)).collect();
        edges.extend(second);
    }
    (if twice { 2 * count } else { count }, edges)
}

/// Matrices so large that two threads decompose them, in one piece and in two: as nalgebra does, with as many negative pivots as
/// eigenvalues, refused wherever the pivot is that is not positive, and with the same bits whether the second thread is free or not.
#[test]
fn large_matrices_are_shared_by_two_threads() {
    let numbers: Vec<f64> = (0..97).map(|i| libm::sin(f64::from(i * i))).collect();
    for (sides, twice) in [([7, 7, 7], false), ([12, 6, 5], false), ([6, 6, 6], true)] {
        let (count, edges) = lattice(sides, twice);
        let (mut dense, sparse) = matrix(count, 3, &edges, &numbers, 0.5);
        assert!(SymbolicFactor::new(3, &neighbours(count, edges.iter().copied())).is_shared(), "{sides:?}");
        let right = DVector::from_fn(3 * count, |i, _| numbers[i % 97]);
        let solved = |sparse: &SparseMatrix| {
            let mut x = right.as_slice().to_vec();
            sparse.clone().cholesky(PivotRule::Refuse(1e-14)).expect("the diagonal dominates").solve(&mut x);
            x
        };
        let x = solved(&sparse);
        // Other tests may have the second thread for a while.
        for _ in 0..5 {
            let (_, alone) = second_thread::both(|| (), || solved(&sparse));
            assert_eq!(x, alone);
            assert_eq!(x, solved(&sparse));
        }
        let wanted = dense.clone().cholesky().expect("the diagonal dominates").solve(&right);
        assert!((DVector::from_vec(x) - wanted).amax() < 1e-12, "{sides:?}");
        // Diagonal entries far below zero here and there, first one at a time, then together.
        let mut low = sparse.clone();
        for row in [0, count, 3 * count / 2, 3 * count - 1] {
            let mut one = sparse.clone();
            one.add(row, row, -100.0);
            assert!(one.clone().cholesky(PivotRule::Refuse(1e-14)).is_none(), "{row} of {sides:?}");
            assert_eq!(
                one.indefinite().expect("no pivot is small").negative_pivots(),
                1,
                "{row} of {sides:?}"
            );
            low.add(row, row, -100.0);
            dense[(row, row)] -= 100.0;
        }
        let negative = dense.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count();
        assert_eq!(low.indefinite().expect("no pivot is small").negative_pivots(), negative, "{sides:?}");
    }
}

#[test]
fn what_is_not_positive_definite_is_refused_or_raised() {
    let (_, sparse) = matrix(3, 2, &[(0, 1), (1, 2)], &[0.5, -0.3, 0.8], -3.0);
    assert!(sparse.clone().cholesky(PivotRule::Refuse(1e-14)).is_none());
    assert!(sparse.clone().cholesky(PivotRule::Raise(1e-6)).is_some());
    assert!(sparse.indefinite().expect("none is zero").negative_pivots() > 0);
}

/// A tree has an order without fill; of a cube of nodes the order takes less than half of the work of a narrow band.
#[test]
fn the_order_fills_little() {
    // A star, whose middle comes first by its number.
    let star = neighbours(30, (1..30).map(|i| (0, i)));
    let symbolic = SymbolicFactor::new(1, &star);
    assert!(symbolic.work() < 29 * 4 + 30, "{}", symbolic.work());
    let along = 9;
    let at = |x: usize, y: usize, z: usize| (x * along + y) * along + z;
    let mut edges = Vec::new();
    for x in 0..along {
        for y in 0..along {
            for z in 0..along - 1 {
                edges.extend([(at(x, y, z), at(x, y, z + 1)), (at(x, z, y), at(x, z + 1, y))]);
                edges.push((at(z, x, y), at(z + 1, x, y)));
            }
        }
    }
    let list = neighbours(along * along * along, edges.iter().copied());
    let little = SymbolicFactor::new(1, &list).work();
    let band = SymbolicFactor::in_order(1, &list, &reverse_order(list.len(), edges.into_iter())).work();
    assert!(2 * little < band, "{little} and {band}");
    // Cut into parts that do not hang together, every row still comes once.
    let mut twice = list.clone();
    twice.extend(list.iter().map(|near| near.iter().map(|other| other + list.len()).collect::<Vec<_>>()));
    let mut order = nested_dissection(&twice);
    let apart = SymbolicFactor::in_order(1, &twice, &order).work();
    assert!(apart <= 2 * little + little / 10, "{apart} and twice {little}");
    order.sort_unstable();
    assert_eq!(order, (0..twice.len()).collect::<Vec<_>>());
}
