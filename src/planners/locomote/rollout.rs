//! The rollout of locomotion: the centre of mass along a path, step by step, and over the edge of the
//! support polygon where it gets there (sections IV.A to IV.C of the paper).

use super::landing::RESHAPING_MAX;
use super::objective::{Objective, cost};
use super::{detours, lookahead};
use crate::geometry::Vec3;
use crate::planners::Progress;
use crate::planners::truss::Structure;
use crate::planners::truss::constraint::Constraint;
use crate::planners::truss::motion::{Move, TimeLaw};
use crate::planners::truss::roll::{self, Equilibrium};
use crate::planners::truss::step::{QuadraticCost, StepError, StepProblem, WarmStart, step};
use crate::planners::truss::tolerances::Tolerances;
use crate::planners::truss::{forces, support_polygon};
use std::mem;

/// The greatest number of relaxed steps in a row.
const RELAXED_MAX: usize = 60;
/// The greatest number of relaxed steps in a row with lookahead, where other policies are known.
const RELAXED_MAX_LOOKAHEAD: usize = 3;
/// The contacts that keep their positions during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// Three nodes on the ground, those whose triangle holds the centre of mass with the greatest margin; others may
    /// slide or lift off.
    Three,
    /// All nodes on the ground keep their positions.
    #[default]
    All,
}

/// The settings of `locomote`. Lengths in "units" are multiples of the mean strut length at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The distance of the centre of mass, units, below which a point of the path is reached. Default 0.25: a path
    /// need not be met exactly, and a robot moves in jumps as it rolls over an edge.
    pub arrival_distance: f64,
    /// The distance that the centre of mass moves in one step, units. Default 0.05: the step of [Usevitch et
    /// al.](crate::planners::truss).
    pub stride: f64,
    /// The cost that each step minimises. Default [`Objective::RESTORING`], which under weight gets stuck the least; for large
    /// trusses [`Objective::usual`] has another, whose steps take less time.
    pub objective: Objective,
    /// The contacts that keep their positions during a step. Default [`Hold::All`]: nothing slides.
    pub hold: Hold,
    /// True if the truss may fall over an edge onto other nodes; false if it places a node beyond the edge first,
    /// where it can, as variable topology trusses roll without impact. Default true, as in [Usevitch et
    /// al.](crate::planners::truss).
    pub impact: bool,
    /// The number of steps for which each policy is tried before the best is taken; 0 for none. A policy is an
    /// objective with a value of `impact`: the present objective, the one set here, [`Objective::Springs`],
    /// [`Objective::LENGTHS`] and [`Objective::RESTORING`], each with `impact` as set here, and the present objective
    /// without impact. So `objective` and `impact` are only the first choice. Default 0: lookahead takes five times the
    /// work.
    pub lookahead: usize,
    /// True if easier steps are tried where none is found: with a half or a quarter of the stride, with free height of
    /// the centre of mass, with the other choice of [`Hold`], or with the objective [`Objective::Springs`] and the
    /// whole, half or none of the stride; and, where all get stuck, from some steps before with another objective, or aside
    /// first, over other edges. Default true.
    pub fallbacks: bool,
    /// True if forces that hold the truss at rest, of struts and of the ground, stay within what a strut bears after every
    /// step and roll. Default true; [`follow_path`] looks at them where the limits of its truss have forces.
    pub forces: bool,
    /// The greatest distance that nodes on the ground slide, summed over all, m; infinite for no limit. Default
    /// infinite.
    pub slip_max: f64,
    /// The greatest number of steps. Default 100 000: a distance of five thousand units.
    pub steps_max: usize,
    /// The settings of placing nodes without impact, with the defaults that its fields state.
    pub foothold: Foothold,
    /// The time law by which the moves of the plan are timed, with the defaults that its fields state.
    pub time_law: TimeLaw,
    /// The tolerances of the steps of trusses. Default [`Tolerances::DEFAULT`].
    pub tolerances: Tolerances,
}

