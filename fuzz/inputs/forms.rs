//! Programs of every form of the grammar, made by a seeded generator. They can be read; they need not
//! mean anything.

use super::dice::Dice;
use modl::syntax::skeleton;

/// The greatest depth of forms within forms.
const DEPTH: usize = 6;

/// The programs that are tried until one can be read: the choices of a fuzzer may end.
const TRIES_MAX: usize = 1000;

/// The alternatives of each form; the first is the simplest. `<name>` stands for another form.
const FORMS: &[(&str, &[&str])] = &[
    ("file", &["<item>\n<item>\n\n<item>\n<item>\n"]),
    (
        "item",
        &[
            "let <n> = <e>",
            "let <n>: <type> = <body>",
            "use std.smores.{Smores, Chain3 as Chain}",
            "use \"a/b.mod\".{Part}",
            "use std.gaits",
            "fn <n>(<param>) = <body>",
            "fn f<A, D: Dimension>(a: List<A>, <param>) -> <type> = <body>",
            "fn <n>(<param>, <param>) -> <type> = <body>",
            "/// Says what it is.\nconnector C { mates <n>, D, turns 4, holds <e>, capture 2mm 3deg <e>, snap, hinge(axis: X) }",
            "record R { a: <type> }",
            "/// A record.\nrecord R {\n  /// A field.\n  a: <type> = <e>\n  for: <type>, b: <type>,\n}",
            "module M { <module> }",
            "module M(<param>) {\n<module>\n  <module>\n}",
            "config C(<param>) { <config> <config> }",
            "config C closed {\n  <config>\n<config>\n}",
            "scene W(<param>) {\n  <config>\n<config>\n}",
            "cell K { size 100mm, shrinks to }",
            "strut S { length <e> mass 3kg }",
            "lattice L(<param>) of K = <body>",
            "truss T of S = octet(edge: 4m, divisions: 4, interior: false)",
            "truss T(<param>) of a.S {\n  <truss>  <truss>\n<truss>\n}",
            "study s(<n> in <e>, n in 1..3) by grid(<n>: <e>) = <body>",
            "study s() by sobol(<e>)\n  each k in <e> each seed in 0..4 = <body>",
            "test \"it holds\" {\n<statement>\n  <statement>\n}",
            "extern fn f<T, D: Dimension>(a: T..., b: Quantity<D^2>) -> List<T>",
            "extern type R is P {\n  /// A field.\n  a: Length\n  fn at(t: Time) -> State,\n}",
            "<statement>",
            "<e>",
        ],
    ),
    (
        "statement",
        &[
            "let <n> = <e>",
            "print(<e>)",
            "expect <e>",
            "expect <e>, \"why\"",
            "require <e>, <text>",
            "ensure a > <e>, <text>",
            "for <n> in <e> { <e> }",
            "for <n> in <e> {\n<statement>\n  <statement>\n}",
            "if <e> { <e> }",
            "if <e> {\n <statement>\n} else if <e> { <e> } else {\n<e>\n}",
            "-<e>",
        ],
    ),
    ("body", &["<e>", "<e>", "{\n  let <n> = <e>\n<e>\n}", "{ <e> }"]),
    ("param", &["a: Length", "b: <type> = <e>", "for: Time"]),
    (
        "type",
        &[
            "Int",
            "List<<type>>",
            "<type>?",
            "fn(<type>, Int) -> <type>",
            "(exact | heuristic)",
            "Quantity<1/s>",
            "Quantity<kg*m^2>",
            "std.Smores",
            "auto | Int",
        ],
    ),
    (
        "module",
        &[
            "mass 100g",
            "touch 0.2mm",
            "contact 4mm",
            "link a = <e>",
            "link a = box(1mm, 1mm, 1mm)  collides <e>  at <e> turned(X, 90deg)",
            "joint a : b -> c = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 2N*m) at <e>",
            "joint a = -b / 2",
            "port p : Face on a at <e> facing -X up +Z",
            "port p[<e>]: Face on a facing [0, <e>, 0]",
            "motor m = a + 2 * b[0] - (c) (max_speed: <e>)",
            "touching a b",
            "alias c = d",
            "let <n> = <e>",
            "require <e>, \"no\"",
            "if <e> { <module> } else if <e> {\n<module>\n} else { <module> }",
            "for i in <e> {\n  <module>\n}",
        ],
    ),
    (
        "config",
        &[
            "part a: Smores",
            "/// Many.\n  part a[<e>]: b.Chain3(<arg>)",
            "part a[i in 0..4]: Leg(left: i < 2)",
            "part a: Leg at [<e>, 0m, 0m] turned(Z, <e>)",
            "part a[i in 0..4]: Leg(<arg>) at <e>",
            "obstacle wall = <e> at [0m, <e>, 0m]",
            "obstacle post[i] = sphere(<e>)",
            "world(friction: <e>)",
            "port p = a.b",
            "port p[4] = [<e>]",
            "base a[0].b",
            "behavior b = <body>",
            "/// Goes.\n  behavior b(<param>) allows unstable, collision(a, b) = <e>",
            "connect a.b -- c[<e>].d turn <e>",
            "connect a.b -- c.d",
            "set a.j = <e>",
            "let <n> = <body>",
            "require <e>",
            "if <e> { <config> } else { <config> }",
            "if <e> {\n<config>\n} else if <e> { <config> }",
            "for i in 0..n - 1 { <config> }",
        ],
    ),
    (
        "truss",
        &[
            "node a = [0m, 0m, 0m]",
            "node p[i] = [r * cos(<e>), <e>, 0m]",
            "strut a -- b",
            "strut p[i] -- p[(i + 1) % n]",
            "let <n> = <e>",
            "require <e>, \"no\"",
            "if <e> { <truss> } else if <e> { <truss> } else {\n<truss>\n}",
            "for i in 0..n { <truss> }",
        ],
    ),
    (
        "e",
        &[
            "<n>",
            "<number>",
            "<text>",
            "(<e>)",
            "[]",
            "[<e>, <e>,]",
            "[\n<e>,\n  <e>\n]",
            "[<e> for <n> in <e>]",
            "[<e>\n for <n> in <e> for <n> in <e> if <e>]",
            "<e> <op> <e>",
            "<e>\n  <wide> <e>",
            "<e> <op>\n <e>",
            "-<e>",
            "not (<e>)",
            "(<e>).a.for",
            "<n> with { a: <e>, for: <e> }",
            "(<e>) with {\n  a: <e>\n  b: <e>,\n}.b",
            "<n>[<e>]",
            "<n>(<arg>, <arg>)",
            "<n>(\n<arg>,\n  <arg>,\n)",
            "Sc(\n<e>,\n  Pc([x.lift(<e>) for x in leg]),\n)",
            "if <e> { <e> } else { <e> }",
            "if <e> { <e> } else if <e> {\n<e>\n} else { <e> }",
            "(a => <e>)",
            "map(xs, (a, b) => { <e> })",
            "move(j, to: <e>, until: angle(j) > 20deg, timeout: 2s) else abort(\"blocked\")",
            "[<e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>, <e>]",
        ],
    ),
    ("arg", &["<e>", "to: <e>", "for: <e>"]),
    ("n", &["a", "b", "reach", "_", "part", "turn", "X"]),
    ("number", &["1", "0.5", "1e-3", "30deg", "9.81m/s^2", "1_000", "2N*m", "2m^-1"]),
    (
        "text",
        &[
            "\"a\"",
            "\"{a} of {b + 1}\"",
            "\"{<n> in mm:.2} {<n>:.0} {a + 1 in deg/s}\"",
            "\"\\u{41}\\n\\{\"",
            "\"\"\"\n    #..\n    ##.\n    \"\"\"",
            "\"\"",
        ],
    ),
    (
        "op",
        &[
            "+", "-", "*", "/", "%", "^", "..", "++", "==", "!=", "<", "<=", ">", ">=", "<->", "and", "or",
            "else",
        ],
    ),
    ("wide", &["*", "/", "%", "..", "++", "==", "and", "or", "."]),
];

/// A program that the grammar can read.
pub fn program(dice: &mut Dice) -> String {
    // Forms that need their line for themselves may come to stand side by side.
    for _ in 0..TRIES_MAX {
        let mut text = String::new();
        expand("file", dice, 0, &mut text);
        if skeleton(&text).is_some() {
            return text;
        }
    }
    "let a = 1\n".to_owned()
}

fn expand(form: &str, dice: &mut Dice, depth: usize, out: &mut String) {
    let (_, choices) = FORMS.iter().find(|(name, _)| *name == form).expect("a form of the list");
    let chosen = if depth >= DEPTH { choices[0] } else { choices[dice.below(choices.len())] };
    let mut rest = chosen;
    while let Some(at) = rest.find('<') {
        let (before, tail) = rest.split_at(at);
        out.push_str(before);
        let name = tail[1..].split('>').next().filter(|name| FORMS.iter().any(|(form, _)| form == name));
        match name {
            Some(name) => {
                expand(name, dice, depth + 1, out);
                rest = &tail[name.len() + 2..];
            }
            None => {
                out.push('<');
                rest = &tail[1..];
            }
        }
    }
    out.push_str(rest);
}
