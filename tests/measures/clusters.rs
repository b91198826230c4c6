//! Modes of one cluster are judged together, whatever basis of their space a search has found.

use faer::Mat;
use supel::job::{Coupling, InterfaceJob, Method, NodeSelection};
use supel::modes::Retained;
use supel::verification::Evidence;
use supel::verification::check::Verdict;
use supel_models::springs::springs;
use supel_models::{Material, Model, brick};

use crate::evidence::{checks, line, with_model};

/// A pendulum on a free body whose springs are 10¹² times as stiff, and two on another such body.
///
/// The first pulls its body along, so that terms cancel in its λ = k (1/m + 1/Σm_b), which is known to about 10⁻⁷. The two swing against each
/// other at a λ that is known to its rounding, and nearer to the first than 10⁻⁷.
fn nearly_one_frequency() -> Model {
    let bodies: Vec<f64> = (1..=5).map(|i| 1.0 + 0.1 * f64::from(i).sin()).collect();
    let (m, k) = (0.05 * std::f64::consts::PI / 3.0, 2.0 * std::f64::consts::PI / 3.0);
    let lambda = k * (1.0 / m + 1.0 / bodies.iter().sum::<f64>());
    let masses = [bodies.clone(), bodies, vec![m; 3]].concat();
    let mut between: Vec<(u32, u32, f64)> = [0, 1, 2, 3, 5, 6, 7, 8].map(|row| (row, row + 1, 1e12 * k)).to_vec();
    let swings = m * lambda * (1.0 + 1e-8);
    between.extend([(4, 10, k), (9, 11, swings), (9, 12, swings)]);
    springs(&masses, &[], &between)
}

#[test]
fn modes_that_rounding_cannot_tell_apart_are_judged_as_their_space() {
    let ends = InterfaceJob::new("ends", NodeSelection::Rows { rows: vec![0, 5] }, Coupling::Direct);
    with_model(&nearly_one_frequency(), &[ends], (Method::Herting, 3), |evidence| {
        let seen = |retained: &Retained| {
            let checks = checks(&Evidence { retained, ..evidence });
            let of_pairs = checks.iter().filter(|check| ["M-01", "M-02"].contains(&check.id));
            of_pairs.map(|check| (check.verdict() == Verdict::Fail, line(check))).collect::<Vec<_>>()
        };
        let sound = evidence.retained;
        assert_eq!(sound.modes.lambda[0], sound.modes.lambda[1], "taken for one");
        assert!(seen(sound).iter().all(|(is_seen, _)| !is_seen), "{:?}", seen(sound));
        // Quotients that are apart within their bars: the modes may be mixtures all the same.
        let mut apart = sound.clone();
        apart.modes.lambda[1] *= 1.0 + apart.modes.errors[1].data_bar;
        assert!(seen(&apart).iter().all(|(is_seen, _)| !is_seen), "{:?}", seen(&apart));
        // A λ farther off than its bar says, and a space that another mode has a part in.
        let mut off = sound.clone();
        let bar = off.modes.errors[0].data_bar;
        off.modes.lambda[..2].iter_mut().for_each(|lambda| *lambda *= 1.0 + 100.0 * bar);
        assert!(seen(&off).iter().all(|(is_seen, _)| *is_seen), "{:?}", seen(&off));
        let mut mixed = sound.clone();
        let shapes = &mut mixed.modes.shapes;
        (0..shapes.nrows()).for_each(|row| shapes[(row, 1)] += 1e-4 * shapes[(row, 2)]);
        assert!(seen(&mixed).iter().all(|(is_seen, _)| *is_seen), "{:?}", seen(&mixed));
    });
}

/// Two pendulums on a body that is held: they swing with one frequency. One against the other they do not pull at the body, side by side they do.
#[test]
fn a_mode_that_nothing_sees_in_a_cluster_that_is_seen_counts_as_seen() {
    let model = springs(&[5.0, 1.0, 1.0, 2.0], &[(3, 9e3)], &[(0, 1, 1e3), (0, 2, 1e3), (0, 3, 4e3)]);
    let body = InterfaceJob::new("body", NodeSelection::Rows { rows: vec![0] }, Coupling::Direct);
    with_model(&model, &[body], (Method::CraigBampton, 3), |evidence| {
        let retained = evidence.retained.clone();
        // Rows of the pendulums are the ones that the two modes move.
        let shapes = &retained.modes.shapes;
        let moved: Vec<usize> = (0..3).filter(|row| shapes[(*row, 0)].hypot(shapes[(*row, 1)]) > 1e-6).collect();
        assert_eq!(moved.len(), 2);
        let length = shapes[(moved[0], 0)].hypot(shapes[(moved[0], 1)]) * 0.5f64.sqrt();
        let against = |row: usize, mode: usize| match (moved.iter().position(|of| *of == row), mode) {
            (Some(1), 0) => -length,
            (Some(_), 0 | 1) => length,
            (_, mode) => {
                if mode == 2 {
                    shapes[(row, 2)]
                } else {
                    0.0
                }
            }
        };
        let turned = Mat::from_fn(3, 3, against);
        let modes = supel::eigen::Modes { shapes: turned, ..retained.modes };
        let ranked = Retained { modes, ..retained }.ranked(evidence.partition, None);
        let [first, second] = [ranked.couplings[0], ranked.couplings[1]];
        assert!(first.size < 1e-12 * second.size, "{first:?}, {second:?}");
        assert!(first.is_seen && second.is_seen, "{first:?}, {second:?}");
        assert_eq!(first.share, second.share);
    });
}

/// Of a mode whose column was left out the others have all but 10⁻⁸ of its length, which its residual may show; of a mode that has its
/// column nothing is missing.
#[test]
fn a_mode_whose_column_was_left_out_is_judged_by_what_it_lacks() {
    // Interface at two of three layers: more modes than the interior has of its own.
    let model = brick([2, 2, 2], [0.4, 0.31, 0.23], &Material::STEEL_SI);
    let nodes = NodeSelection::Labels((1..=24).collect());
    with_model(&model, &[InterfaceJob::new("most", nodes, Coupling::Direct)], (Method::Herting, 12), |evidence| {
        let is_left_out =
            |mode: &usize| evidence.basis.dropped.iter().any(|column| column.coordinate.mode() == Some(*mode));
        let (dropped, kept): (Vec<usize>, Vec<usize>) = (0..12).partition(is_left_out);
        assert!(!dropped.is_empty() && !kept.is_empty(), "{dropped:?}");
        let first = evidence.basis.mixing.ncols() - 12;
        let verdict = |mode: usize, share: f64| {
            let mut basis = evidence.basis.clone();
            // The first coordinate, of inertia relief, is in every mode's reach.
            basis.mixing[(0, first + mode)] += share;
            let checks = checks(&Evidence { basis: &basis, ..evidence });
            let check =
                checks.iter().find(|check| check.name == "modes are eigenpairs of the reduced model").expect("M-14");
            println!("{mode} {share:e}: {}", line(check));
            check.verdict()
        };
        let scale = |mode: usize| {
            let column = evidence.basis.mixing.as_ref().col(first + mode);
            column.iter().fold(0.0f64, |max, value| max.max(value.abs()))
        };
        for (mode, share, seen) in
            [(dropped[0], 1e-8, Verdict::Pass), (dropped[0], 1e-4, Verdict::Fail), (kept[0], 1e-4, Verdict::Fail)]
        {
            assert_eq!(verdict(mode, share * scale(mode)), seen, "mode {mode} by {share:e}");
        }
        assert!(verdict(kept[0], 1e-8 * scale(kept[0])) > Verdict::Pass);
    });
}
