//! Unwinding: plans from the planner before the judge, and replayed a second time with arithmetic of
//! their own; what is refused; plans that are spoilt.
#![allow(non_snake_case)]

use crate::desk::{run, run_clean};
use crate::suite::MapFiles;
use modl::interpret::Mode;
use modl::plan::{self, Body, DockKind, Plan, Tracks};
use modl::source::code;
use std::f64::consts::{FRAC_PI_2, PI};

/// Shapes that are no snake, with what they are made of.
const SHAPES: &str = "
use std.rofi.{Rofi, Snake, Ring}

/// A middle with legs at its sides.
config Star(length: Int = 2) {
  part middle: Rofi
  part leg[4]: Snake(n: length)
  connect middle.a_plus_x -- leg[0].head
  connect middle.a_minus_x -- leg[1].head turn 90deg
  connect middle.b_plus_x -- leg[2].head turn 180deg
  connect middle.b_minus_x -- leg[3].head
}

/// Modules side by side, each held by the next at its sides.
config Raft(n: Int = 4) {
  part m[n]: Rofi
  for i in 0..n - 1 { connect m[i].a_plus_x -- m[i + 1].a_minus_x turn 180deg }
}

/// A ring with a tail: a loop, and a bond between them that is none of a snake.
config Tailed closed {
  part ring: Ring(n: 8)
  part tail: Snake(n: 3)
  connect ring.m[0].a_plus_x -- tail.head turn 90deg
}

/// Two snakes, end to end in a turn that is none of a snake.
config Twisted {
  part a: Snake(n: 3)
  part b: Snake(n: 3)
  connect a.tail -- b.head turn 90deg
}
";

const EXPRESSIONS: [&str; 6] = ["Snake(n: 3)", "Ring(n: 6)", "Star", "Raft", "Tailed", "Twisted"];

fn planned(expression: &str) -> Plan {
    let text = format!("{SHAPES}\nemit(tosnake({expression}), \"p.plan.json\")\n");
    plan::file::read(run_clean(&text).text("p.plan.json")).expect("it was written to be read")
}

fn tracks(plan: &Plan) -> &Tracks {
    let Body::Tracks(tracks) = &plan.body else { panic!("a plan of joints") };
    tracks
}

#[test]
fn shapes_unwind_to_snakes_and_a_second_replay_agrees() {
    for expression in EXPRESSIONS {
        let plan = planned(expression);
        assert!(plan::verify::verify(&plan).ok(), "{expression}");
        let replay = Replay::new(tracks(&plan));
        replay.judge().unwrap_or_else(|fault| panic!("{expression}: {fault}"));
        replay.ends_as_snake().unwrap_or_else(|fault| panic!("{expression}: {fault}"));
    }
}

#[test]
fn the_same_seed_gives_the_same_plan_and_another_seed_a_plan() {
    let text = |seed: u32| {
        let program = format!(
            "{SHAPES}\nlet p = tosnake(Star, seed: {seed})\nemit(p, \"p.plan.json\")\nprint(p.work)\n"
        );
        run_clean(&program)
    };
    assert_eq!(text(3).text("p.plan.json"), text(3).text("p.plan.json"));
    assert_ne!(text(3).printed, text(4).printed, "the search depends on the seed");
}

#[test]
fn what_can_not_be_unwound_is_refused_with_the_reason() {
    let overlapping = "C\nM 0 0 0 0\nM 1 0 90 0\nM 2 0 90 0\nM 3 0 90 0\nM 4 0 90 0\nE 0 B -Z N -Z A 1\n\
                       E 1 B -Z S -Z A 2\nE 2 B -Z S -Z A 3\nE 3 B -Z S -Z A 4\n";
    for (call, wanted, words) in [
        ("tosnake(Star, budget: 500)", code::NO_WAY, "0 of 4 connections were made"),
        ("tosnake(Smores())", code::NOT_COVERED, "no RoFI module"),
        ("tosnake(load(\"x.rofi\"))", code::NO_WAY, "in each other"),
        ("reconfigure(Snake(n: 3), Snake(n: 4))", code::NO_WAY, "3 modules can't become one of 4"),
        ("tosnake(Mixed)", code::NOT_COVERED, "another pitch"),
        ("tosnake(Star, gravity: 50m/s^2)", code::NO_WAY, "under gravity"),
    ] {
        let text = format!(
            "{SHAPES}\nuse std.smores.Smores\nconfig Mixed {{\n  part a: Rofi\n  part b: Rofi(pitch: 50mm)\n  \
             connect a.a_plus_x -- b.a_plus_x\n}}\nprint({call})\n"
        );
        let mut files = MapFiles::of(&text);
        files.0.insert("x.rofi".into(), overlapping.as_bytes().to_vec());
        let (observed, _, _) = run(&files, Mode::Run);
        let errors: Vec<_> = observed.diagnostics.iter().filter(|d| d.code == wanted).collect();
        let [error] = errors[..] else { panic!("{call}: {:?}", observed.diagnostics) };
        assert!(error.message.contains(words), "{call}: {}", error.message);
    }
}

