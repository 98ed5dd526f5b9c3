//! Trusses among obstacles and on uneven ground: what the planners do, looked at by arithmetic of the
//! tests' own, and what the judge says of plans that were changed.

use crate::desk::cli::Sandbox;
use crate::support::trusses::{robot, stepping};
use modl::geometry::{HeightField, Placed, Shape, Solid, Vec3, pose::shifted};
use modl::plan::{Body, CheckKind, Interpolation, NodePaths, Verdict, verify};
use modl::planners::NoProgress;
use modl::planners::locomote::{End, Objective, Settings, Travel, follow_path};
use modl::planners::truss::motion::Move;
use modl::planners::truss::roll::{rolled, settled};
use modl::planners::truss::{Structure, Surroundings};
use std::fs;

/// Half a clearance, as deep as a strut may be in the ground between its nodes.
const SINK: f64 = 0.05;

/// Hills and hollows 6 apart, with ripples; the grid ends where they are not flat.
fn hills(high: f64, spacing: f64) -> HeightField {
    const WAVES: f64 = std::f64::consts::TAU / 6.0;
    let count = (40.0 / spacing) as usize;
    let at = |i: usize| -10.0 + i as f64 * spacing;
    let height = |x: f64, y: f64| {
        high * (libm::sin(WAVES * x) * libm::sin(WAVES * y) + 0.3 * libm::sin(2.3 * x + 1.7 * y))
    };
    let heights = (0..count * count).map(|i| height(at(i % count), at(i / count))).collect();
    HeightField { corner: [-10.0; 2], spacing, columns: count, heights }
}

/// Of the three heights of the triangle that a place is in, by areas.
fn height_by_areas(field: &HeightField, x: f64, y: f64) -> f64 {
    let [u, v] = [(0, x), (1, y)].map(|(k, at)| (at - field.corner[k]) / field.spacing);
    let [u, v] = [u.clamp(0.0, field.columns as f64 - 1.0), v.clamp(0.0, field.rows() as f64 - 1.0)];
    let (i, j) = (u.min(field.columns as f64 - 1.5).floor(), v.min(field.rows() as f64 - 1.5).floor());
    let corner =
        |a: f64, b: f64| (i + a, j + b, field.heights[(j + b) as usize * field.columns + (i + a) as usize]);
    let third = if u - i > v - j { corner(1.0, 0.0) } else { corner(0.0, 1.0) };
    let [a, b, c] = [corner(0.0, 0.0), corner(1.0, 1.0), third];
    let area =
        |p: (f64, f64), q: (f64, f64), r: (f64, f64)| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
    let [pa, pb, pc] = [(a.0, a.1), (b.0, b.1), (c.0, c.1)];
    let all = area(pa, pb, pc);
    (area((u, v), pb, pc) * a.2 + area(pa, (u, v), pc) * b.2 + area(pa, pb, (u, v)) * c.2) / all
}

#[test]
fn heights_are_those_of_flat_triangles() {
    let field = hills(0.5, 0.7);
    let mut place = 0.0;
    for i in 0..500 {
        place += 0.618_034;
        let (x, y) = (-12.0 + 40.0 * (place % 1.0), -12.003 + 40.0 * f64::from(i) / 500.0);
        let (found, wanted) = (field.height(x, y), height_by_areas(&field, x, y));
        assert!((found - wanted).abs() < 1e-12, "({x}, {y}): {found}, {wanted}");
        let slope = field.slope(x, y);
        let [right, up] = [field.height(x + 1e-7, y), field.height(x, y + 1e-7)].map(|h| (h - found) / 1e-7);
        assert!((slope[0] - right).abs() < 1e-6 && (slope[1] - up).abs() < 1e-6, "({x}, {y})");
        assert!(libm::hypot(slope[0], slope[1]) <= field.steepest() + 1e-12);
    }
}

#[test]
fn a_segment_is_lowest_where_it_crosses_the_side_of_a_triangle() {
    let field = hills(0.5, 0.7);
    for i in 0..60 {
        let (s, c) = libm::sincos(f64::from(i));
        let (p, q) = (Vec3::new(3.0 * s, 4.0 * c, 0.3 * c), Vec3::new(14.0 * c, 9.0 * s, 0.3 * s));
        let (part, height) = field.lowest(p, q);
        assert!((field.above(p + (q - p) * part) - height).abs() < 1e-12);
        let looked = (0..=4000).map(|k| field.above(p + (q - p) * (f64::from(k) / 4000.0)));
        let looked = looked.fold(f64::INFINITY, f64::min);
        // Never above what is seen, and no farther below than the looks are apart.
        assert!(height <= looked + 1e-12 && height > looked - 0.01, "{height}, {looked}");
    }
}