/// The settings of placing a node on the ground beyond an edge of the support polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foothold {
    /// The distance of the centre of mass to an edge, units, below which a node is placed beyond it before the next
    /// step. Default 0.1: two steps.
    pub trigger: f64,
    /// The least distance of the placed node beyond the edge, units. Default 0.2.
    pub beyond: f64,
    /// The weight of the placed node's distance to the ground in the cost of a step, without unit. Default 100.
    pub weight: f64,
    /// The number of steps after which another node is tried. Default 60: a distance of three units.
    pub steps_max: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            arrival_distance: 0.25,
            stride: 0.05,
            objective: Objective::RESTORING,
            hold: Hold::All,
            impact: true,
            lookahead: 0,
            fallbacks: true,
            forces: true,
            slip_max: f64::INFINITY,
            steps_max: 100_000,
            foothold: Foothold { trigger: 0.1, beyond: 0.2, weight: 100.0, steps_max: 60 },
            time_law: TimeLaw::default(),
            tolerances: Tolerances::DEFAULT,
        }
    }
}

/// The reason why a search for a motion along a path ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The centre of mass reached the last point of the path.
    Arrived,
    /// No step was found, not even an easier one of [`Settings::fallbacks`], or too many of these in a row were taken;
    /// the error is that of the ordinary step.
    Stuck(StepError),
    /// The truss stands on one node, has no contact, or rolls without end.
    Falls,
    /// The truss would topple over an edge, and violate the given constraint while it rolls.
    Blocked(Constraint),
    /// The truss steps and rolls to and fro, and comes no nearer to the end of the path.
    ToAndFro,
    /// The greatest number of steps was made before the end of the path was reached.
    Steps,
    /// The observer ended the search.
    Cancelled,
}

/// The motion that [`follow_path`] found, with the figures of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct Travel {
    /// The moves in order of time, from the positions given as the start.
    pub moves: Vec<Move>,
    /// The reason why the motion ends after the last move.
    pub end: End,
    /// The number of points of the path that the centre of mass reached.
    pub reached: usize,
    /// The number of steps made, those included that were taken back because a roll after them was blocked.
    pub steps: usize,
    /// The number of rolls made, those included that were taken back.
    pub rolls: usize,
    /// The number of steps, among those made, that were easier ones of [`Settings::fallbacks`].
    pub relaxed_steps: usize,
    /// The number of nodes placed beyond an edge before the centre of mass went there.
    pub footholds: usize,
    /// The distance that nodes in contact slid over the ground in steps, summed over nodes, m.
    pub slip: f64,
    /// The duration of the motion, s, without rounding steps up to the law's shortest.
    pub duration: f64,
}

/// The weight of the motion over the ground of a contact that is not held, relative to that of other nodes, where all
/// are held that can be: it then lifts off rather than slides.
const ANCHOR: f64 = 100.0;
/// The height by which such a contact would lift off if nothing else moved it, as a fraction of the stride.
const LIFT: f64 = 1.0;

/// A relaxation of a step: an easier one that is tried instead.
pub(super) struct Relaxation {
    /// The fraction of the stride.
    speed: f64,
    /// True if the height of the centre of mass is prescribed too.
    level: bool,
    /// True if the other set of contacts is held.
    other_hold: bool,
    /// True if the objective is Springs.
    springs: bool,
}

/// The step as it is wanted, then its relaxations in the order in which they are tried.
pub(super) const RELAXATIONS: [Relaxation; 8] = [
    Relaxation { speed: 1.0, level: true, other_hold: false, springs: false },
    Relaxation { speed: 0.5, level: true, other_hold: false, springs: false },
    Relaxation { speed: 0.25, level: true, other_hold: false, springs: false },
    Relaxation { speed: 1.0, level: false, other_hold: false, springs: false },
    Relaxation { speed: 1.0, level: true, other_hold: true, springs: false },
    Relaxation { speed: 1.0, level: true, other_hold: false, springs: true },
    Relaxation { speed: 0.5, level: true, other_hold: false, springs: true },
    // The centre of mass stands still while the truss gets into shape.
    Relaxation { speed: 0.0, level: true, other_hold: false, springs: true },
];

