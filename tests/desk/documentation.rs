//! `modl doc` and the examples that `modl test` runs.

use crate::desk::browser;
use crate::desk::cli::Sandbox;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

const ARM: &str = "\
//! An arm of [`Hinge`]s.
use \"hinge.mod\".{Hinge}

/// Two hinges in a row; see [the hinge](Hinge), [`Hinge.bend`] and <b>no markup</b>.
///
/// ```modl
/// use \"arm.mod\".{Arm}
/// expect count(Arm()) == 2
/// emit(Arm().curl(), \"nobody_wants_this.plan.json\")
/// ```
config Arm {
  part h[2]: Hinge(length: 60mm)
  connect h[0].front -- h[1].back

  /// From the shoulder to the tip.
  let reach = 120mm
  /// Where a tool docks.
  port hand = h[1].front

  /// Bends by `a`.
  behavior curl(a: Angle = 20deg) = move(h[1].bend, to: a)
}

/// Private, so it is not told.
fn _hidden() = 1

/// What every arm may carry.
let load = 200g

/// Needs a number.
config Chain(n: Int) { part h[n]: Hinge  for i in 0..n - 1 { connect h[i].front -- h[i + 1].back } }
";

fn project() -> Sandbox {
    Sandbox::new(&[("hinge.mod", crate::desk::transcripts::HINGE.as_bytes()), ("arm.mod", ARM.as_bytes())])
}

