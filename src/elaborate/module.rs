//! Modules: Definition IV.1, (D, X, A, K), from a declaration to a module type.

use super::tolerances::TOLERANCES;
use crate::check::typed::{
    DefId, JointDef, JointDefKind, Linear, LinkDef, ModuleClause, ModuleDef, MotorDef, Placement, PortClause,
};
use crate::geometry::pose::{shifted, turned};
use crate::geometry::soundness::{self, EXTENT_MAX};
use crate::geometry::{Placed, Pose, Unsound, Vec3};
use crate::interpret::design::ConnectorDesign;
use crate::interpret::design::{DesignKind, Instance, ModuleDesign};
use crate::interpret::frame::Frame;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::{JointSpec, Solid, Value};
use crate::robot::{Joint, Limits, Link, ModulePart, ModuleType, Motor, Port, mass, validation};
use crate::source::{Diagnostic, Span, code};
use std::cell::OnceCell;
use std::rc::Rc;

/// A module while its body is read.
struct Draft<'d> {
    def: &'d ModuleDef,
    module: ModuleType,
    solids: Vec<Solid>,
    connectors: Vec<Rc<ConnectorDesign>>,
    /// The ports so far as (index of the group, index in the group, span of the clause, port).
    ports: Vec<(usize, i64, Span, Port)>,
}

