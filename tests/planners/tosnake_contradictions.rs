//! Files whose connections contradict each other: which are left out is searched for, and compared with all spanning
//! trees of the connections, placed by the formulas of the RoFI project.

use crate::language::interpret::{Ran, ran};
use crate::support::replay::{Matrix, about_x, about_z, across, face, inverse, shift, times};
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};
use modl::source::{Severity, code};
use std::f64::consts::{FRAC_PI_2, PI};

const DOCKS: [(&str, &str); 3] = [("+X", "plus_x"), ("-X", "minus_x"), ("-Z", "minus_z")];

/// A connection: (module, side, dock) twice, and the turn between.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    a: (usize, usize, usize),
    b: (usize, usize, usize),
    turn: usize,
}

/// A configuration as a file states it: joints in quarter turns.
struct Tangle {
    joints: Vec<[i32; 3]>,
    edges: Vec<Edge>,
}

/// Numbers that look random, by Knuth's constants.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % n
    }
}

impl Tangle {
    /// Modules each on one before it, and two connections more between docks that are free.
    fn of_seed(seed: u64) -> Tangle {
        let mut dice = Dice(seed);
        let n = 5 + dice.below(3);
        let quarter = |dice: &mut Dice| dice.below(3) as i32 - 1;
        let joints = (0..n).map(|_| [0; 3].map(|_| quarter(&mut dice))).collect();
        let mut free: Vec<Vec<(usize, usize)>> =
            vec![(0..2).flat_map(|side| (0..3).map(move |dock| (side, dock))).collect(); n];
        let mut edges = Vec::new();
        let mut pairs: Vec<(usize, usize)> = (1..n).map(|i| (dice.below(i), i)).collect();
        pairs.extend([dice.below(n - 1), dice.below(n - 1)].map(|i| (i, n - 1)));
        for (i, j) in pairs {
            if i == j || free[i].is_empty() || free[j].is_empty() {
                continue;
            }
            let mut end = |module: usize| {
                let at = dice.below(free[module].len());
                let (side, dock) = free[module].remove(at);
                (module, side, dock)
            };
            let (a, b) = (end(i), end(j));
            edges.push(Edge { a, b, turn: dice.below(4) });
        }
        Tangle { joints, edges }
    }

    fn file(&self) -> String {
        let mut text = String::from("C\n");
        for (id, joints) in self.joints.iter().enumerate() {
            let [a, b, c] = joints.map(|quarter| 90 * quarter);
            text += &format!("M {id} {a} {b} {c}\n");
        }
        for Edge { a, b, turn } in &self.edges {
            let side = |side: usize| ["A", "B"][side];
            let turn = ["N", "E", "S", "W"][*turn];
            let [from, to] = [a, b].map(|end| DOCKS[end.2].0);
            text += &format!("E {} {} {from} {turn} {to} {} {}\n", a.0, side(a.1), side(b.1), b.0);
        }
        text
    }

    /// The line of the file that states an edge.
    fn line(&self, edge: usize) -> usize {
        2 + self.joints.len() + edge
    }

    /// Both balls of each module with these edges, in pitches; `None` where they do not reach all. Edges later in the
    /// list than those that reached a module count for nothing.
    fn shoes(&self, edges: &[usize]) -> Option<Vec<Matrix>> {
        let n = self.joints.len();
        let inside: Vec<Matrix> = self
            .joints
            .iter()
            .map(|joints| {
                let [alpha, beta, gamma] = joints.map(|quarter| FRAC_PI_2 * f64::from(quarter));
                across(alpha, beta, gamma)
            })
            .collect();
        let mut shoes: Vec<Option<Matrix>> = vec![None; 2 * n];
        (shoes[0], shoes[1]) = (Some(shift(0.0)), Some(inside[0]));
        let mut reached = 1;
        loop {
            let before = reached;
            for &edge in edges {
                let Edge { a, b, turn } = self.edges[edge];
                let there = mate(a.2, turn, b.2);
                for (from, to, across) in [(a, b, there), (b, a, inverse(&there))] {
                    let Some(at) = shoes[2 * from.0 + from.1] else { continue };
                    if shoes[2 * to.0].is_some() {
                        continue;
                    }
                    let shoe = times(&at, &across);
                    let other = if to.1 == 0 { inside[to.0] } else { inverse(&inside[to.0]) };
                    shoes[2 * to.0 + to.1] = Some(shoe);
                    shoes[2 * to.0 + 1 - to.1] = Some(times(&shoe, &other));
                    reached += 1;
                }
            }
            if reached == n {
                return shoes.into_iter().collect();
            }
            if reached == before {
                return None;
            }
        }
    }

