--- fields between commas or line breaks
/// A leg.
record Design {
  /// How far it bends.
  bend: Angle = 30deg
  speed: Speed, for: Time?

  many: List<Design> = [],
}
//> (doc "A leg." (record Design (doc "How far it bends." bend:Angle=30'deg) speed:Speed for:Time? many:List<Design>=[]))
record Empty {}
//> (record Empty)
record One { a: Int }
//> (record One a:Int)

--- a changed copy binds like a field
let a = d with { bend: 40deg, speed: v }
//> (let a (with d bend:40'deg speed:v))
let b = x + c.d[0] with {
  bend: 1deg
  for: 2s,
}.bend ^ 2
//> (let b (Add x (Pow (with (at c.d 0) bend:1'deg for:2's).bend 2)))
let c = f(d => d with {}) == e
  with { a: 1 }
//> (let c (Eq (call f (=> (d) (with d))) (with e a:1)))

--- `with` and `record` are names elsewhere
let with = 3
//> (let with 3)
let record = with + 1
//> (let record (Add with 1))
for with in record { print(with) }
//> (for with record (call print with))
if with { with }
//> (if with with)
let x = y
//> (let x y)
with
//> with
f(with: with, record: record.with)
//> (call f with:with record:record.with)

--- mistakes in a record leave the next item alone
record A { a, b: Int }
//         ^ E0001 the field `a` needs a type | `a: Length`
//> ERROR
record B {
  a
//^ E0001 the field `a` needs a type
//> ERROR
  b: Int
}
record C { a Int, b: Int }
//           ^^^ E0001 `:` is missing before `Int` | record Name { a: Length = 1m, b: Angle }
//> ERROR
record D(a: Int)
//      ^ E0001 `{` is missing before `(` | record Name {
//> ERROR
record E { a: Int
//       ^ E0004 never closed
//> ERROR
record F {
  fn g() = 3
//   ^ E0001 a record has only fields; a function takes it
//> ERROR
}
let after = 1
//> (let after 1)

--- what other languages write
struct A { a: Int }
//<1-6 E0001 a `record Name { a: Length, b: Angle }`
//> ERROR
let b = Design { bend: 30deg, speed: 2m/s }
//             ^ E0001 a record is built in round brackets | write `Design(bend: 30deg, speed: 2m/s)`
//> (let b ERROR)
fn c(n: Int) -> Design = Design { n: n }
//                              ^ E0001 write `Design(n: n)`
//> (fn c (n:Int) ->Design ERROR)
let d = Design(bend = 3deg)
//                  ^ E0001 a named argument is written with `:`
//> (let d (call Design bend:3'deg))
let e = d with { bend = 3deg }
//                    ^ E0001 a named argument is written with `:`
//> (let e (with d bend:3'deg))
let f = d with bend: 3deg
//             ^^^^ E0001 what `with` changes stands in braces | `d with { bend: 40deg }`
//> (let f ERROR)
let g = { a: 1 }
//         ^ E0001 no value is written in `{ }` | `Name(a: 1, b: 2)`
//> (let g ERROR)
d.bend = 40deg
//     ^ E0001 `=` cannot change `d.bend` | `d with { bend: 40deg }`
//> ERROR
legs[0].d.bend = 40deg
//             ^ E0001 `=` cannot change `legs[0].d.bend` | `legs[0].d with { bend: 40deg }`
//> ERROR
