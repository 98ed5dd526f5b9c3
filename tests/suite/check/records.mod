--- fields are given by name
record Design { bend: Angle = 30deg, speed: Speed }
let a = Design(30deg, 2m/s)
//             ^^^^^ E0205 the fields of `Design` are given by name | `Design(bend: 30deg, speed: 2m/s)`
let b = Design(bnd: 30deg, speed: 2m/s)
//             ^^^ E0205 `Design` has no field `bnd` | `bend`?
let c = Design(bend: 30deg)
//      ^^^^^^^^^^^^^^^^^^^ E0205 also needs `speed` | one field is not given
let d = Design(bend: 1deg, speed: 2m/s, bend: 2deg)
//                                            ^^^^ E0205 `bend` is given twice
let e = Design(bend: 3m, speed: 2m/s)
//                   ^^ E0201 `bend` wants an angle (deg); `3m` is a length
let f = Design
//      ^^^^^^ E0205 `Design` needs `speed`
let g = Design(speed: 2m/s, x)
//                          ^ E0205 given by name
let h = Design(2m/s, bend: 3deg)
//             ^^^^ E0205 `Design(bend: 3deg, speed: ...)`

--- a record is of its own type
record A { x: Int }
record B { x: Int }
let a: A = B(x: 1)
//         ^^^^^^^ E0202 `a` wants a `A`; `B(x: 1)` is a `B`
let b = [A(x: 1), B(x: 1)]
//       ~~~~~~~ the list began with a `A`
//                ^^^^^^^ E0202 this is a `B`
fn f(a: A) -> Int = a.x
print(f(B(x: 1)), A(x: 1) == B(x: 1))
//      ^^^^^^^ E0202 `a` wants a `A`
//                        ^^ E0207 `==` does not take a `A` and a `B`

--- fields are read, and changed in a copy
record A { size: Length, n: Int = 1 }
let a = A(size: 1m)
print(a.szie)
//      ^^^^ E0107 a A has no `szie` | `size`?
print(a with { size: 2s })
//                   ^^ E0201 `size` wants a length
print(a with { szie: 2m, n: 1, n: 2 })
//             ^^^^ E0205 `A` has no field `szie` | `size`?
//                                ^ E0205 `n` is given twice
print(3 with { size: 2m })
//    ^ E0207 `with` gives a changed copy of a record, not of a whole number
print(a.size + a.n, (a with { n: 2 }).n + 1)
//           ^ E0201
use std.smores.Smores
print(Smores() with { n: 1 })
//    ^^^^^^^^ E0207 not of a `Smores` | `Smores(...)`
print(world() with { friction: 1 })
//    ^^^^^^^ E0207 not of a `World`

--- a record in itself needs an end
record A { b: B }
//         ^ E0108 a `A` would hold another `A` | `b: B?` | `b: List<B>`
record B { a: A, n: Int }
record C { c: C = C() }
//         ^ E0108 a `C` would hold another `C`
record D { d: List<D>, e: D?, f: fn(D) -> D }
record E { c: C }

--- what can't be compared is named
record A { name: Text, f: fn(Int) -> Int }
record B { many: List<A> }
record C { c: C?, n: Int }
fn same(x: A, y: A) -> Bool = x == y
//                              ^^ E0207 its field `f`, a `fn(Int) -> Int`, can't be compared
fn differ(x: B, y: B) -> Bool = x != y
//                                ^^ E0207 its field `many.f`
fn equal(x: C, y: C) -> Bool = x == y

--- names and types of fields
record A { a: Int, a: Int }
//         ~ first declared here
//                 ^ E0102 `a` is declared twice
record B { maxSpeed: Speed, b: Nothing, true: Int }
//         ^^^^^^^^ W0001 parameters and fields are written like `max_speed`
//                             ^^^^^^^ E0209
//                                      ^^^^ E0001 `true` is a truth value
record low { a: Int = 3m }
//     ^^^ W0001 are written like `Low`
//                    ^^ E0201 `a` wants a number
let b = low
let Tool = low
//  ^^^^ W0001
record Tool { a: Int }
//     ^^^^ E0102
