//! Which test provokes each error and each warning: found in the sources of the tests, so that none is forgotten.
//!
//! A test counts when it names the variant or the code of the error it expects; run with `--nocapture` for the list.

use std::collections::BTreeMap;
use std::path::Path;

use supel::error::{Error, ErrorEntry};
use supel_testing::sources::{TestFunction, files_below, tests_of};

/// Warnings that no test provokes: no model is known whose pivots grow that far.
const UNPROVOKED: [&str; 1] = ["W-COUNT-LIKELY"];

/// Every `#[test]` function below a folder of the crate.
fn tests_below(folder: &str) -> Vec<TestFunction> {
    let files = files_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    files.iter().filter(|path| !path.ends_with("tests/errors/provoked.rs")).flat_map(|path| tests_of(path)).collect()
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
            Some(test) => eprintln!("{code:26} {}: {}", test.file.display(), test.name),
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
        eprintln!("{code:26} {}: {}", test.file.display(), test.name);
        provoked.insert(code, &test.name);
    }
    assert!(provoked.len() >= 8, "{provoked:?}");
}