/// Returns the motion of a truss whose centre of mass follows a path of points (x, y), m, after sections IV.A to IV.C
/// of [Usevitch et al.](crate::planners::truss); the first point may be where it is, and an empty path is at its end.
/// `start`: the positions of the nodes, m, resting on the ground. If the search gets stuck, or `progress` ends it,
/// the result is the motion found so far, and [`Travel::end`] gives the reason.
///
/// This is the search beneath [`plan`](super::plan), for callers who have a [`Structure`] of their own. The points of
/// the path must be finite, which `plan` checks and this does not.
pub fn follow_path(
    truss: &Structure,
    start: &[Vec3],
    path: &[[f64; 2]],
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Travel {
    let truss = &truss.tightened(truss.tolerances.clearance_margin);
    let mut monitor = Monitor { progress, asked: 0 };
    let mut rollout = Rollout {
        truss,
        path,
        settings,
        stride: settings.stride * truss.unit,
        policy: StepPolicy { objective: settings.objective, impact: settings.impact, thorough: false },
        x: start.to_vec(),
        warm_start: WarmStart::default(),
        relaxed_in_a_row: 0,
        aside: None,
        allow_fallbacks: false,
        place_node_first: false,
        placing: None,
        out_of_reach: Vec::new(),
        reshaped: 0,
        reshaping: false,
        landed: forces::Known::default(),
        travel: Travel::new(),
    };
    rollout.travel.end = match rollout.settle() {
        Err(end) => end,
        Ok(()) if settings.lookahead > 0 => return lookahead::search(rollout, &mut monitor).travel,
        Ok(()) => return detours::search(rollout, &mut monitor).travel,
    };
    rollout.travel
}

/// The observer of the caller, with the number of steps begun on all branches of the search.
pub(super) struct Monitor<'a> {
    progress: &'a mut dyn Progress,
    asked: usize,
}

impl Monitor<'_> {
    /// Reports a step that is about to begin; returns false if the observer ends the search.
    fn should_continue(&mut self, rollout: &Rollout) -> bool {
        let (step, most) = (self.asked, rollout.settings.steps_max);
        let (reached, places) = (rollout.travel.reached, rollout.path.len());
        self.asked += 1;
        self.progress
            .report(&|| format!("step {step} of at most {most}, {reached} of {places} places reached"));
        self.progress.should_continue()
    }
}

impl Travel {
    fn new() -> Travel {
        Travel {
            moves: Vec::new(),
            end: End::Arrived,
            reached: 0,
            steps: 0,
            rolls: 0,
            relaxed_steps: 0,
            footholds: 0,
            slip: 0.0,
            duration: 0.0,
        }
    }
}

/// The choices by which a rollout makes its steps; lookahead compares several of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepPolicy {
    /// The objective that the steps minimise.
    pub objective: Objective,
    /// True if the truss may fall over an edge onto other nodes; false to place a node before, where that is possible.
    pub impact: bool,
    /// True if steps are looked for where they are seldom found, which takes long.
    pub thorough: bool,
}

