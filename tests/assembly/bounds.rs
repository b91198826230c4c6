//! The lower bounds, where they are nearly reached and where a file does not give any.

use supel::assembly::{Assembly, Component, Kind, Omitted};
use supel::cli::ExitCode;
use supel_models::springs::springs;
use supel_models::{Material, brick, spectrum};
use supel_runtime::Coordinate;
use supel_testing::place::{Place, supel};

use crate::{all_modes, assert_enclosed, beams, line, n_rigid, reduced};

/// A pin that carries two oscillators of which the slower one is kept: the bound is that of the other one at the frequency of the
/// kept one, and moving the omitted one there brings the whole model to its bound.
#[test]
fn bound_is_reached_by_an_omitted_mode_at_the_end_of_the_band() {
    let ground = springs(&[1e-9, 2.0], &[(1, 1.0)], &[(0, 1, 3.0)]);
    // λ of the omitted oscillator over that of the kept one, which is one.
    let mut gaps = Vec::new();
    for ratio in [1.1, 1.01, 1.001] {
        let arms = springs(&[1e-9, 1.0, 2.0], &[], &[(0, 1, 1.0), (0, 2, 2.0 * ratio)]);
        let mut assembly = Assembly::new(vec![
            reduced("arms", &arms, "--interface pin=rows:0 --method craig-bampton --modes 1"),
            reduced("ground", &ground, "--interface ends=rows:0,1 --method guyan"),
        ])
        .expect("two names");
        assembly.join("arms.rows:0", "ground.rows:0").expect("rows");
        let modes = all_modes(&assembly);
        let whole = springs(&[2e-9, 1.0, 2.0, 2.0], &[(3, 1.0)], &[(0, 1, 1.0), (0, 2, 2.0 * ratio), (0, 3, 3.0)]);
        let whole = spectrum(&whole);
        assert_enclosed(&modes, &whole);
        let lower = modes.modes[0].at_least_hz.expect("a bound");
        gaps.push(whole[0].sqrt() / std::f64::consts::TAU / lower - 1.0);
    }
    // What is between the bound and the whole model goes with the distance of the omitted mode from the band.
    assert!(gaps[0] > 5.0 * gaps[1] && gaps[1] > 5.0 * gaps[2] && gaps[2] < 1e-3, "{gaps:?}");
}

#[test]
fn frequencies_beyond_the_band_are_marked_and_bounded_by_its_end() {
    let beam = reduced("beam", &beams(&line()), "--interface end=1 --method herting --modes 4");
    let Omitted::Above { hz, .. } = beam.omitted else { panic!("a band: {:?}", beam.omitted) };
    let mut assembly = Assembly::new(vec![beam]).expect("one name");
    let free = all_modes(&assembly);
    assert_eq!((n_rigid(&free), free.band_hz), (6, Some(hz)));
    // The modes that were kept are exact, and the bounds meet there; the rest cannot be bounded by more than the end of the band.
    for mode in &free.modes[6..10] {
        let at_least = mode.at_least_hz.expect("a bound");
        assert!(mode.frequency_hz / at_least - 1.0 < 1e-6, "{mode:?}");
    }
    for mode in &free.modes[10..] {
        assert!(mode.is_beyond_band && mode.at_least_hz.expect("a bound") <= hz, "{mode:?}");
    }
    assembly.fix("end").expect("the only component needs no name");
    assert!(all_modes(&assembly).modes.iter().all(|mode| mode.kind == Kind::Elastic));
}

/// Why a file gives no bound, for a beam reduced by some flags.
fn unbounded(flags: &str) -> String {
    let component = reduced("beam", &beams(&line()), &format!("--interface end=1 {flags}"));
    let Omitted::Unknown { why } = component.omitted.clone() else { panic!("{:?}", component.omitted) };
    let modes = all_modes(&Assembly::new(vec![component]).expect("one name"));
    assert!(modes.band_hz.is_none() && modes.modes.iter().all(|mode| mode.at_least_hz.is_none()));
    why
}

#[test]
fn no_bound_is_given_where_the_file_does_not_say_what_is_left_out() {
    assert!(unbounded("--method guyan").contains("Guyan keeps no modes"));
    assert!(unbounded("--method herting --modes 4 --certify none").contains("were not counted"));
    assert!(unbounded("--method herting --modes 0").contains("keeps no mode above zero"));
}

#[test]
fn frequencies_that_the_matrices_do_not_have_give_no_bound() {
    let place = Place::with(&beams(&line()));
    place.reduce(&place.model_flags(), "--interface end=1 --method herting --modes 4");
    let superelement = place.superelement("x.supel");
    let (mut tensors, metadata) = (superelement.tensors().clone(), superelement.metadata().clone());
    let n = tensors.stiffness.rows();
    let stiffness = tensors.stiffness.clone();
    tensors.stiffness = supel_runtime::Matrix::from_fn(n, n, |i, j| 1.001 * stiffness[(i, j)]);
    let altered = supel_runtime::Superelement::new(tensors, metadata).expect("one superelement");
    let component = Component::new("beam".to_owned(), altered).expect("a component");
    let Omitted::InDoubt { why } = &component.omitted else { panic!("{:?}", component.omitted) };
    assert!(why.contains("do not have the frequencies that it states"), "{why}");
}

