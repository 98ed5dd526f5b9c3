//! The reserves that the library's documentation states, beside those that the judge finds under full dynamics.

use crate::support::desk;
use crate::support::fences::files;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::source::FileId;
use modl::syntax::ast::{ConfigClauseKind, ItemKind};
use modl::syntax::parse;
use std::thread;

/// The part of a limit by which the documentation may state less than the judge finds, without unit.
const SPARE: f64 = 0.1;

/// The sentence that states the reserve of a behaviour begins so, and goes on with the number and the world.
const STATES: &str = "Keeps a reserve of ";

/// A behaviour of the library with what its documentation says of its reserve.
#[derive(Debug)]
struct Stated {
    /// The library and the robot or scene: `smores.Car`.
    robot: String,
    /// True for a scene, in which no plan begins after a docking: what comes before is judged, too.
    scene: bool,
    /// The behaviour as a call: `turn()`.
    call: String,
    /// A call of the behaviour that comes before; `None`: it begins in the start pose.
    after: Option<String>,
    /// The world: a value of `ground`.
    ground: &'static str,
    /// The part of the limit that is left to the joint with the greatest load, without unit.
    reserve: f64,
}

/// Reads `Keeps a reserve of 0.45 on level ground with friction 1, as `turn(90deg)`, after `stand()`.`, or `... with its
/// base held`; `None` where a documentation has no such sentence.
fn stated(robot: &str, scene: bool, behavior: &str, doc: &str) -> Option<Stated> {
    let words = doc.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, rest) = words.split_once(STATES)?;
    let (reserve, rest) = rest.split_once(' ')?;
    let grounds = [("on level ground with friction 1", "settle"), ("with its base held", "held")];
    let (rest, ground) =
        grounds.iter().find_map(|(words, ground)| Some((rest.strip_prefix(words)?, *ground)))?;
    let said =
        |word: &str| rest.split_once(&format!(", {word} `")).and_then(|(_, call)| call.split('`').next());
    Some(Stated {
        robot: robot.to_owned(),
        scene,
        call: said("as").map_or(format!("{behavior}()"), str::to_owned),
        after: said("after").map(str::to_owned),
        ground,
        reserve: reserve.parse().ok()?,
    })
}

/// Returns the behaviours of all robots of the library; fails where one does not state its reserve.
fn library() -> Vec<Stated> {
    let mut found = vec![];
    for (path, text) in files("stdlib", "mod") {
        let library = path.trim_start_matches("stdlib/").trim_end_matches(".mod");
        for item in parse(FileId(0), &text).file.items {
            let ItemKind::Config(config) = item.kind else { continue };
            let robot = format!("{library}.{}", config.name.text);
            for clause in &config.clauses {
                let ConfigClauseKind::Behavior(behavior) = &clause.kind else { continue };
                let name = behavior.name.text.as_str();
                if name.starts_with('_') {
                    continue;
                }
                let doc = clause.doc.as_deref().unwrap_or("");
                let stated = stated(&robot, config.scene, name, doc);
                found.push(stated.unwrap_or_else(|| panic!("{robot}.{name} does not state its reserve")));
            }
        }
    }
    found
}

/// Returns what is wrong with what the documentation says of a behaviour; `None` if it is right.
fn contradiction(stated: &Stated) -> Option<String> {
    let Stated { robot, scene, call, after, ground, reserve } = stated;
    let (library, name) = robot.split_once('.').expect("a robot is named with its library");
    let (motion, begin) = match after {
        Some(after) if *scene => (format!("Sc(x.{after}, x.{call})"), String::new()),
        Some(after) => (format!("x.{call}"), format!("from: plan(x.{after}).end, ")),
        None => (format!("x.{call}"), String::new()),
    };
    let program = format!(
        "use std.{library}.{name}\nlet x = {name}()\n\
         let p = plan({motion}, {begin}world: world(dynamics: full, ground: {ground}))\n\
         let r = verify(p, reserve: 0)\nprint(r.ok)\nprint(r.torque_margin)\nprint(r.failures)\n"
    );
    let (observed, _, _) = desk::run(&MapFiles::of(&program), Mode::Run);
    let [ok, margin, ..] = &observed.printed[..] else {
        return Some(format!("{stated:?}: {:?}", observed.diagnostics));
    };
    let found: f64 = margin.parse().expect("a margin is a number");
    let right = ok == "true" && (found - SPARE..=found).contains(reserve);
    (!right).then(|| format!("{robot}.{call} states {reserve}: {:?}", observed.printed))
}

#[test]
fn behaviors_of_the_library_keep_the_reserves_that_they_state() {
    let all = library();
    assert!(all.len() > 50, "the library has more behaviours than {}", all.len());
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let wrong: Vec<String> = thread::scope(|scope| {
        let share = |first: usize| {
            let mine = all.iter().skip(first).step_by(threads);
            scope.spawn(move || mine.filter_map(contradiction).collect::<Vec<_>>())
        };
        let shares: Vec<_> = (0..threads).map(share).collect();
        shares.into_iter().flat_map(|share| share.join().expect("no thread panics")).collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn sentences_that_state_a_reserve_are_read() {
    let read = |doc| stated("a.B", false, "go", doc).map(|s| (s.call, s.after, s.ground, s.reserve));
    let some = |call: &str, after: Option<&str>, ground, reserve| {
        Some((call.to_owned(), after.map(str::to_owned), ground, reserve))
    };
    assert_eq!(read("Goes."), None);
    assert_eq!(
        read("Goes.\n\nKeeps a reserve of 0 on level ground with friction 1."),
        some("go()", None, "settle", 0.0)
    );
    assert_eq!(
        read("Goes.\n\nKeeps a reserve of 0.45 with its base\nheld, as `go(1)`, after `stand()`."),
        some("go(1)", Some("stand()"), "held", 0.45)
    );
}
