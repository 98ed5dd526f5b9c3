//! All designs of the library of SMORES modules: each unwinds to the same straight snake as the others of as many modules,
//! and becomes each of these.
//!
//! `MODL_WHOLE=1 cargo test --release --test all unwind_designs -- --nocapture` takes all of them, and prints the tables of
//! `docs/planners/tosnake.md`: what was planned, or the words of the refusal.

use super::tosnake::tracks;
use super::unwind::{closed, end, is_straight, sorts};
use crate::support::desk::run;
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::plan::{Plan, verify};
use std::collections::BTreeMap;
use std::time::Instant;

/// The designs that the gate takes, the quickest.
const QUICK: [&str; 4] = ["Chain3", "Leg3", "Ring12", "Grasper7"];

/// Returns the names of all configurations that the library of SMORES modules declares, in its order.
fn designs() -> Vec<&'static str> {
    let text = include_str!("../../stdlib/smores.mod");
    let named = text.lines().filter_map(|line| line.strip_prefix("config "));
    let all: Vec<&str> = named.filter_map(|rest| rest.split([' ', '(']).next()).collect();
    assert!(QUICK.iter().all(|quick| all.contains(quick)), "{all:?}");
    all.into_iter().filter(|name| whole() || QUICK.contains(name)).collect()
}

/// Returns the length of a module by its type, m: that of the paper's, and that of the later one.
fn length(kind: &str) -> f64 {
    match kind {
        "Smores" => 0.1,
        "SmoresEP" => 0.08,
        other => panic!("a module of the library: {other}"),
    }
}

/// Plans a call on designs, and returns the plan and the cells of a row of a table: connections made and let go, steps,
/// duration (s) and the time that it took (s). An error is the words of the refusal.
fn planned(call: &str, names: &[&str]) -> Result<(Plan, String), String> {
    let text = format!(
        "use std.smores.{{{}}}\nlet p = {call}\nemit(p, \"p.plan.json\")\nprint(p.docks, p.undocks, p.steps)\n\
         print(p.docks + p.undocks >= p.fewest_changes)\n",
        names.join(", ")
    );
    let begun = Instant::now();
    let (observed, desk, _) = run(&MapFiles::of(&text), Mode::Run);
    let took = begun.elapsed().as_secs_f64();
    if let Some(refusal) = observed.diagnostics.first() {
        return Err(refusal.message.clone());
    }
    let plan = desk.plan("p.plan.json");
    let [counts, no_fewer] = &desk.printed[..] else { panic!("{:?}", desk.printed) };
    assert_eq!(no_fewer, "true", "{call}");
    let counts = counts.replace(' ', " | ");
    let duration = plan.body.duration();
    Ok((plan, format!("{counts} | {duration:.1} | {took:.1}")))
}

#[test]
fn the_designs_of_the_library_unwind_and_become_each_other() {
    println!(
        "| design | modules | docks | undocks | steps | lasts, s | planned in, s |\n|---|--:|--:|--:|--:|--:|--:|"
    );
    let mut refused = Vec::new();
    // The connections at the start, by the sorts of their ports, of the designs of so many modules.
    let mut alike: BTreeMap<usize, Vec<(&str, _)>> = BTreeMap::new();
    for name in designs() {
        match planned(&format!("tosnake({name})"), &[name]) {
            Ok((plan, row)) => {
                let robot = &tracks(&plan).robot;
                let (modules, length) = (robot.modules.len(), length(&robot.module_type(0).name));
                is_straight(name, &plan, ["top", "bottom"], length);
                println!("| {name} | {modules} | {row} |");
                let bonds = sorts(&plan, &closed(&plan, &tracks(&plan).start.bonds));
                alike.entry(modules).or_default().push((name, bonds));
            }
            Err(words) => {
                println!("| {name} | | {words} |");
                refused.push(words);
            }
        }
    }
    println!(
        "\n| from | to | docks | undocks | steps | lasts, s | planned in, s |\n|---|---|--:|--:|--:|--:|--:|"
    );
    for designs in alike.values() {
        for (from, _) in designs {
            for (to, goal) in designs.iter().filter(|(to, _)| to != from) {
                match planned(&format!("reconfigure({from}, {to})"), &[from, to]) {
                    Ok((plan, row)) => {
                        assert!(verify::verify(&plan).ok(), "{from} to {to}");
                        assert_eq!(&sorts(&plan, &end(&plan).1), goal, "{from} to {to}");
                        println!("| {from} | {to} | {row} |");
                    }
                    Err(words) => {
                        println!("| {from} | {to} | {words} |");
                        refused.push(words);
                    }
                }
            }
        }
    }
    assert_eq!(refused, Vec::<String>::new());
}
