//! The table of inputs tried in `docs/fuzzing.md`.

use super::tried;
use crate::fuzz::inputs::corpus::root;
use crate::fuzz::targets::TARGETS;

/// The lines about the table.
const BEGIN: &str =
    "<!-- Made from fuzz/tried.json; `UPDATE_DOCS=1 cargo test --release fuzzing` writes it. -->\n";
const END: &str = "<!-- The end of the table. -->\n";

/// Returns a number with commas between thousands.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let lead = digits.len() % 3;
    let mut text = digits[..lead].to_owned();
    for group in digits.as_bytes()[lead..].chunks(3) {
        if !text.is_empty() {
            text.push(',');
        }
        text.push_str(std::str::from_utf8(group).expect("digits"));
    }
    text
}

/// Returns the table.
fn table() -> String {
    let all = tried::read();
    let mut text = String::from(
        "| target | inputs tried | hours | inputs a second | broke a property, and was mended | what must hold |\n|---|--:|--:|--:|--:|---|\n",
    );
    let row = |name: &str, inputs: u64, seconds: f64, broke: u64, says: &str| {
        let rate = if seconds > 0.0 { inputs as f64 / seconds } else { 0.0 };
        format!("| {name} | {} | {:.2} | {rate:.0} | {broke} | {says} |\n", grouped(inputs), seconds / 3600.0)
    };
    for target in TARGETS {
        let tried = &all[target.name];
        text.push_str(&row(
            &format!("`{}`", target.name),
            tried.inputs,
            tried.seconds,
            tried.broke,
            target.says,
        ));
    }
    let sum = |of: &dyn Fn(&tried::Tried) -> f64| all.values().map(of).sum::<f64>();
    let (inputs, seconds, broke) = (sum(&|t| t.inputs as f64), sum(&|t| t.seconds), sum(&|t| t.broke as f64));
    text.push_str(&row("in all", inputs as u64, seconds, broke as u64, ""));
    text
}

#[test]
fn the_table_of_inputs_tried_is_up_to_date() {
    let path = root().join("docs/fuzzing.md");
    let page = std::fs::read_to_string(&path).expect("the page is there");
    let (before, rest) = page.split_once(BEGIN).expect("the table begins");
    let (_, after) = rest.split_once(END).expect("the table ends");
    let wanted = format!("{before}{BEGIN}\n{}\n{END}{after}", table());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &wanted).expect("the page can be written");
        return;
    }
    assert!(page == wanted, "docs/fuzzing.md is stale: run the tests with UPDATE_DOCS=1");
}
