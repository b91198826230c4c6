//! The bracket on its hinge: energy, basis, interior.

use std::sync::OnceLock;

use supel_models::model::multiply;
use supel_runtime::Superelement;
use validation::curve::Curves;
use validation::integrator::Scheme;
use validation::pendulum::{SCHEME, film, part, superelement, swing};

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

#[test]
fn energy_is_constant_to_the_order_of_the_scheme() {
    let bracket = twenty();
    let error = |step: f64| {
        let curves = curves(bracket, step);
        let (kinetic, sum) = (curves.column(3), curves.column(6));
        let turned = curves.column(2).into_iter().fold(0.0, f64::max);
        assert!(turned > 200.0, "the base comes to the other side of the hinge, at z = 112: {turned}");
        let largest = kinetic.into_iter().fold(0.0, f64::max);
        sum.iter().map(|energy| (energy - sum[0]).abs()).fold(0.0, f64::max) / largest
    };
    let (coarse, fine) = (error(2e-3), error(1e-3));
    println!("{coarse:e} {fine:e}");
    // Second order: halving the step leaves a quarter, but for terms of the fourth, some (ωh)² of it with ωh = 0.1 at the
    // first elastic frequency and the coarse step.
    assert!((coarse / fine - 4.0).abs() < 0.4, "{coarse:e} becomes {fine:e}");
    // (φ̇ h)²/12 with the largest angular velocity of the swing, 13 rad/s.
    assert!(fine < (13.0_f64 * 1e-3).powi(2) / 12.0, "{fine:e}");
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
