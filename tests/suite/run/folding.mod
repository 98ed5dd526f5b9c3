--- a shape is folded from the best of its flat patterns
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron}
let tetra = fold(tetrahedron(edge: 80mm), module: Mori, method: enumerate)
print(tetra.layouts, tetra.steps, tetra.duration, tetra.optimal, tetra.ties, verify(tetra).ok)
//> 16 1 2.29s true [0, 1, 2, 3] true
let octa = fold(octahedron(edge: 80mm), module: Mori, step: 2s)
print(octa.layouts, octa.steps, octa.duration, octa.optimal, octa.layout.panels, octa.layout.overlaps)
//> 384 3 6s true 8 []
// The panels of the folded robot lie round its middle; flat, the root and its neighbours are level.
print(count(octa.robot), mass(octa.robot), [norm(octa.end.com)], verify(octa.plan).ok, verify(reverse(octa)).ok)
//> 8 208g [32.6599mm] true true

--- the energies of a folding are in joules, its torques in newton metres
use std.mori.Mori
use std.shapes.tetrahedron
fn unit(shown: Text) -> Text = join([c for c in characters(shown) if not contains(characters("-.0123456789e"), c)], with: "")
let plain = fold(tetrahedron(edge: 80mm), module: Mori)
let sample = random_orders(plain, orders: 2)
print([unit("{e}") for e in [plain.energy, plain.bound, plain.lifting, plain.lifting_bound, verify(plain).energy]])
print([unit("{e}") for e in [sample.least, sample.mean, sample.greatest]], unit("{plain.peak_torque}"))
//> [J, J, J, J, J]
//> [J, J, J] N*m
let peak = fold(tetrahedron(edge: 80mm), module: Mori, minimise: peak_torque)
print(unit("{peak.energy}"), unit("{peak.bound}"), unit("{peak.peak_torque}"))
//> J N*m N*m

--- a heuristic and other roots are no better than what is proved
use std.mori.Mori
use std.shapes.{octahedron, quadruped18}
let best = fold(octahedron(edge: 80mm), module: Mori)
let fast = fold(octahedron(edge: 80mm), module: Mori, method: heuristic)
print(abs(fast.energy / best.energy - 1) < 1e-6, best.energy >= best.bound)
//> true true
// However it was found, what reaches the bound of all layouts is proved.
print(fast.optimal, fast.gap)
//> true 0
// The least of all 384 layouts that fold root first is 45/38 of the least of those that fold leaves first.
let rooted = fold(octahedron(edge: 80mm), module: Mori, sequence: root_first)
print(rooted.optimal, rooted.gap, abs(rooted.energy / best.energy - 45 / 38) < 1e-9)
//> true 0 true
let quad = fold(quadruped18(edge: 80mm), module: Mori, root: 4)
print(quad.layouts, quad.root, verify(quad).ok, fold(quadruped18(edge: 80mm), module: Mori).ties)
//> 108 4 true [0]

