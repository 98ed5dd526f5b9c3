//! The data of a simulation in a page, beside that of the plan that it plays: the measured motion, contact forces, efforts
//! and the paths of further runs.

use super::columns::{column, unit_of};
use super::input::RenderInput;
use super::mesh::Mesh;
use super::number::{list, number, place, vector};
use super::robot::MeasuredTrees;
use super::tolerances::TOLERANCES;
use super::{data, findings};
use crate::geometry::{HeightField, Placed, Pose, Vec3, ground_features};
use crate::plan::Tracks;
use crate::robot::{Assembly, JointOwner};
use crate::simulate::{
    BondEvent, BondEventKind, ContactForce, Drive, Extreme, FailureCounts, Moment, Run, Simulation, Terrain,
};
use crate::units::{Dimension, fixed, quantity};
use serde_json::{Value, json};

/// The most numbers of motion in one page; of a longer one every second moment is shown, every third, ...
const NUMBERS_MAX: usize = 400_000;

/// The numbers of a contact in a page.
const CONTACT: usize = 8;

/// The most positions on the paths of all runs in one page.
const PATHS_MAX: usize = 20_000;

/// The most runs whose paths are in one page.
const RUNS_MAX: usize = 2000;

/// The squares along each axis in which terrain is drawn.
const TERRAIN_CELLS: usize = 40;

/// The length of the arrow of the robot's whole weight, as a part of about how large the robot is: of several feet, each has
/// a part of it.
const WEIGHT_ARROW: f64 = 1.5;

/// The input of a page of a simulation besides its plan.
#[derive(Clone, Copy, Debug)]
pub struct SimulationInput<'a> {
    /// The simulation.
    pub outcome: &'a Simulation,
    /// Further runs, whose paths are drawn; may be empty.
    pub runs: &'a [Run],
    /// Sentences about the simulation, for the page to list.
    pub notes: &'a [String],
}

/// Returns the data of a simulation as the page's scripts read it: that of its plan, which is the ghost, under the names
/// that it has in pages of plans, with the measured motion as `simulation`. Only plans of joints have simulations; of
/// others the data is the plan's.
pub(super) fn data(input: &RenderInput, shown: &SimulationInput) -> Value {
    let Some(tracks) = input.plan.body.tracks() else { return data::data(input) };
    let outcome = shown.outcome;
    let placed = outcome.terrain.as_ref().map_or(Pose::identity(), |terrain| terrain.X_WP);
    let mut page = data::nominal(input, &placed);
    let mut notes: Vec<String> = Vec::new();
    let mut measured =
        measured(tracks, shown, input.plan.worlds.first().map_or(0.0, |w| w.world.gravity), &mut notes);
    measured["events"] = events(tracks, outcome);
    let end = outcome.motion.last().map_or(0.0, |moment| moment.time);
    page["title"] = json!(input.title);
    let travels = length(outcome.travel.xy().norm());
    page["summary"] = json!(format!("{}, travels {travels}", findings::summary(input, outcome.duration)));
    page["duration"] = number(end);
    page["end"] = number(end);
    page["verdict"] = told(tracks, shown);
    if let Some(list) = page["notes"].as_array_mut() {
        list.extend(notes.into_iter().map(Value::from));
    }
    if let Some(terrain) = &outcome.terrain {
        page["ground"] = json!(false);
        measured["terrain"] = terrain_lines(&terrain.field, outcome, size(&tracks.robot));
    }
    measured["obstacles"] = outcome.obstacles.iter().flat_map(|shapes| outlines(shapes)).collect();
    page["simulation"] = measured;
    page
}

