//! Nodes of trusses that merge and split, before the judge: two towers of six struts each, whose arms meet and part.

use super::truss_plans::*;
use crate::desk::cli::Sandbox;
use modl::plan::file::{read, write};
use modl::plan::{
    CauseId, CheckKind, Keyframe, NodePaths, Plan, Status, TopologyChange, TopologyEvent, Verdict, World,
    joined, reversed, sliced,
};
use nalgebra::{DMatrix, DVector};

/// The nodes of the left tower are 0 to 3, those of the right one 4 to 7; the arms end in 8 and 9.
const G: usize = 8;
const H: usize = 9;

/// Six struts of each tower, six between them, three of each arm.
const STRUTS: [(usize, usize); 24] = [
    (0, 1),
    (0, 2),
    (1, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (4, 5),
    (4, 6),
    (5, 6),
    (4, 7),
    (5, 7),
    (6, 7),
    (1, 5),
    (2, 6),
    (1, 6),
    (3, 5),
    (3, 6),
    (3, 7),
    (G, 1),
    (G, 2),
    (G, 3),
    (H, 5),
    (H, 6),
    (H, 7),
];
/// The struts that H takes along when it splits off: one to the left tower, two to the right one.
const TAKEN: [usize; 3] = [18, 21, 23];

/// Returns the nodes with the ends of the arms there. `lifted`: three of the six feet are that much higher, m.
fn towers(g: Place, h: Place, lifted: f64) -> Vec<Place> {
    let left = [[0.2, 0.0, 0.0], [2.0, -1.0, lifted], [2.0, 1.0, lifted], [1.7, 0.0, 1.4]];
    let right = [[5.8, 0.0, lifted], [4.0, -1.0, 0.0], [4.0, 1.0, 0.0], [4.3, 0.0, 1.4]];
    [&left[..], &right[..], &[g, h]].concat()
}

const MIDDLE: Place = [3.0, 0.0, 2.4];

fn event(time: f64, change: TopologyChange) -> TopologyEvent {
    TopologyEvent { time, change, cause: CauseId(0) }
}

fn merge(time: f64) -> TopologyEvent {
    event(time, TopologyChange::Merge { node: H, into: G })
}

fn split(time: f64, struts: &[usize]) -> TopologyEvent {
    event(time, TopologyChange::Split { node: H, struts: struts.to_vec() })
}

/// Returns a plan of keyframes and events; the causes of events follow those of keyframes.
fn with_events(world: World, keyframes: Vec<Keyframe>, events: &[TopologyEvent]) -> Plan {
    let mut plan = with(plan(world, &STRUTS, keyframes), |paths| paths.events = events.to_vec());
    let first = plan.causes.len() as u32;
    plan = with(plan, |paths| {
        paths.events.iter_mut().zip(first..).for_each(|(event, cause)| event.cause = CauseId(cause));
    });
    let cause = plan.causes[0].clone();
    plan.causes.extend(events.iter().map(|_| cause.clone()));
    of_strut(plan, |strut| strut.acceleration = Some(10.0))
}

/// Returns the keyframes of a reconfiguration: the arms meet at 2 s, rise together till 3 s, and part till 5 s.
fn moves() -> Vec<Keyframe> {
    let even = (0.5, 0.5);
    let risen = [3.0, 0.0, 2.6];
    vec![
        straight(0.0, &towers([2.1, 0.0, 2.4], [3.9, 0.0, 2.4], 0.0)),
        ramped(2.0, even, &towers(MIDDLE, MIDDLE, 0.0)),
        ramped(3.0, even, &towers(risen, risen, 0.0)),
        ramped(5.0, even, &towers([3.0, 0.8, 2.2], [3.0, -0.8, 2.2], 0.0)),
    ]
}

fn reconfiguration() -> Plan {
    with_events(STANDING, moves(), &[merge(2.0), split(3.0, &TAKEN)])
}

fn paths(plan: &Plan) -> &NodePaths {
    plan.body.node_paths().expect("a truss's plan")
}

fn fault(plan: &Plan) -> String {
    modl::plan::validation::check(plan).expect_err("it is refused").to_string()
}

#[test]
fn nodes_merge_and_split_under_weight_and_back() {
    let plan = reconfiguration();
    for (plan, words) in [
        (plan.clone(), ["n9 merges into n8", "n9 splits off n8 with 3 struts"]),
        (reversed(&plan), ["n9 merges into n8", "n9 splits off n8 with 3 struts"]),
    ] {
        let verdict = judged(&plan);
        assert_eq!(verdict.failures, vec![]);
        let told: Vec<&str> = verdict.events.iter().map(|(_, words)| words.as_str()).collect();
        assert_eq!(told, words);
        assert_eq!(status(&verdict, CheckKind::Rest), Status::Proved);
        assert!(matches!(status(&verdict, CheckKind::Rigidity), Status::Sampled(_)));
        assert!(matches!(status(&verdict, CheckKind::StrutLoad), Status::Sampled(_)));
        for part in ["assumed: the passive joints", "not proved: that the last 200mm of struts"] {
            assert!(verdict.notes.iter().any(|note| note.starts_with(part)), "{:?}", verdict.notes);
        }
    }
    // Two arms have three struts each at first, the one node six, and then three each again, other ones.
    let degree = |time: f64, node: usize| {
        let ends = paths(&plan).struts(time);
        ends.iter().filter(|(a, b)| *a == node || *b == node).count()
    };
    assert_eq!([1.0, 2.0, 3.0].map(|time| [degree(time, G), degree(time, H)]), [[3, 3], [6, 0], [3, 3]]);
    let neighbours = |time: f64, node: usize| -> Vec<usize> {
        let ends = paths(&plan).struts(time);
        ends.iter().filter(|(a, _)| *a == node).map(|(_, b)| *b).collect()
    };
    assert_eq!([neighbours(0.0, H), neighbours(5.0, H)], [vec![5, 6, 7], vec![1, 5, 7]]);
    assert_eq!(neighbours(5.0, G), [2, 3, 6]);
}

/// Returns forces that hold a truss on three feet that only push up, and a basis of its self-stresses.
fn holding(plan: &Plan, time: f64) -> (DVector<f64>, DMatrix<f64>) {
    let (paths, nodes) = (paths(plan), paths(plan).state(time));
    let topology = paths.topology(time);
    let (free, struts) = (topology.free_nodes(), &topology.struts);
    let feet: Vec<usize> = free.iter().copied().filter(|&node| nodes[node][2] == 0.0).collect();
    assert_eq!(feet.len(), 3);
    let row = |node: usize| 3 * free.iter().position(|&other| other == node).expect("free");
    let mut balance = DMatrix::zeros(3 * free.len(), struts.len() + feet.len());
    let mut loads = DVector::zeros(3 * free.len());
    for (strut, &(a, b)) in struts.iter().enumerate() {
        let along = minus(nodes[b], nodes[a]).map(|x| x / norm(minus(nodes[b], nodes[a])));
        for k in 0..3 {
            balance[(row(a) + k, strut)] = along[k];
            balance[(row(b) + k, strut)] = -along[k];
        }
        loads[row(a) + 2] += GRAVITY / 2.0;
        loads[row(b) + 2] += GRAVITY / 2.0;
    }
    feet.iter().enumerate().for_each(|(k, &foot)| balance[(row(foot) + 2, struts.len() + k)] = 1.0);
    // A right inverse by normal equations, and the self-stresses by the eigenvectors of the least eigenvalues.
    let square = balance.transpose() * &balance;
    let eigen = square.symmetric_eigen();
    let null: Vec<usize> = (0..eigen.eigenvalues.len()).filter(|&i| eigen.eigenvalues[i] < 1e-10).collect();
    let forces = eigen.eigenvectors.transpose() * (balance.transpose() * &loads);
    let scaled = DVector::from_fn(forces.len(), |i, _| {
        if null.contains(&i) { 0.0 } else { forces[i] / eigen.eigenvalues[i] }
    });
    let found = &eigen.eigenvectors * scaled;
    assert!((&balance * &found - &loads).amax() < 1e-9, "these forces are in equilibrium");
    let stresses = DMatrix::from_fn(struts.len(), null.len(), |i, k| eigen.eigenvectors[(i, null[k])]);
    (found.rows(0, struts.len()).into_owned(), stresses)
}

/// Returns the least greatest force over all self-stresses: at that one as many forces and one more are greatest, so all sets
/// of these are tried.
fn least_greatest((forces, stresses): &(DVector<f64>, DMatrix<f64>)) -> f64 {
    let free = stresses.ncols();
    if free == 0 {
        return forces.amax();
    }
    let mut best = f64::INFINITY;
    let mut set: Vec<usize> = (0..=free).collect();
    loop {
        for signs in 0..1_usize << free {
            // Signs that are all turned around give the same set of equations with the greatest force negative.
            let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
            let matrix =
                DMatrix::from_fn(
                    free + 1,
                    free + 1,
                    |i, k| {
                        if k < free { stresses[(set[i], k)] } else { -sign(i) }
                    },
                );
            let right = DVector::from_fn(free + 1, |i, _| -forces[set[i]]);
            let Some(solved) = matrix.lu().solve(&right) else { continue };
            let all = forces + stresses * solved.rows(0, free);
            if all.amax() <= solved[free].abs() * (1.0 + 1e-9) {
                best = best.min(all.amax());
            }
        }
        // The next set.
        let Some(at) = (0..=free).rev().find(|&k| set[k] + free - k + 1 < forces.len()) else { return best };
        let next = set[at] + 1;
        set.splice(at.., next..next + free + 1 - at);
    }
}

/// Returns a plan in which nothing moves, on three feet that only push, with the events at its only keyframe.
fn poised(events: &[TopologyEvent]) -> Plan {
    const SMOOTH: World = World { friction: 1e-9, ..STANDING };
    with_events(SMOOTH, vec![straight(0.0, &towers(MIDDLE, MIDDLE, 0.3))], events)
}

fn margin(verdict: &Verdict) -> f64 {
    verdict.force_margin.as_ref().expect("told").value
}

#[test]
fn forces_on_both_sides_of_an_event_are_those_of_the_equilibrium() {
    let force = 1e4;
    // The truss as it is after each number of events, without any: a slice that begins after them.
    let after = [vec![], vec![merge(0.0)], vec![merge(0.0), split(0.0, &TAKEN)]].map(|events| {
        let plan = poised(&events);
        let still = sliced(&plan, 0.0, 0.0).expect("it lasts no time");
        assert!(paths(&still).events.is_empty());
        let held = holding(&still, 0.0);
        let least = least_greatest(&held);
        (margin(&judged(&still)), least, held.1.ncols())
    });
    // Maxwell: 24 struts hold ten nodes and no stress, nine nodes and three stresses.
    assert_eq!(after.map(|(.., stresses)| stresses), [0, 3, 0]);
    for (margin, least, _) in after {
        assert!((margin - (1.0 - least / force)).abs() < 1e-6, "{margin}, {least}");
    }
    let [before, merged, parted] = after.map(|(_, least, _)| least);
    assert!(merged < before && merged < parted, "what is redundant may help: {before}, {merged}, {parted}");
    // A plan with events bears what the worst of its sides does.
    for (events, worst) in [
        (vec![merge(0.0)], before.max(merged)),
        (vec![merge(0.0), split(0.0, &TAKEN)], before.max(merged).max(parted)),
    ] {
        let verdict = judged(&poised(&events));
        assert_eq!(verdict.failures, vec![]);
        assert!((margin(&verdict) - (1.0 - worst / force)).abs() < 1e-6, "{worst}");
    }
}

#[test]
fn a_split_after_which_a_strut_bears_too_much_fails_and_is_to_blame() {
    let least = |events: &[TopologyEvent]| {
        let still = sliced(&poised(events), 0.0, 0.0).expect("it lasts no time");
        least_greatest(&holding(&still, 0.0))
    };
    let (merged, parted) = (least(&[merge(0.0)]), least(&[merge(0.0), split(0.0, &TAKEN)]));
    // From the merged state on, so that the forces before it are of no interest.
    let begun = with(poised(&[split(0.0, &TAKEN)]), |paths| {
        paths.merged = vec![(H, G)];
        paths.struts.iter_mut().for_each(|ends| {
            if ends.0 == H {
                ends.0 = G;
            }
        });
    });
    let bears = |force: f64| judged(&of_strut(begun.clone(), |strut| strut.force = force));
    assert_eq!(bears(parted * 1.001).failures, vec![]);
    let verdict = bears((merged + parted) / 2.0);
    let [failure] = &verdict.failures[..] else { panic!("one failure: {:?}", verdict.failures) };
    assert_eq!((failure.kind, failure.time), (CheckKind::StrutLoad, 0.0));
    assert!((failure.value - parted / ((merged + parted) / 2.0)).abs() < 1e-4, "{failure:?}");
    let split = paths(&begun).events[0].cause;
    assert_eq!(failure.blame, vec![split]);
}

#[test]
fn a_node_that_splits_off_with_two_struts_has_no_hold() {
    let verdict = judged(&with_events(STANDING, moves(), &[merge(2.0), split(3.0, &[18, 21])]));
    let lost = of(CheckKind::Stability, &verdict);
    assert!(!lost.is_empty());
    assert_eq!((lost[0].at.as_slice(), lost[0].time), (&["n9".to_owned()][..], 3.0), "{lost:?}");
    assert!(lost[0].message.contains("hold the node n9: its struts lie in one plane"), "{lost:?}");
    let limp = of(CheckKind::Rigidity, &verdict);
    assert!(limp.iter().any(|failure| failure.time == 3.0 && failure.value == 0.0), "{limp:?}");
    // Weightless it falls apart all the same.
    let free = judged(&with_events(FREE, moves(), &[merge(2.0), split(3.0, &[18, 21])]));
    assert!(of(CheckKind::Stability, &free).is_empty());
    assert!(!of(CheckKind::Rigidity, &free).is_empty());
}

#[test]
fn nodes_that_are_a_millimetre_apart_do_not_merge() {
    let apart = |by: f64| {
        let mut keyframes = moves();
        for keyframe in &mut keyframes[1..3] {
            keyframe.nodes[H][1] += by;
        }
        with_events(STANDING, keyframes, &[merge(2.0), split(3.0, &TAKEN)])
    };
    assert_eq!(judged(&apart(0.9e-9)).failures, vec![]);
    assert_eq!(fault(&apart(1e-3)), "at 2 s the node n9 is 1mm from n8, with which it is merged");
    assert!(fault(&apart(1.2e-9)).contains("from n8, with which it is merged"));
    // On the way they stay together, too.
    let mut keyframes = moves();
    let mut between = keyframes[2].clone();
    (between.time, between.nodes[H][0]) = (2.5, 3.001);
    for keyframe in [&mut between, &mut keyframes[2]] {
        (keyframe.ramps.up, keyframe.ramps.down) = (0.25, 0.25);
    }
    keyframes.insert(2, between);
    let strays = with_events(STANDING, keyframes, &[merge(2.0), split(3.0, &TAKEN)]);
    assert_eq!(fault(&strays), "at 2.5 s the node n9 is 1mm from n8, with which it is merged");
}

#[test]
fn a_truss_is_at_rest_where_nodes_merge_and_split() {
    // Each step begins or ends with the rate that it has in its middle.
    for (step, ramps, event, speed) in
        [(1, (0.5, 0.0), 2.0, "just before"), (2, (0.0, 0.5), 2.0, "just after")]
    {
        let mut keyframes = moves();
        (keyframes[step].ramps.up, keyframes[step].ramps.down) = ramps;
        let verdict = judged(&with_events(STANDING, keyframes, &[merge(2.0), split(3.0, &TAKEN)]));
        let moving = of(CheckKind::Rest, &verdict);
        let [failure] = &moving[..] else { panic!("one failure: {:?}", verdict.failures) };
        assert!(failure.message.contains(speed) && failure.time == event, "{failure:?}");
        // The way over the time that is left when half of the ramp is taken away.
        let (way, seconds) = if step == 1 { (0.9, 2.0) } else { (0.2, 1.0) };
        assert!((failure.value - way / (seconds - 0.25)).abs() < 1e-9, "{failure:?}");
        assert_eq!(status(&verdict, CheckKind::Rest), Status::Failed);
    }
    // Struts that state no acceleration stop at once, which is said.
    let mut keyframes = moves();
    keyframes.iter_mut().for_each(|keyframe| (keyframe.ramps.up, keyframe.ramps.down) = (0.0, 0.0));
    let abrupt = with_events(STANDING, keyframes, &[merge(2.0), split(3.0, &TAKEN)]);
    let verdict = judged(&of_strut(abrupt, |strut| strut.acceleration = None));
    assert_eq!(verdict.failures, vec![]);
    assert!(verdict.notes.iter().any(|note| note.contains("stop and start at once")), "{:?}", verdict.notes);
}

/// The arms come together along another way than straight: ends that pass near each other long before they merge, and part
/// again, keep their clearance.
#[test]
fn only_nodes_that_come_nearer_up_to_the_event_may_come_nearer_than_the_clearance() {
    let verdict = |ways: &[(Place, Place)]| {
        let last = ways.len() - 1;
        let keyframes = ways.iter().enumerate().map(|(i, (g, h))| {
            let even = if i == 0 { (0.0, 0.0) } else { (0.5, 0.5) };
            ramped(2.0 * i as f64, even, &towers(*g, *h, 0.0))
        });
        judged(&with_events(STANDING, keyframes.collect(), &[merge(2.0 * last as f64)]))
    };
    let ends = |half: f64| ([3.0 - half, 0.0, 2.4], [3.0 + half, 0.0, 2.4]);
    let near = [ends(0.9), ends(0.02), ends(0.0)];
    assert_eq!(verdict(&near).failures, vec![]);
    // Back a little, and then together.
    let back = [ends(0.9), ends(0.02), ends(0.5), ends(0.0)];
    let met = of(CheckKind::Collision, &verdict(&back));
    assert!(!met.is_empty());
    assert!(met.iter().all(|failure| failure.time < 6.0), "the last approach is one: {met:?}");
    let least = met.iter().map(|failure| failure.value).fold(f64::INFINITY, f64::min);
    assert!((least - 0.04).abs() < 1e-9, "the ends are 4 cm apart: {least}");
}

/// Two struts that meet at an angle: beyond the reach of the joint, twice the clearance, they are as far apart as the sine of
/// the angle says.
#[test]
fn struts_of_nodes_that_merge_are_a_clearance_apart_beyond_the_reach_of_the_joint() {
    // A low joint: its struts to one tower and to the other make a small angle where they lead aside.
    let angle = |height: f64| {
        let arms = [[-1.0, -1.0, -height], [1.0, -1.0, -height]];
        libm::acos(dot(arms[0], arms[1]) / (norm(arms[0]) * norm(arms[1])))
    };
    for (clearance, height) in [(0.1, 2.4), (0.1, 2.7), (0.24, 2.4), (0.3, 2.4)] {
        let place = [3.0, 0.0, height];
        let keyframes = vec![
            straight(0.0, &towers([2.1, 0.0, height], [3.9, 0.0, height], 0.0)),
            ramped(2.0, (0.5, 0.5), &towers(place, place, 0.0)),
        ];
        let verdict = judged(&of_strut(with_events(STANDING, keyframes, &[merge(2.0)]), |strut| {
            strut.clearance = clearance;
        }));
        let beyond = 2.0 * clearance * libm::sin(angle(height));
        let found = of(CheckKind::Collision, &verdict);
        let of_arms = |failure: &&modl::plan::Failure| {
            failure.at == ["n8 -- n1", "n9 -- n5"] && (failure.value - beyond).abs() < 1e-6
        };
        assert_eq!(
            found.iter().any(|failure| of_arms(&failure)),
            beyond < clearance,
            "{clearance}: {found:?}"
        );
    }
}

#[test]
fn events_that_cannot_be_are_refused_with_the_reason() {
    let refused = |events: &[TopologyEvent], words: &str| {
        let found = fault(&with_events(STANDING, moves(), events));
        assert!(found.contains(words), "{found}");
    };
    let change = |node: usize, into: usize| event(2.0, TopologyChange::Merge { node, into });
    refused(&[merge(2.5)], "at 2.5 s, which is no keyframe");
    refused(&[merge(3.0), merge(2.0)], "before the event in front of it");
    refused(&[merge(2.0), merge(3.0)], "the node n9 merges at 3 s, and is merged already");
    refused(&[change(H, H)], "the node n9 merges into itself at 2 s");
    refused(&[merge(2.0), event(3.0, TopologyChange::Merge { node: G, into: H })], "n8 merges into itself");
    refused(&[change(3, 7)], "the nodes of the strut n3 -- n7 merge at 2 s");
    refused(&[change(H, 1)], "from 2 s on the strut");
    refused(&[change(H, 99)], "node");
    refused(&[split(2.0, &TAKEN)], "the node n9 splits off at 2 s, and is merged into no other");
    refused(&[merge(2.0), split(3.0, &[])], "without any strut");
    refused(&[merge(2.0), split(3.0, &[18, 18])], "not in ascending order");
    refused(
        &[merge(2.0), split(3.0, &[0])],
        "n0 -- n1, which is to be taken along at 3 s, does not end at n8",
    );
    refused(&[merge(2.0), split(3.0, &[99])], "strut");
    refused(&vec![merge(2.0); 1001], "1001 times; a plan has up to 1000");
    let begun = |merged: &[(usize, usize)]| {
        fault(&with(reconfiguration(), |paths| {
            (paths.merged, paths.events) = (merged.to_vec(), Vec::new());
        }))
    };
    assert!(begun(&[(H, G)]).contains("n9 rides along with another, and has struts of its own"));
    assert!(begun(&[(H, H)]).contains("rides along with itself"));
    assert!(begun(&[(H, G), (G, H)]).contains("not in ascending order"));
    assert!(begun(&[(G, H), (H, G)]).contains("rides along with itself"));
    assert!(begun(&[(99, 0)]).contains("node"));
    let cause = with(reconfiguration(), |paths| paths.events[0].cause = CauseId(99));
    assert!(fault(&cause).contains("cause"));
}

#[test]
fn a_file_with_events_is_read_as_it_was_written_and_its_names_are_compared() {
    let plan = reconfiguration();
    for plan in [plan.clone(), sliced(&plan, 2.5, 5.0).expect("within"), reversed(&plan)] {
        let text = write(&plan).expect("it can be written");
        assert!(text.contains("\"version\": 4"), "{text}");
        let again = read(&text).expect("what was written can be read");
        assert_eq!(again, plan);
        assert_eq!(write(&again).expect("it can be written"), text);
        let schema = jsonschema::validator_for(&modl::plan::file::schema()).expect("the schema is one");
        assert!(schema.is_valid(&serde_json::from_str(&text).expect("it is JSON")));
    }
    let text = write(&plan).expect("it can be written");
    let altered = |from: &str, to: &str| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        read(&text.replacen(from, to, 1)).expect_err("it is refused").to_string()
    };
    // Another node, another strut, another name.
    assert!(altered("\"node\": 9, \"into\": 8", "\"node\": 9, \"into\": 3").contains("n3"), "names differ");
    assert!(altered("\"struts\": [18, 21, 23]", "\"struts\": [18, 21, 22]").contains("n8 -- n6"));
    assert!(altered("[\"n9\", \"n8\"]", "[\"n9\", \"n7\"]").contains("n7"));
    assert!(altered("\"struts\": [18, 21, 23]", "\"struts\": [0, 21, 23]").contains("does not end at n8"));
    // Without any events the version is the old one.
    let plain = with(plan, |paths| paths.events.clear());
    assert!(write(&plain).expect("it can be written").contains("\"version\": 2"));
}