--- a mesh that does not fold is refused, with the faces
use std.mori.Mori
use std.shapes.{cube, octahedron}
print(fold(cube(edge: 80mm), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 does not fold

--- what is wrong with a mesh is said with how to mend it
use std.mori.Mori
use std.shapes.geodesic
let s = 80mm
let h = s * sqrt(0.75)
let corners: List<Vec3<Length>> = [[0m, 0m, 0m], [s, 0m, 0m], [s / 2, h, 0m], [s / 2, -h, 0m], [s / 2, 0m, h], [s / 2, 0m, 0m]]
print(fold(polyhedron(corners, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 faces 0, 1 and 2 meet at one edge | until two are left
print(fold(polyhedron(corners, [[0, 1, 2], [0, 1, 3]]), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 faces 0 and 1 | counterclockwise
print(fold(polyhedron(corners, [[0, 1, 2], [0, 5, 1]]), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 1 has no area | off one line
print(fold(polyhedron(corners, [[0, 1, 2], [3, 4, 5]]), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 from face 0 to face 1 | that coincide
print(fold(polyhedron([[0m, 0m, 0m], [1e12m, 0m, 0m], [0m, 1e12m, 0m]], [[0, 1, 2]]), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0 has a corner farther away than 1 km | unit of a file
print(fold(polyhedron([], []), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^ E0803 no faces | at least one
print(fold(geodesic(radius: 1m, parts: 6), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 at most 400 | a coarser mesh

--- a panel, and two panels
use std.mori.Mori
let s = 80mm
let h = s * sqrt(0.75)
let corners: List<Vec3<Length>> = [[0m, 0m, 0m], [s, 0m, 0m], [s / 2, h, 0m], [s / 2, -h * cos(50deg), h * sin(50deg)]]
let one = fold(polyhedron(corners, [[0, 1, 2]]), module: Mori)
print(one.layouts, one.optimal, one.order, one.duration, verify(one).ok)
//> 1 true [] 0ms true
let two = fold(polyhedron(corners, [[0, 1, 2], [1, 0, 3]]), module: Mori)
print(two.layouts, two.optimal, two.gap, two.order, verify(two).ok)
//> 1 true 0 [[1]] true

--- a face that there isn't
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, root: 8).layouts)
//                                                     ^ E0506 there are 8

--- a module that is no panel
use std.smores.Smores
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Smores).layouts)
//                                         ^^^^^^ E0506 no panel: it has more than one link

--- a step that the hinges can't keep
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, step: 1s).layouts)
//                                                     ^^ E0506 can't fold as fast | steps of 1.47s are long enough

--- every layout that ties is counted, and random orders are compared
use std.mori.Mori
use std.shapes.octahedron
let all = fold(octahedron(edge: 80mm), module: Mori, method: enumerate, sequence: leaves_first)
print(all.tied, all.ties, all.price, abs(all.energy / all.bound - 1) < 1e-6, all.fewest_steps, all.optimal)
//> 192 [0, 1, 2, 3, 4, 5, 6, 7] 1 true 3 true
let some = random_orders(all, orders: 200, seed: 3)
print(some.orders, some.worse > 0.5, some.least >= all.energy * 0.999999, some.mean > all.energy)
//> 200 true true true
print(random_orders(all, orders: 200, seed: 3).mean == some.mean, random_orders(all, orders: 200).mean == some.mean)
//> true false

--- other objectives and conventions
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron, quadruped18}
let plain = fold(octahedron(edge: 80mm), module: Mori, root: 0)
let peak = fold(octahedron(edge: 80mm), module: Mori, root: 0, minimise: peak_torque)
print(peak.peak_torque <= plain.peak_torque, peak.energy >= plain.energy, peak.optimal)
//> true true true
let steps = fold(quadruped18(edge: 80mm), module: Mori, minimise: steps)
print(steps.steps, steps.fewest_steps, steps.optimal, steps.price)
//> 4 4 true 1
let heavy = fold(octahedron(edge: 80mm), module: Mori, root: 0, inertia: prism)
print(heavy.energy > plain.energy, fold(octahedron(edge: 80mm), module: Mori, root: 0, inertia: point).energy < plain.energy)
//> true true
let tetra = tetrahedron(edge: 80mm)
let lifted = fold(tetra, module: Mori, root: 0, gravity: on)
print(lifted.energy > fold(tetra, module: Mori, root: 0).energy, lifted.assumes.gravity > 9m/s^2, lifted.bound <= lifted.energy, verify(lifted).ok)
//> true true true true

--- orders
use std.mori.Mori
use std.shapes.quadruped18
let quad = quadruped18(edge: 80mm)
let work = fold(quad, module: Mori, sequence: least_work)
let cheap = fold(quad, module: Mori, sequence: least_energy)
let plain = fold(quad, module: Mori, sequence: leaves_first)
print(work.lifting < plain.lifting, work.lifting >= work.lifting_bound, cheap.energy < plain.energy, cheap.optimal)
//> true true true false

--- no order with a name spends less than the layout and the order that are sought together
use std.mori.Mori
use std.shapes.{icosahedron, octahedron, quadruped18}
let quad = quadruped18(edge: 80mm)
let free = fold(quad, module: Mori, root: 8, step: 1s)
print(verify(free).ok, free.bound <= free.energy, free.energy < fold(quad, module: Mori, root: 8, step: 1s, sequence: leaves_first).energy * 0.65)
//> true true true
let named = [
  fold(quad, module: Mori, root: 8, step: 1s, sequence: leaves_first),
  fold(quad, module: Mori, root: 8, step: 1s, sequence: root_first),
  fold(quad, module: Mori, root: 8, step: 1s, sequence: least_work),
  fold(quad, module: Mori, root: 8, step: 1s, sequence: least_energy),
  fold(quad, module: Mori, root: 8, step: 1s, method: heuristic),
  fold(quad, module: Mori, root: 8, step: 1s, method: enumerate),
]
print([free.energy <= other.energy * (1 + 1e-9) for other in named])
//> [true, true, true, true, true, true]
// What the orders for single layouts reached: 0.015134, 0.0112925 and 0.0134895 N*m.
print(free.energy < 0.0151345J, fold(quad, module: Mori, step: 1s).energy < 0.0112930J, fold(icosahedron(edge: 80mm), module: Mori, step: 1s).energy < 0.0134900J)
//> true true true

--- passive panels, and hinges that are too thick
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron}
let light = fold(octahedron(edge: 80mm), module: Mori, passive: [6, 7], passive_module: Mori(weight: 8g))
print(light.layouts, mass(light.robot), light.optimal)
//> 160 172g true
print(fold(tetrahedron(edge: 80mm), module: Mori, root: 0, hinge_radius: 6mm).too_thick)
//> []
print(fold(tetrahedron(edge: 80mm), module: Mori, root: 0, hinge_radius: 5mm).too_thick)
//> [1, 2, 3]

--- a layout of one's own
use std.mori.Mori
use std.shapes.tetrahedron
let path = fold(tetrahedron(edge: 80mm), module: Mori, root: 0, hinges: [[0, 1], [1, 2], [2, 3]])
print(path.layout.hinges, path.steps, path.optimal, path.energy > path.bound)
//> [[0, 1], [1, 2], [2, 3]] 3 false true

--- options that don't go together
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, method: heuristic, gravity: on).layouts)
//                                                       ^^^^^^^^^ E0506 moving joints without gravity

--- an order that is not found under gravity
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, count: all, sequence: least_energy).layouts)
//                                                                     ^^^^^^^^^^^^ E0506 moving joints without gravity

--- a value that an option does not know
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, inertia: sheet).layouts)
//                                                        ^^^^^ E0206 lamina

--- passive panels of nothing
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, passive: [0]).layouts)
//                                                        ^^^ E0506 of what

--- passive panels that nothing drives
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, passive: [i for i in 0..8], passive_module: Mori(weight: 8g)).layouts)
//                                                        ^^^^^^^^^^^^^^^^^ E0803 no chain of hinges with motors

