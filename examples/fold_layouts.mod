//! How flat patterns of one shape compare: tables 3, 4 and 7 of the origami-folding paper, for shapes of its kind.
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron, quadruped18}

/// A shape with the numbers of the patterns that table 3 shows, and the root of table 4, which the paper counts from 1.
record Target { name: Text, shape: Mesh, panels: Int, shown: List<Int>, root: Int }

let targets = [
  Target(name: "tetrahedron", shape: tetrahedron(edge: 80mm), panels: 4, shown: [1, 7, 13], root: 1),
  Target(name: "octahedron", shape: octahedron(edge: 80mm), panels: 8, shown: [1, 160, 320], root: 5),
  Target(name: "quadruped", shape: quadruped18(edge: 80mm), panels: 18, shown: [35, 70, 105], root: 5),
]

/// All flat patterns with a root, under the paper's conventions: leaves first, without gravity.
fn compared(target: Target, root: Int) -> LayoutComparison =
  compare_layouts(fold(target.shape, module: Mori, root: root, sequence: leaves_first))

// Table 3: some patterns of each shape, as pictures true to scale. The order in which patterns are numbered is not the paper's.
for target in targets {
  let all = compared(target, 0)
  for number in target.shown {
    let pattern = fold(target.shape, module: Mori, root: 0, hinges: all.hinges(number - 1))
    show(pattern.layout, "{target.name}_{number}.svg")
  }
}

// Table 4: the best of all (the paper's Method I) and the worst, and the place of the one that its measure prefers (Method II). There
// Method II has the places 1 of 16, 14 of 384 and 1 of 108, and the maximum consumption is 21, 10 and 5 times the least.
for target in targets {
  let all = compared(target, target.root - 1)
  let ratio = all.energies[all.preferred] / all.least
  print("{target.name}: {all.least} at best, {all.greatest} at worst ({all.greatest / all.least:.1} times as much);",
    "Method II takes {ratio:.3} of the best, place {all.preferred_rank} of {all.layouts}")
}

// Table 7: for how many roots Method II finds the best, and for how many it is better than half of all. There: 100% and 100%, 0% and
// 87.5%, 5.56% and 61.11%. A program has no clock: `cargo bench --bench fold` tells how long layouts take.
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
