--- a program without mistakes
let reach = 120mm
fn ramp(i: Int, n: Int) -> Number = i / (n - 1)
print(ramp(1, 3), reach + 1cm, 2rad/s * 45mm)

--- dimensions do not mix
let a = 1mm + 1s
//          ^ E0201 a length | a time
//      ~~~ this is a length

--- an angle is no number
let n: Number = 30deg
//              ^^^^^ E0201 a number | an angle

--- a plain number is no angle
print(sin(0.5))
//        ^^^ E0201 `x` wants an angle (deg); `0.5` is a number | in radians? `0.5rad`
print(sin(1.57), sin(90), sin(2))
//        ^^^^ E0201 `1.57` is a number | in radians? `1.57rad`
//                   ^^ E0201 `90` is a number | in degrees? `90deg`
//                            ^ E0201 `2` is a number | in radians it is `2rad`, in degrees `2deg`
print(90deg + 1.57, 90deg + 45)
//          ^ E0201 an angle and a number do not go together in `+` | in radians? `1.57rad`
//                        ^ E0201 a whole number | `45deg`
let turned = 1.57
print(cos(turned))
//        ^^^^^^ E0201 in radians it is `turned * 1rad`, in degrees `turned * 1deg`

--- revolutions per minute
print(60rpm == 1turn / 1s, 5rpm < 1rad/s)

--- units that are others here
let a = 3inch
//       ^^^^ E0203 `inch` is no unit | an inch is `25.4mm`
let b = 3in
//       ^^ E0203 `in` is no unit | an inch is `25.4mm`
let c = 2lb + 3000RPM
//       ^^ E0203 a pound is `0.45359237kg`
//                ^^^ E0203 write `rpm`

--- radians are dropped from products, and never invented
let v: Speed = 2rad/s * 45mm
let e: Energy = 2N*m * 90deg
let w: AngularSpeed = 1m/s / 45mm
//                    ^^^^^^^^^^^ E0201 an angular speed (rad/s) | a frequency
let f: Frequency = 2rad/s
//                 ^^^^^^ E0201 a frequency (Hz) | an angular speed

--- energies and torques stand for each other, and errors name the one that is wanted
let e: Energy = 3N*m
let t: Torque = e
let late: Energy = 3s
//                 ^^ E0201 `late` wants an energy (J); `3s` is a time
let long: Torque = 3m
//                 ^^ E0201 `long` wants a torque or energy (N*m)

--- a stiffness is no torque
let t: Torque = 3N*m/rad
//              ^^^^^^^^ E0201 a torque

--- no unit of that name, once
let x = 5n + 3zz
//       ^ E0203 `n` is no unit | `90deg / n`
//            ^^ E0203 `zz` is no unit

--- the suffix sticks to the number
let s = 2
let a = 6rad/s
//           ^ W0002 the unit, not the variable
let b = 6rad / s
let c: Angle = b
let d: AngularSpeed = a

--- misspelt names are guessed
let reach = 1m
print(raech)
//    ^^^^^ E0101 `raech` is not known here | `reach`?

--- what follows from a mistake is not said again
let a = oops
//      ^^^^ E0101
let b = a + 1mm
let c = [b, a, 3s]
print(c, b.x, a(1))

--- an unknown name is said at each place where it stands
print(oops)
//    ^^^^ E0101
print(oops + 1)
//    ^^^^ E0101

--- powers
let a: Area = (2m)^2
let v: Volume = 2 * (1cm)^3
let n = 2
let b = (2m)^n
//           ^ E0207 a whole number, written out
let r: Length = sqrt(4m^2)

--- choices
config C {
  part m: M
  behavior b = move(m.j, to: 3deg, profile: smoth)
//                                          ^^^^^ E0206 none of the choices | `smooth`?
}
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint j: a -> b = revolute(axis: X)
}

--- optional values
let xs = [1mm, 2mm]
let a: Length = first(xs)
//              ^^^^^^^^^ E0202 first(xs) else ...
let b: Length = first(xs) else 0mm
let c = 3mm else 1mm
//      ^^^ E0202 never missing

--- lists have elements of one type
let xs = [1mm, 2s]
//             ^^ E0202 of one type
//        ~~~ the list began with a length
let ys = [1, 2.5]
let zs: List<Number> = ys
let empty: List<Length> = []

--- vectors where vectors are expected
let p: Vec3<Length> = [1mm, 2mm, 3mm]
let q: Vec3<Length> = [1mm, 2, 3mm]
//                          ^ E0201 each coordinate wants a length
let path: List<Vec3<Length>> = [[0m, 0m, 0m], [1m, 0m, 0m]]
print(p + q, p.x, norm(p), 2 * p)

--- functions
fn half(x: Length) = x / 2
let h: Length = half(3mm)
let k = half(3s)
//           ^^ E0201 `x` wants a length
let l = half()
//      ^^^^^^ E0205 `half` also needs `x`
let m = half(1mm, 2mm)
//                ^^^ E0205 too many arguments
let n = half(y: 1mm)
//           ^ E0205 no parameter `y`

