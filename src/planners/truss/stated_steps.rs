//! Steps that are stated, not searched: nodes of a truss that go straight to given places, timed by the struts.

use super::motion::{Findings, Move, TimeLaw, timed};
use super::problem::{InvalidTruss, TrussProblem};
use super::structure::{Limits, Structure};
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::plan::{Keyframe, Margins, NodePaths, Topology, World};
use crate::robot::Strut;

/// Returns the motion of a truss from where a plan of it ends, with the topology of that moment: the nodes in `to`, by their
/// index in the plan, go straight to their places (m), all others stay, and nodes that ride along go with those that carry
/// them. The motion is cut into `steps` steps of one length, each from rest to rest in the least time that the struts allow,
/// as those of other planners; in a `world` with weight the forces of acceleration are borne, too. It states no margins.
///
/// # Errors
/// [`InvalidTruss`] for a truss without struts, or with a strut that has no length.
pub fn stated_steps(
    (paths, strut): (&NodePaths, &Strut),
    world: World,
    to: &[(usize, Vec3)],
    steps: usize,
) -> Result<NodePaths, InvalidTruss> {
    let topology = paths.topology_at_end();
    let free = topology.free_nodes();
    let own = |node: usize| free.binary_search(&topology.carrier(node)).unwrap_or_default();
    let end = paths.state(paths.duration());
    let start: Vec<Vec3> = free.iter().map(|&node| Vec3::from(end[node])).collect();
    let problem = TrussProblem {
        strut: strut.clone(),
        node_names: free.iter().map(|&node| paths.node_names[node].clone()).collect(),
        nodes: start.clone(),
        struts: topology.struts.iter().map(|&(a, b)| (own(a), own(b))).collect(),
        limits: Limits::default(),
        obstacles: Vec::new(),
        terrain: paths.surroundings.terrain.clone(),
        friction: world.friction,
    };
    let truss = weighing(&problem, (&topology, &free), world)?;
    let mut goal = start.clone();
    to.iter().for_each(|&(node, place)| goal[own(node)] = place);
    let part = |step: usize| step as f64 / steps as f64;
    let between = |step: usize| -> Vec<Vec3> {
        // The last place is the goal itself.
        if step == steps {
            return goal.clone();
        }
        start.iter().zip(&goal).map(|(p, q)| p + (q - p) * part(step)).collect()
    };
    let moves: Vec<Move> = (1..=steps).map(|step| Move::Linear(between(step), Findings::default())).collect();
    let timed = timed(&truss, &start, &moves, TimeLaw::default(), |_, _| Margins::default());
    let everywhere = |keyframe: Keyframe| Keyframe {
        nodes: (0..paths.node_names.len()).map(|node| keyframe.nodes[own(node)]).collect(),
        ..keyframe
    };
    Ok(NodePaths {
        struts: topology.struts.clone(),
        merged: topology.riders(),
        keyframes: timed.into_iter().map(everywhere).collect(),
        events: Vec::new(),
        ..paths.clone()
    })
}

/// Returns the structure of a truss whose nodes carry those that ride along with them: the free nodes of a topology, with
/// forces as a limit where the world has weight.
fn weighing(
    problem: &TrussProblem,
    (topology, free): (&Topology, &[usize]),
    world: World,
) -> Result<Structure, InvalidTruss> {
    let truss = problem.structure(Tolerances::DEFAULT)?;
    let node_mass = problem.strut.node_mass.unwrap_or(0.0);
    let mut masses = problem.strut.node_masses(problem.nodes.len(), &problem.struts);
    for (node, _) in topology.riders() {
        if let Ok(own) = free.binary_search(&topology.carrier(node)) {
            masses[own] += node_mass;
        }
    }
    let mut forces = problem.weight();
    for (load, mass) in forces.loads.iter_mut().zip(&masses) {
        *load = Vec3::new(0.0, 0.0, -mass * world.gravity);
    }
    let forces = (world.floor_bears()).then_some(forces);
    let mass: f64 = masses.iter().sum();
    let mass_fractions = masses.into_iter().map(|own| own / mass).collect();
    let limits = Limits { forces, ..truss.limits.clone() };
    Ok(Structure { mass, mass_fractions, limits, ..truss })
}
