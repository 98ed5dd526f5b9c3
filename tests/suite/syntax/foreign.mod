--- words of other languages are answered with what takes their place
    def f(x) = 1
//  ^^^ E0001 `def` does not begin an item of a file | fn name(x: Length)
--- importing
    import std
//  ^^^^^^ E0001 `import` does not begin an item of a file | use std.smores.{Smores}
--- loops
    while true { }
//  ^^^^^ E0001 `while` does not begin an item of a file | for i in 0..4
--- variables
    var y = 3
//  ^^^ E0001 `var` does not begin an item of a file | let name = ...
--- a colon before a body
    for i in [1]: print(i)
//              ^ E0001 `:` cannot stand here | a body stands in braces
--- a part of a list
    let l = [1, 2]
    let m = l[0:1]
//             ^ E0001 `:` cannot stand here | slice(list, 1..3)
--- a power
    let p = 2 ** 3
//            ^^ E0001 modl writes `^` for `**`
    let q = 2m**2
//            ^^ E0001 modl writes `^` for `**`
--- a unit of words
    let a = 90 degrees
//             ^^^^^^^ E0001 `degrees` cannot stand here | `90deg`
--- a text with a letter before it
    let t = f"x"
//           ^^^ E0001 `"x"` cannot stand here | without `f`
--- a loop with a colon is told as it is written here
    for i in range(3):
//                   ^ E0001 `:` cannot stand here | `for i in 0..3 { ... }`
--- a call without brackets
    print x
//  ^^^^^ E0001 `print` does not begin an item of a file | `print(...)`
--- a comment of a shell or of Python: what it says is no code
    let x = 3 # (the "length
//            ^ E0003 `#` | `//`
    let y = 4
--- a condition behind its value
    let a = 1 if true else 0
//            ^^ E0001 stands behind it | `if c { a } else { b }`
--- whether a list holds something
    if 3 in [1, 2] { }
//       ^^ E0001 `in` cannot stand here | `contains(list, item)`
--- identity
    if 3 is 3 { }
//       ^^ E0001 `is` cannot stand here | `==` compares
--- braces of a format
    print("{} of")
//          ^ E0001 an expression is missing before `}` | {value}
--- a chain of comparisons is one mistake
    let b = 1 < 2 < 3
//                ^ E0001 comparisons do not chain | `a < b and b < c`
--- whole quotients of Python are comments here
    let n = 7
    let half = n // 2
//               ^^^^ W0008 `//` begins a comment, it does not divide | `div(n, 2)`
    let plain = 7//2
//               ^^^ W0008 `//` begins a comment | all of this is skipped | `div(7, 2)`; `/` divides
    let path = 1 + a.b // 2
//                     ^^^^ W0008 `//` begins a comment | `div(a.b, 2)`
    let product = 3 * n // 2
//                      ^^^^ W0008 `//` begins a comment | `div(a, 2)`
    let more = f(n) // 2 + n
//                  ^^^^^^^^ W0008 `//` begins a comment | `div(a, 2)`
--- a divisor whose bracket is swallowed
    let k = (n // m)
//          ^ E0004 this `(` is never closed: `//` begins a comment | `div(n, m)`
//             ~~~~~ all of this is skipped
--- a divisor whose bracket is closed on a later line
    let k = (n // m)
//             ^^^^^ W0008 `//` begins a comment | `div(n, m)`
    )
--- ordinary comments stay what they are
    let a = 3 // metres
    let b = 7 // 7 modules
    let c = 40mm // 40
    let d = [
      1, // 2
      g(2), // 3
    ]
    let e = 3  // (about 2)
    let f = 3  // 1.5 of its width
--- what differs, in Basic and in SQL
    if 1 <> 2 { }
//       ^^ E0001 modl writes `!=` for `<>`
--- a comprehension without its list
    let a = sum(f(x) for x in xs)
//                   ^^^ E0001 `for` stands in a list here | write `sum([f(x) for x in xs])`
    let b = f(1, [2], g(x, 1) for x in xs if x > 1)
//                            ^^^ E0001 `for` stands in a list | write `f(1, [2], [g(x, 1) for x in xs if x > 1])`
    let c = Pc(
      move(x.tilt, to: 0deg) for x in xs
//                           ^^^ E0001 `for` stands in a list | write `Pc([move(x.tilt, to: 0deg) for x in xs])`
    )
--- the name of a test
    test hello { expect true }
//       ^^^^^ E0001 the name of a test is a text | write `test "hello" { ... }`
    test it folds flat { expect true }
//       ^^ E0001 the name of a test is a text | write `test "it folds flat" { ... }`
--- a value that is to change
    let x = 1
    x = x + 1
//    ^ E0001 `=` cannot change `x` | a new one has a name of its own: `let next = x + 1`
    y = 3mm
//    ^ E0001 `=` cannot change `y` | a name is given its value once, by `let y = 3mm`
    for i in 0..4 {
      x = x + i
//      ^ E0001 `=` cannot change `x` | `let next = x + i` | is a list
    }
    if x = 3 { }
//       ^ E0001 `=` cannot stand here | `==` compares
--- a joint that is to move
    m.tilt = 30deg
//         ^ E0001 `=` cannot change `m.tilt` | `move(m.tilt, to: 30deg)` | in a `config`: `set m.tilt = 30deg`
    m.leg[1].tilt = bend
//                ^ E0001 `move(m.leg[1].tilt, to: bend)` | `m.leg[1] with { tilt: bend }`
    config C {
      part m: M
      m.tilt = 30deg
//           ^ E0001 `=` cannot change `m.tilt` | `move(m.tilt, to: 30deg)` | set by `set m.tilt = 30deg`
    }
