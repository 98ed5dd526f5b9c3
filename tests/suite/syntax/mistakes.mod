--- a bracket that is not closed
    let a = f(b, c
//           ^ E0004 this `(` is never closed
    let d = 3

--- the wrong bracket
    let a = [1, 2)
//               ^ E0001 this `)` closes nothing

--- a bracket too many
    let a = f(1))
//              ^ E0001 this `)` closes nothing | delete it
    let b = 2

--- a connection without its sign
    config C {
      connect a.b c.d
//                ^ E0001 `--` is missing between the two ports | connect a -- b
      connect a.b - c.d
//                ^ E0001 `--` joins the two ports, not `-`
      connect a.b -- c.d
    }
    truss T of R { strut a b }
//                         ^ E0001 `--` is missing between the two nodes

--- a named argument with an equals sign
    let a = f(b = 3)
//              ^ E0001 written with `:`, not with `=` | b: ...

--- semicolons
    let a = 1; let b = 2; print(a);
//           ^ E0003 no semicolons | line break
    print(b);
//          ^ E0003 no semicolons

--- comparisons do not chain
    let a = b < c < d
//                ^ E0001 do not chain | a < b and b < c
    let e = (b < c) == d
    let f = b == c != d
//                 ^^ E0001 do not chain

--- ranges do not chain
    let a = 1..2..3
//              ^^ E0001 a range has two ends

--- a reserved word as a name
    let for = 3
//      ^^^ E0001 `for` is a reserved word
    let X = 3
//      ^ E0001 `X` is an axis
    fn in(a: Int) = 3
//     ^^ E0001 `in` is a reserved word
    config C { part not: M }
//                  ^^^ E0001 `not` is a reserved word
    fn f(if: Int) = 3
//       ^^ E0001 `if` is a reserved word

--- operators of other languages
    let a = b && c || !d
//            ^^ E0001 modl writes `and` for `&&`
//                 ^^ E0001 modl writes `or` for `||`
//                    ^ E0001 modl writes `not` for `!`
    let e = b ? c : d
//            ^ E0001 `?` cannot stand here | if c { a } else { b }
    let f = b & c
//            ^ E0003 `&` (U+0026) | write `and`

--- records
    let a = { x: 1, y: 2 }
//             ^ E0001 no value is written in `{ }` | `record Name { a: Int, b: Int }` | `Name(a: 1, b: 2)`
    let b = f({ x: 1 })
//            ^ E0001 no value is written in `{ }`

--- single quotes
    let a = 'text'
//          ^ E0003 no single quotes | double quotes
    let b = 3

--- a parameter without a type
    fn f(x) = x
//       ^ E0001 the parameter `x` needs a type | x: Length
    fn g(a: Int, b) = a
//               ^ E0001 the parameter `b` needs a type

--- one mark for another
    let a == 3
//        ^^ E0001 `==` cannot stand here | one `=`
    config C {
      part a = M
//           ^ E0001 `=` cannot stand here | behind `:`
      behavior b: Sc()
//              ^ E0001 `:` cannot stand here | behind `=`
    }

--- a number without its zero
    let a = .5
//          ^ E0001 `.` cannot stand here | 0.5

--- a unit that does not stick
    let a = 90 deg
//             ^^^ E0001 `deg` cannot stand here | `90deg`

--- underscores in numbers
    let a = 1_000
    let b = 1__0
//          ^^^^ E0008 underscore
    let c = 1m^100
//             ^^^ E0008 exponent

--- brackets hold one expression
    let a = (b, c)
//          ^^^^^^ E0001 one expression | [a, b]
    let d = ()
//          ^^ E0001 one expression

--- functions behind operators
    let a = b + x => x
//              ^ E0001 stands in brackets
    let c = (f(x)) => x
//           ^^^^ E0001 must be a name

--- `not` behind a comparison
    let a = b == not c
//               ^^^ E0001 binds looser | (not ...)

--- paths stand around the sign of mating
    let a = f(x) <-> b
//          ^^^^ E0001 between two ports

--- an empty place
    let a =
//         ^ E0001 an expression is missing at the end of this line
    let b = f(, 2)
//            ^ E0001 an expression is missing before `,`
    let c = [1,, 2]
//             ^ E0001 an expression is missing before `,`
    print(d e)
//          ^ E0001 `)` or `,` is missing before `e`

--- misspelt words
    modul M { mass 3kg }
//  ^^^^^ E0001 `modul` does not begin an item | `module`?
    config C {
      conect a -- b
//    ^^^^^^ E0001 `conect` does not begin a clause of a configuration | `connect`?
      part x: M
    }

--- words in another place
    part a: M
//  ^^^^ E0001 `part` begins a clause of a configuration, not an item
    config C {
      module M { mass 1kg }
//    ^^^^^^ E0001 `module` begins an item of a file
      for i in 0..2 { part a: M }
//                    ^^^^^^^^^ E0001 a part stands at the top | part leg[4]
    }

--- clauses that end too early
    module M {
      touching a
//              ^ E0001 ends too early | touching a b
      joint k
//           ^ E0001 `:` or `=` is missing at the end of this line | joint name : parent -> child
      port p: F on a facing
//                         ^ E0001 an expression is missing
    }

--- what only built-ins may use
    fn f(a: Int...) = 3
//             ^^^ E0001 only an `extern fn`

--- a branch without braces
    let a = if b { c } else d
//                     ^^^^ E0001 stands in `{ }`

--- parts of the language that are not built yet
    role R { joint bend }
//  ^^^^ E0010 `role` is not built yet
    config C closed (solves a) { part m: M }
//           ^^^^^^ E0010 is not built yet
    config D { part m: M
      behavior w() ensures clearance > 2mm = m.go()
//                 ^^^^^^^ E0010 `ensures` is not built yet
    }