/// Returns what was measured, in words, in the form in which pages of plans hold verdicts.
fn told(tracks: &Tracks, shown: &SimulationInput) -> Value {
    let (robot, outcome) = (&tracks.robot, shown.outcome);
    let of_bond = |index: usize| {
        let event = &outcome.bonds[index];
        let bond = &robot.bonds[event.bond];
        let kind = if matches!(event.kind, BondEventKind::Breaks(_)) { "bond load" } else { "docking" };
        (kind, vec![bond.a.module, bond.b.module])
    };
    let failure = |(time, bond, message): (f64, Option<usize>, String)| {
        let (kind, modules) = bond.map_or(("stability", vec![]), of_bond);
        let place = if bond.is_none() { base_at(outcome, time) } else { None };
        json!({
            "time": number(time), "until": null, "kind": kind, "message": message,
            "point": place.as_ref().map(vector), "modules": modules, "blame": [],
        })
    };
    let failures: Vec<Value> = outcome.timed_failures(robot).into_iter().map(failure).collect();
    let fails = !failures.is_empty();
    let worst = |extreme: Option<Extreme>, words: &dyn Fn(&Extreme) -> String| {
        extreme.map(|e| json!([number(e.time), words(&e)]))
    };
    let parts = |x: f64| format!("{}%", fixed(100.0 * x, 1));
    let angle = |x: f64| format!("{}deg", fixed(x.to_degrees(), 1));
    let extremes = [
        worst(outcome.lag, &|e| format!("greatest lag {}, {}", angle(e.value), e.joint(robot))),
        worst(outcome.lag_length, &|e| format!("greatest lag {}, {}", length(e.value), e.joint(robot))),
        worst(outcome.effort, &|e| {
            format!("greatest effort {} of its limit, {}", parts(e.value), e.joint(robot))
        }),
        worst(outcome.bond_load, &|e| {
            format!("greatest load {} of what it holds, {}", parts(e.value), e.bond(robot))
        }),
        worst(outcome.dock_error(), &|e| {
            format!("ports to dock are off by {}, {}", length(e.value), e.bond(robot))
        }),
    ];
    let mut checks = vec![
        ["travels".to_owned(), length(outcome.travel.xy().norm())],
        ["turns".to_owned(), angle(outcome.heading)],
        ["leans at most".to_owned(), angle(outcome.lean_max)],
        ["slips at most".to_owned(), length(outcome.slip)],
        ["comes down at".to_owned(), quantity(libm::round(outcome.impact * 1e3) / 1e3, Dimension::SPEED)],
        ["motors' work".to_owned(), format!("{}J", fixed(outcome.work, 2))],
        ["time step".to_owned(), quantity(outcome.step, Dimension::TIME)],
    ];
    if !shown.runs.is_empty() {
        let failing = FailureCounts::of(shown.runs).fails;
        checks.push(["runs that fail".to_owned(), format!("{failing} of {}", shown.runs.len())]);
    }
    json!({
        "stamp": if fails { "failed" } else { "simulated" },
        "headline": match (outcome.fall, fails) {
            (Some(_), _) => "simulated: it falls",
            (None, true) => "simulated: it fails",
            (None, false) => "simulated",
        },
        "load": null,
        "checks": checks,
        "worst": extremes.into_iter().flatten().collect::<Vec<_>>(),
        "failures": failures,
        "notes": shown.notes,
        "events": [],
    })
}

/// Returns a length (m) in words.
fn length(x: f64) -> String {
    quantity(findings::short_length(x), Dimension::LENGTH)
}

/// Returns the position of the base at a time (s), m: at the first moment from then on.
fn base_at(outcome: &Simulation, time: f64) -> Option<Vec3> {
    let after = outcome.motion.partition_point(|moment| moment.time < time);
    outcome.motion.get(after).or(outcome.motion.last()).map(|moment| moment.base.translation.vector)
}

/// Returns `[time, text]` of bonds that dock and undock, as measured.
fn events(tracks: &Tracks, outcome: &Simulation) -> Value {
    let robot = &tracks.robot;
    let event = |event: &BondEvent| {
        let bond = robot.bond_name(event.bond);
        let words = match event.kind {
            BondEventKind::Undocks => format!("undocks {bond}"),
            BondEventKind::Docks(distance, angle) => {
                let (distance, angle) = (length(distance), fixed(angle.to_degrees(), 1));
                format!("docks {bond}, {distance} and {angle}deg from a perfect mate")
            }
            BondEventKind::Misses(..) | BondEventKind::Breaks(_) => return None,
        };
        Some(json!([number(event.time), words]))
    };
    outcome.bonds.iter().filter_map(event).collect()
}

/// Returns the measured motion, with lengths in metres, angles in radians, forces in newtons and times in seconds, in
/// [columns](column). Adds to `notes` a sentence for each thing left out. `gravity`: m/s².
fn measured(tracks: &Tracks, shown: &SimulationInput, gravity: f64, notes: &mut Vec<String>) -> Value {
    let (robot, outcome) = (&tracks.robot, shown.outcome);
    let trees = MeasuredTrees::new(tracks, &outcome.apart);
    let moments = thinned(&outcome.motion, trees.trees.len(), notes);
    let positions =
        |joint: usize| column(TOLERANCES.measured, moments.iter().map(move |moment| moment.joints[joint]));
    let base = |tree: usize| poses(moments.iter().map(move |moment| root(moment, tree)));
    let forces = moments.iter().flat_map(|moment| &moment.contacts).map(|contact| contact.force.norm());
    let newton = unit_of(forces.fold(0.0, f64::max));
    json!({
        "times": column(TOLERANCES.measured, moments.iter().map(|moment| moment.time)),
        "count": moments.len(),
        "trees": trees.trees,
        "forms": trees.forms,
        "bases": (0..trees.trees.len()).map(base).collect::<Vec<_>>(),
        "joints": (0..tracks.start.joints.len()).map(positions).collect::<Vec<_>>(),
        "drives": drives(robot, outcome, &moments),
        "force": newton,
        "contacts": moments.iter().map(|moment| contacts(&moment.contacts, newton)).collect::<Vec<_>>(),
        "newtons": newtons(robot, &outcome.motion, gravity),
        "fell": outcome.fall.and_then(|time| base_at(outcome, time)).map(|at| list([at.x, at.y].map(place))),
        "runs": runs(shown.runs, outcome.terrain.as_ref(), notes),
    })
}

