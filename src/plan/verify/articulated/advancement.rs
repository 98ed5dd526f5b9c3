//! Conservative advancement for collisions and for the clearance, by bisection of intervals of time: pairs that
//! a bound on motion proves to be separated over an interval are done with (Schwarzer, Saha and Latombe 2005; see
//! [`collision`](super::collision)).

use super::bodies::{Bodies, InnerPair};
use super::bonded::{BondedLinks, NominalOverlaps};
use super::collision::{self, Collision, Excuse, Findings};
use super::interval_state::IntervalState;
use super::module_clusters::{Cluster, ClusterBounds, ClusterPair, NEARLY, Proximity, Scene};
use super::motion_bounds::{JointMotions, MotionBounds};
use super::polyline::Polyline;
use super::reference_links::{self, ReferenceLinks};
use super::repetition::Repetition;
use super::separation::{self, BodyPair, Bound, ModulePair, Slab, View};
use super::tolerances::Precision;
use super::work_budget::{DISTANCE_WORK, LINK_WORK, MODULES_SMALL, SLAB_WORK, WorkBudget};
use crate::geometry::Vec3;
use crate::geometry::distance::Needed;
use crate::interrupt;
use crate::plan::{Exemption, Tracks, Worst};
use crate::robot::{Assembly, Kinematics};
use crate::units::{Dimension, quantity};
use std::collections::{BTreeMap, BTreeSet};

/// The search for the collisions and the clearance of a plan by conservative advancement: the robot, the limits of
/// the work, and the findings in the windows of time examined so far.
pub(super) struct Advancement<'a> {
    robot: &'a Assembly,
    /// The convex bodies of the robot's links.
    pub bodies: &'a Bodies,
    /// The least penetration depth that any two modules are allowed, m.
    allowed_min: f64,
    /// The instants at which segments begin and end: intervals are preferably cut at them.
    instants: Vec<f64>,
    precision: Precision,
    /// The greatest number of intervals that may be examined.
    samples_max: usize,
    /// The number of intervals examined so far.
    samples: usize,
    /// The work done so far, and the most that may be done.
    pub work: WorkBudget,
    /// True if the least distance is sought, and not only collisions.
    seeks_clearance: bool,
    /// The least signed distance found so far of links that may not touch; `None` before the first.
    clearance: Option<Clearance>,
    /// The collisions so far. The key: the indices of the two modules, and true if an exemption excuses it.
    collisions: BTreeMap<(usize, usize, bool), Collision>,
    /// The indices in the plan's list of the exemptions that excused a collision.
    used: BTreeSet<usize>,
    /// The overlaps of bonded links computed so far.
    overlaps: NominalOverlaps,
    /// The state of the robot over the present interval.
    pub state: IntervalState,
    /// The bounding spheres of clusters of modules over the present interval.
    clusters: ClusterBounds,
    /// The intervals of time that need not be examined, as they repeat earlier ones.
    pub repetition: Repetition,
    /// Emptied lists of pairs, whose memory is used again.
    spare: Vec<Vec<BodyPair>>,
}

/// The least signed distance, m, with its time (s) and the indices of the two modules.
struct Clearance {
    distance: f64,
    time: f64,
    modules: (usize, usize),
}

/// A part of the robot that bonds connect, over a window of time in which those bonds stay.
pub(super) struct Region<'a> {
    /// The kinematics of the part, from a link in its middle.
    pub kinematics: Kinematics,
    /// The reference links of its pairs of modules.
    levels: ReferenceLinks,
    /// The position of each module, by its index in the assembly, in the breadth-first order of the tree of modules.
    rank: Vec<usize>,
    /// The pairs of links that bonds join.
    pub bonded: BondedLinks,
    /// The exemptions that hold in the window.
    excused: &'a [Excuse],
}

/// The mark of an interval no longer than `tol_time`, in which a penetration that is found is the first of its two
/// modules: before it they are proved to be separated.
#[derive(Clone, Copy, Default)]
pub(super) struct Instant {
    /// The bond at whose nominal pose the links penetrate each other; `None` if a motion brings them there.
    pub bond: Option<usize>,
}

/// The error of a distance that need not be exact, as a part of the distance that the pair may come nearer by in the
/// interval: a direction that is so good does not need many more halvings than the best.
const MOTION_PART: f64 = 0.1;

