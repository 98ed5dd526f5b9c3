--- a plan that begins at rest lasts no time, and is judged
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [500mm, 900mm, 0m]  node d = [500mm, 300mm, 800mm]
  node top = [500mm, 300mm, 1.6m]
  strut a -- b  strut b -- c  strut c -- a  strut d -- a  strut d -- b  strut d -- c
  strut top -- a  strut top -- b  strut top -- c
}
let still = at_rest(T)
print(still.duration, verify(still).ok, verify(still).force_margin > 0.9)
//> 0ms true true
print(verify(at_rest(T, weight: false)).ok)
//> true

--- a motion from rest to rest, at 50 mm/s at most: the node goes 40 mm up
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [500mm, 900mm, 0m]  node d = [500mm, 300mm, 800mm]
  node top = [500mm, 300mm, 1.6m]
  strut a -- b  strut b -- c  strut c -- a  strut d -- a  strut d -- b  strut d -- c
  strut top -- a  strut top -- b  strut top -- c
}
let up = move_nodes(at_rest(T), nodes: ["top"], to: [[500mm, 300mm, 1.64m]])
print(verify(up).ok, up.duration > 800ms, up.duration < 1.2s)
//> true true true
let on = move_nodes(up, nodes: ["top"], to: [[500mm, 300mm, 1.6m]], steps: 4)
print(verify(on).ok, verify(reverse(on)).ok)
//> true true

--- nodes that are unknown, and places for others
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [500mm, 900mm, 0m]  node d = [500mm, 300mm, 800mm]
  node top = [500mm, 300mm, 1.6m]
  strut a -- b  strut b -- c  strut c -- a  strut d -- a  strut d -- b  strut d -- c
  strut top -- a  strut top -- b  strut top -- c
}
let still = at_rest(T)
let one = move_nodes(still, nodes: ["tip"], to: [[0m, 0m, 1m]])
//                                 ^^^^^^^ E0506 the truss has no node `tip`
let two = move_nodes(still, nodes: ["top"], to: [])
//                                              ^^ E0506 there are 0 places for 1 nodes
let three = move_nodes(still, nodes: ["top", "top"], to: [[0m, 0m, 1m], [0m, 0m, 1m]])
//                                   ^^^^^^^^^^^^^^ E0506 the node top is there twice
let four = move_nodes(still, nodes: ["top"], to: [[500mm, 300mm, 1.7m]], steps: 0)
//                                                                              ^ E0506 from 1 to 10000 steps
let five = move_nodes(still, nodes: ["top"], to: [[0m, 0m, 0m]])
//                                               ^^^^^^^^^^^^^^ E0506 a strut would have no length
let six = move_nodes(still, nodes: ["top"], to: [[0m, 0m, 2km]])
//                                              ^^^^^^^^^^^^^^^ E0506
let seven = merge_nodes(still, node: "tip", into: "a")
//                                   ^^^^^ E0506 the truss has no node `tip`
let eight = merge_nodes(still, node: "top", into: "e")
//                                                ^^^ E0506 the truss has no node `e`
print(at_rest(T, friction: 0).duration)
//                         ^ E0506

--- nodes that can not merge
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [500mm, 900mm, 0m]  node d = [500mm, 300mm, 800mm]
  node top = [500mm, 300mm, 1.6m]
  strut a -- b  strut b -- c  strut c -- a  strut d -- a  strut d -- b  strut d -- c
  strut top -- a  strut top -- b  strut top -- c
}
let still = at_rest(T)
let one = merge_nodes(still, node: "top", into: "top")
//                                 ^^^^^ E0506 the node top can't merge into itself
let two = merge_nodes(still, node: "top", into: "a")
//                                 ^^^^^ E0506 the strut top -- a joins the two
let three = merge_nodes(still, node: "top", into: "d")
//                                   ^^^^^ E0506 would be there twice
let four = split_node(still, node: "top", struts: ["top -- a"])
//                                                ^^^^^^^^^^^^ E0506 the node top is merged into no other
let five = split_node(still, node: "top", struts: ["top -- d"])
//                                                ^^^^^^^^^^^^ E0506 the truss has no strut `top -- d`
let six = split_node(still, node: "top", struts: ["top -- a", "a -- top"])
//                                               ^^^^^^^^^^^^^^^^^^^^^^^^ E0506 is there twice

