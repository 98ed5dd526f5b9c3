//! A program of any length that is valid: connectors, modules, configurations, behaviours, functions,
//! tests, with comments and blank lines as people write them.

/// A program of at least this many lines.
pub fn program(lines: usize) -> String {
    let mut text = String::from(HEAD);
    let mut count = HEAD.lines().count();
    for i in 0.. {
        if count >= lines {
            break;
        }
        let part = PART.replace("@", &i.to_string());
        count += part.lines().count();
        text.push_str(&part);
    }
    text
}

const HEAD: &str = "\
//! Generated: many modules and configurations of one kind.
connector Face { mates Face, turns 4, holds 80N, holds 2N*m, capture 4mm 5deg }

fn ramp(i: Int, n: Int) -> Number = i / (n - 1)
";

const PART: &str = "
/// A hinge with a face at either end.
module Hinge@(length: Length = 40mm) {
  mass  150g
  link  base = box(length, 40mm, 40mm)
  link  tip  = box(length, 40mm, 40mm, friction: 0.6) at [length + 20mm, 0mm, 0mm]
  joint bend : base -> tip = revolute(axis: Y, range: -40deg..40deg, max_speed: 60deg/s, max_torque: 4N*m)
    at [length / 2 + 10mm, 0mm, 0mm]
  port  back : Face on base at [-length / 2, 0mm, 0mm] facing -X up +Z
  port  front: Face on tip  at [length / 2, 0mm, 0mm]  facing +X up +Z
}

/// A chain of them.
config Arm@(n: Int = 4, bend: Angle = 30deg) {
  part h[n]: Hinge@(length: 50mm)
  for i in 0..n - 1 { connect h[i].front -- h[i + 1].back turn if i % 2 == 0 { 90deg } else { 0deg } }
  set h[0].bend = bend / 2       // half way
  port head = h[n - 1].front
  port tail = h[0].back
  base h[0]
  require n > 1 and bend < 90deg, \"an arm has at least two hinges\"

  behavior curl(to: Angle = 30deg) allows unstable = Pc([move(x.bend, to: to) for x in h])
  behavior wave(amplitude: Angle = 20deg, times: Int = 3) allows unstable = repeat(
    Sc(
      Pc([move(h[i].bend, to: amplitude * ramp(i, n)) for i in 0..n if i % 2 == 0]),
      wait(0.5s),
      Pc([move(h[i].bend, to: -amplitude) for i in 0..n]),
    ),
    times,
  )
  behavior sway = Sc(curl(bend), curl(-bend), curl(0deg))
}

let reach@ = 120mm + 4 * 50mm
let tips@ = [reach@ * ramp(i, 5) for i in 0..5]

test \"arm @ has order 1\" {
  let arm = Arm@(6)
  expect order(arm) == 1
  expect count(arm) == 6, \"{count(arm)} modules\"
}
";
