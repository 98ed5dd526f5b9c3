--- what a plot says of itself
let xs = [1mm, 2mm, 3mm]
let heights = [1N, 4N, 9N]
print(plot(heights, x: xs), plot(heights, x: xs, kind: scatter), plot(heights, kind: histogram))
//> a curve of heights over xs 3 points of heights over xs a histogram of heights
print(plot([heights, [2N, 3N, 4N]], x: xs, y_label: "force"), plot(heights).series, plot([heights, heights]).series)
//> 2 curves of force over xs 1 2
print(plot(heights, x: xs, x_label: "length", y_label: ""))
//> a curve of y over length

--- names come from fields, signals and values
use std.smores.Chain3
let c = Chain3()
let p = plan(move(c.m[1].tilt, to: 30deg))
print(plot(p.series(angle(c.m[1].tilt), step: 1s), x: p.times(step: 1s)))
//> a curve of angle over time
print(plot([s.com.z for s in p.states(step: 1s)], x: [s.margin for s in p.states(step: 1s)]))
//> a curve of z over margin

--- missing and infinite values leave gaps
use std.smores.Chain3
let far = verify(Chain3(), world: world(ground: off, gravity: off)).margin
print(far, plot([1mm, far, 2mm]).gaps, plot([1, _, 3]).gaps, plot([1mm, 2mm], x: [_, 3s]).gaps)
//> infinite 1 1 1
print(plot([far, far]))
//         ^^^^^^^^^^ E0506 all values are missing or infinite

--- an empty list
let none: List<Length> = []
print(plot(none))
//         ^^^^ E0506 an empty list has nothing to draw

--- an empty list among others
print(plot([[1mm], [x for x in [1mm] if x > 2mm]]))
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 an empty list has nothing to draw

--- lists of unequal length
print(plot([1, 2, 3], x: [1s, 2s]))
//         ^^^^^^^^^ E0506 `y` has 3 values and `x` has 2

--- one of several lists has another length
print(plot([[1, 2], [1, 2, 3]], x: [1s, 2s]))
//         ^^^^^^^^^^^^^^^^^^^ E0506 list 1 of `y` has 3 values and `x` has 2

--- as many lists of x as of y
print(plot([[1, 2], [1, 2], [3, 4]], x: [[1s, 2s], [1s, 3s]]))
//                                      ^^^^^^^^^^^^^^^^^^^^ E0506 there are 3 lists of `y` and 2 of `x`

--- quantities of two dimensions on one axis
print(plot([[1mm, 2mm], [1s, 2s]]))
//         ^^^^^^^^^^^^^^^^^^^^^^ E0506 quantities of one dimension

--- names for some
print(plot([[1, 2], [1, 2]], names: ["a"]))
//                                  ^^^^^ E0506 as many names as lists, 2, and not 1

--- a histogram over something
print(plot([1, 2], x: [1, 2], kind: histogram))
//                    ^^^^^^ E0506 a histogram counts values of `y`

--- bins of a curve
print(plot([1, 2], bins: 3))
//                       ^ E0506 only a histogram has bins

--- no bins
print(plot([1, 2], bins: 0, kind: histogram))
//                       ^ E0506 a histogram has 1 to 1000 bins

--- a plot is no page
show(plot([1, 2]), "a.html")
//                 ^^^^^^^^ E0506 `.svg` or `.png`

--- a plot is saved as a picture
save(plot([1, 2]), "a.rofi")
//                 ^^^^^^^^ E0506 `.svg` or `.png`

--- a plot stays in the output folder
save(plot([1, 2]), "../a.svg")
//                 ^^^^^^^^^^ E0701
