//! Reconfiguration on a floor: rests beside closed forms, plans that stand all the time, and what is refused.

use crate::planners::tosnake::tracks;
use crate::planners::tosnake_search::EIGHT;
use crate::support::desk::{messages, run, run_clean};
use crate::support::properties::whole;
use crate::support::replay::{Matrix, Replay};
use crate::support::suite::MapFiles;
use modl::geometry::Vec3;
use modl::interpret::Mode;
use modl::plan::{self, Plan};
use modl::planners::tosnake::stance::{Point, balanced_parts, rest, rests, settled};

/// Returns balls at the corners of a box about its centre.
fn block(sides: [f64; 3]) -> Vec<Vec3> {
    let corner = |number: usize| {
        let sign = |axis: usize| if number >> axis & 1 == 0 { -0.5 } else { 0.5 };
        Vec3::new(sign(0) * sides[0], sign(1) * sides[1], sign(2) * sides[2])
    };
    (0..8).map(corner).collect()
}

/// A tower of 1 x 1 x 4 stands while it leans by less than atan(1 / 4) = 14.04 degrees, and lies down beyond.
#[test]
fn a_tower_rolls_back_onto_the_side_that_is_below_its_centre() {
    let tower = block([1.0, 1.0, 4.0]);
    for (angle, stands) in [(0.0f64, true), (13.9, true), (14.2, false), (50.0, false)] {
        let (sine, cosine) = libm::sincos(angle.to_radians());
        let rest = rest(&tower, Vec3::new(sine, 0.0, -cosine)).expect("a block rests");
        let down = if stands { -Vec3::z() } else { Vec3::x() };
        assert!((rest.down - down).norm() < 1e-9, "{angle}: {}", rest.down);
        assert_eq!(rest.contacts.len(), 4);
        assert!((rest.margin - 0.5).abs() < 1e-9, "{angle}: {}", rest.margin);
    }
}

#[test]
fn what_is_balanced_stays_until_it_is_touched() {
    let on_edge = Vec3::new(1.0, 0.0, -1.0).normalize();
    let cube = block([1.0, 1.0, 1.0]);
    assert_eq!(rest(&cube, on_edge).expect("it is balanced").margin, 0.0);
    let lying = settled(&cube, on_edge).expect("it goes over to either side");
    assert!((lying.margin - 0.5).abs() < 1e-9 && lying.contacts.len() == 4);
    // A slab on which the centre of mass is above an edge goes over that edge, onto its side.
    let shifted: Vec<Vec3> =
        block([1.0, 1.0, 0.5]).into_iter().map(|arm| arm - Vec3::new(0.5, 0.0, 0.1)).collect();
    let lying = settled(&shifted, -Vec3::z()).expect("it rests");
    assert!((lying.down - Vec3::x()).norm() < 1e-9, "{}", lying.down);
    // Balls in a line have no area to stand on, whatever touches them.
    let line: Vec<Vec3> = (0..5).map(|k| Vec3::new(f64::from(k) - 2.0, 0.0, 0.0)).collect();
    let lying = settled(&line, -Vec3::z()).expect("it lies");
    assert_eq!((lying.contacts.len(), lying.margin), (5, 0.0));
}

/// A slender tower that is drawn aslant stands on its end, which no direction of a coarse grid would find, and on five
/// other sides.
#[test]
fn a_robot_that_stands_as_drawn_is_found_to() {
    let (sine, cosine) = libm::sincos(0.4);
    let turn = nalgebra::Matrix3::new(cosine, 0.0, sine, 0.0, 1.0, 0.0, -sine, 0.0, cosine);
    let tower: Vec<Vec3> = block([1.0, 1.0, 20.0]).into_iter().map(|arm| turn * arm).collect();
    let found = rests(&tower, turn * -Vec3::z());
    assert!((found[0].down - turn * -Vec3::z()).norm() < 1e-9 && found.len() >= 5, "{found:?}");
}

#[test]
fn a_weight_is_borne_in_equilibrium() {
    let points = [[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0], [5.0, 5.0], [-0.5, 3.0]].map(Point::from);
    let parts = balanced_parts(&points).expect("the origin is inside");
    let sum: f64 = parts.iter().sum();
    let moment: Point = points.iter().zip(&parts).map(|(point, part)| point * *part).sum();
    assert!((sum - 1.0).abs() < 1e-12 && moment.norm() < 1e-12 && parts.iter().all(|part| *part >= 0.0));
    // A lever of arms 1 and 2 bears two thirds on the short one.
    let parts = balanced_parts(&[Point::new(-1.0, 0.0), Point::new(2.0, 0.0)]).expect("a lever");
    assert!((parts[0] - 2.0 / 3.0).abs() < 1e-12);
    assert!(balanced_parts(&[Point::new(1.0, 0.0), Point::new(2.0, 0.0)]).is_none());
}

