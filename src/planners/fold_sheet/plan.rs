//! From a folded form without cuts to the plan that folds a flat sheet into it.

use super::effort::{SheetEffort, effort};
use super::loops::{Loops, NoSheet};
use super::path::{self, Stuck};
use super::timing;
use crate::behavior;
use crate::geometry::{Pose, Vec3};
use crate::interrupt;
use crate::plan::{self, Command, Failure, Ground, Node, Verdict, World};
use crate::planners::fold::judgement::{self, Fault, Judged, Motion};
use crate::planners::fold::pattern::Pattern;
use crate::planners::fold::sheet::action;
use crate::planners::fold::{Layout, Panels, Target};
use crate::planners::{Progress, Solution};
use crate::robot::{Assembly, Bond, JointId, Kinematics, ModuleInstance, PortRef, State};
use std::fmt;
use std::sync::Arc;

/// The greatest number of creases of a sheet: the linear algebra of a step is cubic in them.
pub(super) const CREASES_MAX: usize = 300;

/// A sheet to be folded.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The folded form, whose hinges are the creases.
    pub target: Target,
    /// The panels of its faces.
    pub panels: Panels,
    /// The face that stays where it is, an index in [`Target::faces`].
    pub root: usize,
}

/// The settings of the planner.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The duration of the motion, s; `None`: as long as the fastest hinge needs.
    pub time: Option<f64>,
    /// The world in which the sheet folds.
    pub world: SheetWorld,
    /// The settings of the judge that the plan has to pass.
    pub judge: plan::Settings,
}

/// The world in which a sheet folds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SheetWorld {
    /// Nothing weighs.
    #[default]
    Free,
    /// Standard gravity; the sheet lies on the ground with its front up, and rests on whatever touches it as it folds.
    Settling,
    /// Standard gravity; the root is held fast with its front up, and carries all others.
    Held,
}

impl SheetWorld {
    /// Returns the world that a plan states.
    pub fn world(self) -> World {
        let gravity = World::default().gravity;
        match self {
            SheetWorld::Free => World::FREE,
            SheetWorld::Settling => World { gravity, ground: Ground::Settle, ..World::FREE },
            SheetWorld::Held => World { gravity, ground: Ground::Held, ..World::FREE },
        }
    }
}

/// A folding of a sheet that the judge lets through, beside its motion.
#[derive(Clone, Debug)]
pub struct Report {
    /// The number of creases, which all are hinges.
    pub creases: usize,
    /// The number of vertices inside, each with a loop of creases.
    pub loops: usize,
    /// The number of angles that can be chosen freely at the folded form.
    pub freedom: usize,
    /// The greatest rotation that is left over round a vertex on the way, rad.
    pub gap: f64,
    /// The angles of the creases at the end, in the order of [`Target::hinges`], rad.
    pub angles: Vec<f64>,
    /// The effort of the hinges, with the least squares of torques that cause the motion; `None` where the ground carries the
    /// sheet, since its forces are not planned.
    pub effort: Option<SheetEffort>,
    /// The surface that the sheet becomes.
    pub target: Target,
    /// The number of actions of the program.
    pub actions: u64,
    /// The verdict of the judge on the plan.
    pub verdict: Verdict,
}

/// The reason why a sheet was not folded.
#[derive(Debug)]
pub enum Refusal {
    /// The surface is no sheet.
    NoSheet(NoSheet),
    /// The sheet has more creases than can be planned for.
    TooManyCreases {
        /// The number of creases.
        creases: usize,
    },
    /// The root is not a face.
    NoSuchRoot {
        /// The number of faces.
        faces: usize,
    },
    /// Two faces lie on each other in the flat sheet.
    Overlap {
        /// The faces, as indices in [`Target::faces`].
        faces: [usize; 2],
    },
    /// No way that keeps the loops closed leads from flat to the folded form.
    Stuck(Stuck),
    /// The connector of a panel has no hinge.
    NoHinge,
    /// The hinges can't go the way in the time asked for.
    TooShort {
        /// The least time in which they can, s.
        least: f64,
    },
    /// The program can't be scheduled.
    Schedule(behavior::Refusal),
    /// The judge refuses the motion.
    Refused(Box<Failure>),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::NoSheet(why) => why.fmt(f),
            Refusal::TooManyCreases { creases } => {
                write!(f, "the sheet has {creases} creases; at most {CREASES_MAX} can be planned")
            }
            Refusal::NoSuchRoot { faces } => write!(f, "the root is not a face: there are {faces}"),
            Refusal::Overlap { faces: [a, b] } => {
                write!(f, "laid flat, faces {a} and {b} lie on each other")
            }
            Refusal::Stuck(Stuck { part }) => write!(
                f,
                "no way was found from flat on which all loops stay closed: from the folded form it ends where {:.1}% of \
                 the angles are left",
                part * 100.0
            ),
            Refusal::NoHinge => f.write_str("no panel: its edges have no hinge"),
            Refusal::TooShort { .. } => f.write_str("the hinges can't fold as fast as that"),
            Refusal::Schedule(refusal) => refusal.reason.fmt(f),
            Refusal::Refused(failure) => write!(f, "the judge refuses the motion: {}", failure.message),
        }
    }
}

impl std::error::Error for Refusal {}

