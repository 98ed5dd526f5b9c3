//! The model of loads and travel of docs/dynamics.md, written down once more without the judge's methods: the least energy of
//! all springs and the least power of friction by dense Newton steps, displacements by differences of poses, and the travel
//! by momentum in steps of 50 µs. Robots touch the ground with balls only, whose links are named `.._ballR`, R their radius
//! in millimetres.
#![allow(non_snake_case)]

use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::{Instant, Rollout, Tolerances, roll_out};
use modl::plan::{Plan, Tracks};
use modl::robot::dynamics::{Dynamics, MotionState, Twist, Wrench};
use modl::robot::{JointOwner, Kinematics};
use nalgebra::allocator::Allocator;
use nalgebra::{
    DMatrix, DVector, DefaultAllocator, Dim, DimMin, Matrix3, Matrix6, OMatrix, OVector, SMatrix, U1,
    Vector3, Vector6,
};

/// The window over which velocities and accelerations are means, s.
pub const WINDOW: f64 = 0.05;
/// The stiffness of a contact (N/m), of a stop (N·m/rad or N/m), and of a closing bond (N/m and N·m/rad).
const CONTACT: f64 = 1e5;
const STOP: f64 = 1e3;
const BOND: [f64; 2] = [1e5, 1e3];
/// The speed below which friction is viscous, m/s, and the weight of motion along the normal beside that of slip.
const VISCOUS: f64 = 1e-3;
const NORMAL: f64 = 30.0;

/// A joint with a motion of its own: its number, stiffness, armature and range.
type Driven = (usize, f64, f64, Option<(f64, f64)>);

/// The velocities and accelerations of all joints.
type Rates = (Vec<f64>, Vec<f64>);

/// A robot of a plan, with what the model needs of it.
pub struct Machine<'a> {
    /// The pose of the frame of the ground in the world (`X_WG`), in whose axes everything is, and gravity in it, m/s².
    pub ground: Pose,
    gravity: Vec3,
    pub tracks: &'a Tracks,
    pub kinematics: Kinematics,
    dynamics: Dynamics,
    /// The links that are balls, all that may touch the ground: number, radius (m), friction.
    balls: Vec<(usize, f64, f64)>,
    /// The joints with a motion of their own: number, stiffness, armature, and range.
    joints: Vec<Driven>,
}

