//! Robots for the tests, built by plain Rust: the SMORES module and the designs made of it. They
//! depend on nothing of the language, so that rooms can be examined before and beside it.
#![allow(dead_code)]

use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::robot::{
    Assembly, Bond, Capture, Connector, Joint, JointKind, Library, Limits, Link, ModuleInstance, ModuleType,
    Motor, Port, PortRef, Servo, State, Strut,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Half the pitch from face to face.
pub const H: f64 = 0.05;

// Links of the module, in order.
pub const CHASSIS: usize = 0;
pub const BLOCK: usize = 1;
pub const DISC: usize = 2;
pub const LEFT_WHEEL: usize = 3;
pub const RIGHT_WHEEL: usize = 4;

// Joints of the module, in order; joint `j` of module `m` has the id `4 m + j`.
pub const LEFT: usize = 0;
pub const RIGHT: usize = 1;
pub const FRONT: usize = 2;
pub const TILT: usize = 3;

// Ports of the module, in order.
pub const L: usize = 0;
pub const R: usize = 1;
pub const T: usize = 2;
pub const B: usize = 3;

pub fn millimetres(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z) * 1e-3
}

pub fn boxed(lo: Vec3, hi: Vec3) -> Placed {
    Placed { pose: shifted((lo + hi) / 2.0), shape: Shape::Box { size: hi - lo } }
}

pub fn disc(axis: Vec3, from: f64, to: f64, radius: f64) -> Placed {
    let pose = shifted(axis * ((from + to) / 2.0));
    Placed { pose, shape: Shape::Cylinder { radius, length: (to - from).abs(), axis: axis.map(f64::abs) } }
}

pub fn link(name: &str, shape: Vec<Placed>, mass: f64, com: Vec3, friction: f64) -> Link {
    let solid = modl::robot::mass::of_shapes(&shape, 1.0).expect("the tests' shapes are sound");
    let scale = mass / solid.mass;
    Link {
        name: name.into(),
        pose: Pose::identity(),
        collides: shape.clone(),
        left_out: 0.0,
        shape,
        mass,
        com,
        inertia: solid.inertia.map(|i| i * scale),
        friction,
        surface: modl::robot::Surface::default(),
    }
}

/// A joint that a motor drives, of which no facts of a servo are stated; `between`: the links that carry and are carried.
pub fn joint(
    name: &str,
    between: (usize, usize),
    kind: JointKind,
    pose: Pose,
    axis: Vec3,
    limits: Limits,
) -> Joint {
    let ((parent, child), servo) = (between, Servo::default());
    Joint { name: name.into(), parent, child, kind, pose, axis, limits, passive: false, mimic: None, servo }
}

pub fn revolute(
    name: &str,
    parent: usize,
    child: usize,
    axis: Vec3,
    range: Option<(f64, f64)>,
    effort: f64,
) -> Joint {
    let limits = Limits { range, speed: Some(2.4086), acceleration: None, effort: Some(effort) };
    joint(name, (parent, child), JointKind::Revolute, Pose::identity(), axis, limits)
}

fn port(name: &str, link: usize, turn: f64) -> Port {
    let pose = turned(Vec3::z(), turn) * shifted(Vec3::new(H, 0.0, 0.0));
    Port { name: name.into(), link, pose, connector: 0 }
}

