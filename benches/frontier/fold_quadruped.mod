//! The least energy of the quadruped with any face on the ground, over layouts and orders, and what the proof leaves open.
use std.mori.Mori
use std.shapes.quadruped18
let found = fold(quadruped18(edge: 80mm), module: Mori, step: 1s)
print("| quadruped, any root, least energy, J | 0.0114164 | 0.0112925 | {found.energy / 1J} | |")
print("| the same, gap in any order | | 0 | {found.gap} | |")