impl<'a> Machine<'a> {
    pub fn new(plan: &'a Plan) -> Machine<'a> {
        let tracks = plan.body.tracks().expect("a robot of modules");
        let robot = &tracks.robot;
        let kinematics = Kinematics::new(robot, &vec![true; robot.bonds.len()], robot.base);
        let mut balls = Vec::new();
        for module in 0..robot.modules.len() {
            for (index, link) in robot.module_type(module).links.iter().enumerate() {
                // Balls end in their radius in millimetres.
                if let Some((_, radius)) = link.name.split_once("_ball") {
                    let radius: f64 = radius.parse().expect("a radius in its name");
                    balls.push((kinematics.link(module, index), radius * 1e-3, link.friction));
                }
            }
        }
        let mut joints = Vec::new();
        for (number, owner) in robot.joints().enumerate() {
            let JointOwner::Module { module, joint } = owner else { panic!("no bond turns") };
            let declared = &robot.module_type(module).joints[joint];
            if declared.mimic.is_none() {
                let servo = declared.servo;
                let stiffness = servo.stiffness.expect("stated");
                joints.push((number, stiffness, servo.armature.unwrap_or(0.0), declared.limits.range));
            }
        }
        let world = plan.worlds[0].world;
        let ground = world.ground_pose();
        let gravity = ground.rotation.inverse() * Vec3::new(0.0, 0.0, -world.gravity);
        Machine { ground, gravity, tracks, dynamics: Dynamics::new(robot), kinematics, balls, joints }
    }

    pub fn positions(&self, t: f64) -> Vec<f64> {
        self.tracks.state(t.clamp(0.0, self.tracks.duration)).joints
    }

    /// Returns the mean velocities and accelerations of all joints over the window about a time (s).
    fn rates(&self, t: f64) -> (Vec<f64>, Vec<f64>) {
        let (from, to) = (t - WINDOW / 2.0, t + WINDOW / 2.0);
        let (a, b) = (self.positions(from), self.positions(to));
        let velocities = a.iter().zip(&b).map(|(a, b)| (b - a) / WINDOW).collect();
        let mut accelerations = vec![0.0; a.len()];
        for track in &self.tracks.tracks {
            let rate =
                |t: f64| if (0.0..self.tracks.duration).contains(&t) { track.velocity(t) } else { 0.0 };
            accelerations[track.joint.0 as usize] = (rate(to) - rate(from)) / WINDOW;
        }
        (velocities, accelerations)
    }

    fn poses(&self, joints: &[f64], base: &Pose) -> Vec<Pose> {
        let mut poses = vec![Pose::identity(); self.kinematics.link_count()];
        self.kinematics.link_poses(joints, base, &mut poses);
        poses
    }

    /// Returns the centre of mass, m, and the mass, kg.
    fn centre(&self, poses: &[Pose]) -> (Vec3, f64) {
        self.kinematics.centre_of_mass(&self.tracks.robot, poses)
    }
}

/// A displacement of a link: the shift of its point at the centre of mass, and its turn.
type Shift = (Vec3, Vec3);

/// Returns the displacement from one pose to another near it, about a point.
fn shift(from: &Pose, to: &Pose, about: &Vec3) -> Shift {
    let step = to * from.inverse();
    let point = nalgebra::Point3::from(*about);
    ((step * point).coords - about, step.rotation.scaled_axis())
}

/// A point of contact: its link, its place from the centre of mass (m), its gap (m), its friction, and its velocity by the
/// joints alone (m/s).
struct Contact {
    link: usize,
    p: Vec3,
    gap: f64,
    friction: f64,
    by_joints: Vec3,
}

impl Contact {
    /// Returns the friction on the contact, N, under a load (N), if the base moves it at a velocity (m/s) besides its joints.
    fn resists(&self, load: f64, base: &Vec3) -> Vec3 {
        let mut slip = base + self.by_joints;
        slip.z = 0.0;
        -slip * (self.friction * load / regularized(&slip))
    }
}

/// Returns the speed along the ground by which friction on a slip is divided, m/s.
fn regularized(slip: &Vec3) -> f64 {
    (slip.x * slip.x + slip.y * slip.y + VISCOUS * VISCOUS).sqrt()
}

/// The gradient and the Hessian of a function.
type Derivatives<D> = (OVector<f64, D>, OMatrix<f64, D, D>);

/// Returns the least point of a convex function from a first one on, by Newton steps with a line search.
fn least<D: Dim + DimMin<D, Output = D>>(
    first: OVector<f64, D>,
    value: &dyn Fn(&OVector<f64, D>) -> f64,
    derivatives: &dyn Fn(&OVector<f64, D>) -> Derivatives<D>,
) -> OVector<f64, D>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D> + Allocator<U1, D>,
{
    let mut x = first;
    for _ in 0..300 {
        let (gradient, hessian) = derivatives(&x);
        let step = hessian.lu().solve(&-&gradient).expect("the Hessian is regular");
        let (before, mut part) = (value(&x), 1.0);
        while part > 1e-9 && value(&(&x + &step * part)) > before + 1e-4 * part * gradient.dot(&step) {
            part *= 0.5;
        }
        x += &step * part;
        if part == 1.0 && step.amax() < 1e-12 {
            break;
        }
    }
    x
}

/// The robot at an instant.
struct Scene<'a> {
    machine: &'a Machine<'a>,
    joints: Vec<f64>,
    poses: Vec<Pose>,
    centre: Vec3,
    mass: f64,
    contacts: Vec<Contact>,
    /// The displacement of each link by each degree of freedom: height, roll and pitch of the whole, then each joint.
    shifts: Vec<Vec<Shift>>,
}

