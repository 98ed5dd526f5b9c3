//! The map from a plan's joints to the motors of a real robot, as a file states it, and whether it fits a plan.

use super::series::{can_be_commanded, quantity};
use crate::formats::RecordTable;
use crate::plan::{Plan, Segment, Tracks, polynomial};
use crate::robot::{JointId, JointOwner};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The excess over a limit that counts as rounding, rad or m, and rad/s or m/s.
const TOL_LIMIT: f64 = 1e-9;
/// The tolerance of the greatest position and speed of a polynomial, in parts of its largest control point.
const TOL_EXTREME: f64 = 1e-10;
/// The names that a message lists of those there are.
const LISTED: usize = 6;

/// The map of a robot: which motor on which bus moves which joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotMap {
    /// The modules that are there, each with its bus.
    pub modules: Vec<MappedModule>,
    /// The motors of hinges in bonds, for robots that have some.
    #[serde(default)]
    pub hinges: Vec<MappedHinge>,
}

/// A module of the map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MappedModule {
    /// The path name of the module in the plan, such as `leg[2].m[0]`.
    pub module: String,
    /// The number of the module on the bus.
    pub bus: u32,
    /// The motors of its joints.
    pub joints: Vec<MappedJoint>,
}

/// A joint of a module with its motor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MappedJoint {
    /// The name of the joint in its module, such as `tilt`.
    pub joint: String,
    /// The motor.
    pub motor: Motor,
}

/// A hinge of a bond with its motor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MappedHinge {
    /// The name of the bond, such as `a.front -- b.back`.
    pub bond: String,
    /// The number on the bus of the module with the motor.
    pub bus: u32,
    /// The motor.
    pub motor: Motor,
}

/// A motor: its target is `sign · q + zero` for the position q of the joint, in rad, or m where it slides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// The number of the motor among those on its bus.
    pub channel: u32,
    /// The target at which the joint is at 0, rad or m.
    #[serde(default)]
    pub zero: f64,
    /// 1 where the motor turns as the joint, -1 where it turns against it.
    #[serde(default = "forwards")]
    pub sign: i8,
    /// The least and the greatest target, rad or m.
    #[serde(default)]
    pub range: Option<[f64; 2]>,
    /// The greatest speed, rad/s or m/s.
    #[serde(default)]
    pub speed: Option<f64>,
}

fn forwards() -> i8 {
    1
}

impl Motor {
    /// Returns the target for a position of the joint, rad or m.
    pub fn target(&self, position: f64) -> f64 {
        f64::from(self.sign) * position + self.zero
    }
}

/// A motor that a plan commands.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// The joint.
    pub joint: JointId,
    /// The number of its module on the bus.
    pub bus: u32,
    /// Its motor.
    pub motor: Motor,
}

/// The reason why a map does not fit a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum MapFault {
    /// The plan is one of a lattice or a truss.
    NoJoints,
    /// The plan has nothing of this name.
    Unknown {
        /// The kind of thing, in words.
        what: &'static str,
        /// The name in the map.
        name: String,
        /// Some of the names there are.
        known: Vec<String>,
    },
    /// The joint takes no commands: it has no motor, follows others, or does not move.
    NotCommanded(String),
    /// The joint has two motors in the map.
    Twice(String),
    /// Two joints have the same motor.
    Shared {
        /// The number on the bus.
        bus: u32,
        /// The number of the motor.
        channel: u32,
        /// The two joints.
        joints: [String; 2],
    },
    /// The sign is neither 1 nor -1, or a number is not finite, or a range is empty.
    Senseless(String),
    /// The plan moves a joint that has no motor in the map.
    Unmapped(String),
    /// The plan drives a motor past the end of its range, or too fast.
    Exceeded {
        /// The joint.
        joint: String,
        /// The target or speed, rad or m, a second for a speed.
        value: f64,
        /// The limit in the map.
        limit: f64,
        /// True for a speed.
        is_speed: bool,
        /// The beginning of the piece of motion, s from the start of the plan.
        time: f64,
    },
}

impl fmt::Display for MapFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            MapFault::NoJoints => f.write_str("a map is one of joints, which lattices and trusses have not"),
            MapFault::Unknown { what, name, known } => {
                write!(f, "the plan has no {what} `{name}`; there are {}", known.join(", "))
            }
            MapFault::NotCommanded(joint) => write!(
                f,
                "`{joint}` takes no commands: it has no motor of its own, follows other joints or does not move"
            ),
            MapFault::Twice(joint) => write!(f, "`{joint}` is in the map twice"),
            MapFault::Shared { bus, channel, joints: [a, b] } => {
                write!(f, "motor {channel} on bus {bus} is that of `{a}` and of `{b}`")
            }
            MapFault::Senseless(joint) => write!(
                f,
                "the motor of `{joint}` makes no sense: its sign is 1 or -1, its numbers are finite, its range goes from \
                 the lesser to the greater"
            ),
            MapFault::Unmapped(joint) => write!(f, "the plan moves `{joint}`, which has no motor in the map"),
            MapFault::Exceeded { joint, value, limit, is_speed, time } => {
                let (what, per) = if *is_speed { ("speed", "/s") } else { ("target", "") };
                write!(
                    f,
                    "the plan drives `{joint}` to a {what} of {value:.4} (rad or m){per} from {time} s on, and the map \
                     allows {limit:.4}"
                )
            }
        }
    }
}

