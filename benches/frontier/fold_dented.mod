//! Surfaces that are not convex, as whole calls: an icosahedron with spikes of 0.3 of the side, shaken, and a sphere of 80 faces whose
//! radii are off by up to 15 %. The files are in sides; `spiked`, `shaken` and `dented` of `benches/fold_proofs.rs` are their formulas.
use std.mori.Panel
let panel = Panel(thickness: 2mm)
let some = fold(load_mesh("spikes_60.off", scale: 80mm), module: panel, sequence: leaves_first)
let many = fold(load_mesh("dents_80.off", scale: 80mm), module: panel, sequence: leaves_first)
print("| spikes on 60 faces, gap of the call, % | 13.8 | 1 | {some.gap * 100}, by the least with the leaves first {some.price} | |")
print("| dents on 80 faces, the same | 3.8 | 1 | {many.gap * 100}, {many.price} | |")