/// Returns the moments that a page holds: all of them, or every second one, third one, ...; adds a note then.
fn thinned<'a>(motion: &'a [Moment], trees: usize, notes: &mut Vec<String>) -> Vec<&'a Moment> {
    let numbers = |moment: &Moment| {
        7 * trees + moment.joints.len() + moment.efforts.len() + CONTACT * moment.contacts.len()
    };
    let stride = motion.iter().map(numbers).sum::<usize>().div_ceil(NUMBERS_MAX).max(1);
    let last = motion.len().saturating_sub(1);
    if stride > 1 {
        notes.push(format!("of the moments of the simulation one in {stride} is shown"));
    }
    motion.iter().enumerate().filter(|(i, _)| i % stride == 0 || *i == last).map(|(_, m)| m).collect()
}

/// Returns the pose of the root of a tree.
fn root(moment: &Moment, tree: usize) -> Pose {
    if tree == 0 { moment.base } else { moment.roots[tree - 1] }
}

/// Returns poses as seven columns: x, y, z and the unit quaternion x, y, z, w, of which neighbours have no opposite signs.
fn poses(poses: impl Iterator<Item = Pose>) -> Value {
    let mut columns: [Vec<f64>; 7] = Default::default();
    let mut before: Option<[f64; 4]> = None;
    for pose in poses {
        let (p, q) = (pose.translation.vector, pose.rotation);
        let mut turn = [q.i, q.j, q.k, q.w];
        if before.is_some_and(|b| b.iter().zip(&turn).map(|(x, y)| x * y).sum::<f64>() < 0.0) {
            turn = turn.map(|x| -x);
        }
        before = Some(turn);
        let numbers = [p.x, p.y, p.z, turn[0], turn[1], turn[2], turn[3]];
        columns.iter_mut().zip(numbers).for_each(|(column, x)| column.push(x));
    }
    columns.into_iter().map(|numbers| column(TOLERANCES.measured, numbers)).collect()
}

/// Returns the drives as `{joint, name, limit, unit, efforts}`: the efforts over the moments as a column.
fn drives(robot: &Assembly, outcome: &Simulation, moments: &[&Moment]) -> Vec<Value> {
    let owners: Vec<JointOwner> = robot.joints().collect();
    let drive = |(index, drive): (usize, &Drive)| {
        let owner = owners[drive.joint];
        let motor = drive.motor.zip(match owner {
            JointOwner::Module { module, .. } => Some(module),
            JointOwner::Bond(_) => None,
        });
        let name = motor.map(|(motor, module)| {
            format!("{}.{}", robot.modules[module].name, robot.module_type(module).motors[motor].name)
        });
        let efforts = || moments.iter().map(move |moment| moment.efforts[index]);
        let unit = unit_of(drive.limit.unwrap_or(0.0).max(efforts().map(f64::abs).fold(0.0, f64::max)));
        json!({
            "joint": drive.joint,
            "name": name.unwrap_or_else(|| robot.joint_name(owner)),
            "limit": drive.limit.map(number),
            "unit": if robot.slides(owner) { "N" } else { "N·m" },
            "efforts": column(unit, efforts()),
        })
    };
    outcome.drives.iter().enumerate().map(drive).collect()
}

/// Returns the contacts of a moment as a flat list of `link, other or -1, x, y, z, fx, fy, fz`: positions in tenths of a
/// millimetre, forces in `newton`.
fn contacts(contacts: &[ContactForce], newton: f64) -> Vec<i64> {
    let whole = |x: f64| libm::round(x) as i64;
    let numbers = |contact: &ContactForce| {
        let (p, f) = (contact.point * 1e4, contact.force / newton);
        let of = [contact.link as i64, contact.other.map_or(-1, |other| other as i64)];
        [of[0], of[1], whole(p.x), whole(p.y), whole(p.z), whole(f.x), whole(f.y), whole(f.z)]
    };
    contacts.iter().flat_map(numbers).collect()
}

