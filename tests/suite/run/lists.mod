--- lists of pairs, places, and the best element
use std.lists
print(lists.zip([1m, 2m], [2s, 8s], (way, time) => way / time), lists.zip([], [], (a, b) => [a, b]))
//> [500mm/s, 250mm/s] []
print(lists.enumerate(["hip", "knee"], (i, name) => "{i} {name}"))
//> [0 hip, 1 knee]
record Leg { name: Text, length: Length }
let legs = [Leg(name: "a", length: 3cm), Leg(name: "b", length: 2cm), Leg(name: "c", length: 2cm)]
print([leg.name for leg in lists.sorted(legs, by: leg => leg.length)], [l.name for l in lists.sorted(legs, by: l => -l.length)])
//> [b, c, a] [a, b, c]
print(lists.argmin(legs, by: l => l.length).name, lists.argmax(legs, by: l => l.length).name)
//> b a
print(lists.argmin([0, 1, 2], by: i => legs[i].length), lists.argmax([1, -3, 3], by: x => abs(x)))
//> 1 -3

--- mean and deviation of a sample
use std.lists.{mean, deviation, linspace}
// By hand: the mean is 5, the squares of the differences add up to 32, and 32 / 7 has the root 2.13809.
print(mean([2mm, 4mm, 4mm, 4mm, 5mm, 5mm, 7mm, 9mm]), deviation([2mm, 4mm, 4mm, 4mm, 5mm, 5mm, 7mm, 9mm]))
//> 5mm 2.13809mm
print(mean([1, 2]), deviation([3m, 3m, 3m]), deviation([1s, 3s]) == sqrt(2) * 1s)
//> 1.5 0mm true
print(linspace(0deg, 90deg, count: 4), linspace(1, 0, count: 2), last(linspace(0m, 0.7m, count: 8)) == 0.7m)
//> [0deg, 30deg, 60deg, 90deg] [1, 0] true

--- steps of a range
print(steps(0..10, by: 3), steps(10..0, by: -5), steps(0..0, by: 2), [i * 10 for i in steps(0..3, by: 2)])
//> [0, 3, 6, 9] [10, 5] [] [0, 20]
print(steps(0deg..90deg, by: 30deg), steps(0mm..10mm, by: 4mm), len(steps(0..1.0, by: 0.1)))
//> [0deg, 30deg, 60deg, 90deg] [0mm, 4mm, 8mm] 11
print(steps(1m..0m, by: -500mm), steps(1m..1m, by: 1m))
//> [1m, 500mm, 0mm] [1m]

--- pseudorandom numbers are those of SplitMix64
use std.lists.{shuffle, mean}
// The first numbers of the generator for this seed, as they were published with it.
let published = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431, 16408922859458223821]
print([floor(r * 2^53) for r in random(1234567, 5)] == [div(n, 2^11) for n in published])
//> true
print(random(7, 3) == slice(random(7, 10), 0..3), random(7, 3) == random(8, 3), random(7, 0))
//> true false []
let many = random(3, 10_000)
print(all([0 <= r and r < 1 for r in many]), abs(mean(many) - 0.5) < 0.01)
//> true true
let mixed = shuffle([i for i in 0..100], seed: 4)
print(mixed == [i for i in 0..100], sorted(mixed) == [i for i in 0..100], mixed == shuffle([i for i in 0..100], seed: 4))
//> false true true

--- a scan keeps what came of each element
print(scan([100g, 50g, 20g], (total, x) => total + x, from: 0g), scan([], (a, x) => a + 1, from: 3))
//> [100g, 150g, 170g] []
print(ranking([30mm, 10mm, 20mm]), ranking([2, 1, 1, 0]), ranking([]))
//> [1, 2, 0] [3, 1, 2, 0] []

--- what these functions refuse
use std.lists
print(lists.zip([1, 2], [1], (a, b) => a))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0507 the lists have 2 and 1 elements
print(lists.mean([]), lists.deviation([1m]))
//    ^^^^^^^^^^^^^^ E0507 no values have no mean
//                    ^^^^^^^^^^^^^^^^^^^^^ E0507 two values or more; these are 1
print(lists.argmin([], by: x => 1), lists.linspace(0, 1, count: 1))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0507 an empty list
//                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0507 `count` is 2 or more
print(steps(0..10, by: 0), steps(0..10, by: -1), steps(0m..1m, by: 0m), steps(0m..1m, by: 1nm))
//                     ^ E0506 does not lead
//                                          ^^ E0506 does not lead
//                                                                 ^^ E0506 does not lead
//                                                                      ^^^^^^^^^^^^^^^^^^^^^^ E0505 a list of more than 1000000 elements
print(random(-1, 3), random(1, -3))
//           ^^ E0506 must not be negative
//                             ^^ E0506 must not be negative
