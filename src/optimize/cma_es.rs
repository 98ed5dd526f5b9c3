//! CMA-ES, the evolution strategy with covariance matrix adaptation, with active (negative) weights: Hansen, "The CMA
//! Evolution Strategy: A Tutorial", arXiv:1604.00772v2 (2023), whose equations the comments name.

use super::random::SplitMix64;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The ratio of the greatest to the least eigenvalue of the covariance matrix, above which it is taken for degenerate.
const CONDITION_MAX: f64 = 1e14;
/// The standard deviation, as a part of the initial step size, below which all coordinates count as converged.
const STEP_MIN: f64 = 1e-12;

/// A search by CMA-ES: it asks for the values of an objective at the points of a generation, and is told them. The same
/// seed and values give the same points.
///
/// ```
/// let mut search = modl::optimize::CmaEs::new(vec![0.8; 3], 0.3, &[0.0; 3], 1, None);
/// let mut least = f64::INFINITY;
/// for _ in 0..100 {
///     let points = search.ask();
///     let values: Vec<f64> = points.iter().map(|x| x.iter().map(|x| x * x).sum()).collect();
///     least = values.iter().copied().fold(least, f64::min);
///     search.tell(&points, &values);
/// }
/// assert!(least < 1e-10);
/// ```
#[derive(Clone, Debug)]
pub struct CmaEs {
    weights: Weights,
    random: SplitMix64,
    mean: DVector<f64>,
    /// The overall standard deviation σ.
    sigma: f64,
    sigma_start: f64,
    /// The least standard deviation of each coordinate.
    least: DVector<f64>,
    covariance: DMatrix<f64>,
    /// The eigenvectors of the covariance matrix, one a column.
    axes: DMatrix<f64>,
    /// The square roots of its eigenvalues.
    lengths: DVector<f64>,
    /// The evolution path of the step size, p_σ.
    path_sigma: DVector<f64>,
    /// The evolution path of the covariance, p_c.
    path_c: DVector<f64>,
    generation: u32,
    degenerate: bool,
}

/// The recombination weights and learning rates, Table 1 of the tutorial.
#[derive(Clone, Debug)]
struct Weights {
    /// The weights by rank; those of the worse half are negative.
    by_rank: Vec<f64>,
    /// The variance-effective size of the selection, μ_eff.
    effective: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// The expected length of a standard normal vector.
    chi: f64,
}

impl Weights {
    /// Returns the default weights for `n` coordinates and populations of `lambda` points.
    fn new(n: usize, lambda: usize) -> Weights {
        let dimension = n as f64;
        // Eq. 49.
        let raw: Vec<f64> =
            (1..=lambda).map(|i| libm::log((lambda as f64 + 1.0) / 2.0) - libm::log(i as f64)).collect();
        let mu = lambda / 2;
        let square = |sum: f64| sum * sum;
        let effective_of = |raw: &[f64]| {
            square(raw.iter().sum()) / raw.iter().map(|w| w * w).sum::<f64>().max(f64::MIN_POSITIVE)
        };
        let (effective, effective_minus) = (effective_of(&raw[..mu]), effective_of(&raw[mu..]));
        let c_1 = 2.0 / (square(dimension + 1.3) + effective);
        let c_mu = (2.0 * (0.25 + effective + 1.0 / effective - 2.0) / (square(dimension + 2.0) + effective))
            .min(1.0 - c_1);
        // Eqs. 50 to 53.
        let alpha = (1.0 + c_1 / c_mu)
            .min(1.0 + 2.0 * effective_minus / (effective + 2.0))
            .min((1.0 - c_1 - c_mu) / (dimension * c_mu));
        let plus: f64 = raw.iter().filter(|w| **w > 0.0).sum();
        let minus: f64 = raw.iter().filter(|w| **w < 0.0).map(|w| -w).sum();
        let by_rank = raw.iter().map(|w| if *w >= 0.0 { w / plus } else { w * alpha / minus }).collect();
        let c_sigma = (effective + 2.0) / (dimension + effective + 5.0);
        let slack = ((effective - 1.0) / (dimension + 1.0)).max(0.0).sqrt() - 1.0;
        let d_sigma = 1.0 + 2.0 * slack.max(0.0) + c_sigma;
        let c_c = (4.0 + effective / dimension) / (dimension + 4.0 + 2.0 * effective / dimension);
        let chi = dimension.sqrt() * (1.0 - 1.0 / (4.0 * dimension) + 1.0 / (21.0 * dimension * dimension));
        Weights { by_rank, effective, c_sigma, d_sigma, c_c, c_1, c_mu, chi }
    }
}

impl CmaEs {
    /// Returns a search that begins at `mean` with the standard deviation `sigma` in every coordinate. `least`: for each
    /// coordinate the standard deviation below which it does not fall, 0 for none: values that are told apart only in
    /// steps need one. `seed`: that of the random numbers; `population`: the number of points of a generation, 4 + 3 ln n
    /// for `None`, at least 4. Panics if there are no coordinates, or `least` has another length.
    pub fn new(mean: Vec<f64>, sigma: f64, least: &[f64], seed: u64, population: Option<usize>) -> CmaEs {
        let n = mean.len();
        assert!(n > 0 && least.len() == n, "each coordinate has a mean and a least deviation");
        let usual = 4 + (3.0 * libm::log(n as f64)).floor() as usize;
        let lambda = population.unwrap_or(usual).max(4);
        CmaEs {
            weights: Weights::new(n, lambda),
            random: SplitMix64(seed),
            mean: DVector::from_vec(mean),
            sigma,
            sigma_start: sigma,
            least: DVector::from_column_slice(least),
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
            path_sigma: DVector::zeros(n),
            path_c: DVector::zeros(n),
            generation: 0,
            degenerate: false,
        }
    }

