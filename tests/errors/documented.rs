//! `docs/errors.md` against the enum and the sources.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use supel::error::{Error, INTERNAL_CODE, USAGE_CODE};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The cells of every row of the document whose first is a code with this start.
fn rows(start: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(root().join("docs/errors.md")).expect("the document");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `")?.strip_suffix(" |"));
    let cells = rows.map(|row| row.split(" | ").map(|cell| cell.trim_matches('`').to_owned()).collect::<Vec<_>>());
    cells.filter(|cells| cells[0].starts_with(start)).collect()
}

/// One line for each error, in the order of the enum, with its exit code, what is wrong and what to do.
#[test]
fn every_error_has_its_line() {
    let found: Vec<(String, String)> = rows("E-").into_iter().map(|row| (row[0].clone(), row[1].clone())).collect();
    let of_enum = Error::CODES.iter().map(|(_, code, class)| (code.to_string(), (*class as u8).to_string()));
    let others = [(USAGE_CODE, "2"), (INTERNAL_CODE, "70")].map(|(code, exit)| (code.to_owned(), exit.to_owned()));
    assert_eq!(found, of_enum.chain(others).collect::<Vec<_>>());
    for row in rows("E-").into_iter().chain(rows("W-")) {
        let n_cells = if row[0].starts_with("E-") { 4 } else { 3 };
        assert_eq!(row.len(), n_cells, "{row:?}");
        assert!(row.iter().skip(n_cells - 2).all(|cell| cell.contains(' ')), "{row:?}");
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
    rows("W-").into_iter().map(|row| row[0].clone()).collect()
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