impl Interpreter<'_> {
    /// Returns the design of a module; `None` where it is broken, which has been reported. `title`: the name with its
    /// arguments, for messages.
    ///
    /// # Errors
    /// `Stop::Halt` if a limit is reached or the user cancels; faults are reported.
    pub(super) fn elaborate_module(
        &mut self,
        def: &ModuleDef,
        id: DefId,
        this: &Rc<Instance>,
        title: &str,
    ) -> Eval<Option<DesignKind>> {
        let mark = self.reported.errors;
        let mut frame = Frame::new(def.frame, Some(this.clone()));
        let mut draft = self.draft(def, title, &mut frame)?;
        let name = self.shared.program.def(id).span;
        for step in [Self::read_links, Self::read_joints, Self::read_ports, Self::read_motors] {
            self.attempt(|this| step(this, &mut draft, &mut frame))?;
        }
        self.attempt(|this| this.check_module(&draft, name))?;
        if self.failed_since(mark) {
            return Ok(None);
        }
        self.attempt(|this| this.mass_properties(&mut draft, name, &mut frame))?;
        let groups = self.attempt(|this| this.order_ports(&mut draft))?;
        let (Some(port_groups), false) = (groups, self.failed_since(mark)) else { return Ok(None) };
        self.attempt(|_| validated(&draft, name))?;
        if self.failed_since(mark) {
            return Ok(None);
        }
        Ok(Some(DesignKind::Module(ModuleDesign {
            module: Rc::new(draft.module),
            connectors: draft.connectors.iter().map(|c| c.def).collect(),
            port_groups,
            joint_dimensions: def.joints.iter().map(|joint| joint.dimension).collect(),
            robot: OnceCell::new(),
        })))
    }

    /// Returns the module before its links, joints, ports and motors are read.
    fn draft<'d>(&mut self, def: &'d ModuleDef, title: &str, frame: &mut Frame) -> Eval<Draft<'d>> {
        let touch = match &def.touch {
            Some(touch) => self.positive(touch, "`touch`", frame)?,
            None => ModuleType::TOUCH_DEFAULT,
        };
        let contact = match &def.contact {
            Some(contact) => self.positive(contact, "`contact`", frame)?,
            None => ModuleType::CONTACT_DEFAULT,
        };
        let module = ModuleType {
            name: title.to_string(),
            links: Vec::new(),
            joints: Vec::new(),
            ports: Vec::new(),
            motors: Vec::new(),
            touching: Vec::new(),
            touch,
            contact,
        };
        Ok(Draft { def, module, solids: Vec::new(), connectors: Vec::new(), ports: Vec::new() })
    }

    fn read_links(&mut self, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        for link in &draft.def.links {
            let (solid, built) = self.read_link(link, frame)?;
            draft.solids.push(solid);
            draft.module.links.push(built);
        }
        Ok(())
    }

    /// Returns the shape of a link as it is declared, and the link, still without mass, centre and inertia.
    fn read_link(&mut self, link: &LinkDef, frame: &mut Frame) -> Eval<(Solid, Link)> {
        let shape = self.eval(&link.shape, frame)?;
        let collides = self.eval_optional(link.collides.as_ref(), frame)?;
        let pose = self.placement(link.at.as_ref(), frame)?;
        let solid = match &shape {
            Value::Shape(solid) => {
                self.attempt(|_| sound(solid, link))?;
                solid.as_ref().clone()
            }
            // Unknown, which has been reported.
            _ => Solid::default(),
        };
        let judged = match &collides {
            Some(Value::Shape(solid)) => solid.parts.clone(),
            _ => solid.parts.clone(),
        };
        let left_out = self.attempt(|_| left_out(&solid.parts, &judged, link))?.unwrap_or(0.0);
        let built = Link {
            name: link.name.to_string(),
            pose,
            shape: solid.parts.clone(),
            collides: judged,
            left_out,
            mass: 0.0,
            com: Vec3::zeros(),
            inertia: [0.0; 6],
            friction: solid.friction.unwrap_or(Link::FRICTION_DEFAULT),
            surface: solid.surface,
        };
        Ok((solid, built))
    }

    /// Returns the pose that `at [x, y, z] turned(Z, 90deg)` gives in the frame around it: the position in m, then the
    /// turns in the order written, each about an axis of the frame turned so far. The identity for `None`.
    ///
    /// # Errors
    /// A fault where the position is farther than [`EXTENT_MAX`](crate::geometry::soundness::EXTENT_MAX) along an
    /// axis, or an axis is zero.
    pub(super) fn placement(&mut self, at: Option<&Placement>, frame: &mut Frame) -> Eval<Pose> {
        let Some(at) = at else { return Ok(Pose::identity()) };
        let mut pose = match self.eval(&at.position, frame)? {
            Value::Vec3(position, _) if position.iter().any(|c| c.abs() > EXTENT_MAX) => {
                let message = "nothing is placed farther away than 1 km";
                return Err(fault(code::BAD_VALUE, at.position.span, message, "too far"));
            }
            Value::Vec3(position, _) => shifted(position),
            _ => Pose::identity(),
        };
        for (axis, angle) in &at.turned {
            let direction = self.direction(axis, frame)?;
            let angle = self.eval(angle, frame)?.as_number();
            if let (Some(direction), Some(angle)) = (direction, angle) {
                pose *= turned(direction, angle);
            }
        }
        Ok(pose)
    }

    /// Returns the direction of an expression as a unit vector; `None` where it is unknown.
    ///
    /// # Errors
    /// A fault where it is zero.
    fn direction(&mut self, expr: &crate::check::typed::Expr, frame: &mut Frame) -> Eval<Option<Vec3>> {
        match self.eval(expr, frame)? {
            Value::Vec3(v, _) if v.norm() > 0.0 => Ok(Some(v.normalize())),
            Value::Vec3(..) => {
                let message = "a direction must not be zero";
                Err(fault(code::BAD_VALUE, expr.span, message, "this points nowhere"))
            }
            _ => Ok(None),
        }
    }

    /// Reads the joints; one of unknown kind becomes a fixed one, and a mimic joint moves no link.
    fn read_joints(&mut self, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        for (index, joint) in draft.def.joints.iter().enumerate() {
            let built = match &joint.kind {
                JointDefKind::Declared(between) => {
                    let kind = self.eval(&between.kind, frame)?;
                    let pose = self.placement(between.at.as_ref(), frame)?;
                    let mut built = match kind {
                        Value::JointKind(spec) => {
                            declared_joint(joint, between.parent, between.child, &spec, pose)
                        }
                        _ => fixed_joint(joint, between.parent, between.child, pose),
                    };
                    if let Some(follows) = &between.follows {
                        built.mimic = Some(self.followed(index, joint, follows, frame)?);
                    }
                    built
                }
                JointDefKind::Mimic(follows) => {
                    let mut built = fixed_joint(joint, 0, 0, Pose::identity());
                    built.mimic = Some(self.followed(index, joint, follows, frame)?);
                    built
                }
            };
            draft.module.joints.push(built);
        }
        Ok(())
    }

    /// Returns the linear combination of joints that the joint at `index` follows.
    ///
    /// # Errors
    /// A fault where it follows itself.
    fn followed(
        &mut self,
        index: usize,
        joint: &JointDef,
        follows: &Linear,
        frame: &mut Frame,
    ) -> Eval<Vec<(usize, f64)>> {
        let mut sum = Vec::new();
        for (of, factor) in follows {
            if *of == index {
                let message = format!("`{}` follows itself", joint.name);
                return Err(fault(code::BAD_MODULE, joint.span, message, "follows itself"));
            }
            sum.push((*of, self.eval(factor, frame)?.as_number().unwrap_or(1.0)));
        }
        Ok(sum)
    }

    fn read_ports(&mut self, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        let def = draft.def;
        self.module_clauses(&def.clauses, draft, frame)
    }

    fn module_clauses(&mut self, clauses: &[ModuleClause], draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        for clause in clauses {
            self.attempt(|this| this.module_clause(clause, draft, frame))?;
        }
        Ok(())
    }

    /// Runs a clause: reads its port, takes its pair of links that may touch, binds its local, or checks its
    /// requirement.
    fn module_clause(&mut self, clause: &ModuleClause, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        match clause {
            ModuleClause::Port(port) => self.read_port(port, draft, frame),
            ModuleClause::Touching(a, b, _) => {
                draft.module.touching.push((*a, *b));
                Ok(())
            }
            ModuleClause::Let { local, value } => {
                let value = self.eval(value, frame)?;
                frame.set(*local, value);
                Ok(())
            }
            ModuleClause::Require(require) => self.check_requirement(require, frame),
            ModuleClause::If { condition, then, otherwise } => match self.eval(condition, frame)? {
                Value::Bool(true) => self.module_clauses(then, draft, frame),
                Value::Bool(false) => self.module_clauses(otherwise, draft, frame),
                _ => Ok(()),
            },
            ModuleClause::For { binder, iterable, body } => {
                let values = self.eval(iterable, frame)?;
                self.for_each(&values, *binder, iterable.span, frame, |this, frame| {
                    this.module_clauses(body, draft, frame)
                })?;
                Ok(())
            }
        }
    }

    /// Adds the port of a clause: its x axis along `facing`, its z axis in the plane of `facing` and `up`. Adds
    /// none where something is unknown.
    ///
    /// # Errors
    /// A fault where `up` and `facing` lie on one line.
    fn read_port(&mut self, clause: &PortClause, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        let PortClause { group, index, connector, link, at, facing, up, span } = clause;
        let index = match index {
            Some(index) => match self.eval(index, frame)? {
                Value::Int(i) => i,
                _ => return Ok(()),
            },
            None => 0,
        };
        let place = self.placement(at.as_ref(), frame)?;
        let facing_direction = self.direction(facing, frame)?;
        let up_direction = match up {
            Some(up) => self.direction(up, frame)?,
            None => Some(default_up(facing_direction.unwrap_or(Vec3::x()))),
        };
        let Some(connector) = self.connector(*connector)? else { return Ok(()) };
        let (Some(x), Some(z)) = (facing_direction, up_direction) else { return Ok(()) };
        let Some(rotation) = port_rotation(x, z) else {
            let up = up.as_ref().map_or(*span, |up| up.span);
            return Err(Diagnostic::error(code::BAD_MODULE, "`up` and `facing` lie on one line")
                .label(up, "this leaves the port's turn open")
                .label(facing.span, "parallel to this")
                .into());
        };
        let known = draft.connectors.iter().position(|c| c.def == connector.def);
        let connector = known.unwrap_or_else(|| {
            draft.connectors.push(connector);
            draft.connectors.len() - 1
        });
        let declared = &draft.def.ports[*group];
        let name =
            if declared.array { format!("{}[{index}]", declared.name) } else { declared.name.to_string() };
        let pose = Pose::from_parts(place.translation, place.rotation * rotation);
        draft.ports.push((*group, index, *span, Port { name, link: *link, pose, connector }));
        Ok(())
    }

    /// Puts ports in the order of their declarations and array indices, which must be 0, 1, 2, ... Returns the
    /// index of the first port and the number of ports of each group.
    ///
    /// # Errors
    /// A fault where an index is left out or given twice, or a single port is never declared.
    fn order_ports(&mut self, draft: &mut Draft) -> Eval<Vec<(usize, usize)>> {
        draft.ports.sort_by_key(|(group, index, ..)| (*group, *index));
        let mut groups = Vec::new();
        for (group, declared) in draft.def.ports.iter().enumerate() {
            let first = draft.module.ports.len();
            let of_group = draft.ports.iter().filter(|(g, ..)| *g == group);
            for (expected, (_, index, span, port)) in of_group.enumerate() {
                if *index != expected as i64 {
                    let message = format!("`{}[{expected}]` comes next, not `{}`", declared.name, port.name);
                    let label = "elements are declared from 0, each once";
                    return Err(fault(code::BAD_MODULE, *span, message, label));
                }
                draft.module.ports.push(port.clone());
            }
            let count = draft.module.ports.len() - first;
            if count == 0 && !declared.array {
                let message = format!("the port `{}` is never declared", declared.name);
                return Err(fault(
                    code::BAD_MODULE,
                    declared.span,
                    message,
                    "no clause that runs declares it",
                ));
            }
            groups.push((first, count));
        }
        Ok(groups)
    }

    fn read_motors(&mut self, draft: &mut Draft, frame: &mut Frame) -> Eval<()> {
        for motor in &draft.def.motors {
            let built = self.read_motor(motor, frame)?;
            draft.module.motors.push(built);
        }
        Ok(())
    }

    fn read_motor(&mut self, motor: &MotorDef, frame: &mut Frame) -> Eval<Motor> {
        let mut joints = Vec::new();
        for (joint, factor) in &motor.joints {
            joints.push((*joint, self.eval(factor, frame)?.as_number().unwrap_or(1.0)));
        }
        let mut limits = Limits::default();
        for (expr, slot) in [
            (&motor.max_speed, &mut limits.speed),
            (&motor.max_accel, &mut limits.acceleration),
            (&motor.max_torque, &mut limits.effort),
        ] {
            if let Some(expr) = expr {
                *slot = Some(self.positive(expr, "a limit of a motor", frame)?);
            }
        }
        Ok(Motor { name: motor.name.to_string(), joints, limits })
    }

    /// Refuses a module without links, one whose links and joints form no tree with the first link as its root,
    /// and one with a joint whose range ends before it begins.
    ///
    /// # Errors
    /// A fault at the link or joint to blame.
    fn check_module(&mut self, draft: &Draft, name: Span) -> Eval<()> {
        let (def, module) = (draft.def, &draft.module);
        if def.links.is_empty() {
            let message = format!("the module `{}` has no link", module.name);
            return Err(fault(code::BAD_MODULE, name, message, "the first link is its body"));
        }
        let mut carried_by: Vec<Option<usize>> = vec![None; def.links.len()];
        let between_links = |index: usize| matches!(def.joints[index].kind, JointDefKind::Declared(_));
        for (index, joint) in module.joints.iter().enumerate().filter(|(index, _)| between_links(*index)) {
            let span = def.joints[index].span;
            if joint.child == 0 || joint.child == joint.parent {
                let message = format!("the joint `{}` closes a circle of links", joint.name);
                return Err(fault(code::BAD_MODULE, span, message, "links and joints form a tree"));
            }
            if let Some(other) = carried_by[joint.child].replace(index) {
                let child = def.links[joint.child].name;
                let message = format!("the link `{child}` hangs on two joints");
                return Err(Diagnostic::error(code::BAD_MODULE, message)
                    .label(span, "on this one")
                    .label(def.joints[other].span, "and on this one")
                    .into());
            }
            if let Some((low, high)) = joint.limits.range
                && low > high
            {
                let message = format!("the range of `{}` ends before it begins", joint.name);
                return Err(fault(code::BAD_MODULE, span, message, "write the lower end first"));
            }
        }
        self.check_rooted(draft, &carried_by)
    }

    /// Refuses a link that no chain of joints connects with the first one. `carried_by`: the joint of which
    /// each link is the child.
    fn check_rooted(&mut self, draft: &Draft, carried_by: &[Option<usize>]) -> Eval<()> {
        let parent = |link: usize| carried_by[link].map(|joint| draft.module.joints[joint].parent);
        for (link, declared) in draft.def.links.iter().enumerate() {
            let hops = carried_by.len();
            let top = std::iter::successors(Some(link), |&l| parent(l)).take(hops + 1).last();
            if top != Some(0) {
                let message = format!("no joint connects the link `{}` with the body", declared.name);
                let body = draft.def.links[0].name;
                let label = format!("not connected with `{body}`, the first link");
                return Err(fault(code::BAD_MODULE, declared.span, message, label));
            }
        }
        Ok(())
    }

    /// Computes masses, centres of mass and inertias of the links: as stated, else from the module's mass by
    /// volume.
    ///
    /// # Errors
    /// A fault where no mass is stated, or the links are heavier than the module.
    fn mass_properties(&mut self, draft: &mut Draft, name: Span, frame: &mut Frame) -> Eval<()> {
        let stated: Vec<_> = draft.solids.iter().map(|s| (s.parts.as_slice(), s.mass)).collect();
        let (whole, span) = match &draft.def.mass {
            Some(mass) => (self.positive(mass, "the mass of a module", frame)?, mass.span),
            None if stated.iter().all(|(_, mass)| mass.is_some()) => {
                (stated.iter().filter_map(|(_, mass)| *mass).sum(), name)
            }
            None => {
                let message = format!("the module `{}` has no mass", draft.module.name);
                return Err(Diagnostic::error(code::BAD_MODULE, message)
                    .label(name, "no `mass`, and not every link has one")
                    .hint("write `mass 150g`, or give every link's shape a `mass:`")
                    .into());
            }
        };
        let masses = mass::split(&stated, whole)
            .map_err(|unsound| fault(code::BAD_SHAPE, name, unsound.to_string(), "has no volume"))?
            .ok_or_else(|| {
                let message = "the links are heavier than the module";
                fault(code::BAD_MODULE, span, message, "less than the masses of its links")
            })?;
        for ((link, solid), mass) in draft.module.links.iter_mut().zip(&draft.solids).zip(masses) {
            link.mass = mass.mass;
            link.com = solid.com.unwrap_or(mass.com);
            link.inertia = solid.inertia.unwrap_or(mass.inertia);
        }
        Ok(())
    }
}

