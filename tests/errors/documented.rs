//! `docs/errors.md` against the enum and the sources.

use std::collections::BTreeSet;
use std::path::Path;

use supel::error::{Error, INTERNAL_CODE, USAGE_CODE};
use supel_testing::sources::files_below;

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

/// The document with the tables of errors made anew: in the section of each exit code the errors of that class, in the order of the
/// enum. What is no error of the enum, a command line that cannot be read and a defect of the program, stays as it is.
fn page_of_errors(page: &str) -> String {
    let (mut made, mut exit_code) = (String::new(), None);
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        if line.starts_with('#') {
            exit_code = line.split_once(": exit code ").map(|(_, code)| code.parse::<u8>().expect("an exit code"));
        }
        if !line.starts_with("| `E-")
            || [USAGE_CODE, INTERNAL_CODE].iter().any(|code| line.contains(&format!("`{code}`")))
        {
            made += line;
            made.push('\n');
        }
        let is_table = line.starts_with("|---") && lines.peek().is_some_and(|next| next.starts_with("| `E-"));
        if let Some(exit_code) = exit_code.filter(|_| is_table) {
            for entry in Error::CODES.iter().filter(|entry| entry.class as u8 == exit_code) {
                made += &format!("| `{}` | {} | {} |\n", entry.code, cell(entry.what), entry.remedy);
            }
        }
    }
    made
}

/// A sentence of the documentation of a variant as a cell: on one line, without a full stop, and in lower case unless it begins with a
/// symbol or an abbreviation.
fn cell(sentence: &str) -> String {
    let words = sentence.split_whitespace().collect::<Vec<_>>().join(" ");
    let words = words.trim_end_matches('.');
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    let is_word = (first == "A" && rest.starts_with(" ")) || rest.starts_with(|second: char| second.is_lowercase());
    if is_word { format!("{}{rest}", first.to_lowercase()) } else { words.to_owned() }
}

/// The document is made from the entries of the enum: `SUPEL_UPDATE_DOCS=1 cargo test --test errors documented` writes it.
#[test]
fn every_error_has_its_line() {
    let path = root().join("docs/errors.md");
    let page = std::fs::read_to_string(&path).expect("the document");
    let made = page_of_errors(&page);
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, &made).expect("the document can be written");
    } else {
        assert_eq!(page, made, "docs/errors.md is not what the enum says: see above how it is written");
    }
    let exit_codes: Vec<u8> =
        rows("E-").into_iter().map(|(exit, _)| exit.expect("a section with an exit code")).collect();
    assert!(exit_codes.is_sorted() && exit_codes.len() == Error::CODES.len() + 2, "{} rows", exit_codes.len());
    for (_, row) in rows("E-").into_iter().chain(rows("W-")) {
        assert_eq!(row.len(), 3, "{row:?}");
        assert!(row.iter().skip(1).all(|cell| cell.contains(' ')), "{row:?}");
    }
}

/// A message reads what – where – found – expected – what to do, with dashes between its parts.
#[test]
fn messages_have_one_grammar() {
    let source = include_str!("../../src/error.rs");
    let messages: Vec<&str> =
        source.split("#[error(").skip(1).map(|rest| rest.split(")]").next().unwrap_or("")).collect();
    assert!(messages.len() >= Error::CODES.len() - 2, "{} messages", messages.len());
    for message in messages {
        let words = message.split_whitespace().filter(|word| *word != "\\").collect::<Vec<_>>().join(" ");
        // What was found may be the first thing to say of a line or an object.
        let is_place = |(place, _): &(&str, &str)| place.starts_with("\"{}") && !place.contains(' ');
        let words = words.split_once(": ").filter(is_place).map_or(words.as_str(), |(_, rest)| rest);
        for other in ["; expected", ", expected", ": expected", "; found", ": found", ", found"] {
            assert!(!words.contains(other), "{other:?} for a dash in {words}");
        }
    }
}

#[test]
fn codes_are_unique_and_say_what_they_are() {
    let codes: BTreeSet<&str> = Error::CODES.iter().map(|entry| entry.code).collect();
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
    let mut used = BTreeSet::new();
    for path in files_below(&root().join("src")) {
        let text = std::fs::read_to_string(&path).expect("a source");
        let quoted = text.split("\"W-").skip(1).filter_map(|rest| rest.split_once('"'));
        used.extend(quoted.map(|(code, _)| format!("W-{code}")));
    }
    assert_eq!(warnings(), used.into_iter().collect::<Vec<_>>());
}
