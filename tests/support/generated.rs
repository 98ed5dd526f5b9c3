//! Programs made by a seeded generator: those that are valid by construction check and run; those
//! that were then damaged end with diagnostics, never with a panic.

use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};
use std::fmt::Write;

const VALID: u64 = 40;
const DAMAGED: u64 = 400;

/// A generator of numbers (xorshift), the same on every machine.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % n
    }

    fn of<'a, T: ?Sized>(&mut self, choices: &[&'a T]) -> &'a T {
        choices[self.below(choices.len())]
    }
}

const MODULE: &str = "connector Face { mates Face, turns 4, holds 80N }
module Hinge(length: Length = 40mm) {
  mass 150g
  link base = box(length, 40mm, 40mm)
  link tip = box(length, 40mm, 40mm) at [length + 20mm, 0mm, 0mm]
  joint bend: base -> tip = revolute(axis: Y, range: -60deg..60deg, max_speed: 60deg/s) at [length / 2 + 10mm, 0mm, 0mm]
  port back: Face on base at [-length / 2, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [length / 2, 0mm, 0mm] facing +X up +Z
  for i in 0..2 { port side[i]: Face on base at [0mm, if i == 0 { 20mm } else { -20mm }, 0mm] facing [0, 1 - 2 * i, 0] up +Z }
}
";

/// A program that is right: numbers, a robot that is a tree, behaviours within its limits.
pub fn program(dice: &mut Dice) -> String {
    let mut text = String::from(MODULE);
    let modules = 2 + dice.below(4);
    arithmetic(dice, &mut text);
    writeln!(text, "config Robot(bend: Angle = {}deg) {{", dice.below(30)).expect("text grows");
    writeln!(text, "  part h[{modules}]: Hinge(length: {}mm)", 40 + dice.below(20)).expect("text grows");
    let mut free = vec!["h[0].front".to_string(), "h[0].side[0]".into(), "h[0].side[1]".into()];
    for module in 1..modules {
        let port = free.swap_remove(dice.below(free.len()));
        let turn = dice.of(&["", " turn 90deg", " turn 180deg"]);
        writeln!(text, "  connect {port} -- h[{module}].back{turn}").expect("text grows");
        free.push(format!("h[{module}].front"));
        free.push(format!("h[{module}].side[{}]", dice.below(2)));
    }
    writeln!(text, "  set h[{}].bend = bend\n  base h[0]", dice.below(modules)).expect("text grows");
    writeln!(text, "  behavior all(to: Angle = bend) = Pc([move(x.bend, to: to) for x in h])")
        .expect("text grows");
    writeln!(text, "  behavior some = {}", behavior(dice, 0..modules, 3)).expect("text grows");
    text.push_str("}\nlet r = Robot()\n");
    text.push_str("print(r, count(r), mass(r), com(r), plan(r.all()).duration)\n");
    text.push_str("let p = plan(Sc(r.some(), r.all(10deg)))\n");
    text.push_str("print(p.duration, p.actions, reverse(p).duration, (p ++ r.some()).steps)\n");
    text
}

fn arithmetic(dice: &mut Dice, text: &mut String) {
    let (a, b, c) = (1 + dice.below(9), 1 + dice.below(9), 1 + dice.below(9));
    let op = dice.of(&["+", "-", "*"]);
    writeln!(text, "let n = {a} {op} {b}\nlet x = {c}mm / {b}").expect("text grows");
    writeln!(text, "fn f(k: Int, l: Length = {a}cm) -> Length = if k > {b} {{ l * k }} else {{ l / {c} }}")
        .expect("text grows");
    writeln!(text, "print(n, x + f({b}), [f(i, x) for i in 0..{a} if i % 2 == 0], \"{{n}} of {{x}}\")")
        .expect("text grows");
}

/// Of joints that no sibling in parallel uses.
fn behavior(dice: &mut Dice, joints: std::ops::Range<usize>, depth: usize) -> String {
    let simple = |dice: &mut Dice| {
        let joint = joints.start + dice.below(joints.len());
        let to = dice.below(100) as i64 - 50;
        format!("move(h[{joint}].bend, to: {to}deg)")
    };
    match dice.below(if depth == 0 { 2 } else { 5 }) {
        0 => simple(dice),
        1 => format!("wait({}ms)", 100 + dice.below(900)),
        2 => format!(
            "Sc({}, {})",
            behavior(dice, joints.clone(), depth - 1),
            behavior(dice, joints, depth - 1)
        ),
        3 if joints.len() > 1 => {
            let middle = joints.start + joints.len() / 2;
            let (a, b) = (
                behavior(dice, joints.start..middle, depth - 1),
                behavior(dice, middle..joints.end, depth - 1),
            );
            format!("Pc({a}, {b})")
        }
        _ => format!(
            "repeat(Sc({}, {}), {})",
            simple(dice),
            behavior(dice, joints.clone(), depth - 1),
            1 + dice.below(3)
        ),
    }
}

fn options() -> Options {
    let mut options = Options::default();
    options.limits.steps = 200_000;
    options.limits.samples = 1_000;
    options.limits.list = 10_000;
    options.limits.modules = 500;
    options
}

#[test]
fn programs_that_are_right_check_and_run() {
    for seed in 0..VALID {
        let text = program(&mut Dice::new(seed));
        let files = MapFiles::of(&text);
        for mode in [Mode::Check, Mode::Run] {
            let ran = ran(&files, "main.mod", mode, &options());
            let errors: Vec<_> = ran.outcome.diagnostics.iter().filter(|d| d.is_error()).collect();
            assert!(errors.is_empty(), "seed {seed}, {mode:?}: {errors:#?}\n{text}");
            assert_eq!(ran.host.printed.len(), if mode == Mode::Run { 3 } else { 0 }, "seed {seed}\n{text}");
        }
    }
}

/// A token or two of the program put where they do not belong, taken out, or doubled.
fn damaged(dice: &mut Dice, text: &str) -> String {
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        let joins =
            |last: &String| c.is_alphanumeric() && last.ends_with(|l: char| l.is_alphanumeric() || l == '_');
        match tokens.last_mut() {
            Some(last) if joins(last) => last.push(c),
            _ => tokens.push(c.to_string()),
        }
    }
    for _ in 0..1 + dice.below(3) {
        let (at, from) = (dice.below(tokens.len()), dice.below(tokens.len()));
        match dice.below(4) {
            0 => drop(tokens.remove(at)),
            1 => tokens[at] = tokens[from].clone(),
            2 => tokens.swap(at, from),
            _ => tokens.insert(at, tokens[from].clone()),
        }
    }
    tokens.concat()
}

#[test]
fn programs_that_were_damaged_never_panic() {
    let mut refused = 0;
    for seed in 0..DAMAGED {
        let mut dice = Dice::new(1_000 + seed);
        let whole = program(&mut dice);
        let text = damaged(&mut dice, &whole);
        let mode = if seed % 2 == 0 { Mode::Run } else { Mode::Check };
        let ran = ran(&MapFiles::of(&text), "main.mod", mode, &options());
        refused += u64::from(ran.outcome.diagnostics.iter().any(|d| d.is_error()));
    }
    assert!(refused > DAMAGED / 4, "the damage is seen: {refused}");
}
