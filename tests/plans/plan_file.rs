//! Plan files: nothing is lost, nothing strange is taken in, and the published schema is the truth.

use crate::plans::plan_operations::{plan_of, rolling, squeezing};
use crate::support::lattices::small_cell;
use crate::support::motions::STATICS;
use crate::support::programs::*;
use crate::support::robots::{LEFT, TILT, chain, reel, walk4};
use modl::plan::file::{FileError, read, schema, write};
use modl::plan::{
    Action, Body, CauseId, Change, Check, CheckKind, Command, Compare, Condition, Exemption, ExemptionKind,
    Ground, Node, ObjectiveValue, Otherwise, Plan, Segment, StageEnd, Status, Track, Verdict, World,
    WorldFrom, Worst,
};
use modl::robot::{JointId, Library, PortRef};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

const L: u32 = LEFT as u32;
const T: u32 = TILT as u32;

/// A plan that has something of everything that a file can hold.
fn rich() -> Plan {
    let blocked = until(spinning(L, 2.0, Some(3.0)), angle(L, Compare::GreaterEqual, 1.0), 1);
    let blocked = node(Action { timeout: Some(2.0), otherwise: Otherwise::Node(wait(0.5)), ..blocked });
    let stroke = series(vec![go(T, 0.3, 2), go(T, -0.3, 3)]);
    let cycles = series(vec![
        Arc::new(Node::Approach { body: stroke.clone(), shift: 0.5, cause: CauseId(4) }),
        Arc::new(Node::Phase { body: stroke.clone(), shift: 0.5, cause: CauseId(4) }),
        Arc::new(Node::Stretch { body: stroke.clone(), duration: 9.0, cause: CauseId(4) }),
        repeat(stroke, 3),
    ]);
    let free = Condition::Not(Box::new(Condition::Docked(PortRef { module: 14, port: 3 })));
    let free = Condition::Or(Box::new(free), Box::new(angle(L, Compare::Less, 0.1)));
    let last = node(until(Command::Wait { duration: 1.0 }, free, 5));
    let kind = ExemptionKind::Collision(Some((0, 1)));
    let excused = Arc::new(Node::Exempt { body: cycles, kind, cause: CauseId(6) });
    let undock = act(Command::Undock { port: PortRef { module: 14, port: 2 } }, 7);
    let program = series(vec![blocked, excused, last, undock]);
    let mut plan = plan_of(plan(walk4(), program).expect("it can be scheduled"));
    plan.causes[3].caller = Some(Box::new(plan.causes[4].clone()));
    plan.causes[3].text = "move(\"\u{e9}\\\n\u{1f916}\")".into();
    plan.provenance.seed = Some(u64::MAX);
    plan.provenance.bound = Some(ObjectiveValue::FoldingEnergy(0.1));
    plan.provenance.reached = Some(ObjectiveValue::FoldingEnergy(0.1 + 0.2));
    plan.provenance.sources = vec![("a.mod".into(), "00ff".into())];
    let joined =
        Change::Joined { at: 1.0, renamed: vec![("a".into(), "b".into())], appended: vec![Change::Reversed] };
    plan.provenance.history = vec![joined, Change::ProgramDropped("why".into())];
    let world = World { ground: Ground::Off, gravity: 0.0, friction: 0.1 + 0.2, ..World::default() };
    plan.worlds.push(WorldFrom { from: 1.0 / 3.0, world });
    plan.exemptions.push(Exemption {
        kind: ExemptionKind::Overload(None),
        from: 0.1,
        to: 0.7,
        cause: CauseId(0),
    });
    let checks = vec![
        Check { kind: CheckKind::Collision, status: Status::Proved },
        Check { kind: CheckKind::Torque, status: Status::NotChecked("no limit".into()) },
        Check { kind: CheckKind::Slip, status: Status::Sampled(17) },
    ];
    let clearance = Some(Worst { value: -0.0, time: 5e-324, at: vec!["m".into()] });
    plan.verdict = Some(Verdict { checks, clearance, duration: f64::MAX, ..Verdict::default() });
    plan
}

