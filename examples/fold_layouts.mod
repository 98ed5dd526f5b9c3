//! How flat patterns of one shape compare: tables 3, 4 and 7 of the origami-folding paper, for shapes of its kind.
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron, quadruped18}

record Target { name: Text, shape: Mesh, panels: Int }

let targets = [
  Target(name: "tetrahedron", shape: tetrahedron(edge: 80mm), panels: 4),
  Target(name: "octahedron", shape: octahedron(edge: 80mm), panels: 8),
  Target(name: "quadruped", shape: quadruped18(edge: 80mm), panels: 18),
]

/// All flat patterns with a root, under the paper's conventions: leaves first, without gravity.
fn compared(target: Target, root: Int) -> LayoutComparison =
  compare_layouts(fold(target.shape, module: Mori, root: root, sequence: leaves_first))

// Table 3: some patterns of a shape, as pictures true to scale.
let octahedra = compared(targets[1], 0)
for index in [0, 159, 319] {
  let pattern = fold(targets[1].shape, module: Mori, root: 0, hinges: octahedra.hinges(index))
  show(pattern.layout, "octahedron_{index + 1}.svg")
}

// Table 4: the best of all (the paper's Method I), and the place of the one that its measure prefers (Method II).
for target in targets {
  let all = compared(target, 0)
  let ratio = all.energies[all.preferred] / all.least
  print("{target.name}: {all.least} at best, {all.greatest} at worst; Method II takes {ratio:.3} of the best,",
    "place {all.preferred_rank} of {all.layouts}")
}

// Table 7: for how many roots Method II finds the best, and for how many it is better than half of all.
for target in targets {
  let all = [compared(target, root) for root in 0..target.panels]
  let first = len([a for a in all if a.preferred_rank == 1])
  let better = len([a for a in all if a.energies[a.preferred] < a.median])
  print("{target.name}: Rate 1 {100 * first / target.panels:.1}%, Rate 2 {100 * better / target.panels:.1}%")
}

test "all patterns are compared, and none takes less than the best of the planner" {
  for target in targets {
    let best = fold(target.shape, module: Mori, root: 0, sequence: leaves_first)
    let all = compare_layouts(best)
    expect all.complete
    expect all.layouts == best.layouts
    expect all.least >= best.bound
    expect all.rank >= 1
  }
}