/// A state of the search: a truss on its way along the path, with the motion so far.
#[derive(Clone)]
pub(super) struct Rollout<'a> {
    /// The truss with its limits and surroundings.
    pub truss: &'a Structure,
    /// The points (x, y) in the world's frame that the centre of mass has to reach, m.
    pub path: &'a [[f64; 2]],
    /// The settings with which the planner was called.
    pub settings: &'a Settings,
    /// The distance of the centre of mass in one step, m.
    pub stride: f64,
    /// The policy by which the present steps are made.
    pub policy: StepPolicy,
    /// The positions of the nodes in the world's frame, by index, m.
    pub x: Vec<Vec3>,
    /// The data of the last step, with which the next begins.
    pub warm_start: WarmStart,
    relaxed_in_a_row: usize,
    /// A place (x, y) beside the path that the centre of mass goes to before the next point of the path, m.
    pub aside: Option<[f64; 2]>,
    /// True if the search continues with relaxed steps as long as it can.
    pub allow_fallbacks: bool,
    /// True if a constraint blocks the next roll, so that a node has to be placed first.
    pub place_node_first: bool,
    /// The node that is being placed, and the number of steps this has taken; `None` if none is.
    pub placing: Option<(usize, usize)>,
    /// Nodes that could not be placed from where the truss stands.
    pub out_of_reach: Vec<usize>,
    /// The number of steps in which the truss was reshaped before its next roll.
    pub reshaped: usize,
    /// True while it is.
    pub reshaping: bool,
    /// The forces where it would land.
    pub landed: forces::Known,
    /// The motion found so far.
    pub travel: Travel,
}

impl<'a> Rollout<'a> {
    /// Returns a copy to go back to, without what is large and made again.
    pub(super) fn kept(&mut self) -> Rollout<'a> {
        let warm_start = mem::take(&mut self.warm_start);
        let mut kept = self.clone();
        self.warm_start = warm_start;
        kept.warm_start = self.warm_start.light_copy();
        kept
    }
}

