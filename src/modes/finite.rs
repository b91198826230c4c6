//! The number of finite eigenvalues, which is the rank of M.
//!
//! A search that ends with fewer modes than were asked for has found all there are, or has lost some. A count far above the
//! spectrum decides for eigenvalues below its shift; the rank of M decides without a shift.

use super::boundary_problem::BoundaryProblem;
use crate::eigen::ratios;
use crate::eigen::rows_with_mass;
use crate::error::Result;
use crate::factor::{Analysis, rank};

/// λ of a mesh is at most this many times the largest K_ii/M_ii: M of an element is within 10² of its diagonal, and a row of
/// K has at most 10² entries.
const ABOVE_ALL: f64 = 1e4;

/// A shift above the spectrum of any mesh with these diagonals.
pub(super) fn above_all(problem: &BoundaryProblem<'_>) -> f64 {
    ABOVE_ALL * ratios(problem.modal()).last().copied().unwrap_or(1.0)
}

/// Finite eigenvalues there are at most, those of zero modes included, where `n_found` are known.
///
/// Rows with mass bound the rank of M in exact arithmetic. Where there are more of them than eigenvalues known, M itself is
/// counted: whether what lies within its rounding is mass cannot be known.
///
/// # Errors
/// No memory for a factor.
pub(super) fn most_finite(problem: &BoundaryProblem<'_>, n_found: usize) -> Result<usize> {
    let modal = problem.modal();
    let n_rows = rows_with_mass(modal.mass);
    if n_rows <= n_found {
        return Ok(n_rows);
    }
    let analysis = Analysis::new(modal.pencil())?;
    Ok(rank(&analysis, modal.mass, modal.precision.mass).map_or(n_rows, |rank| rank.min(n_rows)))
}