--- a passive face that there isn't
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, passive: [9], passive_module: Mori).layouts)
//                                                        ^^^ E0506 there is no face 9

--- hinges that are no layout
use std.mori.Mori
use std.shapes.tetrahedron
print(fold(tetrahedron(edge: 80mm), module: Mori, hinges: [[0, 1], [1, 2]]).layouts)
//                                                        ^^^^^^^^^^^^^^^^ E0506 join not all 4 faces

--- too many layouts to simulate
use std.mori.Mori
use std.shapes.icosahedron
print(fold(icosahedron(edge: 80mm), module: Mori, method: enumerate, count: all).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^ E0802 too many layouts

--- the heuristic knows one mass
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, method: heuristic, passive: [0], passive_module: Mori(weight: 8g)).layouts)
//                                                       ^^^^^^^^^ E0506 equally heavy

--- the least peak torque of a larger shape is proved, or approached with its bound stated
use std.mori.Mori
use std.shapes.{icosahedron, tube}
let peak = fold(icosahedron(edge: 80mm), module: Mori, minimise: peak_torque, root: 0)
print(peak.bound > 0N*m, peak.bound <= peak.peak_torque * (1 + 1e-9), peak.optimal, peak.gap, verify(peak).ok)
//> true true true 0 true
let wide = fold(tube(sides: 6, rings: 3, edge: 80mm), module: Mori, minimise: peak_torque, budget: 1_000_000)
print(wide.bound > 0N*m, wide.bound <= wide.peak_torque, verify(wide).ok)
//> true true true

