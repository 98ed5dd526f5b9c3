//! The paper's own method on the 25 shapes made by hand, as the library has them.
use std.rofi.{
  Ball, Board, Caterpillar, Chain, Chair, Circle, Column, Crab, DoubleWheel, Dumbbell, Eight, Fan, HighChair, Human, Infant,
  Puppy, Rectangle, RoundRectangle, Snake, Spider, Stool,
}
let shapes = [
  Ball(), Board(), Caterpillar(), Chain(), Chair(), Circle(), Column(), Crab(), Crab(folded: true), DoubleWheel(),
  Dumbbell(), Eight(), Fan(), HighChair(), Human(), Infant(), Puppy(), Rectangle(), RoundRectangle(), Snake(n: 8),
  Snake(n: 10), Spider(), Spider(gap: true), Spider(gap: true, straight: true), Stool(),
]
let detected = [tosnake(shape, collisions: detection) for shape in shapes]
let avoided = [tosnake(shape, collisions: avoidance) for shape in shapes]
print("| shapes by hand with `collisions: detection`, of {len(shapes)} | 18 | 22 | {len(detected)} | 22 |")
print("| the same with `avoidance` | 22 | 25 | {len(avoided)} | 25 |")
