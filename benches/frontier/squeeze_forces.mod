//! A row that shrinks to half, and one that becomes a column, with no contact carrying more than a cell's own force: the time by its bound.
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(256)
lattice Pole of ExpandingCube = column(256)
let shrunk = squeeze(Bar, Bar, sides: [0.5, 1, 1], max_force: 10N)
let turned = squeeze(Bar, Pole, max_force: 10N)
print("| row of 256 to half cells under a force limit, T by the bound | | | {shrunk.ratio} | |")
print("| row of 256 to a column under a force limit, T by the bound | 22 | | {turned.ratio} | |")
