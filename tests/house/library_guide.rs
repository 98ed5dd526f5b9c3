//! `docs/library.md`: the robots of the library by order, with what they can do. The test compares it;
//! `UPDATE_DOCS=1 cargo test --release library_guide` writes it.

use crate::language::interpret::ran;
use crate::support::fences::files;
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};
use modl::source::FileId;
use modl::syntax::ast::{Config, ConfigClauseKind, ItemKind};
use modl::syntax::parse;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

struct Robot {
    /// `std.smores`
    library: String,
    name: String,
    /// The first sentence of its documentation.
    about: String,
    behaviors: Vec<String>,
    /// Whether it is one without arguments.
    whole: bool,
}

fn robot(library: &str, doc: &str, config: &Config) -> Robot {
    let behaviors = config.clauses.iter().filter_map(|clause| match &clause.kind {
        ConfigClauseKind::Behavior(behavior) => Some(behavior.name.text.to_string()),
        _ => None,
    });
    let paragraph = doc.trim().split("\n\n").next().unwrap_or("");
    let words = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    Robot {
        library: library.to_owned(),
        name: config.name.text.to_string(),
        about: words.split_once(". ").map_or(words.clone(), |(first, _)| format!("{first}.")),
        behaviors: behaviors.filter(|name| !name.starts_with('_')).collect(),
        whole: config.params.iter().all(|param| param.default.is_some()),
    }
}

fn robots() -> Vec<Robot> {
    let mut found = Vec::new();
    for (path, text) in files("stdlib", "mod") {
        let library = path.trim_start_matches("stdlib/").trim_end_matches(".mod");
        for item in parse(FileId(0), &text).file.items {
            if let ItemKind::Config(config) = &item.kind
                && !config.scene
                && !config.name.text.as_str().starts_with('_')
            {
                found.push(robot(library, item.doc.as_deref().unwrap_or(""), config));
            }
        }
    }
    found
}

/// Order and number of modules, as the language has them.
fn facts(robots: &[Robot]) -> Vec<String> {
    let mut program = String::new();
    let mut libraries: Vec<&str> = robots.iter().map(|robot| robot.library.as_str()).collect();
    libraries.dedup();
    libraries.iter().for_each(|library| writeln!(program, "use std.{library}").expect("text grows"));
    for robot in robots.iter().filter(|robot| robot.whole) {
        let name = format!("{}.{}()", robot.library, robot.name);
        writeln!(program, "print(order({name}), count({name}))").expect("text grows");
    }
    let ran = ran(&MapFiles::of(&program), "main.mod", Mode::Run, &Options::default());
    let errors: Vec<_> = ran.outcome.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:#?}");
    ran.host.printed.iter().map(|line| line.trim().to_owned()).collect()
}

fn page() -> String {
    let robots = robots();
    let mut told = facts(&robots).into_iter();
    let mut by_order: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    for robot in &robots {
        let facts = robot.whole.then(|| told.next().expect("each has printed a line"));
        let (order, modules) = match facts.as_deref().and_then(|facts| facts.split_once(' ')) {
            Some((order, count)) => {
                let word = if count == "1" { "module" } else { "modules" };
                (order.parse().expect("a number"), format!(", {count} {word}"))
            }
            None => (u32::MAX, String::new()),
        };
        let behaviors: Vec<String> = robot.behaviors.iter().map(|name| format!("`{name}`")).collect();
        let can =
            if behaviors.is_empty() { String::new() } else { format!(" Can {}.", behaviors.join(", ")) };
        by_order.entry(order).or_default().push(format!(
            "- [`{name}`](reference/{library}.md#{anchor}), std.{library}{modules}: {}{can}",
            robot.about,
            name = robot.name,
            library = robot.library,
            anchor = robot.name.to_lowercase(),
        ));
    }
    let mut page = "# The robots of the library\n\n\
        <!-- Made from the declarations; `UPDATE_DOCS=1 cargo test --release library_guide` writes this page. -->\n\n\
        A configuration of order 1 is made of modules; one of order 2, of configurations of order 1 and \
        modules; and so on. `modl doc` draws them.\n"
        .to_owned();
    for (order, lines) in by_order {
        let title =
            if order == u32::MAX { "Of a size to be given".to_owned() } else { format!("Order {order}") };
        write!(page, "\n## {title}\n\n{}\n", lines.join("\n")).expect("text grows");
    }
    page
}

#[test]
fn the_guide_to_the_robots_is_that_of_the_declarations() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/library.md");
    let page = page();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &page).expect("docs can be written");
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == page,
        "docs/library.md is stale; UPDATE_DOCS=1 cargo test --release library_guide writes it"
    );
}