    /// Returns the number of points of a generation.
    pub fn population(&self) -> usize {
        self.weights.by_rank.len()
    }

    /// Returns the points of the next generation, drawn from the present distribution (eqs. 38 to 40).
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        (0..self.population()).map(|_| self.draw()).collect()
    }

    fn draw(&mut self) -> Vec<f64> {
        let n = self.mean.len();
        let normal = DVector::from_fn(n, |_, _| self.normal());
        let step = &self.axes * normal.component_mul(&self.lengths);
        (&self.mean + step * self.sigma).as_slice().to_vec()
    }

    /// Returns a standard normal number, by Marsaglia's polar method.
    fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (self.random.next_signed(), self.random.next_signed());
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                return u * (-2.0 * libm::log(s) / s).sqrt();
            }
        }
    }

    /// Takes the values of the objective at the points of a generation, of which the least is best, and moves the
    /// distribution. `points`: those that [`ask`](Self::ask) gave, or others instead of them; `values`: infinite, or
    /// not a number, for those without a value, which count as the worst. Points of equal value rank in their order.
    /// Panics if there is not one value for each point of a whole generation.
    pub fn tell(&mut self, points: &[Vec<f64>], values: &[f64]) {
        let lambda = self.population();
        assert!(points.len() == lambda && values.len() == lambda, "a whole generation is told");
        self.generation += 1;
        let value = |i: usize| if values[i].is_nan() { f64::INFINITY } else { values[i] };
        let mut order: Vec<usize> = (0..lambda).collect();
        order.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
        let steps: Vec<DVector<f64>> = order
            .iter()
            .map(|i| (DVector::from_column_slice(&points[*i]) - &self.mean) / self.sigma)
            .collect();
        let n = self.mean.len();
        let w = &self.weights;
        // Selection and recombination, eqs. 41 and 42.
        let mut step = DVector::zeros(n);
        for (y, weight) in steps.iter().zip(&w.by_rank).filter(|(_, weight)| **weight > 0.0) {
            step += y * *weight;
        }
        self.mean += &step * self.sigma;
        // Control of the step size, eqs. 43 and 44.
        let whitened = self.whitened(&step);
        let keep = 1.0 - w.c_sigma;
        self.path_sigma =
            &self.path_sigma * keep + whitened * (w.c_sigma * (2.0 - w.c_sigma) * w.effective).sqrt();
        let length = self.path_sigma.norm();
        // Adaptation of the covariance, eqs. 45 to 47.
        let forgotten = 1.0 - libm::pow(keep, 2.0 * f64::from(self.generation));
        let stalled = length / forgotten.sqrt() >= (1.4 + 2.0 / (n as f64 + 1.0)) * w.chi;
        let heaviside = if stalled { 0.0 } else { 1.0 };
        self.path_c =
            &self.path_c * (1.0 - w.c_c) + &step * (heaviside * (w.c_c * (2.0 - w.c_c) * w.effective).sqrt());
        let missing = (1.0 - heaviside) * w.c_c * (2.0 - w.c_c);
        let total: f64 = w.by_rank.iter().sum();
        let mut covariance = &self.covariance * (1.0 + w.c_1 * missing - w.c_1 - w.c_mu * total)
            + &self.path_c * self.path_c.transpose() * w.c_1;
        for (y, weight) in steps.iter().zip(&w.by_rank) {
            let scaled = if *weight >= 0.0 {
                *weight
            } else {
                weight * n as f64 / self.whitened(y).norm_squared().max(f64::MIN_POSITIVE)
            };
            covariance += y * y.transpose() * (w.c_mu * scaled);
        }
        self.covariance = (&covariance + covariance.transpose()) * 0.5;
        self.sigma *= libm::exp((w.c_sigma / w.d_sigma * (length / w.chi - 1.0)).min(1.0));
        self.decompose();
        self.keep_least();
    }

    /// Returns C^(-1/2) times a vector.
    fn whitened(&self, y: &DVector<f64>) -> DVector<f64> {
        &self.axes * (self.axes.transpose() * y).component_div(&self.lengths)
    }

    /// Takes the covariance matrix apart into axes and lengths.
    fn decompose(&mut self) {
        let parts = SymmetricEigen::new(self.covariance.clone());
        let (least, greatest) = (parts.eigenvalues.min(), parts.eigenvalues.max());
        let sound = least > 0.0 && greatest / least <= CONDITION_MAX && self.sigma.is_finite();
        self.degenerate = !sound;
        if sound {
            self.lengths = parts.eigenvalues.map(f64::sqrt);
            self.axes = parts.eigenvectors;
        }
    }

    /// Raises the variances of coordinates whose standard deviation fell below the least one.
    fn keep_least(&mut self) {
        let mut raised = false;
        for i in 0..self.mean.len() {
            let deviation = self.sigma * self.covariance[(i, i)].sqrt();
            if deviation < self.least[i] {
                let wanted = self.least[i] / self.sigma;
                self.covariance[(i, i)] = wanted * wanted;
                raised = true;
            }
        }
        if raised {
            self.decompose();
        }
    }

    /// Returns true once the distribution tells no points apart any more, or has become degenerate: another search has
    /// to begin.
    pub fn is_done(&self) -> bool {
        let free = self.least.iter().any(|least| *least == 0.0);
        let widest = (0..self.mean.len()).map(|i| self.covariance[(i, i)].sqrt()).fold(0.0, f64::max);
        self.degenerate || free && self.sigma * widest < STEP_MIN * self.sigma_start
    }
}
