//! What `fold` is given: the panels and the shape, checked.

use super::call::Call;
use super::design::Design;
use super::interpreter::Interpreter;
use super::stop::{Eval, Stop};
use super::value::Value;
use crate::behavior::law;
use crate::geometry::{Part, Placed, Pose, Shape, Solid, Vec3};
use crate::planners::fold::meeting::Solids;
use crate::planners::fold::{Target, Unfoldable};
use crate::robot::{Link, ModuleType, Port};
use crate::source::{Diagnostic, code};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::rc::Rc;

/// How far sides may be off those of the panels, as a part of them.
const TOL_SIDE: f64 = 1e-6;

/// What a triangular panel is to the planner.
pub struct Panel {
    pub design: Rc<Design>,
    /// kg
    pub mass: f64,
    /// m
    pub side: f64,
    /// Of the even plate that is spread as much across itself, m.
    pub thickness: f64,
    /// What the hinges of its edges can do.
    pub able: law::Ability,
    /// What they hold, N·m, where a limit is stated.
    pub torque: Option<f64>,
    /// How deep a panel may be in another or in the ground, m, and what is nearer to the ground than
    /// the second touches it.
    pub touch: f64,
    pub contact: f64,
    /// Its convex parts in the frame of [`Solids`](crate::planners::fold::meeting::Solids).
    pub parts: Vec<Part>,
}

impl Panel {
    /// The module in argument `index`.
    pub fn of(interpreter: &mut Interpreter, call: &Call, index: usize) -> Eval<Panel> {
        let design = call.instance(index)?.design.clone();
        let no_panel = |why: &str| call.refuse(index, format!("no triangular panel: {why}"));
        let Some(module) = design.module() else { return Err(no_panel("a module is wanted")) };
        let kind = &module.module;
        let [a, b, c] = &kind.ports[..] else { return Err(no_panel("it needs one port for each edge")) };
        let [link] = &kind.links[..] else { return Err(no_panel("it has more than one link")) };
        // From the middle of one edge to those of the others it is half a side.
        let middle = |port: &Port| port.pose.translation.vector;
        let halves = [(a, b), (b, c), (c, a)].map(|(p, q)| (middle(q) - middle(p)).norm());
        let side = 2.0 * halves[0];
        if halves.iter().any(|half| (2.0 * half - side).abs() > TOL_SIDE * side) {
            return Err(no_panel("its ports are not at the middles of equal edges"));
        }
        let Some(robot) = interpreter.robot_of(&design)? else {
            return Err(no_panel("its module is not sound"));
        };
        let library = &robot.assembly.library;
        let connector = library.modules[0].ports[0].connector;
        let Some(hinge) = &library.connectors[connector].hinge else {
            return Err(no_panel("its edges have no hinge"));
        };
        let able = law::Ability { speed: hinge.limits.speed, acceleration: hinge.limits.acceleration };
        let torque = hinge.limits.effort;
        let thickness = thickness(link, a.pose.rotation * Vec3::z());
        let solid = Solid::new(&link.collides).map_err(|_| no_panel("its shape is not sound"))?;
        let panel_of_link = frame(a, b, c).inverse();
        let parts = solid.parts.iter().map(|part| part.moved(&panel_of_link)).collect();
        let ModuleType { touch, contact, .. } = library.modules[0];
        let (mass, design) = (link.mass, design.clone());
        Ok(Panel { mass, side, thickness, able, torque, touch, contact, parts, design })
    }
}

/// The middle of a panel, with x towards its first edge and z along its normal, in the frame of its link.
fn frame(a: &Port, b: &Port, c: &Port) -> Pose {
    let [p, q, r] = [a, b, c].map(|port| port.pose.translation.vector);
    let middle = (p + q + r) / 3.0;
    let (x, z) = ((p - middle).normalize(), a.pose.rotation * Vec3::z());
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]));
    Pose::from_parts(middle.into(), UnitQuaternion::from_rotation_matrix(&turn))
}

