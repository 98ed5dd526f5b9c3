//! Nodes of a truss merge and split: two towers reach for each other, and their arms become a ridge between them.
//!
//! A reconfiguration of our own making, after the idea of variable topology trusses (Spinos and others 2021; Liu, Yu and Yim
//! 2021). Two tetrahedra of six struts stand side by side, and six struts hold them together. Each has an arm: three struts
//! that meet in a node. The two nodes meet in the middle and become one, which rises on its six struts; then it comes apart
//! again, and each of the two nodes takes along struts of both towers. All under weight, with passive joints that are taken
//! to open and close by themselves.
use std.truss.PneumaticReel

truss Towers of PneumaticReel {
  node l0 = [200mm, 0m, 0m]  node l1 = [2m, -1m, 0m]  node l2 = [2m, 1m, 0m]  node l3 = [1.7m, 0m, 1.4m]
  node r0 = [5800mm, 0m, 0m]  node r1 = [4m, -1m, 0m]  node r2 = [4m, 1m, 0m]  node r3 = [4.3m, 0m, 1.4m]
  node g = [2.1m, 0m, 2.4m]  node h = [3.9m, 0m, 2.4m]
  // The towers.
  strut l0 -- l1  strut l0 -- l2  strut l1 -- l2  strut l0 -- l3  strut l1 -- l3  strut l2 -- l3
  strut r0 -- r1  strut r0 -- r2  strut r1 -- r2  strut r0 -- r3  strut r1 -- r3  strut r2 -- r3
  // Between them.
  strut l1 -- r1  strut l2 -- r2  strut l1 -- r2  strut l3 -- r1  strut l3 -- r2  strut l3 -- r3
  // The arms.
  strut g -- l1  strut g -- l2  strut g -- l3
  strut h -- r1  strut h -- r2  strut h -- r3
}

// The same nodes and struts as they are to be in the end, declared by hand: the arms have become a ridge.
truss Ridge of PneumaticReel {
  node l0 = [200mm, 0m, 0m]  node l1 = [2m, -1m, 0m]  node l2 = [2m, 1m, 0m]  node l3 = [1.7m, 0m, 1.4m]
  node r0 = [5800mm, 0m, 0m]  node r1 = [4m, -1m, 0m]  node r2 = [4m, 1m, 0m]  node r3 = [4.3m, 0m, 1.4m]
  node g = [3m, 800mm, 2.2m]  node h = [3m, -800mm, 2.2m]
  strut l0 -- l1  strut l0 -- l2  strut l1 -- l2  strut l0 -- l3  strut l1 -- l3  strut l2 -- l3
  strut r0 -- r1  strut r0 -- r2  strut r1 -- r2  strut r0 -- r3  strut r1 -- r3  strut r2 -- r3
  strut l1 -- r1  strut l2 -- r2  strut l1 -- r2  strut l3 -- r1  strut l3 -- r2  strut l3 -- r3
  strut h -- l1  strut g -- l2  strut g -- l3
  strut h -- r1  strut g -- r2  strut h -- r3
}

let middle: Vec3<Length> = [3m, 0m, 2.4m]
let met = move_nodes(at_rest(Towers), nodes: ["g", "h"], to: [middle, middle])
let one = merge_nodes(met, node: "h", into: "g")
let risen = move_nodes(one, nodes: ["g"], to: [[3m, 0m, 2.6m]])
let two = split_node(risen, node: "h", struts: ["g -- l1", "g -- r1", "g -- r3"])
let apart = move_nodes(two, nodes: ["g", "h"], to: [[3m, 800mm, 2.2m], [3m, -800mm, 2.2m]], steps: 2)

// What was declared by hand goes on where the plan ends, or `++` would refuse it: each strut has the ends it was to have.
let ridge = apart ++ at_rest(Ridge)
print(ridge.duration, verify(ridge).force_margin, verify(ridge).rigidity, verify(ridge).slip)
emit(ridge, "ridge.plan.json")

test "the arms become a ridge, and go back" {
  expect verify(ridge).ok
  expect verify(reverse(ridge)).ok
}
