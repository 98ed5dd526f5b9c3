--- a text states units and decimals
let x = 453.21725mm
print("{x in mm:.2} {x in m} {x:.1} {x in cm:.0} {x in km:.6}")
//> 453.22mm 0.45321725m 453.2mm 45cm 0.000453km
print("{[x, 2m] in cm:.1} {30deg in rad:.4} {6rad/s in deg/s:.1} {1/3:.3} {7:.2} {7}")
//> [45.3cm, 200.0cm] 0.5236rad 343.8deg/s 0.333 7.00 7
let at: Vec3<Length> = [1mm, 20mm, -3mm]
print("{at in cm:.1} {first([y for y in [1m] if y > 2m]) in mm}")
//> [0.1cm, 2.0cm, -0.3cm] _
print("{-0.001m in m:.2} {0.001m in m:.2} {2rad/s * 45mm in mm/s:.1}")
//> 0.00m 0.00m 90.0mm/s

--- whole numbers and ten digits are exact, all else has six digits
print(20000000.5, 1234567.891, 123456789012.0, -0.5, 1e15, 2.5e-7)
//> 20000000.5 1234567.891 123456789012 -0.5 1e15 2.5e-7
print(0.1 + 0.2, 1 / 3, 10000000 / 3, 1000000 / 7, 2 / 3 * 1e-7)
//> 0.3 0.333333 3333333 142857 6.66667e-8
print(12.3456789mm, 30deg, 90deg / 7, 1.000000001kg, 1.00000000001kg)
//> 12.3456789mm 30deg 12.8571deg 1.000000001kg 1kg

--- a unit of another dimension
print("{1m in s:.2}")
//      ^^ E0201 a length can't be shown in `s`
//            ~ another dimension

--- an unknown unit
print("{1m in furlong}")
//            ^^^^^^^ E0203 `furlong` is no unit

--- decimals of what is no quantity
let name = "a"
print("{name:.2}")
//      ^^^^ E0202 are for quantities; this is a `Text`

--- more decimals than there are
print("{1m:.21}")
//         ^^^ E0008 at most 20 decimals

--- texts are filled up
print(pad("ab", 4), pad("ab", 4, align: right), pad("ab", 5, align: centre), pad("abc", 2), pad("é", 2), 1)
//> ab     ab  ab   abc é  1
print(pad("a", -1))
//             ^^ E0506 must not be negative

--- a list of records is a table
record Leg { name: Text, bend: Angle, mass: Mass, reach: Length?, n: Int, ok: Bool }
let legs = [
  Leg(name: "left", bend: 30deg, mass: 4kg, reach: 0.25m, n: 3, ok: true),
  Leg(name: "far right", bend: -45.5deg, mass: 250g, reach: _, n: 12, ok: false),
]
print(legs)
//> name       bend [deg]  mass [kg]  reach [mm]   n  ok
//> left             30.0       4.00         250   3  true
//> far right       -45.5       0.25           _  12  false
print("as text:", [legs[0]])
//> as text: [Leg(name: "left", bend: 30deg, mass: 4kg, reach: 250mm, n: 3, ok: true)]

--- records in records, vectors, margins without limit
use std.smores.Chain3
record Inner { at: Vec3<Length>, free: Length }
record Outer { inner: Inner, list: List<Int> }
let free = verify(Chain3(), world: world(ground: off, gravity: off)).margin
print([Outer(inner: Inner(at: [1mm, 2m, 0mm], free: free), list: [1, 2])])
//> inner.at.x [mm]  inner.at.y [m]  inner.at.z [m]  inner.free [m]  list
//>               1               2               0        infinite  [1, 2]

--- records of two kinds, and none
record A { a: Int }
let none: List<A> = []
print(none)
//> []
print([A(a: 1)] ++ [A(a: 2) with { a: 3 }])
//> a
//> 1
//> 3

--- an ending that does not fit says what does
record A { a: Int }
save([A(a: 1)], "a.rofi")
//              ^^^^^^^^ E0506 a list of records is saved as `.csv` or `.json`; `.rofi` is for a robot

--- an unknown ending lists the known ones
use std.smores.Car
save(Car(), "car.sdf")
//          ^^^^^^^^^ E0506 `.sdf` is no format that `save` knows | `.gif` or `.frames`, a robot as `.mjcf.xml`, `.urdf`,

--- a name without an ending
save([1, 2], "a")
//   ^^^^^^ E0506 a list of records is wanted

--- an empty list has nothing to save
record A { a: Int }
let none: List<A> = []
save(none, "a.csv")
//   ^^^^ E0506 an empty list has no records

--- of a plan a model is saved; the plan itself is emitted
use std.smores.Car
save(plan(Car().drive(t: 1s)), "a.rofi")
//                             ^^^^^^^^ E0506 a plan is saved as `.mjcf.xml`, `.urdf`, | `emit` writes the plan itself
save(Car().drive(t: 1s), "a.plan.json")
//                       ^^^^^^^^^^^^^ E0506 `.json` is for a robot
save(Car().drive(t: 1s), "a.xml")
//                       ^^^^^^^ E0506 `.xml` is no format that `save` knows

--- a name of the ending alone
use std.smores.Car
save(Car(), "mjcf.xml")
//          ^^^^^^^^^^ E0506 `.xml` is no format

--- a lattice has no links and joints
use std.crystal.ExpandingCube
lattice A of ExpandingCube = row(4)
lattice B of ExpandingCube = column(4)
save(squeeze(A, B), "a.mjcf.xml")
//   ^^^^^^^^^^^^^ E0506 a model for MuJoCo is one of links and joints

--- a closed loop is no tree
use std.smores.Ring12
save(Ring12(), "ring.urdf")
//   ^^^^^^^^ E0506 URDF has no closed loops, and the bond

--- a motion that fails is not written for a robot
use std.smores.Chain3
let c = Chain3()
save(move(c.m[1].tilt, to: 10deg, in: 1ms), "a.trajectory.yaml")
//                                    ^^^ E0402 can't do this in 1ms

--- a list is no robot
save([1, 2], "a.mjcf.xml")
//   ^^^^^^ E0506 a list of records is wanted

--- a lattice is no robot
use std.crystal.ExpandingCube
lattice A of ExpandingCube = row(4)
save(A(), "a.mjcf.xml")
//   ^^^ E0202

--- a chain that MuJoCo does not read
use std.smores.Smores
config Chain(n: Int) {
  part m[n]: Smores
  for i in 0..n - 1 { connect m[i].top -- m[i + 1].bottom }
  base m[0]
}
save(Chain(n: 166), "a.mjcf.xml")
//   ^^^^^^^^^^^^^ E0506 498 links hang on each other in a row, and MuJoCo reads 496 at most

--- outside of the output folder
record A { a: Int }
save([A(a: 1)], "../a.csv")
//              ^^^^^^^^^^ E0701
