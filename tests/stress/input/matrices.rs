//! Numbers and sizes of a matrix: I-01 to I-04, I-07 to I-13, I-22.

use supel_models::model::Entry;
use supel_models::transform::{grounded, supported};
use supel_models::{Ends, Model, spring};

use super::{CHAIN, assert_done, assert_refused, chain, held_chain, mtx, notes_say, reduce_chain};
use crate::place::{Place, steel_brick};

const HEAD: &str = "%%MatrixMarket matrix coordinate real symmetric\n";
const FOOT: &str = "--interface foot=1,11,31,41 --method herting --modes 5 --threads 1";

/// Writes K and asserts the refusal.
#[track_caller]
fn stiffness_refused(text: impl AsRef<[u8]>, code: &str, parts: &[&str]) {
    let place = chain();
    place.write("K.mtx", text.as_ref());
    assert_refused(&place, &reduce_chain(&place), code, parts);
}

#[test]
fn i_01_sizes_that_do_not_fit() {
    let four = mtx("symmetric", 4, &spring(4, Ends::Free).stiffness[..1]);
    stiffness_refused(four, "E-DIM", &["K.mtx has 4 rows", "M.mtx has 5", "same degrees of freedom"]);
    stiffness_refused(format!("{HEAD}5 4 1\n1 1 1\n"), "E-DIM-SQUARE", &["K.mtx:2", "5 rows and 4 columns"]);
    stiffness_refused(format!("{HEAD}0 0 0\n"), "E-DIM-ORDER", &["K.mtx:2", "0 rows"]);
}

/// Free and held, with coordinates and without.
#[test]
fn i_02_stiffness_and_mass_exchanged() {
    let held = supported(&steel_brick(), |(label, _)| label % 5 == 1);
    for (model, rest) in [
        (steel_brick(), FOOT),
        (held, "--interface head=5,15,35 --method herting --modes 12 --threads 1"),
        (spring(5, Ends::Free), CHAIN),
        (spring(5, Ends::Fixed), CHAIN),
    ] {
        let is_solid = model.dofs.len() > 5;
        let place = Place::with(&model);
        let mut flags = if is_solid { place.model_flags() } else { place.matrix_flags() };
        flags.swap(1, 3);
        assert_refused(&place, &place.reduce(&flags, rest), "E-SWAPPED", &["exchange the two files"]);
        flags.swap(1, 3);
        assert_done(&place, &place.reduce(&flags, rest), &[]);
    }
}

#[test]
fn i_03_values_that_are_no_numbers() {
    for value in ["nan", "NaN", "inf", "-Infinity", "1e999", "-1d999"] {
        let text = format!("{HEAD}5 5 2\n1 1 1.0\n3 2 {value}\n");
        stiffness_refused(text, "E-NONFINITE", &["K.mtx:4", "(3, 2)", value, "finite number"]);
    }
}

/// The whole stiffness of the held chain with one entry below the diagonal changed by `difference` of the largest.
fn askew(difference: f64) -> Place {
    let place = held_chain();
    let mut entries = spring(5, Ends::Fixed).stiffness;
    let at = entries.iter().position(|entry| (entry.0, entry.1) == (2, 1)).expect("an entry");
    // The largest entry is 2.
    entries[at].2 += 2.0 * difference;
    place.write("K.mtx", &mtx("general", 5, &entries));
    place
}

#[test]
fn i_04_asymmetry_by_its_size() {
    let rounding = askew(1e-13);
    assert_done(&rounding, &reduce_chain(&rounding), &[]);
    assert!(notes_say(&rounding, "stiffness matrix was symmetric to 1.0e-13 of its rows only"));
    let doubtful = askew(1e-9);
    assert_done(&doubtful, &reduce_chain(&doubtful), &["W-UNSYMMETRIC"]);
    let wrong = askew(1e-4);
    let parts =
        ["row 3, column 2", "1.0e-4", "follower forces, gyroscopic and friction terms", "[[matrix]] in the job"];
    assert_refused(&wrong, &reduce_chain(&wrong), "E-UNSYMMETRIC", &parts);
}

