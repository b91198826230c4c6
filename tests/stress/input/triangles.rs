//! Which triangles of a matrix a file holds: I-05 and I-06.

use supel_models::model::Entry;
use supel_models::{Ends, spring};

use super::{CHAIN, assert_done, assert_refused, chain, mtx, notes_say, reduce_chain};
use crate::place::Place;

/// The chain with these entries of its stiffness, declared so.
fn with_entries(symmetry: &str, kept: impl Fn(u32, u32) -> bool) -> Place {
    let place = chain();
    let entries = spring(5, Ends::Free).stiffness;
    let entries: Vec<Entry> = entries.into_iter().filter(|entry| kept(entry.0, entry.1)).collect();
    place.write("K.mtx", &mtx(symmetry, 5, &entries));
    place
}

/// What the program makes of the chain itself.
#[track_caller]
fn assert_is_the_chain(place: &Place) {
    let whole = chain();
    assert_done(&whole, &reduce_chain(&whole), &[]);
    assert_eq!(place.superelement("x.supel").tensors(), whole.superelement("x.supel").tensors());
}

#[test]
fn i_05_one_triangle_or_both() {
    let (lower, upper) = (|row, col| row >= col, |row, col| row <= col);
    for (symmetry, place, is_mirrored) in [
        ("symmetric lower", with_entries("symmetric", lower), false),
        ("symmetric upper", with_entries("symmetric", upper), false),
        ("general lower", with_entries("general", lower), true),
        ("general upper", with_entries("general", upper), true),
        ("general both", with_entries("general", |_, _| true), false),
    ] {
        assert_done(&place, &reduce_chain(&place), &[]);
        assert_eq!(notes_say(&place, "only one triangle is given; it was mirrored"), is_mirrored, "{symmetry}");
        assert_is_the_chain(&place);
    }
    let doubled = with_entries("symmetric", |_, _| true);
    let parts = ["declared symmetric", "(2, 1) and (1, 2)", "model.symmetric = \"lower\" or \"upper\""];
    assert_refused(&doubled, &reduce_chain(&doubled), "E-DOUBLE-TRIANGLE", &parts);
    let ended = doubled.reduce(&doubled.matrix_flags(), &format!("{CHAIN} --symmetric lower"));
    assert_done(&doubled, &ended, &[]);
    assert_is_the_chain(&doubled);
}

/// A file that lost part of one triangle: what is missing counts as a difference of its whole size.
#[test]
fn i_06_half_a_triangle_missing() {
    for (triangle, missing) in [("lower", (3, 4)), ("upper", (4, 3))] {
        let place = with_entries("general", |row, col| (row, col) != missing);
        let parts = [
            "7.1e-1 of its rows",
            "where the file lacks part of a triangle",
            "model.symmetric = \"lower\" or \"upper\"",
        ];
        assert_refused(&place, &reduce_chain(&place), "E-UNSYMMETRIC", &parts);
        let ended = place.reduce(&place.matrix_flags(), &format!("{CHAIN} --symmetric {triangle}"));
        assert_done(&place, &ended, &[]);
        assert!(notes_say(
            &place,
            &format!("the {triangle} triangle was taken for both; of 1 pair of rows that is given once")
        ));
        assert_is_the_chain(&place);
    }
}

/// The key of the job does what the flag does, for K and M alike.
#[test]
fn i_06_by_the_job() {
    let place = with_entries("general", |row, col| (row, col) != (3, 4));
    place.write("M.mtx", &mtx("general", 5, &spring(5, Ends::Free).mass));
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", symmetric = "lower" }
interface = [{ name = "ends", nodes = { rows = [0, 4] } }]
reduction = { method = "craig-bampton", modes = { count = 1 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    let ended = crate::place::supel(&["reduce", &place.text("job.toml")]);
    assert_done(&place, &ended, &[]);
    assert_is_the_chain(&place);
}
