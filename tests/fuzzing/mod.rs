//! Generated inputs on the targets of `fuzz/`: a part of them in the gate, and for hours by `fuzz/run`.
//!
//! The gate tries the same inputs in every run, and every input that once failed, which `fuzz/corpus` keeps.

mod long;
mod table;
mod tried;
mod watch;

use crate::fuzz::inputs::corpus::root;
use crate::fuzz::targets::{TARGETS, Target};
use crate::support::properties::whole;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// With `MODL_WHOLE=1`, so many times the inputs.
const WHOLE: u64 = 10;

/// Returns the folder of the inputs of a target that once failed.
fn kept(target: &Target) -> PathBuf {
    root().join("fuzz/corpus").join(target.name)
}

/// Returns the inputs of a target that once failed, with their names.
fn kept_inputs(target: &Target) -> Vec<(String, Vec<u8>)> {
    // A target of which no input has failed has no folder.
    let Ok(entries) = std::fs::read_dir(kept(target)) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("it can be read").path()).collect();
    paths.sort();
    let read = |path: PathBuf| (path.display().to_string(), std::fs::read(&path).expect("it can be read"));
    paths.into_iter().map(read).collect()
}

/// Checks an input; returns false, and tells, where it breaks a property.
fn holds(target: &Target, name: &str, input: &[u8]) -> bool {
    let checked = catch_unwind(AssertUnwindSafe(|| (target.check)(input)));
    if checked.is_err() {
        eprintln!("{}: input {name} breaks a property:\n{}", target.name, String::from_utf8_lossy(input));
    }
    checked.is_ok()
}

/// Tries the inputs of the gate on a target.
fn gate(name: &str) {
    let target = Target::named(name).expect("it is a target");
    let watch = watch::Watch::new(watch::Patience::Gate);
    let mut broken = Vec::new();
    for (name, input) in kept_inputs(target) {
        watch.begins(target.name, &name);
        if !holds(target, &name, &input) {
            broken.push(name);
        }
    }
    for seed in 0..target.gate * if whole() { WHOLE } else { 1 } {
        watch.begins(target.name, &seed.to_string());
        if !holds(target, &seed.to_string(), &target.of_seed(seed)) {
            broken.push(seed.to_string());
        }
    }
    assert!(broken.is_empty(), "{name}: {} inputs break a property: {broken:?}", broken.len());
}

/// A test for each target, and one that no target is left out.
macro_rules! gates {
    ($($name:ident),*) => {
        $(
            #[test]
            fn $name() {
                gate(stringify!($name));
            }
        )*

        #[test]
        fn every_target_is_tried() {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

gates!(
    parse,
    format,
    check,
    run,
    sessions,
    articulated,
    lattice,
    truss,
    scenes,
    meshes,
    drawings,
    rofi,
    urdf,
    smores,
    maps,
    creases,
    exports,
    pictures,
    wire
);

/// The generators make what their targets are for: not everything is refused.
#[test]
fn inputs_are_right_often_enough() {
    let share = |name: &str, right: &dyn Fn(&[u8]) -> bool| {
        let target = Target::named(name).expect("it is a target");
        let many = (0..400).filter(|seed| right(&target.of_seed(*seed))).count();
        assert!(many > 40 && many < 399, "{many} of 400 inputs of `{name}` are right");
    };
    let text = |input: &[u8]| String::from_utf8_lossy(input).into_owned();
    share("parse", &|input| modl::syntax::skeleton(&text(input)).is_some());
    share("check", &|input| {
        let files = crate::fuzz::inputs::project::Project::of(&text(input));
        !modl::check::check(&files, "main.mod").has_errors()
    });
    let is_plan = |input: &[u8]| modl::plan::file::read(&text(input)).is_ok();
    ["articulated", "lattice", "truss", "exports"].iter().for_each(|name| share(name, &is_plan));
    share("smores", &|input| {
        let files = crate::fuzz::inputs::files::parted(input);
        let given: Vec<modl::exchange::ImportFile> = files
            .iter()
            .filter(|(name, _)| name != "row.conf")
            .map(|(name, text)| modl::exchange::ImportFile { name, text })
            .collect();
        modl::exchange::import(&given, &mut |_| None).is_ok()
    });
    share("urdf", &|input| {
        let files = crate::fuzz::inputs::files::parted(input);
        let given = [modl::exchange::ImportFile { name: &files[0].0, text: &files[0].1 }];
        modl::exchange::import(&given, &mut |_| None).is_ok()
    });
}