fn lattice() -> Plan {
    let mut plan = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    plan.library = Arc::new(Library { cells: vec![small_cell()], ..Library::default() });
    (plan.body, plan.program) = (Body::Stages(squeezing()), None);
    plan.worlds[0].world = STATICS;
    plan
}

fn truss() -> Plan {
    let mut plan = lattice();
    plan.library = Arc::new(Library { struts: vec![reel()], ..Library::default() });
    plan.body = Body::NodePaths(rolling());
    plan
}

fn written(plan: &Plan) -> String {
    write(plan).expect("it can be written")
}

fn refused(text: &str) -> FileError {
    read(text).expect_err("it is refused")
}

#[test]
fn a_plan_that_was_written_is_read_as_it_was() {
    for plan in [rich(), lattice(), truss()] {
        let text = written(&plan);
        let again = read(&text).expect("what was written can be read");
        assert_eq!(again, plan);
        assert_eq!(written(&again), text);
    }
}

#[test]
fn sharing_survives_the_file() {
    let mut body = series(vec![go(T, 0.1, 0)]);
    for _ in 0..60 {
        body = parallel(vec![repeat(body.clone(), 0), series(vec![])]);
        body = series(vec![body.clone(), body]);
    }
    let mut plan = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    plan.program = Some(modl::plan::Program { root: body });
    plan.causes.truncate(1);
    let text = written(&plan);
    assert!(text.len() < 60_000, "{}", text.len());
    assert_eq!(written(&read(&text).expect("it can be read")), text);
}

#[test]
fn every_written_plan_meets_the_published_schema() {
    let validator = jsonschema::validator_for(&schema()).expect("the schema is one");
    for plan in [rich(), lattice(), truss()] {
        let value: serde_json::Value = serde_json::from_str(&written(&plan)).expect("it is JSON");
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{} at {}", e, e.instance_path)).collect();
        assert!(errors.is_empty(), "{errors:?}");
        for field in ["library", "worlds", "body", "causes"] {
            let mut lacking = value.clone();
            lacking.as_object_mut().expect("an object").remove(field);
            assert!(!validator.is_valid(&lacking), "`{field}` is required");
        }
        let mut more = value.clone();
        more.as_object_mut().expect("an object").insert("more".into(), 1.into());
        assert!(!validator.is_valid(&more));
    }
}

#[test]
fn the_published_schema_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/plan.schema.json");
    let text = format!("{}\n", serde_json::to_string_pretty(&schema()).expect("it can be written"));
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(path, &text).expect("the docs can be written");
    }
    let found = std::fs::read_to_string(path).unwrap_or_default();
    assert!(found == text, "docs/plan.schema.json is stale: run the tests with UPDATE_DOCS=1");
}

#[test]
fn faults_of_the_text_have_a_line_and_a_column() {
    let text = written(&rich());
    let broken = text.replacen("\"nominal\": true", "\"nominal\": maybe", 1);
    let line = 1 + text[..text.find("\"nominal\"").expect("it is written")].matches('\n').count();
    assert_eq!(refused(&broken).line, line);
    assert!(refused(&broken).column > 0);
    let unknown = refused(&text.replacen("\"nominal\"", "\"extra\": 1, \"nominal\"", 1));
    assert!(unknown.message.contains("unknown field `extra`"), "{unknown}");
    assert!(refused(&text.replacen("\"duration\": ", "\"duration\": 1e999, \"x\": ", 1)).line > 1);
    assert!(refused("").line <= 1);
    assert_eq!(refused("[]").line, 1);
    assert!(refused("{}").message.contains("no plan file"));
    let past = refused(&text.replacen("\"version\": 2", "\"version\": 1", 1));
    assert!(past.message.contains("plan again with this tool"), "{past}");
    let deep = format!("{{\"format\": {}", "[".repeat(100_000));
    assert!(
        refused(&deep).message.contains("recursion limit") || refused(&deep).message.contains("invalid type")
    );
}

