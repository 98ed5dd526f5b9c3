//! Unwinding: plans from the planner before the judge, and replayed a second time with arithmetic of
//! their own; what is refused; plans that are spoilt.

use crate::support::desk::{run, run_clean};
use crate::support::properties::whole;
use crate::support::replay::Replay;
use crate::support::suite::MapFiles;
use modl::geometry::Vec3;
use modl::geometry::rigid_transform::{rotation_x, rotation_z};
use modl::interpret::Mode;
use modl::optimize::random::SplitMix64;
use modl::plan::{self, Body, DockingKind, Plan, Tracks};
use modl::planners::tosnake::robot::across;
use modl::source::code;
use nalgebra::Matrix3;

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

pub fn tracks(plan: &Plan) -> &Tracks {
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
        ("tosnake(Smores(), gravity: on)", code::NOT_COVERED, "no RoFI module"),
        ("tosnake(load(\"x.rofi\"))", code::NO_WAY, "in each other"),
        ("reconfigure(Snake(n: 3), Snake(n: 4))", code::NO_WAY, "3 modules can't become one of 4"),
        ("tosnake(Mixed, gravity: on)", code::NOT_COVERED, "another pitch"),
        ("tosnake(Star, gravity: 200m/s^2)", code::NO_WAY, "too heavy: "),
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
let free = world(ground: off, gravity: off, dynamics: statics)
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
    let first = |kind: DockingKind, tracks: &Tracks| {
        tracks.events.iter().position(|dock| dock.kind == kind).expect("there is one")
    };
    spoil("a dock that does not meet", &|tracks| {
        let dock = first(DockingKind::Dock, tracks);
        tracks.events[dock].time *= 0.5;
    });
    spoil("letting go too early", &|tracks| {
        let dock = first(DockingKind::Undock, tracks);
        tracks.events[dock].time *= 0.5;
        tracks.events.swap(0, dock);
    });
    spoil("a joint that stays behind", &|tracks| {
        let longest = tracks.tracks.iter_mut().max_by_key(|track| track.segments.len());
        longest.expect("something moves").segments.remove(0);
    });
    spoil("a robot that lacks a module", &|tracks| {
        tracks.robot.modules.pop();
    });
    spoil("a bond that is let go, and nothing else holds", &|tracks| {
        let dock = first(DockingKind::Dock, tracks);
        tracks.events.remove(dock);
    });
    spoil("only ends of moves: whoever is between them", &|tracks| {
        for track in &mut tracks.tracks {
            for segment in &mut track.segments {
                // Half a turn off in the middle, and at the ends where it was.
                let middle = segment.control.len() / 2;
                segment.control[middle] += 20.0;
            }
        }
    });
    spoil("a joint beyond its range", &|tracks| {
        let tilt = tracks.tracks.iter_mut().find(|track| track.joint.0 % 3 == 0).expect("a tilt moves");
        let middle = tilt.segments[0].control.len() / 2;
        tilt.segments[0].control[middle] += 3.0;
    });
}

/// The judge proves motions, whatever they are for. That all modules are in the snake is for the replay.
#[test]
fn a_snake_that_lacks_a_module_is_none() {
    let mut plan = planned("Star");
    let Body::Tracks(tracks) = &mut plan.body else { panic!("a plan of joints") };
    Replay::new(tracks).ends_as_snake().expect("as it was planned");
    let last = |kind: DockingKind, tracks: &Tracks| {
        tracks.events.iter().rposition(|dock| dock.kind == kind).expect("there is one")
    };
    // Before the last leg docked it hung on by another bond, and everything else held as it does in the end.
    let undock = last(DockingKind::Undock, tracks);
    tracks.events.remove(undock);
    let dock = last(DockingKind::Dock, tracks);
    tracks.events.remove(dock);
    assert!(Replay::new(tracks).ends_as_snake().is_err());
}

