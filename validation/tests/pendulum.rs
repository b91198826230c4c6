//! The bracket on its hinge: energy, basis, interior.

use std::sync::OnceLock;

use supel_models::model::multiply;
use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures, ModalComponent};
use validation::curve::Curves;
use validation::integrator::Scheme;
use validation::pendulum::{GRAVITY, HINGE, SCHEME, film, part, superelement, swing};

fn reduced(n_modes: usize) -> Superelement {
    superelement(tempfile::tempdir().expect("folder").path(), n_modes).expect("verified")
}

/// With twenty modes.
fn twenty() -> &'static Superelement {
    static BRACKET: OnceLock<Superelement> = OnceLock::new();
    BRACKET.get_or_init(|| reduced(20))
}

/// Half a second: more than half a turn, down and up again.
fn curves(superelement: &Superelement, step: f64) -> Curves {
    let scheme = Scheme { step, n_steps: (0.5 / step).round() as usize, ..SCHEME };
    swing(superelement, &scheme, usize::MAX).expect("swings").curves
}

/// The bracket taken as rigid: w² = m g ρ / I about the hinge, and the angle from the lowest place at which it is let go.
fn rigid(superelement: &Superelement) -> (f64, f64) {
    let (frame, measures) = (FloatingFrame::MassWeighted, Measures::MotionBased);
    let component = ModalComponent::with_measures(superelement, frame, measures).expect("accepted");
    let mass = component.rigid_mass();
    // The block of translations and rotations about the origin is −m x̃_c.
    let (m, x, z) = (mass[0][0], mass[1][5] / mass[0][0], mass[0][4] / mass[0][0]);
    let radius = x.hypot(z - HINGE);
    let moment = mass[4][4] + m * (radius * radius - x * x - z * z);
    (m * GRAVITY * radius / moment, (x / radius).acos())
}

#[test]
fn energy_is_constant_to_the_order_of_the_scheme() {
    let bracket = twenty();
    let h = SCHEME.step;
    let runs = [2.0 * h, h].map(|step| curves(bracket, step));
    let largest = |column: usize| runs[1].column(column).into_iter().fold(0.0, f64::max);
    assert!(largest(2) > 200.0, "the base comes to the other side of the hinge, at z = {HINGE}: {}", largest(2));
    let [coarse, fine] = runs.each_ref().map(|curves| {
        let sum = curves.column(6);
        sum.iter().map(|energy| energy - sum[0]).collect::<Vec<f64>>()
    });
    let most = |changes: &[f64]| changes.iter().fold(0.0_f64, |most, change| most.max(change.abs()));
    // A mode below which nothing vibrates: terms of the fourth order are (ω h)² of those of the second.
    let (omega, (w2, start)) = (bracket.tensors().frequencies[0], rigid(bracket));
    let fourth = (omega * h).powi(2);

    // Without damping the scheme is the trapezoidal rule, which keeps H + h²/12 (φ̇² V″ + V′²) of H = φ̇²/2 + V to the
    // fourth order, here with V = −w² cos φ.
    let term = |phi: f64| 2.0 * w2 * w2 * (phi.cos() - start.cos()) * phi.cos() + (w2 * phi.sin()).powi(2);
    let changes: Vec<f64> = (0..=100).map(|i| term(start * f64::from(i) / 100.0) - term(start)).collect();
    let kinetic = w2 * (1.0 - start.cos());
    let expected = h * h / 12.0 * most(&changes) / kinetic;
    let found = most(&fine) / largest(3);
    println!("change {found:e} of the kinetic energy, {expected:e} of a rigid bracket");
    // Centrifugal forces lengthen the pendulum by (φ̇/ω)² of its radius at most, its moment by twice as much.
    let lengthened = 2.0 * kinetic / (omega * omega);
    assert!((found / expected - 1.0).abs() < 2.0 * lengthened, "{found:e} for {expected:e} within {lengthened}");

    // Half the step leaves a quarter: f (1 + 4ε) · 4 becomes f (1 + ε).
    let ratio = most(&coarse) / most(&fine);
    assert!((ratio / 4.0 - 1.0).abs() < 3.0 * fourth, "{ratio}");
    // What stays without any step is the fault of the component's forces; judged by the strain energy, some 250 times
    // smaller than the kinetic. Of the fourth order (4 − 16)/3 remain.
    let without_step: Vec<f64> = coarse.iter().enumerate().map(|(i, c)| (4.0 * fine[2 * i] - c) / 3.0).collect();
    let of_strain = most(&without_step) / largest(4);
    println!("{of_strain:e} of the strain energy without a step");
    assert!(most(&without_step) < 4.0 * fourth * most(&fine), "{of_strain:e}");
    assert!(of_strain < 1e-4, "{of_strain:e}, and the README says less than a ten-thousandth");
}

#[test]
fn twenty_modes_move_as_sixty_do() {
    let finest = curves(&reduced(60), 1e-3);
    let [none, twenty] = [&reduced(0), twenty()].map(|bracket| {
        let curves = curves(bracket, 1e-3);
        [0, 2].map(|axis| curves.misfit(axis, (&finest, axis), [0.0, 0.5]).max).into_iter().fold(0.0, f64::max)
    });
    println!("{none:e} {twenty:e}");
    assert!(twenty < none / 10.0, "{none:e} without modes, {twenty:e} with 20");
}

#[test]
fn recovered_rows_are_the_basis_of_the_reduction() {
    let bracket = twenty();
    let recovery = bracket.tensors().recovery.as_ref().expect("rows");
    let (model, n) = (part(20).model, bracket.n_coordinates());
    let columns: Vec<Vec<f64>> = (0..n).map(|j| (0..model.n).map(|i| recovery.rows()[(i, j)]).collect()).collect();
    for (entries, reduced) in [(&model.stiffness, &bracket.tensors().stiffness), (&model.mass, &bracket.tensors().mass)]
    {
        for j in 0..n {
            let image = multiply(entries, &columns[j]);
            for i in 0..n {
                let found: f64 = columns[i].iter().zip(&image).map(|(a, b)| a * b).sum();
                // Sums of some 5000 terms that cancel in K: rounding relative to the diagonal, times the terms' size.
                let scale = (reduced[(i, i)] * reduced[(j, j)]).sqrt();
                assert!((found - reduced[(i, j)]).abs() <= 1e-9 * scale, "({i}, {j}): {found} for {}", reduced[(i, j)]);
            }
        }
    }
}

#[test]
fn film_shows_the_bracket_at_every_instant() {
    let bracket = twenty();
    let swing = swing(bracket, &Scheme { n_steps: 200, ..SCHEME }, 50).expect("swings");
    assert_eq!(swing.frames.len(), 5);
    let svg = film(&swing.frames);
    assert!(svg.contains("0.20 s") && svg.matches("<polygon").count() > 5 * 500);
    // At the start nothing is deformed; later the base lags behind.
    let largest = |frame: usize| swing.frames[frame].deformations.iter().copied().fold(0.0, f64::max);
    assert!(largest(0) < 1e-9 && largest(4) > 0.1, "{} and {} mm", largest(0), largest(4));
}
