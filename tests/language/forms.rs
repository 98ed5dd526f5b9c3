//! Generated programs have every form of the grammar.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::forms::program;
use modl::syntax::skeleton;
use std::collections::BTreeSet;

/// Rules that make a node of their own; those for runs that are read after a mistake do not count.
fn rules() -> BTreeSet<String> {
    let grammar = include_str!("../../grammar/modl.pest");
    let rules = grammar.lines().filter_map(|line| {
        let (name, rest) = line.split_once('=')?;
        let name = name.trim_end();
        let plain = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
        (plain && rest.trim_start().starts_with(['$', '@'])).then(|| name.to_owned())
    });
    let again = ["chunk", "module_clauses", "config_clauses", "truss_clauses", "statements"];
    rules.filter(|name| !again.contains(&name.as_str())).collect()
}

#[test]
fn every_rule_of_the_grammar_is_among_the_generated_programs() {
    let mut seen = BTreeSet::new();
    for seed in 0..400 {
        let text = program(&mut Dice::new(seed));
        let found = format!("{:?}", skeleton(&text).expect("it can be read"));
        seen.extend(found.split('(').filter_map(|node| node.split(',').next()).map(str::to_owned));
    }
    let missing: Vec<String> = rules().difference(&seen).cloned().collect();
    assert!(missing.is_empty(), "no program has {missing:?}");
}