/// Plans the motion of a flat sheet of panels into a folded form without cutting it: all creases fold together, from rest
/// to rest, on a way on which the loops round all vertices stay closed. All actions of the program have cause 0.
///
/// # Errors
/// A [`Refusal`]: a surface that is no sheet, a form to which no way leads, a motion that the judge refuses.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    _: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let Problem { target, panels, root } = problem;
    interrupt::start_task(format!("folding {} creases together", target.hinges.len()));
    if *root >= target.faces.len() {
        return Err(Refusal::NoSuchRoot { faces: target.faces.len() });
    }
    if target.hinges.len() > CREASES_MAX {
        return Err(Refusal::TooManyCreases { creases: target.hinges.len() });
    }
    let loops = Loops::of(target).map_err(Refusal::NoSheet)?;
    let tree = spanning_tree(target, *root);
    if let Some(&faces) = Pattern::of(target, &tree).overlaps().first() {
        return Err(Refusal::Overlap { faces });
    }
    let folded: Vec<f64> = target.hinges.iter().map(|hinge| hinge.angle).collect();
    let way = path::from_flat(&loops, &folded).map_err(Refusal::Stuck)?;
    // The motion of all creases at once.
    let least = timing::least_duration(&way, panels.weakest.able);
    let duration = settings.time.unwrap_or(least);
    if duration < least {
        return Err(Refusal::TooShort { least });
    }
    let (robot, joints) = assembly(target, panels, *root)?;
    let follow = |(joint, keyframes): (&JointId, Vec<[f64; 3]>)| {
        Arc::new(action(Command::Follow { joint: *joint, keyframes }))
    };
    let keyframes = timing::keyframes(&way, duration);
    let gravity = match settings.world {
        SheetWorld::Free | SheetWorld::Settling => Vec3::zeros(),
        SheetWorld::Held => target.normal(*root) * -settings.world.world().gravity,
    };
    let known = settings.world != SheetWorld::Settling;
    let effort = known.then(|| effort(target, (&loops, &tree), (&panels.masses, gravity), &keyframes));
    let moves = joints.iter().zip(keyframes).map(follow).collect();
    let start = State {
        joints: vec![0.0; robot.joints().count()],
        bonds: vec![true; robot.bonds.len()],
        base: Pose::identity(),
        clusters: vec![],
        misalignments: vec![],
    };
    let motion = Motion {
        robot,
        start,
        program: Arc::new(Node::Parallel(moves)),
        world: settings.world.world(),
        judge: settings.judge,
    };
    let solution = judgement::judged(motion).map_err(|fault| match fault {
        Fault::Refused(failure) => Refusal::Refused(failure),
        Fault::Schedule(refusal) => Refusal::Schedule(refusal),
        Fault::TooFast => Refusal::TooShort { least },
    })?;
    let Judged { actions, verdict } = solution.report;
    let angles = way.places.last().expect("a way has places").angles.iter().copied().collect();
    let report = Report {
        creases: target.hinges.len(),
        loops: loops.loops.len(),
        freedom: way.freedom,
        gap: way.gap,
        angles,
        effort,
        target: target.clone(),
        actions,
        verdict,
    };
    Ok(Solution { body: solution.body, program: solution.program, report })
}

/// Returns the panels of a target joined at all its hinges, in the order of these, and the joint of each hinge.
///
/// # Errors
/// [`Refusal::NoHinge`] if the connector of a bond has no hinge.
pub(crate) fn assembly(
    target: &Target,
    panels: &Panels,
    root: usize,
) -> Result<(Assembly, Vec<JointId>), Refusal> {
    let name = &panels.library.modules[panels.kinds[root]].name;
    let module =
        |(face, kind): (usize, &usize)| ModuleInstance { name: format!("panel[{face}]"), kind: *kind };
    let bonds = target.hinges.iter().map(|hinge| {
        let port = |end: usize| PortRef { module: hinge.faces[end], port: hinge.sides[end] };
        Bond { a: port(0), b: port(1), turn: 0 }
    });
    let robot = Assembly {
        name: format!("{name}[{}]", panels.kinds.len()),
        library: panels.library.clone(),
        modules: panels.kinds.iter().enumerate().map(module).collect(),
        bonds: bonds.collect(),
        base: root,
        closed: true,
        misalignments: vec![],
    };
    let kinematics = Kinematics::new(&robot, &vec![true; robot.bonds.len()], root);
    let joint = |bond: usize| kinematics.hinge(bond).map(|joint| JointId(joint as u32));
    let joints = (0..robot.bonds.len()).map(joint).collect::<Option<Vec<_>>>().ok_or(Refusal::NoHinge)?;
    Ok((robot, joints))
}

/// Returns a layout by which the sheet lies flat: any, since it is one in all of them.
pub(super) fn spanning_tree(target: &Target, root: usize) -> Layout {
    let mut seen = vec![false; target.faces.len()];
    seen[root] = true;
    let (mut waiting, mut hinges) = (vec![root], Vec::new());
    while let Some(face) = waiting.pop() {
        for (hinge, other) in target.around(face) {
            if !std::mem::replace(&mut seen[other], true) {
                hinges.push(hinge);
                waiting.push(other);
            }
        }
    }
    Layout::of_hinges(target, &hinges, root).expect("a target is connected")
}
