//! Compiles the parser, once it has been generated.

use std::path::Path;

fn main() {
    let source = Path::new("../src");
    println!("cargo::rerun-if-changed=../src");
    println!("cargo::rustc-check-cfg=cfg(parser)");
    if source.join("parser.c").exists() {
        cc::Build::new()
            .include(source)
            .file(source.join("parser.c"))
            .file(source.join("scanner.c"))
            .warnings(false)
            .compile("tree-sitter-modl");
        println!("cargo::rustc-cfg=parser");
    }
}