/// The least number of changes, counted by hand: of bonds that a snake may have all may stay but one of a ring; all others are
/// undocked, and what the snake then lacks of its bonds is docked.
const FEWEST: [(&str, usize, &str); 6] = [
    ("Snake(n: 3)", 0, "the robot is one chain: joints turn alone"),
    (
        "Ring(n: 6)",
        1,
        "a connection that closes a loop goes; one chain is left: no plan changes fewer connections",
    ),
    ("Star", 8, "4 times two chains become one: no plan changes fewer connections"),
    ("Raft", 6, "3 times two chains become one: no plan changes fewer connections"),
    (
        "Tailed",
        3,
        "a connection that closes a loop goes; two chains become one: no plan changes fewer connections",
    ),
    ("Twisted", 2, "two chains become one: no plan changes fewer connections"),
];

#[test]
fn no_plan_changes_fewer_connections_than_the_bound() {
    for (expression, fewest, why) in FEWEST {
        let text = format!(
            "{SHAPES}\nlet p = tosnake({expression})\nprint(p.fewest_changes, p.docks + p.undocks)\nprint(p.why)\n"
        );
        let printed = run_clean(&text).printed;
        assert_eq!(printed, [format!("{fewest} {fewest}"), why.to_owned()], "{expression}");
    }
}

