//! Ways in closed form: configurations one after another, with the least time of each stage.

use super::Refusal;
use super::domain::{Domain, Spot, WHOLE};
use crate::plan::{CauseId, CellLimits, Counter, Law, Model, Ratio, Run, Stage, Stages};

/// Stages between configurations that name every cell.
#[derive(Clone, Debug)]
pub struct Way {
    pub count: u64,
    /// One more than there are legs. About the centre of mass.
    pub configurations: Vec<Vec<Run>>,
    pub legs: Vec<Leg>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    pub name: &'static str,
    pub time_squared: Ratio,
    pub law: Law,
    /// Whether the angular momentum stays zero.
    pub balanced: bool,
}

/// How the time of a stage is spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// Speeding up for half the time, slowing down for the other, as in the paper.
    #[default]
    BangBang,
    /// With a stretch of constant speed where the speed limit binds: the least time.
    Trapezoid,
}

/// What all ways are planned under.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    pub limits: CellLimits,
    pub profile: Profile,
    /// Whether the length of an acceleration is bounded, not only its part along each axis.
    pub euclidean: bool,
}

/// What a way becomes part of: a plan of cells of a kind.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The cell's index in the library.
    pub cell: usize,
    /// Seconds of the unit of time.
    pub time_unit: f64,
    pub limits: CellLimits,
    pub model: Model,
}

type Place<'a> = Box<dyn Fn(u64) -> Spot + 'a>;

/// Builds a way stage by stage.
pub struct Builder<'a> {
    terms: Terms,
    way: Way,
    last: Place<'a>,
}

/// What moves in a stage: in quarters, before the centre of mass is held.
struct Motion {
    /// Greatest distance along each axis from the centre of mass's own, times `WHOLE · count`.
    farthest: [i128; 3],
    resized: i64,
    moves: bool,
    balanced: bool,
}

impl<'a> Builder<'a> {
    /// `place` must be affine on each of the domains, which hold each of `count` cells once.
    pub fn new(
        terms: Terms,
        count: u64,
        domains: &[Domain],
        place: impl Fn(u64) -> Spot + 'a,
    ) -> Result<Builder<'a>, Refusal> {
        let start = runs(domains, count, &place)?;
        let way = Way { count, configurations: vec![start], legs: vec![] };
        Ok(Builder { terms, way, last: Box::new(place) })
    }

    /// A stage to where `place` says. On the domains the last place and the next must be affine;
    /// `parting` is the greatest distance (in quarters, along an axis) by which two cells move against
    /// each other that are in contact all the while. A stage in which nothing moves is left out.
    pub fn stage(
        &mut self,
        name: &'static str,
        parting: i64,
        domains: &[Domain],
        place: impl Fn(u64) -> Spot + 'a,
    ) -> Result<(), Refusal> {
        let motion = Motion::of(domains, self.way.count, &self.last, &place);
        if motion.moves {
            let (time_squared, law) =
                least_time(&self.terms, self.way.count, &motion, parting).ok_or(Refusal::TooLarge)?;
            self.way.legs.push(Leg { name, time_squared, law, balanced: motion.balanced });
            self.way.configurations.push(runs(domains, self.way.count, &place)?);
        }
        self.last = Box::new(place);
        Ok(())
    }

    /// A motion in two stages that does not rest between them: what is affine over both, with the same
    /// displacement in each.
    pub fn twin_stages(
        &mut self,
        name: &'static str,
        parting: i64,
        domains: &[Domain],
        middle: impl Fn(u64) -> Spot + 'a,
        end: impl Fn(u64) -> Spot + 'a,
    ) -> Result<(), Refusal> {
        let whole = Motion::of(domains, self.way.count, &self.last, &end);
        let resized = 2 * Motion::of(domains, self.way.count, &self.last, &middle).resized;
        let terms = Terms { profile: Profile::Trapezoid, ..self.terms };
        let (time, law) =
            least_time(&terms, self.way.count, &whole, parting.max(resized)).ok_or(Refusal::TooLarge)?;
        let half = Ratio::new(time.0.into(), 4 * i128::from(time.1)).ok_or(Refusal::TooLarge)?;
        let ramp = law.ramps().0.times(Ratio(2, 1)).ok_or(Refusal::TooLarge)?;
        for (law, place) in
            [(Law::SpeedUp(ramp), &middle as &dyn Fn(u64) -> Spot), (Law::SlowDown(ramp), &end)]
        {
            self.way.legs.push(Leg { name, time_squared: half, law, balanced: whole.balanced });
            self.way.configurations.push(runs(domains, self.way.count, &place)?);
        }
        self.last = Box::new(end);
        Ok(())
    }

    pub fn way(self) -> Way {
        self.way
    }
}