#[test]
fn a_site_tells_of_the_project_and_the_library() {
    let sandbox = project();
    let ran = sandbox.run(&["doc"]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let page = |name: &str| {
        let path = sandbox.path(&format!("out/doc/{name}"));
        fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let arm = page("arm-mod.html");
    assert!(arm.contains("<span class=\"k\">config</span> <span class=\"t\">Arm</span>"), "{arm}");
    let arm = without_colours(&arm);
    for words in [
        "config Arm",
        "config Chain(n: Int)",
        "order 1 · 2 modules · 300g",
        "<code>curl(a: Angle = 20deg)</code>",
        "<p>Bends by <code>a</code>.</p>",
        "<code>h[]: Hinge</code>",
        "<h3>values</h3>\n<dl>\n<dt id=\"Arm.reach\"><code>reach: Length</code></dt>\n<dd><p>From the shoulder to the tip.</p>",
        "<h2><a href=\"#load\">load</a> <small>let</small></h2>",
        "let load: Mass</pre>\n<p>What every arm may carry.</p>",
        "<h3>ports</h3>\n<dl>\n<dt id=\"Arm.hand\"><code>hand</code></dt>\n<dd><p>Where a tool docks.</p>",
        "<h3>parameters</h3>\n<dl>\n<dt id=\"Chain.n\"><code>n: Int</code></dt>",
        "<a href=\"hinge-mod.html#Hinge\"><code>Hinge</code></a>",
        "<a href=\"hinge-mod.html#Hinge.bend\">",
        "&lt;b&gt;no markup&lt;/b&gt;",
        "<img src=\"pictures/arm-mod-Arm.png\"",
    ] {
        assert!(arm.contains(words), "no `{words}` in\n{arm}");
    }
    assert!(!arm.contains("_hidden") && !arm.contains("arm-mod-Chain.png"), "{arm}");
    let picture = fs::read(sandbox.path("out/doc/pictures/arm-mod-Arm.png")).expect("a picture");
    assert!(picture.starts_with(b"\x89PNG"));
    let hinge = without_colours(&page("hinge-mod.html"));
    assert!(
        hinge.contains("<code>bend: Joint&lt;Angle&gt;</code>") && hinge.contains("<code>back</code>"),
        "{hinge}"
    );
    // Planners and robots of the library.
    assert!(without_colours(&page("prelude.html")).contains("method: exact | heuristic | enumerate = exact"));
    assert!(page("std-smores.html").contains("pictures/std-smores-Chain3.png"));
    let guide = page("guide.html");
    let (first, second) = (guide.find("Order 1").expect("order 1"), guide.find("Order 2").expect("order 2"));
    let at = |name: &str| {
        guide.find(&format!("#{name}\">")).unwrap_or_else(|| panic!("{name} is not in the guide"))
    };
    let open = guide.find("Of a size to be given").expect("there is one");
    assert!(guide.find("arm-mod.html#Chain\">").is_some_and(|at| at > open), "{guide}");
    assert!(first < at("Arm") && at("Arm") < second && second < at("FourLeg17"));
    assert!(page("index.js").contains("\"Arm.curl\"") && page("index.html").contains("arm-mod.html#Arm"));
    every_address_leads_to_a_place(&sandbox.path("out/doc"));
    tells_of_modl(&page);
    if let Some((playwright, chromium)) = browser::tools() {
        is_used_in_a_browser(&playwright, &chromium, &sandbox.path("out/doc"));
    }
}

/// The text of a page without the colours of programs.
fn without_colours(text: &str) -> String {
    let pieces = text.replace("</span>", "");
    ["k", "t", "n", "s", "c"]
        .iter()
        .fold(pieces, |text, class| text.replace(&format!("<span class=\"{class}\">"), ""))
}

/// The parts of pages that are addresses: of links, pictures, styles and scripts.
fn addresses(text: &str) -> impl Iterator<Item = &str> {
    let after = |start| text.split(start).skip(1).filter_map(|rest: &str| rest.split('"').next());
    after(" href=\"").chain(after(" src=\""))
}

/// Every address on every page leads to a file that is there, and to a place in it.
fn every_address_leads_to_a_place(folder: &Path) {
    let names = fs::read_dir(folder).expect("the site is a folder");
    let names = names.map(|entry| entry.expect("it is listed").file_name().to_string_lossy().into_owned());
    let pages: BTreeMap<String, String> = names
        .filter(|name| name.ends_with(".html"))
        .map(|name| (name.clone(), fs::read_to_string(folder.join(&name)).expect("a page")))
        .collect();
    assert!(pages.len() > 35, "{:?}", pages.keys());
    for (name, text) in &pages {
        for address in addresses(text).filter(|address| !address.starts_with("https://")) {
            let (file, place) = address.split_once('#').unwrap_or((address, ""));
            let there = if file.is_empty() { Some(text) } else { pages.get(file) };
            assert!(there.is_some() || folder.join(file).is_file(), "{name}: {address}");
            let found = there.is_none_or(|text| text.contains(&format!("id=\"{place}\"")));
            assert!(place.is_empty() || found, "{name}: {address}");
        }
    }
}

/// The pages of the manual are those that users read of `docs/`, with colours, contents and words to search.
fn tells_of_modl(page: &dyn Fn(&str) -> String) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    for folder in ["", "planners/"] {
        for entry in fs::read_dir(root.join(folder)).expect("the folder is there") {
            let name = entry.expect("it is listed").file_name().to_string_lossy().into_owned();
            let Some(stem) = name.strip_suffix(".md") else { continue };
            // The site has an index and a guide of its own, and is not for those who change the program.
            if ["README", "architecture", "library"].contains(&stem) {
                continue;
            }
            let file = format!("manual-{}{}.html", folder.replace('/', "-"), stem.replace('_', "-"));
            let text = fs::read_to_string(root.join(folder).join(&name)).expect("a page");
            let title =
                text.lines().next().expect("it has a title").trim_start_matches("# ").replace('`', "");
            assert!(page("index.html").contains(&format!("href=\"{file}\"")), "{file} is not listed");
            let shown = title.replace('"', "&quot;");
            assert!(page(&file).contains(&format!("<title>{shown}</title>")), "{file} is not {title}");
        }
    }
    let tour = page("manual-tour.html");
    assert!(tour.contains("<span class=\"k\">use</span>") && tour.contains("On this page"), "{tour}");
    assert!(!page("manual-fuzzing.html").contains("&lt;!--"), "a comment is shown");
    let errors = page("manual-errors.html");
    assert!(errors.contains("<h2 id=\"e0301-a-port-that-is-taken-already\">"), "{errors}");
    assert!(page("index.js").contains("manual-errors.html#e0301-a-port-that-is-taken-already"));
}

/// The site in Chromium: search, light and dark, contents, a phone.
fn is_used_in_a_browser(playwright: &Path, chromium: &Path, folder: &Path) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/site.mjs");
    let output = Command::new("node").args([&script, playwright, chromium, folder]).output();
    let output = output.expect("Node.js runs, it has before");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "[]");
}

