//! Motions that repeat: a cycle is searched for collisions once, and what differs from it is searched all the same.

use super::collision::{CAUSE, DURATION, agree, judged, plan, rail, random_tracks, segment, smooth};
use crate::support::numbers::Numbers;
use crate::support::robots;
use modl::plan::verify::articulated::Precision;
use modl::plan::verify::articulated::collision::judge;
use modl::plan::{Exemption, ExemptionKind, Segment, Settings, Status, Tracks};

/// Two cubes that come nearer, from 10 mm, and part again, once for each of the distances (m) that they reach, in `period`
/// seconds each.
fn approaches(least: &[f64], period: f64) -> Tracks {
    let cycle = |(i, least): (usize, &f64)| {
        let t = i as f64 * period;
        [smooth(t, t + period / 2.0, 0.01, *least), smooth(t + period / 2.0, t + period, *least, 0.01)]
    };
    let segments = least.iter().enumerate().flat_map(cycle).collect();
    plan(rail(), vec![(0, segments)], least.len() as f64 * period)
}

/// A chain of which the modules tilt to and fro.
fn waving(cycles: usize) -> Tracks {
    let swing = |m: usize| {
        let by = if m.is_multiple_of(2) { 0.5 } else { -0.4 };
        let cycle = |i: usize| {
            let t = i as f64;
            [smooth(t, t + 0.5, -by, by), smooth(t + 0.5, t + 1.0, by, -by)]
        };
        (4 * m + robots::TILT, (0..cycles).flat_map(cycle).collect())
    };
    plan(robots::chain(6), (0..6).map(swing).collect(), cycles as f64)
}

#[test]
fn a_cycle_is_examined_once_however_often_it_is_repeated() {
    let (once, often) = (judged(&waving(1)), judged(&waving(64)));
    assert_eq!((&once.status, &often.status), (&Status::Proved, &Status::Proved));
    let [a, b] = [&once, &often].map(|found| found.clearance.as_ref().expect("many pairs").value);
    assert!((a - b).abs() < 2.1e-5, "{a} and {b}");
    // The halvings that lead to the first cycle are more.
    assert!(often.samples < 2 * once.samples, "{} and {}", once.samples, often.samples);
}

#[test]
fn a_cycle_that_differs_from_the_others_is_examined() {
    // Penetrations below 0.1 mm are a touch.
    let [free, deep] = [0.05e-3, -0.15e-3];
    for period in [1.0, 0.7, 1.0 / 3.0] {
        for odd in 0..7 {
            let mut least = [free; 7];
            least[odd] = deep;
            let found = judged(&approaches(&least, period));
            let [collision] = &found.collisions[..] else { panic!("one collision: {found:?}") };
            let middle = (odd as f64 + 0.5) * period;
            assert!((collision.time - middle).abs() < 0.2 * period, "{odd} of {period} s: {collision:?}");
            assert!((collision.depth + deep).abs() < 2.1e-5, "{odd} of {period} s: {collision:?}");
        }
        let found = judged(&approaches(&[free; 7], period));
        assert_eq!(found.status, Status::Proved);
        let clearance = found.clearance.expect("two links that may not touch");
        let part = (clearance.time / period).fract();
        assert!((clearance.value - free).abs() < 2.1e-5 && (part - 0.5).abs() < 0.1, "{clearance:?}");
    }
}

#[test]
fn a_cycle_of_another_shape_is_no_repetition() {
    // Both times from a place to the same place, the second time through a collision.
    let direct = segment(0.0, 1.0, &[0.01, 0.01]);
    let bent = segment(1.0, 2.0, &[0.01, -0.02, 0.01]);
    let found = judged(&plan(rail(), vec![(0, vec![direct, bent])], 2.0));
    assert_eq!((&found.status, found.collisions.len()), (&Status::Failed, 1));
    assert!(found.collisions[0].time > 1.0, "{found:?}");
}

#[test]
fn an_excused_collision_does_not_excuse_its_repetition() {
    let tracks = approaches(&[-0.005, -0.005, -0.005], 1.0);
    let first = Exemption { kind: ExemptionKind::Collision(None), from: 0.0, to: 1.0, cause: CAUSE };
    let found = judge(&tracks, &Settings::default(), &[first], &Precision::default()).expect("sound shapes");
    let exempt: Vec<(bool, bool)> = found.collisions.iter().map(|c| (c.exempt, c.time < 1.0)).collect();
    assert_eq!((found.status, exempt), (Status::Failed, vec![(true, true), (false, false)]));
}

/// Random motions there and back, several times over, of which one time may differ in one joint: what dense sampling sees is
/// found.
#[test]
fn random_motions_that_repeat_are_judged_as_dense_sampling_judges_them() {
    let samples = 2_400;
    let free = (0..60).filter(|seed| {
        let mut numbers = Numbers(1_000 + seed);
        let mut tracks = random_tracks(&mut numbers);
        let cycles = 2 + numbers.below(3);
        for track in &mut tracks.tracks {
            track.segments = (0..cycles).flat_map(|i| there_and_back(&track.segments, i)).collect();
        }
        tracks.duration = 2.0 * DURATION * cycles as f64;
        let count = tracks.tracks.len();
        if numbers.below(2) == 0 && count > 0 {
            let segments = &mut tracks.tracks[numbers.below(count)].segments;
            let odd = numbers.below(segments.len());
            let degree = segments[odd].control.len() - 1;
            if degree > 1 {
                segments[odd].control[degree / 2] += numbers.between(-3.0, 3.0);
            }
        }
        agree(&tracks, *seed, samples)
    });
    assert!((6..54).contains(&free.count()), "both outcomes occur");
}

/// Returns the segments, then the same backwards, in the time of the cycle of this number.
fn there_and_back(segments: &[Segment], cycle: usize) -> Vec<Segment> {
    let begin = 2.0 * DURATION * cycle as f64;
    let there = segments.iter().map(|s| segment(begin + s.start, begin + s.end, &s.control));
    let back = segments.iter().rev().map(|s| {
        let control: Vec<f64> = s.control.iter().rev().copied().collect();
        let end = begin + 2.0 * DURATION;
        segment(end - s.end, end - s.start, &control)
    });
    there.chain(back).collect()
}
