//! From an icosahedron of 80 panels, four to a face, to a tube of as many. The column of seconds is a figure, too.
use std.mori.Mori
use std.shapes.{icosahedron, tube}
let there = refold(subdivided(icosahedron(edge: 160mm), 2), tube(sides: 10, rings: 4, edge: 80mm), module: Mori)
print("| refold of 80 panels, changes (bound) | refused | | {there.changes} ({there.bound}) | |")
