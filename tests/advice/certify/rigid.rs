//! Rigid-body modes: all of them, none of them, some of them.

use serde_json::{Value, json};
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

/// What an iteration leaves of zeros is no end of a band: the highest of them lies among the others.
#[test]
fn a_result_of_rigid_body_modes_alone_is_certified() {
    let all = lowest(&bar(), 7);
    for stated in [[0.0; 6], [1.7e-4, 8.0e-5, 7.4e-5, 8.9e-5, 1.1e-4, 1.3e-4], [1e-3; 6]] {
        let mut pairs = all.clone().without(6);
        pairs.hertz = stated.to_vec();
        let place = place_of(&bar(), &pairs);
        let found = document(&place, "--strict", ExitCode::Done);
        assert_eq!((&found["verdict"], of_kind(&found, "rigid-body").len()), (&"pass".into(), 6), "{found}");
        assert_eq!((verdict(&found, "C-04"), verdict(&found, "C-05")), (Some("pass"), Some("pass")), "{found}");
        // The rounding of a zero is no end of a band.
        assert_eq!((&found["band_hz"], &found["count"]), (&json!([0.0, 0.0]), &Value::Null), "{found}");
        // Asked for, the band ends among the zeros as well.
        let found = document(&place, "--band 0,0.001", ExitCode::Done);
        assert_eq!(missing(&found).len(), 0, "{found}");
    }
    // Five of them are not enough, and a frequency of a tenth of the first elastic one is none of rounding.
    let pairs = all.clone().without(6).without(2);
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!(verdict(&found, "C-04"), Some("fail"), "{found}");
    let mut pairs = all.clone().without(6);
    pairs.hertz = vec![0.1 * all.hertz[6]; 6];
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-05"), of_kind(&found, "inexact").len()), (Some("fail"), 6), "{found}");
}

/// All motions of a point mass are rigid-body motion, and no force is left of any.
#[test]
fn a_point_mass_without_stiffness_is_certified() {
    let place = supel_testing::place::Place::new();
    let diagonal = |values: [f64; 6]| {
        let lines: String = (1..).zip(values).map(|(row, value)| format!("{row} {row} {value}\n")).collect();
        format!("%%MatrixMarket matrix coordinate real symmetric\n6 6 6\n{lines}")
    };
    place.write("K.mtx", diagonal([0.0; 6]).as_bytes());
    place.write("M.mtx", diagonal([2.0, 2.0, 2.0, 0.1, 0.1, 0.1]).as_bytes());
    let shapes: Vec<Vec<f64>> = (0..6).map(|i| (0..6).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    super::Pairs { hertz: vec![0.0; 6], shapes }.write(&place);
    let found = document(&place, "", ExitCode::Done);
    assert_eq!((verdict(&found, "M-01"), of_kind(&found, "rigid-body").len()), (Some("pass"), 6), "{found}");
}

/// Any combinations of rigid-body motions are rigid-body modes: translations, and turns about an axis that is far from the centre of mass.
#[test]
fn motions_that_are_not_orthogonal_are_modes_all_the_same() {
    let mut pairs = lowest(&bar(), 14);
    let combined: Vec<f64> = pairs.shapes[0].iter().zip(&pairs.shapes[5]).map(|(a, b)| 2.0 * a + b).collect();
    pairs.shapes[5] = combined;
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::Done);
    assert_eq!((verdict(&found, "M-03"), verdict(&found, "C-04")), (Some("warn"), Some("pass")), "{found}");
    assert!(found["checks"].to_string().contains("rigid-body modes all the same"), "{found}");
    // What two modes of different frequencies have of each other is none of that.
    pairs = lowest(&bar(), 14);
    pairs.shapes[8] = pairs.shapes[8].iter().zip(&pairs.shapes[11]).map(|(a, b)| a + 0.2 * b).collect();
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!(verdict(&found, "M-03"), Some("fail"), "{found}");
}