/// Returns true if two plans have the same ends of struts and the same places of nodes at many times.
fn same(a: &Plan, b: &Plan) -> bool {
    let (a, b) = (paths(a), paths(b));
    let near = |p: &[f64; 3], q: &[f64; 3]| norm(minus(*p, *q)) < 1e-12;
    a.duration() == b.duration()
        && (0..=200).all(|i| {
            let time = a.duration() * f64::from(i) / 200.0;
            let places = a.state(time).iter().zip(&b.state(time)).all(|(p, q)| near(p, q));
            places && a.topology(time) == b.topology(time)
        })
}

#[test]
fn plans_with_events_are_cut_joined_and_run_backwards_exactly() {
    let plan = reconfiguration();
    assert_eq!(reversed(&reversed(&plan)).body, plan.body);
    assert_eq!(sliced(&plan, 0.0, 5.0).expect("all of it").body, plan.body);
    // A step of the first arrangement in reverse has the ends of the last one at its start.
    let back = reversed(&plan);
    for time in [0.5, 1.5, 2.5, 3.5, 4.5] {
        assert_eq!(paths(&back).topology(5.0 - time), paths(&plan).topology(time), "{time}");
    }
    for cut in [0.7, 2.0, 2.3, 3.0, 4.0] {
        let (first, second) =
            (sliced(&plan, 0.0, cut).expect("within"), sliced(&plan, cut, 5.0).expect("within"));
        let whole = joined(&first, &second).expect("they fit");
        assert!(same(&whole, &plan), "cut at {cut}");
        // An event at the cut belongs to the part before it.
        let counts = [&first, &second].map(|plan| paths(plan).events.len());
        let before = usize::from(cut >= 2.0) + usize::from(cut >= 3.0);
        assert_eq!(counts, [before, 2 - before], "cut at {cut}");
        for whole in [&whole, &reversed(&whole)] {
            assert_eq!(judged(whole).failures, vec![], "cut at {cut}");
        }
        // A part that is cut where the truss rests is a plan of its own, but for one that begins where nodes have split: no
        // event says then why their struts are in one place.
        if cut == 2.0 || cut == 3.0 {
            assert_eq!(judged(&first).failures, vec![], "cut at {cut}");
            let failures = judged(&second).failures;
            let met =
                failures.iter().all(|failure| failure.kind == CheckKind::Collision && failure.time == 0.0);
            assert!(met && failures.is_empty() == (cut == 2.0), "cut at {cut}: {failures:?}");
        }
        let turned = joined(&reversed(&second), &reversed(&first)).expect("they fit");
        assert!(same(&turned, &back), "cut at {cut}");
    }
    // There and back.
    let round = joined(&plan, &back).expect("they fit");
    assert_eq!(judged(&round).failures, vec![]);
    assert_eq!(paths(&round).topology(10.0), paths(&plan).topology(0.0));
    // A plan that goes on with other ends does not fit.
    let other = sliced(&with_events(STANDING, moves(), &[]), 3.0, 5.0).expect("within");
    let unfit = joined(&sliced(&plan, 0.0, 3.0).expect("within"), &other).expect_err("refused");
    assert!(unfit.to_string().contains("other nodes are merged"), "{unfit}");
    // Merged nodes are told apart from such that are in one place.
    let merged = sliced(&plan, 0.0, 2.5).expect("within");
    let unmerged = sliced(&with_events(STANDING, moves(), &[]), 2.5, 5.0).expect("within");
    assert!(joined(&merged, &unmerged).is_err());
}

