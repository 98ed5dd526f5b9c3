//! Programs with goals: each goal becomes actions, one after the other, from the state in which it begins.

use super::free_space::{FreeSpace, Surroundings};
use super::front::{Misplaced, cut, mark, misplaced, replaced, written_out};
use super::timing;
use super::{avoid, line, reach};
use crate::behavior::{self, Scheduled, schedule};
use crate::geometry::{Pose, Unsound};
use crate::plan::{
    Action, CauseId, Command, Goal, GoalFrame, GoalKind, LineEnd, Node, Obstacle, Otherwise, Profile,
    StatedPath, Target,
};
use crate::planners::Progress;
use crate::robot::chain::{Chain, Orientation, Target as Place};
use crate::robot::jacobian::LinkFrame;
use crate::robot::{Assembly, JointId, JointOwner, Kinematics, State};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The greatest number of goals in a program, repetitions written out.
pub const GOALS_MAX: usize = 10_000;

/// A program with goals.
#[derive(Clone)]
pub struct Problem<'a> {
    /// The robots.
    pub robot: &'a Assembly,
    /// The state in which the program begins.
    pub start: &'a State,
    /// The program.
    pub program: &'a Arc<Node>,
    /// The obstacles, in the world's frame.
    pub obstacles: &'a [Obstacle],
    /// True if there is ground at height 0 that robots stand on.
    pub floor: bool,
    /// The limits of scheduling.
    pub settings: behavior::Settings,
}

/// The reason why a goal did not become actions.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// No posture reaches the place.
    Reach(reach::Refusal),
    /// There is no motion along the line.
    Line(line::Refusal),
    /// There is no free way.
    Avoid(avoid::Refusal),
    /// The actions before the goal, or the behaviour at whose end it is, have no motion.
    Schedule(behavior::Refusal),
    /// The goal stands where its beginning is not known.
    Misplaced(Misplaced),
    /// Nothing connects the port with the module that stays where it is.
    NotConnected,
    /// No joint that has to move states a greatest speed, and no duration is stated.
    NoSpeed,
    /// The behaviour at whose end the goal is docks or undocks.
    Docks,
    /// There are more goals than [`GOALS_MAX`].
    TooMany,
    /// A shape that is not sound.
    Unsound(Unsound),
}

/// A refusal of a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The cause of the goal to blame; `None` if the program as a whole is.
    pub cause: Option<CauseId>,
    /// The name of the built-in that makes the goal.
    pub name: &'static str,
    /// The reason.
    pub reason: Box<Reason>,
}

/// Returns the world poses of all links at a time of a motion, by their numbers in the kinematics, and gives bonds by which
/// robots have docked on the way the turns in which they have.
pub type Placing<'p> = dyn FnMut(&mut Scheduled, f64) -> Vec<Pose> + 'p;

/// A program without goals, and what their motions keep to.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// The program.
    pub program: Arc<Node>,
    /// The lines and arcs in space that ports keep to, at the times at which the program moves them.
    pub paths: Vec<StatedPath>,
}

/// Returns a program in which actions stand in the place of all goals. `placing`: where the robots are as the judge has
/// it; it is asked only where that makes a difference.
///
/// # Errors
/// A [`Refusal`] for the first goal that does not become actions.
pub fn resolve(
    problem: &Problem,
    placing: &mut Placing,
    progress: &mut dyn Progress,
) -> Result<Resolved, Refusal> {
    let mut paths = Vec::new();
    if let Some((goal, why)) = misplaced(problem.program) {
        return Err(refusal(goal, Reason::Misplaced(why)));
    }
    let mut most = GOALS_MAX;
    let whole = |reason| Refusal { cause: None, name: "", reason: Box::new(reason) };
    let written = written_out(problem.program, &mut most);
    let mut program = written.ok_or_else(|| whole(Reason::TooMany))?;
    loop {
        let mut goals = Vec::new();
        let before = cut(&program, &mut goals);
        if goals.is_empty() {
            return Ok(Resolved { program, paths });
        }
        let mut scheduled = scheduled(problem, problem.start.clone(), before)
            .map_err(|refusal| whole(Reason::Schedule(refusal)))?;
        // Of those that are next the one that begins first.
        let begin = |index: usize| {
            let marked = scheduled.exemptions.iter().find(|exemption| exemption.cause == mark(index));
            marked.map_or(f64::INFINITY, |exemption| exemption.from)
        };
        let first = (0..goals.len()).min_by(|a, b| begin(*a).total_cmp(&begin(*b))).unwrap_or(0);
        let Node::Goal(goal) = &**goals[first] else { unreachable!("goals are cut off") };
        let time = begin(first);
        let state = scheduled.tracks.state(time);
        let poses = match goal.is_placed() {
            true => placing(&mut scheduled, time),
            false => standing_poses(&scheduled.tracks.robot, &state),
        };
        let beginning = Beginning { problem, robot: &scheduled.tracks.robot, state, poses };
        let (actions, path) = beginning.actions(goal, progress).map_err(|reason| refusal(goal, reason))?;
        paths.extend(path.map(|path| StatedPath { from: time, to: time + path.to, ..path }));
        let old = goals[first].clone();
        program = replaced(&program, &old, &actions);
    }
}

