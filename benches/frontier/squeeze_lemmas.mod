//! The squeeze problem of Lemmas 1 and 2: a row of cells to one of half cells, by the time of the lemmas, √(n - 1)
//! units of time, each √(size · mass / force), which is 0.1 s for these.
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(401)
let shrunk = squeeze(Bar, Bar, sides: [0.5, 1, 1])
print("| a row of 401 cells to half cells, by the time of Lemma 2 | not asked | 1 | {shrunk.duration / 0.1s / 20} | 1 |")
