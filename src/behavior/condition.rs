//! The first instant at which a condition holds along the nominal motion: exact crossings of polynomials.
//!
//! Conditions are judged on open intervals of time and at the instants where a piece of motion
//! begins; a signal that only touches a value inside a piece does not reach it. Of what only a robot in motion can measure
//! nothing is known before, so conditions have three values (Kleene 1938): true, false and unknown.

use super::motion::{Motion, SignalPiece};
use crate::plan::time::tick_after;
use crate::plan::{Compare, Condition, Signal, polynomial};
use crate::robot::{Assembly, PortRef};

/// The greatest depth to which conditions may be nested; an action with a deeper one is refused.
pub(super) const DEPTH_MAX: usize = 64;

/// The sensors of a robot that executes a program: what they report now.
pub trait Sensors {
    /// Returns the value of a signal: rad or m, rad/s or m/s, N·m or N. It is not asked for the time of an action
    /// ([`Signal::Elapsed`]).
    fn value(&self, signal: Signal) -> f64;

    /// Returns true if one of some modules, given by their indices, touches one of `others`, or, where there is `None`, the ground
    /// or a module that is not among them. Modules that are docked to each other do not touch.
    fn touches(&self, modules: &[usize], others: Option<&[usize]>) -> bool;
}

/// The state of a run on which a condition is judged: the motion of the joints and the bonds.
pub(super) struct View<'a> {
    /// The robot with the bonds so far.
    pub(super) robot: &'a Assembly,
    /// The motion of every joint, by the number in its `JointId`.
    pub(super) motions: &'a [Motion],
    /// For every bond of the robot, by index, true if it holds.
    pub(super) holds: &'a [bool],
    /// The time at which the action began, s.
    pub(super) began: f64,
    /// The sensors, where the program is executed; `None` in the undisturbed run, which follows the motion.
    pub(super) sensors: Option<&'a dyn Sensors>,
}

/// Returns the first time in `t0..=t1` (s, `t1` may be infinite) from which on the condition holds: `t0`, `t1`, or
/// the instant rounded up to a tick; `None` if there is none.
pub(super) fn first(condition: &Condition, view: &View, t0: f64, t1: f64) -> Option<f64> {
    let holds = |t| holds(condition, view, t) == Some(true);
    if holds(t0) {
        return Some(t0);
    }
    let mut breaks = vec![t0];
    add_breaks(condition, view, t0, t1, &mut breaks);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    // After the last break nothing changes any more: one second later stands for all time.
    let last = breaks[breaks.len() - 1];
    breaks.push(if t1.is_finite() { t1 } else { last + 1.0 });
    for pair in breaks.windows(2) {
        if pair[0] > t0 && holds(pair[0]) || holds((pair[0] + pair[1]) / 2.0) {
            return Some(tick_after(pair[0])).filter(|t| *t <= t1);
        }
    }
    (t1.is_finite() && holds(t1)).then_some(t1)
}

/// Returns the depth to which a condition is nested, 1 for a plain comparison or test; where it is more than
/// [`DEPTH_MAX`], one more than that.
pub(super) fn depth(condition: &Condition) -> usize {
    let mut deepest = 0;
    let mut stack = vec![(condition, 1)];
    while let Some((c, depth)) = stack.pop() {
        deepest = deepest.max(depth);
        if depth <= DEPTH_MAX {
            stack.extend(parts(c).map(|part| (part, depth + 1)));
        }
    }
    deepest
}

/// Returns the one or two conditions that a condition combines; none for a simple one.
fn parts(condition: &Condition) -> impl Iterator<Item = &Condition> {
    let (a, b) = match condition {
        Condition::And(a, b) | Condition::Or(a, b) => (Some(&**a), Some(&**b)),
        Condition::Not(a) => (Some(&**a), None),
        Condition::Compare { .. }
        | Condition::Docked(_)
        | Condition::Mated(..)
        | Condition::Touching(_)
        | Condition::TouchingEachOther(..) => (None, None),
    };
    a.into_iter().chain(b)
}

/// Returns true if a part of a condition reads a sensor: all do but the time since the action began.
pub(super) fn senses(condition: &Condition) -> bool {
    match condition {
        Condition::Compare { signal, .. } => *signal != Signal::Elapsed,
        Condition::Docked(_)
        | Condition::Mated(..)
        | Condition::Touching(_)
        | Condition::TouchingEachOther(..) => true,
        Condition::And(..) | Condition::Or(..) | Condition::Not(_) => parts(condition).any(senses),
    }
}

