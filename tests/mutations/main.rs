//! The table of faults fits the sources: every place is there exactly once, every test exists.
//!
//! `tests/mutations/run.sh` puts the faults in and demands that the tests fail. That takes a build of its own; this keeps the
//! table from going stale in between.

use std::path::Path;

#[derive(serde::Deserialize)]
struct Table {
    mutation: Vec<Mutation>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Mutation {
    name: String,
    fact: String,
    file: String,
    before: String,
    after: String,
    /// Folder of the package of the test, where it is not that of the program.
    #[serde(default)]
    member: String,
    test: [String; 2],
    /// The test reads the file while it runs.
    #[serde(default, rename = "is_text")]
    _is_text: bool,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The sources of a test target, one file or a folder. A module may be named instead of a test.
fn sources_of(target: &Path) -> String {
    std::fs::read_to_string(target.with_extension("rs")).unwrap_or_else(|_| sources(target))
}

/// The sources in a folder.
fn sources(folder: &Path) -> String {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let module = path.file_stem().expect("a name").to_string_lossy();
            match path.extension() {
                Some(extension) if extension == "rs" => {
                    format!("fn {module}(\n{}", std::fs::read_to_string(&path).expect("a source"))
                }
                None if path.is_dir() => sources(&path),
                _ => String::new(),
            }
        })
        .collect()
}

#[test]
fn the_table_fits_the_sources() {
    let table: Table = toml::from_str(include_str!("table.toml")).expect("a table");
    let mut names = std::collections::BTreeSet::new();
    for mutation in &table.mutation {
        let Mutation { name, fact, file, before, after, member, test: [target, test], .. } = mutation;
        assert!(names.insert(name), "{name} stands twice");
        assert!(!fact.is_empty() && before != after, "{name} changes nothing");
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(text.matches(before.as_str()).count(), 1, "{name}: {before:?} in {file}");
        let tests = sources_of(&root().join(member).join("tests").join(target));
        assert!(tests.contains(&format!("fn {test}(")), "{name}: no test {test} in {target}");
    }
    assert!(names.len() >= 25, "faults were taken out of the table");
}