impl std::error::Error for MapFault {}

impl MapFault {
    /// Returns the name of a module or joint in the map that the fault is about, as the map file writes it; `None` if it
    /// is about none.
    pub fn name(&self) -> Option<&str> {
        let name = match self {
            MapFault::NoJoints | MapFault::Unmapped(_) => return None,
            MapFault::Unknown { what: "joint", name, .. } => name,
            MapFault::Unknown { name, .. } => return Some(name),
            MapFault::NotCommanded(joint) | MapFault::Twice(joint) | MapFault::Senseless(joint) => joint,
            MapFault::Shared { joints, .. } => &joints[1],
            MapFault::Exceeded { joint, .. } => joint,
        };
        // A hinge has the name of its bond; a joint of a module its own behind that of the module.
        if name.contains(" -- ") { Some(name) } else { name.rsplit_once('.').map(|(_, joint)| joint) }
    }
}

impl RobotMap {
    /// Returns the schema of map files, as JSON Schema.
    pub fn schema() -> serde_json::Value {
        let mut schema = schemars::schema_for!(RobotMap).to_value();
        if let Some(object) = schema.as_object_mut() {
            object.insert("title".into(), "modl robot map".into());
        }
        schema
    }

    /// Reads the text of a map file.
    ///
    /// # Errors
    /// (message, line, column): what is wrong and where, from 1.
    pub fn read(text: &str) -> Result<RobotMap, (String, usize, usize)> {
        serde_json::from_str(text).map_err(|e| (e.to_string(), e.line(), e.column()))
    }

    /// Returns the motors of a plan's joints, in the order of the joints.
    ///
    /// # Errors
    /// Everything in which the map does not fit the plan, at least one.
    pub fn checked(&self, plan: &Plan) -> Result<Vec<Driven>, Vec<MapFault>> {
        let tracks = plan.body.tracks().ok_or_else(|| vec![MapFault::NoJoints])?;
        let mut faults = Vec::new();
        let driven = self.driven(tracks, &mut faults);
        let mut by_joint: BTreeMap<JointId, Driven> = BTreeMap::new();
        let mut by_motor: BTreeMap<(u32, u32), JointId> = BTreeMap::new();
        for one in driven {
            let name = tracks.robot.name_of(one.joint);
            let owner = tracks.robot.joints().nth(one.joint.0 as usize);
            let motor = &one.motor;
            let limits = motor.range.into_iter().flatten().chain(motor.speed);
            let finite = limits.chain([motor.zero]).all(f64::is_finite);
            if !owner.is_some_and(|owner| can_be_commanded(plan, owner)) {
                faults.push(MapFault::NotCommanded(name));
                continue;
            }
            if motor.sign.abs() != 1 || !finite || motor.range.is_some_and(|[low, high]| low >= high) {
                faults.push(MapFault::Senseless(name));
                continue;
            }
            if let Some(other) = by_motor.insert((one.bus, motor.channel), one.joint)
                && other != one.joint
            {
                let joints = [tracks.robot.name_of(other), name.clone()];
                faults.push(MapFault::Shared { bus: one.bus, channel: motor.channel, joints });
            }
            if by_joint.insert(one.joint, one).is_some() {
                faults.push(MapFault::Twice(name));
            }
        }
        for track in &tracks.tracks {
            match by_joint.get(&track.joint) {
                None if track.segments.is_empty() => {}
                None => faults.push(MapFault::Unmapped(tracks.robot.name_of(track.joint))),
                Some(driven) => exceeded(tracks, driven, &track.segments, &mut faults),
            }
        }
        for driven in by_joint.values() {
            let start = tracks.start.joints[driven.joint.0 as usize];
            within(tracks, driven, [start, start], 0.0, &mut faults);
        }
        if faults.is_empty() { Ok(by_joint.into_values().collect()) } else { Err(faults) }
    }

