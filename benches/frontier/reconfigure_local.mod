//! A spider with a gap becomes one without: what both have in common stays.
use std.rofi.Spider
let p = reconfigure(Spider(gap: true), Spider())
print("| spider that closes its gap: connections changed | | {p.fewest_changes} | {p.docks + p.undocks}, {p.why} | |")
print("| the same, steps; s | | | {p.steps}; {p.duration / 1s} | |")
