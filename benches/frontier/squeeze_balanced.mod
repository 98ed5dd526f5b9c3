//! A row that becomes a column with its angular momentum at zero, in units of time by the root of the number of cells.
//! The unit, √(size · mass / force), is 0.1 s for these.
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(400)
lattice Pole of ExpandingCube = column(400)
let p = squeeze(Bar, Pole, model: balanced)
print("| row of 400 to a column, balanced, T by the root of n | 1.9 | | {p.duration / 0.1s / 20} | |")
print("| the same, gap | | 0 | {p.gap} | |")
