//! `modes = { accept = true }`: the fewest modes that meet what the scene accepts.

use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::verification::check::Verdict;
use supel_models::{Inertia, Material, Section, frame};

use crate::chain::{direct, rigid_group};
use crate::run::{Files, block};

/// A solid between a rigid patch and a node, and a frame of beams between two nodes.
fn components() -> [(Files, f64); 2] {
    let along = |i: usize| i as f64 / 16.0;
    let nodes: Vec<[f64; 3]> = (0..=16).map(|i| [1.3 * along(i), 0.4 * along(i).powi(2), 0.1 * along(i)]).collect();
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|i| [i - 1, i]).collect();
    let section = Section::round(0.015);
    let beams = frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent);
    let solid = Files::new(block(), vec![rigid_group("XMIN"), direct("tip", &[45])]);
    [(solid, 3000.0), (Files::new(beams, vec![direct("foot", &[1]), direct("head", &[17])]), 400.0)]
}

fn scene(band_end: f64, accept: &str) -> String {
    format!("band_hz = [0, {band_end}]\nboundaries = [\"free\"]\naccept = {{ {accept} }}")
}

fn n_modes(outcome: &Outcome) -> usize {
    outcome.superelement.tensors().frequencies.len()
}

fn is_met(outcome: &Outcome) -> bool {
    let checks = outcome.report.body.checks.iter().filter(|check| ["M-29", "M-30", "M-34"].contains(&check.id));
    checks.filter(|check| check.verdict() == Verdict::Fail).count() == 0
}

/// The number is the least by which jobs that name a number meet the limits as well: one fewer does not.
#[test]
fn as_many_as_the_limits_need_and_no_more() {
    let mut n_rising = 0;
    let limits =
        [["frequency = 5e-2", "response_db = 1.0, frequency = 1e-3"], ["internal_load = 0.5", "internal_load = 0.05"]];
    for ((files, band_end), limits) in components().into_iter().zip(limits) {
        for method in ["craig-bampton", "herting"] {
            let mut counts = Vec::new();
            for accept in limits {
                let scene = scene(band_end, accept);
                let chosen = files.reduce(method, "accept = true", &scene);
                let count = n_modes(&chosen);
                assert!(is_met(&chosen), "{method}, {accept}: {count} modes");
                let remark = format!("{count} of the ");
                let notes = &chosen.report.body.model.notes;
                assert!(notes.iter().any(|note| note.starts_with(&remark)), "{notes:?}");
                let told = files.reduce(method, &format!("count = {count}"), &scene);
                assert_eq!(told.superelement.tensors(), chosen.superelement.tensors(), "{method}, {accept}");
                if let Some(fewer) = count.checked_sub(1) {
                    let fewer = files.reduce(method, &format!("count = {fewer}"), &scene);
                    assert!(
                        !is_met(&fewer) || n_modes(&fewer) == count,
                        "{method}, {accept}: {count} are not the fewest"
                    );
                }
                counts.push(count);
            }
            assert!(counts.is_sorted(), "{method}: {counts:?}");
            n_rising += usize::from(counts[0] < counts[1]);
        }
    }
    // Six free modes of the frame meet both limits of its internal loads.
    assert_eq!(n_rising, 3);
}

/// What no number of modes meets fails, with the best that was reached.
#[test]
fn a_limit_out_of_reach_fails() {
    let [_, (files, band_end)] = components();
    let outcome = files.reduce("herting", "accept = true", &scene(band_end, "response_db = 1e-7"));
    assert!(!is_met(&outcome));
    let few = files.reduce("herting", "accept = true", &scene(band_end, "response_db = 1.0"));
    assert!(n_modes(&outcome) > n_modes(&few));
    // Twice the band is looked through first, and that doubled twice where it is not enough.
    let first =
        files.reduce("herting", &format!("up_to_hz = {}", 2.0 * band_end), &scene(band_end, "response_db = 1.0"));
    assert!(n_modes(&outcome) > n_modes(&first), "{} of {}", n_modes(&outcome), n_modes(&first));
}

/// Verification finds the modes of the file again, as many as it has, and measures what the scene accepts on its matrices.
#[test]
fn a_file_with_chosen_modes_is_verified_against_its_job() {
    let [(files, band_end), _] = components();
    let job = files.job("craig-bampton", "accept = true", &scene(band_end, "frequency = 1e-3"));
    let chosen = supel::reduce(&job, Resources::default(), &mut ()).expect("reduced").superelement;
    let audit = supel::verify(&chosen, Some(&job), Resources::default(), &mut ()).expect("compared");
    assert_ne!(audit.verdict(), Verdict::Fail, "{:?}", audit.checks);
    // A file with fewer modes under the same job does not meet it.
    let few = files.job("craig-bampton", "count = 1", &scene(band_end, "frequency = 1e-3"));
    let few = supel::reduce(&few, Resources::default(), &mut ()).expect("reduced").superelement;
    let audit = supel::verify(&few, Some(&job), Resources::default(), &mut ()).expect("compared");
    let failed = audit.checks.iter().filter(|check| check.verdict() == Verdict::Fail);
    assert!(failed.map(|check| check.id).any(|id| id == "M-29"), "{:?}", audit.checks);
}

/// A component without an interface has frequencies and no response: the one limit is met, the others cannot be, whoever says how many
/// modes are kept.
#[test]
fn without_an_interface_frequencies_alone_are_judged() {
    let [_, (beams, band_end)] = components();
    let files = Files::new(beams.model.clone(), Vec::new());
    for modes in ["accept = true", "count = 9"] {
        for method in ["herting", "craig-bampton"] {
            for (accept, is_judged) in
                [("frequency = 1e-3", true), ("response_db = 1.0", false), ("internal_load = 0.1", false)]
            {
                let outcome = files.reduce(method, modes, &scene(band_end, accept));
                assert_eq!(is_met(&outcome), is_judged, "{method}, {modes}, {accept}");
                let accuracy = &outcome.report.body.preservation.accuracy;
                let measured = accuracy.iter().any(|accuracy| accuracy.error.is_some_and(|error| error <= 1e-9));
                // Its modes are those of the full model.
                assert_eq!(measured, is_judged, "{method}, {modes}, {accept}: {accuracy:?}");
            }
        }
    }
}
