//! `modl doc` where its site is there already: what is written, kept, and removed.

use crate::desk::cli::{Ran, Sandbox};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::SystemTime;

/// A tetrahedron, whose size a test changes.
const WEDGE: &str = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const CLAW: &str = "/// A claw of a file, beside [a block](block.mod).
module Claw { mass 50g  link body = mesh(\"wedge.off\", scale: 40mm) }
";
const BLOCK: &str = "/// A block.\nmodule Block { mass 300g  link body = box(40mm, 40mm, 40mm) }\n";
/// It needs `block.mod`.
const PAIR: &str = "use \"block.mod\".{Block}\n/// A block of its own.\nconfig Alone { part b: Block }\n";

fn project() -> Sandbox {
    Sandbox::new(&[
        ("wedge.off", WEDGE.as_bytes()),
        ("claw.mod", CLAW.as_bytes()),
        ("block.mod", BLOCK.as_bytes()),
        ("pair.mod", PAIR.as_bytes()),
    ])
}

fn documented(sandbox: &Sandbox) -> Ran {
    let ran = sandbox.run(&["doc", "--only"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// The files below a folder with their bytes and the times when they were written.
fn tree(folder: &Path) -> BTreeMap<String, (Vec<u8>, SystemTime)> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name in UTF-8");
        if entry.path().is_dir() {
            let inner = tree(&entry.path()).into_iter();
            found.extend(inner.map(|(path, file)| (format!("{name}/{path}"), file)));
        } else {
            let written = entry.metadata().and_then(|about| about.modified()).expect("a time");
            found.insert(name, (fs::read(entry.path()).expect("a file"), written));
        }
    }
    found
}

fn site(sandbox: &Sandbox) -> BTreeMap<String, (Vec<u8>, SystemTime)> {
    tree(&sandbox.path("out/doc"))
}

/// Compares the site, manifest included, with one that is made in another folder.
fn expect_as_anew(sandbox: &Sandbox, when: &str) {
    let ran = sandbox.run(&["doc", "--only", "--out", "anew"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let bytes = |folder: &str| -> BTreeMap<String, Vec<u8>> {
        tree(&sandbox.path(folder)).into_iter().map(|(name, (bytes, _))| (name, bytes)).collect()
    };
    let (here, anew) = (bytes("out/doc"), bytes("anew/doc"));
    assert_eq!(here.keys().collect::<Vec<_>>(), anew.keys().collect::<Vec<_>>(), "{when}");
    for (name, bytes) in &anew {
        assert!(here[name] == *bytes, "{when}: {name}");
    }
    fs::remove_dir_all(sandbox.path("anew")).expect("it was made");
}

/// The names of the files that differ in their times: those that were written since.
fn written(sandbox: &Sandbox, before: &BTreeMap<String, (Vec<u8>, SystemTime)>) -> Vec<String> {
    let changed = |(name, file): (&String, &(Vec<u8>, SystemTime))| {
        (before.get(name).map(|(_, time)| time) != Some(&file.1)).then(|| name.clone())
    };
    site(sandbox).iter().filter_map(changed).collect()
}

#[test]
fn only_what_has_changed_is_written_again() {
    let sandbox = project();
    let first = documented(&sandbox);
    assert!(first.err.contains("wrote out/doc/index.html and "), "{}", first.err);
    let before = site(&sandbox);
    let again = documented(&sandbox);
    assert!(again.err.starts_with("nothing has changed: out/doc/index.html and "), "{}", again.err);
    assert!(site(&sandbox) == before, "{:?}", written(&sandbox, &before));

    // A comment is on its page and in the lists; the picture is drawn again and is the same.
    fs::write(sandbox.path("pair.mod"), PAIR.replace("of its own", "alone")).expect("a file");
    let third = documented(&sandbox);
    let pages = [".modl-doc.json", "guide.html", "index.html", "index.js", "pair-mod.html"];
    let since = written(&sandbox, &before);
    assert!(since.iter().all(|name| pages.contains(&name.as_str())), "{since:?}");
    assert!(since.contains(&"pair-mod.html".to_owned()), "{since:?}");
    assert!(third.err.contains(" files in out/doc\n"), "{}", third.err);
    expect_as_anew(&sandbox, "a comment was changed");

    // A block is drawn on two pages, one of which imports it. The file of a page that links to it is taken along.
    let before = site(&sandbox);
    fs::write(sandbox.path("block.mod"), BLOCK.replace("40mm)", "80mm)")).expect("a file");
    documented(&sandbox);
    let since = written(&sandbox, &before);
    for name in ["pictures/block-mod-Block.png", "pictures/pair-mod-Alone.png", "files/block.mod"] {
        assert!(since.contains(&name.to_owned()), "{name} in {since:?}");
    }
    assert!(!since.contains(&"pictures/claw-mod-Claw.png".to_owned()), "{since:?}");
    expect_as_anew(&sandbox, "a module was changed");

    // A picture depends on all files that its program reads, meshes included.
    let before = site(&sandbox);
    fs::write(sandbox.path("wedge.off"), WEDGE.replace("0 0 1\n3", "0 0 3\n3")).expect("a file");
    documented(&sandbox);
    assert_eq!(written(&sandbox, &before), [".modl-doc.json", "pictures/claw-mod-Claw.png"]);
    expect_as_anew(&sandbox, "a mesh was changed");
}

#[test]
fn pages_without_a_source_are_removed_and_nothing_else_is() {
    let sandbox = project();
    documented(&sandbox);
    for name in ["notes.html", "pictures/mine.png"] {
        fs::write(sandbox.path(&format!("out/doc/{name}")), "mine").expect("a file");
    }
    // A page that someone has changed is theirs.
    let edited = sandbox.path("out/doc/claw-mod.html");
    fs::write(&edited, "edited").expect("a file");
    for name in ["pair.mod", "claw.mod"] {
        fs::remove_file(sandbox.path(name)).expect("a source");
    }
    let ran = documented(&sandbox);
    assert!(ran.err.contains("left out/doc/claw-mod.html: it is not as modl wrote it"), "{}", ran.err);
    assert!(ran.err.contains(", removed 4\n"), "{}", ran.err);
    assert_eq!(fs::read(&edited).expect("it is left"), b"edited");
    let names: Vec<String> = site(&sandbox).into_keys().collect();
    assert!(names.contains(&"notes.html".to_owned()) && names.contains(&"pictures/mine.png".to_owned()));
    // The page that linked to a file of the project is gone, so its copy and its folder are, too.
    assert!(!names.iter().any(|name| name.contains("pair-mod") || name.contains("Claw")), "{names:?}");
    assert!(!sandbox.path("out/doc/files").exists());
    for name in ["notes.html", "pictures/mine.png", "claw-mod.html"] {
        fs::remove_file(sandbox.path(&format!("out/doc/{name}"))).expect("a file");
    }
    expect_as_anew(&sandbox, "sources were removed");
    // A page of a source that is there is as its source says.
    fs::write(sandbox.path("out/doc/block-mod.html"), "edited").expect("a file");
    fs::remove_file(sandbox.path("out/doc/pictures/block-mod-Block.png")).expect("a picture");
    documented(&sandbox);
    expect_as_anew(&sandbox, "a page was edited, and a picture removed");
}

#[test]
fn a_manifest_that_modl_did_not_write_is_not_believed() {
    let sandbox = Sandbox::new(&[("block.mod", BLOCK.as_bytes())]);
    documented(&sandbox);
    let manifest = sandbox.path("out/doc/.modl-doc.json");
    let text = fs::read_to_string(&manifest).expect("a manifest");
    fs::write(sandbox.path("out/evil.txt"), "evil").expect("a file");
    let digest = "4e1b5e0a9b1a0b5d7b0d3a3f5b6d9c3c";
    // It would say 9 kg on the page if it were believed: here it is of another program, or has what none has.
    let heavy = text.replace("\"300g\"", "\"9kg\"");
    let other = heavy.replacen("\"modl\": \"", "\"modl\": \"0.", 1);
    assert!(heavy != text && other != heavy);
    let outside = heavy.replacen("\"files\": {", &format!("\"files\": {{ \"../evil.txt\": \"{digest}\","), 1);
    let foreign = heavy.replacen("{", "{ \"theirs\": 1,", 1);
    let half = &heavy[..heavy.len() / 2];
    for (name, wrong) in [
        ("other", other.as_str()),
        ("outside", &outside),
        ("foreign", &foreign),
        ("half", half),
        ("empty", ""),
    ] {
        fs::write(&manifest, wrong).expect("a file");
        documented(&sandbox);
        let page = fs::read_to_string(sandbox.path("out/doc/block-mod.html")).expect("a page");
        assert!(page.contains("300g") && !page.contains("9kg"), "{name}: {page}");
        assert_eq!(fs::read_to_string(&manifest).expect("a manifest"), text, "{name}");
        assert!(sandbox.path("out/evil.txt").exists(), "{name}");
    }
    // A manifest is believed where the files bear it out.
    fs::write(&manifest, &heavy).expect("a file");
    documented(&sandbox);
    let page = fs::read_to_string(sandbox.path("out/doc/block-mod.html")).expect("a page");
    assert!(page.contains("9kg"), "the drawing is taken over: {page}");
}