--- an argument without a name goes to the first parameter that has none
fn line(from: Length, to: Length, n: Int = 2) = (to - from) / n
let a = line(from: 1m, 3m, 4) + line(1m, n: 4, 3m) + line(to: 3m, n: 4, 1m)
let b = line(1m, from: 2m, 3m)
//                     ^^ E0205 `from` is given twice
let c = line(to: 3m, 1m, 2, 5)
//                          ^ E0205 too many arguments for `line`
let d = Pc(behaviors: wait(1s), wait(2s))
//                              ^^^^^^^^ E0205 too many arguments for `Pc`

--- a result that needs itself
fn f(n: Int) = f(n - 1)
//             ^^^^^^^^ E0210 `f` | `-> Type`
fn g(n: Int) -> Int = g(n - 1)

--- declarations that need each other
let a = b
let b = a
//      ^ E0108 `a` needs itself

--- lambdas and what they capture
let offset = 2
let k = 3
fn apply(f: fn(Int) -> Int, x: Int) -> Int = f(x)
print(apply(x => x * k + offset, 4))
let bad = x => x
//        ^^^^^^ E0210

--- declared twice
let a = 1
let a = 2
//  ^ E0102
fn f(x: Int, x: Int) -> Int = x
//           ^ E0102 `x` is declared twice

--- conditions are no truth values
config C {
  part m: M
  behavior a = move(m.j, to: 3deg, until: angle(m.j) > 1deg and elapsed() > 1s, timeout: 2s) else abort("late")
  behavior b = move(m.j, to: 3deg, until: 1 < 2)
//                                        ^^^^^ E0202 `until` wants
  behavior c = if angle(m.j) > 1deg { a() } else { b() }
//                ^^^^^^^^^^^^^^^^^ E0202 the condition wants true or false
}
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint j: a -> b = revolute(axis: X)
}

--- a block is its last line
fn area(r: Length) -> Area = {
  let d = 2 * r
  d * d
}
fn lost(r: Length) -> Length = {
  r * 2
//^^^^^ E0202 is lost
  r
}

--- comparisons and texts
let a = "x" + "y"
//          ^ E0207 `++`
let b = "x" ++ "y {1 + 2mm}"
//                   ^ E0201
let c = [1] ++ [2]
let d = 1mm < 2mm and 3 == 3

--- types that are none
fn f(x: Lenght) -> Int = 1
//      ^^^^^^ E0209 `Length`?
fn g(x: List) -> Int = 1
//      ^^^^ E0209
let y: Smores = 1
//     ^^^^^^ E0209

--- names are styled
let maxSpeed = 1
//  ^^^^^^^^ W0001 `max_speed`
config my_arm { }
//     ^^^^^^ W0001 `MyArm`

--- nothing has no value
let x = print(1)
//      ^^^^^^^^ E0202 no value

--- joints of connections
use std.mori.Mori
use std.smores.Smores
config Strip { part m[3]: Mori
  for i in 0..2 { connect m[i].edge[1] -- m[i + 1].edge[0] }
  behavior a() = move(m[1].edge[1], to: 10deg)
//                    ^^^^^^^^^^^^ E0202 this is a `Port` | `m[1].edge[1].joint`
  behavior b() = move(m[1].edge.joint, to: 10deg)
//                              ^^^^^ E0107 a `List<Port>` has no `joint`
}
config Stiff { part m: Smores
  behavior b() = move(m.tilt.port, to: 10deg)
//                           ^^^^ E0107 a `Joint<Angle>` has no `port`
}

--- words of a call that is wrong itself
print(plan(wait(1s), wolrd: settle), nothing(off, 1mm + 1s))
//                   ^^^^^ E0205 no parameter `wolrd`
//                                   ^^^^^^^ E0101 no such name
//                                                    ^ E0201 a length and a time

--- a plain number beside a quantity
let a = 30deg + 2
//            ^ E0201 an angle | `2deg`
//      ~~~~~ this is an angle

--- a plain number where a quantity is wanted, with its sign
use std.smores.Smores
config C {
  part m: Smores
  behavior b = move(m.tilt, to: -50)
//                              ^^^ E0201 `to` wants an angle (deg) | `-50deg`
}

--- a length where an angle is wanted
fn g(a: Angle) = a * 2
let y = g(2mm)
//        ^^^ E0201 `a` wants an angle (deg); `2mm` is a length | `deg`

--- a quotient where a whole number is wanted
let l = [1, 2, 3]
let half = l[4 / 2]
//           ^^^^^ E0202 a whole number | `div(a, b)`

--- types of other languages
let x: float = 2.0
//     ^^^^^ E0209 `float` | `Number`
let z: str = "a"
//     ^^^ E0209 `str` | `Text`

