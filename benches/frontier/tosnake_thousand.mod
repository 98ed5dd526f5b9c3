//! A tangle of 1,000 modules to a snake: the column of seconds is the figure, here of two threads with the judge's.
use std.rofi.tangle
let p = tosnake(tangle(1000, 1000, seed: 1))
print("| tangle of 1,000 modules | 58 s of a processor | 20 s of a processor | {p.steps} steps | none planned |")