fn refusal(goal: &Goal, reason: Reason) -> Refusal {
    Refusal { cause: Some(goal.cause), name: goal.name(), reason: Box::new(reason) }
}

fn scheduled(problem: &Problem, start: State, program: Arc<Node>) -> Result<Scheduled, behavior::Refusal> {
    schedule(behavior::Problem {
        robot: problem.robot.clone(),
        start,
        program,
        start_causes: vec![],
        bond_causes: vec![],
        settings: problem.settings,
    })
}

/// The instant at which a goal begins.
struct Beginning<'a> {
    problem: &'a Problem<'a>,
    robot: &'a Assembly,
    state: State,
    /// The world poses of all links.
    poses: Vec<Pose>,
}

impl Beginning<'_> {
    /// Returns the actions that a goal becomes, and the path that it states, which begins at 0 s.
    fn actions(
        &self,
        goal: &Goal,
        progress: &mut dyn Progress,
    ) -> Result<(Arc<Node>, Option<StatedPath>), Reason> {
        let (robot, state, poses) = (self.robot, &self.state, self.poses.as_slice());
        match &goal.kind {
            GoalKind::Reach { frame, position, orientation, duration, profile, starts, seed } => {
                let held = Held::new(robot, state, poses, frame)?;
                let names = names(robot);
                let problem = reach::Problem {
                    chain: &held.chain,
                    target: held.place(*position, *orientation),
                    joints: &state.joints,
                    names: &names,
                };
                let around = self.around(goal.is_placed());
                let settings = reach::Settings {
                    starts: *starts,
                    seed: *seed,
                    balance: around.floor,
                    ..reach::Settings::default()
                };
                let mut space = held.space(around, settings.clearance)?;
                let found = reach::plan(&problem, &mut space, &settings, progress)
                    .map_err(|refusal| Reason::Reach(held.seen(refusal)))?;
                let moved: Vec<usize> = held.chain.joints().iter().map(|joint| joint.joint).collect();
                let times = (*duration, *profile);
                let moves = move_together(robot, (&state.joints, &found.joints), &moved, times, goal.cause)?;
                Ok((moves, None))
            }
            GoalKind::Line { frame, end, via, duration, free, within } => {
                let held = Held::new(robot, state, poses, frame)?;
                let names = names(robot);
                let begins = held.chain.pose(&state.joints);
                let into = held.X_HP;
                let problem = line::Problem {
                    chain: &held.chain,
                    goal: match end {
                        LineEnd::To(pose) => into * pose,
                        LineEnd::By(shift) => Pose::from_parts(
                            (begins.translation.vector + into.rotation * shift).into(),
                            begins.rotation,
                        ),
                    },
                    form: via.map_or(line::Form::Line, |via| {
                        line::Form::Arc(into.transform_point(&via.into()).coords)
                    }),
                    joints: &state.joints,
                    names: &names,
                    free: *free,
                    within: *within,
                };
                let path =
                    line::plan(&problem, &line::Settings::default(), progress).map_err(Reason::Line)?;
                let (follows, lasting) = follow(robot, &held.chain, &path, *duration, goal.cause)?;
                let via = via.map(|via| into.transform_point(&via.into()).coords.into());
                let stated = StatedPath {
                    port: frame.port,
                    module: held.module,
                    from: 0.0,
                    to: lasting,
                    start: begins,
                    end: problem.goal,
                    via,
                    within: within.distance,
                    turned_within: (!free).then_some(within.angle),
                    cause: goal.cause,
                };
                Ok((follows, Some(stated)))
            }
            GoalKind::Avoid { body, clearance, budget, seed } => {
                let settings = avoid::Settings { budget: *budget, seed: *seed, ..avoid::Settings::default() };
                let joints = commanded(goal);
                let around = AvoidGoal { joints, body, clearance: *clearance, settings, cause: goal.cause };
                Ok((self.free_way(&around, progress)?, None))
            }
        }
    }

    /// Returns the moves along a free way to where a behaviour would bring the joints.
    fn free_way(&self, goal: &AvoidGoal, progress: &mut dyn Progress) -> Result<Arc<Node>, Reason> {
        let (robot, state) = (self.robot, &self.state);
        let end = {
            let start = state.clone();
            let problem = Problem { robot, start: &start, program: goal.body, ..self.problem.clone() };
            // Goals in the behaviour begin where the robot stands here.
            let mut placing = |_: &mut Scheduled, _: f64| self.poses.clone();
            let program = resolve(&problem, &mut placing, progress).map_err(|refusal| *refusal.reason)?;
            scheduled(&problem, start.clone(), program.program).map_err(Reason::Schedule)?
        };
        if !end.tracks.events.is_empty() {
            return Err(Reason::Docks);
        }
        let to = end.tracks.end().joints;
        let mut moved = goal.joints.clone();
        moved.extend(end.tracks.tracks.iter().map(|track| track.joint.0 as usize));
        let moved: Vec<usize> = moved.into_iter().collect();
        let around = self.around(true);
        let mut space = FreeSpace::new(around, standing(robot, state, &moved), &moved, goal.clearance)
            .map_err(Reason::Unsound)?;
        let limits = ranges(robot);
        let problem = avoid::Problem { from: &state.joints, to: &to, limits: &limits };
        let path = avoid::plan(&problem, &mut space, &goal.settings, progress).map_err(Reason::Avoid)?;
        let moves = path.postures.windows(2).map(|pair| {
            move_together(robot, (&pair[0], &pair[1]), &moved, (None, Profile::Smooth), goal.cause)
        });
        Ok(Arc::new(Node::Series(moves.collect::<Result<_, _>>()?)))
    }

    /// Returns what is around the robot; obstacles and the ground only where it is known where it stands.
    fn around(&self, placed: bool) -> Surroundings<'_> {
        Surroundings {
            robot: self.robot,
            state: &self.state,
            poses: &self.poses,
            obstacles: if placed { self.problem.obstacles } else { &[] },
            floor: self.problem.floor && placed,
        }
    }
}

