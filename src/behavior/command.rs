//! The effect of each command on the joints at the instant it is given.

use super::docking::{self, Docked};
use super::joints;
use super::law::{self, MotionLimits, Piece};
use super::limits::{Issue, IssueKind, Part};
use super::motion::Motion;
use super::refusal::{Reason, Refusal};
use super::run::Run;
use crate::plan::time::{TICK, tick_after};
use crate::plan::{Action, CauseId, Command, DockingEvent, DockingKind, Profile, Target};
use crate::robot::{Bond, JointId, PortRef};
use std::sync::Arc;

/// The time at which an action ends by itself, and the joint to hold if it ends before.
type Begun = (Option<f64>, Option<(JointId, CauseId)>);

impl Run<'_> {
    /// Carries out an action's command at the present time: gives its motions to the joints, or docks or undocks.
    /// Returns (end, held): the time at which the action ends by itself, s, `None` if a condition or timeout must end
    /// it; and the joint to hold, with the cause, if it ends before.
    ///
    /// # Errors
    /// A [`Refusal`] that blames the action, if the command can't be carried out.
    pub(super) fn command(&mut self, action: &Action) -> Result<Begun, Refusal> {
        self.judge(action).map_err(|reason| Refusal::at(action.cause, reason))
    }

    /// Carries out an action's command, by its kind.
    fn judge(&mut self, action: &Action) -> Result<Begun, Reason> {
        let cause = action.cause;
        match &action.command {
            Command::Move { joint, target, duration, profile } => {
                let end = self.begin_move(action, *joint, *target, *duration, *profile)?;
                // A condition replaces "has arrived".
                Ok((Some(end).filter(|_| action.until.is_none()), None))
            }
            Command::Spin { joint, speed, duration: Some(duration) } => {
                let end = self.begin_spin_for(action, *joint, *speed, *duration)?;
                Ok((Some(end), Some((*joint, cause))))
            }
            Command::Spin { joint, speed, duration: None } => {
                self.begin_spin(action, *joint, *speed)?;
                let endless = action.until.is_some() || action.timeout.is_some();
                Ok((Some(self.now).filter(|_| !endless), None))
            }
            Command::Follow { joint, keyframes } => {
                let end = self.begin_follow(action, *joint, keyframes)?;
                Ok((Some(end), Some((*joint, cause))))
            }
            Command::Wait { duration } => {
                at_least_zero("a wait", *duration)?;
                Ok((Some(self.now + tick_after(*duration)), None))
            }
            Command::Dock { a, b } => {
                self.dock(*a, *b, cause)?;
                // A robot that executes knows only after it whether the ports have met.
                Ok((Some(if self.executes { self.now + TICK } else { self.now }), None))
            }
            Command::Undock { port } => {
                self.undock(*port, cause)?;
                Ok((Some(self.now), None))
            }
        }
    }

    /// Begins a move: the joint brakes if it moves, then goes from rest to rest; returns the time at which it ends.
    fn begin_move(
        &mut self,
        action: &Action,
        joint: JointId,
        target: Target,
        duration: Option<f64>,
        profile: Profile,
    ) -> Result<f64, Reason> {
        let able = self.able(joint)?;
        let motion = &self.motions[joint.0 as usize];
        let same = matches!(target, Target::To(_))
            && motion.command.as_ref().is_some_and(|(command, _)| *command == action.command);
        if let Some(end) = motion.ends().filter(|end| same && *end > self.now) {
            // The joint is moving there already.
            return Ok(end);
        }
        // The joint is taken over where it is, and brakes first if it moves.
        let (at, speed) = self.take_over(joint);
        let target = match target {
            Target::To(position) => position,
            Target::By(change) => at + change,
        };
        finite("a target", target)?;
        let braking = law::changed_speed(at, speed, 0.0, able);
        let stopped = braking.as_ref().map_or(at, |piece| piece.control[2]);
        let spent = braking.as_ref().map_or(0.0, |piece| piece.duration);
        // The move from rest to rest takes the rest of the stated duration, or the least that there is.
        let least = law::least_duration(profile, target - stopped, able);
        let lasting = match duration {
            Some(given) => self.given_duration(action, joint, given, spent, least)?,
            None => tick_after(least.ok_or_else(|| Reason::NoSpeed { joint: self.name(joint) })?),
        };
        if lasting <= 0.0 && target != stopped {
            return Err(Reason::NoTimeToStop {
                joint: self.name(joint),
                needed: spent,
                given: duration.unwrap_or(0.0),
            });
        }
        let mut pieces: Vec<Piece> = braking.into_iter().collect();
        pieces.extend(law::rest_to_rest(profile, stopped, target, lasting, able));
        self.give(action, joint, pieces)
    }

    /// Returns the time that is left of a stated duration after braking; too little time for the joint's
    /// limits is noted, not refused: the judge of plans sees it, too.
    fn given_duration(
        &mut self,
        action: &Action,
        joint: JointId,
        given: f64,
        spent: f64,
        least: Option<f64>,
    ) -> Result<f64, Reason> {
        at_least_zero("a duration", given)?;
        let needed = spent + least.unwrap_or(0.0);
        if given < needed * (1.0 - self.settings.tol_duration) {
            let kind = IssueKind::TooShort { joint: self.name(joint), given, needed };
            let issue = Issue { cause: action.cause, part: Part::Duration, kind };
            if !self.issues.iter().any(|i| i.cause == issue.cause) {
                self.issues.push(issue);
            }
        }
        Ok(tick_after(given) - spent)
    }

    /// Begins a spin of a stated duration; returns the time at which it ends.
    fn begin_spin_for(
        &mut self,
        action: &Action,
        joint: JointId,
        speed: f64,
        duration: f64,
    ) -> Result<f64, Reason> {
        let able = self.able(joint)?;
        finite("a speed", speed)?;
        at_least_zero("a duration", duration)?;
        let (at, at_speed) = self.take_over(joint);
        let pieces = law::spin(at, at_speed, speed, tick_after(duration), able);
        self.give(action, joint, pieces)
    }

    /// Begins a spin without end.
    fn begin_spin(&mut self, action: &Action, joint: JointId, speed: f64) -> Result<(), Reason> {
        let able = self.able(joint)?;
        finite("a speed", speed)?;
        let (at, at_speed) = self.take_over(joint);
        let ramp = law::changed_speed(at, at_speed, speed, able);
        let since = self.give(action, joint, ramp.into_iter().collect())?;
        if speed != 0.0 {
            self.motions[joint.0 as usize].turn(since, speed, action.cause);
        }
        Ok(())
    }

    /// Begins the cubics through keyframes, which must begin at time 0 where the joint is; returns the time at which
    /// they end.
    fn begin_follow(
        &mut self,
        action: &Action,
        joint: JointId,
        keyframes: &[[f64; 3]],
    ) -> Result<f64, Reason> {
        self.able(joint)?;
        keyframes.iter().flatten().try_for_each(|&n| finite("a keyframe", n))?;
        let begins =
            keyframes.first().ok_or(Reason::BadNumber { what: "the number of keyframes", value: 0.0 })?;
        if begins[0] != 0.0 {
            return Err(Reason::BadNumber { what: "the time of the first keyframe", value: begins[0] });
        }
        let late = keyframes.windows(2).find(|w| crate::plan::time::tick_near(w[1][0] - w[0][0]) <= 0.0);
        if let Some(w) = late {
            return Err(Reason::BadNumber {
                what: "the time between two keyframes",
                value: w[1][0] - w[0][0],
            });
        }
        let at = self.take_over(joint).0;
        if (at - begins[1]).abs() > self.settings.tol_begin {
            return Err(Reason::Jump { joint: self.name(joint), at, begins: begins[1] });
        }
        self.give(action, joint, law::cubic_pieces(keyframes))
    }

    /// Brings a joint to rest from the present time on at its greatest deceleration: at once where no acceleration
    /// limit is stated. `cause`: that of the segment.
    pub(super) fn stop(&mut self, joint: JointId, cause: CauseId) {
        let (at, speed) = self.take_over(joint);
        let facts = &self.facts[joint.0 as usize];
        let able = MotionLimits { speed: facts.speed, acceleration: facts.acceleration };
        let braking = law::changed_speed(at, speed, 0.0, able).into_iter().collect();
        self.motions[joint.0 as usize].append(self.now, braking, cause);
    }

    /// Gives a joint new pieces of motion; returns when they end.
    fn give(&mut self, action: &Action, joint: JointId, pieces: Vec<Piece>) -> Result<f64, Reason> {
        self.count_segments(pieces.len()).map_err(|refusal| refusal.reason)?;
        let motion = &mut self.motions[joint.0 as usize];
        motion.command = Some((action.command.clone(), action.cause));
        Ok(motion.append(self.now, pieces, action.cause))
    }

    /// Ends the motion of a joint. Returns its position and speed at that time.
    fn take_over(&mut self, joint: JointId) -> (f64, f64) {
        self.motions[joint.0 as usize].cut(self.now)
    }

    /// Returns the speed and acceleration limits of a joint that takes commands.
    fn able(&self, joint: JointId) -> Result<MotionLimits, Reason> {
        let facts = &self.facts[joint.0 as usize];
        match facts.uncommandable {
            Some(why) => Err(Reason::NoCommands { joint: facts.name.clone(), why }),
            None => Ok(MotionLimits { speed: facts.speed, acceleration: facts.acceleration }),
        }
    }

    /// Returns the path name of a joint.
    fn name(&self, joint: JointId) -> String {
        self.facts[joint.0 as usize].name.clone()
    }

    /// Docks two ports: closes the same bond as before, or a new one with its hinge.
    fn dock(&mut self, a: PortRef, b: PortRef, cause: CauseId) -> Result<(), Reason> {
        if self.executes {
            return self.dock_known(a, b, cause);
        }
        let joints: Vec<f64> = self.motions.iter().map(|m| m.position(self.now)).collect();
        let Docked { bond, hinge, apart } = docking::docked(&self.robot, &self.holds, &joints, a, b)?;
        // From the first docking of robots that stand by themselves on, kinematics does not tell turns.
        let open = apart || !self.open_turns.is_empty();
        // A bond whose hinge may have turned since is a new one; without a hinge its ends are alike.
        let swapped = Bond { a: bond.b, b: bond.a, turn: bond.turn };
        let same = |known: &Bond| (*known == bond || *known == swapped) && hinge.is_none();
        let known = self.robot.bonds.iter().position(same).filter(|_| !open);
        let index = known.unwrap_or_else(|| {
            Arc::make_mut(&mut self.robot).bonds.push(bond);
            self.holds.push(false);
            if let Some(position) = hinge {
                self.motions.push(Motion::at_rest(position));
                self.start.push(position);
                self.facts.extend(joints::facts(&self.robot).pop());
            }
            self.robot.bonds.len() - 1
        });
        if open {
            self.open_turns.push(index);
        }
        self.holds[index] = true;
        self.docks.push(DockingEvent { time: self.now, kind: DockingKind::Dock, bond: index, cause });
        Ok(())
    }

    /// Docks two ports by a bond that the robot knows, one that has not been closed before if there are several: where they
    /// are is the robot's affair.
    fn dock_known(&mut self, a: PortRef, b: PortRef, cause: CauseId) -> Result<(), Reason> {
        docking::free(&self.robot, &self.holds, a, b)?;
        let joins = |bond: &Bond| (bond.a, bond.b) == (a, b) || (bond.a, bond.b) == (b, a);
        let closed = |bond: &usize| {
            self.docks.iter().any(|event| event.bond == *bond && event.kind == DockingKind::Dock)
        };
        let known = (0..self.robot.bonds.len()).filter(|bond| joins(&self.robot.bonds[*bond]));
        let bond = known
            .min_by_key(closed)
            .ok_or_else(|| Reason::NotPlanned { a: self.robot.port_name(a), b: self.robot.port_name(b) })?;
        self.holds[bond] = true;
        self.docks.push(DockingEvent { time: self.now, kind: DockingKind::Dock, bond, cause });
        Ok(())
    }

    /// Undocks the bond at a port.
    fn undock(&mut self, port: PortRef, cause: CauseId) -> Result<(), Reason> {
        let bond = docking::bond_at(&self.robot, &self.holds, port)
            .ok_or_else(|| Reason::PortFree { port: self.robot.port_name(port) })?;
        self.holds[bond] = false;
        self.docks.push(DockingEvent { time: self.now, kind: DockingKind::Undock, bond, cause });
        Ok(())
    }
}

/// Refuses a number that is not finite.
fn finite(what: &'static str, value: f64) -> Result<(), Reason> {
    if value.is_finite() { Ok(()) } else { Err(Reason::BadNumber { what, value }) }
}

/// Refuses a number that is negative or not finite.
fn at_least_zero(what: &'static str, value: f64) -> Result<(), Reason> {
    if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(Reason::BadNumber { what, value }) }
}
