//! A second look at what a plan describes, by other means than the judge's: sampled motions with kinematics, statics
//! and contacts of its own. It finds what is wrong at its samples; it proves nothing.
#![allow(non_snake_case)]

use modl::geometry::closest_points::segment_segment_distance;
use modl::geometry::distance::distance_of_solids;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Part, Pose, Solid, Vec3};
use modl::plan::{
    Body, DockingKind, ExemptionKind, Ground, Interpolation, NodePaths, Plan, Segment, Tracks, World,
};
use modl::robot::{JointKind, JointOwner, Library, ModuleType, PortRef};
use std::f64::consts::{PI, TAU};

/// Samples over the whole of a motion, beside those at its instants.
const SAMPLES: usize = 60;
/// The deviation that sampling and rounding explain, as a part of a limit, and in m or rad.
const SLACK: f64 = 1e-4;

/// Returns what is wrong with a plan, in words; nothing where all that is recounted is right.
pub fn wrongs(plan: &Plan) -> Vec<String> {
    let mut found = declared(&plan.library);
    match &plan.body {
        Body::Tracks(tracks) => Robot::new(plan, tracks).recount(&mut found),
        Body::Stages(_) => super::recount_lattice::recount(plan, &mut found),
        Body::NodePaths(paths) => truss(plan, paths, &mut found),
    }
    found
}

/// The world at a time.
fn world(plan: &Plan, t: f64) -> World {
    plan.worlds.iter().rfind(|w| w.from <= t).map_or(World::default(), |w| w.world)
}

/// Returns the facts of a library that no module, cell or strut can have, in words.
fn declared(library: &Library) -> Vec<String> {
    let mut found = Vec::new();
    for module in &library.modules {
        let mut wrong = |words: &str| found.push(format!("{}: {words}", module.name));
        if !(0.0..=0.01).contains(&module.touch) || !(0.0..=0.03).contains(&module.contact) {
            wrong("a tolerance is none");
        }
        for link in &module.links {
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            // Second moments: of a body they are positive along every axis.
            let half = (xx + yy + zz) / 2.0;
            let seconds = [half - xx, half - yy, half - zz];
            let minor = |a: f64, b: f64, c: f64| a * b - c * c;
            let minors = [
                minor(seconds[0], seconds[1], xy),
                minor(seconds[0], seconds[2], xz),
                minor(seconds[1], seconds[2], yz),
            ];
            let none = seconds.iter().any(|s| *s < -SLACK * 20.0 * half)
                || minors.iter().any(|m| *m < -SLACK * 20.0 * half * half);
            if !(link.mass >= 0.0 && link.mass < 1e10) || none || !half.is_finite() {
                wrong("a mass or inertia is none");
            }
            if sticks_out(&link.shape, &link.collides) > link.left_out + SLACK {
                wrong("what is drawn is not judged");
            }
        }
        for joint in &module.joints {
            let limits = [joint.limits.speed, joint.limits.acceleration, joint.limits.effort];
            if limits.iter().flatten().any(|limit| !(*limit > 0.0 && *limit < 1e10)) {
                wrong("a limit is none");
            }
            if follows_itself(module, joint.mimic.iter().flatten().map(|m| m.0).collect(), 0) {
                wrong("a joint follows itself");
            }
        }
    }
    for cell in &library.cells {
        let positive = [cell.size, cell.shrinks_to, cell.mass, cell.force, cell.speed]
            .iter()
            .all(|x| *x > 0.0 && *x < 1e10);
        if !positive || cell.shrinks_to >= cell.size {
            found.push(format!("{} is no cell", cell.name));
        }
    }
    for strut in &library.struts {
        let positive =
            [strut.length.0, strut.speed, strut.force, strut.mass].iter().all(|x| *x > 0.0 && *x < 1e10);
        if !positive || strut.length.1 <= strut.length.0 || strut.clearance < 0.0 {
            found.push(format!("{} is no strut", strut.name));
        }
    }
    found
}

fn follows_itself(module: &ModuleType, followed: Vec<usize>, depth: usize) -> bool {
    depth > 20
        || followed.into_iter().any(|joint| {
            let next = module.joints[joint].mimic.iter().flatten().map(|m| m.0).collect();
            follows_itself(module, next, depth + 1)
        })
}

