//! The trajectory of one joint while a behaviour is scheduled (trajectory generation): its past, and its
//! future as far as no other command supersedes it.

use super::law::Piece;
use crate::plan::{CauseId, Command, Segment, polynomial};
use std::collections::VecDeque;

/// The trajectory of a joint while a behaviour is scheduled: its past, and its future as commanded so far.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// The past segments in order of time, which nothing can change.
    pub(super) past: Vec<Segment>,
    /// The present and coming segments, in order.
    ahead: VecDeque<Segment>,
    /// The spin without end that follows `ahead`; `None` without one.
    turning: Option<Turning>,
    /// The position after `ahead`, rad or m.
    rest: f64,
    /// The command in force with its cause; `None` if there is none.
    pub(super) command: Option<(Command, CauseId)>,
}

/// A motion of a joint at constant speed without end, from a time and position on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turning {
    /// The time from which on it turns, s.
    pub(super) since: f64,
    /// The position at that time, rad or m.
    pub(super) from: f64,
    /// The constant speed, rad/s or m/s.
    pub(super) speed: f64,
    /// The cause of the command.
    pub(super) cause: CauseId,
}

impl Motion {
    /// Returns the motion of a joint that stays at a position, rad or m.
    pub(super) fn at_rest(position: f64) -> Motion {
        Motion { past: vec![], ahead: VecDeque::new(), turning: None, rest: position, command: None }
    }

    /// Moves the segments that have ended by the time `now` (s) from the future to the past.
    pub(super) fn pass(&mut self, now: f64) {
        while self.ahead.front().is_some_and(|s| s.end <= now) {
            self.past.extend(self.ahead.pop_front());
        }
    }

    /// Returns the position, rad or m, at the time `t` (s), which is not before the last [`pass`](Motion::pass).
    pub(super) fn position(&self, t: f64) -> f64 {
        let begun = self.ahead.iter().take_while(|s| s.start <= t).last();
        match (begun, self.turning) {
            (_, Some(turning)) if t >= turning.since => turning.at(t),
            (Some(segment), _) => segment.position(t),
            // A gap before the first coming segment holds where that begins.
            (None, _) => self.ahead.front().map_or(self.rest, |s| s.control[0]),
        }
    }

    /// Ends the motion at the time `now` (s): drops all that comes after it, and the command in force. Returns
    /// (position, speed) just before `now`, rad or m and rad/s or m/s.
    pub(super) fn cut(&mut self, now: f64) -> (f64, f64) {
        let position = self.position(now);
        let speed = self.speed_before(now);
        self.pass(now);
        if let Some(segment) = self.ahead.pop_front() {
            self.past.extend(segment.between(segment.start, now));
        }
        self.ahead.clear();
        if let Some(turning) = self.turning.take().filter(|t| now > t.since) {
            let Turning { since, from, cause, .. } = turning;
            self.past.push(Segment { start: since, end: now, control: vec![from, position], cause });
        }
        self.rest = position;
        self.command = None;
        (position, speed)
    }

    /// Returns the speed just before `now`, if the motion continues then; 0 if it has ended or not begun.
    fn speed_before(&self, now: f64) -> f64 {
        if let Some(turning) = self.turning.filter(|t| now >= t.since) {
            return turning.speed;
        }
        let moving = self.ahead.iter().find(|s| s.start < now && now < s.end);
        let begins = self.ahead.iter().find(|s| s.start == now);
        match (moving, begins) {
            (Some(segment), _) => segment.velocity(now),
            // Between two pieces of one motion both know the speed; at its beginning it is at rest.
            (None, Some(segment)) if self.joins(now) => segment.velocity(now),
            _ => 0.0,
        }
    }

    /// Returns the rate just after the time `t` (s), rad/s or m/s; 0 in a gap and at rest.
    pub(super) fn rate(&self, t: f64) -> f64 {
        match self.turning.filter(|turning| t >= turning.since) {
            Some(turning) => turning.speed,
            None => self.ahead.iter().find(|s| s.start <= t && t < s.end).map_or(0.0, |s| s.velocity(t)),
        }
    }

    /// Returns true if a segment ends at `now`.
    fn joins(&self, now: f64) -> bool {
        self.ahead.iter().chain(self.past.last()).any(|s| s.end == now)
    }

