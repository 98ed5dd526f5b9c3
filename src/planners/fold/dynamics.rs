//! Dynamics of the folding tree: recursive Newton-Euler (Eq. 3 and 4) for any motion of its hinges.
//!
//! The outward recursion from the root, which is held, gives the pose, velocity and acceleration of every face. The
//! inward recursion from the leaves gives the force and moment that the parent has to exert on it; the moment about the
//! hinge is the motor's torque. In Eq. 3 `p_i` is one vector for each child, from the face's own hinge to the child's.
//! (The paper has one for each module, which is wrong where a module has two children.)

use super::inertia::Body;
use super::kinematics::about;
use super::layout::Layout;
use super::target::Target;
use crate::geometry::{Pose, Vec3};

/// The position (rad), speed (rad/s) and acceleration (rad/s²) of the hinge between a face and its parent. An angle of
/// 0 is level, positive angles are convex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hinging {
    /// The angle of the hinge, rad.
    pub angle: f64,
    /// The speed of the hinge, rad/s.
    pub speed: f64,
    /// The acceleration of the hinge, rad/s².
    pub acceleration: f64,
}

/// The inverse dynamics of a layout by the recursive Newton-Euler algorithm: a tree of rigid bodies on hinges whose
/// root is held fast.
pub struct Dynamics<'t> {
    target: &'t Target,
    layout: &'t Layout,
    bodies: &'t [Body],
    /// The gravity vector in the frame of the target, m/s².
    gravity: Vec3,
    faces: Vec<Moving>,
}

/// A face while it moves, in the frame of the target.
#[derive(Clone, Copy)]
struct Moving {
    /// Its displacement from its pose in the target.
    pose: Pose,
    /// A point of its hinge, m, and the unit vector about which the motor turns it.
    origin: Vec3,
    axis: Vec3,
    /// The angular velocity, rad/s, and the angular acceleration, rad/s².
    turning: Vec3,
    spinning_up: Vec3,
    /// The acceleration of the origin, less gravity, m/s².
    rising: Vec3,
    /// The force that its parent exerts, N, and the moment about the origin, N·m.
    force: Vec3,
    moment: Vec3,
}

const AT_REST: Moving = Moving {
    pose: Pose {
        rotation: nalgebra::Unit::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0)),
        translation: nalgebra::Translation3 { vector: Vec3::new(0.0, 0.0, 0.0) },
    },
    origin: Vec3::new(0.0, 0.0, 0.0),
    axis: Vec3::new(0.0, 0.0, 0.0),
    turning: Vec3::new(0.0, 0.0, 0.0),
    spinning_up: Vec3::new(0.0, 0.0, 0.0),
    rising: Vec3::new(0.0, 0.0, 0.0),
    force: Vec3::new(0.0, 0.0, 0.0),
    moment: Vec3::new(0.0, 0.0, 0.0),
};

impl<'t> Dynamics<'t> {
    /// Sets up the dynamics with all hinges at rest; `bodies`: one for each face of the target, in the order of
    /// [`Target::faces`], in the frame of the target; `gravity`: the vector in that frame, m/s². `layout`: the layout
    /// of the target whose hinges turn.
    pub fn new(target: &'t Target, layout: &'t Layout, bodies: &'t [Body], gravity: Vec3) -> Dynamics<'t> {
        Dynamics { target, layout, bodies, gravity, faces: vec![AT_REST; bodies.len()] }
    }

    /// Computes the torques of all hinges by inverse dynamics (recursive Newton-Euler algorithm, Eq. 3 and 4 of [Yao
    /// et al.](super)) and writes them to `torques`, N·m: entry k is that of the hinge between face k and its parent,
    /// that of the root is 0. `hinging(k)`: the motion of that hinge. Positive torques turn towards positive angles.
    /// Panics if `torques` has fewer entries than there are faces.
    pub fn torques(&mut self, hinging: impl Fn(usize) -> Hinging, torques: &mut [f64]) {
        self.outwards(hinging);
        for &face in self.layout.order[1..].iter().rev() {
            let Moving { axis, force, moment, origin, .. } = self.faces[face];
            torques[face] = axis.dot(&moment);
            let parent = &mut self.faces[self.layout.parent[face]];
            parent.force += force;
            parent.moment += moment + (origin - parent.origin).cross(&force);
        }
        torques[self.layout.root] = 0.0;
    }

    /// Computes poses, velocities, accelerations, and the net force and moment of each body (outward
    /// recursion).
    fn outwards(&mut self, hinging: impl Fn(usize) -> Hinging) {
        let layout = self.layout;
        // Gravity enters as an upward acceleration of the base.
        self.faces[layout.root] = Moving { rising: -self.gravity, ..AT_REST };
        for &face in &layout.order[1..] {
            let hinge = &self.target.hinges[layout.hinge[face].expect("only the root has none")];
            let parent = &self.faces[layout.parent[face]];
            let Hinging { angle, speed, acceleration } = hinging(face);
            let local = hinge.axis_from(layout.parent[face]);
            let axis = parent.pose.rotation * local;
            let origin = parent.pose.transform_point(&hinge.point.into()).coords;
            let missing = angle - hinge.angle;
            let pose =
                if missing == 0.0 { parent.pose } else { parent.pose * about(&hinge.point, local, missing) };
            let turning = parent.turning + axis * speed;
            let spinning_up = parent.spinning_up + axis * acceleration + parent.turning.cross(&axis) * speed;
            let rising =
                parent.rising + carried(&parent.turning, &parent.spinning_up, &(origin - parent.origin));
            let body = &self.bodies[face];
            let arm = pose.transform_point(&body.centre.into()).coords - origin;
            let force = (rising + carried(&turning, &spinning_up, &arm)) * body.mass;
            // In the frame of the face, where its inertia does not change.
            let (w, dw) = (pose.rotation.inverse() * turning, pose.rotation.inverse() * spinning_up);
            let twist = pose.rotation * (body.inertia * dw + w.cross(&(body.inertia * w)));
            let moment = twist + arm.cross(&force);
            self.faces[face] = Moving { pose, origin, axis, turning, spinning_up, rising, force, moment };
        }
    }
}

/// Returns the acceleration of a point of a body relative to that of another point of it; `arm`: from that to it.
fn carried(turning: &Vec3, spinning_up: &Vec3, arm: &Vec3) -> Vec3 {
    spinning_up.cross(arm) + turning.cross(&turning.cross(arm))
}