/// The SMORES module: chassis frame, +x towards T at zero tilt, +y towards L, +z up.
pub fn smores() -> ModuleType {
    // The side arms of the U-holder are round about the axle, and reach back to its plate.
    let holder = vec![
        boxed(millimetres(-49.2, -42.7, -44.0), millimetres(-44.0, 42.7, 44.0)),
        disc(Vec3::y(), 0.0363, 0.0427, 0.044),
        disc(Vec3::y(), -0.0427, -0.0363, 0.044),
    ];
    let block = vec![boxed(millimetres(-29.7, -36.1, -29.8), millimetres(42.6, 36.1, 29.8))];
    let front = vec![disc(Vec3::x(), 0.0459, 0.0491, 0.042)];
    let left = vec![disc(Vec3::y(), 0.0431, 0.0491, 0.0453)];
    let right = vec![disc(Vec3::y(), -0.0431, -0.0491, 0.0453)];
    let y = Vec3::y();
    let motor = |name: &str, sign: f64| Motor {
        name: name.into(),
        joints: vec![(TILT, 1.0), (FRONT, sign)],
        limits: Limits { speed: Some(2.4086), ..Limits::default() },
    };
    ModuleType {
        name: "Smores".into(),
        links: vec![
            link("chassis", holder, 0.127498, millimetres(-30.7, 0.0, 0.0), 0.35),
            link("block", block, 0.309551, millimetres(8.2, 0.0, 0.0), 0.35),
            link("disc", front, 0.045716, millimetres(43.7, 0.0, 0.0), 0.75),
            link("left_wheel", left, 0.0372637, millimetres(0.0, 45.8, 0.0), 1.0),
            link("right_wheel", right, 0.0372637, millimetres(0.0, -45.8, 0.0), 1.0),
        ],
        joints: vec![
            revolute("left", CHASSIS, LEFT_WHEEL, y, None, 1.2),
            revolute("right", CHASSIS, RIGHT_WHEEL, y, None, 1.2),
            revolute("front", BLOCK, DISC, Vec3::x(), None, 2.3),
            revolute("tilt", CHASSIS, BLOCK, -y, Some((-FRAC_PI_2, FRAC_PI_2)), 2.3),
        ],
        ports: vec![
            port("left", LEFT_WHEEL, FRAC_PI_2),
            port("right", RIGHT_WHEEL, -FRAC_PI_2),
            port("top", DISC, 0.0),
            port("bottom", CHASSIS, PI),
        ],
        motors: vec![motor("a", 1.0), motor("b", -1.0)],
        touching: vec![],
        touch: 1e-4,
        contact: 4e-3,
    }
}

/// Returns a connector that mates with its own kind in one way, and holds whatever pulls.
pub fn face() -> Connector {
    Connector {
        name: "Face".into(),
        mates: vec![0],
        turns: 1,
        holds_force: None,
        holds_moment: None,
        capture: None,
        snaps: false,
        hinge: None,
    }
}

pub fn smores_library() -> Arc<Library> {
    let face = Connector {
        name: "EPFace".into(),
        mates: vec![0],
        turns: 4,
        holds_force: Some(88.4),
        holds_moment: Some(1.9),
        capture: Some(Capture::at_rest(4e-3, 5.0 * PI / 180.0)),
        snaps: false,
        hinge: None,
    };
    Arc::new(Library { connectors: vec![face], modules: vec![smores()], ..Library::default() })
}

/// Puts modules of one kind together by name.
pub struct Design(pub Assembly);

impl Design {
    pub fn new(name: &str, library: Arc<Library>) -> Design {
        let (modules, bonds) = (vec![], vec![]);
        Design(Assembly {
            name: name.into(),
            library,
            modules,
            bonds,
            base: 0,
            closed: false,
            misalignments: vec![],
        })
    }

    pub fn index(&self, module: &str) -> usize {
        self.0.modules.iter().position(|m| m.name == module).expect("a module of this name was added")
    }

    pub fn add(&mut self, name: &str) -> usize {
        self.0.modules.push(ModuleInstance { name: name.into(), kind: 0 });
        self.0.modules.len() - 1
    }

    pub fn connect(&mut self, a: (usize, usize), b: (usize, usize), turn: u32) {
        let port = |(module, port)| PortRef { module, port };
        self.0.bonds.push(Bond { a: port(a), b: port(b), turn });
    }

    /// Adds a row of modules, each with its port `from` docked to port `to` of the next; returns
    /// their indices.
    pub fn row(&mut self, names: &[String], from: usize, to: usize) -> Vec<usize> {
        let row: Vec<usize> = names.iter().map(|n| self.add(n)).collect();
        for pair in row.windows(2) {
            self.connect((pair[0], from), (pair[1], to), 0);
        }
        row
    }

