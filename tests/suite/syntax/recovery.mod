--- each mistake is told once, and the rest of the tree is built
    let a = 3 +
//             ^ E0001 an expression is missing at the end of this line
    config C {
      part m Smores
//           ^^^^^^ E0001 `:` is missing before `Smores` | part name[4] : Type
      part n: Smores
      behavior b(v: Speed) allows slip = Pc(a b)
//                                            ^ E0001 `)` or `,` is missing before `b`
      behavior c = n.go()
      for i in 0..4 { connect a -- b  set c.d 3deg }
//                                            ^^^^ E0001 `=` is missing before `3deg`
      for i in 0..4 { connect a -- b
        if a { connect a -- b } else if b { sett c } else { set x = }
//                                          ^^^^ E0001 `sett` does not begin | `set`?
//                                                                 ^ E0001 an expression is missing
      }
    }
    module M { mass 3kg  mas 4kg }
//                       ^^^ E0001 `mas` does not begin a clause of a module | `mass`?
    fn f(a: Int) -> Int = {
      let b = a *
//               ^ E0001 an expression is missing at the end of this line
      let c = b
      c c
//    ^ E0001 `c` does not begin
    }
    test "t" {
      let r = verify(w
//                  ^ E0004 this `(` is never closed
      expect r.ok
      expect r,
//             ^ E0001 an expression is missing
    }
    print(a)
//> (let a ERROR)
//> (config C ERROR (part n Smores) (behavior b (v:Speed) allows:[slip] ERROR) (behavior c (call n.go)) (for i (.. 0 4) (connect a b) ERROR) (for i (.. 0 4) (connect a b) (if a (connect a b) (else (if b ERROR (else (set x ERROR)))))))
//> (module M (mass 3'kg) (mass 4'kg))
//> (fn f (a:Int) ->Int ERROR)
//> (test "t" (let r ERROR) (expect r.ok) ERROR)
//> (call print a)

--- a missing brace ends where the next item begins
config A {
//<10-10 E0004 this `{` is never closed
  part m: M
config B {
  part n: N
}
//> (config A (part m M))
//> (config B (part n N))

--- a missing bracket leaves the clauses behind it
config A {
  part m: M(a: 3
//<12-12 E0004 this `(` is never closed
  part n: N
  behavior b = n.go()
}
print(1)
//> (config A ERROR (part n N) (behavior b (call n.go)))
//> (call print 1)

--- a faulty import leaves the rest
    use std.smores.{Smores, Chain3
//                 ^ E0004 this `{` is never closed
let a = 3
//> ERROR
//> (let a 3)

--- a comment that never ends
    let a = 3
    /* and /* so */ on
//  ^^ E0004 this comment is never closed
//> (let a 3)

--- what a misspelt keyword begins is read as if it were not
    cnfig C {
//  ^^^^^ E0001 `cnfig` does not begin an item of a file | `config`?
      part m: M  bahavior b = m.go()
//               ^^^^^^^^ E0001 `bahavior` does not begin a clause of a configuration | `behavior`?
      fro i in 0..2 { connect m.a -- m.b  conect m.c -- m.d }
//    ^^^ E0001 `fro` does not begin | `for`?
//                                        ^^^^^^ E0001 `conect` does not begin | `connect`?
    }
    tset "t" { expcet true }
//  ^^^^ E0001 `tset` does not begin an item of a file | `test`?
//             ^^^^^^ E0001 `expcet` does not begin a statement | `expect`?
    letice L of C = row(4)
//  ^^^^^^ E0001 `letice` does not begin an item of a file | `lattice`?
    functoin f() = 3 +
//  ^^^^^^^^ E0001 `functoin` does not begin an item of a file
//> (config C (part m M) (behavior b (call m.go)) (for i (.. 0 2) (connect m.a m.b) (connect m.c m.d)))
//> (test "t" (expect true))
//> (lattice L of C (call row 4))
//> ERROR
