//! Records: values with fields, of a program's own declarations or given back by built-ins, and how each field
//! is read.

use super::design::{Design, Instance};
use super::plan_value::PlanValue;
use super::robot::Robot;
use super::value::Value;
use crate::check::typed::DefId;
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::articulated::{Detail, Instant, base_at};
use crate::plan::{Ground, Plan, Verdict, World};
use crate::robot::{Kinematics, State};
use std::any::Any;
use std::cell::OnceCell;
use std::rc::Rc;

/// A value with fields, `record.name`: of a declaration of the program, or of a type of the standard library.
#[derive(Debug)]
pub enum Record {
    /// A record that a `record` declares.
    Declared(DeclaredRecord),
    /// A `Plan`, or a record that a planner makes and that is a plan.
    Plan(Rc<PlanValue>),
    /// A `Report`: the verdict of the judge, and the headline under which it is shown.
    Report(Rc<Verdict>, String),
    /// A state of a robot, `State`.
    State(Box<StateValue>),
    /// The assumptions about a robot's surroundings, `World`.
    World(World),
    /// A `Frame`: the positions of nodes, m, and struts as pairs of indices of these.
    Frame(Vec<Vec3>, Vec<(usize, usize)>),
    /// The `Rigidity` of a truss, given by its design.
    Rigidity(Rc<Design>),
    /// A record that the file of a native defines.
    Native(Rc<dyn NativeRecord>),
}

/// A record that a `record` declares, with the values of its fields in the order of the declaration.
#[derive(Debug)]
pub struct DeclaredRecord {
    /// The declaration of the record, by identity.
    pub def: DefId,
    /// The values of the record's fields, in the order of the declaration; none is unknown.
    pub fields: Vec<Value>,
}

/// A record that the file of a native defines, with its fields and how it is shown.
pub trait NativeRecord: Any + std::fmt::Debug {
    /// Returns a field by its name. Panics for a name that the declaration does not have.
    fn read(&self, field: &str) -> Value;

    /// Returns the record on one line, as `print` shows it.
    fn show(&self) -> String;

    /// Returns the plan that the record is about and stands for; `None` if there is none.
    fn plan(&self) -> Option<&Rc<PlanValue>> {
        None
    }
}

/// A state of a robot, with its time and the plan that it was taken from.
pub struct StateValue {
    /// The design of the robot that is in the state.
    pub robot: Rc<Design>,
    /// The robot as an assembly with its kinematics.
    pub body: Rc<Robot>,
    /// The positions of the joints (rad or m), the bonds that hold, and the base.
    pub state: State,
    /// The time in the plan, s, from 0 to its duration.
    pub time: f64,
    /// The plan that the state was taken from.
    pub planned: Rc<PlanValue>,
    /// The pose `X_WB` of the plan's base in the world; empty until it is asked for.
    pub base: OnceCell<Pose>,
    /// The times (s) of the states that were made together with this one, and the index of its own time among them,
    /// from 0.
    pub among: (Rc<Vec<f64>>, usize),
    /// The robot that the state is of; `None` for all robots of the plan.
    pub only: Option<Rc<OneRobot>>,
}

/// One of the robots with which a plan begins.
#[derive(Debug)]
pub struct OneRobot {
    /// The robot as the program names it: an instance with its base.
    pub instance: Rc<Instance>,
    /// The module that is its base, by its index in the plan's robot.
    pub reference: usize,
    /// Its modules, by their indices in the plan's robot, ascending.
    pub modules: Vec<usize>,
}

/// The name of a field of a record, with the function that reads its value.
pub type Field<T> = (&'static str, fn(&T) -> Value);

/// Returns the value of a field by its table. `fields`: the table; `record`: the value with the fields. Panics if the
/// table has no such field, which `check` excludes.
pub fn read_field<T>(fields: &[Field<T>], record: &T, field: &str) -> Value {
    let found = fields.iter().find(|(name, _)| *name == field);
    found.map_or_else(|| unreachable!("`check` knows no field `{field}` here"), |(_, read)| read(record))
}

/// Returns the names of a table's fields, in its order.
pub fn field_names<T>(fields: &[Field<T>]) -> Vec<&'static str> {
    fields.iter().map(|(name, _)| *name).collect()
}

/// Returns the world that a plan assumes from its beginning; the default if it states none.
pub fn first_world(plan: &Plan) -> World {
    plan.worlds.first().map_or_else(World::default, |from| from.world)
}

impl std::fmt::Debug for StateValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.in_words())
    }
}

