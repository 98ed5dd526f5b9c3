//! The least energy of the icosahedron over layouts and orders; 0.0137192 N·m with the leaves first.
use std.mori.Mori
use std.shapes.icosahedron
let found = fold(icosahedron(edge: 80mm), module: Mori, step: 1s)
print("{found.energy} in steps of 1 s, no less than {found.bound}: gap {found.gap}, {found.order}")
