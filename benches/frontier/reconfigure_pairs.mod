// All ordered pairs of the shapes made by hand with as many modules as each other, 42 of eight and 306 of ten: the steps,
// the duration (s), the connections changed, and the fewest that any plan changes, each in sum.
use std.rofi.{
  Snake, Chair, HighChair, Spider, Crab, Ball, Board, Caterpillar, Chain, Circle, Column, DoubleWheel,
  Dumbbell, Eight, Fan, Human, Infant, Puppy, Rectangle, RoundRectangle, Stool,
}
let eight = [
  Chair(),
  Snake(n: 8),
  Spider(),
  Spider(gap: true),
  Spider(gap: true, straight: true),
  Crab(),
  Crab(folded: true),
]
let ten = [
  Ball(),
  Board(),
  Caterpillar(),
  Chain(),
  HighChair(),
  Circle(),
  Column(),
  DoubleWheel(),
  Dumbbell(),
  Eight(),
  Fan(),
  Human(),
  Infant(),
  Puppy(),
  Rectangle(),
  RoundRectangle(),
  Snake(n: 10),
  Stool(),
]
let pairs = [reconfigure(a, b) for shapes in [eight, ten] for a in shapes for b in shapes if a != b]
print(sum([p.steps for p in pairs]), sum([p.duration for p in pairs]) / 1s)
print(sum([p.docks + p.undocks for p in pairs]), sum([p.fewest_changes for p in pairs]))
print(len([p for p in pairs if p.way == "snake"]), "of", len(pairs), "through the snake")