/// Returns the world poses of all links with the bases where a state has them.
fn standing_poses(robot: &Assembly, state: &State) -> Vec<Pose> {
    let kinematics = Kinematics::new(robot, &state.bonds, robot.base);
    let mut poses = vec![state.base; kinematics.link_count()];
    kinematics.link_poses(&state.joints, &state.base, &mut poses);
    for cluster in &state.clusters {
        let kinematics = Kinematics::new(robot, &state.bonds, cluster.reference);
        kinematics.link_poses(&state.joints, &cluster.pose, &mut poses);
    }
    poses
}

/// A goal of kind `avoid`.
struct AvoidGoal<'a> {
    /// The joints that the behaviour commands, whether or not they move in it.
    joints: BTreeSet<usize>,
    body: &'a Arc<Node>,
    clearance: f64,
    settings: avoid::Settings,
    cause: CauseId,
}

/// The chain of a goal, and the frame in which its places are given.
struct Held {
    /// The module whose body stays where it is, by its index.
    module: usize,
    chain: Chain,
    /// The pose of the frame in which places are given (the module's own, or the world) in that of the body that stays.
    X_HP: Pose,
}

impl Held {
    fn new(robot: &Assembly, state: &State, poses: &[Pose], frame: &GoalFrame) -> Result<Held, Reason> {
        let module = frame.module.unwrap_or_else(|| base_of(robot, state, frame.port.module));
        let kinematics = Kinematics::new(robot, &state.bonds, module);
        let port = LinkFrame::of_port(robot, &kinematics, frame.port);
        let body = kinematics.link(module, 0);
        let chain = Chain::new(robot, &kinematics, body, &port).ok_or(Reason::NotConnected)?;
        let X_HP = if frame.module.is_some() { Pose::identity() } else { poses[body].inverse() };
        Ok(Held { module, chain, X_HP })
    }

    fn place(&self, position: crate::geometry::Vec3, orientation: Orientation) -> Place {
        let orientation = match orientation {
            Orientation::Free => Orientation::Free,
            Orientation::Along(axis) => Orientation::Along(self.X_HP.rotation * axis),
            Orientation::Full(rotation) => Orientation::Full(self.X_HP.rotation * rotation),
        };
        Place { position: self.X_HP.transform_point(&position.into()).coords, orientation }
    }

    /// Returns a refusal with its places in the frame in which those of the goal are given.
    fn seen(&self, refusal: reach::Refusal) -> reach::Refusal {
        match refusal {
            reach::Refusal::Unreachable { error, nearest, starts, at_limit } => {
                let nearest = self.X_HP.inverse() * nearest;
                reach::Refusal::Unreachable { error, nearest, starts, at_limit }
            }
            other => other,
        }
    }

    fn space<'s>(&self, around: Surroundings<'s>, clearance: f64) -> Result<FreeSpace<'s>, Reason> {
        let joints: Vec<usize> = self.chain.joints().iter().map(|joint| joint.joint).collect();
        FreeSpace::new(around, self.module, &joints, clearance).map_err(Reason::Unsound)
    }
}

