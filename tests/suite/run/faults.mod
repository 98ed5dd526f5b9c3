--- an index outside
let xs = [1, 2, 3]
print(xs[3])
//    ^^^^^ E0501 index 3 is outside `xs`, which has 3 elements

--- divisions by zero
let zero = 0
print(1 / zero)
//        ^^^^ E0502 division by zero
print(5 % zero)
//        ^^^^ E0502 division by zero
print(div(5, zero))
//           ^^^^ E0502

--- what follows from a mistake stays silent, what does not goes on
let a = [1][2]
//      ^^^^^^ E0501
let b = a + 1
print(b)
print("on")
//> on

--- a loop says which round
for i in 0..3 { print([10, 20][i]) }
//                    ^^^^^^^^^^^ E0501 (with i = 2)
//> 10
//> 20

--- a value that needs itself
let a: Int = b
//  ~ declared here
let b: Int = a
//           ^ E0108 needs itself
print(a)

--- recursion without an end
fn f(n: Int) -> Int = f(n + 1)
//                    ~~~~~~~~ led to this call
print(f(0))
//    ^^^^ E0503 20000 deep | has to come to a case in which it does not | `iterate(f, from: ..., until: ...)`

--- what is carried along for ever
print(iterate(n => n + 1, from: 0, until: n => n < 0, max: 1000))
//                                        ^^^^^^^^^^ E0506 does not hold after 1000 steps | `max:`
print(iterate(n => [1, 2][n], from: 0, until: n => n == 5))
//                 ^^^^^^^^^ E0501 index 2 of 2
//            ~~~~~~~~~~~~~~ called from here: `=>`
print(reduce([1, 0], (a, x) => a / x, from: 1.0))
//                                 ^ E0502
print(iterate(n => n, from: 0, until: n => true, max: -1))
//                                                    ^^ E0506

--- what is carried along becomes too deep
record N { next: N? }
fn same(x: Int) -> Int = x
fn deeper(g: fn(Int) -> Int, i: Int) -> fn(Int) -> Int = x => g(x) + 1
print(iterate(n => N(next: n), from: N(), until: n => false))
//            ^^^^^^^^^^^^^^^ E0505 10000 values within each other | these were 16384
let steps = [i for i in 0..20_000]
let b = reduce(steps, (b, i) => Sc(b, wait(1s)), from: wait(1s))
//                    ^^^^^^^^^^^^^^^^^^^^^^^^^ E0505 10000 values within each other
let g = reduce(steps, deeper, from: same)
//                    ^^^^^^ E0505 10000 values within each other

--- numbers too large
print(10^100_000)
//    ^^^^^^^^^^ E0505 digits

--- functions that refuse
print(sqrt(-1), asin(2), ln(0))
//         ^^ E0506 negative
//                   ^ E0506 outside -1..1
//                          ^ E0506 positive

--- expectations in a run
expect 1 + 1 == 3
//     ^^^^^^^^^^ E0507 2 == 3 is false
expect 1mm > 2mm, "too short"
//     ^^^^^^^^^ E0507 too short