#[test]
fn a_link_that_leads_nowhere_is_an_error() {
    let sandbox =
        Sandbox::new(&[
            ("a.mod", b"/// As [`Nothing`], [there](nowhere.md), [here](#nobody), ![see](no.png), [a note](note.md#x) and [a list].\nlet a = 1\n"),
            ("note.md", b"x"),
        ]);
    let ran = sandbox.run(&["doc", "--only"]);
    assert_eq!(ran.code, 1);
    assert!(ran.err.contains("a.mod, a: the link ``Nothing`` leads nowhere"), "{}", ran.err);
    assert!(
        ran.err.contains("the link `nowhere.md` leads nowhere") && !ran.err.contains("a list"),
        "{}",
        ran.err
    );
    for lost in ["#nobody", "no.png"] {
        assert!(ran.err.contains(&format!("the link `{lost}` leads nowhere")), "{}", ran.err);
    }
    let page = fs::read_to_string(sandbox.path("out/doc/a-mod.html")).expect("it was written");
    assert!(page.contains("href=\"files/note.md#x\"") && sandbox.path("out/doc/files/note.md").exists());
}

#[test]
fn examples_in_documentation_are_tests() {
    let sandbox = project();
    let ran = sandbox.run(&["test", "arm.mod"]);
    assert_eq!(
        (ran.code, ran.out.as_str()),
        (0, "test \"example in line 7\" ... ok\n1 passed, 0 failed\n"),
        "{}",
        ran.err
    );
    assert!(!sandbox.path("out").exists(), "an example writes nothing");
    fs::write(sandbox.path("arm.mod"), ARM.replace("== 2", "== 3")).expect("a file can be written");
    let ran = sandbox.run(&["test", "arm.mod"]);
    assert_eq!(ran.code, 1);
    assert!(
        ran.out.contains("test \"example in line 7\" ... FAILED") && ran.err.contains("[arm.mod:8:12]"),
        "{}",
        ran.err
    );
    // What only the file itself would do is not done.
    let ran = sandbox.run(&["test", "hinge.mod"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "0 passed, 0 failed\n"));
}

/// Links that run scripts or leave the project, in every way that Markdown knows.
const HOSTILE: &str = "/// [a](javascript:alert(1)) [b](JaVaScRiPt:alert(2)) [c][c] [d] [e][] <javascript:alert(6)>
/// [f](data:text/html;base64,PHNjcmlwdD4=) [g](file:///etc/passwd) [h](vbscript:x) [i](//elsewhere.org/x)
/// ![j](https://elsewhere.org/j.png) ![k](data:image/png;base64,AAAA) ![l](file:///l.png) ![m][m] ![n](//elsewhere.org/n.png)
/// [fine](https://example.org/a) <https://example.org/b> <someone@example.org> [mail](mailto:a@example.org)
///
/// [c]: javascript:alert(3)
/// [d]: data:text/html,4
/// [e]: file:///5
/// [m]: https://elsewhere.org/m.png
let a = 1
";

#[test]
fn documentation_leads_to_no_script_and_loads_nothing_from_elsewhere() {
    let sandbox = Sandbox::new(&[("a.mod", HOSTILE.as_bytes())]);
    let ran = sandbox.run(&["doc", "--only"]);
    assert_eq!(ran.code, 1);
    for (file, text) in ["a-mod.html", "guide.html", "index.html"]
        .map(|name| (name, fs::read_to_string(sandbox.path(&format!("out/doc/{name}"))).expect("a page")))
    {
        let addresses = ["href=\"", "src=\""].iter().flat_map(|start| text.split(start).skip(1));
        for address in addresses.filter_map(|rest| rest.split('"').next()) {
            let scheme = address.split_once(':').map(|(scheme, _)| scheme);
            assert!(matches!(scheme, None | Some("https" | "mailto")), "{file}: {address}");
            assert!(!address.starts_with("//") && !address.contains("elsewhere"), "{file}: {address}");
        }
    }
    let page = fs::read_to_string(sandbox.path("out/doc/a-mod.html")).expect("a page");
    for kept in [
        "https://example.org/a",
        "https://example.org/b",
        "mailto:someone@example.org",
        "mailto:a@example.org",
    ] {
        assert!(page.contains(&format!("href=\"{kept}\"")), "{kept} in\n{page}");
    }
    let lost = ran.err.lines().filter(|line| line.contains("leads nowhere")).count();
    assert_eq!(lost, 15, "{}", ran.err);
}
