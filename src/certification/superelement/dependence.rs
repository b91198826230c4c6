//! Whether the columns of a basis are independent, and K̂ and M̂ not singular together: C-11.
//!
//! ```text
//! G    Ψᵀ diag(K) Ψ   singular where a column is made up of others; a row without stiffness counts by its mass, times the least
//!                     K_jj / M_jj of the other rows
//! H    K̂ + M̂         singular where a motion has neither stiffness nor mass
//! ```
//! Both, and in H both terms, are brought to unit diagonal first, where that is more than rounding. A mass that is singular by itself is
//! none the worse, and neither is rigid-body motion.

use faer::{Mat, MatRef};

use super::foreign::{Foreign, Pair};
use crate::certification::listing::first_of;
use crate::dense;
use crate::eigen::lowest_ratio_of;
use crate::error::Result;
use crate::partition::Partition;
use crate::sparse::diagonal;
use crate::verification::check::{Check, Limits};

/// Digits that a solution has left at a condition of this over ε.
const LEFT: [f64; 2] = [1e-6, 1e-3];
/// Share of the largest coordinate of a motion from which on one is named.
const NAMED: f64 = 0.1;
/// Coordinates that are named.
const LISTED: usize = 4;

/// C-11.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn check(partition: &Partition, foreign: &Foreign) -> Result<Check> {
    let of_basis = Condition::of(of_columns(partition, foreign).as_ref())?;
    let of_matrices = Condition::of(sum_at_unit_diagonal([&foreign.stiffness, &foreign.mass]).as_ref())?;
    let Condition { value, weakest } = if of_matrices.value > of_basis.value { of_matrices } else { of_basis };
    let [limit, fail_above] = LEFT.map(|left| left / f64::EPSILON);
    Ok(Check {
        id: "C-11",
        name: "columns of the basis are independent",
        equation: "condition of Ψᵀ diag(K) Ψ, or of K̂ + M̂ with each at unit diagonal, whichever is worse",
        value,
        limits: Limits { engineering: limit, ..Limits::default() },
        fail_above,
        worst: Some(named(foreign, &weakest)),
    })
}

fn of_columns(partition: &Partition, foreign: &Foreign) -> Mat<f64> {
    let [stiffness, mass] = [&partition.stiffness, &partition.mass].map(diagonal);
    let of_mass = lowest_ratio_of(stiffness.iter().copied().zip(mass.iter().copied())).unwrap_or(1.0);
    let weight = |i: usize| if stiffness[i] > 0.0 { stiffness[i] } else { of_mass * mass[i].max(0.0) };
    let basis = &foreign.basis;
    let weighted = Mat::from_fn(basis.nrows(), basis.ncols(), |i, j| weight(i).sqrt() * basis[(i, j)]);
    dense::gram(weighted.as_ref(), weighted.as_ref())
}

/// H of K̂ and M̂.
fn sum_at_unit_diagonal(matrices: [&Pair; 2]) -> Mat<f64> {
    let [k, m] = matrices.map(Pair::at_unit_diagonal);
    Mat::from_fn(k.nrows(), k.nrows(), |i, j| k[(i, j)] + m[(i, j)])
}

/// The condition of a matrix at unit diagonal.
struct Condition {
    value: f64,
    /// The motion that has least of it, in the coordinates as they are.
    weakest: Vec<f64>,
}

impl Condition {
    fn of(a: MatRef<'_, f64>) -> Result<Self> {
        let (scaled, _) = dense::unit_diagonal(a);
        let (values, vectors) = dense::symmetric_eigen(scaled.as_ref())?;
        let (Some(least), Some(most)) = (values.first(), values.last()) else {
            return Ok(Self { value: 1.0, weakest: Vec::new() });
        };
        let value = if *least > 0.0 { (most / least).min(1.0 / f64::EPSILON) } else { 1.0 / f64::EPSILON };
        Ok(Self { value, weakest: dense::column(vectors.as_ref(), 0).to_vec() })
    }
}

/// The coordinates that a motion is made of, the largest first.
fn named(foreign: &Foreign, motion: &[f64]) -> String {
    let largest = motion.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let mut of_it: Vec<usize> = (0..motion.len()).filter(|at| motion[*at].abs() >= NAMED * largest).collect();
    of_it.sort_by(|a, b| motion[*b].abs().total_cmp(&motion[*a].abs()).then(a.cmp(b)));
    format!("together {}", first_of(of_it.iter().map(|at| foreign.name(*at)), (LISTED, of_it.len())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_may_be_singular_by_itself_and_not_together_with_the_stiffness() {
        let value = |k: [[f64; 2]; 2], m: [[f64; 2]; 2]| {
            let [k, m] = [k, m].map(|a| {
                let given = Mat::from_fn(2, 2, |i, j| a[i][j]);
                let (projected, terms) = (given.clone(), vec![2e9; 2]);
                Pair { sizes: given.clone(), given, projected, terms, asymmetry: 0.0, rounding: [0.0; 2] }
            });
            Condition::of(sum_at_unit_diagonal([&k, &m]).as_ref()).expect("converges").value
        };
        // A coordinate without mass, of any stiffness.
        assert!(value([[1e9, 0.0], [0.0, 1.0]], [[2.0, 0.0], [0.0, 0.0]]) < 10.0);
        // Rigid-body motion has no stiffness, and mass.
        assert!(value([[1e9, -1e9], [-1e9, 1e9]], [[2.0, 0.0], [0.0, 3.0]]) < 10.0);
        // Of two rigid-body motions K̂ has nothing but rounding, which no diagonal of rounding scales up.
        assert!(value([[1e-9, 1e-7], [1e-7, -1e-9]], [[2.0, 0.0], [0.0, 3.0]]) < 10.0);
        // Neither.
        assert!(value([[1e9, -1e9], [-1e9, 1e9]], [[2.0, -2.0], [-2.0, 2.0]]) > LEFT[1] / f64::EPSILON);
    }
}