impl Rollout<'_> {
    /// Makes at most `steps` steps towards the next points of the path. Returns the reason why the rollout ended;
    /// `None` if the steps are used up and it may go on. Points of the path that are near enough are reached without a
    /// step.
    pub(super) fn advance_steps(&mut self, steps: usize, monitor: &mut Monitor) -> Option<End> {
        let first = self.travel.steps;
        while let Some(place) = self.next_place() {
            let centre = self.truss.centre_of_mass(&self.x);
            let away = [place[0] - centre.x, place[1] - centre.y];
            let distance = libm::hypot(away[0], away[1]);
            if distance < self.settings.arrival_distance * self.truss.unit {
                self.travel.reached += usize::from(self.aside.take().is_none());
                continue;
            }
            if self.travel.steps >= self.settings.steps_max {
                return Some(End::Steps);
            }
            if self.travel.steps - first >= steps {
                return None;
            }
            if !monitor.should_continue(self) {
                return Some(End::Cancelled);
            }
            let stride = self.stride.min(distance) / distance;
            if let Err(end) = self.advance_one([away[0] * stride, away[1] * stride]) {
                return Some(end);
            }
        }
        Some(End::Arrived)
    }

    /// Returns the place that the centre of mass goes to next, m; `None` at the end of the path.
    pub(super) fn next_place(&self) -> Option<[f64; 2]> {
        self.path.get(self.travel.reached).map(|place| self.aside.unwrap_or(*place))
    }

    /// Makes one step, and the rolls that follow.
    fn advance_one(&mut self, stride: [f64; 2]) -> Result<(), End> {
        if (!self.policy.impact || self.place_node_first) && self.place_node(stride) {
            return self.settle();
        }
        if self.reshaping && self.reshape(stride) {
            return Ok(());
        }
        let before = (self.x.clone(), self.travel.moves.len(), self.travel.duration, self.travel.slip);
        let y = match self.next(stride) {
            Ok(y) => y,
            Err(error) => {
                if self.place_node_first || !error.constraints().contains(&Constraint::Force) {
                    return Err(End::Stuck(error));
                }
                self.place_node_first = true;
                self.warm_start = WarmStart::default();
                return Ok(());
            }
        };
        self.travel.steps += 1;
        self.move_to(y);
        let settled = self.settle();
        if let Err(End::Blocked(constraint)) = settled
            && !self.place_node_first
        {
            // Take the step back, and reshape or place a node first.
            self.reshaping = constraint == Constraint::Force && self.reshaped < RESHAPING_MAX;
            self.place_node_first = !self.reshaping;
            self.warm_start = WarmStart::default();
            self.x = before.0;
            self.travel.moves.truncate(before.1);
            (self.travel.duration, self.travel.slip) = (before.2, before.3);
            return Ok(());
        }
        settled
    }

    /// Returns the distance left on the ground along straight lines from the centre of mass to the next point of the
    /// path and from point to point, m.
    pub(super) fn distance_left(&self) -> f64 {
        let centre = self.truss.centre_of_mass(&self.x);
        let rest = &self.path[self.travel.reached.min(self.path.len())..];
        let places: Vec<[f64; 2]> = [[centre.x, centre.y]].into_iter().chain(rest.iter().copied()).collect();
        places.windows(2).map(|p| libm::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1])).sum()
    }

    /// Returns the positions after the next step, from the first relaxation that has one.
    fn next(&mut self, stride: [f64; 2]) -> Result<Vec<Vec3>, StepError> {
        let contacts = support_polygon::contacts(self.truss, &self.x);
        let mut first = None;
        let relaxations = if self.settings.fallbacks { &RELAXATIONS[..] } else { &RELAXATIONS[..1] };
        for (index, relaxation) in relaxations.iter().enumerate() {
            match self.attempt(relaxation, stride, &contacts) {
                // Nodes would slide too far, or the centre of mass would leave the support between the ends.
                Ok(y) if !self.keeps_its_feet(&y) => {
                    self.warm_start.active.clear();
                    first.get_or_insert(StepError::NotConverged(Vec::new()));
                }
                Ok(y) => {
                    let relaxed = index > 0;
                    self.travel.relaxed_steps += usize::from(relaxed);
                    self.relaxed_in_a_row = if relaxed { self.relaxed_in_a_row + 1 } else { 0 };
                    let most = if self.allow_fallbacks { RELAXED_MAX } else { RELAXED_MAX_LOOKAHEAD };
                    if self.relaxed_in_a_row <= most {
                        return Ok(y);
                    }
                }
                Err(error) => {
                    first.get_or_insert(error);
                }
            }
        }
        Err(first.unwrap_or(StepError::NotConverged(Vec::new())))
    }

    /// Returns the positions after a step under a relaxation, and keeps its warm start.
    pub(super) fn attempt(
        &mut self,
        relaxation: &Relaxation,
        stride: [f64; 2],
        contacts: &[usize],
    ) -> Result<Vec<Vec3>, StepError> {
        let centre = self.truss.centre_of_mass(&self.x);
        let pinned = match (self.settings.hold, relaxation.other_hold) {
            (Hold::Three, false) | (Hold::All, true) => {
                support_polygon::support_triangle(&self.x, &support_polygon::hull(&self.x, contacts), centre)
            }
            (Hold::All, false) | (Hold::Three, true) => contacts.to_vec(),
        };
        let objective = if relaxation.springs { Objective::Springs } else { self.policy.objective };
        let mut goal = vec![(0, stride[0] * relaxation.speed), (1, stride[1] * relaxation.speed)];
        if relaxation.level {
            let to = [centre.x + goal[0].1, centre.y + goal[1].1];
            let rise = self.truss.surroundings.ground_rise([centre.x, centre.y], to, self.truss.unit);
            goal.push((2, rise));
        }
        let mut cost = cost(objective, self.truss, &self.x, self.stride / self.truss.unit);
        self.released(&mut cost, contacts, &pinned);
        self.prepare_landing(&mut cost, stride, &pinned);
        let problem = StepProblem {
            truss: self.truss,
            x: &self.x,
            cost: &cost,
            pinned: &pinned,
            centre_of_mass: &goal,
            ground: true,
            displacement_max: f64::INFINITY,
            thorough: self.policy.thorough,
        };
        step(&problem, &mut self.warm_start)
    }

    /// Makes contacts that are not held lift off rather than slide, where all are held that can be.
    pub(super) fn released(&self, cost: &mut QuadraticCost, contacts: &[usize], pinned: &[usize]) {
        if self.settings.hold == Hold::Three {
            return;
        }
        for &node in contacts.iter().filter(|node| !pinned.contains(node)) {
            (0..2).for_each(|k| cost.hessian.push((3 * node + k, 3 * node + k, ANCHOR)));
            cost.linear[3 * node + 2] -= LIFT * self.stride;
        }
    }

    /// Moves the nodes to y, or as far towards it as [`Rollout::ending`] says.
    pub(super) fn move_to(&mut self, y: Vec<Vec3>) {
        let next = self.ending(&y);
        self.travel.slip += self.slip(&next);
        if next != self.x {
            let findings = self.warm_start.findings(self.truss, &self.x, &next, &self.settings.time_law);
            self.push(Move::Linear(next.clone(), findings));
            self.x = next;
        }
    }

    /// Returns the positions of the nodes, m, as far on the way to `y` as the truss is statically stable, or before, where
    /// the first node touches the ground.
    fn ending(&self, y: &[Vec3]) -> Vec<Vec3> {
        let next = support_polygon::standing(self.truss, &self.x, y);
        // Above the edge itself it could not brake; if it rolls there, it need not.
        if next != y && self.truss.limits.forces.is_some() && roll::is_stable(self.truss, &next) {
            support_polygon::touching_down(self.truss, &self.x, &next)
        } else {
            next
        }
    }

    /// Returns true if on the way to `y`, as far as that is gone, nodes slide no farther than they may, and the truss stands
    /// all the way.
    pub(super) fn keeps_its_feet(&self, y: &[Vec3]) -> bool {
        let next = self.ending(y);
        self.travel.slip + self.slip(&next) <= self.settings.slip_max
            && support_polygon::stands_all_the_way(self.truss, &self.x, &next)
    }

    /// Returns the distance that nodes on the ground slide on the way to `next`, summed over all, m.
    fn slip(&self, next: &[Vec3]) -> f64 {
        let slid = |node: usize| {
            let way = next[node] - self.x[node];
            libm::hypot(way.x, way.y)
        };
        support_polygon::staying(self.truss, &self.x, next).into_iter().map(slid).sum()
    }

    /// Adds a move and its duration.
    fn push(&mut self, step: Move) {
        self.travel.duration += self.settings.time_law.duration(self.truss, &self.x, &step);
        self.travel.moves.push(step);
    }

    /// Rolls until the truss is statically stable.
    fn settle(&mut self) -> Result<(), End> {
        for _ in 0..roll::ROLLS_MAX {
            let roll = match roll::equilibrium(self.truss, &self.x) {
                Some(Equilibrium::Stable) => return Ok(()),
                Some(Equilibrium::Topples(roll)) => roll,
                Some(Equilibrium::OnOneNode(_)) | None => return Err(End::Falls),
            };
            if let Some(constraint) = roll::blocked(self.truss, &self.x, roll) {
                return Err(End::Blocked(constraint));
            }
            let landed = roll::rolled(&self.x, roll);
            if !forces::holds(self.truss, &landed) {
                return Err(End::Blocked(Constraint::Force));
            }
            self.push(Move::Roll(roll));
            self.x = landed;
            // Distances between struts are invariant under a roll; those from the surroundings are not.
            let outer = |constraint: &Constraint| {
                matches!(
                    constraint,
                    Constraint::NodeHeight(_)
                        | Constraint::StrutHeight(..)
                        | Constraint::ObstacleClearance(..)
                )
            };
            self.warm_start.active.retain(|(constraint, _)| !outer(constraint));
            self.travel.rolls += 1;
            self.place_node_first = false;
            (self.reshaping, self.reshaped) = (false, 0);
            self.placing = None;
            self.out_of_reach.clear();
        }
        Err(End::Falls)
    }
}