fn declared_joint(joint: &JointDef, parent: usize, child: usize, spec: &JointSpec, pose: Pose) -> Joint {
    Joint {
        name: joint.name.to_string(),
        parent,
        child,
        kind: spec.kind,
        pose,
        axis: spec.axis.try_normalize(0.0).unwrap_or(Vec3::z()),
        limits: spec.limits,
        passive: spec.passive,
        servo: spec.servo,
        mimic: None,
    }
}

fn fixed_joint(joint: &JointDef, parent: usize, child: usize, pose: Pose) -> Joint {
    let spec = JointSpec::fixed();
    declared_joint(joint, parent, child, &spec, pose)
}

/// Returns the orientation of a port: x along `facing`, z along the part of `up` that is perpendicular to it.
/// `None` where they lie on one line.
pub(crate) fn port_rotation(facing: Vec3, up: Vec3) -> Option<nalgebra::UnitQuaternion<f64>> {
    let y = up.cross(&facing);
    if y.norm() < TOLERANCES.parallel {
        return None;
    }
    let y = y.normalize();
    let axes = nalgebra::Matrix3::from_columns(&[facing, y, facing.cross(&y)]);
    Some(nalgebra::UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(axes)))
}

/// Returns the direction from which turns are counted by default: upwards, or forwards for a port that faces up
/// or down.
pub(crate) fn default_up(facing: Vec3) -> Vec3 {
    if facing.cross(&Vec3::z()).norm() < TOLERANCES.parallel { Vec3::x() } else { Vec3::z() }
}