/// Square of the least time in which cells can move as they do and part (or change
/// their sizes) by `parting / WHOLE`, with the law that does it.
fn least_time(terms: &Terms, count: u64, motion: &Motion, parting: i64) -> Option<(Ratio, Law)> {
    let parting = parting.max(motion.resized);
    let distance = motion.distance(terms, count)?;
    let parting_squared = Ratio::new(i128::from(parting) * i128::from(parting), i128::from(WHOLE * WHOLE))?;
    let speed = terms.limits.speed_squared;
    // The square of the time for the parting at full speed.
    let coasting = parting_squared.times(Ratio(speed.1, speed.0))?;
    if coasting.order(distance).is_le() {
        return Some((distance.times(Ratio(4, 1))?, Law::BangBang));
    }
    if terms.profile == Profile::Trapezoid && distance.0 > 0 {
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

fn plus(a: Ratio, b: Ratio) -> Option<Ratio> {
    let product = |x: i64, y: i64| i128::from(x) * i128::from(y);
    Ratio::new(product(a.0, b.1).checked_add(product(b.0, a.1))?, product(a.1, b.1))
}

/// An affine function of a domain's counters: its value at the first cell, and the steps.
struct Affine {
    first: Spot,
    /// For each counter, along each axis.
    steps: Vec<[i64; 3]>,
}

impl Affine {
    fn of(domain: &Domain, place: &dyn Fn(u64) -> Spot) -> Affine {
        let first = place(domain.first);
        let step = |&(_, stride): &(u64, i64)| {
            let next = place((domain.first as i64 + stride) as u64);
            [0, 1, 2].map(|axis| next.center[axis] - first.center[axis])
        };
        Affine { first, steps: domain.counters.iter().map(step).collect() }
    }

    /// The sum of the centres along an axis over the domain.
    fn sum(&self, domain: &Domain, axis: usize) -> i128 {
        let count = i128::from(domain.count());
        // Every second factor of count · (c - 1) is even, for c divides the count.
        let spread = domain.counters.iter().zip(&self.steps);
        let halves: i128 =
            spread.map(|((c, _), step)| i128::from(step[axis]) * (i128::from(*c) - 1) * count).sum();
        i128::from(self.first.center[axis]) * count + halves / 2
    }
}

/// The configuration about its centre of mass.
fn runs(domains: &[Domain], count: u64, place: &dyn Fn(u64) -> Spot) -> Result<Vec<Run>, Refusal> {
    crate::interrupt::checkpoint();
    let affine: Vec<Affine> = domains.iter().map(|domain| Affine::of(domain, place)).collect();
    let sum = |axis| domains.iter().zip(&affine).map(|(d, a)| a.sum(d, axis)).sum::<i128>();
    let total = [sum(0), sum(1), sum(2)];
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

/// Into so many parts a distance along several axes is rounded, up: its square is no square number.
const ROOT_PARTS: i128 = 1 << 16;

impl Motion {
    /// What bounds the acceleration: the greatest distance along an axis, or at most the length of the
    /// greatest along all.
    fn distance(&self, terms: &Terms, count: u64) -> Option<Ratio> {
        let whole = i128::from(WHOLE) * i128::from(count);
        let most = self.farthest.into_iter().max().unwrap_or(0);
        if !terms.euclidean || self.farthest.iter().sum::<i128>() == most {
            return Ratio::new(most, whole);
        }
        let square = self.farthest.iter().try_fold(0_i128, |sum, reach| {
            let parts = reach.checked_mul(ROOT_PARTS)?;
            sum.checked_add(parts.checked_mul(parts)?)
        })?;
        let root = square.isqrt();
        let root = root + i128::from(root * root < square);
        Ratio::new(root, whole * ROOT_PARTS)
    }

    fn of(
        domains: &[Domain],
        count: u64,
        before: &dyn Fn(u64) -> Spot,
        after: &dyn Fn(u64) -> Spot,
    ) -> Motion {
        let ends: Vec<(Affine, Affine)> =
            domains.iter().map(|d| (Affine::of(d, before), Affine::of(d, after))).collect();
        let sum = |axis: usize| {
            let moved = |(d, (a, b)): (&Domain, &(Affine, Affine))| b.sum(d, axis) - a.sum(d, axis);
            domains.iter().zip(&ends).map(moved).sum::<i128>()
        };
        let drift = [sum(0), sum(1), sum(2)];
        let mut motion = Motion { farthest: [0; 3], resized: 0, moves: false, balanced: true };
        // Twelve times the sum of place times displacement, as a cross product; both from the origin.
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
        // About the centre of mass, which is held.
        let about = |axis: usize| {
            let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
            i128::from(count) * turning[axis] - 12 * (places[y] * drift[z] - places[z] * drift[y])
        };
        motion.balanced = (0..3).all(|axis| about(axis) == 0);
        motion
    }
}

impl Way {
    /// A way that goes nowhere.
    pub fn rest(count: u64, domains: &[Domain], place: impl Fn(u64) -> Spot) -> Result<Way, Refusal> {
        Ok(Way { count, configurations: vec![runs(domains, count, &place)?], legs: vec![] })
    }

    /// From the end to the start.
    pub fn reversed(mut self) -> Way {
        self.configurations.reverse();
        self.legs.reverse();
        self.legs.iter_mut().for_each(|leg| leg.law = leg.law.reversed());
        self
    }

    /// This way, then another that begins where it ends.
    pub fn then(mut self, next: Way) -> Way {
        self.configurations.extend(next.configurations.into_iter().skip(1));
        self.legs.extend(next.legs);
        self
    }

    /// The axes in another order: what was along axis `k` is along `to[k]`.
    pub fn turned(mut self, to: [usize; 3]) -> Way {
        let turn = |ratios: [Ratio; 3]| {
            let mut turned = ratios;
            (0..3).for_each(|k| turned[to[k]] = ratios[k]);
            turned
        };
        for run in self.configurations.iter_mut().flatten() {
            run.center = turn(run.center);
            run.size = turn(run.size);
            run.counters.iter_mut().for_each(|counter| counter.step = turn(counter.step));
        }
        self
    }

    /// The body of a plan; its one cause is 0.
    pub fn into_stages(self, frame: Frame) -> Stages {
        let mut configurations = self.configurations.into_iter();
        let start = configurations.next().unwrap_or_default();
        let stage = |(leg, end): (Leg, Vec<Run>)| Stage {
            name: leg.name.into(),
            time_squared: leg.time_squared,
            law: leg.law,
            end,
            cause: CauseId(0),
        };
        Stages {
            cell: frame.cell,
            count: self.count,
            time_unit: frame.time_unit,
            limits: frame.limits,
            model: frame.model,
            start,
            stages: self.legs.into_iter().zip(configurations).map(stage).collect(),
        }
    }

    /// In units of time.
    pub fn duration(&self) -> f64 {
        self.legs.iter().fold(0.0, |time, leg| time + libm::sqrt(leg.time_squared.to_f64()))
    }

    pub fn is_balanced(&self) -> bool {
        self.legs.iter().all(|leg| leg.balanced)
    }
}
