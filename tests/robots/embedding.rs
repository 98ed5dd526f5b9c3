//! Embeddings against their definition: all injections of modules, tried one by one.

use crate::support::numbers::Numbers;
use crate::support::robots;
use modl::robot::{Assembly, Bond, Library, ModuleInstance, PortRef, embeddings};
use std::sync::Arc;

/// The number of random pairs of a pattern and a robot.
const PAIRS: u64 = 600;

/// Returns every embedding by the definition, ascending by the images of all modules.
fn by_definition(pattern: &Assembly, robot: &Assembly) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut images = Vec::new();
    extend(pattern, robot, &mut images, &mut found);
    found
}

fn extend(pattern: &Assembly, robot: &Assembly, images: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    if images.len() == pattern.modules.len() {
        if is_embedding(pattern, robot, images) {
            found.push(images.clone());
        }
        return;
    }
    for image in 0..robot.modules.len() {
        if !images.contains(&image) {
            images.push(image);
            extend(pattern, robot, images, found);
            images.pop();
        }
    }
}

fn is_embedding(pattern: &Assembly, robot: &Assembly, images: &[usize]) -> bool {
    let name = |of: &Assembly, module: usize| of.module_type(module).name.clone();
    let types = images.iter().enumerate().all(|(module, image)| name(pattern, module) == name(robot, *image));
    // Bonds as sets of two ports with a turn.
    let key = |a: PortRef, b: PortRef, turn| (a.min(b), a.max(b), turn);
    let mapped = |at: PortRef| PortRef { module: images[at.module], port: at.port };
    let mut wanted: Vec<_> =
        pattern.bonds.iter().map(|bond| key(mapped(bond.a), mapped(bond.b), bond.turn)).collect();
    let among = |bond: &&Bond| images.contains(&bond.a.module) && images.contains(&bond.b.module);
    let mut there: Vec<_> =
        robot.bonds.iter().filter(among).map(|bond| key(bond.a, bond.b, bond.turn)).collect();
    wanted.sort_unstable();
    there.sort_unstable();
    types && wanted == there
}

/// Returns a random connected robot of up to `most` modules of two types, with loops.
fn robot(n: &mut Numbers, library: &Arc<Library>, most: usize) -> Assembly {
    let count = 1 + n.below(most);
    let modules: Vec<ModuleInstance> =
        (0..count).map(|i| ModuleInstance { name: format!("m[{i}]"), kind: n.below(2) }).collect();
    let mut bonds: Vec<Bond> = Vec::new();
    let mut free: Vec<PortRef> = Vec::new();
    for (module, instance) in modules.iter().enumerate() {
        let ports = library.modules[instance.kind].ports.len();
        let mut own: Vec<PortRef> = (0..ports).map(|port| PortRef { module, port }).collect();
        // The first bond connects the module with those before, a second one may close a loop.
        for loops in 0..2 {
            if !free.is_empty() && !own.is_empty() && (loops == 0 || n.below(3) == 0) {
                let (a, b) = (free.swap_remove(n.below(free.len())), own.swap_remove(n.below(own.len())));
                let (a, b) = if n.below(2) == 0 { (a, b) } else { (b, a) };
                bonds.push(Bond { a, b, turn: n.below(2) as u32 });
            }
        }
        free.extend(own);
    }
    Assembly {
        name: String::new(),
        library: library.clone(),
        modules,
        bonds,
        base: 0,
        closed: true,
        misalignments: vec![],
    }
}

/// Returns a library of two module types that differ in nothing but the name.
fn library() -> Arc<Library> {
    let mut library = Library::clone(&robots::smores_library());
    let mut other = library.modules[0].clone();
    other.name = "Other".to_owned();
    library.modules.push(other);
    Arc::new(library)
}

/// Returns all embeddings, as the search finds them.
fn found(pattern: &Assembly, robot: &Assembly) -> Vec<Vec<usize>> {
    embeddings(pattern, robot).expect("in one piece").filter_map(|attempt| attempt.images).collect()
}

#[test]
fn random_robots_have_the_embeddings_of_the_definition() {
    let library = library();
    let (mut several, mut none, mut whole) = (0, 0, 0);
    for seed in 0..PAIRS {
        let mut n = Numbers(seed);
        let pattern = robot(&mut n, &library, 4);
        let robot = robot(&mut n, &library, 7);
        let wanted = by_definition(&pattern, &robot);
        assert_eq!(found(&pattern, &robot), wanted, "seed {seed}");
        several += usize::from(wanted.len() > 1);
        none += usize::from(wanted.is_empty());
        // Every robot is embedded in itself.
        let own = found(&robot, &robot);
        assert_eq!(own, by_definition(&robot, &robot), "seed {seed}");
        assert!(own.contains(&(0..robot.modules.len()).collect()), "seed {seed}");
        whole += usize::from(own.len() > 1);
    }
    assert!(several > 30 && none > 30 && whole > 5, "{several} {none} {whole}");
}

#[test]
fn each_attempt_compares_each_module_of_the_pattern_once_at_most() {
    let library = library();
    for seed in 0..50 {
        let mut n = Numbers(seed);
        let (pattern, robot) = (robot(&mut n, &library, 6), robot(&mut n, &library, 40));
        let attempts = embeddings(&pattern, &robot).expect("in one piece");
        let comparisons: Vec<usize> = attempts.map(|attempt| attempt.comparisons).collect();
        assert_eq!(comparisons.len(), robot.modules.len());
        assert!(comparisons.iter().all(|count| (1..=pattern.modules.len()).contains(count)), "seed {seed}");
    }
}

#[test]
fn patterns_in_pieces_have_no_embeddings_that_one_image_fixes() {
    let library = library();
    let module = |i: usize| ModuleInstance { name: format!("m[{i}]"), kind: 0 };
    let pieces = |count: usize| Assembly {
        name: String::new(),
        library: library.clone(),
        modules: (0..count).map(module).collect(),
        bonds: Vec::new(),
        base: 0,
        closed: false,
        misalignments: vec![],
    };
    assert!(embeddings(&pieces(0), &pieces(2)).is_none());
    assert!(embeddings(&pieces(2), &pieces(2)).is_none());
    // The robot may be in pieces.
    assert_eq!(found(&pieces(1), &pieces(2)), [[0], [1]]);
}