/// Returns the force of an arrow of 0.1 m, N: a 1, 2 or 5 with zeros, such that the weight of the robot, or its greatest
/// contact force where it has none, is somewhat longer than the robot is large. `gravity`: m/s².
fn newtons(robot: &Assembly, motion: &[Moment], gravity: f64) -> Value {
    let links = (0..robot.modules.len()).flat_map(|module| &robot.module_type(module).links);
    let mass: f64 = links.map(|link| link.mass).sum();
    let points = || motion.iter().flat_map(|moment| &moment.contacts);
    let weight = mass * gravity;
    let force = if weight > 0.0 { weight } else { points().map(|c| c.force.norm()).fold(0.0, f64::max) };
    let arrow = WEIGHT_ARROW * size(robot);
    let wanted = 0.1 * force / arrow;
    if !(wanted > 0.0 && wanted.is_finite()) {
        return json!(1);
    }
    let power = unit_of(wanted) * 1e3;
    let round = [5.0, 2.0, 1.0].into_iter().find(|x| x * power <= wanted).unwrap_or(1.0);
    number(round * power)
}

/// Returns about how large a robot is, m: the cube root of the number of its modules times the size of one.
fn size(robot: &Assembly) -> f64 {
    let reach = |module: usize| {
        let links = &robot.module_type(module).links;
        let features = links.iter().flat_map(|link| ground_features::features(&link.collides));
        features.map(|feature| feature.reach()).fold(0.0, f64::max)
    };
    let one = (0..robot.modules.len()).map(reach).fold(TOLERANCES.module, f64::max);
    2.0 * one * libm::cbrt(robot.modules.len() as f64)
}

/// Returns the sharp edges of an obstacle, each as a flat list of x, y, z of its ends in metres.
fn outlines(shapes: &[Placed]) -> Vec<Value> {
    let edge = |ends: &[Vec3; 2]| list(ends.iter().flat_map(|p| [p.x, p.y, p.z].map(place)));
    Mesh::of(shapes).edges.iter().map(edge).collect()
}

/// Returns lines along x and y on the terrain around the way of a robot, each as a flat list of x, y, z in metres; `size`:
/// that of the robot, m.
fn terrain_lines(field: &HeightField, outcome: &Simulation, size: f64) -> Value {
    let way = || outcome.motion.iter().map(|moment| moment.base.translation.vector);
    let [across, along] = [0, 1].map(|axis| {
        let (low, high) = way().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at[axis]), high.max(at[axis]))
        });
        let (low, high) = (low - size, high + size);
        move |i: usize| low + (high - low) * i as f64 / TERRAIN_CELLS as f64
    });
    let point = |i: usize, j: usize| {
        let (x, y) = (across(i), along(j));
        [x, y, field.height(x, y)].map(place)
    };
    let line = |k: usize, is_across: bool| {
        list((0..=TERRAIN_CELLS).flat_map(|i| if is_across { point(i, k) } else { point(k, i) }))
    };
    (0..=TERRAIN_CELLS).flat_map(|k| [line(k, true), line(k, false)]).collect()
}

/// Returns `[number of places, column of x, column of y, [x, y] where it fails or null, column of heights or null]` of each
/// run; heights are those of the terrain. Adds a note if some are left out.
fn runs(runs: &[Run], terrain: Option<&Terrain>, notes: &mut Vec<String>) -> Vec<Value> {
    let count = runs.len().min(RUNS_MAX);
    if count < runs.len() {
        notes.push(format!("of the paths of {} runs the first {count} are drawn", runs.len()));
    }
    let most = (PATHS_MAX / count.max(1)).max(2);
    let path = |run: &Run| {
        let stride = run.path.len().div_ceil(most).max(1);
        let last = run.path.len().saturating_sub(1);
        let kept = || run.path.iter().enumerate().filter(move |(i, _)| i % stride == 0 || *i == last);
        let along = |axis: usize| column(TOLERANCES.way, kept().map(move |(_, at)| at[axis]));
        let height = |at: &[f64; 2]| terrain.map(|terrain| terrain.field.height(at[0], at[1]));
        let heights = terrain.map(|_| column(TOLERANCES.way, kept().filter_map(|(_, at)| height(at))));
        let failed = run.failed_at.map(|at| list(at.into_iter().chain(height(&at)).map(place)));
        json!([kept().count(), along(0), along(1), failed, heights])
    };
    runs[..count].iter().map(path).collect()
}