    /// Appends pieces of motion from the time `start` (s) on, where the motion so far has ended; pieces in which
    /// nothing moves only take time. Returns the time at which the last piece ends, s. `cause`: that of the command.
    pub(super) fn append(&mut self, start: f64, pieces: Vec<Piece>, cause: CauseId) -> f64 {
        let mut now = start;
        for Piece { duration, mut control } in pieces.into_iter().filter(|p| p.duration > 0.0) {
            let (begin, end) = (now, now + duration);
            now = end;
            // Rounding must not make the motion discontinuous: it begins where the last piece ended.
            control[0] = self.rest;
            let last = control[control.len() - 1];
            if control.iter().any(|&c| c != last) {
                self.ahead.push_back(Segment { start: begin, end, control, cause });
                self.rest = last;
            }
        }
        now
    }

    /// Lets the joint turn or slide without end at `speed` (rad/s or m/s) from the time `since` (s) on, at which the
    /// appended pieces are over. `cause`: that of the command.
    pub(super) fn turn(&mut self, since: f64, speed: f64, cause: CauseId) {
        self.turning = Some(Turning { since, from: self.rest, speed, cause });
    }

    /// Returns the motion without end that follows the last segment; `None` if there is none.
    pub(super) fn turning(&self) -> Option<Turning> {
        self.turning
    }

    /// Returns the time at which the last segment of the future ends, s; `None` if there is none.
    pub(super) fn ends(&self) -> Option<f64> {
        self.ahead.back().map(|s| s.end)
    }

    /// Returns the pieces of the position over `t0..t1` (s, `t1` may be infinite), in order of time: each with its
    /// interval and, in Bernstein form, the position (rad or m) over it. The last may be endless, and is then linear
    /// over its first second.
    pub(super) fn pieces(&self, t0: f64, t1: f64) -> Vec<SignalPiece> {
        let mut pieces = Vec::new();
        let mut now = t0;
        let mut hold = self.position(t0);
        for segment in self.ahead.iter().take_while(|s| s.start < t1).filter(|s| s.end > t0) {
            if segment.start > now {
                pieces.push(SignalPiece { start: now, end: segment.start, control: vec![hold] });
            }
            if let Some(piece) = segment.between(now, t1) {
                now = piece.end;
                hold = piece.last();
                pieces.push(SignalPiece { start: piece.start, end: piece.end, control: piece.control });
            }
        }
        if let Some(turning) = self.turning.filter(|t| t1 > t.since) {
            let start = now.max(turning.since);
            let length = (t1 - start).min(1.0);
            let from = turning.at(start);
            let control = vec![from, from + turning.speed * length];
            // Linear pieces are given over all their time, or over one second if they are endless.
            let control = if t1.is_finite() { vec![from, turning.at(t1)] } else { control };
            pieces.push(SignalPiece { start, end: t1, control });
        } else if now < t1 {
            pieces.push(SignalPiece { start: now, end: t1, control: vec![hold] });
        }
        pieces
    }

    /// Returns all segments, past and future, in order of time.
    pub(super) fn into_segments(mut self) -> Vec<Segment> {
        self.past.extend(self.ahead);
        self.past
    }
}

/// A piece of a signal, the position, rate or elapsed time that a condition measures, as a polynomial of time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SignalPiece {
    /// The beginning of the piece, s.
    pub(super) start: f64,
    /// The end, s; infinite for an endless piece.
    pub(super) end: f64,
    /// The control points in Bernstein form of the signal over the piece, or over its first second if it is endless;
    /// in the unit of the signal.
    pub(super) control: Vec<f64>,
}

impl SignalPiece {
    /// Returns the duration over which the control points are spread, s.
    pub(super) fn span(&self) -> f64 {
        if self.end.is_finite() { self.end - self.start } else { 1.0 }
    }

    /// Returns the time derivative of the signal over the same piece, in the unit of the signal per second.
    pub(super) fn rate(&self) -> SignalPiece {
        let span = self.span();
        let control = polynomial::derivative(&self.control).into_iter().map(|c| c / span).collect();
        SignalPiece { control, ..*self }
    }
}

impl Turning {
    /// Returns the position at a time, rad or m.
    fn at(&self, t: f64) -> f64 {
        self.from + self.speed * (t - self.since)
    }
}