impl<'a> Scene<'a> {
    /// Returns the robot at a time, with its base there; `velocities`: of all joints.
    fn new(machine: &'a Machine, t: f64, base: &Pose, velocities: &[f64]) -> Scene<'a> {
        let joints = machine.positions(t);
        let poses = machine.poses(&joints, base);
        let (centre, mass) = machine.centre(&poses);
        let moved = |by: &dyn Fn(usize) -> f64, h: f64| -> Vec<f64> {
            joints.iter().enumerate().map(|(j, q)| q + h * by(j)).collect()
        };
        let difference = |by: &dyn Fn(usize) -> f64| -> Vec<Shift> {
            let h = 1e-5;
            let (a, b) = (machine.poses(&moved(by, -h), base), machine.poses(&moved(by, h), base));
            let rate = |(a, b): (&Pose, &Pose)| {
                let (linear, angular) = shift(a, b, &centre);
                (linear / (2.0 * h), angular / (2.0 * h))
            };
            a.iter().zip(&b).map(rate).collect()
        };
        let motion = difference(&|j| velocities[j]);
        let whole = [(Vec3::z(), Vec3::zeros()), (Vec3::zeros(), Vec3::x()), (Vec3::zeros(), Vec3::y())];
        let mut shifts: Vec<Vec<Shift>> = whole.iter().map(|s| vec![*s; poses.len()]).collect();
        shifts.extend(machine.joints.iter().map(|(own, ..)| difference(&|j| f64::from(u8::from(j == *own)))));
        let lowest = |&(link, radius, friction): &(usize, f64, f64)| {
            let p = poses[link].translation.vector - Vec3::z() * radius - centre;
            let by_joints = motion[link].0 + motion[link].1.cross(&p);
            Contact { link, p, gap: p.z, friction, by_joints }
        };
        let mut contacts: Vec<Contact> = machine.balls.iter().map(lowest).collect();
        let ground = contacts.iter().map(|c| c.gap).fold(f64::INFINITY, f64::min);
        contacts.iter_mut().for_each(|c| c.gap -= ground);
        contacts.retain(|c| c.gap <= 2.5e-3);
        Scene { machine, joints, poses, centre, mass, contacts, shifts }
    }

    /// Returns the wrench about the centre of mass that each link needs under gravity, in motion or at rest.
    fn needed(&self, motion: Option<(&Rates, [Twist; 2])>) -> Vec<Wrench> {
        let still = (vec![0.0; self.joints.len()], vec![0.0; self.joints.len()]);
        let (rates, [base, base_acceleration]) = motion.unwrap_or((&still, [Twist::default(); 2]));
        let state = MotionState {
            poses: &self.poses,
            base,
            base_acceleration,
            velocities: &rates.0,
            accelerations: &rates.1,
        };
        let machine = self.machine;
        machine.dynamics.link_wrenches(&machine.kinematics, &state, &machine.gravity, &self.centre)
    }

    /// Returns the normal force of each contact and the effort of each joint at the least energy of all springs, with these
    /// forces of friction.
    fn loads(&self, needed: &[Wrench], friction: &[Vec3]) -> (Vec<f64>, Vec<f64>) {
        let count = self.shifts.len();
        let robot = &self.machine.tracks.robot;
        let mut force = DVector::zeros(count);
        for (dof, shifts) in self.shifts.iter().enumerate() {
            let work =
                |(w, (linear, angular)): (&Wrench, &Shift)| w.force.dot(linear) + w.moment.dot(angular);
            let slid = |(c, f): (&Contact, &Vec3)| {
                let (linear, angular) = &shifts[c.link];
                f.dot(&(linear + angular.cross(&c.p)))
            };
            force[dof] = needed.iter().zip(shifts).map(work).sum::<f64>()
                - self.contacts.iter().zip(friction).map(slid).sum::<f64>();
        }
        // Springs that only push: (stiffness, gap, how the gap grows with each degree of freedom).
        let mut pushing: Vec<(f64, f64, DVector<f64>)> = Vec::new();
        for c in &self.contacts {
            let rise = |shifts: &Vec<Shift>| (shifts[c.link].0 + shifts[c.link].1.cross(&c.p)).z;
            pushing.push((CONTACT, c.gap, DVector::from_iterator(count, self.shifts.iter().map(rise))));
        }
        let mut stiffness = DMatrix::zeros(count, count);
        // A touch of stiffness for what nothing bears.
        (0..3).for_each(|dof| stiffness[(dof, dof)] = 1e-4);
        for (own, (joint, k, _, range)) in self.machine.joints.iter().enumerate() {
            stiffness[(3 + own, 3 + own)] += k;
            if let Some((low, high)) = range {
                let ends = [(self.joints[*joint] - low, 1.0), (high - self.joints[*joint], -1.0)];
                for (gap, sign) in ends.into_iter().filter(|(gap, _)| *gap <= 0.05) {
                    let mut row = DVector::zeros(count);
                    row[3 + own] = sign;
                    pushing.push((STOP, gap.max(0.0), row));
                }
            }
        }
        for &bond in &self.machine.kinematics.tree.closing {
            let [a, b] = [robot.bonds[bond].a, robot.bonds[bond].b];
            let port = self.machine.kinematics.port_pose(robot, a, &self.poses);
            let p = port.translation.vector - self.centre;
            let [a, b] = [a, b].map(|port| self.machine.kinematics.port_link(robot, port));
            let apart = |shifts: &Vec<Shift>| {
                let (linear, angular) = (shifts[a].0 - shifts[b].0, shifts[a].1 - shifts[b].1);
                let shifted = linear + angular.cross(&p);
                Vector6::from_iterator(shifted.iter().chain(angular.iter()).copied())
            };
            let rows: Vec<Vector6<f64>> = self.shifts.iter().map(apart).collect();
            for i in 0..count {
                for j in 0..count {
                    stiffness[(i, j)] += (0..6).map(|k| BOND[k / 3] * rows[i][k] * rows[j][k]).sum::<f64>();
                }
            }
        }
        let energy = |x: &DVector<f64>| {
            let pressed =
                pushing.iter().map(|(k, gap, row)| 0.5 * k * libm::pow((gap + row.dot(x)).min(0.0), 2.0));
            0.5 * x.dot(&(&stiffness * x)) + force.dot(x) + pressed.sum::<f64>()
        };
        let derivatives = |x: &DVector<f64>| {
            let (mut gradient, mut hessian) = (&stiffness * x + &force, stiffness.clone());
            for (k, gap, row) in &pushing {
                let depth = (gap + row.dot(x)).min(0.0);
                if depth < 0.0 {
                    gradient += row * (k * depth);
                    hessian += row * row.transpose() * *k;
                }
            }
            (gradient, hessian)
        };
        // Pressed by a little, so that all contacts count at first.
        let mut pressed = DVector::zeros(count);
        pressed[0] = -2.0 * self.contacts.iter().map(|c| c.gap).fold(1e-6, f64::max);
        let x = least(pressed, &energy, &derivatives);
        let normals =
            pushing[..self.contacts.len()].iter().map(|(k, gap, row)| -k * (gap + row.dot(&x)).min(0.0));
        let normals: Vec<f64> = normals.collect();
        // A servo gives what its spring does.
        let efforts =
            self.machine.joints.iter().enumerate().map(|(own, (_, k, ..))| -k * x[3 + own]).collect();
        (normals, efforts)
    }

    /// Returns the twist of the base at the centre of mass at the least power of friction, with the force along the
    /// ground and the moment that friction has to supply.
    fn twist(&self, normals: &[f64], needed: &Vector6<f64>) -> Vector6<f64> {
        let loaded: Vec<(&Contact, f64, SMatrix<f64, 3, 6>)> = self
            .contacts
            .iter()
            .zip(normals)
            .filter(|(_, load)| **load > 0.0)
            .map(|(c, load)| {
                let mut J = SMatrix::<f64, 3, 6>::zeros();
                J.fixed_view_mut::<3, 3>(0, 0).copy_from(&Matrix3::identity());
                J.fixed_view_mut::<3, 3>(0, 3).copy_from(&-c.p.cross_matrix());
                (c, *load, J)
            })
            .collect();
        let power = |xi: &Vector6<f64>| {
            let mut power: f64 = needed.dot(xi);
            for (c, load, J) in &loaded {
                let s = J * xi + c.by_joints;
                power += c.friction * load * regularized(&s);
                power += 0.5 * NORMAL / VISCOUS * load * s.z * s.z;
            }
            power
        };
        let derivatives = |xi: &Vector6<f64>| {
            let (mut gradient, mut hessian) = (*needed, Matrix6::identity() * 1e-7);
            for (c, load, J) in &loaded {
                let s = J * xi + c.by_joints;
                let planar = Vec3::new(s.x, s.y, 0.0);
                let speed = regularized(&s);
                let w = c.friction * load / speed;
                let along = Matrix3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0));
                let bend = along * w - planar * planar.transpose() * (w / (speed * speed));
                let lift = Matrix3::from_diagonal(&Vec3::new(0.0, 0.0, NORMAL / VISCOUS * load));
                gradient += J.transpose() * (planar * w + lift * s);
                hessian += J.transpose() * (bend + lift) * J;
            }
            (gradient, hessian)
        };
        least(Vector6::zeros(), &power, &derivatives)
    }

    /// Returns the force of friction on each contact under a twist.
    fn friction(&self, normals: &[f64], xi: &Vector6<f64>) -> Vec<Vec3> {
        let (linear, angular): (Vec3, Vec3) = (xi.fixed_rows::<3>(0).into(), xi.fixed_rows::<3>(3).into());
        let one = |(c, load): (&Contact, &f64)| c.resists(*load, &(linear + angular.cross(&c.p)));
        self.contacts.iter().zip(normals).map(one).collect()
    }

    /// Returns the twist, the normal forces, the friction and the efforts that belong together without momentum.
    fn equilibrium(&self, needed: &[Wrench]) -> (Vector6<f64>, Vec<f64>, Vec<Vec3>, Vec<f64>) {
        let sum = needed
            .iter()
            .fold(Wrench::default(), |a, b| Wrench { force: a.force + b.force, moment: a.moment + b.moment });
        // On a slope friction bears what the normal forces leave of the moments in roll and pitch, too.
        let sloped = self.machine.ground != Pose::identity();
        let mut friction = vec![Vec3::zeros(); self.contacts.len()];
        let (mut normals, mut efforts) = self.loads(needed, &friction);
        let mut xi = Vector6::zeros();
        for round in 0..60 {
            let mut left = sum.moment;
            self.contacts.iter().zip(&normals).for_each(|(c, load)| left -= c.p.cross(&(Vec3::z() * *load)));
            let tilting = if sloped { [left.x, left.y] } else { [0.0; 2] };
            let wanted = Vector6::new(sum.force.x, sum.force.y, 0.0, tilting[0], tilting[1], sum.moment.z);
            xi = self.twist(&normals, &wanted);
            friction = self.friction(&normals, &xi);
            let (next, found) = self.loads(needed, &friction);
            let change: f64 = next.iter().zip(&normals).map(|(a, b)| (a - b).abs()).sum();
            let part = if round < 5 { 1.0 } else { 0.4 };
            normals.iter_mut().zip(&next).for_each(|(load, next)| *load += part * (next - *load));
            efforts = found;
            if change < 1e-7 * self.mass {
                break;
            }
        }
        (xi, normals, friction, efforts)
    }
}