    /// Returns the distance by which a connection fails to meet.
    fn missing(&self, edge: usize, shoes: &[Matrix]) -> f64 {
        let Edge { a, b, turn } = self.edges[edge];
        let wanted = times(&shoes[2 * a.0 + a.1], &mate(a.2, turn, b.2));
        let found = &shoes[2 * b.0 + b.1];
        (0..16).map(|i| (wanted[i / 4][i % 4] - found[i / 4][i % 4]).abs()).fold(0.0, f64::max)
    }

    /// All spanning trees, as lists of edges.
    fn trees(&self) -> Vec<Vec<usize>> {
        let (n, m) = (self.joints.len(), self.edges.len());
        let all = (0..1u32 << m).filter(|set| set.count_ones() as usize == n - 1);
        let lists = all.map(|set| (0..m).filter(|edge| set >> edge & 1 == 1).collect::<Vec<_>>());
        lists.filter(|list| self.shoes(list).is_some()).collect()
    }
}

/// From shoe to shoe over two docks.
fn mate(a: usize, turn: usize, b: usize) -> Matrix {
    let quarter = about_z(FRAC_PI_2 * turn as f64);
    let [first, second] = [a, b].map(|dock| face(DOCKS[dock].1));
    times(&times(&times(&first, &quarter), &shift(-1.0)), &times(&about_x(PI), &inverse(&second)))
}

/// The pairs of modules that are in each other.
fn overlaps(shoes: &[Matrix]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (i, a) in shoes.iter().enumerate() {
        for (j, b) in shoes.iter().enumerate().skip(i + 1).filter(|(j, _)| j / 2 != i / 2) {
            let squared: f64 = (0..3).map(|k| (a[k][3] - b[k][3]) * (a[k][3] - b[k][3])).sum();
            if squared < 0.999 * 0.999 {
                found.push((i / 2, j / 2));
            }
        }
    }
    found.dedup();
    found
}

fn loaded(file: &str, program: &str) -> Ran {
    let mut files = MapFiles::of(program);
    files.0.insert("x.rofi".into(), file.as_bytes().to_vec());
    ran(&files, "main.mod", Mode::Run, &Options::default())
}