#[test]
fn a_later_version_is_read_unless_it_uses_what_was_added() {
    let text = written(&rich()).replacen("\"version\": 2", "\"version\": 5", 1);
    assert_eq!(read(&text).expect("versions only add fields"), rich());
    let added = refused(&text.replacen("\"nominal\"", "\"added\": 1, \"nominal\"", 1));
    assert!(added.message.contains("unknown field `added`"), "{added}");
    assert!(added.message.contains("version is 5") && added.message.contains("newer modl"), "{added}");
    assert!(added.line > 1);
    let unsaid = refused(&text.replacen("\"version\": 5,", "", 1));
    assert!(unsaid.message.contains("does not say its `version`"), "{unsaid}");
}

/// Whoever reads a bound can rely on its being below what the plan reaches.
#[test]
fn a_bound_above_what_the_plan_reaches_is_refused() {
    let stating = |bound: Option<f64>, reached: Option<f64>| {
        let mut plan = rich();
        plan.provenance.bound = bound.map(ObjectiveValue::FoldingEnergy);
        plan.provenance.reached = reached.map(ObjectiveValue::FoldingEnergy);
        written(&plan)
    };
    for (bound, reached) in
        [(Some(0.1), Some(0.1)), (Some(0.0), Some(1e300)), (None, Some(0.2)), (Some(0.2), None)]
    {
        assert!(read(&stating(bound, reached)).is_ok(), "{bound:?} and {reached:?}");
    }
    let above = refused(&stating(Some(0.0767593), Some(0.0757014)));
    assert!(above.message.contains("a lower bound of 0.0767593, above the 0.0757014"), "{above}");
    let next = f64::from_bits(0.1_f64.to_bits() + 1);
    assert!(refused(&stating(Some(next), Some(0.1))).message.contains("above the 0.1 "));
    for (bound, reached) in [(Some(-1e-9), Some(0.1)), (None, Some(-0.1))] {
        assert!(refused(&stating(bound, reached)).message.contains("neither is below 0"), "{bound:?}");
    }
}

/// The names of a file with one of them changed, by its place in the JSON.
fn renamed(plan: &Plan, place: &str) -> String {
    let mut value: serde_json::Value = serde_json::from_str(&written(plan)).expect("it is JSON");
    *value.pointer_mut(place).unwrap_or_else(|| panic!("{place} is there")) = "another".into();
    value.to_string()
}

#[test]
fn names_that_contradict_their_indices_are_refused() {
    let tracks = [
        "/names/connectors/0/mates/0",
        "/names/modules/0/joints/0/parent",
        "/names/modules/0/ports/0/link",
        "/body/tracks/robot/modules/3/kind_name",
        "/body/tracks/robot/joints/5",
        "/body/tracks/robot/bonds/0/name",
        "/body/tracks/robot/bonds/0/b/name",
        "/body/tracks/robot/base_name",
        "/body/tracks/clusters/0/reference",
        "/body/tracks/clusters/0/modules/2",
        "/body/tracks/tracks/1/name",
        "/body/tracks/events/0/name",
        "/body/tracks/events/0/ports/1",
        "/program/nodes/1/action/on/0",
        "/program/nodes/1/action/until_on/0",
    ];
    for place in tracks {
        let error = refused(&renamed(&rich(), place));
        assert!(error.message.contains("`another` stands as the name of"), "{place}: {error}");
    }
    for (plan, place) in [
        (lattice(), "/body/stages/cell_name"),
        (truss(), "/body/node_paths/strut_name"),
        (truss(), "/body/node_paths/strut_ends/1/0"),
    ] {
        assert!(refused(&renamed(&plan, place)).message.contains("`another` stands"), "{place}");
    }
    let mut fewer: serde_json::Value = serde_json::from_str(&written(&rich())).expect("it is JSON");
    let joints = fewer.pointer_mut("/body/tracks/robot/joints").and_then(|j| j.as_array_mut());
    joints.expect("a list").pop();
    assert!(refused(&fewer.to_string()).message.contains("not as many names"));
    let moving = written(&rich()).replacen("\"full\"", "\"kinodynamic\"", 1);
    assert!(refused(&moving).message.contains("judged under `statics`"));
}