/// The weight of a node that rides along is borne by the one that carries it.
#[test]
fn nodes_that_ride_along_keep_their_weight() {
    let weigh = |node_mass: f64| {
        let still = sliced(&poised(&[merge(0.0)]), 0.0, 0.0).expect("it lasts no time");
        let plan = of_strut(still, |strut| strut.node_mass = Some(node_mass));
        judged(&plan).margin.expect("told").value
    };
    // The stability margin is the distance of the centre of mass from the edges of the three feet, seen from above.
    let nodes = towers(MIDDLE, MIDDLE, 0.3);
    for node_mass in [1e-3, 5.0, 1e3] {
        let mut centre = [0.0; 3];
        let mut whole = 0.0;
        let mut add = |place: Place, mass: f64| {
            (0..3).for_each(|k| centre[k] += place[k] * mass);
            whole += mass;
        };
        STRUTS.iter().for_each(|&(a, b)| [a, b].into_iter().for_each(|end| add(nodes[end], 0.5)));
        nodes.iter().for_each(|place| add(*place, node_mass));
        let (x, y) = (centre[0] / whole, centre[1] / whole);
        let feet = [[0.2, 0.0], [4.0, -1.0], [4.0, 1.0]];
        let edge = |[a, b]: [[f64; 2]; 2]| {
            let (u, v) = (b[0] - a[0], b[1] - a[1]);
            (u * (y - a[1]) - v * (x - a[0])) / libm::hypot(u, v)
        };
        let inside = [[feet[0], feet[1]], [feet[1], feet[2]], [feet[2], feet[0]]].map(edge);
        let least = inside.into_iter().fold(f64::INFINITY, f64::min);
        assert!((weigh(node_mass) - least).abs() < 1e-9, "{node_mass}: {least}");
    }
    assert!((weigh(1e-3) - weigh(1e3)).abs() > 1e-3, "the weight of nodes counts");
}

