//! The quadruped under its weight: of panels of 25 g it folds; those of 26 g are refused, for which a hinge would need 0.104 N·m.
use std.mori.Mori
use std.shapes.quadruped18
let found = fold(quadruped18(edge: 80mm), module: Mori(weight: 25g), step: 1s, gravity: on)
let needed = 0.1 * (1 - verify(found).torque_margin)
print("| quadruped of 25 g panels under its weight, N·m | | 0.1 | {needed} | |")
