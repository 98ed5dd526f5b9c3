//! Trajectories in closed form: configurations one after another, with the least time of each transition.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use crate::plan::{CauseId, CellLimits, Counter, Law, Model, Moves, Ratio, Run, Stage, StageEnd, Stages};

/// A motion (trajectory) of a lattice robot: configurations of all cells with the transitions between them. Lengths
/// are in cell sizes; the unit of time is √(size · mass / force), in which the greatest acceleration of a cell is 1
/// cell size per squared unit.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The number of cells of the robot.
    pub count: u64,
    /// The configurations in order of time as arithmetic runs, in cell sizes relative to the centre of mass, which
    /// rests; one more than there are transitions. `None` between two transitions that state moves; the first and the
    /// last are stated always.
    pub configurations: Vec<Option<Vec<Run>>>,
    /// The transitions, of which number `k` leads from configuration `k` to `k + 1`.
    pub transitions: Vec<Transition>,
}

/// A stage of a motion, from one configuration to the next: every cell moves along a line, all by the same time law.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// The name of the stage that the transition becomes.
    pub name: &'static str,
    /// The square of the transition's duration, in squared units of time ([`Motion`]).
    pub time_squared: Ratio,
    /// The time law of the progress of all cells.
    pub law: Law,
    /// True if the angular momentum stays zero during the transition.
    pub balanced: bool,
    /// The moves of all cells; `None` if the configurations before and after are stated instead.
    pub moves: Option<Moves>,
}

/// The velocity profile of a stage: how its progress speeds up and slows down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// Constant acceleration for half the time, constant deceleration for the other half, as in [Reif and
    /// Slee](super).
    #[default]
    BangBang,
    /// A ramp, an interval of constant speed if the speed limit is active, and a ramp: the least time.
    Trapezoid,
}

/// The limits of cells under which motions are planned, and the velocity profile.
#[derive(Clone, Copy, Debug)]
pub struct PlanLimits {
    /// The limits of a cell: least size and greatest speed, in cell sizes and units of time ([`Motion`]).
    pub cell: CellLimits,
    /// The velocity profile of all stages.
    pub profile: Profile,
    /// True if the Euclidean norm of an acceleration is bounded, not only its component along each axis.
    pub euclidean: bool,
    /// True if some cells stand fast, so that nothing recoils: configurations are relative to the lattice, not to the
    /// centre of mass.
    pub anchored: bool,
    /// True if cells hold each other over any parts of their faces; false if only where the middles of two faces meet.
    pub slides: bool,
}

/// The data about cells, limits and model that a motion needs to become the body of a plan.
#[derive(Clone, Copy, Debug)]
pub struct PlanHeader {
    /// The index of the kind of cell in [`Library::cells`](crate::robot::Library) of the plan.
    pub cell: usize,
    /// The unit of time ([`Motion`]), s.
    pub time_unit: f64,
    /// The limits of a cell: least size and greatest speed, in cell sizes and units of time.
    pub limits: CellLimits,
    /// The model of forces that the plan is judged under.
    pub model: Model,
}

type Place<'a> = Box<dyn Fn(u64) -> CellState + 'a>;

/// A motion that is built stage by stage.
pub(super) struct Builder<'a> {
    limits: PlanLimits,
    motion: Motion,
    last: Place<'a>,
}

/// The displacements of a stage, in quarters, before the centre of mass is held.
struct Displacements {
    /// The greatest displacement along each axis relative to the centre of mass, times `WHOLE · count`.
    farthest: [i128; 3],
    resized: i64,
    moves: bool,
    balanced: bool,
}

