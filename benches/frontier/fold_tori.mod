//! Tori whose panels meet on the way in all cheap layouts: the energy by the least of any layout.
use std.mori.Panel
use std.shapes.torus
let panel = Panel(thickness: 2mm)
let tight = fold(torus(radius: 200mm, tube: 80mm, around: 5, across: 3), module: panel)
let wide = fold(torus(radius: 300mm, tube: 100mm, around: 12, across: 6), module: panel)
print("| torus 5x3, energy by the least | 11.1 | | {tight.price} | |")
print("| torus 12x6, energy by the least | 11.7 | | {wide.price} | |")