/// Returns the distance of the support points of drawn parts from the parts that are judged, at most.
fn sticks_out(drawn: &[modl::geometry::Placed], judged: &[modl::geometry::Placed]) -> f64 {
    if drawn == judged {
        return 0.0;
    }
    let (Ok(drawn), Ok(judged)) = (Solid::new(drawn), Solid::new(judged)) else { return f64::INFINITY };
    let axes = [-1.0, 0.0, 1.0];
    let directions =
        axes.iter().flat_map(|x| axes.map(|y| (*x, y))).flat_map(|(x, y)| axes.map(|z| Vec3::new(x, y, z)));
    let ends: Vec<Vec3> = directions
        .filter(|n| n.norm() > 0.0)
        .flat_map(|n| drawn.parts.iter().map(move |p| p.support(&n)).collect::<Vec<_>>())
        .collect();
    let apart = |p: &Vec3| {
        let point = Part::sphere(*p, 0.0);
        let from =
            |part: &Part| modl::geometry::distance::signed_distance(&point, part, &Pose::identity()).distance;
        judged.parts.iter().map(from).fold(f64::INFINITY, f64::min)
    };
    ends.iter().map(apart).fold(0.0, f64::max)
}

/// A robot in motion.
pub struct Robot<'a> {
    plan: &'a Plan,
    tracks: &'a Tracks,
    solids: Vec<Vec<Solid>>,
    owners: Vec<JointOwner>,
}

/// A link and the link that carries it, each as (module, link).
pub type Carried = ((usize, usize), (usize, usize));

/// The links of a robot at a time: by module and link.
pub type Poses = Vec<Vec<Option<Pose>>>;

