//! Tori whose panels meet on the way in all cheap layouts: the energy by the least of any layout.
use std.mori.Panel
use std.shapes.torus
let panel = Panel(thickness: 2mm)
let wide = fold(torus(radius: 300mm, tube: 100mm, around: 12, across: 6), module: panel)
print("| torus 12x6, energy by the least | 11.7 | | {wide.price} | |")