/// The kinds of false plans that are known of other planners, each beside a true twin.
#[test]
fn only_ends_that_are_free_do_not_make_a_plan() {
    let gate = |to: &str| {
        format!(
            "use std.rofi.Rofi
config Gate {{
  part m[2]: Rofi
  part post: Rofi
  connect m[0].b_minus_z -- m[1].a_minus_z
  connect m[0].a_plus_x -- post.a_minus_z turn 90deg
  set m[0].beta = 90deg
  set post.alpha = 90deg
  base m[0]
  behavior swing(to: Angle) = move(m[0].gamma, to: to)
}}
let free = world(ground: off, gravity: off)
print(verify(Gate().swing({to}), world: free).ok)
"
        )
    };
    // From the one side of the post to the other: past it, or the other way round.
    assert_eq!(run_clean(&gate("180deg")).printed, ["false"]);
    assert_eq!(run_clean(&gate("-180deg")).printed, ["true"]);
}

#[test]
fn spoilt_plans_do_not_pass() {
    let plan = planned("Star");
    let spoil = |what: &str, how: &dyn Fn(&mut Tracks)| {
        let mut spoilt = plan.clone();
        let Body::Tracks(tracks) = &mut spoilt.body else { panic!("a plan of joints") };
        how(tracks);
        assert!(!plan::verify::verify(&spoilt).ok(), "{what} passes");
    };
    let first = |kind: DockKind, tracks: &Tracks| {
        tracks.docks.iter().position(|dock| dock.kind == kind).expect("there is one")
    };
    spoil("a dock that does not meet", &|tracks| {
        let dock = first(DockKind::Dock, tracks);
        tracks.docks[dock].time *= 0.5;
    });
    spoil("letting go too early", &|tracks| {
        let dock = first(DockKind::Undock, tracks);
        tracks.docks[dock].time *= 0.5;
        tracks.docks.swap(0, dock);
    });
    spoil("a joint that stays behind", &|tracks| {
        let longest = tracks.tracks.iter_mut().max_by_key(|track| track.segments.len());
        longest.expect("something moves").segments.remove(0);
    });
    spoil("a joint beyond its range", &|tracks| {
        let tilt = tracks.tracks.iter_mut().find(|track| track.joint.0 % 3 == 0).expect("a tilt moves");
        let middle = tilt.segments[0].control.len() / 2;
        tilt.segments[0].control[middle] += 3.0;
    });
}

#[test]
fn a_robot_becomes_another() {
    let printed = run_clean(&format!(
        "{SHAPES}\nuse std.rofi.{{Chair, Spider}}
let p = reconfigure(Star(length: 1), Snake(n: 5))
print(verify(p).ok, p.docks, p.undocks)
let q = tosnake(Chair()) ++ reverse(tosnake(Spider(), seed: 1))
print(verify(q).ok)
// It ends as the second robot: a motion of that robot goes on from there.
config Waving closed {{
  part s: Spider
  behavior wave = move(s.foot[0].gamma, by: 30deg)
}}
let free = world(ground: off, gravity: off)
print(verify(q ++ plan(Waving().wave(), world: free)).ok)
emit(q, \"q.plan.json\")
"
    ));
    assert_eq!(printed.printed, ["true 4 4", "true", "true"]);
    // Its program does what its tracks say, whichever end of a bond it names first.
    let plan = plan::file::read(printed.text("q.plan.json")).expect("it was written to be read");
    assert_eq!(modl::behavior::unfaithful(&plan), None);
}

#[test]
fn what_a_chair_became_crawls() {
    let printed = run_clean(
        "use std.rofi.{Chair, Spider}
let r = verify(reconfigure(Chair(), Spider(), seed: 1) ++ Spider().crawl())
print(r.ok, r.travel > 20mm)
",
    );
    assert_eq!(printed.printed, ["true true"]);
}

#[test]
fn the_shapes_of_the_paper_unwind() {
    for shape in ["Chair", "Spider", "Ball", "Puppy", "Human", "Crab(folded: true)"] {
        let name = shape.split('(').next().unwrap_or(shape);
        let text = format!("use std.rofi.{name}\nemit(tosnake({shape}), \"p.plan.json\")\n");
        let plan = plan::file::read(run_clean(&text).text("p.plan.json")).expect("it was written to be read");
        let replay = Replay::new(tracks(&plan));
        replay.judge().unwrap_or_else(|fault| panic!("{shape}: {fault}"));
        replay.ends_as_snake().unwrap_or_else(|fault| panic!("{shape}: {fault}"));
    }
}

/// A plan replayed with formulas of the RoFI project, in steps of at most a degree.
struct Replay<'a> {
    tracks: &'a Tracks,
}