#[test]
fn a_robot_becomes_another() {
    let printed = run_clean(&format!(
        "{SHAPES}\nuse std.rofi.{{Chair, Spider}}
let p = reconfigure(Star(length: 1), Snake(n: 5))
print(verify(p).ok, p.docks + p.undocks >= p.fewest_changes)
let q = tosnake(Chair()) ++ reverse(tosnake(Spider(), seed: 1))
print(verify(q).ok)
// It ends as the second robot: a motion of that robot goes on from there.
config Waving closed {{
  part s: Spider
  behavior wave = move(s.foot[0].gamma, by: 30deg)
}}
let free = world(ground: off, gravity: off, dynamics: statics)
print(verify(q ++ plan(Waving().wave(), world: free)).ok)
emit(q, \"q.plan.json\")
"
    ));
    assert_eq!(printed.printed, ["true true", "true", "true"]);
    // Its program does what its tracks say, whichever end of a bond it names first.
    let plan = plan::file::read(printed.text("q.plan.json")).expect("it was written to be read");
    assert_eq!(modl::behavior::unfaithful(&plan), None);
}

#[test]
fn what_a_chair_became_crawls() {
    let printed = run_clean(
        "use std.rofi.{Chair, Spider}
let crawl = plan(Spider().crawl(), world: world(dynamics: statics))
let r = verify(reconfigure(Chair(), Spider(), seed: 1) ++ crawl)
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

/// Random tangles, the number of actions and the seed by their size: what comes out is judged by the replay, and not by the planner.
#[test]
fn tangles_of_every_size_unwind_and_a_second_replay_agrees() {
    let sizes: &[u32] = match whole() {
        true => &[5, 8, 12, 17, 25, 36, 50, 60, 75, 90, 110, 130, 150, 175, 200],
        false => &[5, 8, 12, 17, 25, 36, 50],
    };
    for size in sizes {
        let actions = if size % 2 == 0 { 1000 } else { 6000 };
        let text = format!(
            "use std.rofi.tangle\nemit(tosnake(tangle({size}, {actions}, seed: {size})), \"p.plan.json\")\n"
        );
        let plan = plan::file::read(run_clean(&text).text("p.plan.json")).expect("it was written to be read");
        let replay = Replay::new(tracks(&plan));
        replay.judge().unwrap_or_else(|fault| panic!("{size} modules: {fault}"));
        replay.ends_as_snake().unwrap_or_else(|fault| panic!("{size} modules: {fault}"));
    }
}

/// Two chains of three modules, end to end with a turn, as an assembly made in Rust.
fn twisted(turn: &str) -> (modl::robot::Assembly, modl::robot::State) {
    let modules: String = (0..6).map(|id| format!("M {id} 0 0 0\n")).collect();
    let edge = |i: usize| format!("E {i} B -Z {} -Z A {}\n", if i == 2 { turn } else { "N" }, i + 1);
    let edges: String = (0..5).map(edge).collect();
    let world = modl::robot::rofi::read(&format!("C\n{modules}{edges}")).expect("it is a configuration");
    modl::robot::rofi_assembly::assembly(&world, 0.1)
}

/// An observer that ends every search.
struct Impatient;

impl modl::planners::Progress for Impatient {
    fn report(&mut self, _: &dyn Fn() -> String) {}

    fn should_continue(&mut self) -> bool {
        false
    }
}

#[test]
fn rust_calls_the_planners_without_the_language() {
    use modl::plan::World;
    use modl::planners::{NoProgress, reconfigure, tosnake};
    let ((east, start), (west, goal)) = (twisted("E"), twisted("W"));
    let problem = tosnake::Problem { robot: &east, start: &start, world: World::FREE };
    let settings = tosnake::Settings::default();
    let found = tosnake::plan(&problem, &settings, &mut NoProgress).expect("the tests unwind it, too");
    assert_eq!((found.report.docks, found.report.undocks), (1, 1));
    assert!(found.body.duration() > 0.0 && found.program.is_some());

    let refused = tosnake::plan(&problem, &settings, &mut Impatient).expect_err("nobody waits");
    assert!(matches!(refused, tosnake::Refusal::Stopped(_)), "{refused}");
    let poor = tosnake::Settings { budget: 0, ..settings };
    let refused = tosnake::plan(&problem, &poor, &mut NoProgress).expect_err("nothing may be worked out");
    assert!(matches!(refused, tosnake::Refusal::BudgetSpent(_)), "{refused}");
    // A level arm of six modules is too heavy before anything moves.
    let level = modl::geometry::pose::turned(modl::geometry::Vec3::x(), std::f64::consts::FRAC_PI_2);
    let level = modl::robot::State { base: level, ..start.clone() };
    let heavy = tosnake::Problem { start: &level, world: World::default(), ..problem };
    let refused = tosnake::plan(&heavy, &settings, &mut NoProgress).expect_err("joints are overloaded");
    let tosnake::Refusal::Overload(overload) = refused else { panic!("{refused}") };
    assert_eq!(overload.operation, tosnake::Operation::HoldingStart);

    let from = reconfigure::Configuration { robot: &east, state: &start };
    let to = reconfigure::Configuration { robot: &west, state: &goal };
    let problem = reconfigure::Problem { from, to, world: World::FREE };
    let both =
        reconfigure::plan(&problem, &reconfigure::Settings::default(), &mut NoProgress).expect("both unwind");
    // Either chain stays as it is: the bond between them is docked elsewhere, then undocked where it was.
    assert_eq!((both.report.both.docks, both.report.both.undocks), (1, 1));
    assert_eq!(both.report.fewest_changes, 2);
    assert!(both.report.verdict.is_none() && !both.report.history.is_empty());
}

#[test]
fn a_cache_has_no_plan_for_other_settings() {
    use modl::plan::World;
    use modl::planners::NoProgress;
    use modl::planners::tosnake::{self, SearchCache, Settings, inverse_kinematics};
    let (robot, start) = twisted("E");
    let problem = tosnake::Problem { robot: &robot, start: &start, world: World::FREE };
    let mut cache = SearchCache::default();
    let settings = Settings { budget: 20_000, ..Settings::default() };
    let mut unwound =
        |settings: &Settings| tosnake::plan_with_cache(&problem, settings, &mut cache, &mut NoProgress);
    let found = unwound(&settings).expect("it unwinds").report;
    let again = Settings { threads: 2, ..settings };
    assert_eq!(unwound(&again).expect("threads change nothing").report, found);
    // Without iterations no loop ever closes.
    let iterations_max = 0;
    let idle = inverse_kinematics::Settings { iterations_max, ..settings.inverse_kinematics };
    let refused = unwound(&Settings { inverse_kinematics: idle, ..settings }).expect_err("nothing meets");
    assert!(matches!(refused, tosnake::Refusal::BudgetSpent(_)), "{refused}");
}

#[test]
fn a_shoe_is_where_the_turns_between_it_and_the_other_take_it() {
    let half_turn = Matrix3::new(-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0);
    let mut numbers = SplitMix64(7);
    for _ in 0..1000 {
        let [near, far, gamma] = std::array::from_fn(|_| 4.0 * numbers.next_signed());
        let pose = across(near, far, gamma);
        let tilt = rotation_x(near);
        let rotation = tilt * rotation_z(gamma) * half_turn * rotation_x(-far);
        assert!((pose.rotation - rotation).amax() < 1e-15);
        assert!((pose.translation - tilt * Vec3::z()).amax() < 1e-15);
    }
}
