//! MSC Nastran's superelement analysis of a cantilever in two parts, Craig-Bampton with one, two and three modes a part and massless
//! rotations: its printed eigenvalues to all seven digits. Skipped, with a message, where the corpus is absent.

use std::path::Path;

use serde_json::Value;
use supel::assembly::{Assembly, Component};
use supel::cli::ExitCode;
use supel_testing::corpus::corpus;
use supel_testing::place::{Place, supel};

use crate::all_modes;

/// Half a unit of the seventh digit, relative to the first: the least that seven printed digits can be off.
const PRINTED: f64 = 5e-7;

fn component(folder: &Path, part: &str, rows: &str, n_modes: usize) -> Component {
    let place = Place::new();
    let file = |matrix: &str| folder.join(format!("{part}_{matrix}.mtx")).display().to_string();
    let flags = format!("--interface grid6=rows:{rows} --method craig-bampton --modes {n_modes} --output");
    let (stiffness, mass, output) = (file("K"), file("M"), place.text("x.supel"));
    let mut args = vec!["reduce", "--stiffness", &stiffness, "--mass", &mass];
    args.extend(flags.split_whitespace());
    args.push(&output);
    supel(&args).expect(ExitCode::Done);
    Component::new(part.to_owned(), place.superelement("x.supel")).expect("a component")
}

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().expect("a list").iter().map(|value| value.as_f64().expect("a number")).collect()
}

#[test]
fn assembled_eigenvalues_are_those_that_nastran_prints() {
    let Some(pairs) = corpus() else { return };
    let folder = pairs.join("../nastran_cb/cofe_cantilever_bar_matrices");
    let reference = std::fs::read_to_string(folder.join("reference.json")).expect("the reference");
    let reference: Value = serde_json::from_str(&reference).expect("JSON");
    let whole = numbers(&reference["recomputed_full"]);
    for n_modes in 1..=3 {
        let mut assembly = Assembly::new(vec![
            component(&folder, "comp1_grids6-11", "0,1", n_modes),
            component(&folder, "comp2_grids2-6", "8,9", n_modes),
        ])
        .expect("two names");
        assembly.join("comp1_grids6-11.rows:0,1", "comp2_grids2-6.rows:8,9").expect("two rows each");
        let modes = all_modes(&assembly);
        let printed = numbers(&reference[format!("cb_{n_modes}modes_f06")]["assembled"]);
        assert_eq!(modes.modes.len(), printed.len(), "{n_modes} modes a part");
        for ((mode, printed), whole) in modes.modes.iter().zip(&printed).zip(&whole) {
            let lambda = (std::f64::consts::TAU * mode.frequency_hz).powi(2);
            let difference = lambda / printed - 1.0;
            assert!(difference.abs() <= PRINTED, "{n_modes} modes a part: {lambda:.8e} for {printed:.6e}");
            let at_least = (std::f64::consts::TAU * mode.at_least_hz.expect("a bound")).powi(2);
            assert!(
                at_least <= whole * (1.0 + 1e-12) && *whole <= lambda * (1.0 + 1e-12),
                "{at_least} {whole} {lambda}"
            );
        }
    }
}