/// The state of two modules over an interval.
enum ModuleProximity {
    /// They are separated.
    Separated,
    /// They stay open as a pair.
    Open,
    /// Their bounding spheres meet in the middle, or nearly so.
    Near,
}

/// The pairs that are not proved to be separated.
#[derive(Clone, Default)]
struct Open {
    clusters: Vec<ClusterPair>,
    bodies: Vec<BodyPair>,
}

impl<'a> Advancement<'a> {
    /// Returns a search along the motion that a plan prescribes, before the first window. `bodies`: those of the
    /// plan's robot; `precision`: the depth (m), distance (m) and time (s) to which it is exact; at most
    /// `samples_max` intervals are examined.
    pub(super) fn new(
        tracks: &'a Tracks,
        bodies: &'a Bodies,
        precision: Precision,
        samples_max: usize,
    ) -> Advancement<'a> {
        Advancement {
            robot: &tracks.robot,
            allowed_min: bodies.least_allowed_depth(),
            bodies,
            instants: tracks.instants(),
            precision,
            samples_max,
            samples: 0,
            work: WorkBudget::new(samples_max, tracks.robot.modules.len()),
            seeks_clearance: true,
            clearance: None,
            collisions: BTreeMap::new(),
            used: BTreeSet::new(),
            overlaps: NominalOverlaps::default(),
            state: IntervalState::new(JointMotions::Planned(MotionBounds::new(tracks))),
            clusters: ClusterBounds::default(),
            repetition: Repetition::default(),
            spare: Vec::new(),
        }
    }

    /// Returns a search for collisions alone, without the clearance, along the positions of the joints `along` in
    /// place of the plan's. Intervals are halved down to the least time between two instants of `along`, but not below
    /// [`DEFLECTED_TIME_MIN`](super::tolerances::DEFLECTED_TIME_MIN): what happens between instants is not proved.
    pub(super) fn deflected(
        tracks: &'a Tracks,
        bodies: &'a Bodies,
        along: Polyline,
        samples_max: usize,
    ) -> Advancement<'a> {
        let instants = along.times().to_vec();
        let spacing = instants.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let precision =
            Precision { tol_time: spacing.max(Precision::DEFLECTED_TIME_MIN), ..Precision::default() };
        let planned = Advancement::new(tracks, bodies, precision, samples_max);
        let state = IntervalState::new(JointMotions::Deflected(along));
        Advancement { instants, state, seeks_clearance: false, ..planned }
    }

    /// Examines a window of time (from, to; s) in which bonds stay as they are, and adds to the findings. `bonds`:
    /// for each bond of the assembly, by index, true if it holds; `excused`: the exemptions that hold in the window.
    /// Parts of the robot that no bond connects are examined each by itself: their relative pose is unknown.
    pub(super) fn window(&mut self, bonds: &[bool], window: (f64, f64), excused: &[Excuse]) {
        let mut seen = vec![false; self.robot.modules.len()];
        while let Some(first) = seen.iter().position(|seen| !seen) {
            let part = Kinematics::new(self.robot, bonds, first);
            part.tree.order.iter().for_each(|(module, _)| seen[*module] = true);
            // From the middle of the part, paths are short and numbers small.
            let kinematics = Kinematics::new(self.robot, bonds, reference_links::middle(self.robot, &part));
            let levels = ReferenceLinks::new(self.robot, &kinematics);
            let bonded = BondedLinks::new(self.robot, bonds, &kinematics, self.bodies, &mut self.overlaps);
            let mut rank = vec![0; self.robot.modules.len()];
            kinematics.tree.order.iter().enumerate().for_each(|(at, (module, _))| rank[*module] = at);
            let region = Region { kinematics, levels, rank, bonded, excused };
            self.fixed_pairs(&region, window.0);
            self.rigid_bonds(&region);
            let mut within = Vec::new();
            for &(module, _) in &region.kinematics.tree.order {
                self.within(&region, module, &mut within);
            }
            self.state.set(&region.kinematics, window.0, window.0);
            if self.seeks_clearance {
                self.guess_clearance(&region, window.0, &within);
            }
            self.enclosed(&region, window.0);
            let clusters = ClusterPair::all(&region.levels, &region.kinematics);
            self.advance(&region, window.0, window.1, Open { clusters, bodies: within });
        }
    }

    /// Returns the least signed distance of links that may not touch at one instant (s), m; `None` if there are no two
    /// such links. `bonds`: for each bond of the assembly, true if it holds. Forgets the collisions found so far.
    pub(super) fn clearance_at(&mut self, bonds: &[bool], time: f64) -> Option<f64> {
        self.clearance = None;
        self.collisions.clear();
        self.window(bonds, (time, time), &[]);
        self.clearance.as_ref().map(|nearest| nearest.distance)
    }

    /// Returns the collisions, the clearance and the status that follow from all windows; `exemptions`: the plan's
    /// list, to which the indices in `Findings::used` refer.
    pub(super) fn findings(self, exemptions: &[Exemption]) -> Findings {
        let reached_limit = self.reached_limit();
        let mut collisions: Vec<Collision> = self.collisions.into_values().collect();
        collisions.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.modules.cmp(&b.modules)));
        let gave_up = reached_limit.then_some(self.samples);
        let status = collision::status(gave_up, &collisions, self.clearance.as_ref().map(|c| c.distance));
        let name = |module: usize| self.robot.modules[module].name.clone();
        let clearance = self.clearance.map(|nearest| {
            let (a, b) = nearest.modules;
            let at = if a == b { vec![name(a)] } else { vec![name(a), name(b)] };
            Worst { value: nearest.distance, time: nearest.time, at }
        });
        let used = self.used.into_iter().filter(|index| *index < exemptions.len()).collect();
        Findings { status, collisions, clearance, samples: self.samples, used }
    }

    /// Appends the pairs of bodies within a module that joints move.
    fn within(&self, region: &Region, module: usize, out: &mut Vec<BodyPair>) {
        let level = region.levels.between(module, module) as u32;
        let first = self.bodies.of(module).start;
        let moved = self.bodies.inner(module).iter().filter(|inner| inner.fixed.is_none());
        out.extend(moved.map(|inner| inner_pair(inner, first, level)));
    }

    /// Appends the pairs of bodies of two modules. Links that a rigid bond joins are known once and for all; the
    /// distance of others that a bond joins is no clearance.
    fn expand(&self, region: &Region, m: usize, n: usize, out: &mut Vec<BodyPair>) {
        let level = region.levels.between(m, n) as u32;
        for a in self.bodies.of(m) {
            for b in self.bodies.of(n) {
                out.extend(self.pair_of_modules(region, level, (a, b)));
            }
        }
    }

    /// Returns the pair of two bodies of different modules, given by their indices in [`Bodies::bodies`]; `None` if a
    /// rigid bond joins their links, which is judged once instead. `level`: that of their reference link, an index in
    /// [`ReferenceLinks::levels`].
    pub(super) fn pair_of_modules(
        &self,
        region: &Region,
        level: u32,
        (a, b): (usize, usize),
    ) -> Option<BodyPair> {
        let (x, y) = (&self.bodies.bodies[a], &self.bodies.bodies[b]);
        let bonded = region.bonded.get(x.link, y.link);
        if bonded.is_some_and(|pair| pair.rigid) {
            return None;
        }
        let touch = self.bodies.allowed_depth(x.module, y.module);
        let allowed = bonded.map_or(touch, |pair| pair.allowed(x, y, touch));
        let (a, b, counts) = (a as u32, b as u32, bonded.is_none());
        Some(BodyPair { a, b, level, counts, allowed, normal: Vec3::zeros() })
    }

    /// Measures within modules and between neighbours at one instant, whose state is set, so that the search begins
    /// with a clearance that few pairs can go below. In a large robot of which neither count, it measures between the
    /// root and others.
    fn guess_clearance(&mut self, region: &Region, time: f64, within: &[BodyPair]) {
        let mut near = within.to_vec();
        for &(module, bond) in &region.kinematics.tree.order {
            let Some(bond) = bond.map(|b| &self.robot.bonds[b]) else { continue };
            let (a, b) = (bond.a.module, bond.b.module);
            debug_assert!(module == a || module == b);
            self.expand(region, a.min(b), a.max(b), &mut near);
        }
        self.measure_all(region, near, time);
        let order = &region.kinematics.tree.order;
        if order.len() > MODULES_SMALL {
            let root = order[0].0;
            for &(module, _) in order[1..].iter() {
                if self.clearance.is_some() {
                    break;
                }
                let mut near = Vec::new();
                self.expand(region, root.min(module), root.max(module), &mut near);
                self.measure_all(region, near, time);
            }
        }
    }

    /// Measures the distances that count for the clearance at the instant whose state is set.
    fn measure_all(&mut self, region: &Region, mut pairs: Vec<BodyPair>, time: f64) {
        for pair in pairs.iter_mut().filter(|pair| pair.counts) {
            let exact = (0.0, self.least());
            for body in [pair.a, pair.b] {
                self.state.require(&region.kinematics, self.bodies.bodies[body as usize].carrier);
            }
            self.measure(pair, exact, time);
        }
    }

    /// Discards the pairs that are separated over `from..to` (s), and goes on with the rest in two halves.
    fn advance(&mut self, region: &Region, from: f64, to: f64, open: Open) {
        // Without a collision so far, every pair of links is proved to be free of one up to `from`.
        let is_known = self.collisions.is_empty() && self.repetition.repeats(from, to);
        if is_known || !self.begin_interval(from) {
            return;
        }
        self.state.set(&region.kinematics, from, to);
        let Open { clusters, mut bodies } = open;
        let clusters = self.examine(region, clusters, &mut bodies);
        self.halve(region, from, to, Open { clusters, bodies });
    }

    /// Returns those of the pairs of modules that stay open as such, in clusters. Only where the bounding spheres of
    /// two modules meet in the middle, or nearly so, are their bodies added to `bodies` instead: they are dozens of
    /// pairs for one, which costs more than a few halvings.
    fn examine(
        &mut self,
        region: &Region,
        mut pairs: Vec<ClusterPair>,
        bodies: &mut Vec<BodyPair>,
    ) -> Vec<ClusterPair> {
        let least = self.least() - self.precision.tol_clearance;
        let needs = (least, least.max(-self.allowed_min - self.precision.tol_depth));
        let mut open = Vec::new();
        let mut near = Vec::new();
        while let Some(pair) = pairs.pop() {
            interrupt::checkpoint();
            if self.reached_limit() {
                break;
            }
            self.work.spend(1);
            if let (Cluster::Module(a), Cluster::Module(b)) = (pair.a, pair.b) {
                let modules = ModulePair { a: a.min(b), b: a.max(b), level: pair.level };
                match self.proximity(region, &modules) {
                    ModuleProximity::Separated => {}
                    ModuleProximity::Open => open.push(pair),
                    ModuleProximity::Near => {
                        self.work.spend(DISTANCE_WORK);
                        near.push((modules.a as usize, modules.b as usize));
                    }
                }
                continue;
            }
            let Region { kinematics, levels, .. } = region;
            let scene = Scene { bodies: self.bodies, kinematics, levels };
            match self.clusters.proximity(&mut self.state, &scene, &pair, needs) {
                Proximity::Separated => {}
                Proximity::Open => open.push(pair),
                Proximity::Undecided(first) => pair.split(first, levels, &mut pairs),
            }
        }
        // In the order of the tree, whatever the clusters are.
        near.sort_unstable_by_key(|&(a, b)| {
            let (x, y) = (region.rank[a], region.rank[b]);
            (x.max(y), x.min(y))
        });
        near.iter().for_each(|&(a, b)| self.expand(region, a, b, bodies));
        open
    }

    /// Counts an interval; returns false where a limit is reached.
    fn begin_interval(&mut self, from: f64) -> bool {
        interrupt::progress_checkpoint(|| {
            let least = self.clearance.as_ref().map_or_else(String::new, |nearest| {
                format!(", clearance {} so far", quantity(nearest.distance, Dimension::LENGTH))
            });
            let at = quantity(from, Dimension::TIME);
            format!("looked for collisions up to {at}, {} stretches{least}", self.samples)
        });
        self.work.spend(LINK_WORK * self.state.take_computed());
        let within = !self.reached_limit();
        self.samples += usize::from(within);
        within
    }

    /// Returns true where as many intervals were examined, or as much work was done, as may be.
    fn reached_limit(&self) -> bool {
        self.samples >= self.samples_max || self.work.is_spent()
    }

    /// Discards the pairs of bodies that are separated over an interval, and goes on with the rest in two halves.
    fn halve(&mut self, region: &Region, from: f64, to: f64, open: Open) {
        let Open { clusters, mut bodies } = open;
        bodies.retain_mut(|pair| !self.is_separated(region, pair, to - from));
        let done = clusters.is_empty() && bodies.is_empty();
        if done || to - from <= self.precision.tol_time {
            self.spare.push(bodies);
            return;
        }
        let cut = self.cut(from, to);
        let mut copy = self.spare.pop().unwrap_or_default();
        copy.clone_from(&bodies);
        self.advance(region, from, cut, Open { clusters: clusters.clone(), bodies: copy });
        self.advance(region, cut, to, Open { clusters, bodies });
    }

    /// Returns the time at which to cut an interval (s): at an event in its middle half, or in the middle.
    fn cut(&self, from: f64, to: f64) -> f64 {
        let (middle, quarter) = ((from + to) / 2.0, (to - from) / 4.0);
        let after = self.instants.partition_point(|t| *t < middle);
        let around = self.instants[after.saturating_sub(1)..].iter().take(2).copied();
        let near = around.filter(|t| (t - middle).abs() < quarter);
        near.min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs())).unwrap_or(middle)
    }

    /// Returns the state of two modules over the interval, by their bounding spheres.
    fn proximity(&mut self, region: &Region, pair: &ModulePair) -> ModuleProximity {
        let (a, b) = (pair.a as usize, pair.b as usize);
        let Region { kinematics, levels, .. } = region;
        for module in [a, b] {
            let link = kinematics.link(module, 0);
            self.state.require_deviation(kinematics, levels, pair.level as usize, link);
        }
        let bound = separation::module_bound(&self.view(region), self.bodies, pair);
        let need = self.need(region, a, b, true, self.bodies.allowed_depth(a, b));
        let near = NEARLY * (self.bodies.reach[a] + self.bodies.reach[b]);
        if bound.least >= need {
            ModuleProximity::Separated
        } else if bound.middle >= need + near {
            ModuleProximity::Open
        } else {
            ModuleProximity::Near
        }
    }

    /// Returns true if two bodies are proved to have the distance that they need over the whole interval of this
    /// length (s).
    fn is_separated(&mut self, region: &Region, pair: &mut BodyPair, length: f64) -> bool {
        crate::interrupt::checkpoint();
        let (a, b) = (pair.a as usize, pair.b as usize);
        for body in [a, b] {
            let carrier = self.bodies.bodies[body].carrier;
            let (kinematics, levels) = (&region.kinematics, &region.levels);
            self.state.require_deviation(kinematics, levels, pair.level as usize, carrier);
        }
        self.work.spend(1);
        let need = self.need_of(region, pair);
        let mut bound = separation::sphere_bound(
            &self.view(region),
            &self.bodies.bodies[a],
            &self.bodies.bodies[b],
            pair.level,
        );
        if bound.least >= need {
            return true;
        }
        if pair.normal != Vec3::zeros() {
            self.work.spend(SLAB_WORK);
            let slab = self.slab(region, pair);
            bound = Bound { least: slab.least(), middle: slab.middle() };
            // If it fails by motion alone, another direction would not help before the interval is
            // a quarter. A pair that comes nearer is measured all the same, so that the clearance follows it and
            // leaves room.
            let is_new_least =
                pair.counts && bound.middle < self.least() - self.precision.tol_clearance / 2.0;
            let by_motion = bound.middle >= need + (bound.middle - bound.least) / 4.0;
            if !is_new_least && (bound.least >= need || by_motion) {
                return bound.least >= need;
            }
        }
        self.work.spend(DISTANCE_WORK + SLAB_WORK);
        let time = self.state.interval.middle;
        let motion = bound.middle - bound.least;
        let distance = self.measure(pair, (MOTION_PART * motion, need + 2.0 * motion), time);
        if distance < -pair.allowed {
            let instant = (length <= self.precision.tol_time).then(Instant::default);
            self.collide(region, pair, distance, instant);
        }
        self.slab(region, pair).least() >= self.need_of(region, pair)
    }

    fn view<'v>(&'v self, region: &'v Region) -> View<'v> {
        View { state: &self.state, levels: &region.levels, kinematics: &region.kinematics }
    }

    fn slab<'s>(&'s self, region: &'s Region, pair: &BodyPair) -> Slab<'s> {
        let [a, b] = [pair.a, pair.b].map(|body| &self.bodies.bodies[body as usize]);
        Slab::new(&self.view(region), a, b, pair)
    }

    fn need_of(&self, region: &Region, pair: &BodyPair) -> f64 {
        let module = |body: u32| self.bodies.bodies[body as usize].module;
        self.need(region, module(pair.a), module(pair.b), pair.counts, pair.allowed)
    }

    /// Returns the distance that two bodies of these modules must be proved to have: none deeper than
    /// allowed, none nearer than the clearance if that is more. Once they are known to collide only the
    /// greatest depth is sought.
    fn need(&self, region: &Region, a: usize, b: usize, counts: bool, allowed: f64) -> f64 {
        let mut free = -allowed - self.precision.tol_depth;
        if !self.collisions.is_empty()
            && let Some(known) = self.collisions.get(&(a, b, self.excuse(region, a, b).is_some()))
        {
            free = free.min(-known.depth - self.precision.tol_clearance);
        }
        if counts { free.max(self.least() - self.precision.tol_clearance) } else { free }
    }

    /// Returns the clearance so far, m; minus infinity where none is sought, as no distance needs to be proved for it.
    fn least(&self) -> f64 {
        if !self.seeks_clearance {
            return f64::NEG_INFINITY;
        }
        self.clearance.as_ref().map_or(f64::MAX, |c| c.distance)
    }

    fn excuse<'r>(&self, region: &Region<'r>, a: usize, b: usize) -> Option<&'r Excuse> {
        region.excused.iter().find(|excuse| excuse.covers(a, b))
    }

    /// Measures the distance of a pair in the middle of the interval, m, and keeps the least: exactly below the
    /// clearance, elsewhere a lower bound, which is too small by at most `within` (m) below `enough` (m) and proves a
    /// separation.
    fn measure(&mut self, pair: &mut BodyPair, (within, enough): (f64, f64), time: f64) -> f64 {
        let (a, b) = (&self.bodies.bodies[pair.a as usize], &self.bodies.bodies[pair.b as usize]);
        let exact_below = if pair.counts { self.least() } else { 0.0 };
        let needed = Needed { exact_below, within, enough: enough.max(exact_below) };
        let distance = separation::measure(&self.state, a, b, pair, &needed);
        if distance < exact_below {
            self.count(pair, distance, time);
        }
        distance
    }

    /// Keeps the distance (m) of a pair at a time (s) as the clearance, if the pair counts for it and no lesser one
    /// was found. Does nothing in a search for collisions alone.
    pub(super) fn count(&mut self, pair: &BodyPair, distance: f64, time: f64) {
        if self.seeks_clearance
            && pair.counts
            && self.clearance.as_ref().is_none_or(|c| distance < c.distance)
        {
            let modules = [pair.a, pair.b].map(|body| self.bodies.bodies[body as usize].module);
            self.clearance = Some(Clearance { distance, time, modules: (modules[0], modules[1]) });
        }
    }

    /// Records that a pair penetrates in the middle of the present interval, where its signed distance is `distance`
    /// (m, negative). A known collision of the two modules only takes in the depth, if it is greater. A new one is
    /// recorded only if `instant` marks an interval short enough to be its first instant; `None` leaves it to shorter
    /// intervals.
    pub(super) fn collide(
        &mut self,
        region: &Region,
        pair: &BodyPair,
        distance: f64,
        instant: Option<Instant>,
    ) {
        let (a, b) = (&self.bodies.bodies[pair.a as usize], &self.bodies.bodies[pair.b as usize]);
        let excuse = self.excuse(region, a.module, b.module);
        let key = (a.module, b.module, excuse.is_some());
        let (depth, time) = (-distance, self.state.interval.middle);
        if let Some(known) = self.collisions.get_mut(&key) {
            if depth > known.depth {
                (known.depth, known.deepest) = (depth, time);
            }
        } else if let Some(Instant { bond }) = instant {
            self.used.extend(excuse.map(|excuse| excuse.index));
            let link = |link: usize, module: usize| link - region.kinematics.link(module, 0);
            let collision = Collision {
                modules: (a.module, b.module),
                links: (link(a.link, a.module), link(b.link, b.module)),
                time,
                depth,
                deepest: time,
                allowed: pair.allowed,
                exempt: excuse.is_some(),
                bond,
            };
            self.collisions.insert(key, collision);
        }
    }
}

/// Returns a pair of bodies within a module. `first`: the index of the module's first body in [`Bodies::bodies`];
/// `level`: that of the pair's reference link, an index in [`ReferenceLinks::levels`].
pub(super) fn inner_pair(inner: &InnerPair, first: usize, level: u32) -> BodyPair {
    let (a, b) = ((first + inner.a) as u32, (first + inner.b) as u32);
    BodyPair { a, b, level, counts: inner.counts, allowed: inner.allowed, normal: Vec3::zeros() }
}