#[test]
fn the_example_is_verified_both_ways_and_its_page_marks_its_events() {
    let sandbox = Sandbox::new(&[("merging.mod", include_bytes!("../../examples/merging.mod"))]);
    let tested = sandbox.run(&["test", "merging.mod"]);
    assert_eq!(tested.code, 0, "{}", tested.err);
    assert_eq!(sandbox.run(&["run", "merging.mod"]).code, 0);
    let told = sandbox.run(&["verify", "out/ridge.plan.json"]);
    for words in ["h merges into g", "h splits off g with 3 struts", "assumed: the passive joints"] {
        assert!(told.out.contains(words), "{}", told.out);
    }
    assert_eq!(sandbox.run(&["show", "out/ridge.plan.json"]).code, 0);
    let page = std::fs::read_to_string(sandbox.path("out/ridge.html")).expect("written");
    // Struts 21, 22 and 23 go from node 9 to node 8; then 18, 21 and 23 to node 9.
    for part in ["[21,8,5],[22,8,6],[23,8,7]", "[18,9,1],[21,9,5],[23,9,7]"] {
        assert!(page.contains(part), "the page has the ends from then on: {part}");
    }
    // In the end both nodes have struts to both towers, which neither had at the start.
    let text = std::fs::read_to_string(sandbox.path("out/ridge.plan.json")).expect("written");
    let ridge = read(&text).expect("a plan");
    assert_eq!(judged(&ridge).failures, vec![]);
    let ends = paths(&ridge).topology_at_end().struts;
    for node in [G, H] {
        let others = ends.iter().filter(|(a, b)| *a == node || *b == node).map(|(a, b)| a + b - node);
        let (left, right): (Vec<usize>, Vec<usize>) = others.partition(|other| *other < 4);
        assert!(!left.is_empty() && !right.is_empty(), "{node}: {left:?} {right:?}");
    }
}
