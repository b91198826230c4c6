//! The tests of the project, as their sources have them: for tests that ask whether there is one for everything.

use std::path::{Path, PathBuf};

/// A `#[test]` function.
pub struct TestFunction {
    pub file: PathBuf,
    pub name: String,
    pub body: String,
}

/// The Rust files below a folder, in the order of their paths.
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    collect(folder, &mut files);
    files.sort();
    files
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// Every `#[test]` function of a file.
pub fn tests_of(file: &Path) -> Vec<TestFunction> {
    let text = std::fs::read_to_string(file).expect("a source");
    let mut lines = text.lines();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        let Some(indent) = line.strip_suffix("#[test]") else { continue };
        let mut heads = lines.by_ref().skip_while(|line| line.trim_start().starts_with("#["));
        let name = heads.next().and_then(|line| line.trim_start().strip_prefix("fn ")?.split_once('('));
        let Some((name, _)) = name else { continue };
        let end = format!("{indent}}}");
        let body: Vec<&str> = lines.by_ref().take_while(|line| *line != end).collect();
        found.push(TestFunction { file: file.to_owned(), name: name.to_owned(), body: body.join("\n") });
    }
    found
}
