//! Trajectories of ROS, `trajectory_msgs/JointTrajectory`: points that a quintic interpolation joins to the plan's motion.

use super::export::{Export, ExportFile};
use super::motion::{JointMotion, Stretch, joints};
use super::names::Names;
use super::pieces::{Piece, pieces};
use super::refusal::Refusal;
use crate::plan::{Plan, Tracks};
use serde_json::json;

/// Nanoseconds in a second.
const NANOS: f64 = 1e9;
/// The greatest distance, rad or m, of the quintic between two points from the motion, where that is of a higher degree.
const DEVIATION_MAX: f64 = 1e-10;
/// The greatest relative difference of two values that are the same but for rounding.
const ROUNDING: f64 = 1e-12;
/// The greatest number of times that a stretch is halved.
const HALVINGS_MAX: usize = 12;

/// A trajectory of the joints of a robot while its bonds stay, as `trajectory_msgs/JointTrajectory` states it.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// The end of the stem of its file names, equal to that of the robot's description: empty if it is the only one.
    pub suffix: String,
    /// The time from the start of the plan at which it begins, s.
    pub from: f64,
    /// The names of the joints that are commanded, those of the robot's description.
    pub joints: Vec<String>,
    /// The points in order of time, each later than the one before; at least one.
    pub points: Vec<TrajectoryPoint>,
}

/// A point of a trajectory: what its joints do at one time, in rad or m and s.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryPoint {
    /// The time from the start of the trajectory, ns.
    pub nanoseconds: u64,
    /// The positions of the joints.
    pub positions: Vec<f64>,
    /// Their velocities; at a jump those before or after it, with two points 1 ns apart.
    pub velocities: Vec<f64>,
    /// Their accelerations, likewise.
    pub accelerations: Vec<f64>,
}

/// Returns the trajectories of a plan, one for each piece of robot between changes of its bonds, in order of time. Between
/// two points the polynomial of degree 5 with their positions, velocities and accelerations is the motion of the plan, to
/// 1e-9 rad or m.
///
/// # Errors
/// [`Refusal::NoJoints`] for lattices and trusses.
pub fn trajectories(plan: &Plan) -> Result<Vec<Trajectory>, Refusal> {
    let tracks = plan.body.tracks().ok_or(Refusal::NoJoints { format: "a joint trajectory" })?;
    let names = Names::of(&tracks.robot);
    let all = pieces(tracks).into_iter().map(|piece| trajectory(tracks, &names, piece));
    Ok(all.collect())
}

fn trajectory(tracks: &Tracks, names: &Names, piece: Piece) -> Trajectory {
    let commanded: Vec<JointMotion> =
        joints(tracks, &piece).into_iter().filter(JointMotion::is_commanded).collect();
    let mut points = Vec::new();
    for stretch in Stretch::all(tracks, &piece, &commanded) {
        add_stretch(&stretch, piece.from, &mut points);
    }
    Trajectory {
        suffix: piece.suffix,
        from: piece.from,
        joints: commanded.iter().map(|joint| names.joints[joint.joint].clone()).collect(),
        points,
    }
}

/// Adds the points of a stretch of a trajectory that begins at `origin`, s. Times are whole nanoseconds, and both ends of
/// the stretch lie inside of it, so that every point is on the motion.
fn add_stretch(stretch: &Stretch, origin: f64, points: &mut Vec<TrajectoryPoint>) {
    let (start, end) = stretch.between;
    let first = ((start - origin) * NANOS).ceil() as u64;
    let last = ((end - origin) * NANOS).floor() as u64;
    let at = |nanoseconds: u64| {
        let [positions, velocities, accelerations] = stretch.at(origin + nanoseconds as f64 / NANOS);
        TrajectoryPoint { nanoseconds, positions, velocities, accelerations }
    };
    let begins = match points.last() {
        None => Some(at(first)),
        Some(before) => {
            let own = at(first.max(before.nanoseconds + 1));
            (!follows_on(before, &own)).then_some(own)
        }
    };
    points.extend(begins);
    let begun = points.last().expect("the first stretch adds its beginning").clone();
    if last <= begun.nanoseconds {
        return;
    }
    let ends = at(last);
    if stretch.is_high() {
        halve(&at, &begun, &ends, HALVINGS_MAX, points);
    }
    points.push(ends);
}

/// Returns true if a point states the motion of the one before, a nanosecond or two earlier: nothing jumps.
fn follows_on(before: &TrajectoryPoint, point: &TrajectoryPoint) -> bool {
    let same = |a: &[f64], b: &[f64], rate: &[f64]| {
        let step = (point.nanoseconds - before.nanoseconds) as f64 / NANOS;
        let near = |i: usize| (a[i] + rate[i] * step - b[i]).abs() <= ROUNDING * (1.0 + a[i].abs());
        (0..a.len()).all(near)
    };
    let still = vec![0.0; point.positions.len()];
    same(&before.positions, &point.positions, &point.velocities)
        && same(&before.velocities, &point.velocities, &point.accelerations)
        && same(&before.accelerations, &point.accelerations, &still)
}

