//! Quadratic programmes against all sets of active rows: of the points at which some rows hold as
//! equalities, the optimum is the best that keeps all.

use modl::optimize::{QuadraticProgram, Unsolved};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const N: usize = 4;
const ROWS: usize = 6;

#[derive(Debug)]
struct Case {
    hessian: DMatrix<f64>,
    linear: DVector<f64>,
    rows: DMatrix<f64>,
    right: DVector<f64>,
}

impl Case {
    fn value(&self, x: &DVector<f64>) -> f64 {
        0.5 * x.dot(&(&self.hessian * x)) + self.linear.dot(x)
    }

    /// Returns true if x keeps all rows, up to rounding: where rows are nearly parallel, x is far away.
    fn keeps(&self, x: &DVector<f64>) -> bool {
        (&self.rows * x - &self.right).iter().all(|over| *over <= 1e-9 * (1.0 + x.norm()))
    }

    /// By trying every set of rows.
    fn best(&self) -> Option<DVector<f64>> {
        let mut best: Option<DVector<f64>> = None;
        let many = self.rows.nrows();
        for set in 0..1usize << many {
            let chosen: Vec<usize> = (0..many).filter(|row| set >> row & 1 == 1).collect();
            let size = N + chosen.len();
            let mut matrix = DMatrix::zeros(size, size);
            let mut right = DVector::zeros(size);
            matrix.view_mut((0, 0), (N, N)).copy_from(&self.hessian);
            right.rows_mut(0, N).copy_from(&-&self.linear);
            for (k, &row) in chosen.iter().enumerate() {
                for i in 0..N {
                    matrix[(N + k, i)] = self.rows[(row, i)];
                    matrix[(i, N + k)] = self.rows[(row, i)];
                }
                right[N + k] = self.right[row];
            }
            let Some(solution) = matrix.lu().solve(&right) else { continue };
            let x = solution.rows(0, N).into_owned();
            if self.keeps(&x) && best.as_ref().is_none_or(|known| self.value(&x) < self.value(known)) {
                best = Some(x);
            }
        }
        best
    }

    fn programme(&self) -> QuadraticProgram {
        let entry = |i: usize, j: usize| (i, j, self.hessian[(i, j)]);
        let above = (0..N).flat_map(|i| (i..N).map(move |j| (i, j)));
        QuadraticProgram::new(
            above.map(|(i, j)| entry(i, j)).collect(),
            self.linear.iter().copied().collect(),
            1e-10,
        )
    }

    fn row(&self, row: usize) -> (Vec<(usize, f64)>, f64) {
        ((0..N).map(|i| (i, self.rows[(row, i)])).collect(), self.right[row])
    }
}

fn cases() -> impl Strategy<Value = Case> {
    let numbers = proptest::collection::vec(-1.0f64..1.0, N * N + N + ROWS * N + ROWS);
    numbers.prop_map(|numbers| {
        let (root, rest) = numbers.split_at(N * N);
        let (linear, rest) = rest.split_at(N);
        let (rows, right) = rest.split_at(ROWS * N);
        let root = DMatrix::from_row_slice(N, N, root);
        Case {
            hessian: &root * root.transpose() + DMatrix::identity(N, N) * 0.1,
            linear: DVector::from_row_slice(linear),
            rows: DMatrix::from_row_slice(ROWS, N, rows),
            right: DVector::from_row_slice(right),
        }
    })
}

