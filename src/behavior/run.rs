//! The run of a program (discrete-event simulation): frames for the nodes that have begun, a queue of the times at
//! which actions end.

use super::condition::{self, Sensors, View};
use super::joints::JointFacts;
use super::limits::Issue;
use super::motion::Motion;
use super::played::Played;
use super::refusal::{Reason, Refusal, limit};
use super::schedule::{ContractInterval, Settings};
use crate::plan::time::{DURATION_MAX, tick_after};
use crate::plan::{Action, CauseId, Condition, DockingEvent, Exemption, Node, Otherwise, Track};
use crate::robot::{Assembly, JointId};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// A run of a behaviour in progress, by discrete-event simulation; its time begins at 0 s.
pub(super) struct Run<'a> {
    /// The robot, with the bonds that docking has added so far.
    pub(super) robot: Arc<Assembly>,
    /// The limits of every joint, by the number in its `JointId`.
    pub(super) facts: Vec<JointFacts>,
    /// The motion of every joint, by the number in its `JointId`.
    pub(super) motions: Vec<Motion>,
    /// The positions at the start, by the number in the joint's `JointId`, those of new bonds' hinges included, rad or
    /// m.
    pub(super) start: Vec<f64>,
    /// For every bond of the robot, by index, true if it holds now.
    pub(super) holds: Vec<bool>,
    /// The changes of bonds so far, in order of time.
    pub(super) docks: Vec<DockingEvent>,
    /// The bonds by which robots have docked that stood by themselves, and those closed after that, in order of time: their
    /// turns depend on how the robots stand.
    pub(super) open_turns: Vec<usize>,
    /// The intervals so far that are excused from a check.
    pub(super) exemptions: Vec<Exemption>,
    /// The intervals so far over which contracts are judged.
    pub(super) contracts: Vec<ContractInterval>,
    /// Stated durations so far that are shorter than the limits allow.
    pub(super) issues: Vec<Issue>,
    /// The limits and tolerances of scheduling.
    pub(super) settings: Settings,
    /// The present time of the run, s.
    pub(super) now: f64,
    /// The number of actions begun.
    pub(super) actions: u64,
    /// The number of nodes entered.
    pub(super) steps: u64,
    /// The number of pieces of motion made.
    pub(super) segments: u64,
    /// The number of cycles (phases, stretches) within which this run is, each a run of its own; at most
    /// [`Settings::cycles_max`].
    pub(super) cycles: u64,
    /// True if the program is executed: docking then closes bonds that the robot knows, and no new ones.
    pub(super) executes: bool,
    tasks: Vec<Task<'a>>,
    frames: Vec<Frame<'a>>,
    free: Vec<usize>,
    active: Vec<Option<Active<'a>>>,
    idle: Vec<usize>,
    /// Slots of the actions that wait for a condition, in order of their beginning.
    waiting: Vec<usize>,
    queue: BinaryHeap<Event>,
    events: u64,
    done: bool,
}

/// A task at the present instant.
enum Task<'a> {
    /// A node begins; it completes to the frame of this index.
    Begin(&'a Arc<Node>, Option<usize>),
    /// One child of the frame has completed; `None`: the whole program has.
    Complete(Option<usize>),
}

/// A node with children that has begun; its parent is the index of a frame, `None` for the whole program.
struct Frame<'a> {
    parent: Option<usize>,
    kind: FrameKind<'a>,
}

enum FrameKind<'a> {
    Series { rest: std::slice::Iter<'a, Arc<Node>> },
    Parallel { left: usize },
    Repeat { body: &'a Arc<Node>, left: u64, until: Option<&'a Condition>, began: f64 },
    Exempt { index: usize },
    Contract { index: usize },
}

/// An action, or a piece of a cycle, that has begun.
struct Active<'a> {
    parent: Option<usize>,
    action: Option<&'a Action>,
    began: f64,
    /// The generation of the slot: events of earlier ones are dropped.
    generation: u64,
    /// The joint to hold if the action ends before its motion, with the cause; `None` if there is none.
    holds: Option<(JointId, CauseId)>,
}

/// The kind of an event.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum EventKind {
    End,
    Timeout,
}

/// An event: an action ends or times out.
struct Event {
    time: f64,
    number: u64,
    slot: usize,
    generation: u64,
    kind: EventKind,
}

