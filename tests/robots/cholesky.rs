//! Cholesky's decomposition in the envelope against nalgebra's, and the order of Cuthill and McKee.

use modl::optimize::cholesky::{PivotRule, SymmetricMatrix, cholesky_work};
use modl::optimize::cuthill_mckee::{neighbours, reverse_order};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

proptest! {
    #![proptest_config(crate::support::properties::cases(100))]

    #[test]
    fn factors_and_solutions_are_those_of_nalgebra(
        n in 1usize..20, numbers in proptest::collection::vec(-1.0f64..1.0, 400), width in 1usize..20,
    ) {
        // A band matrix that its diagonal dominates, within an envelope that is no wider.
        let first: Vec<usize> = (0..n).map(|i| i.saturating_sub(width)).collect();
        let mut dense = DMatrix::zeros(n, n);
        let (mut full, mut band) = (SymmetricMatrix::dense(n), SymmetricMatrix::with_envelope(first.clone()));
        for i in 0..n {
            for j in first[i]..=i {
                let value = if i == j { n as f64 + numbers[i].abs() } else { numbers[20 * i + j] };
                (dense[(i, j)], dense[(j, i)]) = (value, value);
                full.add(i, j, value);
                band.add(i, j, value);
            }
        }
        prop_assert!((full.trace() - dense.trace()).abs() < 1e-12);
        prop_assert!(cholesky_work(&vec![0; n]) >= cholesky_work(&first));
        let right = DVector::from_iterator(n, numbers.iter().rev().copied().take(n));
        let truth = dense.clone().cholesky().expect("the diagonal dominates");
        let wanted = truth.solve(&right);
        for matrix in [full, band] {
            let factor = matrix.cholesky(PivotRule::Refuse(1e-14)).expect("positive definite");
            for i in 0..n {
                let (row, from) = (factor.lower().row(i), factor.lower().first(i));
                prop_assert!((from..=i).all(|j| (row[j - from] - truth.l_dirty()[(i, j)]).abs() < 1e-12));
            }
            let mut x = right.as_slice().to_vec();
            factor.solve(&mut x);
            prop_assert!((DVector::from_vec(x) - &wanted).amax() < 1e-12);
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused_or_damped(a in -1.0f64..1.0, b in -1.0f64..1.0) {
        // A product of a vector with itself has rank one.
        let matrix = || {
            let mut matrix = SymmetricMatrix::dense(2);
            matrix.add(0, 0, a * a);
            matrix.add(1, 0, a * b);
            matrix.add(1, 1, b * b);
            matrix
        };
        prop_assert!(matrix().cholesky(PivotRule::Refuse(1e-14)).is_none());
        let factor = matrix().cholesky(PivotRule::Raise(1e-6)).expect("raised");
        prop_assert!((0..2).all(|i| factor.lower().row(i)[i] >= 0.999e-3));
    }

    #[test]
    fn the_order_is_one_of_all_rows(n in 1usize..30, edges in proptest::collection::vec((0usize..30, 0usize..30), 0..60)) {
        let edges: Vec<(usize, usize)> = edges.iter().map(|(i, j)| (i % n, j % n)).collect();
        let mut order = reverse_order(n, edges.iter().copied());
        let list = neighbours(n, edges.iter().copied());
        prop_assert!((0..n).all(|i| list[i].iter().all(|&j| list[j].contains(&i) && i != j)));
        order.sort_unstable();
        prop_assert_eq!(order, (0..n).collect::<Vec<_>>());
    }
}

/// A path whose rows are numbered at random gets the band that it can have.
#[test]
fn a_path_has_a_band_of_one() {
    let names: Vec<usize> = (0..31).map(|i| i * 7 % 31).collect();
    let edges: Vec<(usize, usize)> = names.windows(2).map(|pair| (pair[0], pair[1])).collect();
    let order = reverse_order(31, edges.iter().copied());
    let at = |name: usize| order.iter().position(|row| *row == name).expect("every row is numbered");
    assert!(edges.iter().all(|&(i, j)| at(i).abs_diff(at(j)) == 1), "{order:?}");
}
