//! Simulations in words.

use super::outcome::{BondEventKind, Extreme, Simulation};
use crate::robot::{Assembly, JointId};
use crate::units::{Dimension, fixed, quantity};

/// The resolution of lengths in words, m, and of times, s.
const LENGTH: f64 = 1e-5;
const TIME: f64 = 1e-3;

/// The differences up to which lags (rad: 1°) and efforts, in parts of the limit, count as the same at half the step.
const LAG: f64 = std::f64::consts::PI / 180.0;
const EFFORT: f64 = 0.05;

impl Simulation {
    /// Returns the result on one line for what the base does, one for the joints and one for the motors, if there are
    /// any, one for the ports that dock, and one for each failure; `robot` names joints and bonds.
    pub fn in_words(&self, robot: &Assembly) -> Vec<String> {
        let mut lines = vec![format!(
            "simulated in steps of {}: travels {}, turns {}, leans at most {}",
            quantity(self.step, Dimension::TIME),
            length(self.travel.xy().norm()),
            degrees(self.heading),
            degrees(self.lean_max)
        )];
        if let Some(lag) = self.lag {
            lines.push(format!("joints lag by {} at {}", degrees(lag.value), lag.joint(robot)));
        }
        if let Some(lag) = self.lag_length {
            lines.push(format!("joints that slide lag by {} at {}", length(lag.value), lag.joint(robot)));
        }
        if let Some(effort) = self.effort {
            let effort = format!("{} of the limit at {}", fixed(effort.value, 2), effort.joint(robot));
            lines.push(format!("torque reaches {effort}"));
        }
        if let Some((distance, angle)) = self.dock_error().zip(self.dock_angle()) {
            lines.push(format!(
                "ports to dock are off by {} at {}, and by {} at {}",
                length(distance.value),
                distance.bond(robot),
                degrees(angle.value),
                angle.bond(robot)
            ));
        }
        lines.extend(self.failures(robot).into_iter().map(|failure| format!("failed {failure}")));
        lines
    }

    /// Returns the fall, the bonds that broke, the ports that did not dock, and why the program was stopped, in words, in
    /// order of time; `robot` names the bonds.
    pub fn failures(&self, robot: &Assembly) -> Vec<String> {
        let line = |(time, _, words): (f64, Option<usize>, String)| {
            format!("at {}: {words}", quantity(rounded(time, TIME), Dimension::TIME))
        };
        self.timed_failures(robot).into_iter().map(line).collect()
    }

    /// Returns the same as (time in s, index in `bonds`, words); the index is `None` for the fall and for a
    /// program that is stopped.
    pub fn timed_failures(&self, robot: &Assembly) -> Vec<(f64, Option<usize>, String)> {
        let fall = self.fall.map(|time| {
            let other = self.fallen.and_then(|module| robot.modules.get(module));
            let words =
                other.map_or("it falls".to_owned(), |other| format!("the robot with `{}` falls", other.name));
            (time, None, words)
        });
        let bonds = self.bonds.iter().enumerate().filter_map(|(index, event)| {
            let name = robot.bond_name(event.bond);
            let words = match event.kind {
                BondEventKind::Docks(..) | BondEventKind::Undocks => return None,
                BondEventKind::Misses(distance, angle) => format!(
                    "{name} does not dock: its ports are {} and {} from a perfect mate",
                    length(distance),
                    degrees(angle)
                ),
                BondEventKind::Breaks(load) => {
                    format!("{name} breaks, at {} of what it holds", fixed(load, 2))
                }
            };
            Some((event.time, Some(index), words))
        });
        let stop = self.stop.clone().map(|(time, words)| (time, None, words));
        let mut found: Vec<(f64, Option<usize>, String)> =
            fall.into_iter().chain(bonds).chain(stop).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// Returns the differences of this simulation from one with half the time step, in words: where it ends, what fails, and
    /// lags and efforts that are not nearly the same; `robot` names bonds.
    pub(super) fn halving(&self, finer: &Simulation, robot: &Assembly) -> String {
        let mut words = vec![format!(
            "at half the step it ends {} and {} from there",
            length((self.travel - finer.travel).norm()),
            degrees((self.heading - finer.heading).abs())
        )];
        let mut change = |(now, then): (bool, bool), comes: &str, goes: &str| {
            if now != then {
                words.push(if then { comes.to_owned() } else { goes.to_owned() });
            }
        };
        change((self.fall.is_some(), finer.fall.is_some()), "it falls", "it does not fall");
        let stops = (self.stop.is_some(), finer.stop.is_some());
        change(stops, "its program is stopped", "its program is not stopped");
        for bond in 0..robot.bonds.len() {
            let name = robot.bond_name(bond);
            let of = |simulation: &Simulation, kind: fn(&BondEventKind) -> bool| {
                simulation.bonds.iter().any(|event| event.bond == bond && kind(&event.kind))
            };
            let both = |kind| (of(self, kind), of(finer, kind));
            let breaks = both(|kind| matches!(kind, BondEventKind::Breaks(_)));
            change(breaks, &format!("{name} breaks"), &format!("{name} does not break"));
            let misses = both(|kind| matches!(kind, BondEventKind::Misses(..)));
            change(misses, &format!("{name} does not dock"), &format!("{name} does not miss"));
        }
        let lags = (Extreme::value_of(self.lag), Extreme::value_of(finer.lag));
        if differ(lags, LAG) {
            words.push(format!("joints lag by {}", degrees(lags.1)));
        }
        let efforts = (Extreme::value_of(self.effort), Extreme::value_of(finer.effort));
        if differ(efforts, EFFORT) {
            words.push(format!("torque reaches {} of the limit", fixed(efforts.1, 2)));
        }
        words.join(", and ")
    }
}

/// Returns true if two values differ by more than a tenth of the greater one, and by more than `least`.
fn differ((a, b): (f64, f64), least: f64) -> bool {
    (a - b).abs() > (0.1 * a.max(b)).max(least)
}

impl Extreme {
    /// Returns the greatest value of a quantity; 0 where there is none.
    pub fn value_of(extreme: Option<Extreme>) -> f64 {
        extreme.map_or(0.0, |extreme| extreme.value)
    }

    /// Returns the path name of the joint at which a quantity of joints was greatest; `robot`: the robot.
    pub fn joint(&self, robot: &Assembly) -> String {
        robot.name_of(JointId(u32::try_from(self.of).unwrap_or(u32::MAX)))
    }

    /// Returns the name of the bond at which a quantity of bonds was greatest; `robot`: the robot.
    pub fn bond(&self, robot: &Assembly) -> String {
        robot.bond_name(self.of)
    }
}

/// Returns a length (m) in words.
fn length(x: f64) -> String {
    quantity(rounded(x, LENGTH), Dimension::LENGTH)
}

/// Returns an angle (rad) in tenths of a degree, in words.
fn degrees(angle: f64) -> String {
    let tenths = libm::round(angle.to_degrees() * 10.0) / 10.0;
    format!("{}deg", fixed(tenths + 0.0, 1))
}

/// Returns a number in whole multiples of a unit.
fn rounded(x: f64, unit: f64) -> f64 {
    let whole = libm::round(1.0 / unit);
    libm::round(x * whole) / whole
}
