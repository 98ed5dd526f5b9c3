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
//    ^^^^ E0503 200 deep

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