/// Returns true or false where it is known that a condition holds, or does not, at an instant; rates are those just after
/// it.
pub(super) fn holds(condition: &Condition, view: &View, t: f64) -> Option<bool> {
    match condition {
        Condition::Compare { signal, compare, value } => {
            let at = value_at(*signal, view, t)?;
            Some(match compare {
                Compare::Less => at < *value,
                Compare::LessEqual => at <= *value,
                Compare::Greater => at > *value,
                Compare::GreaterEqual => at >= *value,
            })
        }
        Condition::Docked(port) => Some(bonds_of(view, *port).next().is_some()),
        Condition::Mated(a, b) => Some(bonds_of(view, *a).any(|other| other == *b)),
        Condition::Touching(modules) => view.sensors.map(|sensors| sensors.touches(modules, None)),
        Condition::TouchingEachOther(a, b) => view.sensors.map(|sensors| sensors.touches(a, Some(b))),
        Condition::And(a, b) => match (holds(a, view, t), holds(b, view, t)) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (a, b) => a.and(b),
        },
        Condition::Or(a, b) => match (holds(a, view, t), holds(b, view, t)) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (a, b) => a.and(b),
        },
        Condition::Not(a) => holds(a, view, t).map(|holds| !holds),
    }
}

/// Returns the ports docked to a port.
fn bonds_of<'a>(view: &'a View, port: PortRef) -> impl Iterator<Item = PortRef> + 'a {
    let holding = view.robot.bonds.iter().zip(view.holds).filter(|(_, holds)| **holds);
    holding.filter_map(move |(bond, _)| match port {
        p if p == bond.a => Some(bond.b),
        p if p == bond.b => Some(bond.a),
        _ => None,
    })
}

/// Returns the value of a signal at an instant, just after it for a speed: s, rad or m, rad/s or m/s; `None` where only
/// sensors know it and there are none.
fn value_at(signal: Signal, view: &View, t: f64) -> Option<f64> {
    if signal == Signal::Elapsed {
        return Some(t - view.began);
    }
    if let Some(sensors) = view.sensors {
        return Some(sensors.value(signal));
    }
    match signal {
        Signal::Angle(joint) => Some(view.motions[joint.0 as usize].position(t)),
        Signal::Speed(joint) => {
            let piece = view.motions[joint.0 as usize].pieces(t, f64::INFINITY).into_iter().next();
            Some(piece.map_or(0.0, |p| p.rate().control[0]))
        }
        Signal::Elapsed | Signal::Effort(_) | Signal::Separation(..) | Signal::Tilt(_) => None,
    }
}

/// Collects the instants in `t0..t1` at which a part of the condition may change.
fn add_breaks(condition: &Condition, view: &View, t0: f64, t1: f64, breaks: &mut Vec<f64>) {
    if let Condition::Compare { signal, value, .. } = condition {
        for piece in pieces(*signal, view, t0, t1) {
            breaks.push(piece.start);
            breaks.extend(crossings(&piece, *value));
        }
    }
    parts(condition).for_each(|part| add_breaks(part, view, t0, t1, breaks));
}

/// Returns the pieces of a signal over `t0..t1`.
fn pieces(signal: Signal, view: &View, t0: f64, t1: f64) -> Vec<SignalPiece> {
    let pieces = |joint: crate::robot::JointId| view.motions[joint.0 as usize].pieces(t0, t1);
    match signal {
        Signal::Angle(joint) => pieces(joint),
        Signal::Speed(joint) => pieces(joint).iter().map(SignalPiece::rate).collect(),
        Signal::Elapsed => {
            let elapsed = t0 - view.began;
            let span = if t1.is_finite() { t1 - t0 } else { 1.0 };
            vec![SignalPiece { start: t0, end: t1, control: vec![elapsed, elapsed + span] }]
        }
        Signal::Effort(_) | Signal::Separation(..) | Signal::Tilt(_) => Vec::new(),
    }
}

/// Returns the times at which a piece of a signal crosses a value.
fn crossings(piece: &SignalPiece, value: f64) -> Vec<f64> {
    let control: Vec<f64> = piece.control.iter().map(|c| c - value).collect();
    if control.len() == 2 {
        let u = control[0] / (control[0] - control[1]);
        let t = piece.start + u * piece.span();
        return if u > 0.0 && t < piece.end { vec![t] } else { vec![] };
    }
    if control.len() < 2 || piece.start == piece.end {
        return vec![];
    }
    polynomial::roots(&control).into_iter().map(|u| piece.start + u * piece.span()).collect()
}
