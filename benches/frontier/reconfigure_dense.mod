// Two shapes of ten modules with 13 and 15 connections that have little in common.
use std.rofi.{Stool, Dumbbell}
let p = reconfigure(Stool(), Dumbbell())
print(p.steps, p.duration / 1s, p.docks + p.undocks, p.fewest_changes, p.why, verify(p).ok)