/// Returns the plan of a call; it passes the judge and a second replay.
fn planned(call: &str) -> Plan {
    let text = format!(
        "use std.rofi.{{Spider, Crab, Chair, Fan, Dumbbell, Rectangle, RoundRectangle}}\nlet p = {call}\n\
         print(verify(p).ok, p.assumes.ground, p.way)\nemit(p, \"p.plan.json\")\n"
    );
    let desk = run_clean(&text);
    assert_eq!(desk.printed[0], "true settle direct", "{call}");
    let plan = plan::file::read(desk.text("p.plan.json")).expect("it was written to be read");
    Replay::new(tracks(&plan)).judge().unwrap_or_else(|fault| panic!("{call}: {fault}"));
    plan
}

/// Returns the centres of the balls from the centre of mass at a time, in pitches, in the frame of the first shoe: of a
/// plan of modules whose balls weigh the same.
fn arms(shoes: &[Matrix]) -> Vec<Vec3> {
    let centres: Vec<Vec3> = shoes.iter().map(|shoe| Vec3::new(shoe[0][3], shoe[1][3], shoe[2][3])).collect();
    let middle = centres.iter().sum::<Vec3>() / centres.len() as f64;
    centres.iter().map(|centre| centre - middle).collect()
}

/// Returns the height of the centre of mass above a floor across gravity, in pitches and less half a ball; `down`: the
/// unit vector of gravity.
fn height(arms: &[Vec3], down: &Vec3) -> f64 {
    arms.iter().map(|arm| arm.dot(down)).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns attitudes around one that lean by an angle (rad) in many directions.
fn around(down: &Vec3, lean: f64) -> impl Iterator<Item = Vec3> {
    let x = down.cross(&Vec3::new(0.3, -0.5, 0.8)).normalize();
    let (y, down) = (down.cross(&x), *down);
    (0..144).map(move |way| {
        let (sine, cosine) = libm::sincos(f64::from(way) * 2.5f64.to_radians());
        (down + (x * cosine + y * sine) * lean).normalize()
    })
}

/// Follows the rest of the robot of a plan on the floor from its start, by this test's own search over attitudes: at
/// every twentieth of a second it goes down in ever smaller steps from the last attitude. Returns the heights of all
/// balls above the floor at the start and at the end, in pitches, ascending. At no instant does the robot roll away, or
/// is it on a brink.
fn followed(plan: &Plan) -> [Vec<f64>; 2] {
    let tracks = tracks(plan);
    let replay = Replay::new(tracks);
    let instants = (plan.body.duration() * 20.0) as usize + 1;
    let mut down: Option<Vec3> = None;
    let mut heights = Vec::new();
    for instant in 0..=instants {
        let t = (instant as f64 / 20.0).min(plan.body.duration());
        let hops = replay.hops(&replay.bonds(t, true), t).expect("it hangs together");
        let shoes = replay.shoes(t, &hops);
        let arms = arms(&shoes);
        let mut here = down.unwrap_or_else(|| {
            let base = &shoes[2 * tracks.robot.base];
            let down = tracks.start.base.rotation.inverse() * -Vec3::z();
            Vec3::from_fn(|row, _| (0..3).map(|column| base[row][column] * down[column]).sum())
        });
        let before = here;
        let mut lean = 0.01;
        while lean > 1e-7 {
            let best = around(&here, lean)
                .min_by(|p, q| height(&arms, p).total_cmp(&height(&arms, q)))
                .expect("there are directions");
            if height(&arms, &best) < height(&arms, &here) { here = best } else { lean /= 2.0 }
        }
        assert!((here - before).norm() < 0.2, "it rolls away at {t}: {}", (here - before).norm());
        // With the centre of mass a hundredth of a pitch inside its support, leaning by 0.01 lifts it by a
        // ten-thousandth.
        let least = around(&here, 0.01).map(|down| height(&arms, &down)).fold(f64::INFINITY, f64::min);
        assert!(least > height(&arms, &here) + 4e-5, "a brink at {t}");
        if instant == 0 || instant == instants {
            let floor = height(&arms, &here);
            let mut all: Vec<f64> = arms.iter().map(|arm| floor - arm.dot(&here)).collect();
            all.sort_by(f64::total_cmp);
            heights.push(all);
        }
        down = Some(here);
    }
    heights.try_into().expect("a start and an end")
}

/// The dumbbell stands as it is drawn, so that is how it ends.
#[test]
fn a_robot_stands_all_the_time_and_ends_as_drawn() {
    let there = followed(&planned("reconfigure(Fan(), Dumbbell(), gravity: on, ground: settle)"));
    let drawn = followed(&planned("reconfigure(Dumbbell(), Dumbbell(), gravity: on, ground: settle)"));
    assert_eq!(there[1].len(), 20);
    for (end, drawn) in there[1].iter().zip(&drawn[0]) {
        assert!((end - drawn).abs() < 1e-4, "{:?} {:?}", there[1], drawn);
    }
}

#[test]
fn robots_of_eight_and_ten_modules_change_on_the_floor() {
    for (from, to) in [("Spider()", "Crab()"), ("RoundRectangle()", "Rectangle()")] {
        followed(&planned(&format!("reconfigure({from}, {to}, gravity: on, ground: settle)")));
    }
}

/// The plan of a robot that floats falls over on the floor, and the judge says so.
#[test]
fn a_plan_that_knows_no_floor_falls_over() {
    let desk = run_clean(
        "use std.rofi.{Spider, Crab}\nlet p = reconfigure(Spider(), Crab())\n\
         let v = verify(p, world: world(dynamics: statics))\nprint(v.ok)\nprint(v.failures[0])\n",
    );
    assert_eq!(desk.printed[0], "false");
    assert!(desk.printed[1].contains("falls over"), "{}", desk.printed[1]);
}

#[test]
fn the_same_seed_gives_the_same_plan_on_the_floor() {
    let text = "use std.rofi.{Fan, Dumbbell}\n\
                emit(reconfigure(Fan(), Dumbbell(), gravity: on, ground: settle), \"p.plan.json\")\n";
    assert_eq!(run_clean(text).text("p.plan.json"), run_clean(text).text("p.plan.json"));
}

/// Modules whose joints hold little: they stand, and can't lift what they have to.
#[test]
fn what_does_not_stand_or_is_too_heavy_is_refused() {
    let refused = |text: &str| messages(text).join("\n");
    let straight = refused(
        "use std.rofi.Snake\nprint(reconfigure(Snake(n: 4), Snake(n: 4), gravity: on, ground: settle).why)\n",
    );
    assert!(
        straight.contains("it does not stand on the floor: what supports it spans no area"),
        "{straight}"
    );
    let weightless =
        refused("use std.rofi.{Fan, Dumbbell}\nprint(reconfigure(Fan(), Dumbbell(), ground: settle).why)\n");
    assert!(weightless.contains("nothing rests on it without gravity"), "{weightless}");
    let heavy = refused(
        "use std.rofi.{Fan, Dumbbell}\n\
         print(reconfigure(Fan(), Dumbbell(), gravity: 80m/s^2, ground: settle).why)\n",
    );
    assert!(heavy.contains("overloaded joints") || heavy.contains("would have to hold"), "{heavy}");
}

/// Pairs of the shapes of eight modules that become one another on the floor, with `MODL_WHOLE=1`: the figure in
/// `docs/planners/tosnake.md`.
#[test]
fn most_pairs_of_shapes_change_on_the_floor() {
    if !whole() {
        return;
    }
    let uses = "use std.rofi.{Spider, Crab, Chair}\n";
    let stands: Vec<&str> = EIGHT.into_iter().filter(|shape| !shape.starts_with("Snake")).collect();
    let (mut found, mut all) = (0, 0);
    for from in &stands {
        for to in stands.iter().filter(|to| *to != from) {
            all += 1;
            let text = format!(
                "{uses}let p = reconfigure({from}, {to}, gravity: on, ground: settle)\nprint(verify(p).ok)\n"
            );
            let (observed, desk, _) = run(&MapFiles::of(&text), Mode::Run);
            let ok = desk.printed.first().is_some_and(|line| line == "true");
            eprintln!("{from} to {to}: {}", if ok { "stands" } else { "no way" });
            assert!(
                ok || observed.diagnostics.iter().all(|d| d.code.to_string() == "E0801"),
                "{from} to {to}"
            );
            found += usize::from(ok);
        }
    }
    eprintln!("{found} of {all}");
    assert!(10 * found >= 9 * all, "{found} of {all}");
}
