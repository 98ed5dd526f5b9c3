//! All ordered pairs of the shapes made by hand with as many modules as each other, 42 of eight and 306 of ten.
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
let steps = sum([p.steps for p in pairs])
let changes = sum([p.docks + p.undocks for p in pairs])
print("| {len(pairs)} pairs of shapes made by hand: steps | | half of those through the snake | {steps} | |")
print("| the same, motions together, s | | half | {sum([p.duration for p in pairs]) / 1s} | |")
print("| the same, connections changed | | {sum([p.fewest_changes for p in pairs])} | {changes} | |")
print("| the same, through the snake | | | {len([p for p in pairs if p.way == "snake"])} | |")
