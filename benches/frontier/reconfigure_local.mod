// A spider with a gap becomes one without: what both have in common stays.
use std.rofi.Spider
let p = reconfigure(Spider(gap: true), Spider())
print(p.steps, p.duration / 1s, p.docks + p.undocks, p.fewest_changes, p.why, verify(p).ok)
