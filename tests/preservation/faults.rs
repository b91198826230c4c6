//! The checker checked: each measure of preservation fails on a reduced model that was damaged for it.

use faer::Scale;
use supel::job::{Certify, Job, Method};
use supel::modes::Retained;
use supel::reduction::Reduction;
use supel::verification::check::{Check, Verdict};
use supel::verification::{Compared, Evidence, preservation};

use crate::chain::{direct, rigid_group};
use crate::evidence::with_model;
use crate::run::block;

const JOB: &str = r#"
[model]
stiffness = "K.mtx"
mass = "M.mtx"
[reduction]
method = "herting"
modes = { count = 6 }
[write]
superelement = "x.supel"
"#;

/// The comparison of a block whose reduced matrices and modes may have been damaged.
fn compared(damage: impl Fn(&mut Reduction, &mut Retained)) -> Compared {
    with_block(|evidence, job| {
        let (mut reduction, mut retained) = (evidence.reduction.clone(), evidence.retained.clone());
        damage(&mut reduction, &mut retained);
        compare(&Evidence { reduction: &reduction, retained: &retained, ..evidence }, &job)
    })
}

fn with_block<T>(look: impl Fn(Evidence<'_>, Job) -> T) -> T {
    let interfaces = [rigid_group("XMIN"), direct("tip", &[45])];
    let job = Job::parse(JOB, "job.toml".as_ref()).expect("a job");
    with_model(&block(), &interfaces, (Method::Herting, 6), |evidence| look(evidence, job.clone()))
}

fn compare(evidence: &Evidence<'_>, job: &Job) -> Compared {
    let analysis = evidence.partition.analysis().expect("memory");
    preservation(evidence, &analysis, job).expect("compared")
}

fn check<'a>(compared: &'a Compared, id: &str) -> &'a Check {
    compared.checks.iter().find(|check| check.id == id).unwrap_or_else(|| panic!("no {id}"))
}

#[test]
fn a_sound_reduction_passes() {
    let compared = compared(|_, _| {});
    let ids: Vec<&str> = compared.checks.iter().map(|check| check.id).collect();
    assert_eq!(ids, ["M-15", "M-17", "M-20", "M-21", "M-06", "M-24"]);
    for check in &compared.checks {
        let expected = if check.id == "M-20" { Verdict::Info } else { Verdict::Pass };
        assert_eq!(check.verdict(), expected, "{check:?}");
    }
}

/// A mode that a search missed is found again from another start, because the count knows of it.
#[test]
fn a_mode_that_is_missing_under_a_boundary_is_looked_for_again() {
    let sound = compared(|_, _| {});
    // The free component takes the retained modes for its answer.
    let lacking = compared(|_, retained| retained.modes = retained.modes.without(1));
    let (found, expected) = (&lacking.report.boundaries[0], &sound.report.boundaries[0]);
    assert_eq!((found.boundary.as_str(), found.frequencies.len()), ("free", expected.frequencies.len()));
    let count = found.count.expect("counted");
    assert_eq!((count.n_found, check(&lacking, "M-06").verdict()), (count.n_counted, Verdict::Pass));
    for (found, expected) in found.frequencies.iter().zip(&expected.frequencies) {
        // Rayleigh quotients of the same modes from two searches, some thousand roundings of terms that cancel.
        assert!((found.full_hz / expected.full_hz - 1.0).abs() < 1e-12, "{found:?} for {expected:?}");
    }
}

/// A job that asks for no count gets none.
#[test]
fn nothing_is_counted_where_nothing_is_certified() {
    let compared = with_block(|evidence, mut job| {
        job.run.certify = Certify::None;
        compare(&evidence, &job)
    });
    assert!(compared.checks.iter().all(|check| check.id != "M-06"));
    assert!(
        compared.report.boundaries.len() == 5 && compared.report.boundaries.iter().all(|line| line.count.is_none())
    );
}

#[test]
fn softer_reduced_stiffness_fails_monotonicity_and_statics() {
    let soft = compared(|reduction, _| reduction.stiffness *= Scale(1.0 - 1e-5));
    for id in ["M-17", "M-24"] {
        assert_eq!(check(&soft, id).verdict(), Verdict::Fail, "{:?}", check(&soft, id));
    }
    // λ of every mode is low by the same share.
    assert!((check(&soft, "M-24").value / 1e-5 - 1.0).abs() < 1e-3);
}

#[test]
fn heavier_reduced_mass_fails_monotonicity() {
    let heavy = compared(|reduction, _| reduction.mass *= Scale(1.0 + 1e-6));
    assert_eq!(check(&heavy, "M-24").verdict(), Verdict::Fail);
    assert_eq!(check(&heavy, "M-17").verdict(), Verdict::Pass);
}

#[test]
fn exchanged_modes_fail_the_mac() {
    let compared = compared(|_, retained| {
        let shapes = &mut retained.modes.shapes;
        let second = shapes.col(1).to_owned();
        shapes.col_mut(0).copy_from(&second);
    });
    let mac = check(&compared, "M-15");
    assert_eq!((mac.verdict(), mac.worst.as_deref()), (Verdict::Fail, Some("mode 1")));
    assert!(compared.report.mac[0][1] > 0.999, "the second mode stands in the first row");
}

/// A wrong basis cannot hide: the full answers come from the full matrices.
#[test]
fn damage_to_the_reduced_matrices_shows_in_the_response() {
    let sound = check(&compared(|_, _| {}), "M-20").value;
    // Nine interface dofs and six inertia-relief modes go before the first elastic mode.
    let damaged = compared(|reduction, _| reduction.mass[(15, 15)] *= 1.2);
    assert!(check(&damaged, "M-20").value > 10.0 * sound, "{} {sound}", check(&damaged, "M-20").value);
    let response = damaged.report.response.as_ref().expect("a response");
    assert!(response.peak_shift > 1e-3 && response.residual < 1e-6);
}

/// Reduced matrices that are not definite leave gaps that are named, and no panic.
#[test]
fn what_cannot_be_compared_is_named() {
    let compared = compared(|reduction, _| reduction.mass *= Scale(-1.0));
    assert!(compared.report.not_compared.iter().any(|note| note.starts_with("frequency response: ")));
    assert!(compared.report.response.is_none() && compared.report.boundaries.is_empty());
    assert_eq!(compared.report.statics.len(), 2, "statics need no mass");
}