/// Looks at 50 moments of every step and roll, and of each at many points of every strut.
fn looked_over(truss: &Structure, start: &[Vec3], travel: &Travel, look: &dyn Fn(&[Vec3])) {
    const MOMENTS: usize = 50;
    let mut x = start.to_vec();
    for step in &travel.moves {
        for moment in 0..=MOMENTS {
            let part = moment as f64 / MOMENTS as f64;
            match step {
                Move::Linear(y, _) => {
                    look(&x.iter().zip(y).map(|(p, q)| p + (q - p) * part).collect::<Vec<_>>())
                }
                Move::Roll(roll) => {
                    look(&rolled(&x, modl::planners::truss::roll::Roll { angle: roll.angle * part, ..*roll }))
                }
            }
        }
        x = match step {
            Move::Linear(y, _) => y.clone(),
            Move::Roll(roll) => rolled(&x, *roll),
        };
    }
    assert_eq!(x.len(), truss.nodes);
}

/// Of a box along the axes.
fn to_box(p: Vec3, middle: Vec3, size: Vec3) -> f64 {
    ((p - middle).abs() - size / 2.0).sup(&Vec3::zeros()).norm()
}

#[test]
fn a_truss_goes_through_a_gate_narrower_than_itself() {
    let (truss, start) = robot();
    let from = truss.centre_of_mass(&start);
    let posts =
        [3.6, -3.6].map(|aside| (Vec3::new(from.x + 5.0, from.y + aside, 2.5), Vec3::new(0.5, 5.0, 5.0)));
    let solids = posts.map(|(at, size)| {
        Solid::new(&[Placed { pose: shifted(at), shape: Shape::Box { size } }]).expect("a solid")
    });
    let truss = truss.with_surroundings(Surroundings::new(&solids, None, SINK));
    let (path, settings) = ([[from.x + 8.0, from.y]], stepping(Objective::Springs, 1000));
    let travel = follow_path(&truss, &start, &path, &settings, &mut NoProgress);
    assert_eq!(travel.end, End::Arrived);
    // The gate is 2.2 wide, and the robot was 4.
    looked_over(&truss, &start, &travel, &|x| {
        for (a, b) in truss.struts.iter().map(|&(a, b)| (x[a], x[b])) {
            for (at, size) in posts.iter().filter(|(at, _)| (a.x - at.x).abs().min((b.x - at.x).abs()) < 1.5)
            {
                let near = (0..=20).map(|k| to_box(a + (b - a) * (f64::from(k) / 20.0), *at, *size));
                let near = near.fold(f64::INFINITY, f64::min);
                assert!(near > 0.1 - 1e-9, "{near}");
            }
        }
    });
}

#[test]
fn a_truss_walks_over_hills() {
    let (truss, start) = robot();
    let field = hills(0.1, 1.0);
    let truss = truss.with_surroundings(Surroundings::new(&[], Some(field.clone()), SINK));
    let start = settled(&truss, &start).expect("it rests");
    let from = truss.centre_of_mass(&start);
    let (path, settings) = ([[from.x + 5.0, from.y + 2.0]], stepping(Objective::Springs, 1000));
    let travel = follow_path(&truss, &start, &path, &settings, &mut NoProgress);
    assert_eq!(travel.end, End::Arrived);
    assert!(travel.rolls > 0, "it only crept");
    looked_over(&truss, &start, &travel, &|x| {
        let low = x.iter().map(|p| p.z - height_by_areas(&field, p.x, p.y)).fold(f64::INFINITY, f64::min);
        assert!((-1e-9..1e-3).contains(&low), "the lowest node is {low} above");
        for (a, b) in truss.struts.iter().map(|&(a, b)| (x[a], x[b])).filter(|(a, b)| a.z.min(b.z) < 0.3) {
            for k in 0..=16 {
                let p = a + (b - a) * (f64::from(k) / 16.0);
                let height = p.z - height_by_areas(&field, p.x, p.y);
                assert!(height > -SINK, "a strut is {height} above");
            }
        }
    });
}

#[test]
fn looking_ahead_saves_time_and_there_is_a_way_over_hills() {
    let (truss, start) = robot();
    let from = truss.centre_of_mass(&start);
    let path = [[from.x + 6.0, from.y], [from.x + 6.0, from.y + 3.0]];
    let greedy = stepping(Objective::Springs, 2000);
    let ahead = Settings { lookahead: 30, ..greedy.clone() };
    let duration = |truss: &Structure, settings: &Settings| {
        let start = settled(truss, &start).expect("it rests");
        let travel = follow_path(truss, &start, &path, settings, &mut NoProgress);
        (travel.end == End::Arrived).then_some(travel.duration)
    };
    let [slow, fast] = [&greedy, &ahead].map(|settings| duration(&truss, settings).expect("arrives"));
    assert!(fast < 0.8 * slow, "{fast} s, greedily {slow} s");
    let rough = truss.with_surroundings(Surroundings::new(&[], Some(hills(0.25, 1.0)), SINK));
    // Detours find a way here, too, where steps alone get stuck.
    assert!(duration(&rough, &greedy).or_else(|| duration(&rough, &ahead)).is_some());
}