impl<'a> Robot<'a> {
    pub fn new(plan: &'a Plan, tracks: &'a Tracks) -> Robot<'a> {
        let of = |module: &ModuleType| {
            module.links.iter().map(|l| Solid::new(&l.collides).unwrap_or_default()).collect()
        };
        let solids = tracks.robot.library.modules.iter().map(of).collect();
        Robot { plan, tracks, solids, owners: tracks.robot.joints().collect() }
    }

    /// Position of a joint: de Casteljau.
    fn position(&self, joint: usize, t: f64) -> f64 {
        let track = self.tracks.tracks.iter().find(|track| track.joint.0 as usize == joint);
        let begun = |segment: &&Segment| segment.start <= t;
        let Some(segment) = track.and_then(|track| track.segments.iter().rfind(begun)) else {
            return self.tracks.start.joints[joint];
        };
        let u = ((t - segment.start) / (segment.end - segment.start)).min(1.0);
        let mut points = segment.control.clone();
        while points.len() > 1 {
            points = points.windows(2).map(|w| w[0] + u * (w[1] - w[0])).collect();
        }
        points[0]
    }

    /// Position of a joint of a module, those that follow others included.
    fn value(&self, module: usize, joint: usize, t: f64) -> f64 {
        let declared = &self.tracks.robot.module_type(module).joints[joint];
        if let Some(followed) = &declared.mimic {
            return followed.iter().map(|(other, factor)| factor * self.value(module, *other, t)).sum();
        }
        let owner = JointOwner::Module { module, joint };
        self.position(self.owners.iter().position(|o| *o == owner).expect("it is one"), t)
    }

    fn holds(&self, t: f64) -> Vec<bool> {
        let mut holds = self.tracks.start.bonds.clone();
        for dock in self.tracks.events.iter().filter(|dock| dock.time <= t) {
            holds[dock.bond] = dock.kind == DockingKind::Dock;
        }
        holds
    }

    /// Poses of the links over joints and bonds that hold, from the base on; and the carrier of each link.
    pub fn poses(&self, t: f64) -> (Poses, Vec<Carried>) {
        self.poses_from(t, self.tracks.start.base)
    }

    /// The same with the base at another pose.
    pub fn poses_from(&self, t: f64, base: Pose) -> (Poses, Vec<Carried>) {
        let robot = &self.tracks.robot;
        let mut poses: Poses =
            (0..robot.modules.len()).map(|m| vec![None; robot.module_type(m).links.len()]).collect();
        let mut carried = Vec::new();
        poses[robot.base][0] = Some(base);
        let holds = self.holds(t);
        let mut open = vec![(robot.base, 0)];
        while let Some((module, link)) = open.pop() {
            let here = poses[module][link].expect("it was placed");
            let mut found = Vec::new();
            let kind = robot.module_type(module);
            for (index, joint) in kind.joints.iter().enumerate() {
                let q = self.value(module, index, t);
                let motion = match joint.kind {
                    JointKind::Revolute => turned(joint.axis, q),
                    JointKind::Prismatic => shifted(joint.axis * q),
                    JointKind::Fixed => Pose::identity(),
                };
                let across = joint.pose * motion * joint.pose.inverse();
                let (parent, child) = (kind.links[joint.parent].pose, kind.links[joint.child].pose);
                let step = parent.inverse() * across * child;
                if joint.parent == link && joint.child != link {
                    found.push((module, joint.child, here * step));
                } else if joint.child == link && joint.parent != link {
                    found.push((module, joint.parent, here * step.inverse()));
                }
            }
            for (index, bond) in robot.bonds.iter().enumerate().filter(|(index, _)| holds[*index]) {
                let (X, a, b) = (self.mate(index, t), self.port(bond.a), self.port(bond.b));
                if (bond.a.module, a.0) == (module, link) {
                    found.push((bond.b.module, b.0, here * a.1 * X * b.1.inverse()));
                } else if (bond.b.module, b.0) == (module, link) {
                    found.push((bond.a.module, a.0, here * b.1 * X.inverse() * a.1.inverse()));
                }
            }
            for (to, link_to, pose) in found {
                if poses[to][link_to].is_none() {
                    poses[to][link_to] = Some(pose);
                    carried.push(((to, link_to), (module, link)));
                    open.push((to, link_to));
                }
            }
        }
        (poses, carried)
    }

    fn port(&self, port: PortRef) -> (usize, Pose) {
        let declared = &self.tracks.robot.module_type(port.module).ports[port.port];
        (declared.link, declared.pose)
    }

    /// `X_PQ` of a bond.
    fn mate(&self, bond: usize, t: f64) -> Pose {
        let robot = &self.tracks.robot;
        let declared = robot.bonds[bond];
        let connector =
            &robot.library.connectors[robot.module_type(declared.a.module).ports[declared.a.port].connector];
        let turn = TAU * f64::from(declared.turn) / f64::from(connector.turns);
        let open = connector.hinge.as_ref().map_or(Pose::identity(), |hinge| {
            let joint = self.owners.iter().position(|o| *o == JointOwner::Bond(bond)).expect("it turns");
            turned(hinge.axis, self.position(joint, t))
        });
        open * turned(Vec3::z(), PI) * turned(Vec3::x(), turn)
    }

    fn recount(&self, found: &mut Vec<String>) {
        let end = self.tracks.duration;
        let mut instants: Vec<f64> = (0..=SAMPLES).map(|k| end * k as f64 / SAMPLES as f64).collect();
        instants.extend(
            self.tracks.tracks.iter().flat_map(|t| &t.segments).flat_map(|s| [s.start, s.end]).take(60),
        );
        for t in instants {
            self.limits(t, found);
            let (poses, carried) = self.poses(t);
            if poses.iter().flatten().any(Option::is_none) {
                found.push(format!("at {t} it is in pieces"));
                return;
            }
            self.meetings(t, &poses, found);
            if world(self.plan, t).ground == Ground::Held {
                self.torques(t, &poses, &carried, found);
            }
            if found.len() > 5 {
                return;
            }
        }
        self.dockings(found);
    }

    fn excused(&self, t: f64, kind: impl Fn(&ExemptionKind) -> bool) -> bool {
        self.plan.exemptions.iter().any(|e| e.from <= t && t <= e.to && kind(&e.kind))
    }

    fn limits(&self, t: f64, found: &mut Vec<String>) {
        let robot = &self.tracks.robot;
        let step = 1e-6;
        for (id, owner) in self.owners.iter().enumerate() {
            let (limits, at): (_, Box<dyn Fn(f64) -> f64 + '_>) = match *owner {
                JointOwner::Module { module, joint } => (
                    robot.module_type(module).joints[joint].limits,
                    Box::new(move |t| self.value(module, joint, t)),
                ),
                JointOwner::Bond(bond) => {
                    (robot.hinge(bond).expect("it turns").limits, Box::new(move |t| self.position(id, t)))
                }
            };
            let (low, high) = limits.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            if !(low - SLACK..=high + SLACK).contains(&at(t)) {
                found.push(format!("at {t} joint {id} is at {}", at(t)));
            }
            let rate = (at(t + step) - at(t)) / step;
            if t + step < self.tracks.duration
                && rate.abs() > limits.speed.unwrap_or(f64::INFINITY) * (1.0 + SLACK) + 1e-3
            {
                found.push(format!("at {t} joint {id} moves at {rate}"));
            }
        }
    }

    /// Links of different modules that no bond joins are apart.
    fn meetings(&self, t: f64, poses: &Poses, found: &mut Vec<String>) {
        if self.excused(t, |kind| matches!(kind, ExemptionKind::Collision(_))) {
            return;
        }
        let robot = &self.tracks.robot;
        let holds = self.holds(t);
        let joined = |a: usize, b: usize| {
            let mut bonds = robot.bonds.iter().zip(&holds);
            bonds.any(|(bond, _)| {
                (bond.a.module, bond.b.module) == (a, b) || (bond.a.module, bond.b.module) == (b, a)
            })
        };
        for a in 0..robot.modules.len() {
            for b in (a + 1..robot.modules.len()).filter(|b| !joined(a, *b)) {
                let touch = robot.module_type(a).touch.min(robot.module_type(b).touch);
                for (i, p) in self.solids[robot.modules[a].kind].iter().enumerate() {
                    for (j, q) in self.solids[robot.modules[b].kind].iter().enumerate() {
                        let (X, Y) = (poses[a][i].expect("placed"), poses[b][j].expect("placed"));
                        let between = (X * nalgebra::Point3::from(p.centre)
                            - Y * nalgebra::Point3::from(q.centre))
                        .norm();
                        if between < p.radius + q.radius && distance_of_solids(p, &X, q, &Y) < -touch - SLACK
                        {
                            found.push(format!("at {t} modules {a} and {b} meet"));
                        }
                    }
                }
            }
        }
    }

    /// Torques of the motors of a robot that is held at its base, and of no loops: the weight beyond them.
    fn torques(&self, t: f64, poses: &Poses, carried: &[Carried], found: &mut Vec<String>) {
        if self.excused(t, |kind| matches!(kind, ExemptionKind::Overload(_))) {
            return;
        }
        for (name, moment, effort) in self.held(t, poses, carried) {
            if moment > effort * (1.0 + SLACK) {
                found.push(format!("at {t} {name} holds {moment} N·m"));
            }
        }
    }

    /// The absolute moment that each joint with a limit holds, N·m, with its name and its limit: the weight beyond it, of a
    /// robot that is held at its base and has no loops.
    pub fn held(&self, t: f64, poses: &Poses, carried: &[Carried]) -> Vec<(String, f64, f64)> {
        let robot = &self.tracks.robot;
        let gravity = world(self.plan, t).gravity;
        let mut held = Vec::new();
        for module in 0..robot.modules.len() {
            let kind = robot.module_type(module);
            for joint in kind
                .joints
                .iter()
                .filter(|j| j.kind == JointKind::Revolute && j.mimic.is_none() && !j.passive)
            {
                let (Some(effort), true) =
                    (joint.limits.effort, kind.joints.iter().all(|j| j.mimic.is_none()))
                else {
                    continue;
                };
                // The side that the base is not on.
                let outer = carried.iter().find(|(link, by)| {
                    let ends = [(module, joint.parent), (module, joint.child)];
                    ends.contains(link) && ends.contains(by)
                });
                let Some((outer, _)) = outer else { continue };
                let mut beyond = vec![*outer];
                for (link, by) in carried {
                    if beyond.contains(by) && !beyond.contains(link) {
                        beyond.push(*link);
                    }
                }
                let X_WJ = poses[module][joint.parent].expect("placed")
                    * kind.links[joint.parent].pose.inverse()
                    * joint.pose;
                let axis = X_WJ.rotation * joint.axis;
                let moment: Vec3 = beyond
                    .iter()
                    .map(|&(m, l)| {
                        let link = &robot.module_type(m).links[l];
                        let lever = (poses[m][l].expect("placed") * nalgebra::Point3::from(link.com)).coords
                            - X_WJ.translation.vector;
                        lever.cross(&Vec3::new(0.0, 0.0, -gravity * link.mass))
                    })
                    .sum();
                held.push((joint.name.clone(), axis.dot(&moment).abs(), effort));
            }
        }
        held
    }

    fn dockings(&self, found: &mut Vec<String>) {
        for dock in self.tracks.events.iter().filter(|dock| dock.kind == DockingKind::Dock) {
            let (poses, _) = self.poses(dock.time - 1e-9);
            let bond = self.tracks.robot.bonds[dock.bond];
            let at = |port: PortRef| {
                let (link, pose) = self.port(port);
                poses[port.module][link].map(|X| X * pose)
            };
            let (Some(a), Some(b)) = (at(bond.a), at(bond.b)) else { continue };
            let error = (a * self.mate(dock.bond, dock.time)).inverse() * b;
            let kind = self.tracks.robot.module_type(bond.a.module);
            let capture = self.tracks.robot.library.connectors[kind.ports[bond.a.port].connector].capture;
            let (distance, angle) = capture.map_or((1e-3, 1e-2), |c| (c.distance, c.angle));
            if error.translation.vector.norm() > distance + SLACK || error.rotation.angle() > angle + SLACK {
                found.push(format!("at {} ports are {} apart", dock.time, error.translation.vector.norm()));
            }
        }
    }
}

