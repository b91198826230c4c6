//! The order of the layers, which stands once, on the crate page: no file imports one that comes later, and no files import
//! each other in a circle. Code for tests alone may.

mod imports;

use std::collections::BTreeMap;
use std::path::PathBuf;

use imports::{Import, Sources, circles, texts_of_folder};

/// The folders of sources.
const MEMBERS: [&str; 5] = ["src", "runtime/src", "models/src", "testing/src", "validation/src"];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The words of the block under "# Layers" of the crate page, lowest first.
fn layers(page: &str) -> Vec<String> {
    let lines = page.lines().skip_while(|line| !line.starts_with("//! # Layers"));
    let block =
        lines.skip_while(|line| !line.starts_with("//! ```")).skip(1).take_while(|line| !line.starts_with("//! ```"));
    let words = block.flat_map(|line| line.trim_start_matches("//!").split(" · ").map(str::trim).map(str::to_owned));
    words.filter(|word| !word.is_empty()).collect()
}

/// The folder or file below the root that a file belongs to.
fn layer_of(file: &str) -> &str {
    file.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// Imports of a file that comes later, and of files whose place nobody says.
fn upward(imports: &[Import], layers: &[String]) -> Vec<String> {
    // The root of the crate and the program compose everything.
    let is_root = |layer: &str| ["lib", "main", "stdout"].contains(&layer);
    let place = |layer: &str| layers.iter().position(|word| word == layer);
    let mut wrong = Vec::new();
    for Import { from, to, name } in imports {
        let (lower, upper) = (layer_of(to), layer_of(from));
        if is_root(upper) || lower == upper {
            continue;
        }
        match (place(lower), place(upper)) {
            (Some(lower), Some(upper)) if lower < upper => {}
            _ => wrong.push(format!("{from} imports {to} ({name})")),
        }
    }
    wrong
}

#[test]
fn no_module_imports_one_above_it() {
    let layers = layers(&std::fs::read_to_string(root().join("src/lib.rs")).expect("the crate page"));
    let sources = Sources::of_folder(&root().join("src"));
    assert!(layers.len() > 20 && sources.count() > 250, "{} layers, {} files", layers.len(), sources.count());
    let wrong = upward(&sources.imports(), &layers);
    assert!(wrong.is_empty(), "imports of what comes later:\n{}", wrong.join("\n"));
}

#[test]
fn every_layer_of_the_crate_page_exists() {
    let layers = layers(&std::fs::read_to_string(root().join("src/lib.rs")).expect("the crate page"));
    for layer in layers {
        let is_there =
            root().join("src").join(&layer).is_dir() || root().join("src").join(format!("{layer}.rs")).is_file();
        assert!(is_there, "{layer} is on the crate page and not in src");
    }
}

#[test]
fn no_files_form_a_circle() {
    let mut shown = Vec::new();
    for member in MEMBERS {
        let sources = Sources::of_folder(&root().join(member));
        assert!(sources.count() > 5, "{} files of {member}", sources.count());
        let found = circles(&sources.imports());
        shown.extend(found.iter().map(|files| format!("{member}: {}", files.join(", "))));
    }
    assert!(shown.is_empty(), "files import each other:\n{}", shown.join("\n"));
}

/// Four hundred lines without tests are what a reader follows at a time. Tables are longer, and one thing that splitting would tear.
#[test]
fn no_file_is_longer_than_a_reader_follows() {
    const MOST: usize = 400;
    /// The errors and checks there are, and the steps of one iteration.
    const LONGER: [&str; 4] =
        ["src/error.rs", "runtime/src/error.rs", "src/verification/catalogue.rs", "src/eigen/lanczos.rs"];
    let length = |text: &str| text.lines().take_while(|line| *line != "#[cfg(test)]").count();
    let files = MEMBERS.into_iter().flat_map(|member| {
        texts_of_folder(&root().join(member))
            .into_iter()
            .map(move |(file, text)| (format!("{member}/{file}"), length(&text)))
    });
    let (mut longer, mut exceptions) = (Vec::new(), Vec::new());
    for (file, length) in files.filter(|(_, length)| *length > MOST) {
        if LONGER.contains(&file.as_str()) { exceptions.push(file) } else { longer.push(format!("{file}: {length}")) }
    }
    assert!(longer.is_empty(), "files of more than {MOST} lines without tests: {longer:?}");
    assert_eq!(exceptions.len(), LONGER.len(), "of the exceptions these alone are longer: {exceptions:?}");
}

fn sources(files: &[(&str, &str)]) -> Sources {
    Sources::of_files(
        &files.iter().map(|(file, text)| ((*file).to_owned(), (*text).to_owned())).collect::<BTreeMap<_, _>>(),
    )
}

/// The checker is checked: it follows names through re-exports, sees paths in code and in macros, and leaves tests out.
#[test]
fn an_upward_import_is_seen() {
    let layers = ["low".to_owned(), "high".to_owned()];
    let high = ("high/mod.rs", "mod deep;\npub use deep::{Deep, other};\n");
    let deep = ("high/deep.rs", "pub struct Deep;\npub fn other() {}\n");
    let root = ("lib.rs", "mod low;\nmod high;\n");
    let seen = |low: &str| upward(&sources(&[root, high, deep, ("low.rs", low)]).imports(), &layers);
    for code in [
        "use crate::high::Deep;",
        "use crate::high::{Deep as Other, other};",
        "fn f() { crate::high::other() }",
        "fn f() -> String { format!(\"{:?}\", crate::high::other()) }",
        "fn f() { super::high::other() }",
    ] {
        assert_eq!(seen(code).len(), 1, "{code}");
        assert!(seen(code)[0].starts_with("low.rs imports high/deep.rs"), "{:?}", seen(code));
    }
    for code in [
        "#[cfg(test)]\nmod tests { use crate::high::Deep; }",
        "// crate::high::Deep\nconst A: &str = \"crate::high::Deep\";",
    ] {
        assert!(seen(code).is_empty(), "{code}");
    }
    let downward = sources(&[root, ("high.rs", "use crate::low::a;"), ("low.rs", "pub fn a() {}")]);
    assert!(upward(&downward.imports(), &layers).is_empty());
    assert_eq!(upward(&downward.imports(), &layers[..1]).len(), 1, "a folder without a place");
}

#[test]
fn a_circle_is_seen() {
    let found = |files: &[(&str, &str)]| circles(&sources(files).imports());
    let root = ("lib.rs", "mod a;");
    let parent = ("a/mod.rs", "mod b;\nmod c;\npub use b::B;\npub use c::C;");
    assert_eq!(
        found(&[root, parent, ("a/b.rs", "use super::C;\npub struct B;"), ("a/c.rs", "pub struct C;")]).len(),
        0
    );
    let both =
        found(&[root, parent, ("a/b.rs", "use super::C;\npub struct B;"), ("a/c.rs", "use super::B;\npub struct C;")]);
    assert_eq!(both, [["a/b.rs", "a/c.rs"]]);
    let of_three = found(&[
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        ("a.rs", "use crate::b::f;"),
        ("b.rs", "use crate::c::g;\npub fn f() {}"),
        ("c.rs", "pub fn g() { crate::a::h() }"),
    ]);
    assert_eq!(of_three, [["a.rs", "b.rs", "c.rs"]]);
    // A child that imports what its parent defines.
    let of_parent =
        found(&[root, ("a/mod.rs", "mod b;\npub fn f() { b::g() }"), ("a/b.rs", "use super::f;\npub fn g() {}")]);
    assert_eq!(of_parent, [["a/b.rs", "a/mod.rs"]]);
}
