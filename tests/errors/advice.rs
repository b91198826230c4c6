//! What messages advise: flags that the command has which was run.

use std::collections::BTreeSet;
use std::path::Path;

use supel::cli::ExitCode;
use supel::error::Error;

use crate::place::supel;

const COMMANDS: [&str; 4] = ["reduce", "verify", "inspect", "init"];

/// Errors that only one command meets, whose messages name its flags as they are.
const OF_ONE: [(&str, &str); 5] = [
    ("MissingFlags", "reduce"),
    ("FlagText", "reduce"),
    ("OtherVersion", "verify"),
    ("MadeOfParts", "verify"),
    ("OutputExists", "init"),
];

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

/// What stands at a variant of the enum: what the page says of it, and its message.
struct Advice {
    variant: String,
    page: String,
    message: String,
}

/// The texts of all errors.
fn advice() -> Vec<Advice> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/error.rs");
    let text = std::fs::read_to_string(path).expect("a source").replace("\\\n", " ");
    let is_of_variant = |line: &&str| line.starts_with("    ") && !line.starts_with("        ///");
    let (mut found, mut texts) = (Vec::new(), [String::new(), String::new()]);
    let mut at = 0;
    for line in text.lines().filter(is_of_variant) {
        let name = line.trim().trim_end_matches([' ', '{', ',']);
        if line.starts_with("    #[error(") {
            at = 1;
        }
        // `Name {` or `Name,` ends what stands at a variant.
        if at == 1 && name.chars().all(char::is_alphanumeric) && !name.is_empty() {
            let [page, message] = std::mem::take(&mut texts);
            found.push(Advice { variant: name.to_owned(), page, message });
            at = 0;
            continue;
        }
        texts[at] += line;
        texts[at].push('\n');
    }
    assert_eq!(found.len(), Error::CODES.len());
    found
}

/// A flag without the name of its command is one that every command has which can meet the error; `reduce --symmetric` is one of
/// `reduce`. All models are met by `reduce` and `verify`, and files by `inspect` too.
#[test]
fn every_flag_that_is_advised_exists() {
    let [reduce, verify, inspect, init] = COMMANDS.map(known);
    assert!(reduce.contains("--symmetric") && verify.contains("--reproduce") && inspect.contains("--job"));
    let (mut n_flags, mut wrong) = (0, Vec::new());
    for Advice { variant, page, message } in advice() {
        for (flag, before) in flags(&format!("{page}{message}")) {
            let only = OF_ONE.iter().find(|(name, _)| *name == variant).map(|(_, command)| *command);
            let exists = match only.unwrap_or(before.as_str()) {
                "reduce" => reduce.contains(&flag),
                "verify" => verify.contains(&flag),
                "inspect" => inspect.contains(&flag),
                "init" => init.contains(&flag),
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
    let all = advice();
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
        let of = all.iter().find(|advice| advice.variant == variant);
        for (flag, before) in flags(&of.unwrap_or_else(|| panic!("{variant} is no error")).message) {
            assert!(inspect.contains(&flag) || COMMANDS.contains(&before.as_str()), "{variant}: {flag}");
        }
    }
}
