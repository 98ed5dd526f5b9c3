//! Panels and shapes that `fold` is given, checked.

use crate::behavior::law;
use crate::geometry::{Part, Placed, Pose, Shape, Solid, Vec3};
use crate::interpret::call::Call;
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::planners::fold::{Target, Unfoldable};
use crate::robot::{Link, ModuleType, Port};
use crate::source::{Diagnostic, code};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::rc::Rc;

/// How far sides may be off those of the panels, as a part of them; and directions of ports off those of
/// their edges.
pub const TOL_SIDE: f64 = 1e-6;

/// What a triangular panel is to the planner.
#[derive(Clone)]
pub struct Panel {
    pub design: Rc<Design>,
    /// kg
    pub mass: f64,
    /// From the first edge on, counterclockwise seen from the front, m.
    pub sides: [f64; 3],
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
    /// Its convex parts in the frame of [`Solids`](crate::planners::fold::sweep_collision::Solids).
    pub parts: Vec<Part>,
}

impl Panel {
    /// A design as a panel; `index`: the argument that it came from.
    pub fn of(interpreter: &mut Interpreter, call: &Call, index: usize, design: &Rc<Design>) -> Eval<Panel> {
        let no_panel = |why: &str| call.refuse(index, format!("no triangular panel: {why}"));
        let Some(module) = design.module() else { return Err(no_panel("a module is wanted")) };
        let kind = &module.module;
        let [a, b, c] = &kind.ports[..] else { return Err(no_panel("it needs one port for each edge")) };
        let [link] = &kind.links[..] else { return Err(no_panel("it has more than one link")) };
        let Some(sides) = sides(&[a, b, c]) else {
            let why = "its ports are not at the middles of its edges, facing outwards, counterclockwise, \
                       with `up` to its front";
            return Err(no_panel(why));
        };
        let Some(robot) = interpreter.robot_of(design)? else {
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
        Ok(Panel { mass, sides, thickness, able, torque, touch, contact, parts, design })
    }

    pub fn is_equilateral(&self) -> bool {
        alike(self.sides, [self.sides[0]; 3], TOL_SIDE)
    }

    /// The same with what is worse of another: what holds of it holds of both.
    pub fn weaker(self, other: &Panel) -> Panel {
        let least = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(f64::min);
        let able = law::Ability {
            speed: least(self.able.speed, other.able.speed),
            acceleration: least(self.able.acceleration, other.able.acceleration),
        };
        Panel {
            able,
            torque: least(self.torque, other.torque),
            thickness: self.thickness.max(other.thickness),
            touch: self.touch.max(other.touch),
            ..self
        }
    }
}

/// Whether sides differ by less than a part of the longest.
pub fn alike(a: [f64; 3], b: [f64; 3], tol: f64) -> bool {
    let longest = a.into_iter().fold(0.0, f64::max);
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= tol * longest)
}

/// The sides of a panel with ports at the middles of its edges, which face outwards with their `up` to
/// the front, counterclockwise from there; `None` where they are not that.
fn sides(ports: &[&Port; 3]) -> Option<[f64; 3]> {
    let middle = ports.map(|port| port.pose.translation.vector);
    let front = ports[0].pose.rotation * Vec3::z();
    let mut sides = [0.0; 3];
    for k in 0..3 {
        // From the middle of one edge to that of the next it is half the third, in its direction.
        let half = middle[(k + 2) % 3] - middle[(k + 1) % 3];
        sides[k] = 2.0 * half.norm();
        let out = -half.cross(&front) / half.norm();
        let turn = &ports[k].pose.rotation;
        let off = (turn * Vec3::x() - out).norm().max((turn * Vec3::z() - front).norm());
        if off.is_nan() || off > TOL_SIDE {
            return None;
        }
    }
    Some(sides)
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

/// The shape in argument `index`.
pub fn target(call: &Call, index: usize) -> Eval<Target> {
    let (vertices, faces) = surface(call, index)?;
    Target::new(vertices, &faces).map_err(|why| unfoldable(call, index, &why).into())
}

/// Why the shape in argument `index` does not fold.
pub fn unfoldable(call: &Call, index: usize, why: &Unfoldable) -> Diagnostic {
    Diagnostic::error(code::UNFOLDABLE, why.to_string())
        .label(call.at(index), "does not fold")
        .hint(why.remedy())
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
