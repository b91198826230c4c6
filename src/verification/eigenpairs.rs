//! The retained modes as eigenpairs of the full model: M-01, M-03, M-09.

use faer::Mat;

use super::Evidence;
use super::check::{Check, Limits};
use crate::modes::{Boundary, ModeError, mass_orthogonality};

/// M-01.
pub(super) fn backward_error(evidence: &Evidence<'_>) -> Check {
    let (value, worst) = largest(evidence, |error| error.backward);
    let precision = evidence.partition.precision;
    // On a free component a load is balanced by the interface first and the rigid-body motion taken out afterwards.
    // That motion is up to 1/ratio times the elastic one, and K lets it pass only to the precision of its data; ten
    // stands for the sum over the rigid-body modes.
    let data = 10.0 * precision.stiffness.max(precision.mass) / evidence.rank.singular_ratio;
    // The eigensolver takes a pair at a residual of 16 ε of the largest θ = 1/λ, which is this share of its own.
    let lambda = &evidence.retained.modes.lambda;
    let spread = lambda.last().copied().unwrap_or(1.0) / lambda.first().copied().unwrap_or(1.0);
    let limits = Limits { engineering: 1e-13, arithmetic: 16.0 * f64::EPSILON * spread, data };
    Check {
        id: "M-01",
        name: "modes satisfy the full model",
        equation: "max ‖Kx − λMx‖ / ((‖K‖ + λ‖M‖) ‖x‖), equilibrated",
        value,
        limits,
        fail_above: limits.value().max(1e-10),
        worst,
    }
}

/// M-03.
pub(super) fn orthogonality(evidence: &Evidence<'_>) -> Check {
    let shapes = &evidence.retained.modes.shapes;
    let (mass, all) = match evidence.retained.boundary {
        Boundary::FixedInterface => (evidence.internal.1, shapes.clone()),
        Boundary::FreeInterface => {
            let rigid = &evidence.rigid.orthonormal;
            let n_r = rigid.ncols();
            let join = Mat::from_fn(shapes.nrows(), n_r + shapes.ncols(), |i, j| {
                if j < n_r { rigid[(i, j)] } else { shapes[(i, j - n_r)] }
            });
            (&evidence.partition.mass, join)
        }
    };
    let (value, (a, b)) = mass_orthogonality(mass, all.as_ref());
    Check {
        id: "M-03",
        name: "modes are orthonormal in the mass",
        equation: "max |XᵀMX − I|, rigid-body modes included",
        value,
        limits: Limits { engineering: 1e-12, ..Limits::default() },
        fail_above: 1e-9,
        worst: (value > 0.0).then(|| format!("columns {} and {}", a + 1, b + 1)),
    }
}

/// M-09.
pub(super) fn data_precision(evidence: &Evidence<'_>) -> Check {
    // The bar of a frequency is half that of its square.
    let (value, worst) = largest(evidence, |error| 0.5 * error.relative_bar);
    Check {
        id: "M-09",
        name: "digits of the data suffice",
        equation: "max ½ (ε_K |x|ᵀ|K||x| + ε_M λ|x|ᵀ|M||x|) / λ: relative error bar of a frequency",
        value,
        // A tenth of a per mille is what a modal test can resolve; half the frequency is no frequency any more.
        limits: Limits { engineering: 1e-4, ..Limits::default() },
        fail_above: 0.5,
        worst,
    }
}

fn largest(evidence: &Evidence<'_>, measure: impl Fn(&ModeError) -> f64) -> (f64, Option<String>) {
    let errors = evidence.retained.modes.errors.iter().map(measure).enumerate();
    let worst = errors.fold(None, |worst: Option<(usize, f64)>, (mode, value)| match worst {
        Some((_, largest)) if value <= largest => worst,
        _ => Some((mode, value)),
    });
    worst.map_or((0.0, None), |(mode, value)| (value, Some(format!("mode {}", mode + 1))))
}
