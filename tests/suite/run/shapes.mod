--- shapes of equal triangles have equal sides
use std.shapes.{tetrahedron, triangular_bipyramid, octahedron, boat, pentagonal_bipyramid, snub_disphenoid}
use std.shapes.{triaugmented_prism, gyroelongated_bipyramid, icosahedron, stella_octangula, quadruped18, tube}
fn off(mesh: Mesh) -> Length = {
  let frame = from_mesh(mesh)
  max([abs(norm(frame.nodes[s[0]] - frame.nodes[s[1]]) - 80mm) for s in frame.struts])
}
let e = 80mm
let closed = [
  tetrahedron(e), triangular_bipyramid(e), octahedron(e), boat(e), pentagonal_bipyramid(e), snub_disphenoid(e),
  triaugmented_prism(e), gyroelongated_bipyramid(e), icosahedron(e), stella_octangula(e), subdivided(icosahedron(2 * e), 2),
]
let open = [quadruped18(e), tube(sides: 4, rings: 6, edge: e), tube(sides: 6, rings: 3, edge: e), tube(sides: 3, rings: 1, edge: e)]
print([faces(m) for m in closed], [faces(m) for m in open])
//> [4, 6, 8, 8, 10, 12, 14, 16, 20, 24, 80] [18, 48, 36, 6]
print(max([off(m) for m in closed ++ open]) < 1nm)
//> true
// Euler: of a closed surface without handles, vertices and faces are edges and two.
print([len(from_mesh(m).nodes) + faces(m) - len(from_mesh(m).struts) for m in closed])
//> [2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2]

--- spheres and tori
use std.shapes.{geodesic, torus, octahedron}
let ball = geodesic(radius: 200mm, parts: 3)
let ring = torus(radius: 300mm, tube: 100mm, around: 12, across: 6)
print(faces(ball), faces(ring), [len(from_mesh(m).nodes) + faces(m) - len(from_mesh(m).struts) for m in [ball, ring]])
//> 180 144 [2, 0]
print(max([abs(norm(p) - 200mm) for p in from_mesh(ball).nodes]) < 1nm)
//> true
print(faces(subdivided(octahedron(1m), 1)))
//> 8

--- what can't be subdivided or blown up
use std.shapes.{cube, octahedron}
print(faces(subdivided(cube(1m), 2)))
//                     ^^^^^^^^ E0506 only triangles
print(faces(subdivided(octahedron(1m), 0)))
//                                     ^ E0506 at least one part
print(faces(subdivided(octahedron(1m), 1_000_000_000)))
//          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0505
print(faces(on_sphere(octahedron(1m), 0m)))
//                                    ^^ E0506 radius
print(faces(on_sphere(polyhedron([[0m, 0m, 0m], [1m, 0m, 0m], [0m, 1m, 0m]], [[0, 1, 2]]), 1m)))
//                    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 no direction
