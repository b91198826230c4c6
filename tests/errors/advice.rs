//! What messages advise: flags that the command has which was run.

use std::collections::BTreeSet;
use std::path::Path;

use supel::cli::ExitCode;

use crate::place::supel;

const COMMANDS: [&str; 3] = ["reduce", "verify", "inspect"];

/// Errors that only one command meets, whose messages name its flags as they are.
const OF_ONE: [(&str, &str); 3] = [("MissingFlags", "reduce"), ("FlagText", "reduce"), ("OtherVersion", "verify")];

/// The flags in a text, each with the word before it.
fn flags(text: &str) -> Vec<(String, String)> {
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || "`(),;\"".contains(c)).filter(|w| !w.is_empty()).collect();
    let of = |at: usize| {
        let flag = words[at].trim_end_matches(|c: char| !c.is_ascii_alphabetic());
        let before = at.checked_sub(1).map_or("", |at| words[at]);
        flag.starts_with("--").then(|| (flag.to_owned(), before.to_owned()))
    };
    (0..words.len()).filter_map(of).collect()
}

/// The flags that the help of a command lists.
fn known(command: &str) -> BTreeSet<String> {
    flags(&supel(&[command, "--help"]).expect(ExitCode::Done).out).into_iter().map(|(flag, _)| flag).collect()
}

/// Lines of a source that are no comments, with the variant that comes next or that they belong to.
fn advice(source: &str) -> Vec<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(source);
    let text = std::fs::read_to_string(path).expect("a source");
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    // `Name {` opens a variant, whose message stands before it; `Name => "E-…"` is followed by its texts.
    let opens =
        |line: &str| line.strip_suffix(" {").filter(|name| name.starts_with("    ")).map(|name| name.trim().to_owned());
    let entry = |line: &str| line.split_once(" => \"E-").map(|(name, _)| name.trim().to_owned());
    let of = |(at, line): (usize, &&str)| {
        let next = lines[at..].iter().find_map(|line| opens(line));
        let last = lines[..=at].iter().rev().find_map(|line| entry(line));
        ((*line).to_owned(), last.or(next).unwrap_or_default())
    };
    lines.iter().enumerate().map(of).collect()
}

/// A flag without the name of its command is one that every command has which can meet the error; `reduce --symmetric` is one of
/// `reduce`. All models are met by `reduce` and `verify`, and files by `inspect` too.
#[test]
fn every_flag_that_is_advised_exists() {
    let [reduce, verify, inspect] = COMMANDS.map(known);
    assert!(reduce.contains("--symmetric") && verify.contains("--reproduce") && inspect.contains("--job"));
    let (mut n_flags, mut wrong) = (0, Vec::new());
    for (text, variant) in ["src/error.rs", "src/error/code.rs"].into_iter().flat_map(advice) {
        for (flag, before) in flags(&text) {
            let only = OF_ONE.iter().find(|(name, _)| *name == variant).map(|(_, command)| *command);
            let exists = match only.unwrap_or(before.as_str()) {
                "reduce" => reduce.contains(&flag),
                "verify" => verify.contains(&flag),
                "inspect" => inspect.contains(&flag),
                // A flag of cargo.
                "with" if flag == "--features" => true,
                _ => reduce.contains(&flag) && verify.contains(&flag),
            };
            n_flags += 1;
            if !exists {
                wrong.push(format!("{variant}: {before} {flag}"));
            }
        }
    }
    assert!(wrong.is_empty() && n_flags > 15, "of {n_flags} flags these are none of the command: {wrong:#?}");
}

/// The errors of `supel inspect`, in the words of the program, advise nothing that it lacks.
#[test]
fn inspect_advises_its_own_flags() {
    let inspect = known("inspect");
    let all: Vec<(String, String)> = advice("src/error.rs");
    for variant in [
        "Answer",
        "Read",
        "NotAFile",
        "Changed",
        "SuperelementFile",
        "KeptJob",
        "NameNotText",
        "NotJson",
        "OutOfMemory",
    ] {
        assert!(all.iter().any(|(_, of)| of == variant), "{variant} is no error");
        for (text, _) in all.iter().filter(|(_, of)| of == variant) {
            for (flag, before) in flags(text) {
                assert!(inspect.contains(&flag) || COMMANDS.contains(&before.as_str()), "{variant}: {flag}");
            }
        }
    }
}