/// What an independent reader does who knows no index: positions and bonds at a time, by name.
fn by_names(text: &str, t: f64) -> (BTreeMap<String, f64>, BTreeMap<String, bool>) {
    let value: serde_json::Value = serde_json::from_str(text).expect("it is JSON");
    let tracks = &value["body"]["tracks"];
    let list = |v: &serde_json::Value| v.as_array().expect("a list").clone();
    let name = |v: &serde_json::Value| v.as_str().expect("a name").to_owned();
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    let joints = list(&tracks["robot"]["joints"]);
    let mut positions: BTreeMap<String, f64> =
        joints.iter().zip(list(&tracks["start"]["joints"])).map(|(n, q)| (name(n), number(&q))).collect();
    let bonds = list(&tracks["robot"]["bonds"]);
    let mut holds: BTreeMap<String, bool> = bonds
        .iter()
        .zip(list(&tracks["start"]["bonds"]))
        .map(|(bond, holds)| (name(&bond["name"]), holds.as_bool().expect("a flag")))
        .collect();
    for track in list(&tracks["tracks"]) {
        for segment in list(&track["segments"]).iter().filter(|s| number(&s["start"]) <= t) {
            let (start, end) = (number(&segment["start"]), number(&segment["end"]));
            let control: Vec<f64> = list(&segment["control"]).iter().map(number).collect();
            let u = ((t - start) / (end - start)).min(1.0);
            positions.insert(name(&track["name"]), modl::plan::polynomial::value(&control, u));
        }
    }
    for event in list(&tracks["events"]).iter().filter(|e| number(&e["time"]) <= t) {
        holds.insert(name(&event["name"]), event["kind"] == "dock");
    }
    (positions, holds)
}

#[test]
fn a_reader_who_goes_by_names_finds_the_same_states() {
    let plan = rich();
    let text = written(&plan);
    let tracks = plan.body.tracks().expect("a robot of modules");
    for t in [0.0, 0.7, 2.0, 5.5, tracks.duration] {
        let (positions, holds) = by_names(&text, t);
        let state = tracks.state(t);
        for (joint, owner) in tracks.robot.joints().enumerate() {
            let found = positions[&tracks.robot.joint_name(owner)];
            assert!((found - state.joints[joint]).abs() < 1e-12, "joint {joint} at {t} s");
        }
        for (bond, ends) in tracks.robot.bonds.iter().enumerate() {
            let name = format!("{} -- {}", tracks.robot.port_name(ends.a), tracks.robot.port_name(ends.b));
            assert_eq!(holds[&name], state.bonds[bond], "bond {bond} at {t} s");
        }
    }
}

