//! Every line of the stress catalogue, and where it stands.
//!
//! A line `S-01` is built when a test whose name starts with `s_01_` stands among the tests, or one that a table here names. A line that
//! speaks of methods is built when such a test goes through all of them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use supel_testing::sources::{files_below, tests_of};

/// The tables: prefix of the lines and their numbers.
const TABLES: [(&str, &[u32]); 5] = [
    ("S", &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 20, 21, 22, 23, 24, 25, 26, 27]),
    ("C", &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]),
    ("MS", &[1, 2, 3, 4, 5, 6, 7, 8]),
    ("E", &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]),
    ("I", &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26]),
];

/// Lines that other tests stand for: faults of the system, relations that need no oracle (section 2.7), and the measured example (4.3).
const NAMED: [(&str, &str); 22] = [
    ("F-01", "disk_full"),
    ("F-02", "name_of_a_folder_or_a_device_or_no_name"),
    ("F-03", "killed_while_writing"),
    ("F-04", "reader_sees_the_old_file_or_the_new_one"),
    ("F-05", "a_run_that_does_not_fit_is_refused"),
    ("F-06", "f_06_an_interrupted_run_leaves_nothing"),
    ("F-07", "two_writers_of_one_name_do_not_meet"),
    ("F-08", "a_reader_that_goes_away_is_no_panic"),
    ("F-09", "names_that_are_not_utf8_are_refused_before_anything_is_read"),
    ("F-10", "f_10_methods_do_not_depend_on_threads"),
    ("F-11", "the_job_in_the_file_makes_the_file_again"),
    ("permutation", "order_of_rows_does_not_matter"),
    ("scales", "units_that_are_powers_of_two_change_no_bit"),
    ("turned coordinates", "a_component_may_be_turned"),
    ("order of the interface", "the_order_of_interfaces_permutes_the_reduced_stiffness"),
    ("disjoint union", "the_union_of_two_bodies_is_their_direct_sum"),
    ("mass at the interface", "ms_08_a_mass_added_at_the_interface"),
    ("more modes", "more_modes_never_raise_an_eigenvalue"),
    ("Herting and Rubin", "rubin_is_herting_with_a_proof_of_its_attachment_modes"),
    ("Guyan, Craig-Bampton, full", "statics_alone_lie_above_craig_bampton"),
    ("reduced again", "reducing_again_with_all_modes_is_the_identity"),
    ("4.3", "published_errors_of_the_brick_are_repeated"),
];

/// Lines that speak of methods.
const OF_METHODS: [&str; 10] = ["C-01", "C-06", "C-08", "C-10", "S-04", "S-05", "S-12", "S-20", "S-24", "I-24"];

/// What the catalogue asks for in addition to the outcome of a line and the program does not have: line, word for it, reason.
const LEFT_OUT: [(&str, &str, &str); 4] = [
    (
        "E-03",
        "W-CUT-CLUSTER",
        "clusters are always completed: searches and the dense decomposition extend to the gap, and the count that ends the \
         last slice is moved up until no mode lies within that gap below it",
    ),
    (
        "E-09",
        "allow-negative",
        "a superelement of negative stiffness moves away from rest by itself, whoever simulates it; and with the interface held \
         K = LLᵀ, which constraint modes, enclosures and every energy norm of the report stand on, does not exist",
    ),
    (
        "C-12",
        "rigid_excluded",
        "rows in single precision always serve the deformation alone, so that their precision says what a flag would",
    ),
    ("F-12", "corrupt cached factor", "no factor outlives its run, so that none can be damaged"),
];

#[test]
fn what_is_left_out_is_nowhere_in_the_program() {
    fn sources(folder: &Path, text: &mut String) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => sources(&path, text),
                false => text.push_str(&fs::read_to_string(&path).unwrap_or_default()),
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut text = String::new();
    for folder in ["src", "docs", "schemas"] {
        sources(&root.join(folder), &mut text);
    }
    assert!(text.contains("W-FEWER-MODES") && text.contains("allow-unverified"), "the sources were not read");
    for (line, word, why) in LEFT_OUT {
        assert!(!text.contains(word), "{line}: {word} is there although {why}");
    }
}

/// The tests of the program and of the component: names and bodies.
fn tests() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = ["tests", "runtime/tests"].into_iter().flat_map(|folder| files_below(&root.join(folder)));
    let tests: BTreeMap<String, String> =
        files.flat_map(|file| tests_of(&file)).map(|test| (test.name, test.body)).collect();
    assert!(tests.len() > 500, "only {} tests were found", tests.len());
    tests
}

/// What the names of the tests of a line start with.
fn start(line: &str) -> String {
    format!("{}_", line.to_lowercase().replace('-', "_"))
}

#[test]
fn every_line_has_a_test() {
    let tests = tests();
    let lines = TABLES.iter().flat_map(|(prefix, numbers)| numbers.iter().map(move |n| format!("{prefix}-{n:02}")));
    let is_built = |line: &String| tests.keys().any(|name| name.starts_with(&start(line)));
    let mut missing: Vec<String> = lines.filter(|line| !is_built(line)).collect();
    let named = NAMED.iter().filter(|(_, test)| !tests.contains_key(*test));
    missing.extend(named.map(|(line, test)| format!("{line} ({test})")));
    assert!(missing.is_empty(), "no test for {}", missing.join(", "));
}

#[test]
fn lines_of_methods_go_through_all_of_them() {
    let tests = tests();
    for line in OF_METHODS {
        let of_line: Vec<_> = tests.iter().filter(|(name, _)| name.starts_with(&start(line))).collect();
        let goes = of_line.iter().any(|(_, body)| body.contains("for method in ALL"));
        assert!(
            goes,
            "{line}: none of {:?} has every method",
            of_line.iter().map(|(name, _)| name).collect::<Vec<_>>()
        );
    }
}
