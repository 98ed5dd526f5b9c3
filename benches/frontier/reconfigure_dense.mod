//! Two shapes of ten modules with 13 and 15 connections that have little in common.
use std.rofi.{Stool, Dumbbell}
let p = reconfigure(Stool(), Dumbbell())
print("| stool to dumbbell: connections changed | | {p.fewest_changes} | {p.docks + p.undocks}, {p.why} | |")
print("| the same, steps; s | | | {p.steps}; {p.duration / 1s} | |")