/// The chain with one entry given as two halves.
fn in_halves() -> Place {
    let place = chain();
    let mut entries: Vec<Entry> = spring(5, Ends::Free).stiffness.into_iter().filter(|e| e.0 >= e.1).collect();
    entries[3].2 /= 2.0;
    entries.push(entries[3]);
    place.write("K.mtx", &mtx("symmetric", 5, &entries));
    place
}

#[test]
fn i_07_repeated_entries() {
    let (place, whole) = (in_halves(), chain());
    assert_done(&place, &reduce_chain(&place), &[]);
    assert_done(&whole, &reduce_chain(&whole), &[]);
    assert!(notes_say(&place, "K.mtx: 1 entry repeats a position"));
    let tensors = |place: &Place| place.superelement("x.supel").tensors().clone();
    assert_eq!(tensors(&place), tensors(&whole));
    let strict = in_halves();
    let ended = strict.reduce(&strict.matrix_flags(), &format!("{CHAIN} --strict"));
    assert_refused(&strict, &ended, "E-DUPLICATES", &["K.mtx: 1 entry repeats a position", "assemble the matrix"]);
    let ended = whole.reduce(&whole.matrix_flags(), &format!("{CHAIN} --strict"));
    assert_done(&whole, &ended, &[]);
}

#[test]
fn i_08_indices_from_zero() {
    stiffness_refused(format!("{HEAD}5 5 2\n1 1 1\n1 0 -1\n"), "E-INDEX", &["K.mtx:4", "column 0", "count from 1"]);
    // A row that only the mass knows: indices that count from zero would leave this behind, and so does a free particle.
    let (five, six) = (spring(5, Ends::Free), spring(6, Ends::Free));
    let place = chain();
    place.write("K.mtx", &mtx("general", 6, &five.stiffness));
    place.write("M.mtx", &mtx("general", 6, &six.mass));
    let ended = place.reduce(&place.matrix_flags(), &CHAIN.replace("0,4", "0,4,5"));
    assert_done(&place, &ended, &["W-INDEX-BASE", "W-FREE-PARTICLE", "W-HANGING"]);
    assert!(ended.out.contains("row 6, the last one, is empty and no other is"), "{}", ended.out);
    // In both it is a row of nothing.
    let place = chain();
    place.write("K.mtx", &mtx("general", 6, &five.stiffness));
    place.write("M.mtx", &mtx("general", 6, &five.mass));
    assert_refused(&place, &reduce_chain(&place), "E-EMPTY-ROWS", &["the first is row 6"]);
}

#[test]
fn i_09_indices_outside() {
    for index in ["6", "2147483648", "4294967297", "9223372036854775808", "99999999999999999999"] {
        stiffness_refused(format!("{HEAD}5 5 1\n{index} 1 1\n"), "E-INDEX", &["K.mtx:3", "row ", "expected 1 to 5"]);
    }
    // A sign is no digit.
    stiffness_refused(format!("{HEAD}5 5 1\n-1 1 1\n"), "E-ENTRY", &["K.mtx:3", "`-1`", "a whole number from 1"]);
}

#[test]
fn i_10_counts_that_are_wrong() {
    stiffness_refused(
        format!("{HEAD}5 5 1\n1 1 1\n2 2 1\n"),
        "E-NNZ-SURPLUS",
        &["K.mtx:4", "more entries than declared", "expected the 1 of the size line"],
    );
    for declared in ["3", "1000000000000000000"] {
        let text = format!("{HEAD}5 5 {declared}\n1 1 1\n2 2 1\n");
        stiffness_refused(
            text,
            "E-NNZ",
            &[
                &format!(
                    "K.mtx:4: entries are missing – found the end of the file after 2 – expected the {declared} that the size line"
                ),
                "cut short",
            ],
        );
    }
}

/// Memory follows the bytes of the file: a count of 10⁹ entries, 16 GB if it were believed, is refused within one.
#[cfg(target_os = "linux")]
#[test]
fn i_10_a_count_allocates_nothing() {
    let place = chain();
    place.write("K.mtx", format!("{HEAD}5 5 1000000000\n1 1 1\n").as_bytes());
    let output = place.text("x.supel");
    let mut command = std::process::Command::new("sh");
    // Kibibytes of address space, of which a thread's stack and heap reserve some hundred thousand.
    command.args(["-c", "ulimit -v 1000000 && exec \"$0\" \"$@\""]).arg(assert_cmd::cargo::cargo_bin!("supel"));
    command.args(["reduce", "--output", &output]).args(place.matrix_flags()).args(CHAIN.split(' '));
    let ended = command.output().expect("ended");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3), "{said}");
    assert!(said.starts_with("supel: error[E-NNZ]: "), "{said}");
}

