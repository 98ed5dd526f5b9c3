//! The paper's heuristic measure of a layout (MII, Theorem 1), cheaper than a simulation and kept for
//! comparison: the closed form of `weights` is exact and no costlier.

use super::enumerate::{self, TooManyFaces, Traversal};
use super::kinematics::poses;
use super::layout::Layout;
use super::target::Target;
use super::tolerances::TOLERANCES;

/// The constants of [Yao et al.](super)'s heuristic measure χ of a layout (their Method II, Theorem 1, Table 5).
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// The constant λ1 of Theorem 1 of [Yao et al.](super), the norm of a panel's inertia tensor, kg·m². Their
    /// 6.15e-11 amounts to none.
    pub inertia: f64,
    /// The constant λ2 of Theorem 1 of [Yao et al.](super), half the side divided by the sine of 60 degrees, times
    /// the mass, kg·m.
    pub arm: f64,
    /// The constant λ3 of Theorem 1 of [Yao et al.](super), the mass of a panel, kg.
    pub mass: f64,
    /// The constant λ4 of Theorem 1 of [Yao et al.](super), the distance from hinge to hinge, m; of
    /// [`Measure::of_panels`] the side.
    pub span: f64,
    /// The constants κ1, κ2 and κ3 of the design, without unit; 3, 1 and 2 in [Yao et al.](super).
    pub design: [f64; 3],
}

impl Measure {
    /// Returns [Yao et al.](super)'s constants (Table 5) for equal triangular panels of a mass (kg) and side (m).
    pub fn of_panels(mass: f64, side: f64) -> Measure {
        Measure {
            inertia: 6.15e-11,
            arm: side / 2.0 / libm::sqrt(0.75) * mass,
            mass,
            span: side,
            design: [3.0, 1.0, 2.0],
        }
    }

    /// Returns χ of a layout (Eq. 6, 9, 10 of [Yao et al.](super)) with the leaves folded first, kg·m²; less is
    /// better. `target`: the surface that the layout is of.
    ///
    /// Distances are from the root's centroid, at the beginning and at the end of the face's own step:
    /// everything below it has folded, nothing above it has.
    pub fn of(&self, target: &Target, layout: &Layout) -> f64 {
        let n = target.faces.len();
        let flat = poses(target, layout, |_| false);
        let [k1, k2, k3] = self.design;
        let (mut moments, mut forces) = (vec![0.0; n], vec![0.0; n]);
        let mut sum = 0.0;
        for &face in layout.order[1..].iter().rev() {
            let hinge = layout.hinge[face].expect("only the root has none");
            let angle = target.hinges[hinge].angle.abs();
            let parent = layout.parent[face];
            // While its parent is still where it lies flat.
            let root = target.centroid(layout.root);
            let centroid = target.centroid(face);
            let before = (flat[face] * nalgebra::Point3::from(centroid)).coords;
            let after = (flat[parent] * nalgebra::Point3::from(centroid)).coords;
            let moved = ((after - root).norm() - (before - root).norm()).abs();
            forces[face] += self.mass * k1 * moved;
            moments[face] += self.inertia * (k2 * angle + k3 * angle * angle) + self.arm * k1 * moved;
            sum += moments[face];
            moments[parent] += moments[face] + self.span * forces[face];
            forces[parent] += forces[face];
        }
        sum
    }
}

/// The result of [`preferred`]: the layout of least measure χ, with the number of ties and the extent of the search.
#[derive(Clone, Debug)]
pub struct Preferred {
    /// The first layout found of the least measure.
    pub layout: Layout,
    /// The measure χ of the layout ([`Measure::of`]), kg·m²; the least is preferred.
    pub measure: f64,
    /// The number of pairs of a layout and a root asked for with the least measure, up to ties.
    pub ties: u64,
    /// The extent of the enumeration: the layout is the best of those visited.
    pub walked: Traversal,
}

/// Searches for the layout of least measure among all with the root `root` (an index in [`Target::faces`]; `None`:
/// with any root), by enumeration of at most `budget` layouts, and at least one, each with every root asked for. Of
/// equal ones the first is returned. Panics if `root` is not a face of the target.
///
/// # Errors
/// [`TooManyFaces`] for targets of more than [`enumerate::FACES_MAX`] faces.
pub fn preferred(
    target: &Target,
    measure: &Measure,
    root: Option<usize>,
    budget: u64,
) -> Result<Preferred, TooManyFaces> {
    let mut best: Option<(f64, Layout)> = None;
    let mut ties = 0;
    let roots = root.map_or(0..target.faces.len(), |root| root..root + 1);
    let walked = enumerate::each(target, budget, |hinges| {
        for root in roots.clone() {
            let layout = Layout::of_hinges(target, hinges, root).expect("only trees are enumerated");
            let value = measure.of(target, &layout);
            match &best {
                Some((least, _)) if value > least * (1.0 + TOLERANCES.tie) => {}
                Some((least, _)) if value >= least * (1.0 - TOLERANCES.tie) => ties += 1,
                _ => {
                    best = Some((value, layout));
                    ties = 1;
                }
            }
        }
    })?;
    let (measure, layout) = best.expect("a connected target has a layout");
    Ok(Preferred { layout, measure, ties, walked })
}