    pub fn based(mut self, module: &str) -> Assembly {
        self.0.base = self.index(module);
        self.0
    }
}

fn numbered(prefix: &str, n: usize) -> Vec<String> {
    (0..n).map(|i| format!("{prefix}{i}")).collect()
}

/// `m0.B – m1.T`, and so on; the base is the middle one.
pub fn chain(n: usize) -> Assembly {
    let mut d = Design::new("Chain", smores_library());
    d.row(&numbered("m", n), B, T);
    d.based(&format!("m{}", (n - 1) / 2))
}

/// The same as [`chain`], its modules named `s0`, `s1`, ...
pub fn snake(n: usize) -> Assembly {
    let mut d = Design::new("Snake", smores_library());
    d.row(&numbered("s", n), B, T);
    d.based(&format!("s{}", (n - 1) / 2))
}

pub fn walk4() -> Assembly {
    let mut d = Design::new("Walk4", smores_library());
    let body = d.row(&numbered("b", 3), B, T);
    for (corner, at) in
        [("fl", (body[0], L)), ("fr", (body[0], R)), ("bl", (body[2], L)), ("br", (body[2], R))]
    {
        let names = ["hip", "knee", "ankle"].map(|part| format!("{corner}_{part}"));
        let leg = d.row(&names, B, T);
        d.connect(at, (leg[0], T), 0);
    }
    d.based("b1")
}

fn add_car(d: &mut Design) {
    let [center, front, back] = ["center", "front", "back"].map(|n| d.add(n));
    d.connect((front, B), (center, T), 0);
    d.connect((center, B), (back, T), 0);
    for (name, at, port) in
        [("fl", (front, L), R), ("fr", (front, R), L), ("bl", (back, L), R), ("br", (back, R), L)]
    {
        let wheel = d.add(name);
        d.connect(at, (wheel, port), 0);
    }
}

pub fn car() -> Assembly {
    let mut d = Design::new("Car", smores_library());
    add_car(&mut d);
    d.based("center")
}

/// A car with an arm of `n` modules `a0`, `a1`, ... at its front: BACKHOE11 has n = 4.
pub fn backhoe(n: usize) -> Assembly {
    let mut d = Design::new("Backhoe", smores_library());
    add_car(&mut d);
    let arm = d.row(&numbered("a", n), T, B);
    let front = d.index("front");
    d.connect((front, T), (arm[0], B), 0);
    d.based("center")
}

/// Twelve modules in a row; with 30° of tilt each, `r11.B` meets `r0.T`, but no bond closes the ring.
pub fn ring12() -> Assembly {
    let mut d = Design::new("Ring12", smores_library());
    d.row(&numbered("r", 12), B, T);
    d.based("r0")
}

/// [`ring12`] with the bond that closes it.
pub fn ring12_closed() -> Assembly {
    let mut ring = ring12();
    let port = |module, port| PortRef { module, port };
    ring.bonds.push(Bond { a: port(11, B), b: port(0, T), turn: 0 });
    ring.closed = true;
    ring
}

/// All joints at zero, every bond holding, the base at the origin.
pub fn at_rest(robot: &Assembly) -> State {
    State {
        joints: vec![0.0; robot.joints().count()],
        bonds: vec![true; robot.bonds.len()],
        base: Pose::identity(),
        clusters: vec![],
        misalignments: vec![],
    }
}

/// A strut that reels out to ten times its shortest length.
pub fn reel() -> Strut {
    let (name, length, clearance) = ("Reel".into(), (0.3, 3.0), 0.1);
    let (acceleration, buckling, node_mass) = (None, None, None);
    Strut { name, length, speed: 0.05, force: 200.0, mass: 1.0, clearance, acceleration, buckling, node_mass }
}
