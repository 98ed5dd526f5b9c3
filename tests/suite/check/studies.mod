--- axes are lists and ranges, and variables of the body
record Row { area: Area, note: Text? }
study areas(a in [1m, 2m], b in 1m..3m, n in 0..4) by sobol(8) each k in 0..2 = Row(area: a * b * n * k, note: _)
study wrong(a in [1m, 2m]) by sobol(8) = Row(area: a + 1m, note: _)
//                                                 ^^^^^^ E0201 `area` wants an area
study other(a in 3) by sobol(8) = Row(area: 1m^2, note: _)
//               ^ E0202 an axis has the values of a list or a range; this is a whole number
study shapes(a in [box(1m, 1m, 1m)]) by sobol(8) = Row(area: 1m^2, note: _)
//                ^^^^^^^^^^^^^^^^^ E0202 this is a `List<Shape>` | number them
study each_range(a in 1m..2m) by sobol(8) each b in 1m..2m = Row(area: a * b, note: _)
//                                                  ^^^^^^ E0202 `each` goes through a list or a range of whole numbers
study twice(a in 1m..2m, a in 1m..2m) by sobol(8) = Row(area: a * a, note: _)
//          ~ first declared here
//                       ^ E0102 `a` is declared twice

--- the rows are records of plain values
record Row { area: Area }
record Deep { inner: Row, at: Vec3<Length>, ok: Bool, word: left | right }
record Bad { shape: Shape }
//     ~~~ declared here
study fine(a in 1m..2m) by random(3) = Deep(inner: Row(area: a * a), at: [a, a, a], ok: true, word: left)
study bare(a in 1m..2m) by random(3) = a
//                                     ^ E0211 the rows of `bare` are records; this is a length | end with `Row(speed: ...)`
study bad(a in 1m..2m) by random(3) = Bad(shape: box(a, a, a))
//                                    ^^^^^^^^^^^^^^^^^^^^^^^^ E0211 the field `shape` of `Bad`, a `Shape`, is no column
study clash(area in 1m..2m) by random(3) = Row(area: area * area)
//          ^^^^ E0211 the table would have two columns `area` | has its type
study again(area in [1m^2, 2m^2]) by random(3) = Row(area: area)

--- samplers and their settings
record Row { x: Length }
study a(l in 1m..2m, n in [1, 2]) by grid(l: 3) = Row(x: l * n)
study b(l in 1m..2m) by grid() = Row(x: l)
//                      ^^^^ E0205 `grid` needs the number of values of `l` | grid(amplitude: 9)
study c(l in 1m..2m, n in [1, 2]) by grid(l: 3, n: 2) = Row(x: l * n)
//                                                 ^ E0205 `n` has its own values
study d(l in 1m..2m) by grid(l: 3, m: 4, l: 5) = Row(x: l)
//                                 ^ E0205 the study has no axis `m`
//                                          ^ E0205 `l` is given twice
study e(l in 1m..2m) by grid(3) = Row(x: l)
//                           ^ E0205 by the name of its axis
//                      ^^^^ E0205 the number of values of `l`
study f(l in 1m..2m) by sobl(3) = Row(x: l)
//                      ^^^^ E0211 `sobl` is no sampler | `sobol`?
study g(l in 1m..2m) by sobol() = Row(x: l)
//                      ^^^^^ E0205 `sobol` takes the number of points
study h(l in 1m..2m) by sobol(3, 4) = Row(x: l)
//                            ^ E0205 and nothing else
study i(l in 1m..2m) by random(count: 3m) = Row(x: l)
//                                    ^^ E0201 the number of points wants a number
study j(l in 1m..2m) by random(3.5) = Row(x: l)
//                             ^^^ E0202 the number of points wants a whole number

--- a search names a field that is a quantity
record Row { x: Length, ok: Bool }
study a(l in 1m..2m) by cmaes(maximise: x, budget: 3) = Row(x: l, ok: true)
study b(l in 1m..2m) by cmaes(minimise: y, budget: 3) = Row(x: l, ok: true)
//                                      ^ E0107 a field of `Row` is sought, by its name
study c(l in 1m..2m) by cmaes(minimise: ok, budget: 3) = Row(x: l, ok: true)
//                                      ^^ E0202 the best of `ok` can't be told: it is true or false
study d(l in 1m..2m) by cmaes(budget: 3) = Row(x: l, ok: true)
//                      ^^^^^ E0205 `cmaes` needs what is sought, and the budget
study e(l in 1m..2m) by cmaes(minimise: x, maximise: x, budget: 3) = Row(x: l, ok: true)
//                                         ^^^^^^^^ E0205 each once
let best_of: Row = best(a)
let rows_of: List<Row> = rows(a)
print(best(3))
//         ^ E0202
let s: Study<Row> = a
let t: Study<Length> = a
//           ^^^^^^ E0209 `Study` takes no Length

--- its words are words like all others
let study = 3
let by = 4
let each = study + by
let rows_of = [study for study in [each, by]]
fn sobol(study: Int) -> Int = study
record Row { study: Int }
print(sobol(study: study), Row(study: by).study)

--- a study does not need itself
record Row { x: Length }
study a(l in 1m..2m) by random(3) = Row(x: best(a).x)
//    ~ declared here
//                                              ^ E0108
