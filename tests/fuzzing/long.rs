//! Fresh inputs for hours: `fuzz/run`. Without its variables these tests do nothing.

use super::tried::{self, Tried};
use super::watch::{AtHand, Patience, Watch};
use super::{holds, kept};
use crate::fuzz::targets::{TARGETS, Target};
use modl::interrupt::memory;
use std::path::PathBuf;
use std::time::Instant;

/// The seconds that one target is tried before the next.
const TURN: f64 = 20.0;
/// The memory that an input may take, bytes.
const MEMORY_MAX: usize = 1 << 30;

/// The inputs of one turn that are kept: more of them tell the same.
const KEPT_MAX: u64 = 5;

/// Keeps an input that broke a property, and returns its path.
fn keep(target: &Target, seed: u64) -> PathBuf {
    let folder = kept(target);
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    let path = folder.join(seed.to_string());
    std::fs::write(&path, target.of_seed(seed)).expect("the input can be written");
    path
}

/// Tries inputs of a target for a turn.
fn turn(target: &'static Target, tried: &mut Tried, at_hand: &mut AtHand, seconds: f64) {
    let watch = Watch::new(Patience::Run);
    let began = Instant::now();
    let try_one = |seed: u64, at_hand: &mut AtHand| {
        at_hand.names(target.name, seed);
        watch.begins(target.name, &seed.to_string());
        holds(target, &seed.to_string(), &target.of_seed(seed))
    };
    let mut new = 0;
    let mut broken = |seed: u64, why: &str| {
        tried.broke += 1;
        new += 1;
        if new <= KEPT_MAX {
            eprintln!("{}: seed {seed} {why}; kept as {}", target.name, keep(target, seed).display());
        }
    };
    let (first, mut next) = (tried.next, tried.next);
    while began.elapsed().as_secs_f64() < seconds {
        memory::reset_peak();
        let before = memory::in_use();
        if !try_one(next, at_hand) {
            broken(next, "breaks a property");
        }
        let grown = memory::peak().saturating_sub(before);
        if grown > MEMORY_MAX {
            broken(next, &format!("takes {grown} bytes"));
        }
        next += 1;
    }
    tried.next = next;
    tried.inputs += next - first;
    tried.seconds += began.elapsed().as_secs_f64();
}

/// Returns the targets that a variable names, by default all.
fn chosen() -> Vec<&'static Target> {
    let names = std::env::var("MODL_FUZZ_TARGETS").unwrap_or_default();
    if names.trim().is_empty() {
        return TARGETS.iter().collect();
    }
    names
        .split_whitespace()
        .map(|name| Target::named(name).unwrap_or_else(|| panic!("there is no target `{name}`")))
        .collect()
}

/// Tries inputs for `MODL_FUZZ_SECONDS`; each turn is that of the target which has had the least time, of those that have not
/// reached their aim.
#[test]
fn fresh_inputs_for_hours() {
    let Ok(seconds) = std::env::var("MODL_FUZZ_SECONDS") else { return };
    let seconds: f64 = seconds.parse().expect("a number of seconds");
    let began = Instant::now();
    let mut at_hand = AtHand::open();
    let chosen = chosen();
    let broke =
        |all: &std::collections::BTreeMap<String, Tried>| all.values().map(|tried| tried.broke).sum::<u64>();
    let before = broke(&tried::read());
    while began.elapsed().as_secs_f64() < seconds {
        let mut all = tried::read();
        // Those that have reached their aim come last.
        let order = |target: &&&'static Target| {
            let tried = &all[target.name];
            (tried.inputs >= target.aim, tried.seconds)
        };
        let least =
            chosen.iter().min_by(|a, b| order(a).partial_cmp(&order(b)).expect("seconds are numbers"));
        let target = least.expect("there are targets");
        let left = seconds - began.elapsed().as_secs_f64();
        turn(target, all.get_mut(target.name).expect("all targets are there"), &mut at_hand, left.min(TURN));
        tried::write(&all);
    }
    let after = broke(&tried::read());
    assert!(after == before, "{} inputs broke a property; `fuzz/corpus` keeps them", after - before);
}

/// Keeps the input that was at hand when the program ended, and goes on behind it.
#[test]
fn the_input_at_hand_is_kept() {
    if std::env::var_os("MODL_FUZZ_ENDED").is_none() {
        return;
    }
    let line = std::fs::read_to_string(AtHand::path()).expect("the file is there");
    let (name, seed) = line.lines().next().and_then(|line| line.split_once(' ')).expect("it names an input");
    let target = Target::named(name).expect("it is a target");
    let seed: u64 = seed.parse().expect("a seed");
    let mut all = tried::read();
    let tried = all.get_mut(name).expect("all targets are there");
    // The turn was not counted.
    tried.inputs += (seed + 1).saturating_sub(tried.next);
    tried.next = seed + 1;
    tried.broke += 1;
    eprintln!("{name}: seed {seed} ended the program; kept as {}", keep(target, seed).display());
    tried::write(&all);
}
