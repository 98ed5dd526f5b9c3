//! From a mesh file to the best flat pattern, a plan, and files for scissors and for other programs.
use std.mori.Mori
use std.shapes.boat

// A shape of equal triangles; the file's unit is as long as a panel's edge.
let gem = load_mesh("gem.obj", scale: 80mm)

// The pattern that folds into it for the least energy, with proof, and the plan to fold it.
let folding = fold(gem, module: Mori)
print("{folding.layouts} flat patterns, the best takes {folding.energy}, proved: {folding.optimal}")
print("folds in", len(folding.order), "steps:", folding.order)

emit(folding, "gem.plan.json")
show(folding, "gem.html")        // watch it fold
show(folding.layout, "gem.svg")  // true to scale: cuts, mountains and valleys on layers, edges numbered
save(folding, "gem.fold")        // for programs that read FOLD

// The same eight panels as another shape: through the plane, with as few changed connections as can be.
let there = refold(gem, boat(edge: 80mm), module: Mori)
print("refolds with {there.changes} changes of connections, {there.bound} at least")
emit(there, "boat.plan.json")
emit(reverse(there), "gem_again.plan.json")

test "the gem folds, and becomes a boat" {
  expect folding.layouts == 384
  expect folding.optimal
  expect folding.gap == 0
  expect verify(there).ok
  expect there.bound <= there.changes
}
