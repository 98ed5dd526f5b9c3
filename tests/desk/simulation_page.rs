//! Pages of simulations: what they hold beside the closed forms of mechanics, and beside the pages of their plans.

use crate::simulate::fixtures::{DROP, GRAVITY, close};
use crate::support::desk::{run, run_clean};
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use serde_json::Value;

/// The data of a page that a program shows.
fn data(page: &str) -> Value {
    let from = page.split_once("id=\"plan\">").expect("a page holds a plan").1;
    serde_json::from_str(from.split_once("</script>").expect("the data ends").0).expect("the data is JSON")
}

/// The numbers of a column `[unit, first, difference, ...]`.
fn column(column: &Value, count: usize) -> Vec<f64> {
    let numbers: Vec<f64> =
        column.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect();
    let (unit, steps) = numbers.split_first().expect("a unit");
    let mut sum = 0.0;
    (0..count)
        .map(|i| {
            sum += steps.get(i).copied().unwrap_or(0.0);
            sum * unit
        })
        .collect()
}

/// The measured motion of a page.
struct Measured {
    data: Value,
    count: usize,
    times: Vec<f64>,
}

impl Measured {
    fn of(page: &str) -> Measured {
        let data = data(page);
        let count = data["simulation"]["count"].as_u64().expect("a number") as usize;
        let times = column(&data["simulation"]["times"], count);
        Measured { data, count, times }
    }

    fn joint(&self, joint: usize) -> Vec<f64> {
        column(&self.data["simulation"]["joints"][joint], self.count)
    }

    /// A coordinate of the root of a tree: 0 is x, 3 to 6 are those of the quaternion.
    fn base(&self, tree: usize, coordinate: usize) -> Vec<f64> {
        column(&self.data["simulation"]["bases"][tree][coordinate], self.count)
    }

    /// The contacts of a moment: link, other link, and the force, N.
    fn contacts(&self, moment: usize) -> Vec<(i64, i64, [f64; 3])> {
        let unit = self.data["simulation"]["force"].as_f64().expect("a number");
        let numbers = self.data["simulation"]["contacts"][moment].as_array().expect("a list");
        let numbers: Vec<i64> = numbers.iter().map(|x| x.as_i64().expect("a whole number")).collect();
        let contact = |c: &[i64]| (c[0], c[1], [5, 6, 7].map(|k| c[k] as f64 * unit));
        numbers.chunks(8).map(contact).collect()
    }
}

/// The page of the simulation of a behaviour `b` that a program declares, in a world, with settings.
fn shown(program: &str, world: &str, settings: &str) -> String {
    let show = format!("show(simulate(plan(b, world: world({world})){settings}), \"s.html\")\n");
    run_clean(&format!("{program}{show}")).text("s.html").to_owned()
}

#[test]
fn joints_are_where_mechanics_has_them() {
    let page = Measured::of(&shown(DROP, "ground: held", ""));
    assert!(page.count >= 60 && page.times[0] == 0.0, "{} moments", page.count);
    for (time, place) in page.times.iter().zip(page.joint(0)) {
        // It is let go 0.3 s before the plan begins. Velocities at the end of steps are gained a step early.
        let fallen = time + 0.3;
        close(place, -0.5 * GRAVITY * fallen * fallen, GRAVITY * 5e-4 * fallen + 1e-5);
    }
}

/// A module of 2 kg that hangs from one that is held, by a bond that is too weak.
const HANGS: &str = "connector Weak { mates Weak, turns 1, holds 10N }
module Top { link body = box(50mm, 50mm, 50mm, mass: 1kg)
  port low : Weak on body at [0mm, 0mm, -25mm] facing -Z up +X }
module Low { link body = box(50mm, 50mm, 50mm, mass: 2kg)
  port high : Weak on body at [0mm, 0mm, 25mm] facing +Z up +X }
config Hangs { part t: Top part l: Low connect t.low -- l.high
  base t
  behavior rest = wait(500ms)
}
let b = Hangs().rest()
";

