//! Frequencies and matrices of preloaded networks by dense algebra.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use supel_models::{SplitMix64, model};
use supel_runtime::component::{ComponentError, FloatingFrame, ModalComponent};
use supel_runtime::{Flag, RigidBodyModes};
use supel_testing::pencil::{difference, eigen, matrices, part, spectrum, unpacked};
use supel_testing::place::supel;

use supel::cli::ExitCode;

use crate::network::{Network, Nodes, tied_tower, tower};
use crate::{ENDS, Made, PRELOADED, made, n_rigid, place_of, reduced};

/// Tension over stiffness and length.
const STRAIN: f64 = 2e-3;
/// A shift between the motions without stiffness and the others, rad²/s².
const ALPHA: f64 = 1e3;
const BOTH: [Nodes; 2] = [Nodes::Points, Nodes::Bodies];

/// The networks are the truth of the other tests: q and K are the derivatives of an energy that knows finite rotations.
#[test]
fn networks_are_the_derivatives_of_their_energy() {
    /// Steps in metres and radians, whose fourth power is the error of a second difference relative to its square.
    const H: f64 = 1e-3;
    for nodes in BOTH {
        let network = tower(nodes, STRAIN);
        let mut random = SplitMix64::new(3);
        for _ in 0..5 {
            let x: Vec<f64> = (0..network.model.n).map(|_| random.normal()).collect();
            let at = |h: f64| network.energy(&x.iter().map(|x| h * x).collect::<Vec<f64>>());
            let (first, second) = ((at(H) - at(-H)) / (2.0 * H), (at(H) + at(-H) - 2.0 * at(0.0)) / (H * H));
            let expected = model::dot(&x, &model::multiply(&network.model.stiffness, &x));
            let force = model::dot(&x, &network.forces);
            // Third and fourth derivatives are those of lengths, 1/L³ and arms of a fifth: some tens of H² of the second.
            assert!((second / expected - 1.0).abs() < 100.0 * H * H, "{second} {expected}");
            assert!((first - force).abs() < 100.0 * H * H * expected, "{first} {force}");
        }
    }
}

/// K_BB − K_BI K_II⁻¹ K_IB of the interface rows.
fn condensed(k: &Mat<f64>, interface: &[usize]) -> Mat<f64> {
    let inner: Vec<usize> = (0..k.nrows()).filter(|row| !interface.contains(row)).collect();
    let block = |rows: &[usize], cols: &[usize]| Mat::from_fn(rows.len(), cols.len(), |i, j| k[(rows[i], cols[j])]);
    let mut answers = block(&inner, interface);
    part(k.as_ref(), &inner).llt(Side::Lower).expect("stable").solve_in_place(answers.as_mut());
    part(k.as_ref(), interface) - block(interface, &inner) * answers
}

fn interface_rows(network: &Network) -> Vec<usize> {
    let n = network.model.n / 12;
    [0, 1, 10, 11].into_iter().flat_map(|node| n * node..n * (node + 1)).collect()
}

/// The superelement is right by its own content and against its model, says what it is, and makes no component.
pub(crate) fn assert_verified(made: &Made) {
    for args in [&["verify"][..], &["verify", "--job"]] {
        let (file, job) = (made.place.text("x.supel"), made.place.text("job.toml"));
        let mut args = args.to_vec();
        args.extend(if args.len() > 1 { vec![job.as_str(), file.as_str()] } else { vec![file.as_str()] });
        let ended = supel(&args);
        assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    }
    let metadata = made.file.metadata();
    assert!(metadata.flags.contains(&Flag::Preloaded));
    assert_eq!(metadata.model.rigid_body_modes, RigidBodyModes::Algebraic);
    let component = ModalComponent::new(&made.file, FloatingFrame::MassWeighted);
    assert_eq!(component.err(), Some(ComponentError::Preloaded));
}

/// Û moves all interface nodes alike, without rotations.
fn assert_translations(made: &Made, n_directions: usize) {
    let u = &made.file.tensors().rigid_body_modes;
    assert_eq!(u.cols(), 3);
    for mode in 0..3 {
        for row in 0..4 * n_directions {
            let expected = if row % n_directions < 3 { u[(row % n_directions, mode)] } else { 0.0 };
            // Combinations of three unit motions by eight multiplications.
            assert!((u[(row, mode)] - expected).abs() < 1e-14, "mode {mode}, row {row}: {} {expected}", u[(row, mode)]);
        }
    }
}