impl StateValue {
    /// Returns the state in words, as `print` shows it.
    pub fn in_words(&self) -> String {
        match &self.only {
            Some(one) => format!("a state of {} in {}", one.instance.path, self.robot.name),
            None => format!("a state of {}", self.robot.name),
        }
    }

    /// Returns the state of one of its robots at the same time.
    pub fn of(&self, robot: OneRobot) -> StateValue {
        StateValue {
            robot: self.robot.clone(),
            body: self.body.clone(),
            state: self.state.clone(),
            time: self.time,
            planned: self.planned.clone(),
            base: OnceCell::new(),
            among: self.among.clone(),
            only: Some(Rc::new(robot)),
        }
    }

    /// Returns true if the state is one of this module, too, by its index in the plan's robot.
    pub fn has(&self, module: usize) -> bool {
        self.only.as_ref().is_none_or(|one| one.modules.binary_search(&module).is_ok())
    }

    /// Returns the centre of mass in the world, m, of the robot or the robots that the state is of.
    pub fn centre_of_mass(&self) -> Vec3 {
        let poses = self.poses();
        match &self.only {
            Some(one) => self.body.centre_of_modules(one.modules.iter().copied(), &poses).0,
            None => self.body.centre_of(&poses).0,
        }
    }

    /// Returns the poses `X_WL` of all links in the world (metres), by their numbers in the kinematics.
    pub fn poses(&self) -> Vec<Pose> {
        if self.planned.comes_apart()
            && let Some(poses) = self.planned.placed(self.time)
        {
            return poses.to_vec();
        }
        let stood = self.base_of_plan();
        let mut poses = vec![stood; self.body.kinematics.link_count()];
        let base = self.body.assembly.base;
        self.body.kinematics.link_poses_from(base, &self.state.joints, &stood, &mut poses);
        for cluster in &self.state.clusters {
            let robot = &self.body.assembly;
            let kinematics = Kinematics::new(robot, &self.body.start.bonds, cluster.reference);
            kinematics.link_poses(&self.state.joints, &cluster.pose, &mut poses);
        }
        poses
    }

    /// Returns what `read` makes of the judge's quantities at the time of the state; `None` where the judge did not
    /// get there. States that were made together are computed together. `detail`: the quantities that are computed.
    pub fn judged<T>(&self, detail: Detail, read: impl FnOnce(&Instant) -> T) -> Option<T> {
        let (times, own) = &self.among;
        self.planned.instants(times, detail, self.reference()).get(*own).map(read)
    }

    /// Returns the least signed distance, at the time of the state, of links that may not touch, m; `None` where
    /// there are no two such links, or the plan is not valid.
    pub fn clearance(&self) -> Option<f64> {
        let (times, own) = &self.among;
        self.planned.clearances(times, self.reference()).get(*own).copied().flatten()
    }

    /// Returns the base of the robot that the state is of; `None` for all robots.
    fn reference(&self) -> Option<usize> {
        self.only.as_ref().map(|one| one.reference)
    }

    /// Returns the world pose `X_WB` of the base module's body, m: of the robot that the state is of, or of the plan.
    pub fn base(&self) -> Pose {
        match self.reference() {
            Some(reference) => self.body.kinematics.module_pose(reference, &self.poses()),
            None => self.base_of_plan(),
        }
    }

    /// Returns the world pose `X_WB` of the body of the plan's base, m. If any world of the plan has ground, it is the
    /// judge's: that of its last sample up to the time of this state, with the standing, rolling and tipping until
    /// then. Otherwise, or if the plan is not valid, it is the pose in the state.
    fn base_of_plan(&self) -> Pose {
        let grounded = self.planned.plan.worlds.iter().any(|w| w.world.ground != Ground::Off);
        let stand = || {
            if !grounded && !self.planned.comes_apart() {
                return self.state.base;
            }
            base_at(&self.planned.plan, self.time).unwrap_or(self.state.base)
        };
        *self.base.get_or_init(stand)
    }
}

/// Nodes, and struts by pairs of nodes.
type NodesAndStruts = (Vec<Vec3>, Vec<(usize, usize)>);

/// Returns the parts of a `Frame`, which is the nodes and struts of a truss: the positions of the nodes, m, in the
/// coordinate frame of the truss, and the struts as pairs of indices of nodes, from 0. `None` for other values.
pub fn frame_parts(value: &Value) -> Option<NodesAndStruts> {
    match value {
        Value::Record(record) => match &**record {
            Record::Frame(nodes, struts) => Some((nodes.clone(), struts.clone())),
            _ => None,
        },
        _ => None,
    }
}