--- nodes that are apart, merged already, or not at the node that splits
use std.truss.PneumaticReel
truss Towers of PneumaticReel {
  node l0 = [200mm, 0m, 0m]   node l1 = [2m, -1m, 0m]  node l2 = [2m, 1m, 0m]  node l3 = [1.7m, 0m, 1.4m]
  node r0 = [5800mm, 0m, 0m]  node r1 = [4m, -1m, 0m]  node r2 = [4m, 1m, 0m]  node r3 = [4.3m, 0m, 1.4m]
  node g = [2.1m, 0m, 2.4m]   node h = [3.9m, 0m, 2.4m]
  strut l0 -- l1  strut l0 -- l2  strut l1 -- l2  strut l0 -- l3  strut l1 -- l3  strut l2 -- l3
  strut r0 -- r1  strut r0 -- r2  strut r1 -- r2  strut r0 -- r3  strut r1 -- r3  strut r2 -- r3
  strut l1 -- r1  strut l2 -- r2  strut l1 -- r2  strut l3 -- r1  strut l3 -- r2  strut l3 -- r3
  strut g -- l1  strut g -- l2  strut g -- l3  strut h -- r1  strut h -- r2  strut h -- r3
}
let middle: Vec3<Length> = [3m, 0m, 2.4m]
let met = move_nodes(at_rest(Towers), nodes: ["g", "h"], to: [middle, middle])
let apart = merge_nodes(at_rest(Towers), node: "h", into: "g")
//                                             ^^^ E0506 the node h is 1.8m from g
let one = merge_nodes(met, node: "h", into: "g")
print(verify(one).ok, verify(reverse(one)).ok)
//> true true
let twice = merge_nodes(one, node: "h", into: "r0")
//                                 ^^^ E0506 the node h is merged already
let rides = move_nodes(one, nodes: ["h"], to: [[3m, 0m, 2.5m]])
//                                 ^^^^^ E0506 the node h is merged into g
let elsewhere = split_node(one, node: "h", struts: ["l0 -- l1"])
//                                                 ^^^^^^^^^^^^ E0506 the strut l0 -- l1 does not end at g
let bare = split_node(one, node: "h", struts: [])
//                                            ^^ E0506 the node h would be without struts

--- a node that takes two struts along has no hold
use std.truss.PneumaticReel
truss Towers of PneumaticReel {
  node l0 = [200mm, 0m, 0m]   node l1 = [2m, -1m, 0m]  node l2 = [2m, 1m, 0m]  node l3 = [1.7m, 0m, 1.4m]
  node r0 = [5800mm, 0m, 0m]  node r1 = [4m, -1m, 0m]  node r2 = [4m, 1m, 0m]  node r3 = [4.3m, 0m, 1.4m]
  node g = [2.1m, 0m, 2.4m]   node h = [3.9m, 0m, 2.4m]
  strut l0 -- l1  strut l0 -- l2  strut l1 -- l2  strut l0 -- l3  strut l1 -- l3  strut l2 -- l3
  strut r0 -- r1  strut r0 -- r2  strut r1 -- r2  strut r0 -- r3  strut r1 -- r3  strut r2 -- r3
  strut l1 -- r1  strut l2 -- r2  strut l1 -- r2  strut l3 -- r1  strut l3 -- r2  strut l3 -- r3
  strut g -- l1  strut g -- l2  strut g -- l3  strut h -- r1  strut h -- r2  strut h -- r3
}
let middle: Vec3<Length> = [3m, 0m, 2.4m]
let met = move_nodes(at_rest(Towers), nodes: ["g", "h"], to: [middle, middle])
let two = split_node(merge_nodes(met, node: "h", into: "g"), node: "h", struts: ["g -- l1", "g -- r1"])
print(verify(two).ok, len(verify(two).failures))
//> false 2

--- the plan of a robot with joints is none of a truss
use std.smores.Car
let drive = plan(Car().drive(t: 1s))
let moved = move_nodes(drive, nodes: ["a"], to: [[0m, 0m, 1m]])
//                     ^^^^^ E0506 Car is no truss
