//! The search: chains that become one, two ends at a time.

use super::chains::Chains;
use super::ends::{Ends, ends};
use super::refusal::{Refusal, Status};
use super::settings::{LINKS_MAX, SLIDE_SPAN, Settings};
use super::tolerances::TOL_STRAIGHT;
use crate::geometry::Pose;
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use crate::planners::goals::{FreeSpace, Surroundings, avoid, names, ranges, reach};
use crate::robot::chain::{Chain, ChainJoint, Orientation, Target};
use crate::robot::jacobian::LinkFrame;
use crate::robot::{Assembly, Bond, Kinematics, PortRef, State, mate};
use std::f64::consts::{PI, TAU};

/// A step on the way to the snake; bonds by their index among all of the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Step {
    /// All joints go straight to these positions, rad or m, by the number in their `JointId`.
    Turn(Vec<f64>),
    /// A bond is made.
    Dock(usize),
    /// A bond is let go.
    Undock(usize),
}

/// The search for the steps from a robot to a snake.
pub(super) struct Search<'a> {
    settings: &'a Settings,
    /// The robot with every bond that was made on the way.
    pub(super) robot: Assembly,
    /// The state after the steps so far.
    state: State,
    ends: Ends,
    /// True if all modules are to lie alike in the snake.
    alike: bool,
    /// The joints that take commands.
    joints: Vec<ChainJoint>,
    /// The range of every joint, rad or m.
    limits: Vec<(f64, f64)>,
    names: Vec<String>,
    /// The steps so far.
    pub(super) steps: Vec<Step>,
    /// The number of attempts to bring two ends together.
    pub(super) tried: u64,
    /// The number of postures that were examined.
    pub(super) work: u64,
    rng: SplitMix64,
}

