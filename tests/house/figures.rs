//! The figures of the house, measured: `cargo test --release --test all figures -- --nocapture` prints the
//! table of `docs/architecture.md`. The limits that the house holds itself to are asserted in `tidy`.

use crate::support::sources::{code_lines, knots, rust};

#[test]
fn figures_of_the_house() {
    for knot in knots().iter().take(6) {
        println!("knot of {}: {}", knot.len(), knot.join(" "));
    }
    println!("numbered arguments: {}", numbered_arguments());
}

fn numbered_arguments() -> usize {
    let natives = rust("src")
        .into_iter()
        .filter(|(file, _)| file.starts_with("src/natives/") || file.starts_with("src/interpret/natives"));
    natives
        .map(|(_, text)| code_lines(&text).map(|(_, line)| line.matches("call.").count()).sum::<usize>())
        .sum()
}
