//! A generator of programs: random robots of SMORES modules with random gaits, some of which can't happen.

use crate::support::numbers::Numbers;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;

/// A robot with a behaviour, as a program.
pub struct Gait {
    /// The kind of the robot, and of its motion.
    pub kind: &'static str,
    /// The program, which leaves the behaviour in `b`.
    pub program: String,
    /// The factor on the friction of every link, without unit.
    pub friction: f64,
}

/// The greatest speed (rad/s) and acceleration (rad/s²) of a joint: a little below the limits of the modules.
const SPEED: f64 = 2.3;
const ACCELERATION: f64 = 11.0;

/// The greatest number of modules of a walker.
const MODULES_MAX: usize = 17;

/// A move of a module's joint to a position, degrees.
type Target = (usize, &'static str, f64);

/// The speed of a module's wheel, rad/s.
type Wheel = (usize, &'static str, f64);

/// The two sides of a module, each with the side of a neighbour that faces it.
const SIDES: [(&str, &str); 2] = [("left", "right"), ("right", "left")];

/// A robot and its motion while they are drawn.
struct Builder {
    n: Numbers,
    /// The type of its modules.
    module: &'static str,
    /// The number of modules so far.
    count: usize,
    /// The masses of boxes, kg.
    loads: Vec<f64>,
    /// The clauses of its declaration.
    clauses: String,
    /// The number of the base module.
    base: usize,
    /// The positions of joints that were set or moved, degrees.
    at: BTreeMap<(usize, &'static str), f64>,
}

impl Builder {
    /// Returns an integer in a range.
    fn int(&mut self, range: Range<usize>) -> usize {
        range.start + self.n.below(range.len())
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.n.between(low, high)
    }

    fn chance(&mut self, p: f64) -> bool {
        self.n.next() < p
    }

    fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// Adds so many modules, bottom to top, and returns their numbers.
    fn chain(&mut self, count: usize) -> Vec<usize> {
        let chain: Vec<usize> = (self.count..self.count + count).collect();
        self.count += count;
        for pair in chain.windows(2) {
            self.connect(pair[0], "bottom", pair[1], "top", 0);
        }
        chain
    }

    fn connect(&mut self, a: usize, port: &str, b: usize, other: &str, turn: usize) {
        let turned = if turn == 0 { String::new() } else { format!(" turn {turn}deg") };
        writeln!(self.clauses, "  connect m[{a}].{port} -- m[{b}].{other}{turned}")
            .expect("a string takes all");
    }

    /// Adds a box of this mass (kg) at a port.
    fn load(&mut self, a: usize, port: &str, mass: f64) {
        let index = self.loads.len();
        writeln!(self.clauses, "  connect m[{a}].{port} -- load{index}.face").expect("a string takes all");
        self.loads.push(mass);
    }

    /// Sets the tilt of a module at the start, degrees.
    fn set_tilt(&mut self, module: usize, degrees: f64) {
        writeln!(self.clauses, "  set m[{module}].tilt = {degrees:.2}deg").expect("a string takes all");
        self.at.insert((module, "tilt"), degrees);
    }

    /// Returns the position of a joint where its last move ends, degrees.
    fn position(&self, module: usize, joint: &'static str) -> f64 {
        self.at.get(&(module, joint)).copied().unwrap_or(0.0)
    }

    /// Returns moves of several joints in one time: the least, and up to `spare` (s) more.
    fn moves(&mut self, targets: &[Target], spare: f64) -> String {
        let mut way: BTreeMap<usize, f64> = BTreeMap::new();
        for &(module, joint, to) in targets {
            // Tilt and pan share two motors, which turn with their sum and difference.
            *way.entry(module).or_default() += (to - self.position(module, joint)).abs().to_radians();
        }
        let farthest = way.values().copied().fold(0.02, f64::max);
        // The greatest speed and acceleration of a quintic from rest to rest.
        let least = (1.875 * farthest / SPEED).max((5.78 * farthest / ACCELERATION).sqrt());
        let time = least + self.between(0.0, spare);
        let mut parts = vec![];
        for &(module, joint, to) in targets {
            self.at.insert((module, joint), to);
            parts.push(format!("move(r.m[{module}].{joint}, to: {to:.2}deg, in: {time:.3}s)"));
        }
        parallel(&parts)
    }

    /// Adds a module at each side of a module, and returns their numbers.
    fn beside(&mut self, module: usize) -> [usize; 2] {
        SIDES.map(|(side, other)| {
            let beside = self.chain(1)[0];
            self.connect(module, side, beside, other, 0);
            beside
        })
    }

    /// Returns the program.
    fn finish(mut self, kind: &'static str, behavior: &str) -> Gait {
        let friction = (self.between(0.3, 1.2) * 1e3).round() / 1e3;
        let face = if self.module == "Smores" { "MagnetFace" } else { "EPFace" };
        let module = self.module;
        let mut program = format!("use std.gaits\nuse std.smores.{{{face}, {module}}}\n");
        if !self.loads.is_empty() {
            // Its lower side is some mm above the ground.
            writeln!(
                program,
                "module Load(mass: Mass) {{\n  link body = box(60mm, 60mm, 60mm, mass: mass, friction: 0.5)\n  \
                 port face : {face} on body at [-30mm, 0mm, 0mm] facing -X up +Z\n}}"
            )
            .expect("a string takes all");
        }
        let parts: String = self.loads.iter().enumerate().fold(String::new(), |mut text, (index, mass)| {
            writeln!(text, "  part load{index}: Load(mass: {mass:.3}kg)").expect("a string takes all");
            text
        });
        let (count, clauses, base) = (self.count, &self.clauses, self.base);
        writeln!(
            program,
            "config Robot {{\n  part m[{count}]: {module}\n{parts}{clauses}  base m[{base}]\n}}\nlet r = Robot()\n\
             let b = {behavior}"
        )
        .expect("a string takes all");
        Gait { kind, program, friction }
    }
}

/// Returns wheels that turn at their speeds for a time, s.
fn spins(wheels: &[Wheel], time: f64) -> String {
    let spin = |(module, joint, speed): &Wheel| {
        format!("spin(r.m[{module}].{joint}, {speed:.3}rad/s, for: {time:.3}s)")
    };
    parallel(&wheels.iter().map(spin).collect::<Vec<_>>())
}

/// Returns the greatest amplitude (degrees) of a wave of a period (s) whose first and last half period have an envelope.
fn amplitude_max(period: f64) -> f64 {
    let rate = std::f64::consts::TAU / period;
    // The envelope adds to speed and acceleration.
    (0.6 * SPEED / rate).min(0.45 * ACCELERATION / (rate * rate)).to_degrees()
}

/// A wave along the tilts of modules.
struct Wave {
    /// The amplitude, degrees, which is cut to [`amplitude_max`].
    amplitude: f64,
    /// The period, s.
    period: f64,
    /// The number of waves along all joints.
    waves: f64,
    /// The number of periods.
    cycles: usize,
}

impl Wave {
    fn along(&self, modules: &[usize]) -> String {
        let list: Vec<String> = modules.iter().map(|m| format!("r.m[{m}].tilt")).collect();
        format!(
            "gaits.wave([{}], amplitude: {:.2}deg, period: {:.2}s, waves: {:.2}, cycles: {})",
            list.join(", "),
            self.amplitude.min(amplitude_max(self.period)),
            self.period,
            self.waves,
            self.cycles
        )
    }
}

fn parallel(parts: &[String]) -> String {
    if let [one] = parts { one.clone() } else { format!("Pc({})", parts.join(", ")) }
}

fn series(parts: &[String]) -> String {
    if let [one] = parts { one.clone() } else { format!("Sc(\n  {},\n)", parts.join(",\n  ")) }
}

/// Returns the random gait of a seed.
pub fn gait(seed: u64) -> Gait {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    (0..4).for_each(|_| {
        numbers.next();
    });
    // The tilt of a SMORES-EP module does not reach 90 degrees, at which legs and arms stand.
    let upright = matches!(seed % 8, 0 | 1 | 6);
    let module = if numbers.below(4) == 0 && !upright { "SmoresEP" } else { "Smores" };
    let b = Builder {
        n: numbers,
        module,
        count: 0,
        loads: vec![],
        clauses: String::new(),
        base: 0,
        at: BTreeMap::new(),
    };
    match seed % 8 {
        0 | 1 => walker(b),
        2 => snake(b),
        3 => car(b),
        4 => inchworm(b),
        5 => cross(b),
        6 => arm_on_car(b),
        _ => gripper(b),
    }
}

/// A spine with 2 to 6 legs of 2 to 4 modules that lift, reach and are put down in turn, and push together.
fn walker(mut b: Builder) -> Gait {
    let legs = b.int(2..7);
    let pairs = legs / 2;
    let length = (2 * pairs - 1).max(2) + usize::from(legs < 4 && b.chance(0.5));
    let most = (MODULES_MAX - length) / legs;
    let per_leg = b.int(2..5).min(most.max(2));
    let spine = b.chain(length);
    b.base = spine[length / 2];
    let mut feet: Vec<(Vec<usize>, f64)> = vec![];
    for index in 0..legs {
        let leg = b.chain(per_leg);
        if index == 2 * pairs {
            // An odd leg is a tail, which does not swing.
            b.connect(spine[length - 1], "bottom", leg[0], "top", 0);
            feet.push((leg, 0.0));
            continue;
        }
        let side = if index % 2 == 0 { "left" } else { "right" };
        b.connect(spine[(index / 2 * 2).min(length - 1)], side, leg[0], "top", 0);
        feet.push((leg, if index % 2 == 0 { -1.0 } else { 1.0 }));
    }
    // Feet stand closer together, or farther apart, than hips.
    let lean = if per_leg > 2 { b.between(-12.0, 25.0) } else { b.between(-20.0, 0.0) };
    for (leg, _) in &feet {
        if per_leg > 2 {
            b.set_tilt(leg[0], -90.0);
            b.set_tilt(leg[1], -lean);
            b.set_tilt(leg[per_leg - 1], lean);
        } else {
            b.set_tilt(leg[0], -90.0 - lean);
            b.set_tilt(leg[1], lean);
        }
    }
    let (swing, bend, spare) = (b.between(5.0, 22.0), b.between(8.0, 35.0), b.between(0.1, 0.9));
    let together = b.int(1..4);
    let mut order: Vec<usize> = (0..legs).collect();
    if together == 2 && legs >= 4 {
        order = vec![0, 3, 1, 2, 4, 5][..legs].to_vec();
    } else if together == 3 && legs == 6 {
        order = vec![0, 3, 4, 1, 2, 5];
    }
    let together = together.min(legs / 2).max(1);
    let spare = spare * (3.0 / legs.div_ceil(together) as f64).min(1.0);
    let mut steps = vec![];
    for group in order.chunks(together) {
        let (mut lift, mut reach, mut plant) = (vec![], vec![], vec![]);
        for (leg, ahead) in group.iter().map(|leg| &feet[*leg]) {
            let last = leg[per_leg - 1];
            let upper = if per_leg > 2 { leg[1] } else { leg[0] };
            let (stands, level) = (b.position(upper, "tilt"), b.position(last, "tilt"));
            let up = if per_leg > 2 { -bend } else { bend };
            lift.extend([(upper, "tilt", stands + up), (last, "tilt", level - up)]);
            plant.extend([(upper, "tilt", stands), (last, "tilt", level)]);
            if *ahead != 0.0 {
                reach.push((leg[0], "front", swing * ahead));
            }
        }
        steps.push(b.moves(&lift, spare));
        if !reach.is_empty() {
            steps.push(b.moves(&reach, spare));
        }
        steps.push(b.moves(&plant, spare));
    }
    // Legs that stepped one by one are pushed back to where they were, or as far behind.
    let behind = if together == 1 && b.chance(0.5) { -swing } else { 0.0 };
    let swinging = feet.iter().filter(|(_, ahead)| *ahead != 0.0);
    let push: Vec<Target> = swinging.map(|(leg, ahead)| (leg[0], "front", behind * ahead)).collect();
    steps.push(b.moves(&push, spare));
    b.finish("walker", &series(&steps))
}

/// A chain of 4 to 12 modules that crawls, undulates, rolls, or bends at random.
fn snake(mut b: Builder) -> Gait {
    let count = b.int(4..13);
    let style = b.int(0..4);
    let chain: Vec<usize> = (0..count).collect();
    b.count = count;
    b.base = count / 2;
    for pair in chain.windows(2) {
        let turn = match style {
            1 | 2 => 90,
            _ => 0,
        };
        b.connect(pair[0], "bottom", pair[1], "top", turn);
    }
    let (even, odd): (Vec<usize>, Vec<usize>) = chain.iter().partition(|m| *m % 2 == 0);
    let (amplitude, period) = (b.between(6.0, 35.0), b.between(1.2, 3.0));
    let cycles = b.int(1..3) + usize::from(period < 2.0);
    let waves = b.sign() * b.between(0.4, count as f64 / 3.0);
    let wave = Wave { amplitude, period, waves, cycles };
    match style {
        0 => b.finish("snake that crawls", &wave.along(&chain)),
        1 => {
            let (low, across) = (b.between(0.0, 8.0), b.between(0.3, 2.0));
            let (across, up) = (Wave { waves: across, ..wave }, Wave { amplitude: low, ..wave });
            b.finish("snake that undulates", &parallel(&[across.along(&even), up.along(&odd)]))
        }
        2 => {
            let amplitude = (amplitude.min(20.0) * b.between(0.4, 1.0)).min(amplitude_max(period));
            b.finish("snake that rolls", &rolling(&chain, amplitude, period, cycles))
        }
        _ => {
            let spare = b.between(0.2, 1.2);
            let bends = b.int(2..4);
            let mut steps = vec![];
            for _ in 0..bends {
                let parts = b.int(1..4);
                let mut targets: Vec<Target> = vec![];
                for _ in 0..parts {
                    let m = b.int(0..count);
                    if targets.iter().all(|(other, ..)| *other != m) {
                        let to = b.between(-amplitude, amplitude);
                        targets.push((m, "tilt", to));
                    }
                }
                steps.push(b.moves(&targets, spare));
            }
            b.finish("snake that bends", &series(&steps))
        }
    }
}

/// Returns the motion of a chain that is bent to an arc whose plane turns about the chain's axis. Neighbours are turned by
/// 90 degrees against each other: their tilts are a quarter of the period apart.
fn rolling(chain: &[usize], amplitude: f64, period: f64, cycles: usize) -> String {
    let end = cycles as f64 * period;
    let follow = |m: &usize| {
        let (ahead, sign) = (90 * (m % 2), if m % 4 < 2 { 1 } else { -1 });
        let envelope = format!("(1 - cos(360deg * min(min(t, {end:.3}s - t) / {period:.2}s, 0.5))) / 2");
        format!(
            "follow(r.m[{m}].tilt, t => {amplitude:.2}deg * {sign} * {envelope} * sin(360deg * t / {period:.2}s + {ahead}deg), \
             for: {end:.3}s)"
        )
    };
    parallel(&chain.iter().map(follow).collect::<Vec<_>>())
}

/// Two to six modules whose wheels turn, in a row or side by side, with loads.
fn car(mut b: Builder) -> Gait {
    let driven = b.int(2..7);
    let in_a_row = b.chance(0.5);
    let speed = b.sign() * b.between(0.5, 2.2);
    let time = b.between(1.5, 3.5);
    let mut wheels = vec![];
    let steer = if b.chance(0.4) { b.between(-0.6, 1.0) } else { 1.0 };
    let spine = if in_a_row {
        let spine = b.chain(driven);
        for m in &spine {
            wheels.extend([(*m, "left", speed), (*m, "right", speed * steer)]);
        }
        spine
    } else {
        // Wheels that are docked to each other turn alike.
        let between = b.int(0..2);
        let spine = b.chain(2 + between);
        let mut axle = vec![spine[0], spine[1 + between]];
        for index in 0..driven.saturating_sub(2) {
            let (side, other) = SIDES[index % 2];
            let wheel = b.chain(1)[0];
            b.connect(axle[index / 2 % 2], side, wheel, other, 0);
            axle.push(wheel);
        }
        for m in axle {
            wheels.extend([(m, "left", speed), (m, "right", speed)]);
        }
        spine
    };
    b.base = spine[spine.len() / 2];
    for (m, port) in [(spine[0], "top"), (spine[spine.len() - 1], "bottom")] {
        if b.chance(0.4) {
            let mass = b.between(0.1, 2.5);
            b.load(m, port, mass);
        }
    }
    let mut steps = vec![spins(&wheels, time)];
    if b.chance(0.5) {
        let back = b.between(-1.0, 0.9);
        let slower: Vec<_> = wheels.iter().map(|(m, joint, v)| (*m, *joint, v * back)).collect();
        let time = b.between(1.0, 2.0);
        steps.push(spins(&slower, time));
    }
    b.finish("car", &series(&steps))
}

/// A chain of 3 to 7 modules that arches and stretches, one end broader in some.
fn inchworm(mut b: Builder) -> Gait {
    let count = b.int(3..8);
    let chain = b.chain(count);
    let middle = count / 2;
    b.base = chain[middle];
    if b.chance(0.4) {
        let end = [chain[0], chain[count - 1]][b.int(0..2)];
        b.beside(end);
    }
    let (arch, spare) = (b.between(10.0, 60.0), b.between(0.1, 1.0));
    let (front, rear) = (b.between(0.2, 1.0), b.between(0.2, 1.0));
    let sign = if b.chance(0.7) { 1.0 } else { -1.0 };
    let up = [
        (chain[middle], "tilt", sign * arch),
        (chain[middle - 1], "tilt", -sign * arch * front),
        (chain[(middle + 1).min(count - 1)], "tilt", -sign * arch * rear),
    ];
    let mut steps = vec![];
    for _ in 0..b.int(1..3) {
        if b.chance(0.5) {
            steps.push(b.moves(&up, spare));
        } else {
            // One joint after the other.
            for target in up {
                steps.push(b.moves(&[target], spare));
            }
        }
        let flat = up.map(|(m, joint, _)| (m, joint, 0.0));
        if b.chance(0.5) {
            steps.push(b.moves(&flat, spare));
        } else {
            steps.push(b.moves(&flat[1..2], spare));
            steps.push(b.moves(&[flat[0], flat[2]], spare));
        }
    }
    b.finish("inchworm", &series(&steps))
}

/// Three or four arms of two modules about a module, whose knees and pans move.
fn cross(mut b: Builder) -> Gait {
    let arms = b.int(3..5);
    let per_arm = b.int(1..3) + usize::from(arms == 3 && b.chance(0.3));
    let middle = b.chain(1)[0];
    b.base = middle;
    let stance = b.between(20.0, if b.module == "Smores" { 88.0 } else { 78.0 });
    let mut inner = vec![];
    for port in &["left", "right", "top", "bottom"][..arms] {
        let arm = b.chain(per_arm);
        b.connect(middle, port, arm[0], "top", 0);
        b.set_tilt(arm[0], -stance);
        if per_arm > 1 && b.chance(0.7) {
            b.set_tilt(arm[per_arm - 1], stance - 90.0);
        }
        inner.push(arm[0]);
    }
    let (amount, spare) = (b.between(4.0, 30.0), b.between(0.1, 1.0));
    let pans = b.chance(0.4);
    let mut steps = vec![];
    for _ in 0..b.int(1..3) {
        let moving = b.int(1..arms + 1);
        let mut there = vec![];
        for m in &inner[..moving] {
            let to =
                (-stance + b.between(-amount, amount)).max(if b.module == "Smores" { -89.0 } else { -79.0 });
            there.push((*m, "tilt", to));
            if pans {
                let to = b.between(-amount, amount);
                there.push((*m, "front", to));
            }
        }
        steps.push(b.moves(&there, spare));
        let back: Vec<_> = there
            .iter()
            .map(|(m, joint, _)| (*m, *joint, if *joint == "tilt" { -stance } else { 0.0 }))
            .collect();
        steps.push(b.moves(&back, spare));
    }
    b.finish("cross", &series(&steps))
}

/// An arm of 2 to 5 modules that stands on a car and moves, while the car drives in some.
fn arm_on_car(mut b: Builder) -> Gait {
    let length = b.int(1..4);
    let spine = b.chain(length);
    b.base = spine[length / 2];
    let mut driven = vec![spine[length - 1]];
    let ends: &[(usize, f64)] =
        if length == 1 { &[(spine[0], 1.0)] } else { &[(spine[0], 0.8), (spine[length - 1], 0.5)] };
    for &(end, part) in ends {
        if part == 1.0 || b.chance(part) {
            driven.push(end);
            driven.extend(b.beside(end));
        }
    }
    driven.sort_unstable();
    driven.dedup();
    let arm = b.int(2..6).max(b.int(2..6));
    let first = b.count;
    b.count += arm;
    b.connect(spine[0], "top", first, "bottom", 0);
    b.set_tilt(first, 90.0);
    for m in first..first + arm - 1 {
        b.connect(m, "top", m + 1, "bottom", 0);
    }
    if b.chance(0.3) {
        let mass = b.between(0.05, 0.5);
        b.load(first + arm - 1, "top", mass);
    }
    let (amount, spare) = (b.between(20.0, 88.0), b.between(0.1, 1.2));
    let mut steps = vec![];
    for _ in 0..b.int(2..5) {
        let mut targets = vec![];
        for m in first + 1..first + arm {
            if b.chance(0.6) {
                let to = b.sign() * b.between(0.2, 1.0) * amount;
                targets.push((m, "tilt", to));
            }
        }
        if targets.is_empty() || b.chance(0.3) {
            let to = b.between(-amount, amount);
            targets.push((first, "front", to));
        }
        steps.push(b.moves(&targets, spare));
    }
    if b.chance(0.4) {
        let (speed, time) = (b.sign() * b.between(0.3, 1.8), b.between(1.0, 2.5));
        let wheels: Vec<Wheel> =
            driven.iter().flat_map(|m| ["left", "right"].map(|wheel| (*m, wheel, speed))).collect();
        let drive = spins(&wheels, time);
        if b.chance(0.5) {
            let whole = series(&steps);
            return b.finish("arm on a car that drives", &parallel(&[whole, drive]));
        }
        steps.push(drive);
    }
    b.finish("arm on a car", &series(&steps))
}

/// Two fingers of 1 to 3 modules beside a body of 1 to 3, which open and close along the ground.
fn gripper(mut b: Builder) -> Gait {
    let length = b.int(1..4);
    let spine = b.chain(length);
    b.base = spine[0];
    let per_finger = b.int(1..4);
    let mut fingers = vec![];
    for (port, turn) in [("left", 90), ("right", 270)] {
        let finger = b.chain(per_finger);
        b.connect(spine[0], port, finger[0], "top", turn);
        fingers.push(finger);
    }
    let (amount, spare) = (b.between(10.0, 75.0), b.between(0.1, 1.2));
    let mut steps = vec![];
    let asymmetric = b.chance(0.3);
    for _ in 0..b.int(1..3) {
        let mut close = vec![];
        for (left, right) in fingers[0].iter().zip(&fingers[1]) {
            let to = b.between(0.2, 1.0) * amount;
            let other = if asymmetric { b.between(-0.3, 1.0) * amount } else { to };
            close.extend([(*left, "tilt", to), (*right, "tilt", other)]);
        }
        steps.push(b.moves(&close, spare));
        if b.chance(0.5) {
            let open: Vec<_> = close.iter().map(|(m, joint, _)| (*m, *joint, 0.0)).collect();
            steps.push(b.moves(&open, spare));
        }
    }
    if length > 1 && b.chance(0.5) {
        // The body's rear drives.
        let (speed, time) = (b.sign() * b.between(0.3, 1.5), b.between(0.8, 2.0));
        let rear = spine[length - 1];
        steps.push(spins(&[(rear, "left", speed), (rear, "right", speed)], time));
    }
    b.finish("gripper", &series(&steps))
}