/// Returns the base module of the robot that a module belongs to: of the assembly, or of a cluster.
fn base_of(robot: &Assembly, state: &State, module: usize) -> usize {
    let reached = |base: usize| {
        let kinematics = Kinematics::new(robot, &state.bonds, base);
        kinematics.tree.order.iter().any(|(known, _)| *known == module)
    };
    let clusters = state.clusters.iter().map(|cluster| cluster.reference);
    std::iter::once(robot.base).chain(clusters).find(|base| reached(*base)).unwrap_or(robot.base)
}

/// Returns the base of the robot whose joints move.
fn standing(robot: &Assembly, state: &State, joints: &[usize]) -> usize {
    let module =
        joints.first().and_then(|joint| robot.joints().nth(*joint)).map(|owner| robot.module_of(owner));
    module.map_or(robot.base, |module| base_of(robot, state, module))
}

/// Returns the joints that a goal may command, by the number in their `JointId`.
fn commanded(goal: &Goal) -> BTreeSet<usize> {
    let of = |action: &Action| match &action.command {
        Command::Move { joint, .. } | Command::Spin { joint, .. } | Command::Follow { joint, .. } => {
            Some(joint.0 as usize)
        }
        Command::Wait { .. } | Command::Dock { .. } | Command::Undock { .. } => None,
    };
    goal.stand_ins.iter().filter_map(of).collect()
}

/// Returns the name of every joint.
pub(in crate::planners) fn names(robot: &Assembly) -> Vec<String> {
    robot.joints().map(|owner| robot.joint_name(owner)).collect()
}

/// Returns the range of every joint, infinite for those that have none.
pub(in crate::planners) fn ranges(robot: &Assembly) -> Vec<(f64, f64)> {
    let of = |owner| match owner {
        JointOwner::Module { module, joint } => robot.module_type(module).joints[joint].limits.range,
        JointOwner::Bond(bond) => robot.hinge(bond).and_then(|hinge| hinge.limits.range),
    };
    robot.joints().map(|owner| of(owner).unwrap_or((f64::NEG_INFINITY, f64::INFINITY))).collect()
}

/// Returns the node of a command without conditions.
pub(in crate::planners) fn action(command: Command, cause: CauseId) -> Arc<Node> {
    let otherwise = Otherwise::Proceed;
    Arc::new(Node::Action(Action { command, until: None, timeout: None, otherwise, cause }))
}

/// Returns moves of joints that begin and end together.
fn move_together(
    robot: &Assembly,
    (from, to): (&[f64], &[f64]),
    joints: &[usize],
    (duration, profile): (Option<f64>, Profile),
    cause: CauseId,
) -> Result<Arc<Node>, Reason> {
    let least = || timing::together(robot, from, to, profile);
    let duration = duration.or_else(least).ok_or(Reason::NoSpeed)?;
    Ok(moves_within(to, joints, (duration, profile), cause))
}

/// Returns moves of joints (by the number in their `JointId`) to some positions of all joints, rad or m, which take the same
/// time, s.
pub(in crate::planners) fn moves_within(
    to: &[f64],
    joints: &[usize],
    (duration, profile): (f64, Profile),
    cause: CauseId,
) -> Arc<Node> {
    let moves = joints.iter().map(|&joint| {
        let target = Target::To(to[joint]);
        let command = Command::Move { joint: joint_id(joint), target, duration: Some(duration), profile };
        action(command, cause)
    });
    Arc::new(Node::Parallel(moves.collect()))
}

/// Returns the actions by which the joints of a chain follow a path, and the time that they take, s.
fn follow(
    robot: &Assembly,
    chain: &Chain,
    path: &line::Path,
    duration: Option<f64>,
    cause: CauseId,
) -> Result<(Arc<Node>, f64), Reason> {
    let joints: Vec<(usize, &[[f64; 2]])> =
        chain.joints().iter().zip(&path.joints).map(|(joint, keys)| (joint.joint, keys.as_slice())).collect();
    let duration = duration.or_else(|| timing::along(robot, &joints)).ok_or(Reason::NoSpeed)?;
    let follows = joints.iter().map(|(joint, keys)| {
        let last = (keys.len() - 1) as f64;
        let keyframes = keys
            .iter()
            .enumerate()
            .map(|(key, [position, slope])| [duration * key as f64 / last, *position, slope / duration])
            .collect();
        action(Command::Follow { joint: joint_id(*joint), keyframes }, cause)
    });
    Ok((Arc::new(Node::Parallel(follows.collect())), duration))
}

fn joint_id(joint: usize) -> JointId {
    JointId(u32::try_from(joint).expect("joints are counted in 32 bits"))
}
