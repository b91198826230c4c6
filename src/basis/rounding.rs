//! Columns of Herting's method that are nothing but rounding: of a mode or a motion that lives wholly in the interface.
//!
//! ```text
//! x = [X_I; X_B]       n' × 1   a mode of unit modal mass, xᵀKx = λ
//! c = X_I − Ψ_S X_B    n_I × 1   its column (23)
//! l = (MU)_I           n_I × 1   the load of an inertia-relief column (37)
//! ```
//! Scaled to unit length, rounding would be a column that no one asked for, under the name of a mode.

use std::ops::Range;

use faer::MatMut;
use rayon::prelude::*;

use crate::constraint::ConstraintModes;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::Modes;
use crate::partition::Partition;
use crate::sparse::{absolute_energy, panels, product};

/// Length a unit column must keep after the columns before it are taken out. Healthy bases keep 10⁻³ to 10⁻²; at 10⁻⁸
/// half the digits of the column are rounding.
pub(crate) const INDEPENDENT: f64 = 1e-8;
/// Share of the inertia of a motion, as a square, that rounding of the motion makes: a component is known to ε of the whole.
const UNKNOWN: f64 = (NOISE_FACTOR * f64::EPSILON) * (NOISE_FACTOR * f64::EPSILON);

/// Sets accelerated columns to zero that rounding may have made, or that tell nothing beyond it.
///
/// - The difference keeps no more than [`INDEPENDENT`] of its terms, where stiffness lies and where mass does: the interior follows the
///   interface statically. What moves the mass of a soft part alone is nothing next to the stiffness of the others.
/// - cᵀMc is at most (10 ε)² of |x|ᵀ|M||x|: the mode itself is not known that well.
/// - cᵀKc ≤ ελ and cᵀMc ≤ ε: with (Kx)_I = K_II c = λ(Mx)_I the motion x − \[c; 0\], which the interface makes alone, has the
///   Rayleigh quotient λ (1 − cᵀKc/λ) / (1 − 2cᵀKc/λ + cᵀMc). That is λ but for its last digit.
pub(super) fn clear_rounding(
    partition: &Partition,
    constraint: &ConstraintModes<'_>,
    modes: &Modes,
    mut accelerated: MatMut<'_, f64>,
) {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    let (x_i, x_b) = modes.shapes.as_ref().split_at_row(n_i);
    let pencil = partition.internal();
    let stiffness = pencil.stiffness.diagonal();
    let length = |column: &[f64]| column.iter().zip(&stiffness).map(|(x, k)| k.abs() * x * x).sum::<f64>().sqrt();
    let of_panel = |columns: Range<usize>| {
        let psi_s = constraint.modes.columns(columns);
        (0..psi_s.ncols()).map(|b| length(dense::column(psi_s.as_ref(), b))).collect::<Vec<f64>>()
    };
    let of_psi_s: Vec<f64> = panels(n_b).flat_map(of_panel).collect();
    for columns in panels(modes.count()) {
        let c = accelerated.as_ref().get(.., columns.clone());
        let energies = dense::dots(c, product(pencil.stiffness, c).as_ref());
        let inertias = dense::dots(c, product(pencil.mass, c).as_ref());
        let terms = absolute_energy(&partition.mass, modes.shapes.as_ref().get(.., columns.clone()));
        let is_rounding = |at: usize, column: &[f64]| {
            let j = columns.start + at;
            let following =
                dense::column(x_b, j).iter().zip(&of_psi_s).map(|(x, length)| x.abs() * length).sum::<f64>();
            let follows = length(column) <= INDEPENDENT * (length(dense::column(x_i, j)) + following)
                && inertias[at] <= INDEPENDENT * INDEPENDENT * terms[at];
            let is_unknown = inertias[at] <= UNKNOWN * terms[at];
            let changes_nothing = energies[at] <= f64::EPSILON * modes.lambda[j] && inertias[at] <= f64::EPSILON;
            follows || is_unknown || changes_nothing
        };
        let panel = accelerated.as_mut().get_mut(.., columns.clone());
        panel.par_col_chunks_mut(1).enumerate().for_each(|(at, column)| {
            let column = dense::column_mut(column, 0);
            if is_rounding(at, column) {
                column.fill(0.0);
            }
        });
    }
}

/// Sets inertial loads on the interior to zero that are rounding: Σ l_i² / M_ii at most (10 ε)² of `terms`, |u|ᵀ|M||u| of each motion.
pub(crate) fn clear_unloaded(partition: &Partition, terms: &[f64], mut loads: MatMut<'_, f64>) {
    let mass = partition.internal().mass.diagonal();
    for (j, terms) in terms.iter().enumerate() {
        let load = dense::column_mut(loads.as_mut(), j);
        let of_dof = |(l, m): (&f64, &f64)| if *m > 0.0 { l * l / m } else { 0.0 };
        if load.iter().zip(&mass).map(of_dof).sum::<f64>() <= UNKNOWN * terms {
            load.fill(0.0);
        }
    }
}