/// The chain and one more row, with mass or without.
fn with_empty_row(mass: f64) -> Place {
    let model = spring(5, Ends::Free);
    let masses: Vec<Entry> = model.mass.iter().copied().chain([(5, 5, mass)]).filter(|entry| entry.2 != 0.0).collect();
    // A map and nodes, so that interfaces can be named.
    let nodes = (1..=6).map(|label| [f64::from(label), 0.0, 0.0]).collect();
    let dofs = (1..=6).map(|label| (label, 0)).collect();
    Place::with(&Model { n: 6, mass: masses, nodes, labels: (1..=6).collect(), dofs, ..model })
}

#[test]
fn i_11_rows_without_stiffness() {
    // With mass it is a free particle, one more zero mode, which an interface has to hold.
    let particle = with_empty_row(1.0);
    let ended =
        particle.reduce(&particle.model_flags(), "--interface ends=1,5,6 --method herting --modes 1 --threads 1");
    assert_done(&particle, &ended, &["W-INDEX-BASE", "W-FREE-PARTICLE", "W-HANGING"]);
    assert_eq!(particle.superelement("x.supel").tensors().rigid_body_modes.cols(), 2);
    let loose = with_empty_row(1.0);
    let ended = loose.reduce(&loose.model_flags(), "--interface ends=1,5 --method herting --modes 1 --threads 1");
    assert_refused(&loose, &ended, "E-FLOATING-BODY", &["1 of the 2 bodies", "add an interface node there"]);
    // Without mass it is nothing, and goes on request.
    let empty = with_empty_row(0.0);
    let rest = "--interface ends=1,5 --method herting --modes 1 --threads 1";
    let ended = empty.reduce(&empty.model_flags(), rest);
    assert_refused(&empty, &ended, "E-EMPTY-ROWS", &["1 row has", "row 6 (node 6 ux)", "--drop-empty"]);
    let ended = empty.reduce(&empty.model_flags(), &format!("{rest} --drop-empty"));
    assert_done(&empty, &ended, &["W-INDEX-BASE", "W-INDEX-BASE"]);
    assert!(notes_say(&empty, "1 row without stiffness and mass was left out: the first is row 6, node 6 ux"));
    let whole = Place::with(&spring(5, Ends::Free));
    whole.reduce(&whole.model_flags(), rest);
    assert_eq!(empty.superelement("x.supel").tensors(), whole.superelement("x.supel").tensors());
}

#[test]
fn i_12_zero_on_the_diagonal() {
    let place = chain();
    let entries = spring(5, Ends::Free).stiffness.into_iter().filter(|entry| (entry.0, entry.1) != (2, 2));
    place.write("K.mtx", &mtx("general", 5, &entries.collect::<Vec<_>>()));
    assert_refused(&place, &reduce_chain(&place), "E-LAGRANGE", &["row 3", "zero diagonal", "eliminate constraints"]);
}

#[test]
fn i_13_negative_diagonal() {
    let place = Place::with(&grounded(&spring(5, Ends::Free), 2, -2.25));
    assert_refused(&place, &reduce_chain(&place), "E-NEG-DIAG", &["row 3", "-2.500e-1", "preloaded beyond buckling"]);
}

#[test]
fn i_22_fields_of_the_banner() {
    let place = chain();
    let text = String::from_utf8(place.bytes("M.mtx")).expect("text").replace(" real ", " integer ");
    place.write("M.mtx", text.replace("e0", "").as_bytes());
    assert_done(&place, &reduce_chain(&place), &[]);
    for (field, entry) in [("complex", "1 1 1 0"), ("pattern", "1 1")] {
        let text = format!("%%MatrixMarket matrix coordinate {field} symmetric\n5 5 1\n{entry}\n");
        stiffness_refused(text, "E-FLAVOUR", &["K.mtx:1", &format!("`{field}`"), "expected `coordinate` or `array`"]);
    }
}