--- a name of the library that is not imported
let m = Smores
//      ^^^^^^ E0101 `Smores` | `use std.smores.Smores`

--- equal elements of a list
let l = [0] * 3
//          ^ E0207 `*` | `[0 for i in 0..3]`

--- a parameter and a field that were renamed
use std.truss.PneumaticReel
truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let walk = locomote(P, path: [[3m, 0m, 0m]], ladder: false)
//                                           ^^^^^^ E0205 no parameter `ladder` | now called `fallbacks`
print(locomote(P, path: [[3m, 0m, 0m]]).eased)
//                                      ^^^^^ E0107 now called `relaxed_steps`

--- a module, cell, strut or connector of the library that is not imported
config A { part m: Smores }
//                 ^^^^^^ E0209 `Smores` is not known here | the library has it: `use std.smores.Smores`
lattice L of ExpandingCube = row(3)
//           ^^^^^^^^^^^^^ E0209 `use std.crystal.ExpandingCube`
truss T of PneumaticReel = octet(edge: 4m, divisions: 4)
//         ^^^^^^^^^^^^^ E0209 `use std.truss.PneumaticReel`
module M { mass 1kg  link a = box(1cm, 1cm, 1cm)
  port x: EPFace on a at [5mm, 0mm, 0mm] facing +X up +Z
//        ^^^^^^ E0101 `EPFace` is not known here | `use std.smores.EPFace`
}

--- lists that are no vectors
fn f(v: Vec3<Length>) -> Length = v.x
fn g(path: List<Vec3<Length>>) -> Int = len(path)
let two = [1m, 2m]
let three = [1m, 2m, 3m]
let path = [[2m, 1m, 0m], [3m, 1m, 0m]]
let flat = [[2m, 1m], [3m, 1m]]
print(f([1m, 2m]), f(two), f(three), f([i * 1m for i in 0..3]))
//      ^^^^^^^^ E0202 wants a `Vec3<Length>`; `[1m, 2m]` | three coordinates, `[x, y, z]`; here are 2
//                   ^^^ E0202 three coordinates, `[x, y, z]`; here are 2
//                           ^^^^^ E0202 say so where it is declared: `let three: Vec3<Length> = ...`
//                                     ^^^^^^^^^^^^^^^^^^^^^^ E0202 a vector where one is expected: `[x, y, z]`
print(g(path), g(flat), g([[1m]]))
//      ^^^^ E0202 say so where it is declared: `let path: List<Vec3<Length>> = ...`
//               ^^^^ E0202 here are 2
//                         ^^^^ E0202 here is 1
fn inside() -> Int = {
  let way = [[0m, 0m, 0m]]
  g(way)
//  ^^^ E0202 `let way: List<Vec3<Length>> = ...`
}
let told: List<Vec3<Length>> = [[2m, 1m, 0m]]
print(g(told))

--- a joint for a port, and a port for a joint
use std.smores.{Smores, Chain3}
let m = Smores()
fn at(p: Port) -> Pose = pose(p)
fn turned(j: Joint<Angle>) -> Int = 1
print(at(m.tilt), at(m), at(Chain3()))
//       ^^^^^^ E0202 wants a `Port` | the ports of `Smores` are `top`, `bottom`, `left` and `right`
//                   ^ E0202 the ports of `Smores` are
//                          ^^^^^^^^ E0202 the ports of `Chain3` are `head` and `tail`
print(turned(m.top))
//           ^^^^^ E0202 the joints of `Smores` are `tilt`, `front`, `left` and `right`
print(move(m, to: 30deg).duration)
//         ^ E0202 the joints of `Smores` are
config C { part a: Smores  part b: Smores
  connect a.tilt -- b.top
//        ^^^^^^ E0202 `connect` wants a `Port` | the ports of `Smores` are
}

--- a misspelt call beside a misspelt keyword
fn f(a: Int) -> Int = cuont([a])
//                    ^^^^^ E0101 `cuont` is not known here | `count`?
tset "one" { expect f(1) == 1 }
//<1-4 E0001 `tset` does not begin an item of a file | `test`?
use std.smores.Smores
config A { part m: Smores
  behvior nod = moev(m.tilt, to: 30deg)
//^^^^^^^ E0001 `behvior` does not begin a clause of a configuration | `behavior`?
//              ^^^^ E0101 `moev` is not known here | `move`?
}
print(A().nod().duration)

--- a torque is no action
use std.smores.Smores
config Push {
  part m: Smores
  behavior push = torque(m.tilt, 0.5N*m)
//                ^^^^^^^^^^^^^^^^^^^^^^ E0202 a `Signal<Torque>` | there is no action for a torque or a force
//                               ^^^^^^ E0205 too many arguments for `torque`
  behavior both = Sc(torque(m.tilt), wait(1s))
//                   ^^^^^^^^^^^^^^ E0202 a `Signal<Torque>` | `torque(m.tilt)` is what its motor supplies
}