impl<'a> Builder<'a> {
    /// Begins a motion at a configuration: `place` returns the state of a cell by its number, from 0, and must be
    /// affine on each of the domains, which together hold each of `count` cells once.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn new(
        limits: PlanLimits,
        count: u64,
        domains: &[Domain],
        place: impl Fn(u64) -> CellState + 'a,
    ) -> Result<Builder<'a>, Refusal> {
        let start = runs(domains, count, limits.anchored, &place)?;
        let motion = Motion { count, configurations: vec![Some(start)], transitions: vec![] };
        Ok(Builder { limits, motion, last: Box::new(place) })
    }

    /// Appends a stage that takes each cell to the state that `place` returns for its number. On each of the domains
    /// both the last states and the next must be affine functions of the number; `relative_displacement` is the
    /// greatest distance (in quarters of a cell, along an axis) by which two cells move against each other that stay in
    /// contact. A stage in which nothing moves is left out.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn stage(
        &mut self,
        name: &'static str,
        relative_displacement: i64,
        domains: &[Domain],
        place: impl Fn(u64) -> CellState + 'a,
    ) -> Result<(), Refusal> {
        self.stage_by(name, relative_displacement, domains, place, None)
    }

    /// Appends a stage as [`stage`](Self::stage) does, that is stated by these moves if there are any, else by the
    /// configurations before and after. The moves must be the displacements relative to the centre of mass, and they
    /// must lead to the states that `place` returns.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn stage_by(
        &mut self,
        name: &'static str,
        relative_displacement: i64,
        domains: &[Domain],
        place: impl Fn(u64) -> CellState + 'a,
        moves: Option<Moves>,
    ) -> Result<(), Refusal> {
        let motion = self.displacements(domains, &place);
        if motion.moves {
            let (time_squared, law) = motion
                .least_time(&self.limits, self.motion.count, relative_displacement)
                .ok_or(Refusal::TooLarge)?;
            let mut configuration = None;
            if moves.is_none() {
                self.state_last(domains)?;
                configuration = Some(self.runs(domains, &place)?);
            }
            let balanced = motion.balanced;
            self.motion.transitions.push(Transition { name, time_squared, law, balanced, moves });
            self.motion.configurations.push(configuration);
        }
        self.last = Box::new(place);
        Ok(())
    }

    /// States the last configuration, if it is not stated yet, by runs of these domains, on each of which it must be
    /// affine.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn state_last(&mut self, domains: &[Domain]) -> Result<(), Refusal> {
        if let Some(last @ None) = self.motion.configurations.last_mut() {
            *last = Some(runs(domains, self.motion.count, self.limits.anchored, &self.last)?);
        }
        Ok(())
    }

    /// Returns the configuration in which `place` returns the state of a cell, affine on each of the domains.
    fn runs(&self, domains: &[Domain], place: &dyn Fn(u64) -> CellState) -> Result<Vec<Run>, Refusal> {
        runs(domains, self.motion.count, self.limits.anchored, place)
    }

    /// Returns the displacements from the last configuration to that in which `place` returns the state of a cell.
    fn displacements(&self, domains: &[Domain], place: &dyn Fn(u64) -> CellState) -> Displacements {
        Displacements::of(domains, (self.motion.count, self.limits.anchored), &self.last, place)
    }

    /// Appends two stages between which the cells do not come to rest: a speed-up to the states `middle` and a
    /// slow-down to the states `end`, with the same displacement of each cell in both. The parameters are those of
    /// [`stage`](Self::stage).
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub(super) fn two_phase_stage(
        &mut self,
        name: &'static str,
        relative_displacement: i64,
        domains: &[Domain],
        middle: impl Fn(u64) -> CellState + 'a,
        end: impl Fn(u64) -> CellState + 'a,
    ) -> Result<(), Refusal> {
        let whole = self.displacements(domains, &end);
        let resized = 2 * self.displacements(domains, &middle).resized;
        let limits = PlanLimits { profile: Profile::Trapezoid, ..self.limits };
        let (time, law) = whole
            .least_time(&limits, self.motion.count, relative_displacement.max(resized))
            .ok_or(Refusal::TooLarge)?;
        let half = Ratio::new(time.0.into(), 4 * i128::from(time.1)).ok_or(Refusal::TooLarge)?;
        let ramp = law.ramps().0.times(Ratio(2, 1)).ok_or(Refusal::TooLarge)?;
        for (law, place) in
            [(Law::SpeedUp(ramp), &middle as &dyn Fn(u64) -> CellState), (Law::SlowDown(ramp), &end)]
        {
            self.motion.transitions.push(Transition {
                name,
                time_squared: half,
                law,
                balanced: whole.balanced,
                moves: None,
            });
            let configuration = self.runs(domains, &place)?;
            self.motion.configurations.push(Some(configuration));
        }
        self.last = Box::new(end);
        Ok(())
    }

    /// Returns the motion of the stages added so far, whose last configuration must be stated.
    pub(super) fn motion(self) -> Motion {
        self.motion
    }
}