/// Adds the points between two points of a stretch that keep the quintic between neighbours near the motion.
fn halve(
    at: &dyn Fn(u64) -> TrajectoryPoint,
    a: &TrajectoryPoint,
    b: &TrajectoryPoint,
    depth: usize,
    points: &mut Vec<TrajectoryPoint>,
) {
    let span = b.nanoseconds - a.nanoseconds;
    let is_near = |part: u64| {
        let between = at(a.nanoseconds + span * part / 8);
        let quintic = interpolated(a, b, between.nanoseconds);
        quintic.iter().zip(&between.positions).all(|(x, y)| (x - y).abs() <= DEVIATION_MAX)
    };
    if depth == 0 || span < 16 || (1..8).all(is_near) {
        return;
    }
    let middle = at(a.nanoseconds + span / 2);
    halve(at, a, &middle, depth - 1, points);
    points.push(middle.clone());
    halve(at, &middle, b, depth - 1, points);
}

/// Returns the positions at a time (ns) on the polynomials of degree 5 between two points.
fn interpolated(a: &TrajectoryPoint, b: &TrajectoryPoint, nanoseconds: u64) -> Vec<f64> {
    let h = (b.nanoseconds - a.nanoseconds) as f64 / NANOS;
    let u = (nanoseconds - a.nanoseconds) as f64 / NANOS / h;
    let of = |i: usize| {
        let (p, v, c) = (a.positions[i], a.velocities[i] * h, a.accelerations[i] * h * h);
        let (q, w, d) = (b.positions[i], b.velocities[i] * h, b.accelerations[i] * h * h);
        // The control points of the quintic in Bernstein form.
        let control = [p, p + v / 5.0, p + 0.4 * v + c / 20.0, q - 0.4 * w + d / 20.0, q - w / 5.0, q];
        crate::plan::polynomial::value(&control, u)
    };
    (0..a.positions.len()).map(of).collect()
}

/// Returns the trajectories of a plan as files of YAML.
///
/// # Errors
/// As for [`trajectories`].
pub(super) fn write_yaml(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let file = |trajectory: &Trajectory| {
        let name = format!("{}{}.trajectory.yaml", export.stem, trajectory.suffix);
        ExportFile::text(name, yaml(trajectory, export.title))
    };
    Ok(trajectories(export.plan)?.iter().map(file).collect())
}

/// Returns the trajectories of a plan as files of JSON.
///
/// # Errors
/// As for [`trajectories`].
pub(super) fn write_json(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let file = |trajectory: &Trajectory| {
        let name = format!("{}{}.trajectory.json", export.stem, trajectory.suffix);
        ExportFile::text(name, as_json(trajectory))
    };
    Ok(trajectories(export.plan)?.iter().map(file).collect())
}

fn stamp(nanoseconds: u64) -> (u64, u64) {
    (nanoseconds / NANOS as u64, nanoseconds % NANOS as u64)
}

fn as_json(trajectory: &Trajectory) -> String {
    let point = |point: &TrajectoryPoint| {
        let (sec, nanosec) = stamp(point.nanoseconds);
        json!({
            "positions": point.positions,
            "velocities": point.velocities,
            "accelerations": point.accelerations,
            "effort": [],
            "time_from_start": { "sec": sec, "nanosec": nanosec },
        })
    };
    let message = json!({
        "header": { "stamp": { "sec": 0, "nanosec": 0 }, "frame_id": "" },
        "joint_names": trajectory.joints,
        "points": trajectory.points.iter().map(point).collect::<Vec<_>>(),
    });
    format!("{message}\n")
}

fn yaml(trajectory: &Trajectory, title: &str) -> String {
    let plain: String = title.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let mut text = format!(
        "# trajectory_msgs/msg/JointTrajectory of {plain}, from {} s of its plan on; rad, m and s.\n\
         header:\n  stamp: {{sec: 0, nanosec: 0}}\n  frame_id: \"\"\njoint_names:",
        trajectory.from
    );
    if trajectory.joints.is_empty() {
        text.push_str(" []");
    }
    text.push('\n');
    for joint in &trajectory.joints {
        // A text of JSON is one of YAML.
        text.push_str(&format!("- {}\n", json!(joint)));
    }
    text.push_str("points:\n");
    for point in &trajectory.points {
        let (sec, nanosec) = stamp(point.nanoseconds);
        text.push_str(&format!("- positions: {}\n", yaml_list(&point.positions)));
        text.push_str(&format!("  velocities: {}\n", yaml_list(&point.velocities)));
        text.push_str(&format!("  accelerations: {}\n", yaml_list(&point.accelerations)));
        text.push_str(&format!("  effort: []\n  time_from_start: {{sec: {sec}, nanosec: {nanosec}}}\n"));
    }
    text
}

/// Returns numbers as a list of YAML. A number with an exponent needs a dot there, and a sign before large ones.
fn yaml_list(numbers: &[f64]) -> String {
    let number = |x: &f64| {
        let text = format!("{:?}", x + 0.0);
        match text.split_once('e') {
            None => text,
            Some((digits, exponent)) => {
                let dot = if digits.contains('.') { "" } else { ".0" };
                let plus = if exponent.starts_with('-') { "" } else { "+" };
                format!("{digits}{dot}e{plus}{exponent}")
            }
        }
    };
    format!("[{}]", numbers.iter().map(number).collect::<Vec<_>>().join(", "))
}
