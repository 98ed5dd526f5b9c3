--- escapes and holes
let a = "x\n\t\"\\\u{e9}\{\}"
//> (let a "x\n\t\"\\é{}")
let b = "n = {n + 1}: {f("in {x}")}!"
//> (let b (text "n = " (Add n 1) ": " (call f (text "in " x)) "!"))
let c = ""
//> (let c (text))
let d = "{a}{b}"
//> (let d (text a b))
let e = "a } b // no comment"
//> (let e "a } b // no comment")

--- raw texts lose their indentation and outer line breaks
let a = cells("""
    #..
      \n{x}

    ##
  """)
//> (let a (call cells "#..\n  \\n{x}\n\n##"))
let b = """one line"""
//> (let b "one line")
let c = """"""
//> (let c (text))

--- an escape that is none
    let a = "x\q"
//            ^^ E0007 no escape `\q` | \n \t

--- an escape that is no character
    let a = "\u{110000}" ++ "\u{}"
//           ^^^^^^^^^^ E0007 no escape
//                           ^^^^ E0007 no escape

--- an escape in the name of a test
    test "a\qb" { }
//         ^^ E0007 no escape `\q`

--- a text ends on its line
    let a = "abc
//          ^ E0004 this text is never closed | `"` on its line
    let b = 3

--- a raw text ends somewhere
    let a = """abc
//<13-15 E0004 this text is never closed
    let b = 3

--- nothing in a hole
    let a = "x{}"
//             ^ E0001 an expression is missing before `}`

--- half an expression in a hole
    let a = "x{b +} {c}"
//                ^ E0001 an expression is missing before `}`

--- formats of other languages
    print("{x:.2f} of {y} mm")
//           ^^^^ E0001 `.2f` is no format of a value | decimals are written `{x:.2}`, a unit before them

--- a width in a hole
    print("{f(n: 1):>8}")
//                 ^^^ E0001 `>8` is no format of a value | `pad(text, 8)` fills a text up to a width

--- a unit behind the decimals
    print("{x:.2 in mm}")
//           ^^^^^^^^^ E0001 `.2 in mm` is no format of a value | before the decimals: `{x in mm:.2}`

--- two expressions in a hole
    print("a {x y} b")
//              ^ E0001 is missing before `y`