#[test]
fn what_points_nowhere_is_refused() {
    type Harm = fn(&mut Plan);
    fn tracks(plan: &mut Plan) -> &mut modl::plan::Tracks {
        let Body::Tracks(tracks) = &mut plan.body else { panic!("it is a plan of tracks") };
        tracks
    }
    let harms: [(Harm, &str); 14] = [
        (|p| p.causes.truncate(2), "cause"),
        (|p| tracks(p).robot.base = 99, "module 99"),
        (|p| tracks(p).robot.modules[3].kind = 7, "module type 7"),
        (|p| tracks(p).robot.modules[3].name = "b0".into(), "the name `b0`"),
        (|p| tracks(p).robot.bonds[0].a.port = 4, "port 4"),
        (|p| tracks(p).robot.bonds[0].turn = 4, "turn 4"),
        (|p| tracks(p).start.joints.truncate(3), "joint positions"),
        (|p| tracks(p).tracks[1].joint = JointId(4000), "joint 4000"),
        (|p| tracks(p).tracks[0].segments[0].control[0] = 0.1, "jumps"),
        (|p| tracks(p).tracks[0].segments[0].end = 1e4, "beyond the end"),
        (|p| tracks(p).events[0].bond = 77, "bond 77"),
        (|p| tracks(p).duration = 1e9, "outside"),
        (|p| p.worlds.clear(), "first world"),
        (|p| p.exemptions[0].kind = ExemptionKind::Overload(Some(1000)), "joint 1000"),
    ];
    for (harm, says) in harms {
        let mut plan = rich();
        harm(&mut plan);
        let error = refused(&written(&plan));
        assert!(error.message.contains(says), "{error} should say {says}");
    }
    let text = written(&rich());
    let forward = refused(&text.replacen("\"root\": ", "\"root\": 9", 1));
    assert!(forward.message.contains("no node"), "{forward}");
    let mut odd = lattice();
    let Body::Stages(stages) = &mut odd.body else { panic!("it is a lattice") };
    let StageEnd::Runs(runs) = &mut stages.stages[0].end else { panic!("it states positions") };
    runs[0].first = 3;
    assert!(refused(&written(&odd)).message.contains("cells 3 to 6"));
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut plan = rich();
        plan.worlds[1].from = number;
        assert!(write(&plan).expect_err("JSON has no such number").message.contains("`from`"));
        let mut plan = rich();
        plan.verdict = Some(Verdict { clearance: None, duration: number, ..Verdict::default() });
        assert!(write(&plan).is_err());
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(256))]

    #[test]
    fn numbers_survive_to_the_bit(a in any::<f64>(), b in any::<f64>(), c in any::<f64>()) {
        prop_assume!([a, b, c].iter().all(|x| x.is_finite()));
        let mut plan = lattice();
        plan.verdict = Some(Verdict { travel: [a, b, c], heading: -a, ..Verdict::default() });
        let text = written(&plan);
        let again = read(&text).expect("it can be read");
        let travel = again.verdict.as_ref().expect("it was written").travel;
        prop_assert_eq!(travel.map(f64::to_bits), [a, b, c].map(f64::to_bits));
        prop_assert_eq!(written(&again), text);
    }

    /// A reader meets whatever was made of a file on the way.
    #[test]
    fn garbled_files_are_refused_or_read_but_never_panic(at in 0.0..1.0, put in "[\\[\\]{}0-9,:e.\"-]{0,4}", cut in 0..9_usize) {
        let text = written(&truss());
        let at = (text.len() as f64 * at) as usize;
        let garbled = format!("{}{put}{}", &text[..at], &text[(at + cut).min(text.len())..]);
        if let Ok(plan) = read(&garbled) {
            let _ = plan.body.state(plan.body.duration() / 3.0);
        }
    }
}

#[test]
fn a_hundred_thousand_segments_take_their_size_and_no_more() {
    let mut plan = plan_of(plan(chain(1), wait(60_000.0)).expect("it can be scheduled"));
    let segment = |i: u32| Segment {
        start: f64::from(i) / 2.0,
        end: f64::from(i + 1) / 2.0,
        control: vec![f64::from(i) / 3.0, f64::from(i + 1) / 3.0],
        cause: CauseId(i % 1000),
    };
    let Body::Tracks(tracks) = &mut plan.body else { panic!("it is a plan of tracks") };
    tracks.tracks = vec![Track { joint: JointId(L), segments: (0..100_000).map(segment).collect() }];
    let text = written(&plan);
    assert!(text.len() < 120 * 100_000, "{}", text.len());
    assert_eq!(read(&text).expect("it can be read"), plan);
}
