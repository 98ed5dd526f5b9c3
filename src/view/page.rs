//! The page of a plan: one HTML file with style, scripts and the plan inside. It loads nothing.

use super::data;
use super::input::RenderInput;
use super::markup::escaped;
use super::picture::{PictureStyle, StillOptions, small_png};
use super::simulation::{self, SimulationInput};
use crate::geometry::Vec3;
use serde_json::Value;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/style.css");

/// The scripts in order of dependency.
const SCRIPTS: [&str; 15] = [
    include_str!("page/math.js"),
    include_str!("page/motion.js"),
    include_str!("page/shapes.js"),
    include_str!("page/shaders.js"),
    include_str!("page/detail.js"),
    include_str!("page/render.js"),
    include_str!("page/framing.js"),
    include_str!("page/camera.js"),
    include_str!("page/pace.js"),
    include_str!("page/timeline.js"),
    include_str!("page/curves.js"),
    include_str!("page/panel.js"),
    include_str!("page/overlay.js"),
    include_str!("page/scene.js"),
    include_str!("page/main.js"),
];

/// The page of a program that is typed, with its own style and the scripts that it has in place of the last one.
const LIVE_PAGE: &str = include_str!("page/live.html");
const LIVE_STYLE: &str = include_str!("page/live.css");
const LIVE_SCRIPTS: [&str; 5] = [
    include_str!("page/live_wire.js"),
    include_str!("page/live_source.js"),
    include_str!("page/live_controls.js"),
    include_str!("page/live_picture.js"),
    include_str!("page/live.js"),
];

/// The scripts that only pages of simulations have; they stand before the others.
const SIMULATION_SCRIPTS: [&str; 2] = [include_str!("page/measured.js"), include_str!("page/forces.js")];

/// The beginning of lines of [`SCRIPTS`] that are comments in pages of plans, and code in pages of simulations.
const SIMULATION_LINE: &str = "//: ";

/// The options of the still picture that is shown where scripts cannot run.
const STILL: StillOptions = StillOptions {
    time: 0.0,
    side: super::picture::Side::Corner,
    width: 352,
    height: 220,
    look: PictureStyle::Room,
};

/// Returns the page that plays a plan as HTML, which loads nothing from elsewhere. No text of the plan can become
/// markup: the data is JSON in which `<`, `>` and `&` are written as escapes, and the scripts put it on the page as
/// text, never as markup.
pub fn page(input: &RenderInput) -> String {
    whole(input, &data::data(input), &lean(&SCRIPTS.concat()))
}

/// Returns the data of a plan in which nothing moves, as the scripts of a [`live_page`] read it: JSON, whose texts never become
/// markup.
pub fn still_data(input: &RenderInput) -> Value {
    data::data(input)
}

/// Returns the page that plays a plan of a truss, with the surface that it takes on as a ghost: the corners of its triangles,
/// m, in the world's frame.
pub fn target_page(input: &RenderInput, target: &[[Vec3; 3]]) -> String {
    whole(input, &data::with_target(input, target), &lean(&SCRIPTS.concat()))
}

/// Returns the page that plays a simulation of a plan as HTML, with the plan as a ghost beside it. Its texts
/// can't become markup either, as those of [`page`].
pub fn simulation_page(input: &RenderInput, shown: &SimulationInput) -> String {
    let code = |line: &str| line.trim_start().strip_prefix(SIMULATION_LINE).unwrap_or(line).to_owned() + "\n";
    let scripts = SIMULATION_SCRIPTS.concat() + &SCRIPTS.concat();
    let scripts: String = scripts.lines().map(code).collect();
    whole(input, &simulation::data(input, shown), &lean(&scripts))
}

/// Returns the page that shows a program while it is typed: the same picture as the others, without data. It asks the server that
/// it comes from for what it shows.
pub fn live_page() -> String {
    let scripts = SCRIPTS[..SCRIPTS.len() - 1].concat() + &LIVE_SCRIPTS.concat();
    let script = format!("(() => {{\n\"use strict\";\n{}}})();\n", lean(&scripts));
    let style = lean(STYLE) + &lean(LIVE_STYLE);
    filled(LIVE_PAGE, &[("style", &style), ("script", &script)])
}

/// Returns a page with this data and these scripts.
fn whole(input: &RenderInput, data: &Value, scripts: &str) -> String {
    let script = format!("(() => {{\n\"use strict\";\n{scripts}}})();\n");
    let plan = unmarked(&data.to_string());
    let title = escaped(input.title);
    let still = base64(&small_png(input, &STILL));
    let texts: [(&str, &str); 5] =
        [("title", &title), ("style", &lean(STYLE)), ("still", &still), ("plan", &plan), ("script", &script)];
    filled(PAGE, &texts)
}

/// Returns the path of the page of a plan file: the same path with the ending `.html` instead of
/// `.plan.json`, `.json` or `.plan` in letters of any case; added to a path that has none of them.
pub fn page_name(plan_file: &str) -> String {
    let stem = without(without(plan_file, ".json"), ".plan");
    format!("{stem}.html")
}

/// Returns the name without an ending, compared regardless of case.
fn without<'a>(name: &'a str, ending: &str) -> &'a str {
    let at = name.len().saturating_sub(ending.len());
    let ends = name.get(at..).is_some_and(|rest| rest.eq_ignore_ascii_case(ending));
    if ends { &name[..at] } else { name }
}

/// Returns a template with texts for its placeholders. Placeholders are searched in the template only,
/// never in an inserted text.
fn filled(template: &str, texts: &[(&str, &str)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some(at) = rest.find('{') {
        let (before, from) = rest.split_at(at);
        page.push_str(before);
        let place = texts.iter().find(|(name, _)| from[1..].starts_with(&format!("{name}}}")));
        let skipped = match place {
            Some((name, text)) => {
                page.push_str(text);
                name.len() + 2
            }
            None => {
                page.push('{');
                1
            }
        };
        rest = &from[skipped..];
    }
    page + rest
}

/// Returns a script or style without indentation and comment lines.
fn lean(text: &str) -> String {
    let mut lean = String::with_capacity(text.len());
    let kept = text.lines().map(str::trim).filter(|line| {
        let comment = line.starts_with("//") || (line.starts_with("/*") && line.ends_with("*/"));
        !comment && !line.is_empty()
    });
    for line in kept {
        lean.push_str(line);
        lean.push('\n');
    }
    lean
}

/// Returns bytes as base64 text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= three.len() { letter as char } else { '=' });
        }
    }
    text
}

/// Returns JSON with `<`, `>`, `&` and line separators escaped, so that it has no meaning as markup.
fn unmarked(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => text.push_str(&format!("\\u{:04x}", letter as u32)),
            _ => text.push(letter),
        }
    }
    text
}