#[test]
fn what_comes_loose_is_drawn_where_it_falls() {
    let page = Measured::of(&shown(HANGS, "ground: held", ""));
    let verdict = &page.data["verdict"];
    assert_eq!(verdict["stamp"], "failed");
    let failures = verdict["failures"].as_array().expect("a list");
    let broken = failures.iter().find(|f| f["kind"] == "bond load").expect("it breaks");
    assert_eq!(broken["modules"], serde_json::json!([0, 1]));
    assert!(
        failures.iter().any(|f| f["kind"] == "stability" && f["message"] == "the robot with `l` falls"),
        "{failures:?}"
    );
    let since = broken["time"].as_f64().expect("a time");
    let (held, loose) = (page.base(0, 2), page.base(1, 2));
    for (index, time) in page.times.iter().enumerate() {
        close(held[index], held[0], 1e-5);
        let fallen = (time - since).max(0.0);
        close(loose[index], loose[0] - 0.5 * GRAVITY * fallen * fallen, 2.0 * GRAVITY * 5e-4 * fallen + 2e-4);
    }
}

/// A block that stands on the ground.
const BLOCK: &str = "module Block { link body = box(100mm, 80mm, 60mm, mass: 2kg) }
config Stands { part k: Block
  base k
  behavior rest(t: Time) = wait(t)
}
";

#[test]
fn the_contact_forces_of_a_block_at_rest_are_its_weight() {
    let page = Measured::of(&shown(&format!("{BLOCK}let b = Stands().rest(1s)\n"), "ground: settle", ""));
    for moment in page.count / 2..page.count {
        let contacts = page.contacts(moment);
        assert!(contacts.len() >= 3, "{contacts:?}");
        assert!(contacts.iter().all(|(link, other, _)| (*link, *other) == (0, -1)), "{contacts:?}");
        let sum = |axis: usize| contacts.iter().map(|(_, _, force)| force[axis]).sum::<f64>();
        close(sum(2), 2.0 * GRAVITY, 0.02);
        close(sum(0), 0.0, 0.02);
        close(sum(1), 0.0, 0.02);
    }
    // An arrow of the weight is about as long as the block is large.
    let newtons = page.data["simulation"]["newtons"].as_f64().expect("a force");
    let arrow = 0.1 * 2.0 * GRAVITY / newtons;
    assert!((0.1..0.6).contains(&arrow), "{arrow} m");
}

#[test]
fn a_long_motion_is_kept_at_fewer_moments() {
    let page = shown(&format!("{BLOCK}let b = Stands().rest(150s)\n"), "ground: settle", ", step: 5ms");
    let page = Measured::of(&page);
    assert!((2048..=4096).contains(&page.count), "{} moments", page.count);
    close(page.times[1], 0.04, 1e-9);
    close(*page.times.last().expect("a moment"), 150.3, 0.05);
}

/// A walker of the library on slippery ground, with runs that differ.
const WALK: &str = "use std.smores.Walk4
let w = Walk4()
let b = Sc(w.stand(), w.walk(steps: 1))
";