const PROGRAM: &str = "use std.rofi.Rofi
let x = load(\"x.rofi\")
save(x, \"y.rofi\")
print(verify(x, world: world(ground: off, gravity: off)).ok)
";

/// A free choice is found wherever there is one, and where there is none the lines that are named force the overlap
/// that is named.
#[test]
fn a_choice_without_overlap_is_found_wherever_there_is_one() {
    // The counts of tangles whose first tree overlaps and another does not, and of those where none is free.
    let (mut other, mut none, mut forced) = (0, 0, 0);
    for seed in 0..600 {
        let tangle = Tangle::of_seed(seed);
        let shoes = |tree: &Vec<usize>| tangle.shoes(tree).expect("it is a tree");
        let trees = tangle.trees();
        let free = trees.iter().filter(|tree| overlaps(&shoes(tree)).is_empty()).count();
        let contradicts = |tree: &Vec<usize>| {
            let shoes = shoes(tree);
            (0..tangle.edges.len()).any(|edge| tangle.missing(edge, &shoes) > 1e-3)
        };
        if !trees.iter().any(contradicts) {
            continue;
        }
        let done = loaded(&tangle.file(), PROGRAM);
        assert_eq!(done.host.printed, [if free > 0 { "true" } else { "false" }], "{}", tangle.file());
        let warnings: Vec<_> =
            done.outcome.diagnostics.iter().filter(|d| d.severity == Severity::Warning).collect();
        assert!(warnings.iter().all(|d| d.code == code::OPEN_LOOP), "{warnings:?}");
        if free > 0 {
            other += usize::from(free < trees.len());
            // The connections that are kept meet, and those that are left out do not.
            let kept = std::str::from_utf8(&done.host.written["y.rofi"]).expect("text");
            let all = tangle.file();
            let lines: Vec<&str> = all.lines().skip(1 + tangle.joints.len()).collect();
            let holds: Vec<usize> = (0..lines.len()).filter(|&edge| kept.contains(lines[edge])).collect();
            let shoes = shoes(&holds);
            assert!(overlaps(&shoes).is_empty(), "{all}");
            for edge in 0..lines.len() {
                assert_eq!(tangle.missing(edge, &shoes) < 1e-3, holds.contains(&edge), "{all}\n{edge}");
            }
            continue;
        }
        none += 1;
        let told = warnings.iter().find(|d| d.message.contains("whichever of them are left out"));
        let label = &told.unwrap_or_else(|| panic!("{warnings:?}")).labels[0].text;
        // "... lines 8, 9 put modules 2 and 4 into each other ..."
        let numbers: Vec<usize> =
            label.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect();
        let (lines, modules) = numbers.split_at(numbers.len() - 2);
        let edges: Vec<usize> =
            (0..tangle.edges.len()).filter(|edge| lines.contains(&tangle.line(*edge))).collect();
        assert_eq!(edges.len(), lines.len(), "{label}");
        let pair = (modules[0], modules[1]);
        // Any tree with these lines has the overlap; they are all that is between the two.
        let with = |tree: &&Vec<usize>| edges.iter().all(|edge| tree.contains(edge));
        assert!(trees.iter().filter(with).all(|tree| overlaps(&shoes(tree)).contains(&pair)), "{label}");
        assert!(trees.iter().any(|tree| with(&tree)), "{label}");
        if label.contains("in any case") {
            forced += 1;
            assert!(trees.iter().all(|tree| overlaps(&shoes(tree)).contains(&pair)), "{label}");
        }
    }
    assert!(other > 100 && none > 20 && forced > 10, "{other} {none} {forced}: the test says little");
}

/// Without a contradiction the planner names the connections between two modules that are in each other: of six modules
/// in a row, the last four of which turn by a right angle each, so that the last ball of the sixth is where the last ball
/// of the second is. (Balls along y and z, in pitches: (0, 3) to (0, 5), (-1, 5), (-2, 5), (-2, 4), (-2, 3), (-1, 3), (0, 3).)
#[test]
fn the_connections_that_force_an_overlap_are_named() {
    let row: String = (0..6).map(|i| format!("M {i} 0 {} 0\n", if i < 2 { 0 } else { 90 })).collect();
    let edges: String =
        (0..5).map(|i| format!("E {i} B -Z {} -Z A {}\n", if i < 2 { 'N' } else { 'S' }, i + 1)).collect();
    let done = loaded(&format!("C\n{row}{edges}"), "use std.rofi.Rofi\nprint(tosnake(load(\"x.rofi\")))\n");
    let [error] = &done.outcome.diagnostics[..] else { panic!("{:?}", done.outcome.diagnostics) };
    assert_eq!(error.code, code::NO_WAY);
    let all = format!("{error:?}");
    assert!(all.contains("m[1] and m[5]"), "{all}");
    for i in 0..5 {
        let named = all.contains(&format!("m[{i}].b_minus_z -- m[{}].a_minus_z", i + 1));
        assert_eq!(named, i >= 1, "{all}");
    }
}