proptest! {
    #![proptest_config(crate::support::properties::cases(256))]

    /// All rows at once, and one after another, with a solution in between.
    #[test]
    fn the_best_of_all_sets_is_found(case in cases()) {
        let wanted = case.best();
        for grows in [false, true] {
            let mut programme = case.programme();
            let mut found = Ok(Vec::new());
            for row in 0..ROWS {
                let number = programme.at_most(case.row(row));
                if grows {
                    // Asked for less at first.
                    programme.set(number, case.right[row] + 0.5);
                    let _ = programme.solve();
                    programme.set(number, case.right[row]);
                    found = programme.solve();
                    if found.is_err() {
                        break;
                    }
                }
            }
            if !grows {
                found = programme.solve();
            }
            match (&wanted, found) {
                (Some(wanted), Ok(found)) => {
                    let found = DVector::from_vec(found);
                    // Rows that are nearly parallel meet far away, where a place says less than a value.
                    let (value, best) = (case.value(&found), case.value(wanted));
                    prop_assert!((value - best).abs() < 1e-6 * (1.0 + best.abs()), "{found} and not {wanted}");
                    let over = (&case.rows * &found - &case.right).max();
                    prop_assert!(over <= 1e-9 * (1.0 + found.norm()), "{found} is off by {over}");
                }
                (None, Err(Unsolved::Infeasible)) => {}
                (wanted, found) => prop_assert!(false, "{wanted:?} and {found:?}"),
            }
        }
    }

    /// The sum of absolute values is the greatest of the sums with all signs, so that the optimum is the best of those of the
    /// programs in which each is on one side. The first rows are the costs, the others hold; found at once, one after
    /// another, and from the sides of a program with another linear term.
    #[test]
    fn absolute_values_are_costs(case in cases()) {
        const COSTS: usize = 3;
        let value = |x: &DVector<f64>| {
            let off = &case.rows * x - &case.right;
            case.value(x) + (0..COSTS).map(|row| off[row].abs()).sum::<f64>()
        };
        let one_sided = (0..1usize << COSTS).filter_map(|signs| {
            let mut one = Case {
                hessian: case.hessian.clone(),
                linear: case.linear.clone(),
                rows: case.rows.clone(),
                right: case.right.clone(),
            };
            for row in 0..COSTS {
                let sign = if signs >> row & 1 == 1 { 1.0 } else { -1.0 };
                one.linear += case.rows.row(row).transpose() * sign;
                one.rows.row_mut(row).scale_mut(-sign);
                one.right[row] *= -sign;
            }
            one.best()
        });
        let wanted = one_sided.map(|x| value(&x)).min_by(f64::total_cmp);
        let with_costs = |case: &Case| {
            let mut programme = case.programme();
            (0..COSTS).for_each(|row| programme.absolute(case.row(row)));
            programme
        };
        let all = |mut programme: QuadraticProgram| {
            (COSTS..ROWS).for_each(|row| { programme.at_most(case.row(row)); });
            programme.solve()
        };
        let mut one_by_one = with_costs(&case);
        let mut grown = one_by_one.solve();
        for row in COSTS..ROWS {
            one_by_one.at_most(case.row(row));
            grown = one_by_one.solve();
            if grown.is_err() {
                break;
            }
        }
        let turned = Case {
            hessian: case.hessian.clone(),
            linear: &case.linear * -2.0,
            rows: case.rows.clone(),
            right: case.right.clone(),
        };
        let mut other = with_costs(&turned);
        let _ = other.solve();
        let mut begun = with_costs(&case);
        begun.begin(&other.sides());
        for found in [all(with_costs(&case)), grown, all(begun)] {
            match (wanted, found) {
                (Some(wanted), Ok(found)) => {
                    let found = DVector::from_vec(found);
                    prop_assert!((value(&found) - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "{found}: {} and not {wanted}", value(&found));
                    let over = (&case.rows * &found - &case.right).rows(COSTS, ROWS - COSTS).max();
                    prop_assert!(over <= 1e-9 * (1.0 + found.norm()), "{found} is off by {over}");
                }
                (None, Err(Unsolved::Infeasible)) => {}
                (wanted, found) => prop_assert!(false, "{wanted:?} and {found:?}"),
            }
        }
    }

    /// With an equality, the optimum is that of the plane.
    #[test]
    fn equalities_hold(case in cases()) {
        let mut programme = case.programme();
        programme.equal(case.row(0));
        programme.at_most(case.row(1));
        let Ok(found) = programme.solve() else { return Ok(()) };
        let x = DVector::from_vec(found);
        prop_assert!(((&case.rows * &x)[0] - case.right[0]).abs() < 1e-9);
        // No way along the plane that keeps the other row is downhill.
        let slope = &case.hessian * &x + &case.linear;
        for k in 0..40 {
            let d = DVector::from_fn(N, |i, _| libm::sin((7 * k + 3 * i) as f64 * 1.3));
            let row = case.rows.row(0).transpose();
            let along = &d - &row * (row.dot(&d) / row.norm_squared());
            let keeps = (&case.rows * (&x + &along * 1e-3))[1] <= case.right[1] + 1e-9;
            prop_assert!(!keeps || slope.dot(&along) > -1e-6 * along.norm());
        }
    }
}