/// Returns the velocity of the base's frame at which friction is in balance without inertia.
fn quasi_static(machine: &Machine, t: f64, base: &Pose) -> Twist {
    let scene = Scene::new(machine, t, base, &machine.rates(t).0);
    let (xi, ..) = scene.equilibrium(&scene.needed(None));
    let (linear, angular): (Vec3, Vec3) = (xi.fixed_rows::<3>(0).into(), xi.fixed_rows::<3>(3).into());
    Twist { linear: linear + angular.cross(&(base.translation.vector - scene.centre)), angular }
}

/// Compares the loads at an instant, and returns the greatest differences: of forces (parts of the weight) and of efforts
/// (parts of the weight at 0.1 m).
pub fn compared(machine: &Machine, found: &Instant, [before, after]: [&Instant; 2]) -> [f64; 2] {
    let t = found.time;
    let to_ground = machine.ground.inverse();
    let [a, v, b] = [(before.time, before), (t, found), (after.time, after)]
        .map(|(t, instant)| quasi_static(machine, t, &(to_ground * instant.base)));
    let acceleration =
        Twist { linear: (b.linear - a.linear) / WINDOW, angular: (b.angular - a.angular) / WINDOW };
    let rates = machine.rates(t);
    let scene = Scene::new(machine, t, &(to_ground * found.base), &rates.0);
    let needed = scene.needed(Some((&rates, [v, acceleration])));
    let (_, normals, friction, efforts) = scene.equilibrium(&needed);
    let weight = scene.mass * machine.gravity.norm();
    let forces = found.forces.as_ref().expect("forces are known");
    let mut worst: [f64; 2] = [0.0; 2];
    for ((c, normal), f) in scene.contacts.iter().zip(&normals).zip(&friction) {
        let place = (machine.ground * nalgebra::Point3::from(scene.centre + c.p)).coords;
        let near = forces.iter().filter(|force| (force.point - place).norm() < 5e-3);
        let ours = near.fold(Vec3::zeros(), |sum, force| sum + force.force);
        worst[0] = worst[0].max((to_ground.rotation * ours - f - Vec3::z() * *normal).norm() / weight);
    }
    for ((joint, _, armature, _), effort) in machine.joints.iter().zip(&efforts) {
        let slides = if machine.tracks.robot.slides(machine.tracks.robot.joints().nth(*joint).expect("it")) {
            0.1
        } else {
            1.0
        };
        let wanted = effort + armature * rates.1[*joint];
        let ours = found.efforts[*joint].expect("known");
        worst[1] = worst[1].max(slides * (ours - wanted).abs() / (weight * 0.1));
    }
    worst
}

