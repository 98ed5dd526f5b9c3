--- a grid takes all combinations, the last axis fastest, ends included
record Row { x: Length, y: Length, k: Int, on: Bool }
study all(l in [1m, 2m], m in -1m..1m, b in [true, false]) by grid(m: 3) each i in 5..7 = Row(x: l, y: m, k: i, on: b)
let table = rows(all)
print(len(table), table[0], table[1], table[2].on, table[4].y, table[8].y)
//> 24 Row(x: 1m, y: -1m, k: 5, on: true) Row(x: 1m, y: -1m, k: 6, on: true) false 0mm 1m
print([row.x for row in table if row.k == 5 and row.on], len([row for row in table if row.y == 1m]))
//> [1m, 1m, 1m, 2m, 2m, 2m] 8
study one(m in 0m..1m) by grid(m: 1) = Row(x: m, y: m, k: 0, on: true)
print(rows(one)[0].x)
//> 500mm
study none() by grid() each i in 0..3 = Row(x: 0m, y: 0m, k: i, on: true)
print([row.k for row in rows(none)])
//> [0, 1, 2]

--- the Sobol sequence fills each half, quarter and eighth of an axis equally
record Row { x: Number, n: Int }
study even(u in 0.0..1, i in 0..4) by sobol(64) = Row(x: u, n: i)
let table = rows(even)
print([len([row for row in table if row.n == n]) for n in 0..4], [len([row for row in table if row.x < k / 8]) for k in 1..9])
//> [16, 16, 16, 16] [8, 16, 24, 32, 40, 48, 56, 64]
print([len([row for row in table if row.n == n and row.x < 0.25]) for n in 0..4], table[0], table[1])
//> [4, 4, 4, 4] Row(x: 0, n: 0) Row(x: 0.5, n: 2)

--- random points lie within their axes, and are evenly spread
record Row { x: Length, n: Int }
study spread(l in 2m..4m, i in 0..10) by random(4000) = Row(x: l, n: i)
let table = rows(spread)
let mean = sum([row.x for row in table]) / 4000
print(min([row.x for row in table]) >= 2m, max([row.x for row in table]) <= 4m, abs(mean - 3m) < 0.05m)
//> true true true
print(all([abs(len([row for row in table if row.n == n]) - 400) < 100 for n in 0..10]))
//> true

--- rows that fail are left out, and a study all of whose rows do is refused
record Row { x: Length }
study some(l in 1m..3m) by grid(l: 5) = {
  require l < 2.2m, "too long"
  Row(x: l)
}
print([row.x for row in rows(some)])
//> [1m, 1.5m, 2m]
study bad(l in 1m..3m) by grid(l: 2) = {
  require l < 0m, "too long"
  Row(x: l)
}
print(rows(bad))
//         ^^^ E0510 no row of `bad` has values; that of number 0 ends with E0507: too long
print(best(some))
//         ^^^^ E0506 `some` seeks nothing | `rows(..)`

--- a search finds the least and the greatest, on numbers, whole numbers and choices
record Row { l: Length, n: Int, w: Text, cost: Area }
fn cost(l: Length, n: Int, word: Text) -> Area = (l - 3m) ^ 2 + ((n - 4) ^ 2 + (if word == "b" { 0 } else { 1 })) * 1m^2
study down(l in 0m..10m, n in 0..9, w in ["a", "b", "c"]) by cmaes(minimise: cost, budget: 400) = Row(l: l, n: n, w: w, cost: cost(l, n, w))
let b = best(down)
print(abs(b.l - 3m) < 10mm, b.n, b.w, len(rows(down)))
//> true 4 b 400
record Height { at: Length, height: Number }
study up(l in 0m..10m) by cmaes(maximise: height, budget: 100) = Height(at: l, height: 5 - ((l - 8m) / 1m) ^ 2)
print(abs(best(up).at - 8m) < 10mm)
//> true
study edge(l in 0m..10m) by cmaes(maximise: height, budget: 100) each k in 0..2 = Height(at: l, height: l / 1m + k)
print(best(edge).at > 9.9m, best(edge).height > 10.9, len(rows(edge)))
//> true true 200

--- the top of the file is evaluated once, and rows do not see each other
use std.smores.Smores
record Row { a: Mass, n: Int }
let robot = Smores()
study same(i in 0..3) by grid() = Row(a: mass(robot) * i, n: count(robot))
print(all([rows(same)[i].a == mass(robot) * i for i in 0..3]))
//> true

--- axes without values, and settings out of range
record Row { x: Number }
study empty(i in 3..3) by grid() = Row(x: i)
//               ^^^^ E0506 `i` has no values
study backwards(i in 3..1) by grid() = Row(x: i)
//                   ^^^^ E0506 `i` has no values
study zero(i in 1..3) by sobol(0) = Row(x: i)
//                             ^ E0506 the number of points is at least 1; this is 0
study minus(l in 0.0..3) by grid(l: 0 - 2) = Row(x: l)
//                                  ^^^^^ E0506 the number of values is at least 1; this is -2
study many(i in 1..3) by sobol(5_000_000_000) = Row(x: i)
//                             ^^^^^^^^^^^^^ E0506 the sequence has 4294967296 points
study too_many(i in 0..100_000, j in 0..100_000) by grid() = Row(x: i + j)
//                                                  ^^^^^^ E0505 a study of more than 4294967296 rows
study still() by cmaes(minimise: x, budget: 3) = Row(x: 1)
//               ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 a search needs an axis
print(rows(empty), rows(backwards), rows(zero), rows(minus), rows(many), rows(too_many), rows(still))