impl<'a> Search<'a> {
    /// Prepares the search from a robot in a state. `alike`: true if all modules are to lie alike in the snake.
    ///
    /// # Errors
    /// A [`Refusal`] where modules lack what the method needs, or the robot is in pieces.
    pub(super) fn new(
        robot: &Assembly,
        start: &State,
        settings: &'a Settings,
        alike: bool,
    ) -> Result<Search<'a>, Refusal> {
        let ends = ends(robot).map_err(Refusal::Unfit)?;
        let links = (0..robot.modules.len()).map(|module| robot.module_type(module).links.len()).sum();
        if links > LINKS_MAX {
            return Err(Refusal::Links { found: links, limit: LINKS_MAX });
        }
        let owners: Vec<_> = robot.joints().collect();
        let movable = |(joint, owner): (usize, &_)| ChainJoint::commanded(robot, *owner, joint);
        let joints: Vec<ChainJoint> = owners.iter().enumerate().filter_map(movable).collect();
        if let Some(module) = Chains::new(robot, &start.bonds, &ends, alike).apart() {
            return Err(Refusal::Pieces(module));
        }
        Ok(Search {
            settings,
            robot: robot.clone(),
            state: start.clone(),
            ends,
            alike,
            joints,
            limits: ranges(robot),
            names: names(robot),
            steps: Vec::new(),
            tried: 0,
            work: 0,
            rng: SplitMix64(settings.seed),
        })
    }

    fn chains(&self) -> Chains<'_> {
        Chains::new(&self.robot, &self.state.bonds, &self.ends, self.alike)
    }

    /// Returns the least number of bonds that any plan has to dock or undock from the start to a snake of these ends.
    pub(super) fn fewest_changes(&self, start: &State) -> usize {
        Chains::new(&self.robot, &start.bonds, &self.ends, false).fewest_changes()
    }

    fn status(&self) -> Status {
        let needed = self.robot.modules.len() - 1;
        Status { needed, made: self.chains().made(), tried: self.tried, work: self.work }
    }

    /// Finds the steps to the snake.
    ///
    /// # Errors
    /// A [`Refusal`] where the search does not come to its end.
    pub(super) fn run(&mut self, progress: &mut dyn Progress) -> Result<(), Refusal> {
        self.require_free()?;
        for bond in self.chains().loops() {
            self.let_go(bond);
        }
        self.straighten(progress)?;
        let mut rounds = 0;
        while self.status().made < self.status().needed {
            if self.merge(progress)? {
                rounds = 0;
            } else if rounds == self.settings.rounds_max {
                return Err(Refusal::Exhausted(self.status()));
            } else {
                rounds += 1;
                // Joints turn at random, and every other time a branch is moved elsewhere.
                self.perturb()?;
                if rounds % 2 == 0 {
                    self.rearrange(progress)?;
                }
            }
            self.check(progress)?;
        }
        self.straighten(progress)?;
        self.straighten_round_about(progress)
    }

    /// Ends the search where its budget is spent or the observer says so.
    fn check(&self, progress: &mut dyn Progress) -> Result<(), Refusal> {
        if !progress.should_continue() {
            return Err(Refusal::Stopped(self.status()));
        }
        if self.work > self.settings.budget {
            return Err(Refusal::BudgetSpent(self.status()));
        }
        progress.report(&|| {
            let Status { made, needed, .. } = self.status();
            format!("{made} of {needed} connections made")
        });
        Ok(())
    }

    fn let_go(&mut self, bond: usize) {
        self.state.bonds[bond] = false;
        self.steps.push(Step::Undock(bond));
    }

    fn turn(&mut self, joints: Vec<f64>) {
        if joints != self.state.joints {
            self.state.joints.clone_from(&joints);
            self.steps.push(Step::Turn(joints));
        }
    }

    /// Returns the world poses of all links, the base module's body at the origin.
    fn poses(&self) -> Vec<Pose> {
        let kinematics = Kinematics::new(&self.robot, &self.state.bonds, self.robot.base);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&self.state.joints, &Pose::identity(), &mut poses);
        poses
    }

    /// Runs `look` in the free space of some joints, by the number in their `JointId`, while a module stays where it is.
    fn within_space<T>(
        &mut self,
        held: usize,
        joints: &[usize],
        look: impl FnOnce(&mut FreeSpace<'_>, &Search<'_>) -> T,
    ) -> Result<T, Refusal> {
        let poses = self.poses();
        let around = Surroundings {
            robot: &self.robot,
            state: &self.state,
            poses: &poses,
            obstacles: &[],
            floor: false,
        };
        let mut space =
            FreeSpace::new(around, held, joints, self.settings.clearance).map_err(Refusal::Unsound)?;
        let found = look(&mut space, self);
        let work = space.work;
        self.work += work;
        Ok(found)
    }

    /// Requires that nothing meets at the start.
    ///
    /// # Errors
    /// [`Refusal::Overlap`] where two bodies are in each other.
    fn require_free(&mut self) -> Result<(), Refusal> {
        let all: Vec<usize> = self.joints.iter().map(|joint| joint.joint).collect();
        let meeting =
            self.within_space(self.robot.base, &all, |space, search| space.meeting(&search.state.joints))?;
        meeting.map_or(Ok(()), |meeting| Err(Refusal::Overlap(meeting)))
    }

    /// Returns the position of a joint that counts as straight and is nearest: zero, or a whole turn.
    fn straight(&self, joint: &ChainJoint) -> f64 {
        let at = self.state.joints[joint.joint];
        let (low, high) = joint.limits;
        if !joint.slides && low == f64::NEG_INFINITY && high == f64::INFINITY {
            return TAU * libm::round(at / TAU);
        }
        f64::clamp(0.0, low, high)
    }

    /// Returns the joints that are not straight.
    fn bent(&self) -> Vec<ChainJoint> {
        let is_bent = |joint: &&ChainJoint| {
            (self.state.joints[joint.joint] - self.straight(joint)).abs() > TOL_STRAIGHT
        };
        self.joints.iter().filter(is_bent).copied().collect()
    }

    /// Returns all positions with these joints straight.
    fn straightened(&self, bent: &[ChainJoint]) -> Vec<f64> {
        let mut to = self.state.joints.clone();
        for joint in bent {
            to[joint.joint] = self.straight(joint);
        }
        to
    }

    /// Turns joints to zero as far as nothing meets: all at once, in halves of halves, and one by one, as long as that gets on.
    fn straighten(&mut self, progress: &mut dyn Progress) -> Result<(), Refusal> {
        loop {
            let bent = self.bent();
            let before = bent.len();
            let mut open = vec![bent];
            while let Some(part) = open.pop() {
                if part.is_empty() || self.straighten_together(&part)? {
                    continue;
                }
                self.check(progress)?;
                if part.len() > 1 {
                    let (first, second) = part.split_at(part.len() / 2);
                    open.extend([second.to_vec(), first.to_vec()]);
                }
            }
            let left = self.bent().len();
            if left == 0 || left == before {
                return Ok(());
            }
        }
    }

    /// Turns these joints to zero together; returns false if that is not free.
    fn straighten_together(&mut self, bent: &[ChainJoint]) -> Result<bool, Refusal> {
        let to = self.straightened(bent);
        let joints: Vec<usize> = bent.iter().map(|joint| joint.joint).collect();
        let is_free = self.within_space(self.robot.base, &joints, |space, search| {
            space.is_way_free(&search.state.joints, &to)
        })?;
        if is_free {
            self.turn(to);
        }
        Ok(is_free)
    }

    /// Turns the joints that are left to zero along a way that need not be straight.
    ///
    /// # Errors
    /// [`Refusal::Bent`] where there is none.
    fn straighten_round_about(&mut self, progress: &mut dyn Progress) -> Result<(), Refusal> {
        let bent = self.bent();
        if bent.is_empty() {
            return Ok(());
        }
        let to = self.straightened(&bent);
        let all: Vec<usize> = self.joints.iter().map(|joint| joint.joint).collect();
        let settings = avoid::Settings { seed: self.rng.next_u64(), ..avoid::Settings::default() };
        let found = self.within_space(self.robot.base, &all, |space, search| {
            let problem = avoid::Problem { from: &search.state.joints, to: &to, limits: &search.limits };
            avoid::plan(&problem, space, &settings, progress)
        })?;
        match found {
            Ok(path) => path.postures.into_iter().skip(1).for_each(|posture| self.turn(posture)),
            Err(avoid::Refusal::Stopped) => return Err(Refusal::Stopped(self.status())),
            Err(_) => {
                let names = bent.iter().map(|joint| self.names[joint.joint].clone());
                return Err(Refusal::Bent(names.collect()));
            }
        }
        Ok(())
    }

    /// Brings two ends of different chains together, docks them, and lets the bond go that the new one replaces; returns false
    /// if no pair that was tried came together.
    fn merge(&mut self, progress: &mut dyn Progress) -> Result<bool, Refusal> {
        let mut pairs = self.chains().pairs();
        let poses = self.poses();
        let kinematics = Kinematics::new(&self.robot, &self.state.bonds, self.robot.base);
        let place = |port: PortRef| kinematics.port_pose(&self.robot, port, &poses).translation.vector;
        let apart = |pair: &[PortRef; 2]| (place(pair[0]) - place(pair[1])).norm();
        pairs.sort_by(|p, q| apart(p).total_cmp(&apart(q)));
        pairs.truncate(self.settings.pairs_max);
        for [a, b] in pairs {
            let turns = if self.alike { 1 } else { self.robot.connector(a).turns };
            for turn in 0..turns {
                if self.join(Bond { a, b, turn }, progress, |replaced, _| replaced[0])? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Joins two docks of different chains that need not be ends, at random, and lets another bond of the loop go; returns false
    /// if no pair that was tried came together.
    fn rearrange(&mut self, progress: &mut dyn Progress) -> Result<bool, Refusal> {
        let mut pairs = self.chains().other_pairs();
        self.rng.shuffle(&mut pairs);
        pairs.truncate(self.settings.pairs_max);
        for [a, b] in pairs {
            let turns = self.robot.connector(a).turns as usize;
            let turn = u32::try_from(self.rng.below(turns)).expect("it is below a number of 32 bits");
            let random = |replaced: &[usize], rng: &mut SplitMix64| replaced[rng.below(replaced.len())];
            if self.join(Bond { a, b, turn }, progress, random)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Brings the ports of a bond between two chains together, docks them, and lets the bond go that `choose` takes of those that it
    /// may replace; returns false if they did not come together.
    fn join(
        &mut self,
        new: Bond,
        progress: &mut dyn Progress,
        choose: impl Fn(&[usize], &mut SplitMix64) -> usize,
    ) -> Result<bool, Refusal> {
        self.check(progress)?;
        self.tried += 1;
        let bond = self.robot.bonds.len();
        self.robot.bonds.push(new);
        self.state.bonds.push(false);
        let Some(postures) = self.way_to(bond, progress)? else {
            self.robot.bonds.pop();
            self.state.bonds.pop();
            return Ok(false);
        };
        // Two chains are joined by a bond between other docks.
        let replaced = self.chains().replaced(new);
        let replaced = choose(&replaced, &mut self.rng);
        postures.into_iter().skip(1).for_each(|posture| self.turn(posture));
        self.state.bonds[bond] = true;
        self.steps.push(Step::Dock(bond));
        self.let_go(replaced);
        Ok(true)
    }

    /// Returns postures of all joints (rad or m), from the present one to one in which the ports of a bond meet, between
    /// which joints go straight and nothing meets; `None` where none were found.
    fn way_to(&mut self, bond: usize, progress: &mut dyn Progress) -> Result<Option<Vec<Vec<f64>>>, Refusal> {
        let Bond { a, b, .. } = self.robot.bonds[bond];
        let kinematics = Kinematics::new(&self.robot, &self.state.bonds, a.module);
        let (P, Q) = [a, b].map(|port| LinkFrame::of_port(&self.robot, &kinematics, port)).into();
        let Some(chain) = Chain::new(&self.robot, &kinematics, P.link, &Q) else { return Ok(None) };
        let X_LQ = P.X_LF * mate(&self.robot, bond);
        let target =
            Target { position: X_LQ.translation.vector, orientation: Orientation::Full(X_LQ.rotation) };
        let joints: Vec<usize> = chain.joints().iter().map(|joint| joint.joint).collect();
        let (goal_seed, way_seed) = (self.rng.next_u64(), self.rng.next_u64());
        let Settings { starts, way_budget, clearance, .. } = *self.settings;
        self.within_space(a.module, &joints, |space, search| {
            let goal =
                reach::Problem { chain: &chain, target, joints: &search.state.joints, names: &search.names };
            let settings =
                reach::Settings { starts, seed: goal_seed, clearance, ..reach::Settings::default() };
            let posture = match reach::plan(&goal, space, &settings, progress) {
                Ok(posture) if posture.free => posture,
                Err(reach::Refusal::Stopped) => return Err(Refusal::Stopped(search.status())),
                Ok(_) | Err(_) => return Ok(None),
            };
            let way =
                avoid::Problem { from: &search.state.joints, to: &posture.joints, limits: &search.limits };
            let settings =
                avoid::Settings { budget: way_budget, seed: way_seed, ..avoid::Settings::default() };
            match avoid::plan(&way, space, &settings, progress) {
                Ok(path) => Ok(Some(path.postures)),
                Err(avoid::Refusal::Stopped) => Err(Refusal::Stopped(search.status())),
                Err(_) => Ok(None),
            }
        })?
    }

    /// Turns some joints at random as far as nothing meets, so that other pairs may come together.
    fn perturb(&mut self) -> Result<(), Refusal> {
        const JOINTS: usize = 3;
        for _ in 0..self.settings.perturbation_turns {
            let mut to = self.state.joints.clone();
            let mut chosen = Vec::new();
            for _ in 0..JOINTS {
                let joint = self.joints[self.rng.below(self.joints.len())];
                let at = self.state.joints[joint.joint];
                let (low, high) = joint.limits;
                let span = if joint.slides { SLIDE_SPAN } else { PI };
                let low = if low.is_finite() { low } else { at - span };
                let high = if high.is_finite() { high } else { at + span };
                to[joint.joint] = low + self.rng.next_f64() * (high - low);
                chosen.push(joint.joint);
            }
            chosen.sort_unstable();
            chosen.dedup();
            let is_free = self.within_space(self.robot.base, &chosen, |space, search| {
                space.is_way_free(&search.state.joints, &to)
            })?;
            if is_free {
                self.turn(to);
                return Ok(());
            }
        }
        Ok(())
    }
}