/// Returns the pose of the base at the end, followed by planar momentum under friction: the base keeps the tilt that it begins
/// with.
pub fn travelled(machine: &Machine, begin: &Pose) -> Pose {
    let (interval, step) = (2.5e-3, 5e-5);
    let mut base = *begin;
    let (mut centre, _) = machine.centre(&machine.poses(&machine.positions(0.0), begin));
    let (mut yaw, mut xi) = (0.0, Vector3::<f64>::zeros());
    let (mut had, mut friction) = (Vector3::zeros(), Vec::new());
    let placed = |t: f64, yaw: f64, centre: &Vec3| {
        let turn = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::z_axis(), yaw);
        let rough = Pose::from_parts(begin.translation, turn * begin.rotation);
        let (at, _) = machine.centre(&machine.poses(&machine.positions(t), &rough));
        let mut by = centre - at;
        by.z = 0.0;
        Pose::from_parts((rough.translation.vector + by).into(), rough.rotation)
    };
    let count = (machine.tracks.duration / interval).round() as usize;
    for index in 0..count {
        let t = (index as f64 + 0.5) * interval;
        let velocities = machine.rates(t).0;
        let scene = Scene::new(machine, t, &base, &velocities);
        friction.resize(scene.contacts.len(), Vec3::zeros());
        let (normals, _) = scene.loads(&scene.needed(None), &friction);
        let of = |base: &Twist, rates: &[f64]| {
            machine.dynamics.momentum(&machine.kinematics, &scene.poses, base, rates, &scene.centre)
        };
        let own = of(&Twist::default(), &velocities);
        let carried = Vector3::new(own.force.x, own.force.y, own.moment.z);
        let arm = base.translation.vector - scene.centre;
        let spin = Twist { linear: Vec3::z().cross(&arm), angular: Vec3::z() };
        let inertia = Vector3::new(scene.mass, scene.mass, of(&spin, &vec![0.0; velocities.len()]).moment.z);
        xi -= (carried - had).component_div(&inertia);
        had = carried;
        for _ in 0..(interval / step).round() as usize {
            let mut force = Vector3::zeros();
            for ((c, load), f) in scene.contacts.iter().zip(&normals).zip(&mut friction) {
                *f = c.resists(*load, &Vec3::new(xi.x - xi.z * c.p.y, xi.y + xi.z * c.p.x, 0.0));
                force += Vector3::new(f.x, f.y, c.p.x * f.y - c.p.y * f.x);
            }
            xi += force.component_div(&inertia) * step;
            centre += Vec3::new(xi.x, xi.y, 0.0) * step
                + Vec3::new(carried.x, carried.y, 0.0) * (step / scene.mass);
            yaw += xi.z * step;
        }
        base = placed((index + 1) as f64 * interval, yaw, &centre);
    }
    base
}

/// Returns the times (s) at which the judge records attitudes: samples at least 10 ms apart.
pub fn recorded(plan: &Plan) -> Vec<f64> {
    let tolerances = Tolerances::default();
    let tracks = plan.body.tracks().expect("a robot of modules");
    let mut times: Vec<f64> = Vec::new();
    let rollout = Rollout::of(plan, tracks, &tolerances);
    roll_out(rollout, None, tracks.duration, &mut |sample, _| {
        if times.last().is_none_or(|last| sample.time - last >= 0.01 - 1e-6) {
            times.push(sample.time);
        }
        true
    });
    times
}
