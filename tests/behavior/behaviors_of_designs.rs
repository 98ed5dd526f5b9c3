//! Every behaviour of the designs in `std.smores` passes the judge as it is shipped, and those that
//! are there to travel do.

use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// A robot and what it does; how far it gets at least, in millimetres, straight ahead: a little less than wheels that only
/// roll, or feet that only stand, would carry it.
pub const BEHAVIORS: &[(&str, &str, f64)] = &[
    ("Driver1", "x.drive()", 430.0),
    ("Driver1", "x.turn()", 0.0),
    ("Chain3", "x.half_wave(75deg, 3s)", 0.0),
    ("Chain3", "x.sine()", 0.0),
    ("Steer3", "Sc(x.stand(), x.turn(), x.turn(0deg), x.flat())", 0.0),
    ("Grasper7", "Sc(x.squeeze(), x.open())", 0.0),
    ("Climber4", "Sc(x.stand(), x.flat())", 0.0),
    ("Climber4", "x.step()", 100.0),
    ("Walk4", "Sc(x.stand(), x.walk())", 330.0),
    ("FourLeg17", "Sc(x.stand(), x.walk())", 330.0),
    ("Walker14", "Sc(x.stand(), x.tread())", 0.0),
    ("Walkbot17", "x.walk()", 330.0),
    ("Snake18", "x.slither(cycles: 1)", 0.0),
    ("Car", "x.drive()", 430.0),
    ("Car", "Sc(x.stand(), x.turn())", 0.0),
    ("Driver5", "x.drive()", 430.0),
    ("Driver5", "x.turn()", 0.0),
    ("Tank7", "x.drive()", 405.0),
    ("Tank7", "x.turn()", 0.0),
    ("RcCar8", "x.drive()", 405.0),
    ("Proboscis7", "x.raise()", 0.0),
    ("Proboscis7", "x.climb()", 0.0),
    ("Scorpion6", "x.rise()", 0.0),
    ("Cross9", "x.squat()", 0.0),
    ("MobManip8", "Sc(x.raise(), x.forward())", 0.0),
    ("Backhoe", "Sc(x.dig(), x.swing())", 0.0),
    ("Backhoe", "x.drive()", 430.0),
    ("Driver5Puma4", "x.drive()", 430.0),
    ("Driver5Puma4", "x.reach_out()", 0.0),
    ("Driver5Puma4", "x.reach_out(90deg)", 0.0),
    ("TwoCars", "x.drive()", 430.0),
    ("TwoCars", "x.open()", 0.0),
];

#[test]
fn every_behavior_of_the_library_passes_the_judge() {
    let mut wrong = Vec::new();
    for (robot, behavior, travel) in BEHAVIORS {
        let program = format!(
            "use std.smores.{robot}\nlet x = {robot}()\nlet r = verify({behavior})\n\
             print(r.ok, {travel} == 0 or r.displacement.x >= {travel}mm, r.failures)\n"
        );
        let (observed, _, _) = desk::run(&MapFiles::of(&program), Mode::Run);
        let said: Vec<&str> = observed.diagnostics.iter().map(|d| d.code.0).collect();
        let fine = observed.printed.first().is_some_and(|line| line.starts_with("true true"));
        if !fine || !said.is_empty() {
            wrong.push(format!("{robot}: {behavior}: {:?} {said:?}", observed.printed));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