#[test]
fn a_walker_is_shown_with_its_plan_and_its_runs() {
    let program = format!(
        "{WALK}let p = plan(b)
let s = simulate(p, runs: 3, friction_spread: 0.5)
show(s, \"one.html\")
show(simulate(p, runs: 3, friction_spread: 0.5), \"two.html\")
show(p, \"plan.html\")
for t in s.travels {{ print(t / 1m) }}
"
    );
    let desk = run_clean(&program);
    let (page, plan) = (desk.text("one.html"), data(desk.text("plan.html")));
    assert!(page == desk.text("two.html"), "equal simulations have equal pages");
    assert!(page.len() < 600_000, "{} bytes", page.len());
    let plan_page = desk.text("plan.html");
    let own = |page: &str| page.len() - data(page).to_string().len();
    assert!(own(page) < own(plan_page) + 15_000, "its scripts are {} bytes", own(page) - own(plan_page));
    assert!(!plan_page.contains("simulation") && !plan_page.contains("//:"), "a plan's page knows of none");
    let page = Measured::of(page);
    // The ghost is what the page of the plan plays.
    for part in ["tracks", "trees", "forms", "start", "base", "modules", "kinds"] {
        assert_eq!(page.data["body"][part], plan["body"][part], "{part}");
    }
    // Joints follow their commands within some degrees.
    let lag = page.data["verdict"]["worst"][0][1].as_str().expect("words");
    assert!(lag.starts_with("greatest lag"), "{lag}");
    let drives = page.data["simulation"]["drives"].as_array().expect("a list");
    assert!(
        drives.iter().any(|drive| drive["limit"].as_f64().is_some_and(|limit| limit > 0.0)),
        "{drives:?}"
    );
    for drive in drives {
        let efforts = column(&drive["efforts"], page.count);
        let Some(limit) = drive["limit"].as_f64() else { continue };
        assert!(efforts.iter().all(|effort| effort.abs() <= limit * 1.001), "{}", drive["name"]);
    }
    let runs = page.data["simulation"]["runs"].as_array().expect("a list");
    assert_eq!(runs.len(), 3);
    let x = page.base(0, 0);
    for (run, travel) in runs.iter().zip(&desk.printed) {
        let count = run[0].as_u64().expect("a number") as usize;
        assert!((20..=200).contains(&count), "{count} points");
        let (along, across) = (column(&run[1], count), column(&run[2], count));
        close(along[0], x[0], 2e-3);
        let way = libm::hypot(along[count - 1] - along[0], across[count - 1] - across[0]);
        close(way, travel.parse().expect("a number"), 2e-3);
        assert!(run[3].is_null(), "none falls");
    }
}

#[test]
fn a_simulation_is_a_page_and_no_picture() {
    let text = format!("{DROP}show(simulate(plan(b, world: world(ground: held))), \"s.svg\")\n");
    let (observed, desk, _) = run(&MapFiles::of(&text), Mode::Run);
    let said: Vec<&str> = observed.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(said.iter().any(|message| message.contains("simulation's page ends in `.html`")), "{said:?}");
    assert!(desk.written.is_empty());
}

#[test]
fn on_a_slope_the_page_draws_the_slope_and_leans_the_plan_with_it() {
    let program = "module Block { link body = box(100mm, 60mm, 40mm, mass: 1kg, friction: 0.3) }
config One { part b: Block  behavior rest = wait(1s) }
let b = One().rest()
";
    let measured = Measured::of(&shown(program, "", ", terrain: slope(25deg)"));
    let rise = libm::tan(25_f64.to_radians());
    assert_eq!(measured.data["ground"], false);
    let lines = measured.data["simulation"]["terrain"].as_array().expect("lines");
    let numbers = lines.iter().flat_map(|line| line.as_array().expect("numbers"));
    let numbers: Vec<f64> = numbers.map(|x| x.as_f64().expect("a number")).collect();
    for point in numbers.chunks(3) {
        assert!((point[2] - rise * point[0]).abs() < 2e-4, "{point:?}");
    }
    // It slides down, 20 mm above the slope, and the plan stays where it stood, turned against the slope's rise.
    let (x, z) = (measured.base(0, 0), measured.base(0, 2));
    for (x, z) in x.iter().zip(&z) {
        assert!((z - rise * x - 0.02 / libm::cos(25_f64.to_radians())).abs() < 3e-4, "{x} {z}");
    }
    assert!(x[x.len() - 1] < x[0] - 0.5);
    let base = measured.data["body"]["base"].as_array().expect("keys");
    let half = -libm::sin(12.5_f64.to_radians());
    for key in base {
        let turn = key[5].as_f64().expect("a number");
        assert!((turn - half).abs() < 1e-6, "{key}");
    }
}
