//! Loads of short moves: velocities and accelerations are means over a quarter of their time, and loads are found at instants
//! within them. Two arms turn about vertical axes on a base that is held, so that a motor gives the inertia of its arm times
//! the mean acceleration.

use crate::support::dense_model::recorded;
use crate::support::desk::run_clean;
use modl::plan::verify::articulated::{Detail, instants};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Plan, Status, Track, Tracks};

/// Two balls of 1 kg and 20 mm radius, 300 mm from their axes.
fn plan(behavior: &str) -> Plan {
    let program = format!(
        "module Arms {{
           link base = box(100mm, 100mm, 50mm, mass: 3kg)
           link near = sphere(20mm, mass: 1kg) at [300mm, 0mm, 0mm]
           link far = sphere(20mm, mass: 1kg) at [-300mm, 0mm, 0mm]
           joint a : base -> near = revolute(axis: Z, max_torque: 500N*m)
           joint b : base -> far = revolute(axis: Z)
         }}
         let arms = Arms()
         emit(plan({behavior}, world: world(ground: held, dynamics: full)), \"p.json\")
"
    );
    run_clean(&program).plan("p.json")
}

/// The moment of inertia of an arm about its axis, kg·m²: that of a ball and what its distance adds.
const INERTIA: f64 = 0.3 * 0.3 + 0.4 * 0.02 * 0.02;

/// The greatest duration of a short move, and the window of others, s.
const SHORT: f64 = 0.2;
const WINDOW: f64 = 0.05;

fn tracks(plan: &Plan) -> &Tracks {
    plan.body.tracks().expect("arms")
}

/// Returns the mean acceleration of a joint over a window about a time.
fn mean(track: &Track, t: f64, window: f64) -> f64 {
    let rate = |t: f64| if t < 0.0 { 0.0 } else { track.velocity(t) };
    (rate(t + window / 2.0) - rate(t - window / 2.0)) / window
}

/// Compares the efforts of both joints at these times with the closed form; `moves`: begin and end of each move, s.
fn compare(plan: &Plan, times: &[f64], moves: &[(f64, f64)]) {
    let short = |t: f64| {
        let near = moves.iter().filter(|(from, to)| t + WINDOW / 2.0 >= *from && t - WINDOW / 2.0 <= *to);
        let lengths = near.map(|(from, to)| to - from).filter(|length| *length < SHORT);
        lengths.map(|length| length / 4.0).fold(WINDOW, f64::min)
    };
    for found in instants(plan, times, Detail::Loads, None) {
        let window = short(found.time);
        for track in &tracks(plan).tracks {
            let expected = INERTIA * mean(track, found.time, window);
            let effort = found.efforts[track.joint.0 as usize].expect("known");
            assert!(
                (effort - expected).abs() < 1e-7 * (1.0 + expected.abs()),
                "joint {} at {}: {effort} of {expected}",
                track.joint.0,
                found.time
            );
        }
    }
}

/// Returns the instants within a move: seven that divide it into eighths.
fn within((from, to): (f64, f64)) -> Vec<f64> {
    (1..8).map(|k| from + (to - from) * f64::from(k) / 8.0).collect()
}

#[test]
fn windows_are_short_about_short_moves_and_long_elsewhere() {
    let plan =
        plan("Pc(move(arms.b, to: 1rad, in: 2s), Sc(wait(800ms), move(arms.a, to: 0.3rad, in: 100ms)))");
    let moves = [(0.0, 2.0), (0.8, 0.9)];
    let times = recorded(&plan);
    let near = times.iter().filter(|t| (**t - 0.85).abs() < 0.1).count();
    assert!(near >= 10 && times.len() > 50, "{times:?}");
    compare(&plan, &times, &moves);
    compare(&plan, &within(moves[1]), &moves);
    // The verdict tells how many instants it has compared: samples, and those within the short move that are no samples.
    let between =
        within(moves[1]).iter().filter(|t| times.iter().all(|other| (*t - other).abs() > 1e-9)).count();
    let verdict = verify(&plan);
    let torque = verdict.checks.iter().find(|check| check.kind == CheckKind::Torque).expect("it was made");
    assert_eq!(torque.status, Status::Sampled(times.len() + between));
}

#[test]
fn moves_that_overlap_have_the_window_of_the_shorter() {
    let plan = plan(
        "Pc(Sc(wait(200ms), move(arms.a, to: 0.3rad, in: 100ms)), Sc(wait(230ms), move(arms.b, to: -0.4rad, in: 150ms)))",
    );
    let moves = [(0.2, 0.3), (0.23, 0.38)];
    let mut times: Vec<f64> = moves.into_iter().flat_map(within).collect();
    times.sort_by(f64::total_cmp);
    compare(&plan, &times, &moves);
    compare(&plan, &recorded(&plan), &moves);
}

#[test]
fn a_move_in_two_pieces_has_the_loads_of_the_whole() {
    for (length, cut) in [(0.15, 0.05), (0.25, 0.1)] {
        let whole = plan(&format!("Sc(wait(1s), move(arms.a, to: 0.3rad, in: {length}s))"));
        let mut tracks = tracks(&whole).clone();
        let segment = tracks.tracks[0].segments[0].clone();
        let pieces = [(1.0, 1.0 + cut), (1.0 + cut, 1.0 + length)];
        tracks.tracks[0].segments =
            pieces.iter().map(|(from, to)| segment.between(*from, *to).expect("a piece")).collect();
        let parts = Plan { body: tracks.into(), ..whole.clone() };
        let moves = [(1.0, 1.0 + length)];
        compare(&parts, &recorded(&parts), &moves);
        if length < SHORT {
            compare(&parts, &within(moves[0]), &moves);
        }
    }
}

#[test]
fn jumps_of_speed_are_told_with_the_window_by_which_they_are_judged() {
    let whole = plan("Sc(wait(1s), move(arms.a, to: 0.3rad, in: 300ms))");
    let mut tracks = tracks(&whole).clone();
    let segment = tracks.tracks[0].segments[0].clone();
    let piece = |from: f64, to: f64, control: [f64; 2]| modl::plan::Segment {
        start: from,
        end: to,
        control: control.into(),
        ..segment.clone()
    };
    // At 1, at 2, and after a pause at 0 rad/s and back: jumps at the begin, the change, the stop, the begin and the end.
    tracks.tracks[0].segments =
        vec![piece(1.0, 1.1, [0.0, 0.1]), piece(1.1, 1.2, [0.1, 0.3]), piece(1.25, 1.3, [0.3, 0.25])];
    let plan = Plan { body: tracks.into(), ..whole };
    let notes = verify(&plan).notes;
    let wanted = "a changes its speed at once at 1s (and 4 more): its torque is judged as if over 25ms";
    assert!(notes.iter().any(|note| note.contains(wanted)), "{notes:#?}");
}