type Matrix = [[f64; 4]; 4];

impl<'a> Replay<'a> {
    fn new(tracks: &'a Tracks) -> Replay<'a> {
        Replay { tracks }
    }

    /// Positions of a joint, by de Casteljau's construction.
    fn position(&self, joint: usize, t: f64) -> f64 {
        let start = self.tracks.start.joints[joint];
        let Some(track) = self.tracks.tracks.iter().find(|track| track.joint.0 as usize == joint) else {
            return start;
        };
        let Some(segment) = track.segments.iter().rev().find(|s| s.start <= t) else { return start };
        let u = ((t - segment.start) / (segment.end - segment.start)).min(1.0);
        let mut points = segment.control.clone();
        while points.len() > 1 {
            points = points.windows(2).map(|w| w[0] + u * (w[1] - w[0])).collect();
        }
        points[0]
    }

    fn bonds(&self, t: f64, inclusive: bool) -> Vec<bool> {
        let mut bonds = self.tracks.start.bonds.clone();
        for dock in self.tracks.docks.iter().filter(|d| d.time < t || (inclusive && d.time == t)) {
            bonds[dock.bond] = dock.kind == DockKind::Dock;
        }
        bonds
    }

    /// Poses of both shoes of every module in units of the pitch, the first at the origin; an error
    /// where the modules do not hang together, or a bond that holds does not meet.
    fn shoes(&self, t: f64, bonds: &[bool]) -> Result<Vec<Option<Matrix>>, String> {
        let robot = &self.tracks.robot;
        let mut shoes: Vec<Option<Matrix>> = vec![None; 2 * robot.modules.len()];
        let identity = across(0.0, 0.0, 0.0);
        shoes[0] = Some(times(&identity, &inverse(&identity)));
        for _ in 0..2 * shoes.len() {
            for module in 0..robot.modules.len() {
                let [alpha, gamma, beta] = [0, 1, 2].map(|joint| self.position(3 * module + joint, t));
                let X = across(alpha, beta, gamma);
                match (shoes[2 * module], shoes[2 * module + 1]) {
                    (Some(a), None) => shoes[2 * module + 1] = Some(times(&a, &X)),
                    (None, Some(b)) => shoes[2 * module] = Some(times(&b, &inverse(&X))),
                    _ => {}
                }
            }
            for (bond, _) in robot.bonds.iter().zip(bonds).filter(|(_, holds)| **holds) {
                let (from, to, X) = self.mate(bond);
                match (shoes[from], shoes[to]) {
                    (Some(a), None) => shoes[to] = Some(times(&a, &X)),
                    (None, Some(b)) => shoes[from] = Some(times(&b, &inverse(&X))),
                    _ => {}
                }
            }
        }
        if shoes.iter().any(Option::is_none) {
            return Err(format!("at {t} it is in pieces"));
        }
        for (bond, _) in robot.bonds.iter().zip(bonds).filter(|(_, holds)| **holds) {
            let (from, to, X) = self.mate(bond);
            let (Some(a), Some(b)) = (shoes[from], shoes[to]) else { continue };
            let wanted = times(&a, &X);
            let missing = (0..16).map(|i| (wanted[i / 4][i % 4] - b[i / 4][i % 4]).abs()).fold(0.0, f64::max);
            if missing > 1e-6 {
                return Err(format!("at {t} docks are {missing} apart"));
            }
        }
        Ok(shoes)
    }

    /// The shoes of a bond, and the pose of the second against the first.
    fn mate(&self, bond: &modl::robot::Bond) -> (usize, usize, Matrix) {
        let robot = &self.tracks.robot;
        let shoe = |port: modl::robot::PortRef| {
            let name = &robot.module_type(port.module).ports[port.port].name;
            (2 * port.module + usize::from(name.starts_with('b')), face(&name[2..]))
        };
        let ((from, F), (to, G)) = (shoe(bond.a), shoe(bond.b));
        let quarter = about_z(FRAC_PI_2 * f64::from(bond.turn));
        let X = times(&times(&times(&F, &quarter), &shift(-1.0)), &times(&about_x(PI), &inverse(&G)));
        (from, to, X)
    }

    /// Walks through the whole plan.
    fn judge(&self) -> Result<(), String> {
        let mut instants: Vec<f64> = self.tracks.instants();
        instants.dedup();
        for ends in instants.windows(2) {
            let farthest = (0..self.tracks.start.joints.len())
                .map(|joint| (self.position(joint, ends[1]) - self.position(joint, ends[0])).abs())
                .fold(0.0, f64::max);
            // Smooth motions are up to twice as fast as on average.
            let steps = (2.0 * farthest.to_degrees()).ceil().max(1.0) as usize;
            let bonds = self.bonds(ends[0], true);
            for step in 0..=steps {
                let t = ends[0] + (ends[1] - ends[0]) * step as f64 / steps as f64;
                self.state(t, &bonds)?;
            }
            // At the instant of docking both the old and the new bonds meet.
            let mut both = self.bonds(ends[1], false);
            for dock in self.tracks.docks.iter().filter(|d| d.time == ends[1] && d.kind == DockKind::Dock) {
                both[dock.bond] = true;
            }
            self.state(ends[1], &both)?;
        }
        Ok(())
    }

    fn state(&self, t: f64, bonds: &[bool]) -> Result<(), String> {
        for module in 0..self.tracks.robot.modules.len() {
            for tilt in [3 * module, 3 * module + 2] {
                if self.position(tilt, t).abs() > FRAC_PI_2 + 1e-9 {
                    return Err(format!("at {t} a tilt is beyond its range"));
                }
            }
        }
        let centres: Vec<[f64; 3]> = self
            .shoes(t, bonds)?
            .into_iter()
            .flatten()
            .map(|shoe| [shoe[0][3], shoe[1][3], shoe[2][3]])
            .collect();
        for (i, a) in centres.iter().enumerate() {
            for b in &centres[i + 1..] {
                let squared: f64 = (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum();
                if squared < 0.999 * 0.999 {
                    return Err(format!("at {t} balls are {} apart", squared.sqrt()));
                }
            }
        }
        Ok(())
    }

    /// One chain of all modules over red docks in orientation N, straight.
    fn ends_as_snake(&self) -> Result<(), String> {
        let (robot, end) = (&self.tracks.robot, self.tracks.duration);
        let holding = self.bonds(end, true);
        let held: Vec<_> = robot.bonds.iter().zip(&holding).filter(|(_, h)| **h).map(|(b, _)| b).collect();
        if held.len() + 1 != robot.modules.len() {
            return Err(format!("{} bonds hold in the end", held.len()));
        }
        for bond in held {
            let red = [bond.a, bond.b]
                .iter()
                .all(|port| robot.module_type(port.module).ports[port.port].name.ends_with("minus_z"));
            if !red || bond.turn != 0 {
                return Err("a bond is none of a snake".into());
            }
        }
        let bent = (0..self.tracks.start.joints.len()).find(|&joint| {
            let turns = self.position(joint, end) / (2.0 * PI);
            (turns - turns.round()).abs() > 1e-9 || (joint % 3 != 1 && turns.abs() > 1e-9)
        });
        bent.map_or(Ok(()), |joint| Err(format!("joint {joint} is not straight in the end")))
    }
}

fn across(alpha: f64, beta: f64, gamma: f64) -> Matrix {
    let half = [[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let first = times(&about_x(alpha), &about_z(gamma));
    times(&times(&first, &shift(1.0)), &times(&half, &about_x(-beta)))
}

fn about_x(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn about_z(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn shift(z: f64) -> Matrix {
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
}

/// RoFI's frame of a dock.
fn face(name: &str) -> Matrix {
    match name {
        "plus_x" => {
            [[0.0, 0.0, -1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        }
        "minus_x" => {
            [[0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        }
        _ => about_x(0.0),
    }
}

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let cell = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cell(i, j)))
}

fn inverse(a: &Matrix) -> Matrix {
    let back = |i: usize| -> f64 { -(0..3).map(|k| a[k][i] * a[k][3]).sum::<f64>() };
    let row = |i: usize| [a[0][i], a[1][i], a[2][i], back(i)];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}
