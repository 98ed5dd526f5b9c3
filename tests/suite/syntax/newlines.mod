--- an operator may begin a line
let a = b
  * c
  and d
  ..e
  .f
//> (let a (And (Mul b c) (.. d e.f)))
let g = h
  else i
//> (let g (else h i))

--- an operator may end a line, also a sum
let a = b +
  c -
  d
//> (let a (Sub (Add b c) d))

--- round and square brackets do not continue the line before
let f = g
[h for h in g]
//> (let f g)
//> (each h (for h g))

--- a sum does not continue the line before
    let a = b
      + c
//    ^ E0009 begins with `+` | end of the line before

--- neither does a difference
    print(a)
    - c
//  ^ E0009 begins with `-`

--- nor within brackets, where a comma may be missing
    let a = [b
      -c]
//    ^ E0009 begins with `-`

--- nor in a clause
    config C {
      behavior b = walk(1)
        + walk(2)
//      ^ E0009 begins with `+`
      behavior c = Sc
        (a, b)
//      ^ E0009 begins with `(` | on the line of what stands before
      behavior d = walk()
    }

--- arguments on the next line are no arguments
    let a = print
    (b)
//  ^ E0009 begins with `(`

--- the value of a block may begin with anything but a plus
fn f(a: Int) -> Int = {
  let b = a
  -b
}
//> (fn f (a:Int) ->Int {(let b a) (- b)})
fn g(a: Int) -> List<Int> = {
  let b = a
  [b]
}
//> (fn g (a:Int) ->List<Int> {(let b a) [b]})

--- items and statements with a keyword may share a line
config C { part a: X  part b: Y  connect a.p -- b.q }
//> (config C (part a X) (part b Y) (connect a.p b.q))
let a = 1 let b = 2
//> (let a 1)
//> (let b 2)

--- an expression that is a statement begins its own line
    print(1) print(2)
//           ^^^^^ E0001 cannot follow on this line | line break

--- a comment over two lines is a line break
print(1) /*
*/ print(2)
//> (call print 1)
//> (call print 2)

--- a prefix may stand alone
let a = -
  b
//> (let a (- b))
