//! Which test provokes each error and each warning: found in the sources of the tests, so that none is forgotten.
//!
//! A test counts when it names the variant or the code of the error it expects; run with `--nocapture` for the list.

use std::collections::BTreeMap;
use std::path::Path;

use supel::error::{Error, ErrorEntry};

/// Warnings that no test provokes: no model is known whose pivots grow that far.
const UNPROVOKED: [&str; 1] = ["W-COUNT-LIKELY"];

/// A test function with its lines.
struct TestFunction {
    file: String,
    name: String,
    body: String,
}

/// Every `#[test]` function below a folder of the crate.
fn tests_below(folder: &str) -> Vec<TestFunction> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = Vec::new();
    crate::documented::collect(&root.join(folder), &mut sources);
    sources.sort();
    let mut found = Vec::new();
    for path in sources.iter().filter(|path| !path.ends_with("tests/errors/provoked.rs")) {
        let text = std::fs::read_to_string(path).expect("a source");
        let file = path.strip_prefix(root).expect("below the root").display().to_string();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let Some(indent) = line.strip_suffix("#[test]") else { continue };
            let mut heads = lines.by_ref().skip_while(|line| line.trim_start().starts_with("#["));
            let name = heads.next().and_then(|line| line.trim_start().strip_prefix("fn ")?.split_once('('));
            let Some((name, _)) = name else { continue };
            let end = format!("{indent}}}");
            let body: Vec<&str> = lines.by_ref().take_while(|line| *line != end).collect();
            found.push(TestFunction { file: file.clone(), name: name.to_owned(), body: body.join("\n") });
        }
    }
    found
}

/// Whether a text holds a word that ends there: `E-DIM` is not in `E-DIM-ORDER`.
fn mentions(text: &str, word: &str) -> bool {
    let goes_on = |rest: &str| rest.starts_with(|c: char| c.is_alphanumeric() || c == '-' || c == '_');
    text.match_indices(word).any(|(at, _)| !goes_on(&text[at + word.len()..]))
}

#[test]
fn every_error_is_provoked() {
    let tests: Vec<TestFunction> = ["tests", "src"].into_iter().flat_map(tests_below).collect();
    assert!(tests.len() > 300, "only {} tests were found", tests.len());
    let mut unprovoked = Vec::new();
    for ErrorEntry { variant, code, .. } in Error::CODES {
        let is_expected =
            |test: &&TestFunction| mentions(&test.body, code) || mentions(&test.body, &format!("Error::{variant}"));
        match tests.iter().find(is_expected) {
            Some(test) => eprintln!("{code:26} {}: {}", test.file, test.name),
            None => unprovoked.push(*code),
        }
    }
    assert!(unprovoked.is_empty(), "no test expects these errors: {unprovoked:?}");
}

#[test]
fn every_warning_is_provoked() {
    let tests = tests_below("tests");
    let mut provoked = BTreeMap::new();
    for code in crate::documented::warnings().into_iter().filter(|code| !UNPROVOKED.contains(&code.as_str())) {
        let test = tests.iter().find(|test| mentions(&test.body, &code));
        let test = test.unwrap_or_else(|| panic!("no test expects {code}"));
        eprintln!("{code:26} {}: {}", test.file, test.name);
        provoked.insert(code, &test.name);
    }
    assert!(provoked.len() >= 8, "{provoked:?}");
}
