//! Footholds: a node is put down beyond an edge of the support polygon before the centre of mass gets there, so that the truss
//! need not fall over that edge.

use super::objective::cost;
use super::rollout::{Hold, Rollout};
use crate::geometry::Vec3;
use crate::planners::truss::step::{StepProblem, step};
use crate::planners::truss::support_polygon;

impl Rollout<'_> {
    /// Makes a step that lowers a node beyond an edge of the support polygon while the centre of mass stays,
    /// if the next step would bring the centre of mass near that edge. Returns false if there is no node to place.
    pub(super) fn place_node(&mut self, stride: [f64; 2]) -> bool {
        let (unit, foothold) = (self.truss.unit, self.settings.foothold);
        let contacts = support_polygon::contacts(self.truss, &self.x);
        // The node that was being placed is on the ground.
        if let Some((node, _)) = self.placing.filter(|(node, _)| contacts.contains(node)) {
            self.travel.footholds += 1;
            self.out_of_reach.clear();
            self.out_of_reach.push(node);
            self.placing = None;
            self.place_node_first = false;
        }
        // The edge that the centre of mass comes near to.
        let hull = support_polygon::hull(&self.x, &contacts);
        let ahead = self.truss.centre_of_mass(&self.x) + Vec3::new(stride[0], stride[1], 0.0);
        let Some((inside, (a, b))) = support_polygon::margin(&self.x, &hull, ahead) else { return false };
        if inside > foothold.trigger * unit {
            self.placing = None;
            return false;
        }
        // The lowest free node beyond it, unless one is being placed.
        let (from, along) = (self.x[a], (self.x[b] - self.x[a]).normalize());
        let beyond = |node: &usize| (self.x[*node] - from).cross(&along).z > foothold.beyond * unit;
        let open = (0..self.truss.nodes)
            .filter(|node| !contacts.contains(node) && !self.out_of_reach.contains(node) && beyond(node));
        let height = |node: &usize| self.truss.surroundings.height(self.x[*node]);
        let lowest = open.min_by(|i, j| height(i).total_cmp(&height(j)));
        let (node, tries) = match (self.placing, lowest) {
            (Some(placing), _) => placing,
            (None, Some(node)) => (node, 0),
            (None, None) => return false,
        };
        // A step that lowers it; else the next node.
        let step = if tries < foothold.steps_max { self.lower(node, &hull) } else { None };
        let Some(y) = step else {
            self.out_of_reach.push(node);
            self.placing = None;
            return self.place_node(stride);
        };
        self.placing = Some((node, tries + 1));
        self.travel.steps += 1;
        self.move_to(y);
        true
    }

    /// Returns the positions after a step that lowers a node; `None` if other limits hold it up.
    fn lower(&mut self, node: usize, hull: &[usize]) -> Option<Vec<Vec3>> {
        let weight = self.settings.foothold.weight;
        let down = self.truss.surroundings.height(self.x[node]).min(self.stride);
        let pace = self.stride / self.truss.unit;
        let mut cost = cost(self.policy.objective, self.truss, &self.x, pace);
        cost.hessian.push((3 * node + 2, 3 * node + 2, weight));
        cost.linear[3 * node + 2] += weight * down;
        let contacts = support_polygon::contacts(self.truss, &self.x);
        let pinned = match self.settings.hold {
            Hold::Three => {
                support_polygon::support_triangle(&self.x, hull, self.truss.centre_of_mass(&self.x))
            }
            Hold::All => contacts.clone(),
        };
        self.released(&mut cost, &contacts, &pinned);
        let problem = StepProblem {
            truss: self.truss,
            x: &self.x,
            cost: &cost,
            pinned: &pinned,
            centre_of_mass: &[(0, 0.0), (1, 0.0)],
            ground: true,
            displacement_max: f64::INFINITY,
            thorough: self.policy.thorough,
        };
        let y = step(&problem, &mut self.warm_start).ok()?;
        (self.keeps_its_feet(&y) && self.x[node].z - y[node].z > 0.1 * down).then_some(y)
    }
}
