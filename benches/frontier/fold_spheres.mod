//! The gaps that proofs of spheres of 180 and 320 faces leave open with the leaves first. Where panels meet so and another
//! order is the answer, the gap is by the bound for all orders, which is far below for so many faces.
use std.mori.Panel
use std.shapes.geodesic
let panel = Panel(thickness: 2mm)
let some = fold(geodesic(radius: 300mm, parts: 3), module: panel, sequence: leaves_first)
let many = fold(geodesic(radius: 400mm, parts: 4), module: panel, sequence: leaves_first)
print("| sphere of 180 faces, gap, % | 0.19 | 0.05 | {some.gap * 100}, {some.why} | |")
print("| sphere of 320 faces, gap, % | 0.025 | | {many.gap * 100}, {many.why} | |")
