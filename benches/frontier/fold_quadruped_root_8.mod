//! The least energy of the quadruped with face 8 on the ground, over layouts and orders, and what the proof leaves open.
use std.mori.Mori
use std.shapes.quadruped18
let found = fold(quadruped18(edge: 80mm), module: Mori, root: 8, step: 1s)
print("| quadruped, root 8, least energy, J | 0.0243017 | 0.015134 | {found.energy / 1J} | |")
print("| the same, gap in any order | | 0 | {found.gap} | |")