    /// Returns the motors with the joints that they name; names that the plan does not have are faults.
    fn driven(&self, tracks: &Tracks, faults: &mut Vec<MapFault>) -> Vec<Driven> {
        let robot = &tracks.robot;
        let listed = |all: Vec<String>| -> Vec<String> {
            let more = all.len().saturating_sub(LISTED);
            let named = all.into_iter().take(LISTED).map(|name| format!("`{name}`"));
            named.chain((more > 0).then(|| format!("{more} more"))).collect()
        };
        let joints: BTreeMap<String, u32> =
            robot.joints().zip(0..).map(|(owner, id)| (robot.joint_name(owner), id)).collect();
        let modules: BTreeMap<&str, usize> =
            robot.modules.iter().enumerate().map(|(index, module)| (module.name.as_str(), index)).collect();
        let mut driven = Vec::new();
        for MappedModule { module, bus, joints: own } in &self.modules {
            let Some(&index) = modules.get(module.as_str()) else {
                let known = listed(robot.modules.iter().map(|module| module.name.clone()).collect());
                faults.push(MapFault::Unknown { what: "module", name: module.clone(), known });
                continue;
            };
            let declared = &robot.module_type(index).joints;
            for MappedJoint { joint, motor } in own {
                let name = format!("{module}.{joint}");
                match joints.get(&name).filter(|_| declared.iter().any(|known| known.name == *joint)) {
                    Some(&id) => {
                        driven.push(Driven { joint: JointId(id), bus: *bus, motor: motor.clone() });
                    }
                    None => {
                        let known = listed(declared.iter().map(|known| known.name.clone()).collect());
                        faults.push(MapFault::Unknown { what: "joint", name, known });
                    }
                }
            }
        }
        for MappedHinge { bond, bus, motor } in &self.hinges {
            match joints.get(bond) {
                Some(&id) => driven.push(Driven { joint: JointId(id), bus: *bus, motor: motor.clone() }),
                None => {
                    let hinges = robot.joints().filter(|owner| matches!(owner, JointOwner::Bond(_)));
                    let known = listed(hinges.map(|owner| robot.joint_name(owner)).collect());
                    faults.push(MapFault::Unknown { what: "hinge", name: bond.clone(), known });
                }
            }
        }
        driven
    }
}

/// Adds the faults of a motor along the pieces of motion of its joint, one of each kind at most.
fn exceeded(tracks: &Tracks, driven: &Driven, segments: &[Segment], faults: &mut Vec<MapFault>) {
    for segment in segments {
        let turned: Vec<f64> = segment.control.iter().map(|x| -x).collect();
        let high = polynomial::greatest(&segment.control, TOL_EXTREME).0;
        let low = -polynomial::greatest(&turned, TOL_EXTREME).0;
        if within(tracks, driven, [low, high], segment.start, faults) {
            break;
        }
    }
    let Some(limit) = driven.motor.speed else { return };
    for segment in segments {
        let rates = polynomial::derivative(&segment.control);
        let value = polynomial::greatest_size(&rates, TOL_EXTREME).0 / (segment.end - segment.start);
        if value > limit + TOL_LIMIT {
            let (joint, time) = (tracks.robot.name_of(driven.joint), segment.start);
            faults.push(MapFault::Exceeded { joint, value, limit, is_speed: true, time });
            break;
        }
    }
}

/// Adds a fault if positions between two (rad or m) lead out of a motor's range; returns true if they do.
fn within(
    tracks: &Tracks,
    driven: &Driven,
    positions: [f64; 2],
    time: f64,
    faults: &mut Vec<MapFault>,
) -> bool {
    let Some([low, high]) = driven.motor.range else { return false };
    for value in positions.map(|position| driven.motor.target(position)) {
        if value < low - TOL_LIMIT || value > high + TOL_LIMIT {
            let limit = if value < low { low } else { high };
            let joint = tracks.robot.name_of(driven.joint);
            let fault = MapFault::Exceeded { joint, value, limit, is_speed: false, time };
            if !faults.contains(&fault) {
                faults.push(fault);
            }
            return true;
        }
    }
    false
}

/// Returns the targets of motors along a plan at some times (s), as a table with a column `BUS/CHANNEL` for each motor.
pub fn targets(tracks: &Tracks, driven: &[Driven], times: &[f64]) -> RecordTable {
    let mut columns = vec![quantity("time", "s", times.to_vec())];
    for one in driven {
        let owner = tracks.robot.joints().nth(one.joint.0 as usize);
        let unit = if owner.is_some_and(|owner| tracks.robot.slides(owner)) { "m" } else { "rad" };
        let (track, start) = (tracks.track(one.joint), tracks.start.joints[one.joint.0 as usize]);
        let position = |t: &f64| track.map_or(start, |track| track.position(start, *t));
        let values = times.iter().map(|t| one.motor.target(position(t))).collect();
        columns.push(quantity(&format!("{}/{}", one.bus, one.motor.channel), unit, values));
    }
    RecordTable { columns, rows: times.len() }
}

/// Returns the joints of a plan that can be commanded and are in no map.
pub fn without_motor(plan: &Plan, driven: &[Driven]) -> Vec<String> {
    let Some(tracks) = plan.body.tracks() else { return Vec::new() };
    let known: BTreeSet<JointId> = driven.iter().map(|one| one.joint).collect();
    let all = tracks.robot.joints().zip(0..);
    let lacking = all.filter(|(owner, id)| can_be_commanded(plan, *owner) && !known.contains(&JointId(*id)));
    lacking.map(|(owner, _)| tracks.robot.joint_name(owner)).collect()
}