/// From how far the mass is spread along the normal: d²/12 of it.
fn thickness(link: &Link, normal: Vec3) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = link.inertia;
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let across = inertia.trace() / 2.0 - normal.dot(&(inertia * normal));
    libm::sqrt((12.0 * across / link.mass).max(0.0))
}

/// The shape in argument `index`; `module` is where the panel was given.
pub fn target(call: &Call, index: usize, module: usize, panel: &Panel) -> Eval<Target> {
    let (vertices, faces) = surface(call, index)?;
    let target = Target::new(vertices, &faces).and_then(|target| {
        target.check_sides(panel.side, TOL_SIDE * panel.side)?;
        Ok(target)
    });
    target.map_err(|why| {
        let said = unfoldable(call, index, &why);
        match why {
            Unfoldable::UnequalSides { .. } => said.label(call.at(module), "these panels").into(),
            _ => said.into(),
        }
    })
}

fn unfoldable(call: &Call, index: usize, why: &Unfoldable) -> Diagnostic {
    Diagnostic::error(code::UNFOLDABLE, why.to_string())
        .label(call.at(index), "does not fold")
        .hint(why.remedy())
}

/// What each face is made of.
pub struct Panels {
    /// By face.
    pub designs: Vec<Rc<Design>>,
    /// By face, kg.
    pub masses: Vec<f64>,
    pub solids: Solids,
}

/// The faces listed in argument `listed` are made of the module in argument `passive`, which has no
/// motors; the hinge between two of them is none.
pub fn panels(
    interpreter: &mut Interpreter,
    call: &Call,
    [listed, passive]: [usize; 2],
    panel: &Panel,
    target: Target,
) -> Eval<(Panels, Target)> {
    let faces = target.faces.len();
    let solids = Solids { parts: vec![panel.parts.clone(); faces], touch: panel.touch };
    let (designs, masses) = (vec![panel.design.clone(); faces], vec![panel.mass; faces]);
    let mut panels = Panels { designs, masses, solids };
    let list = call.list(listed)?.clone();
    if list.is_empty() {
        return Ok((panels, target));
    }
    if call.is_missing(passive) {
        return Err(call.refuse(listed, "of what are they? `passive_module` says it"));
    }
    let other = Panel::of(interpreter, call, passive)?;
    if (other.side - panel.side).abs() > TOL_SIDE * panel.side {
        return Err(call.refuse(passive, "its sides are not those of the other panels"));
    }
    let mut driven = vec![true; faces];
    for value in list.iter() {
        let Value::Int(face) = value else { continue };
        let Some(face) = usize::try_from(*face).ok().filter(|face| *face < faces) else {
            return Err(call.refuse(listed, format!("there is no face {face}: there are {faces}")));
        };
        driven[face] = false;
        panels.designs[face] = other.design.clone();
        panels.masses[face] = other.mass;
        panels.solids.parts[face].clone_from(&other.parts);
        panels.solids.touch = panel.touch.max(other.touch);
    }
    let target = target.driven(&driven).map_err(|why| -> Stop { unfoldable(call, listed, &why).into() })?;
    Ok((panels, target))
}

/// The surface in an argument: a mesh, or a shape that was read from a file as it is.
fn surface(call: &Call, index: usize) -> Eval<(Vec<Vec3>, Vec<Vec<usize>>)> {
    match call.arg(index) {
        Value::Mesh(mesh) => return Ok((mesh.vertices.clone(), mesh.faces.clone())),
        Value::Shape(solid) => {
            if let [Placed { pose, shape: Shape::Mesh { vertices, triangles, .. } }] = &solid.parts[..] {
                let place = |p: &Vec3| pose.transform_point(&(*p).into()).coords;
                let corners = |t: &[u32; 3]| t.iter().map(|corner| *corner as usize).collect();
                return Ok((vertices.iter().map(place).collect(), triangles.iter().map(corners).collect()));
            }
        }
        _ => {}
    }
    Err(call.refuse(index, "a surface of triangles is wanted: a mesh, or a shape from a mesh file"))
}