/// Translations are free, the soft rotations are modes, and each method keeps exactly what it keeps of any other structure.
#[test]
fn every_method_keeps_what_the_dense_pencil_has() {
    for nodes in BOTH {
        let network = tower(nodes, STRAIN);
        let [k, m] = matrices(&network.model);
        let interface = interface_rows(&network);
        let inner: Vec<usize> = (0..k.nrows()).filter(|row| !interface.contains(row)).collect();
        let free = eigen(k.as_ref(), m.as_ref(), ALPHA).0;
        // Preload alone resists rotations: they are far below the first deformation.
        assert!(free[2].abs() < 1e-6 && free[3] > 10.0 && free[5] < 0.2 * free[6], "{free:?}");
        let held = eigen(part(k.as_ref(), &inner).as_ref(), part(m.as_ref(), &inner).as_ref(), ALPHA).0;
        let statics = condensed(&k, &interface);
        for (reduction, n_kept) in [
            (r#"method = "herting", modes = { count = 8 }"#, 11),
            (r#"method = "rubin", modes = { count = 8 }"#, 11),
            (r#"method = "craig-bampton", modes = { count = 8 }"#, 0),
            (r#"method = "guyan""#, 0),
        ] {
            let made = made(&network, ENDS, reduction);
            assert_eq!(n_rigid(&made.report), 3, "{reduction}");
            assert_translations(&made, network.model.n / 12);
            let file = spectrum(&made.file, &[], ALPHA);
            // θ = 1/(λ + α) is known to rounding of the condition of K + αM, 1e4, on either side.
            assert!(difference(&file[..n_kept.max(3)], &free[..n_kept.max(3)], ALPHA) < 1e-10 || n_kept == 0);
            assert!(difference(&file[..3], &free[..3], ALPHA) < 1e-10, "{reduction}");
            let omega = &made.file.tensors().frequencies;
            let expected = if n_kept > 0 { &free[3..] } else { &held[..] };
            for (omega, lambda) in omega.iter().zip(expected) {
                assert!((omega * omega / lambda - 1.0).abs() < 1e-9, "{reduction}: {} {lambda}", omega * omega);
            }
            if n_kept == 0 {
                let k_red = unpacked(&made.file.tensors().stiffness);
                let n_b = interface.len();
                let error = (k_red.submatrix(0, 0, n_b, n_b) - &statics).norm_max();
                assert!(error < 1e-11 * statics.norm_max(), "{reduction}: {error:e}");
            }
            assert_verified(&made);
        }
    }
}

/// Forces along one line turn with nothing that turns about it: that rotation is free next to the translations.
#[test]
fn a_component_tied_along_a_line_turns_about_it() {
    for nodes in BOTH {
        let network = tied_tower(nodes, 0.1);
        let [k, m] = matrices(&network.model);
        let free = eigen(k.as_ref(), m.as_ref(), ALPHA).0;
        assert!(free[3].abs() < 1e-6 && free[4] > 1.0, "{free:?}");
        for reduction in
            [r#"method = "herting", modes = { count = 8 }"#, r#"method = "craig-bampton", modes = { count = 4 }"#]
        {
            let made = made(&network, ENDS, reduction);
            assert_eq!(n_rigid(&made.report), 4);
            assert_verified(&made);
        }
    }
}

/// Dofs that are held take the free motions away, and what is left of the rotations is the preload's.
#[test]
fn a_held_point_leaves_no_free_rotation() {
    let network = tower(Nodes::Points, STRAIN);
    let [k, m] = matrices(&network.model);
    let moving: Vec<usize> = (3..k.nrows()).collect();
    let expected = eigen(part(k.as_ref(), &moving).as_ref(), part(m.as_ref(), &moving).as_ref(), ALPHA).0;
    let interface = r#"{ name = "tip", nodes = [11, 12] }]
fixed = [{ nodes = [1] }"#;
    let made = made(&network, interface, r#"method = "herting", modes = { count = 8 }"#);
    assert_eq!(n_rigid(&made.report), 0);
    assert!(expected[0] > 1.0);
    for (omega, lambda) in made.file.tensors().frequencies.iter().zip(&expected) {
        assert!((omega * omega / lambda - 1.0).abs() < 1e-9, "{} {lambda}", omega * omega);
    }
}

/// Without an interface the translations are coordinates, and the rotations are the first modes.
#[test]
fn modes_of_the_free_component() {
    let network = tower(Nodes::Bodies, STRAIN);
    let [k, m] = matrices(&network.model);
    let free = eigen(k.as_ref(), m.as_ref(), ALPHA).0;
    let made = made(&network, "", r#"method = "herting", modes = { count = 6 }"#);
    assert_eq!(n_rigid(&made.report), 3);
    let file = spectrum(&made.file, &[], ALPHA);
    assert_eq!(file.len(), 9);
    assert!(difference(&file, &free[..9], ALPHA) < 1e-10);
    let job = made.place.text("job.toml");
    let ended = supel(&["verify", "--job", &job, &made.place.text("x.supel")]);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
}

/// Six digits of the stiffness leave 1e-6 of its terms, of which the preload makes 1e-3.
#[test]
fn a_stiffness_of_six_digits() {
    let network = tower(Nodes::Bodies, STRAIN);
    let place = place_of(&network, &network.forces, (PRELOADED, ENDS), r#"method = "herting", modes = { count = 8 }"#);
    let matrix = String::from_utf8(place.bytes("K.mtx")).expect("UTF-8");
    let shortened = |(number, line): (usize, &str)| match line.rsplit_once(' ') {
        Some((at, value)) if number > 1 => format!("{at} {:.5e}\n", value.parse::<f64>().expect("a number")),
        _ => format!("{line}\n"),
    };
    place.write("K.mtx", matrix.lines().enumerate().map(shortened).collect::<String>().as_bytes());
    let ended = reduced(&place);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(n_rigid(&place.report("x.report.json")), 3);
    let [k, m] = matrices(&network.model);
    let free = eigen(k.as_ref(), m.as_ref(), ALPHA).0;
    let found = place.superelement("x.supel").tensors().frequencies.clone();
    for (omega, lambda) in found.iter().zip(&free[3..]) {
        // |ΔK| is 5e-6 of |K| at most, so that by Weyl no eigenvalue moves by more than that share of the largest of |K|, which is not
        // above twice that of K here.
        assert!((omega * omega - lambda).abs() < 1e-5 * free[71], "{} {lambda}", omega * omega);
    }
}