/// The earliest event is the greatest: first by time, then in order of creation.
impl Ord for Event {
    fn cmp(&self, other: &Event) -> Ordering {
        other.time.total_cmp(&self.time).then(other.number.cmp(&self.number))
    }
}
impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Event) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Event {
    fn eq(&self, other: &Event) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Event {}

impl<'a> Run<'a> {
    /// Returns a run at time 0. `facts` and `motions`: those of every joint, by the number in its `JointId`; `holds`:
    /// for every bond of the robot, by index, true if it holds.
    pub(super) fn new(
        robot: Arc<Assembly>,
        facts: Vec<JointFacts>,
        motions: Vec<Motion>,
        holds: Vec<bool>,
        settings: Settings,
    ) -> Run<'a> {
        let start = motions.iter().map(|m| m.position(0.0)).collect();
        Run {
            robot,
            facts,
            motions,
            start,
            holds,
            docks: vec![],
            open_turns: vec![],
            exemptions: vec![],
            contracts: vec![],
            issues: vec![],
            settings,
            now: 0.0,
            actions: 0,
            steps: 0,
            segments: 0,
            cycles: 0,
            executes: false,
            tasks: vec![],
            frames: vec![],
            free: vec![],
            active: vec![],
            idle: vec![],
            waiting: vec![],
            queue: BinaryHeap::new(),
            events: 0,
            done: false,
        }
    }

    /// Runs a program to its end and until every joint is at rest, and returns the result.
    ///
    /// # Errors
    /// A [`Refusal`] if a command can't be carried out, a condition never holds, the behaviour aborts, a joint still
    /// turns at the end, or a limit of the settings is exceeded.
    pub(super) fn play(mut self, program: &'a Arc<Node>) -> Result<Played, Refusal> {
        self.start_with(program);
        loop {
            self.carry_out(None)?;
            if self.done {
                return self.finish();
            }
            self.advance()?;
        }
    }

    /// Sets the program that is to be run.
    pub(super) fn start_with(&mut self, program: &'a Arc<Node>) {
        self.tasks.push(Task::Begin(program, None));
    }

    /// Carries out the tasks at the present instant.
    fn carry_out(&mut self, sensors: Option<&dyn Sensors>) -> Result<(), Refusal> {
        while let Some(task) = self.tasks.pop() {
            crate::interrupt::checkpoint();
            match task {
                Task::Begin(node, parent) => self.begin(node, parent)?,
                Task::Complete(frame) => self.complete(frame, sensors),
            }
        }
        Ok(())
    }

    /// Goes on up to a time (s), at which sensors report: actions end and time out at their times, and where their
    /// conditions hold on what is reported. Returns true if the program has come to its end.
    ///
    /// # Errors
    /// A [`Refusal`] if a command can't be carried out, the behaviour aborts, or a limit of the settings is exceeded.
    pub(super) fn advance_to(&mut self, time: f64, sensors: &dyn Sensors) -> Result<bool, Refusal> {
        loop {
            self.carry_out(Some(sensors))?;
            if self.done {
                return Ok(true);
            }
            self.drop_void_events();
            let next = self.queue.peek().filter(|event| event.time <= time);
            let Some((at, slot, kind)) = next.map(|event| (event.time, event.slot, event.kind)) else {
                self.now = self.now.max(time);
                self.within_time()?;
                self.motions.iter_mut().for_each(|motion| motion.pass(time));
                match self.waiting.iter().copied().find(|&slot| self.is_met(slot, sensors)) {
                    Some(slot) => self.end_early(slot),
                    None => return Ok(false),
                }
                continue;
            };
            self.queue.pop();
            self.now = self.now.max(at);
            self.within_time()?;
            match kind {
                EventKind::End => self.end(slot),
                // A condition that holds by now comes before the timeout, as in the undisturbed run.
                EventKind::Timeout if self.is_met(slot, sensors) => self.end_early(slot),
                EventKind::Timeout => self.time_out(slot, Some(sensors))?,
            }
        }
    }

    /// Returns true if the condition of the action in a slot holds on what sensors report.
    fn is_met(&self, slot: usize, sensors: &dyn Sensors) -> bool {
        let Some(active) = &self.active[slot] else { return false };
        let until = active.action.and_then(|action| action.until.as_ref());
        until.is_some_and(|until| {
            condition::holds(until, &self.view(active.began, Some(sensors)), self.now) == Some(true)
        })
    }

    /// Returns the present state for conditions that measure time from `began` (s) on.
    fn view<'v>(&'v self, began: f64, sensors: Option<&'v dyn Sensors>) -> View<'v> {
        View { robot: &self.robot, motions: &self.motions, holds: &self.holds, began, sensors }
    }

    /// Begins a node.
    fn begin(&mut self, node: &'a Arc<Node>, parent: Option<usize>) -> Result<(), Refusal> {
        self.count_step()?;
        match &**node {
            Node::Action(action) => {
                self.actions += 1;
                limit(self.actions, self.settings.actions_max, "actions")?;
                self.begin_action(action, parent)?;
            }
            Node::Series(list) => self.enter(parent, FrameKind::Series { rest: list.iter() }),
            Node::Repeat { body, times, until } => {
                let until = until.as_ref();
                limit(
                    until.map_or(0, condition::depth) as u64,
                    condition::DEPTH_MAX as u64,
                    "nested conditions",
                )?;
                let kind = FrameKind::Repeat { body, left: *times, until, began: self.now };
                let frame = self.open(parent, kind);
                self.repeat(frame);
            }
            Node::Parallel(list) if list.is_empty() => self.tasks.push(Task::Complete(parent)),
            Node::Parallel(list) => {
                let frame = self.open(parent, FrameKind::Parallel { left: list.len() });
                self.tasks.extend(list.iter().rev().map(|n| Task::Begin(n, Some(frame))));
            }
            Node::Exempt { body, kind, cause } => {
                let index = self.exemptions.len();
                let (from, to) = (self.now, self.now);
                self.exemptions.push(Exemption { kind: kind.clone(), from, to, cause: *cause });
                let frame = self.open(parent, FrameKind::Exempt { index });
                self.tasks.push(Task::Begin(body, Some(frame)));
            }
            Node::Contract { body, number, cause } => {
                let index = self.contracts.len();
                let (from, to) = (self.now, self.now);
                self.contracts.push(ContractInterval { number: *number, cause: *cause, from, to });
                let frame = self.open(parent, FrameKind::Contract { index });
                self.tasks.push(Task::Begin(body, Some(frame)));
            }
            Node::Goal(goal) => return Err(Refusal::unresolved(goal)),
            Node::Phase { .. } | Node::Approach { .. } | Node::Stretch { .. } => {
                let end = self.begin_cycle(node)?;
                self.activate(
                    Active { parent, action: None, began: self.now, generation: 0, holds: None },
                    Some(end),
                );
            }
        }
        Ok(())
    }

    /// Opens a frame that goes on as if a child of it had just completed.
    fn enter(&mut self, parent: Option<usize>, kind: FrameKind<'a>) {
        let frame = self.open(parent, kind);
        self.tasks.push(Task::Complete(Some(frame)));
    }

    /// Opens a frame; returns its index.
    fn open(&mut self, parent: Option<usize>, kind: FrameKind<'a>) -> usize {
        let frame = Frame { parent, kind };
        if let Some(index) = self.free.pop() {
            self.frames[index] = frame;
            return index;
        }
        self.frames.push(frame);
        self.frames.len() - 1
    }

    /// Begins the body of a repetition once more, if it is not over.
    fn repeat(&mut self, frame: usize) {
        let Frame { parent, kind } = &mut self.frames[frame];
        let task = match kind {
            FrameKind::Repeat { body, left, .. } if *left > 0 => {
                *left -= 1;
                Task::Begin(body, Some(frame))
            }
            _ => {
                self.free.push(frame);
                Task::Complete(*parent)
            }
        };
        self.tasks.push(task);
    }

    /// Completes a child of the frame: the next begins, or the frame completes, too.
    fn complete(&mut self, frame: Option<usize>, sensors: Option<&dyn Sensors>) {
        let Some(index) = frame else {
            self.done = true;
            return;
        };
        if let FrameKind::Repeat { until: Some(until), began, .. } = self.frames[index].kind
            && condition::holds(until, &self.view(began, sensors), self.now) == Some(true)
            && let FrameKind::Repeat { left, .. } = &mut self.frames[index].kind
        {
            *left = 0;
        }
        if matches!(self.frames[index].kind, FrameKind::Repeat { .. }) {
            return self.repeat(index);
        }
        let next = match &mut self.frames[index].kind {
            FrameKind::Series { rest } => rest.next(),
            FrameKind::Parallel { left } if *left > 1 => {
                *left -= 1;
                return;
            }
            FrameKind::Exempt { index } => {
                self.exemptions[*index].to = self.now;
                None
            }
            FrameKind::Contract { index } => {
                self.contracts[*index].to = self.now;
                None
            }
            FrameKind::Repeat { .. } | FrameKind::Parallel { .. } => None,
        };
        if let Some(node) = next {
            self.tasks.push(Task::Begin(node, frame));
        } else {
            self.free.push(index);
            self.tasks.push(Task::Complete(self.frames[index].parent));
        }
    }

    /// Begins an action: gives its command, and posts its end and its timeout.
    fn begin_action(&mut self, action: &'a Action, parent: Option<usize>) -> Result<(), Refusal> {
        let (end, holds) = self.command(action)?;
        let timeout = self.timeout_of(action)?;
        let active = Active { parent, action: Some(action), began: self.now, generation: 0, holds };
        let slot = self.activate(active, end);
        if let Some(time) = timeout {
            self.post(time, slot, EventKind::Timeout);
        }
        if let Some(until) = &action.until {
            if condition::depth(until) > condition::DEPTH_MAX {
                let limit = condition::DEPTH_MAX as u64;
                return Err(Refusal::at(action.cause, Reason::Limit { what: "nested conditions", limit }));
            }
            self.waiting.push(slot);
        }
        Ok(())
    }

    /// Returns the time at which an action times out, s; `None` without timeout.
    fn timeout_of(&self, action: &Action) -> Result<Option<f64>, Refusal> {
        let Some(timeout) = action.timeout else { return Ok(None) };
        if !(timeout >= 0.0 && timeout.is_finite()) {
            return Err(Refusal::at(action.cause, Reason::BadNumber { what: "a timeout", value: timeout }));
        }
        Ok(Some(self.now + tick_after(timeout)))
    }

    /// Adds an active action that ends at a time, if it is known; returns its slot.
    fn activate(&mut self, mut active: Active<'a>, end: Option<f64>) -> usize {
        self.events += 1;
        active.generation = self.events;
        let slot = match self.idle.pop() {
            Some(slot) => {
                self.active[slot] = Some(active);
                slot
            }
            None => {
                self.active.push(Some(active));
                self.active.len() - 1
            }
        };
        if let Some(time) = end {
            self.post(time, slot, EventKind::End);
        }
        slot
    }

    fn post(&mut self, time: f64, slot: usize, kind: EventKind) {
        self.events += 1;
        let generation = self.active[slot].as_ref().expect("events are posted for what is active").generation;
        self.queue.push(Event { time, number: self.events, slot, generation, kind });
    }

    /// Goes on to the next instant at which something completes.
    fn advance(&mut self) -> Result<(), Refusal> {
        self.drop_void_events();
        let horizon = self.queue.peek().map_or(f64::INFINITY, |e| e.time);
        if let Some((slot, time)) = self.first_condition(horizon) {
            self.now = time;
            self.within_time()?;
            self.end_early(slot);
            return Ok(());
        }
        let Some(Event { time, slot, kind, .. }) = self.queue.pop() else {
            let waiting = self.waiting.first().and_then(|&s| self.active[s].as_ref()).and_then(|a| a.action);
            let cause = waiting.expect("without events, what has not completed waits for a condition").cause;
            return Err(Refusal::at(cause, Reason::NeverHolds));
        };
        self.now = time;
        self.within_time()?;
        match kind {
            EventKind::End => self.end(slot),
            EventKind::Timeout => self.time_out(slot, None)?,
        }
        Ok(())
    }

    /// Drops the next events as long as they are those of actions that have ended.
    fn drop_void_events(&mut self) {
        let void = |e: &Event| self.active[e.slot].as_ref().is_none_or(|a| a.generation != e.generation);
        while self.queue.peek().is_some_and(void) {
            self.queue.pop();
        }
    }

    /// Returns the slot of the action whose condition holds first, not after `horizon` (s), with that time; of equals
    /// the one begun first; `None` if no condition holds by then.
    fn first_condition(&mut self, horizon: f64) -> Option<(usize, f64)> {
        if self.waiting.is_empty() {
            return None;
        }
        self.motions.iter_mut().for_each(|m| m.pass(self.now));
        let mut best: Option<(usize, f64)> = None;
        for &slot in &self.waiting {
            let active = self.active[slot].as_ref().expect("what waits is active");
            let action = active.action.expect("only actions wait");
            let until = action.until.as_ref().expect("what waits has a condition");
            let view = self.view(active.began, None);
            let before = best.map_or(horizon, |(_, t)| t);
            let hit = condition::first(until, &view, self.now, before);
            if let Some(time) = hit.filter(|t| best.is_none_or(|(_, b)| *t < b)) {
                best = Some((slot, time));
            }
        }
        best
    }

    /// Refuses a run that takes longer than plans may.
    fn within_time(&self) -> Result<(), Refusal> {
        limit(self.now as u64, DURATION_MAX as u64 - 1, "seconds")
    }

    /// Ends an action whose motion is over.
    fn end(&mut self, slot: usize) {
        let active = self.leave(slot);
        self.tasks.push(Task::Complete(active.parent));
    }

    /// Ends an action whose condition holds.
    fn end_early(&mut self, slot: usize) {
        let active = self.leave(slot);
        self.hold(&active);
        self.tasks.push(Task::Complete(active.parent));
    }

    /// Ends an action whose timeout has come, and goes on as it says; the undisturbed run goes on as if a condition held of
    /// which nothing is known.
    fn time_out(&mut self, slot: usize, sensors: Option<&dyn Sensors>) -> Result<(), Refusal> {
        let active = self.leave(slot);
        self.hold(&active);
        let action = active.action.expect("only actions time out");
        let view = self.view(active.began, sensors);
        if action.until.as_ref().is_some_and(|until| condition::holds(until, &view, self.now).is_none()) {
            self.tasks.push(Task::Complete(active.parent));
            return Ok(());
        }
        match &action.otherwise {
            Otherwise::Proceed => self.tasks.push(Task::Complete(active.parent)),
            Otherwise::Node(node) => self.tasks.push(Task::Begin(node, active.parent)),
            Otherwise::Abort(message) => {
                let reason = Reason::Aborted { message: message.clone(), time: self.now };
                return Err(Refusal::at(action.cause, reason));
            }
        }
        Ok(())
    }

    /// Removes an action from its slot.
    fn leave(&mut self, slot: usize) -> Active<'a> {
        self.waiting.retain(|s| *s != slot);
        self.idle.push(slot);
        self.active[slot].take().expect("only what is active ends")
    }

    /// Brings the joint of an action that ends early to rest, unless another command has taken it over.
    fn hold(&mut self, active: &Active) {
        let Some((joint, cause)) = active.holds else { return };
        if self.motions[joint.0 as usize].command.as_ref().is_some_and(|(_, c)| *c == cause) {
            self.stop(joint, cause);
        }
    }

    /// Returns the result of the run; refuses a joint that still turns.
    fn finish(self) -> Result<Played, Refusal> {
        let mut duration = self.now;
        for (motion, facts) in self.motions.iter().zip(&self.facts) {
            if let Some(turning) = motion.turning().filter(|t| t.speed != 0.0) {
                let reason = Reason::StillTurning { joint: facts.name.clone(), speed: turning.speed };
                return Err(Refusal::at(turning.cause, reason));
            }
            duration = duration.max(motion.ends().unwrap_or(0.0));
        }
        let end = self.motions.iter().map(|m| m.position(f64::INFINITY)).collect();
        let tracks = self.motions.into_iter().enumerate().filter_map(|(joint, motion)| {
            let segments = motion.into_segments();
            (!segments.is_empty()).then_some(Track { joint: JointId(joint as u32), segments })
        });
        Ok(Played {
            tracks: tracks.collect(),
            robot: self.robot,
            joints: self.start,
            end,
            docks: self.docks,
            open_turns: self.open_turns,
            duration,
            exemptions: self.exemptions,
            contracts: self.contracts,
            issues: self.issues,
            actions: self.actions,
            steps: self.steps,
        })
    }

    /// Counts a node that is entered.
    fn count_step(&mut self) -> Result<(), Refusal> {
        self.steps += 1;
        limit(self.steps, self.settings.steps_max, "steps")
    }

    /// Adds `more` to the number of pieces of motion made so far.
    ///
    /// # Errors
    /// [`Reason::Limit`] if there are more than the settings allow.
    pub(super) fn count_segments(&mut self, more: usize) -> Result<(), Refusal> {
        self.segments += more as u64;
        limit(self.segments, self.settings.segments_max, "pieces of motion")
    }
}