/// Refuses a module that breaks a rule of [`validation`], at the part that does.
fn validated(draft: &Draft, name: Span) -> Eval<()> {
    validation::check_module(&draft.module, draft.connectors.len()).map_err(|found| {
        let span = match found.part() {
            Some(ModulePart::Link(link)) => draft.def.links[link].span,
            Some(ModulePart::Joint(joint)) => draft.def.joints[joint].span,
            Some(ModulePart::Motor(motor)) => draft.def.motors[motor].span,
            Some(ModulePart::Port(port)) => {
                let port_name = &draft.module.ports[port].name;
                draft.ports.iter().find(|(.., port)| port.name == *port_name).map_or(name, |p| p.2)
            }
            None => name,
        };
        fault(code::BAD_MODULE, span, found.to_string(), "not sound")
    })
}

/// Returns the distance by which what is drawn of a link sticks out of what is judged.
fn left_out(drawn: &[Placed], judged: &[Placed], link: &LinkDef) -> Eval<f64> {
    let Some(collides) = &link.collides else { return Ok(0.0) };
    let refused =
        |unsound: Unsound| fault(code::BAD_SHAPE, collides.span, unsound.to_string(), "this is no solid");
    if judged.is_empty() {
        return Err(refused(Unsound::Empty));
    }
    judged.iter().try_for_each(soundness::check_placed).map_err(refused)?;
    // A drawn shape that is no solid has been told.
    Ok(validation::left_out(drawn, judged).unwrap_or(0.0))
}

/// Refuses a link's shape that encloses nothing.
fn sound(solid: &Solid, link: &LinkDef) -> Eval<()> {
    for placed in solid.parts.iter() {
        soundness::check_placed(placed).map_err(|unsound| {
            fault(code::BAD_SHAPE, link.shape.span, unsound.to_string(), "this is no solid")
        })?;
    }
    if solid.parts.is_empty() {
        let message = format!("the link `{}` has no shape", link.name);
        return Err(fault(code::BAD_SHAPE, link.shape.span, message, "no shape"));
    }
    Ok(())
}