#[test]
fn the_judge_knows_what_is_around() {
    let sandbox = Sandbox::new(&[("rough.mod", include_bytes!("../../examples/rough.mod"))]);
    let ran = sandbox.run(&["run", "rough.mod"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let plan = |name: &str| {
        let text = fs::read_to_string(sandbox.path(&format!("out/{name}.plan.json"))).expect("written");
        modl::plan::file::read(&text).expect("a plan")
    };
    let [through, over, beside] = ["through", "over", "beside"].map(plan);
    let judged = |plan: &modl::plan::Plan, change: &dyn Fn(&mut NodePaths)| {
        let mut plan = plan.clone();
        let Body::NodePaths(paths) = &mut plan.body else { unreachable!("a truss's plan") };
        change(paths);
        let verdict: Verdict = verify::verify(&plan);
        verdict.failures.iter().map(|failure| failure.kind).collect::<Vec<CheckKind>>()
    };
    for plan in [&through, &over, &beside] {
        assert_eq!(judged(plan, &|_| {}), []);
    }
    // The gate is a little narrower than it was, or the wall nearer.
    let moved = |paths: &mut NodePaths| paths.surroundings.obstacles[0][0].pose.translation.vector.y += 0.3;
    assert!(judged(&through, &moved).contains(&CheckKind::Collision));
    let nearer = |paths: &mut NodePaths| paths.surroundings.obstacles[0][0].pose.translation.vector.x -= 0.3;
    assert!(judged(&beside, &nearer).contains(&CheckKind::Collision));
    // A wall in the way of a roll alone: above where everything is before and after.
    let rolls = judged(&through, &|paths| {
        let roll =
            paths.keyframes.iter().position(|k| k.interpolation != Interpolation::Linear).expect("it rolls");
        let [before, after] = [roll - 1, roll].map(|k| paths.keyframes[k].nodes.clone());
        let half = paths.state((paths.keyframes[roll - 1].time + paths.keyframes[roll].time) / 2.0);
        let far = (0..half.len()).max_by(|a, b| {
            let moved = |n: usize| (Vec3::from(before[n]) - Vec3::from(after[n])).norm();
            moved(*a).total_cmp(&moved(*b))
        });
        let at = Vec3::from(half[far.expect("nodes")]);
        paths.keyframes.truncate(roll + 1);
        paths.keyframes.drain(..roll - 1);
        paths.keyframes.iter_mut().enumerate().for_each(|(i, keyframe)| keyframe.time = 100.0 * i as f64);
        paths.keyframes[0].ramps = modl::plan::Ramps::NONE;
        let post = Shape::Sphere { radius: 0.05 };
        paths.surroundings.obstacles = vec![vec![Placed { pose: shifted(at), shape: post }]];
        paths.keyframes.iter_mut().for_each(|keyframe| keyframe.margins.obstacle = None);
    });
    assert!(!rolls.is_empty() && rolls.iter().all(|kind| *kind == CheckKind::Collision), "{rolls:?}");
    // The ground is higher or lower than it was, flat, or not there.
    let raised = |by: f64| {
        move |paths: &mut NodePaths| {
            let field = paths.surroundings.terrain.as_mut().expect("uneven");
            field.heights.iter_mut().for_each(|h| *h += by);
            paths.keyframes.iter_mut().for_each(|keyframe| keyframe.margins.support = None);
        }
    };
    assert!(judged(&over, &raised(1e-3)).contains(&CheckKind::Ground));
    assert!(judged(&over, &raised(-1e-3)).contains(&CheckKind::Stability));
    assert!(!judged(&over, &|paths| paths.surroundings.terrain = None).is_empty());
    let bad = judged(&over, &|paths| {
        let field = paths.surroundings.terrain.as_mut().expect("uneven");
        field.heights.pop();
    });
    assert_eq!(bad, [CheckKind::Form]);
    // One spike between the nodes of a strut on the ground.
    let spiked = judged(&over, &|paths| {
        let field = paths.surroundings.terrain.as_mut().expect("uneven");
        let last = paths.keyframes.last().expect("keyframes").nodes.clone();
        let on = |p: &[f64; 3]| (p[2] - field.height(p[0], p[1])).abs() < 1e-4;
        let (a, b) =
            *paths.struts.iter().find(|(a, b)| on(&last[*a]) && on(&last[*b])).expect("on the ground");
        let middle = [0, 1].map(|k| (last[a][k] + last[b][k]) / 2.0);
        let [i, j] = [0, 1].map(|k| libm::round((middle[k] - field.corner[k]) / field.spacing) as usize);
        field.heights[j * field.columns + i] += 1.0;
    });
    assert!(spiked.contains(&CheckKind::Ground), "{spiked:?}");
    // Margins that it has not.
    for change in [
        (|m| m.length = m.length.map(|x| x + 1e-3)) as fn(&mut modl::plan::Margins),
        |m| m.support = m.support.map(|x| x + 1e-3),
        |m| m.obstacle = Some(0.0),
        |m| m.clearance = Some(1.0),
    ] {
        let told = judged(&through, &|paths| change(&mut paths.keyframes[10].margins));
        assert_eq!(told, [CheckKind::Form]);
    }
}
