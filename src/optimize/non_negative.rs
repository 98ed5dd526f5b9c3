//! Strictly convex quadratic programs over variables that are free or not negative, by the active-set method of Lawson
//! and Hanson (*Solving Least Squares Problems*, 1974, ch. 23) on the normal equations, with a warm start.

use nalgebra::{DMatrix, DVector};

/// The part of the largest entry of the linear term by which a gradient may be negative at the optimum.
const GRADIENT: f64 = 1e-10;
/// The number of changes of the active set, for each variable, before the method gives up.
const CHANGES_MAX: usize = 6;

/// Returns the x that minimises `½ xᵀ H x + c·x` over `x_i ≥ 0` for every i that is not `free`, by the active-set
/// method of Lawson and Hanson (1974, ch. 23); `hessian` is H, symmetric positive definite, and `linear` c. `passive`
/// holds the variables that may be positive, as a guess on entry (those of the last solution), and of the solution on
/// return. `None` where H is not positive definite, or where the limit of changes of the active set is reached.
/// Panics unless all lengths agree.
pub fn solve_non_negative(
    hessian: &DMatrix<f64>,
    linear: &DVector<f64>,
    free: &[bool],
    passive: &mut Vec<bool>,
) -> Option<DVector<f64>> {
    let n = linear.len();
    assert!(hessian.nrows() == n && free.len() == n, "one row for each variable");
    if passive.len() != n {
        passive.clear();
        passive.resize(n, false);
    }
    passive.iter_mut().zip(free).for_each(|(passive, free)| *passive |= free);
    let tolerance = GRADIENT * linear.amax();
    let mut x = DVector::zeros(n);
    // A guess may be infeasible: its negative variables leave, the most negative first.
    for _ in 0..CHANGES_MAX * (n + 1) {
        let tried = on_passive(hessian, linear, passive)?;
        let negative = (0..n).filter(|&i| passive[i] && !free[i] && tried[i] <= 0.0);
        match negative.clone().next() {
            None => {
                x = tried;
                break;
            }
            Some(_) => negative.collect::<Vec<_>>().into_iter().for_each(|i| passive[i] = false),
        }
    }
    for _ in 0..CHANGES_MAX * (n + 1) {
        let gradient = hessian * &x + linear;
        let entering = (0..n)
            .filter(|&i| !passive[i] && gradient[i] < -tolerance)
            .min_by(|&a, &b| gradient[a].total_cmp(&gradient[b]));
        let Some(entering) = entering else { return Some(x) };
        passive[entering] = true;
        loop {
            let tried = on_passive(hessian, linear, passive)?;
            let block = (0..n)
                .filter(|&i| passive[i] && !free[i] && tried[i] <= 0.0)
                .map(|i| (i, x[i] / (x[i] - tried[i])))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((blocking, step)) = block else {
                x = tried;
                break;
            };
            let step = if step.is_finite() { step.clamp(0.0, 1.0) } else { 0.0 };
            x += (tried - &x) * step;
            x[blocking] = 0.0;
            passive[blocking] = false;
        }
    }
    None
}

/// Returns the minimum over the passive variables, with the others at 0; `None` where their Hessian is not positive
/// definite.
fn on_passive(hessian: &DMatrix<f64>, linear: &DVector<f64>, passive: &[bool]) -> Option<DVector<f64>> {
    let chosen: Vec<usize> = (0..passive.len()).filter(|&i| passive[i]).collect();
    let mut x = DVector::zeros(passive.len());
    if chosen.is_empty() {
        return Some(x);
    }
    let part = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| hessian[(chosen[i], chosen[j])]);
    let right = DVector::from_fn(chosen.len(), |i, _| -linear[chosen[i]]);
    let solved = part.cholesky()?.solve(&right);
    chosen.iter().zip(solved.iter()).for_each(|(&i, value)| x[i] = *value);
    Some(x)
}
