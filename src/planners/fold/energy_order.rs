//! Dynamic programming for the order of folding of least energy: mean torques of the moving joints, without
//! gravity.
//!
//! The energy that hinge a spends on face m depends only on which hinges between them have folded before, so
//! on the order of m's own path. Going down the tree, each face is put at every index of its ancestors'
//! order; orders that agree on their common ancestors can always be merged.

use super::inertia::{Inertia, moment_in};
use super::kinematics::about;
use super::layout::Layout;
use super::target::Target;
use super::weights::QUINTIC;
use crate::geometry::Pose;

/// The greatest number of hinges on a path from the root of a layout that [`least_energy`] searches: the work grows
/// with its factorial.
pub const HEIGHT_MAX: usize = 8;

/// Returns (order, energy): an order of all faces but the root (indices in [`Target::faces`]) of least energy without
/// gravity, with the moving joint counted, and that energy (N·m for steps of one second); `None` for trees that are
/// higher than [`HEIGHT_MAX`]. `masses`: by face, kg. The method is dynamic programming over the orders on each face's
/// path. `target` and `layout`: the surface and how it is unfolded; `inertia`: how the mass of a panel is spread.
pub fn least_energy(
    target: &Target,
    layout: &Layout,
    masses: &[f64],
    inertia: Inertia,
) -> Option<(Vec<usize>, f64)> {
    let children = layout.children();
    if layout.depths().into_iter().max().unwrap_or(0) > HEIGHT_MAX {
        return None;
    }
    let costs = layout.order.iter().map(|&face| (face, Costs::new(target, layout, masses, inertia, face)));
    let mut by_face: Vec<Option<Costs>> = vec![None; target.faces.len()];
    costs.for_each(|(face, costs)| by_face[face] = Some(costs));
    let search = Search { children: &children, costs: &by_face };
    let branches = children[layout.root].iter().map(|&child| search.below(child, &[]));
    let mut all = (Vec::new(), 0.0);
    for (order, energy) in branches {
        all.0.extend(order);
        all.1 += energy;
    }
    Some(all)
}

/// Returns the energy of an order of faces (indices in [`Target::faces`], one hinge after the other) without gravity,
/// with the moving joint counted, N·m for steps of one second; `masses`: by face, kg. `target` and `layout`: the
/// surface and how it is unfolded; `inertia`: how the mass of a panel is spread. Panics if the order names the root.
pub fn energy(target: &Target, layout: &Layout, masses: &[f64], inertia: Inertia, order: &[usize]) -> f64 {
    means(target, layout, masses, inertia, order).iter().sum()
}

/// Returns the mean absolute torque of the hinge of every face while it folds, N·m for steps of one second, by face;
/// 0 for the root and for faces that `order` leaves out. The hinges fold one after the other in `order` (indices in
/// [`Target::faces`]), without gravity; poses are computed anew for each. `masses`: by face, kg. `target` and
/// `layout`: the surface and how it is unfolded; `inertia`: how the mass of a panel is spread. Panics if the order
/// names the root.
pub fn means(
    target: &Target,
    layout: &Layout,
    masses: &[f64],
    inertia: Inertia,
    order: &[usize],
) -> Vec<f64> {
    let mut folded = vec![false; target.faces.len()];
    let mut means = vec![0.0; target.faces.len()];
    for &face in order {
        let hinge = &target.hinges[layout.hinge[face].expect("the root does not fold")];
        // Before the step, seen from the pose of the parent.
        let poses = super::kinematics::poses(target, layout, |f| folded[f]);
        let parent = poses[layout.parent[face]];
        let point = parent.transform_point(&hinge.point.into()).coords;
        let axis = parent.rotation * hinge.axis;
        for below in (0..folded.len()).filter(|&below| layout.is_above(face, below)) {
            let corners = target.corners(below);
            let moment = moment_in(&poses[below], corners, masses[below], inertia, &point, &axis);
            means[face] += QUINTIC * hinge.angle.abs() * moment;
        }
        folded[face] = true;
    }
    means
}

/// The costs of the hinges of a face's path for that face.
#[derive(Clone)]
struct Costs {
    /// The costs by index in the path, from the root's child on; then by which of the later hinges of the
    /// path have folded, bit by bit.
    tables: Vec<Vec<f64>>,
}

impl Costs {
    /// Computes the costs of a face.
    fn new(target: &Target, layout: &Layout, masses: &[f64], inertia: Inertia, face: usize) -> Costs {
        let mut path = Vec::new();
        let mut at = face;
        while at != layout.root {
            path.push(at);
            at = layout.parent[at];
        }
        // From the face up: the positions of the face seen from each hinge of its path.
        let mut places = vec![Pose::identity()];
        let mut tables = Vec::new();
        for &above in &path {
            let hinge = &target.hinges[layout.hinge[above].expect("the root is not on the path")];
            let axis = hinge.axis_from(layout.parent[above]);
            let cost = |place: &Pose| {
                let corners = target.corners(face);
                let moment = moment_in(place, corners, masses[face], inertia, &hinge.point, &axis);
                QUINTIC * hinge.angle.abs() * moment
            };
            tables.push(places.iter().map(cost).collect());
            // The hinge nearest to the root becomes the lowest bit.
            let level = about(&hinge.point, axis, -hinge.angle);
            places = places.iter().flat_map(|place| [level * place, *place]).collect();
        }
        tables.reverse();
        Costs { tables }
    }

    /// Returns the cost of an order; `order`: the indices in the path, in order of folding.
    fn of(&self, order: &[usize]) -> f64 {
        let mut folded = 0usize;
        let mut sum = 0.0;
        for &place in order {
            sum += self.tables[place][folded >> (place + 1)];
            folded |= 1 << place;
        }
        sum
    }
}

struct Search<'s> {
    children: &'s [Vec<usize>],
    costs: &'s [Option<Costs>],
}

impl Search<'_> {
    /// Returns the best order of a face and all below it, given the order of its ancestors, by their indices
    /// in the path. The result names faces below and, in their order, nothing of the ancestors.
    fn below(&self, face: usize, ancestors: &[usize]) -> (Vec<usize>, f64) {
        let (slots, energy) = self.slots(face, ancestors);
        (slots.into_iter().flatten().collect(), energy)
    }

    /// Returns the best order sorted into what folds before the first ancestor, between the first and the second,
    /// and so on: one list more than there are ancestors.
    fn slots(&self, face: usize, ancestors: &[usize]) -> (Vec<Vec<usize>>, f64) {
        crate::interrupt::checkpoint();
        let own = ancestors.len();
        let costs = self.costs[face].as_ref().expect("costs of all faces were computed");
        let mut best: Option<(Vec<Vec<usize>>, f64)> = None;
        for place in (0..=own).rev() {
            let mut order = ancestors.to_vec();
            order.insert(place, own);
            let mut energy = costs.of(&order);
            let mut slots: Vec<Vec<usize>> = vec![Vec::new(); own + 2];
            for &child in &self.children[face] {
                let (below, more) = self.slots(child, &order);
                energy += more;
                slots.iter_mut().zip(below).for_each(|(slot, faces)| slot.extend(faces));
            }
            if best.as_ref().is_none_or(|(_, least)| energy < *least) {
                // Faces that fold just before and just after this one are between the same two ancestors.
                let after = slots.remove(place + 1);
                slots[place].push(face);
                slots[place].extend(after);
                best = Some((slots, energy));
            }
        }
        best.expect("there is at least one place")
    }
}
