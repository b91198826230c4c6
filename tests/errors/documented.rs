//! `docs/errors.md` against the enum and the sources.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use supel::error::{Error, INTERNAL_CODE, USAGE_CODE};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The document, line by line, each with the exit code that the heading above it names.
fn lines_by_exit_code() -> Vec<(Option<u8>, String)> {
    let text = std::fs::read_to_string(root().join("docs/errors.md")).expect("the document");
    let mut exit_code = None;
    let with_code = |line: &str| {
        if line.starts_with('#') {
            exit_code = line.split_once(": exit code ").map(|(_, code)| code.parse().expect("an exit code"));
        }
        (exit_code, line.to_owned())
    };
    text.lines().map(with_code).collect()
}

/// The cells of every row of the document whose first is a code with this start, and the exit code of its section.
fn rows(start: &str) -> Vec<(Option<u8>, Vec<String>)> {
    let cells = |line: &str| -> Option<Vec<String>> {
        let row = line.strip_prefix("| `")?.strip_suffix(" |")?;
        Some(row.split(" | ").map(|cell| cell.trim_matches('`').to_owned()).collect())
    };
    let rows = lines_by_exit_code().into_iter().filter_map(|(exit_code, line)| Some((exit_code, cells(&line)?)));
    rows.filter(|(_, cells)| cells[0].starts_with(start)).collect()
}

/// One line for each error, in the section of its exit code and there in the order of the enum, with what is wrong and
/// what to do. Sections follow each other by exit code.
#[test]
fn every_error_has_its_line() {
    let found: Vec<(u8, String)> = rows("E-")
        .into_iter()
        .map(|(exit, row)| (exit.expect("a section with an exit code"), row[0].clone()))
        .collect();
    let of_enum = Error::CODES.iter().map(|(_, code, class)| (*class as u8, code.to_string()));
    let others = [(2, USAGE_CODE), (70, INTERNAL_CODE)].map(|(exit, code)| (exit, code.to_owned()));
    let mut expected: Vec<(u8, String)> = of_enum.chain(others).collect();
    // A stable sort keeps the order of the enum inside a class.
    expected.sort_by_key(|(exit, _)| *exit);
    assert_eq!(found, expected);
    for (_, row) in rows("E-").into_iter().chain(rows("W-")) {
        assert_eq!(row.len(), 3, "{row:?}");
        assert!(row.iter().skip(1).all(|cell| cell.contains(' ')), "{row:?}");
    }
}

#[test]
fn codes_are_unique_and_say_what_they_are() {
    let codes: BTreeSet<&str> = Error::CODES.iter().map(|(_, code, _)| *code).collect();
    assert_eq!(codes.len(), Error::CODES.len());
    for code in codes {
        let words = code.strip_prefix("E-").unwrap_or_default().split('-');
        for word in words {
            let is_word = !word.is_empty() && word.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit());
            assert!(is_word, "{code}");
        }
    }
}

/// The codes of warnings in the document.
pub(crate) fn warnings() -> Vec<String> {
    rows("W-").into_iter().map(|(_, row)| row[0].clone()).collect()
}

/// The codes of warnings in the sources are those of the document, in alphabetical order.
#[test]
fn every_warning_has_its_line() {
    let mut sources = Vec::new();
    collect(&root().join("src"), &mut sources);
    let mut used = BTreeSet::new();
    for path in sources {
        let text = std::fs::read_to_string(&path).expect("a source");
        let quoted = text.split("\"W-").skip(1).filter_map(|rest| rest.split_once('"'));
        used.extend(quoted.map(|(code, _)| format!("W-{code}")));
    }
    assert_eq!(warnings(), used.into_iter().collect::<Vec<_>>());
}

pub(crate) fn collect(folder: &Path, sources: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            sources.push(path);
        }
    }
}