/// A truss: lengths, rates, distances, ground.
fn truss(plan: &Plan, paths: &NodePaths, found: &mut Vec<String>) {
    let strut = &plan.library.struts[paths.strut];
    let obstacles: Vec<Solid> =
        paths.surroundings.obstacles.iter().filter_map(|o| Solid::new(o).ok()).collect();
    for pair in paths.keyframes.windows(2) {
        let place = |part: f64| -> Vec<Vec3> {
            let from = pair[0].nodes.iter().map(|p| Vec3::from(*p));
            match pair[1].interpolation {
                Interpolation::Linear => {
                    from.zip(&pair[1].nodes).map(|(a, b)| a + (Vec3::from(*b) - a) * part).collect()
                }
                Interpolation::RigidRoll { edge: (a, b), angle } => {
                    let (origin, end) = (Vec3::from(pair[0].nodes[a]), Vec3::from(pair[0].nodes[b]));
                    let turn = turned(end - origin, angle * part);
                    from.map(|p| origin + turn.rotation * (p - origin)).collect()
                }
            }
        };
        let seconds = pair[1].time - pair[0].time;
        let last = place(1.0);
        if last.iter().zip(&pair[1].nodes).any(|(a, b)| (a - Vec3::from(*b)).norm() > SLACK) {
            found.push(format!("at {} it is elsewhere", pair[1].time));
        }
        let mut before: Option<Vec<f64>> = None;
        for k in 0..=8 {
            let x = place(f64::from(k) / 8.0);
            let lengths: Vec<f64> = paths.struts.iter().map(|&(a, b)| (x[a] - x[b]).norm()).collect();
            let (low, high) = strut.length;
            if lengths.iter().any(|l| !(low - SLACK..=high + SLACK).contains(l)) {
                found.push(format!("at {} a strut is too short or too long", pair[0].time));
            }
            if let Some(before) = &before {
                let rate = lengths
                    .iter()
                    .zip(before)
                    .map(|(a, b)| (a - b).abs() * 8.0 / seconds)
                    .fold(0.0, f64::max);
                if rate > strut.speed * (1.0 + SLACK) {
                    found.push(format!("at {} a strut is too fast", pair[0].time));
                }
            }
            before = Some(lengths);
            for (i, &(a, b)) in paths.struts.iter().enumerate() {
                for &(c, d) in &paths.struts[i + 1..] {
                    let shared = [a, b].iter().any(|n| [c, d].contains(n));
                    if !shared
                        && segment_segment_distance((x[a], x[b]), (x[c], x[d])) < strut.clearance - SLACK
                    {
                        found.push(format!("at {} struts are too near", pair[0].time));
                    }
                }
                let rod = Part::points(&[x[a], x[b]]);
                let clear = |solid: &Solid| {
                    let apart = solid.parts.iter().map(|part| {
                        modl::geometry::distance::signed_distance(&rod, part, &Pose::identity()).distance
                    });
                    apart.fold(f64::INFINITY, f64::min) >= strut.clearance - SLACK
                };
                if !obstacles.iter().all(clear) {
                    found.push(format!("at {} a strut is too near an obstacle", pair[0].time));
                }
            }
            let floor = world(plan, pair[0].time).has_floor() && paths.surroundings.terrain.is_none();
            if floor && x.iter().any(|p| p.z < -SLACK) {
                found.push(format!("at {} a node is in the ground", pair[0].time));
            }
            if floor
                && world(plan, pair[0].time).gravity > 0.0
                && pair[1].interpolation == Interpolation::Linear
            {
                stands(&x, paths, pair[0].time, found);
            }
        }
    }
}

/// The centre of mass is not beyond all nodes on the ground, in any direction.
fn stands(x: &[Vec3], paths: &NodePaths, t: f64, found: &mut Vec<String>) {
    let ends: Vec<usize> = paths.struts.iter().flat_map(|&(a, b)| [a, b]).collect();
    let centre: Vec3 = ends.iter().map(|&n| x[n]).sum::<Vec3>() / ends.len() as f64;
    let feet: Vec<&Vec3> = x.iter().filter(|p| p.z < 1e-2).collect();
    for k in 0..64 {
        let (s, c) = libm::sincos(TAU * f64::from(k) / 64.0);
        let beyond = |p: &Vec3| c * (p.x - centre.x) + s * (p.y - centre.y);
        if feet.iter().map(|p| beyond(p)).fold(f64::NEG_INFINITY, f64::max) < -1e-2 {
            found.push(format!("at {t} it falls over"));
            return;
        }
    }
}
