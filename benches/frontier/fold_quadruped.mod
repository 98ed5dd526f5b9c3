//! The least energy of the quadruped with any face on the ground, over layouts and orders; 0.0114164 N·m with the leaves first.
use std.mori.Mori
use std.shapes.quadruped18
let found = fold(quadruped18(edge: 80mm), module: Mori, step: 1s)
print("{found.energy} in steps of 1 s, no less than {found.bound}: gap {found.gap}, {found.order}")
