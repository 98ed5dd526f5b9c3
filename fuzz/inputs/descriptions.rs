//! Robot descriptions in URDF: trees of links, with shapes, masses and joints of every kind, and then damaged.

use super::damage::{damaged, damaged_lines, damaged_numbers};
use super::dice::Dice;
use super::meshes;
use std::fmt::Write;

const NAMES: &[&str] =
    &["base", "arm", "for", "m", "2 hands", "a-b", "Link", "link", "ö", "x_1", "kg", "_", "a&amp;b", "A"];

/// Returns a description, behind the name of its file.
pub fn file(dice: &mut Dice) -> Vec<u8> {
    let text = description(dice);
    let text = match dice.below(6) {
        0 | 1 => text,
        2 => damaged_lines(dice, &text),
        3 => damaged_numbers(dice, &text),
        4 => damaged_words(dice, &text),
        _ => damaged(dice, &text),
    };
    super::files::joined(&[
        ("robot.urdf", text.as_bytes()),
        ("mesh.obj", meshes::obj(&meshes::mesh(dice)).as_bytes()),
    ])
}

/// A word of the description in the place of another.
fn damaged_words(dice: &mut Dice, text: &str) -> String {
    let words = [
        "revolute",
        "continuous",
        "prismatic",
        "fixed",
        "box",
        "sphere",
        "cylinder",
        "capsule",
        "mesh",
        "collision",
        "visual",
        "origin",
        "mimic",
    ];
    let (from, to) = (dice.of(&words), dice.of(&words));
    text.replacen(from, to, 1 + dice.below(2))
}

fn number(dice: &mut Dice) -> String {
    match dice.below(40) {
        0 => "0".to_owned(),
        1 => "1e-9".to_owned(),
        2 => "1e6".to_owned(),
        3 => "1.5707963267948966".to_owned(),
        4 => "-1e3".to_owned(),
        _ => format!("{}", dice.below(401) as f64 / 200.0 - 1.0),
    }
}

fn positive(dice: &mut Dice) -> String {
    match dice.below(40) {
        0 => "1e-7".to_owned(),
        1 => "1e4".to_owned(),
        2 => "1e-200".to_owned(),
        _ => format!("{}", (1 + dice.below(200)) as f64 / 400.0),
    }
}

fn vector(dice: &mut Dice) -> String {
    [0; 3].map(|_| number(dice)).join(" ")
}

fn origin(dice: &mut Dice) -> String {
    match dice.below(3) {
        0 => String::new(),
        1 => format!("<origin xyz=\"{}\"/>", vector(dice)),
        _ => format!("<origin xyz=\"{}\" rpy=\"{}\"/>", vector(dice), vector(dice)),
    }
}

fn shape(dice: &mut Dice) -> String {
    let positive = &mut || positive(dice);
    let (a, b, c) = (positive(), positive(), positive());
    match dice.below(5) {
        0 => format!("<box size=\"{a} {b} {c}\"/>"),
        1 => format!("<sphere radius=\"{a}\"/>"),
        2 => format!("<cylinder radius=\"{a}\" length=\"{b}\"/>"),
        3 => format!("<capsule radius=\"{a}\" length=\"{b}\"/>"),
        _ => format!("<mesh filename=\"package://it/mesh.obj\" scale=\"{a} {b} {c}\"/>"),
    }
}

fn link(dice: &mut Dice, name: &str) -> String {
    let mut text = format!("<link name=\"{name}\">\n");
    if dice.below(4) > 0 {
        let (mass, i) = (positive(dice), positive(dice));
        let _ = writeln!(
            text,
            "<inertial>{}<mass value=\"{mass}\"/><inertia ixx=\"{i}\" iyy=\"{i}\" izz=\"{}\" ixy=\"{}\" ixz=\"0\" iyz=\"0\"/></inertial>",
            origin(dice),
            positive(dice),
            if dice.below(3) == 0 { number(dice) } else { "0".to_owned() }
        );
    }
    for _ in 0..dice.below(3) {
        let element = dice.of(&["collision", "collision", "visual"]);
        let _ = writeln!(text, "<{element}>{}<geometry>{}</geometry></{element}>", origin(dice), shape(dice));
    }
    text + "</link>\n"
}

fn joint(dice: &mut Dice, name: &str, [parent, child]: [&str; 2], others: &[String]) -> String {
    let kind = dice.of(&["revolute", "continuous", "prismatic", "fixed", "revolute"]);
    let mut text = format!(
        "<joint name=\"{name}\" type=\"{kind}\">\n<parent link=\"{parent}\"/><child link=\"{child}\"/>{}\n",
        origin(dice)
    );
    let axis = dice.of(&["0 0 1", "0 1 0", "1 0 0", "0 0.6 0.8", "-1 0 0"]);
    let _ = writeln!(text, "<axis xyz=\"{axis}\"/>");
    if dice.below(4) > 0 {
        let (low, high) = (positive(dice), positive(dice));
        let (effort, speed) = (positive(dice), positive(dice));
        let _ = writeln!(
            text,
            "<limit lower=\"-{low}\" upper=\"{high}\" effort=\"{effort}\" velocity=\"{speed}\"/>"
        );
    }
    if dice.below(5) == 0 {
        let _ = writeln!(text, "<dynamics damping=\"{}\" friction=\"{}\"/>", positive(dice), positive(dice));
    }
    if dice.below(5) == 0 && !others.is_empty() {
        let other = &others[dice.below(others.len())];
        let _ = writeln!(
            text,
            "<mimic joint=\"{other}\" multiplier=\"{}\" offset=\"{}\"/>",
            number(dice),
            number(dice)
        );
    }
    text + "</joint>\n"
}

/// Returns a description that is a tree of links.
fn description(dice: &mut Dice) -> String {
    let many = 1 + dice.below(6);
    let name = |dice: &mut Dice, index: usize| match dice.below(3) {
        0 => format!("{}{index}", dice.of(NAMES)),
        _ => format!("l{index}"),
    };
    let links: Vec<String> = (0..many).map(|index| name(dice, index)).collect();
    let mut text = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", dice.of(NAMES));
    links.iter().for_each(|name| text.push_str(&link(dice, name)));
    let joints: Vec<String> = (1..many).map(|index| name(dice, index)).collect();
    for child in 1..many {
        let parent = dice.below(child);
        text.push_str(&joint(dice, &joints[child - 1], [&links[parent], &links[child]], &joints));
    }
    text + "</robot>\n"
}