/// Returns the square of the least time in which cells can move by `distance` and part (or change their sizes) by
/// `relative_displacement`, both in cells, with the time law that does it; `None` if a number does not fit. At unit
/// acceleration a distance D takes T² = 4D, bang-bang.
pub(super) fn least_time(
    limits: &PlanLimits,
    distance: Ratio,
    relative_displacement: Ratio,
) -> Option<(Ratio, Law)> {
    let relative_displacement_squared = relative_displacement.times(relative_displacement)?;
    let speed = limits.cell.speed_squared;
    // The square of the time for the relative_displacement at full speed.
    let coasting = relative_displacement_squared.times(Ratio(speed.1, speed.0))?;
    if coasting.order(distance).is_le() {
        return Some((distance.times(Ratio(4, 1))?, Law::BangBang));
    }
    if limits.profile == Profile::Trapezoid && distance.0 > 0 {
        let trapezoid = || {
            // T = c + D/c, where c is the time at full speed; a ramp takes D/c of it.
            let square = Ratio::new(
                i128::from(distance.0) * i128::from(distance.0) * i128::from(coasting.1),
                i128::from(distance.1) * i128::from(distance.1) * i128::from(coasting.0),
            )?;
            let time = plus(plus(coasting, distance.times(Ratio(2, 1))?)?, square)?;
            let both = plus(coasting, distance)?;
            Some((time, Law::Trapezoid(distance.times(Ratio(both.1, both.0))?)))
        };
        if let Some(found) = trapezoid() {
            return Some(found);
        }
    }
    Some((coasting.times(Ratio(4, 1))?, Law::BangBang))
}

/// Returns the sum of two numbers; `None` if it does not fit.
fn plus(a: Ratio, b: Ratio) -> Option<Ratio> {
    let product = |x: i64, y: i64| i128::from(x) * i128::from(y);
    Ratio::new(product(a.0, b.1).checked_add(product(b.0, a.1))?, product(a.1, b.1))
}

/// The state of cells as an affine function of a domain's counters.
struct Affine {
    first: CellState,
    /// The increment of the centre for each counter, along each axis.
    steps: Vec<[i64; 3]>,
}

impl Affine {
    /// Returns the affine function that `place` is on a domain.
    fn of(domain: &Domain, place: &dyn Fn(u64) -> CellState) -> Affine {
        let first = place(domain.first);
        let step = |&(_, stride): &(u64, i64)| {
            let next = place((domain.first as i64 + stride) as u64);
            [0, 1, 2].map(|axis| next.center[axis] - first.center[axis])
        };
        Affine { first, steps: domain.counters.iter().map(step).collect() }
    }

    /// Returns the sum of the centres along an axis over the domain.
    fn sum(&self, domain: &Domain, axis: usize) -> i128 {
        let count = i128::from(domain.count());
        // Every second factor of count · (c - 1) is even, for c divides the count.
        let spread = domain.counters.iter().zip(&self.steps);
        let halves: i128 =
            spread.map(|((c, _), step)| i128::from(step[axis]) * (i128::from(*c) - 1) * count).sum();
        i128::from(self.first.center[axis]) * count + halves / 2
    }
}

/// Returns the configuration as arithmetic runs, about its centre of mass if it is not `anchored`.
fn runs(
    domains: &[Domain],
    count: u64,
    anchored: bool,
    place: &dyn Fn(u64) -> CellState,
) -> Result<Vec<Run>, Refusal> {
    crate::interrupt::checkpoint();
    let affine: Vec<Affine> = domains.iter().map(|domain| Affine::of(domain, place)).collect();
    let sum = |axis| domains.iter().zip(&affine).map(|(d, a)| a.sum(d, axis)).sum::<i128>();
    let total = if anchored { [0; 3] } else { [sum(0), sum(1), sum(2)] };
    let quarters = |n: i64| Ratio::new(n.into(), WHOLE.into()).ok_or(Refusal::TooLarge);
    let three = |f: &dyn Fn(usize) -> Result<Ratio, Refusal>| Ok([f(0)?, f(1)?, f(2)?]);
    let run = |(domain, affine): (&Domain, &Affine)| {
        let center = |axis: usize| {
            let whole = i128::from(count);
            let above = i128::from(affine.first.center[axis]) * whole - total[axis];
            Ratio::new(above, i128::from(WHOLE) * whole).ok_or(Refusal::TooLarge)
        };
        let counters = domain.counters.iter().zip(&affine.steps).map(|(&(count, stride), step)| {
            Ok(Counter { count, stride, step: three(&|axis| quarters(step[axis]))? })
        });
        Ok(Run {
            first: domain.first,
            counters: counters.collect::<Result<_, Refusal>>()?,
            center: three(&center)?,
            size: three(&|axis| quarters(affine.first.size[axis]))?,
        })
    };
    domains.iter().zip(&affine).map(run).collect()
}

