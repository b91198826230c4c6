//! Rigid-body modes: all of them, none of them, some of them.

use supel::cli::ExitCode;

use super::{bar, document, lowest, missing, of_kind, place_of, verdict};

#[test]
fn a_result_without_rigid_body_modes_warns() {
    let pairs = lowest(&bar(), 14).from(6);
    let place = place_of(&bar(), &pairs);
    let found = document(&place, "", ExitCode::Done);
    assert_eq!((verdict(&found, "C-04"), &found["verdict"]), (Some("warn"), &"warn".into()), "{found}");
    let worst = found["checks"].to_string();
    assert!(worst.contains("6 motions in which the model is free: the result has none of them"), "{worst}");
    document(&place, "--strict", ExitCode::CheckFailed);
}

#[test]
fn a_result_with_some_of_them_fails() {
    let pairs = lowest(&bar(), 14).without(3);
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-04"), of_kind(&found, "rigid-body").len()), (Some("fail"), 5), "{found}");
    assert_eq!(missing(&found).len(), 0, "elastic modes are all there");
    // One of them twice is as bad.
    let mut pairs = lowest(&bar(), 14);
    pairs.shapes[3] = pairs.shapes[2].clone();
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-04"), of_kind(&found, "repeated")), (Some("fail"), vec![4]), "{found}");
}

#[test]
fn rigid_body_motion_with_a_frequency_is_told() {
    let mut pairs = lowest(&bar(), 14);
    pairs.hertz[5] = 0.1 * pairs.hertz[6];
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-05"), of_kind(&found, "inexact")), (Some("fail"), vec![6]), "{found}");
}
