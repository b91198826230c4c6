//! Modes that Exudyn computed and wrote. It factored the K of a free bar at shift zero, where it is singular: see `fixtures/README.md`.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::place::supel;

use super::{missing, of_kind, verdict};

fn file() -> String {
    format!("{}/fixtures/results/exudyn_free_bar.hdf5", env!("CARGO_MANIFEST_DIR"))
}

fn certified(flags: &[&str], code: ExitCode) -> Value {
    let [k, m, result] = [":/stiffnessMatrix", ":/massMatrix", ""].map(|place| file() + place);
    let mut args = vec!["certify", &k, &m, &result, "--json"];
    args.extend(flags);
    serde_json::from_str(&supel(&args).expect(code).out).expect("JSON")
}

/// The frequencies of K and M by LAPACK, in Hz: two bending pairs and a torsion.
const RIGHT: [f64; 5] = [386.72700014, 386.72700014, 1071.42908605, 1071.42908605, 1613.56029497];

#[test]
fn wrong_modes_of_exudyn_are_named() {
    let found = certified(&[], ExitCode::CheckFailed);
    assert_eq!((&found["result"]["program"], &found["result"]["n_pairs"]), (&"Exudyn".into(), &8.into()));
    assert_eq!(found["result"]["frequencies"], "eigenvalues in (rad/s)²");
    // 257.09 Hz is stated where the bar has a second mode at 386.727 Hz.
    assert_ne!(found["pairs"][0]["kind"], "mode", "{found}");
    let stated = found["pairs"][0]["stated_hz"].as_f64().expect("a frequency");
    assert!((stated - 257.0895).abs() < 1e-3, "{stated}");
    let told: Vec<f64> = missing(&found).into_iter().chain(found["pairs"][0]["mode_hz"].as_f64()).collect();
    assert!(told.iter().any(|hertz| (hertz / RIGHT[0] - 1.0).abs() < 1e-6), "{found}");
    // The second one is right, and is not blamed.
    assert_eq!(found["pairs"][1]["kind"], "mode", "{found}");
    assert!(verdict(&found, "C-01") == Some("fail") || verdict(&found, "C-02") == Some("fail"), "{found}");
    assert!(!of_kind(&found, "mode").contains(&1));
}
