//! Plans as recordings of ROS 2 messages in MCAP files, which Foxglove and Rerun play.

use super::cdr::Cdr;
use super::export::{Export, ExportFile};
use super::motion::{JointMotion, joints};
use super::names::Names;
use super::pieces::{Piece, pieces};
use super::refusal::Refusal;
use super::ros_messages::{JOINT_STATE, JOINT_TRAJECTORY, LOG, MessageType, STRING, TRANSFORMS};
use super::trajectory::{Trajectory, trajectories};
use super::urdf::{descriptions, link_in_description};
use super::urdf_shapes::Shapes;
use crate::geometry::Pose;
use crate::plan::verify::articulated::LinkPaths;
use crate::plan::{DockingKind, Plan, Tracks, headline};
use mcap::records::MessageHeader;
use mcap::{McapResult, WriteOptions};
use std::collections::BTreeMap;
use std::io::Cursor;

/// The samples of joints and frames a second.
const RATE: f64 = 30.0;
/// The greatest number of transforms of a recording: of a longer or larger one there are fewer samples.
const TRANSFORMS_MAX: usize = 1_000_000;
/// The frame of the world.
const WORLD: &str = "world";
/// The levels of lines of a log.
const INFO: u8 = 20;
const ERROR: u8 = 40;

/// Returns the recording of a plan: `/robot_description` and `/planned_trajectory` for each piece of robot, `/tf`,
/// `/tf_static`, `/joint_states`, and `/events` with what docks, undocks and what the judge said. A robot with a closed loop
/// has no description, and is told so in `/events`. Times count from 0.
///
/// # Errors
/// [`Refusal::NoJoints`] for lattices and trusses.
pub(super) fn write(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let messages = messages(export)?;
    let bytes = recorded(messages).expect("memory takes all bytes, and texts are not too long");
    Ok(vec![ExportFile { name: format!("{}.mcap", export.stem), bytes }])
}

/// A message to be recorded.
struct Message {
    topic: &'static str,
    kind: &'static MessageType,
    nanoseconds: u64,
    bytes: Vec<u8>,
}

/// Returns the messages of a recording in order of time.
fn messages(export: &Export) -> Result<Vec<Message>, Refusal> {
    let plan = export.plan;
    let no_joints = Refusal::NoJoints { format: "a recording" };
    let tracks = plan.body.tracks().ok_or(no_joints.clone())?;
    let names = Names::of(&tracks.robot);
    let paths = LinkPaths::of(plan).ok_or(no_joints)?;
    let mut all = Vec::new();
    let mut log = |seconds: f64, level: u8, words: &str| {
        let mut cdr = Cdr::new();
        cdr.time(nanoseconds(seconds)).byte(level).text("modl").text(words).text("").text("").word(0);
        let bytes = cdr.into_bytes();
        all.push(Message { topic: "/events", kind: &LOG, nanoseconds: nanoseconds(seconds), bytes });
    };
    judged(plan, &mut log);
    docked(tracks, &mut log);
    match descriptions(plan, export.title, &mut Shapes::new(export.stem)) {
        Ok(described) => all.extend(described.into_iter().map(|one| {
            let mut cdr = Cdr::new();
            cdr.text(&one.text);
            message("/robot_description", &STRING, one.from, cdr)
        })),
        Err(refusal) => log(0.0, INFO, &format!("no robot description: {refusal}")),
    }
    all.extend(trajectories(plan)?.iter().map(planned));
    for piece in pieces(tracks) {
        let piece = Recorded::new(tracks, &names, &paths, piece);
        piece.add(&mut all);
    }
    all.sort_by_key(|message| message.nanoseconds);
    Ok(all)
}

/// Logs the verdict of a plan, if it has one.
fn judged(plan: &Plan, log: &mut dyn FnMut(f64, u8, &str)) {
    let Some(verdict) = &plan.verdict else {
        log(0.0, INFO, "not judged");
        return;
    };
    log(0.0, if verdict.ok() { INFO } else { ERROR }, &headline(plan, verdict));
    for note in &verdict.notes {
        log(0.0, INFO, note);
    }
    for (time, words) in &verdict.events {
        log(*time, INFO, words);
    }
    for failure in &verdict.failures {
        log(failure.time, ERROR, &failure.message);
    }
}

/// Logs what docks and undocks.
fn docked(tracks: &Tracks, log: &mut dyn FnMut(f64, u8, &str)) {
    for event in &tracks.events {
        let what = match event.kind {
            DockingKind::Dock => "docks",
            DockingKind::Undock => "undocks",
        };
        log(event.time, INFO, &format!("{} {what}", tracks.robot.bond_name(event.bond)));
    }
}

fn nanoseconds(seconds: f64) -> u64 {
    libm::round(seconds.max(0.0) * 1e9) as u64
}

fn message(topic: &'static str, kind: &'static MessageType, seconds: f64, cdr: Cdr) -> Message {
    Message { topic, kind, nanoseconds: nanoseconds(seconds), bytes: cdr.into_bytes() }
}

