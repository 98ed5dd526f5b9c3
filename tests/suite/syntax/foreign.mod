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
//             ^ E0001 `*` cannot stand here | x^2
--- a unit of words
    let a = 90 degrees
//             ^^^^^^^ E0001 `degrees` cannot stand here | `90deg`
--- a text with a letter before it
    let t = f"x"
//           ^^^ E0001 `"x"` cannot stand here | without `f`
