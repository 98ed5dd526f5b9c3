//! The least energy of the icosahedron over layouts and orders, and what the proof leaves open.
use std.mori.Mori
use std.shapes.icosahedron
let found = fold(icosahedron(edge: 80mm), module: Mori, step: 1s)
print("| icosahedron, least energy over layouts and orders, J | 0.0137192 | 0.0134895 | {found.energy / 1J} | |")
print("| the same, gap in any order | | 0 | {found.gap} | |")