/// Returns a trajectory as a message.
fn planned(trajectory: &Trajectory) -> Message {
    let mut cdr = Cdr::new();
    cdr.header(nanoseconds(trajectory.from), "").texts(trajectory.joints.iter().map(String::as_str));
    cdr.word(trajectory.points.len() as u32);
    for point in &trajectory.points {
        cdr.reals(&point.positions).reals(&point.velocities).reals(&point.accelerations).reals(&[]);
        cdr.time(point.nanoseconds);
    }
    message("/planned_trajectory", &JOINT_TRAJECTORY, trajectory.from, cdr)
}

/// A piece of a robot that is recorded.
struct Recorded<'a> {
    tracks: &'a Tracks,
    names: &'a Names,
    paths: &'a LinkPaths<'a>,
    piece: Piece,
    joints: Vec<JointMotion>,
}

impl<'a> Recorded<'a> {
    fn new(tracks: &'a Tracks, names: &'a Names, paths: &'a LinkPaths<'a>, piece: Piece) -> Recorded<'a> {
        let joints = joints(tracks, &piece);
        Recorded { tracks, names, paths, piece, joints }
    }

    /// Adds the frames and joint states of the piece.
    fn add(&self, all: &mut Vec<Message>) {
        let (from, to) = (self.piece.from, self.piece.to);
        let kinematics = &self.piece.kinematics;
        let moved: Vec<usize> = self.joints.iter().map(|joint| joint.link).collect();
        let still = kinematics.steps.iter().map(|step| step.link).filter(|link| !moved.contains(link));
        let still: Vec<usize> = still.collect();
        let most = (TRANSFORMS_MAX / (moved.len() + 1)).max(2);
        let steps = (((to - from) * RATE).ceil() as usize).clamp(1, most);
        let times = (0..=steps).map(|k| from + (to - from) * k as f64 / steps as f64);
        for (index, time) in times.enumerate() {
            if index > 0 && to == from {
                break;
            }
            // At the end of the piece bonds have changed already; its links are where they were just before.
            let X_WR = self.paths.at(time)[self.piece.root()];
            let joints = self.tracks.state(time).joints;
            let mut poses = vec![Pose::identity(); kinematics.link_count()];
            kinematics.link_poses(&joints, &X_WR, &mut poses);
            if index == 0 && !still.is_empty() {
                all.push(self.transforms("/tf_static", time, &still, &poses));
            }
            let mut frames = vec![self.piece.root()];
            frames.extend(&moved);
            all.push(self.transforms("/tf", time, &frames, &poses));
            all.push(self.state(time, &joints));
        }
    }

    /// Returns the poses of the frames of links in those of their parents.
    fn transforms(&self, topic: &'static str, time: f64, links: &[usize], poses: &[Pose]) -> Message {
        let kinematics = &self.piece.kinematics;
        let X_WU = |link: usize| poses[link] * link_in_description(kinematics, link).inverse();
        let mut cdr = Cdr::new();
        cdr.word(links.len() as u32);
        for &link in links {
            let (parent, X) = match kinematics.step(link) {
                Some(step) => (&*self.names.links[step.parent], X_WU(step.parent).inverse() * X_WU(link)),
                None => (WORLD, X_WU(link)),
            };
            cdr.header(nanoseconds(time), parent).text(&self.names.links[link]);
            let (p, q) = (X.translation.vector, X.rotation);
            for x in [p.x, p.y, p.z, q.i, q.j, q.k, q.w] {
                cdr.real(x);
            }
        }
        message(topic, &TRANSFORMS, time, cdr)
    }

    /// Returns the positions of the joints.
    fn state(&self, time: f64, joints: &[f64]) -> Message {
        let positions: Vec<f64> = self.joints.iter().map(|joint| joint.position(joints)).collect();
        let mut cdr = Cdr::new();
        cdr.header(nanoseconds(time), "");
        cdr.texts(self.joints.iter().map(|joint| self.names.joints[joint.joint].as_str()));
        cdr.reals(&positions).reals(&[]).reals(&[]);
        message("/joint_states", &JOINT_STATE, time, cdr)
    }
}

/// Returns the bytes of a file with these messages.
///
/// # Errors
/// None: memory takes all bytes.
fn recorded(messages: Vec<Message>) -> McapResult<Vec<u8>> {
    let options = WriteOptions::new().compression(None).profile("ros2");
    let options = options.library(concat!("modl ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(Cursor::new(Vec::new()))?;
    let mut channels = BTreeMap::new();
    for Message { topic, kind, nanoseconds, bytes } in messages {
        let (channel, sequence) = match channels.get_mut(topic) {
            Some(known) => known,
            None => {
                let schema = writer.add_schema(kind.name, "ros2msg", kind.definition().as_bytes())?;
                let channel = writer.add_channel(schema, topic, "cdr", &BTreeMap::new())?;
                channels.entry(topic).or_insert((channel, 0_u32))
            }
        };
        let header = MessageHeader {
            channel_id: *channel,
            sequence: *sequence,
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        *sequence += 1;
        writer.write_to_known_channel(&header, &bytes)?;
    }
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}