/// The denominator to which a distance along several axes is rounded up: its square is not a square number.
const ROOT_PARTS: i128 = 1 << 16;

/// Returns the distance that bounds the acceleration, in cells: the greatest along an axis, or, if accelerations are
/// bounded in length, an upper bound on the greatest Euclidean one; `None` if a number does not fit. `farthest`: the
/// greatest displacement along each axis, times `whole`.
pub(super) fn distance_bound(farthest: [i128; 3], whole: i128, euclidean: bool) -> Option<Ratio> {
    let most = farthest.into_iter().max().unwrap_or(0);
    if !euclidean || farthest.iter().sum::<i128>() == most {
        return Ratio::new(most, whole);
    }
    let square = farthest.iter().try_fold(0_i128, |sum, reach| {
        let parts = reach.checked_mul(ROOT_PARTS)?;
        sum.checked_add(parts.checked_mul(parts)?)
    })?;
    let root = square.isqrt();
    let root = root + i128::from(root * root < square);
    Ratio::new(root, whole.checked_mul(ROOT_PARTS)?)
}

impl Displacements {
    /// Returns the square of the least time of the stage in which two cells in contact move against each other by
    /// `relative_displacement` quarters of a cell, with the time law that does it; `None` if a number does not fit.
    fn least_time(
        &self,
        limits: &PlanLimits,
        count: u64,
        relative_displacement: i64,
    ) -> Option<(Ratio, Law)> {
        let whole = i128::from(WHOLE) * i128::from(count);
        let relative_displacement = Ratio::new(relative_displacement.max(self.resized).into(), WHOLE.into())?;
        least_time(limits, distance_bound(self.farthest, whole, limits.euclidean)?, relative_displacement)
    }

    /// Computes the displacements of a stage, relative to the centre of mass if it is not `anchored`, and its angular
    /// momentum.
    fn of(
        domains: &[Domain],
        (count, anchored): (u64, bool),
        before: &dyn Fn(u64) -> CellState,
        after: &dyn Fn(u64) -> CellState,
    ) -> Displacements {
        let ends: Vec<(Affine, Affine)> =
            domains.iter().map(|d| (Affine::of(d, before), Affine::of(d, after))).collect();
        let sum = |axis: usize| {
            let moved = |(d, (a, b)): (&Domain, &(Affine, Affine))| b.sum(d, axis) - a.sum(d, axis);
            domains.iter().zip(&ends).map(moved).sum::<i128>()
        };
        // The centre of mass would drift by this; all displacements are relative to it.
        let drift = if anchored { [0; 3] } else { [sum(0), sum(1), sum(2)] };
        let mut motion = Displacements { farthest: [0; 3], resized: 0, moves: false, balanced: true };
        // Twelve times the sum of position × displacement over all cells, about the origin: the angular
        // momentum but for the common time law.
        let mut turning = [0_i128; 3];
        let mut places = [0_i128; 3];
        for (domain, (a, b)) in domains.iter().zip(&ends) {
            let cells = i128::from(domain.count());
            let mut means = [[0_i128; 2]; 3];
            for axis in 0..3 {
                let first = b.first.center[axis] - a.first.center[axis];
                let (mut low, mut high) = (i128::from(first), i128::from(first));
                for (k, (c, _)) in domain.counters.iter().enumerate() {
                    let step = i128::from(b.steps[k][axis] - a.steps[k][axis]) * (i128::from(*c) - 1);
                    low += step.min(0);
                    high += step.max(0);
                }
                let whole = i128::from(count);
                let reach = (low * whole - drift[axis]).abs().max((high * whole - drift[axis]).abs());
                motion.farthest[axis] = motion.farthest[axis].max(reach);
                motion.resized = motion.resized.max((b.first.size[axis] - a.first.size[axis]).abs());
                // Twice the means over the domain.
                let mean = |affine: &Affine| 2 * affine.sum(domain, axis) / cells;
                means[axis] = [mean(a), mean(b) - mean(a)];
                places[axis] += a.sum(domain, axis);
            }
            for (axis, turning) in turning.iter_mut().enumerate() {
                let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut cross = 3 * (means[y][0] * means[z][1] - means[z][0] * means[y][1]);
                for (k, (c, _)) in domain.counters.iter().enumerate() {
                    let step = |affine: &Affine, axis: usize| i128::from(affine.steps[k][axis]);
                    let moved = |axis: usize| step(b, axis) - step(a, axis);
                    let spread = i128::from(*c) * i128::from(*c) - 1;
                    cross += (step(a, y) * moved(z) - step(a, z) * moved(y)) * spread;
                }
                *turning += cross * cells;
            }
        }
        motion.moves = motion.farthest != [0; 3] || motion.resized > 0;
        // The same about the centre of mass, which is held.
        let about = |axis: usize| {
            let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
            i128::from(count) * turning[axis] - 12 * (places[y] * drift[z] - places[z] * drift[y])
        };
        motion.balanced = !anchored && (0..3).all(|axis| about(axis) == 0);
        motion
    }
}