/// Matrices that failed a check or are not those of the stated frequencies bound nothing from above.
#[test]
fn a_component_in_doubt_bounds_nothing() {
    let place = Place::with(&beams(&line()));
    place.reduce(&place.model_flags(), "--interface end=1 --method herting --modes 4");
    let superelement = place.superelement("x.supel");
    let (mut tensors, mut metadata) = (superelement.tensors().clone(), superelement.metadata().clone());
    let n = tensors.stiffness.rows();
    let stiffness = tensors.stiffness.clone();
    tensors.stiffness = supel_runtime::Matrix::from_fn(n, n, |i, j| 0.25 * stiffness[(i, j)]);
    let quarter = supel_runtime::Superelement::new(tensors, metadata.clone()).expect("one superelement");
    metadata.verification.verdict = supel_runtime::Verdict::Fail;
    let failed = supel_runtime::Superelement::new(superelement.tensors().clone(), metadata).expect("one superelement");
    for (altered, code) in [(quarter, ExitCode::Done), (failed, ExitCode::CheckFailed), (superelement, ExitCode::Done)]
    {
        let is_sound = altered.metadata().verification.verdict != supel_runtime::Verdict::Fail
            && altered.tensors().stiffness[(0, 0)] == stiffness[(0, 0)];
        altered.write(&place.path("y.supel")).expect("written");
        let ended = supel(&["modes", &place.text("y.supel"), "--fix", "end"]).expect(code);
        assert_eq!(ended.out.contains("Each frequency is an upper bound"), is_sound, "{}", ended.out);
        assert_eq!(ended.out.contains("the matrices of y are in doubt"), !is_sound, "{}", ended.out);
    }
}

/// Two rigid patches next to each other, and a bar forty times as long beyond them: the mass that the reduction may leave out is rounding at
/// some coordinates, and the bounds are those of the others. By themselves free modes are exact, and their bounds meet.
#[test]
fn patches_next_to_each_other_leave_bounds() {
    let patch = |x: usize| (0..4).map(|row| (41 * row + x + 1).to_string()).collect::<Vec<_>>().join(",");
    // What rounding makes differs from width to width.
    for width in [0.02, 0.0213, 0.0187, 0.0171, 0.0229] {
        let bar = brick([40, 1, 1], [1.0, width, width], &Material::STEEL_SI);
        for (method, share) in [("herting", 1.0 - 1e-6), ("craig-bampton", 0.9)] {
            let flags = format!(
                "--rigid-interface a={} --rigid-interface b={} --method {method} --modes 8 --certify count",
                patch(0),
                patch(1)
            );
            let modes = all_modes(&Assembly::new(vec![reduced("bar", &bar, &flags)]).expect("one name"));
            assert_eq!(n_rigid(&modes), 6);
            for mode in &modes.modes[6..10] {
                let lower = mode.at_least_hz.expect("a bound");
                let known = share * mode.frequency_hz..=mode.frequency_hz;
                assert!(known.contains(&lower), "{width}, {method}: {lower} Hz of {} Hz", mode.frequency_hz);
            }
        }
    }
}

/// A held component has no rigid-body motion that would show the rounding of its matrices; the error bars in its file do.
#[test]
fn rounding_is_no_less_than_the_error_bar_of_a_held_component() {
    for method in ["herting", "craig-bampton"] {
        let flags = format!("--fix wall=1 --interface tip=13 --method {method} --modes 4");
        let component = reduced("beam", &beams(&line()), &flags);
        let bar = component.superelement.metadata().coordinates.iter().find_map(|coordinate| match coordinate {
            Coordinate::ElasticMode { frequency_hz, error_bar_hz, .. }
            | Coordinate::FixedInterfaceMode { frequency_hz, error_bar_hz, .. } => {
                Some(2.0 * std::f64::consts::TAU.powi(2) * frequency_hz * error_bar_hz.expect("a bar"))
            }
            _ => None,
        });
        let modes = all_modes(&Assembly::new(vec![component]).expect("one name"));
        let first = &modes.modes[0];
        let rounding = 2.0 * std::f64::consts::TAU.powi(2) * first.frequency_hz * first.rounding_hz;
        // Eigenvalues, to first order of their bars.
        assert!(rounding >= 0.99 * bar.expect("a mode"), "{method}: {rounding:e}, {bar:?}");
    }
}

/// A free component of which six dofs are left has six motions, and rounding of its matrices is none.
#[test]
fn nothing_but_rigid_body_modes() {
    let component = reduced("beam", &beams(&line()), "--interface tip=13 --method guyan");
    let modes = all_modes(&Assembly::new(vec![component]).expect("one name"));
    assert_eq!((modes.n_free, modes.n_rigid, modes.n_modes), (6, 6, 6));
}