--- a shape that can lie on none of its faces is not folded on the ground
use std.mori.Mori
use std.shapes.{stella_octangula, icosahedron}
print(fold(stella_octangula(edge: 80mm), module: Mori, gravity: on).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0801 whichever face lies on the ground, others reach below it | `gravity: off`
print(fold(stella_octangula(edge: 80mm), module: Mori, gravity: on, root: 3).layouts)
//                                                                        ^ E0801 below face 3, which would lie on the ground

--- refolding what has sides of another length, or is no panel
use std.mori.Mori
use std.smores.Smores
use std.shapes.{octahedron, tetrahedron, boat}
print(refold(octahedron(80mm), tetrahedron(70mm), module: Mori).changes)
//                             ^^^^^^^^^^^^^^^^^ E0803 70.0000 | 80.0000
print(refold(octahedron(80mm), tetrahedron(80mm), module: Mori).flat)
//> 4
print(refold(octahedron(80mm), boat(70mm), module: Mori).changes)
//                             ^^^^^^^^^^ E0803 70.0000 | 80.0000
print(refold(octahedron(80mm), boat(80mm), module: Smores).changes)
//                                                 ^^^^^^ E0506 no panel: it has more than one link
print(refold(octahedron(80mm), boat(80mm), module: Mori, step: 1ms).changes)
//                                                             ^^^ E0506 as fast as that

--- the gap of a folding is what its proof leaves open
use std.mori.Mori
use std.shapes.{octahedron, tube}
let e = 80mm
print(fold(octahedron(e), module: Mori).gap, fold(octahedron(e), module: Mori, method: enumerate).gap)
//> 0 0
print(fold(octahedron(e), module: Mori, method: heuristic).gap < 1e-9)
//> true
let short = fold(tube(sides: 4, rings: 2, edge: e), module: Mori, budget: 1)
print(short.optimal, short.gap >= 0, short.gap < 1, short.bound <= short.energy)
//> false true true true

--- a bound holds for the orders that the answer was chosen from
use std.mori.Mori
use std.shapes.{octahedron, quadruped18, tube}
// With the leaves first no layout passes the judge, and other orders spend less than any layout with the leaves first.
let lifted = fold(octahedron(edge: 80mm), module: Mori, gravity: on, count: all)
print(lifted.price < 1, lifted.bound > 0N*m, lifted.bound < lifted.energy, lifted.gap > 0, lifted.optimal)
//> true true true true false
let tall = fold(tube(sides: 4, rings: 6, edge: 80mm), module: Mori, budget: 1_000_000)
print(tall.price < 1, tall.bound > 0N*m, tall.bound < tall.energy, tall.gap > 0, tall.optimal)
//> true true true true false
let quad = quadruped18(edge: 80mm)
let cheap = fold(quad, module: Mori, root: 8, sequence: least_energy)
print(cheap.price < 1, cheap.bound > 0N*m, cheap.bound < cheap.energy, cheap.gap > 0, cheap.optimal)
//> true true true true false
// What the judge refuses is no part of the bound: the next best, which costs more, is proved.
let next = fold(quad, module: Mori, root: 8, sequence: leaves_first)
print(next.price > 1.1, next.bound < next.energy, abs(next.bound / next.energy - 1) < 4e-9, next.gap, next.optimal)
//> true true true 0 true

--- a search for sheets that its budget ends has a way, and says within what it is the best
use std.mori.Mori
use std.shapes.{octahedron, tube}
let from = octahedron(edge: 80mm)
let to = tube(sides: 4, rings: 1, edge: 80mm)
let soon = refold(from, to, module: Mori, budget: 0)
let best = refold(from, to, module: Mori)
print(soon.changes >= best.changes, soon.gap >= best.gap, verify(soon).ok)
//> true true true

--- panels made to measure fold as those do that happen to fit
use std.mori.{Mori, Panel}
use std.shapes.octahedron
let fits = fold(octahedron(edge: 80mm), module: Mori)
let made = fold(octahedron(edge: 80mm), module: Panel)
print(abs(made.energy / fits.energy - 1) < 1e-9, made.order == fits.order, made.optimal, made.gap)
//> true true true 0
print(abs(mass(Panel()) / mass(Mori()) - 1) < 1e-9, abs(mass(Panel(sides: [60mm, 80mm, 100mm])) / (18g + 8g * 2400mm^2 / (sqrt(3) * 1600mm^2)) - 1) < 1e-9)
//> true true

--- spheres, tori and other shapes of unequal triangles are folded of panels made to measure
use std.mori.Panel
use std.shapes.{geodesic, torus}
let cap: List<Vec3<Length>> = [[0mm, 0mm, 60mm]] ++ [[(100mm + i * 10mm) * cos(60deg * i), 90mm * sin(60deg * i), 0mm] for i in 0..6]
let open = fold(polyhedron(cap, [[0, i + 1, (i + 1) % 6 + 1] for i in 0..6]), module: Panel(thickness: 4mm), sequence: leaves_first)
print(open.layouts, open.optimal, open.layout.overlaps, verify(open).ok, len(open.hinges))
//> 6 true [] true 5
// The best pattern of a torus overlaps.
let ring = fold(torus(radius: 300mm, tube: 150mm, around: 4, across: 4), module: Panel(thickness: 1mm), budget: 3_000_000)
print(ring.layout.panels, ring.layout.overlaps, ring.bound <= ring.energy, ring.optimal, ring.price > 1.05, verify(ring).ok)
//> 32 [] true false true true
// Passive ones are made to measure, too.
let light = fold(polyhedron(cap, [[0, i + 1, (i + 1) % 6 + 1] for i in 0..6]), module: Panel, passive: [1, 3], passive_module: Panel(motors: 1g), sequence: leaves_first)
print(mass(open.robot) - mass(light.robot) > 10g, light.optimal)
//> true true

--- panels of which a face can't be made, whenever they are asked for
use std.mori.Panel
use std.shapes.geodesic
print(fold(geodesic(radius: 20mm, parts: 2), module: Panel).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0, with sides of 10.9307mm, 12.3607mm and 10.9307mm, can't be made: the panel is too thick | thinner
print(fold(geodesic(radius: 20mm, parts: 2), module: Panel).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 the panel is too thick
print(fold(geodesic(radius: 20mm, parts: 2), module: Panel(thickness: 0.5mm)).layouts)
//> 3497104100935210106880000000

--- panels that fit no face, and sides that are stated where they are measured
use std.mori.{Mori, Panel, Edge}
use std.shapes.{octahedron, geodesic}
let ball = geodesic(radius: 200mm, parts: 2)
print(fold(ball, module: Mori).layouts)
//         ^^^^ E0803 face 0 has a side of 109.3066 mm | `Panel` of `std.mori`
print(fold(ball, module: Panel(sides: [60mm, 80mm, 100mm])).layouts)
//                       ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 the sides of its face
print(fold(ball, module: Panel, method: heuristic).layouts)
//                                      ^^^^^^^^^ E0506 all panels for equal
print(refold(ball, ball, module: Panel).changes)
//           ^^^^ E0803 face 0 has a side of | all sides of both shapes
module Stubborn(sides: List<Length> = [80mm, 80mm, 80mm]) {
  mass 20g
  link panel = prism([[40mm * cos(a), 40mm * sin(a), 0mm] for a in [-150deg, -30deg, 90deg]], height: 5mm)
  for i in 0..3 {
    port edge[i] : Edge on panel
      at [40mm / sqrt(3) * cos(120deg * i - 90deg), 40mm / sqrt(3) * sin(120deg * i - 90deg), 0mm]
      facing [cos(120deg * i - 90deg), sin(120deg * i - 90deg), 0] up +Z
  }
}
print(fold(ball, module: Stubborn).layouts)
//         ^^^^ E0803 does not keep to its parameter `sides`

--- a panel whose ports face anywhere is none
use std.mori.Edge
use std.shapes.octahedron
module Inward {
  mass 20g
  link panel = prism([[40mm * cos(a), 40mm * sin(a), 0mm] for a in [-150deg, -30deg, 90deg]], height: 5mm)
  for i in 0..3 {
    port edge[i] : Edge on panel
      at [40mm / sqrt(3) * cos(120deg * i - 90deg), 40mm / sqrt(3) * sin(120deg * i - 90deg), 0mm]
      facing [-cos(120deg * i - 90deg), -sin(120deg * i - 90deg), 0] up +Z
  }
}
print(fold(octahedron(edge: 80mm), module: Inward).layouts)
//                                         ^^^^^^ E0506 facing outwards
