--- products bind more strongly than sums, and both group to the left
a + b * c - d
//> (Sub (Add a (Mul b c)) d)
a / b * c % d
//> (Rem (Mul (Div a b) c) d)

--- powers bind more strongly than signs, and group to the right
-x^2
//> (- (Pow x 2))
x^-2
//> (Pow x (- 2))
a^b^c
//> (Pow a (Pow b c))
let b = -a * b
//> (let b (Mul (- a) b))
let c = - -a
//> (let c (- (- a)))

--- ranges, joining, mating and comparison
-90deg..90deg
//> (.. (- 90'deg) 90'deg)
0..n - 1
//> (.. 0 (Sub n 1))
a ++ b + c ++ d
//> (Join (Join a (Add b c)) d)
a <-> b.c[0] and c < d
//> (And (Mated a (at b.c 0)) (Lt c d))
not a == b and c
//> (And (not (Eq a b)) c)
a or b and not c
//> (Or a (And b (not c)))

--- `else` binds like `or`
move(m.tilt, until: angle(m.tilt) > 90deg, timeout: 2s) else abort("blocked")
//> (else (call move m.tilt until:(Gt (call angle m.tilt) 90'deg) timeout:2's) (call abort "blocked"))
a else b or c
//> (Or (else a b) c)

--- functions are the loosest
f(x => x + 1, (a, b) => a, () => 3)
//> (call f (=> (x) (Add x 1)) (=> (a b) a) (=> () 3))
let f = x => y => x else y
//> (let f (=> (x) (=> (y) (else x y))))
let g = x => { let a = x
  a }
//> (let g (=> (x) {(let a x) a}))

--- calls, indices and fields
f(1)(2)[3].g(h: 4, 5,)
//> (call (at (call (call f 1) 2) 3).g h:4 5)
(a + b).c
//> (Add a b).c
f()
//> (call f)

--- a label is any word, and so is a field
spin(m.left, 2rad/s, for: 5s, in: 1s, if: 2, part: 3, X: 4)
//> (call spin m.left 2'rad*s^-1 for:5's in:1's if:2 part:3 X:4)
a.turn.for.X
//> a.turn.for.X

--- words of clauses are ordinary names elsewhere
let part = 3
//> (let part 3)
let base = part + turn * at - on
//> (let base (Sub (Add part (Mul turn at)) on))
module(config, cell)
//> (call module config cell)
test(3)
//> (call test 3)
fn f(at: Int, mass: Int) -> Int = at + mass
//> (fn f (at:Int mass:Int) ->Int (Add at mass))

--- units stick to their numbers
let a = 9.81m/s^2
//> (let a 9.81'm*s^-2)
let b = 2.5N*m
//> (let b 2.5'N*m)
let c = 6rad / s
//> (let c (Div 6'rad s))
let d = 1_000 + 1e-3mm + 1.5E3 + 2e
//> (let d (Add (Add (Add 1000 1e-3'mm) 1.5E3) 2'e))
let e = 5kg*m^2/s^2 * x
//> (let e (Mul 5'kg*m^2*s^-2 x))
let f = 2m*3 + 2m^n
//> (let f (Add (Mul 2'm 3) (Pow 2'm n)))

--- numbers meet dots
let a = 0..4
//> (let a (.. 0 4))
let b = 1.5..2.5
//> (let b (.. 1.5 2.5))
let c = 1.foo
//> (let c 1.foo)

--- lists and comprehension
[]
//> []
[a, b, c,]
//> [a b c]
[e for x in xs if c for y in ys]
//> (each e (for x xs) (if c) (for y ys))
[[1, _], [_, 2]]
//> [[1 _] [_ 2]]
let d = [-X, +Z, true, false, _]
//> (let d [(- X) (+ Z) true false _])

--- if and blocks
let a = if c { 1 } else if d { 2 } else { 3 }
//> (let a (if c {1} (if d {2} {3})))
let b = { let x = 1
  x + 1 }
//> (let b {(let x 1) (Add x 1)})
let c = if a { 1 } else { 2 } + 3
//> (let c (Add (if a {1} {2}) 3))
fn f(n: Int) -> Int = { if n < 2 { 1 } else { n * f(n - 1) } }
//> (fn f (n:Int) ->Int {(if (Lt n 2) {1} {(Mul n (call f (Sub n 1)))})})

--- comments stand wherever white space may
let a /* one */ = /* two /* nested */ */ 1 // three
  * 2
//> (let a (Mul 1 2))