impl Motion {
    /// Returns the motion of no transitions at a configuration of `count` cells: `place` returns the state of a cell by
    /// its number and must be affine on each of the domains, which together hold each cell once.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit 64 bits.
    pub fn rest(count: u64, domains: &[Domain], place: impl Fn(u64) -> CellState) -> Result<Motion, Refusal> {
        let start = runs(domains, count, false, &place)?;
        Ok(Motion { count, configurations: vec![Some(start)], transitions: vec![] })
    }

    /// Returns the motion in reverse, from the end to the start, with the time laws reversed.
    pub fn reversed(mut self) -> Motion {
        self.configurations.reverse();
        self.transitions.reverse();
        for transition in &mut self.transitions {
            transition.law = transition.law.reversed();
            transition.moves = transition.moves.as_ref().map(Moves::reversed);
        }
        self
    }

    /// Returns this motion, then another of as many cells, whose first configuration must be this one's last, cell for
    /// cell; that is not checked.
    pub fn then(mut self, next: Motion) -> Motion {
        self.configurations.extend(next.configurations.into_iter().skip(1));
        self.transitions.extend(next.transitions);
        self
    }

    /// Returns the motion with its axes permuted: what was along axis `k` (0 to 2 for x, y, z) is along axis `to[k]`.
    /// `to` must be a permutation.
    pub fn turned(mut self, to: [usize; 3]) -> Motion {
        let turn = |ratios: [Ratio; 3]| {
            let mut turned = ratios;
            (0..3).for_each(|k| turned[to[k]] = ratios[k]);
            turned
        };
        let moves = self.transitions.iter_mut().filter_map(|transition| transition.moves.as_mut());
        for class in moves.flat_map(|moves| &mut moves.classes) {
            class.displacement = turn(class.displacement);
            class.growth = turn(class.growth);
        }
        for run in self.configurations.iter_mut().flatten().flatten() {
            run.center = turn(run.center);
            run.size = turn(run.size);
            run.counters.iter_mut().for_each(|counter| counter.step = turn(counter.step));
        }
        self
    }

    /// Returns the motion as the body of a plan without an anchor, whose stages all have cause 0.
    pub fn into_stages(self, header: PlanHeader) -> Stages {
        let mut configurations = self.configurations.into_iter();
        let start = configurations.next().flatten().unwrap_or_default();
        let stage = |(transition, end): (Transition, Option<Vec<Run>>)| Stage {
            name: transition.name.into(),
            time_squared: transition.time_squared,
            law: transition.law,
            end: match transition.moves {
                Some(moves) => StageEnd::Moves(moves),
                None => StageEnd::Runs(end.unwrap_or_default()),
            },
            cause: CauseId(0),
        };
        Stages {
            cell: header.cell,
            count: self.count,
            time_unit: header.time_unit,
            limits: header.limits,
            model: header.model,
            anchor: None,
            start,
            stages: self.transitions.into_iter().zip(configurations).map(stage).collect(),
        }
    }

    /// Returns the duration of all transitions together, in units of time ([`Motion`]).
    pub fn duration(&self) -> f64 {
        self.transitions
            .iter()
            .fold(0.0, |time, transition| time + libm::sqrt(transition.time_squared.to_f64()))
    }

    /// Returns true if the total angular momentum of the cells stays zero during the whole motion.
    pub fn is_balanced(&self) -> bool {
        self.transitions.iter().all(|transition| transition.balanced)
    }
}
