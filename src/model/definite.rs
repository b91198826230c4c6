//! Whether a mass matrix can belong to a structure: no motion may have a negative kinetic energy.
//!
//! ```text
//! D M D        n × n    D = diag(1/√M_ii): every dof of unit mass
//! ```
//! Pairs first, exactly: |M_ij| > √(M_ii M_jj) makes a 2 × 2 minor negative. What only several dofs together show, some
//! steps of Lanczos show: they need products alone, and a Ritz value is the energy of an actual motion, so that a negative
//! one is proof. An isolated negative eigenvalue, the mark of a wrong entry, is what Lanczos finds first.

use faer::Mat;

use crate::dense;
use crate::dofs::RowNames;
use crate::error::{Error, Result};
use crate::random::SplitMix64;
use crate::sparse::diagonal;
use crate::sparse::{Rounding, SparseMatrix, energies_of_terms, product};

/// Steps of Lanczos: an eigenvalue a tenth of the spectrum's width outside of it converges by e⁻¹⁵ in them.
const STEPS: usize = 30;
/// Relative energies above minus this are rounding of the program that wrote the matrix, in binary data.
const ROUNDING: f64 = 1e-9;
/// Units of the last digit of the data that the energy of a motion may be off by: the entries of a row, with one sign.
const DIGITS: f64 = 100.0;

/// Refuses a mass matrix that is indefinite beyond the precision of its data.
pub(super) fn refuse_indefinite(mass: &SparseMatrix, rounding: Rounding, names: RowNames<'_>) -> Result<()> {
    let least = -ROUNDING.max(DIGITS * rounding.relative);
    let diagonal = diagonal(mass);
    let largest = diagonal.iter().fold(0.0f64, |max, value| max.max(*value));
    let negligible = diagonal.len() as f64 * f64::EPSILON * largest;
    let mut is_diagonal = true;
    for (row, view) in mass.outer_iterator().enumerate() {
        for (col, value) in view.iter().filter(|(col, value)| *col < row && **value != 0.0) {
            is_diagonal = false;
            let limit = (diagonal[row] * diagonal[col]).sqrt();
            let energy = if limit > 0.0 { 1.0 - value.abs() / limit } else { f64::NEG_INFINITY };
            // A diagonal of few decimals is uncertain itself.
            let uncertain = rounding.absolute / diagonal[row].min(diagonal[col]).max(f64::MIN_POSITIVE);
            if energy < least - DIGITS * uncertain && value.abs() > negligible {
                let column = format!("column {}{}", names.number(col), names.bracketed(col));
                let place = format!("worst at {}, {column}", names.full(row));
                return Err(Error::IndefiniteMass { place, energy });
            }
        }
    }
    if is_diagonal {
        return Ok(());
    }
    let scale: Vec<f64> = diagonal.iter().map(|m| if *m > 0.0 { 1.0 / m.sqrt() } else { 0.0 }).collect();
    let lanczos = Lanczos { mass, scale: &scale };
    let tridiagonal = lanczos.run(&mut |_, _| {});
    let (values, vectors) = dense::symmetric_eigen(tridiagonal.as_ref())?;
    let (Some(energy), Some(most)) = (values.first().copied(), values.last()) else {
        return Ok(());
    };
    if energy >= least * most {
        return Ok(());
    }
    // Only now is the motion itself of interest: the same steps again, summed with the weights of the Ritz vector.
    let mut motion = vec![0.0; scale.len()];
    lanczos.run(&mut |step, unit| dense::add_scaled(&mut motion, vectors[(step, 0)], unit));
    if rounding.is_beyond_entries()
        && -energy * dense::dot(&motion, &motion) <= noise(mass, rounding, (&scale, &motion))
    {
        return Ok(());
    }
    let row = (0..motion.len()).max_by(|a, b| motion[*a].abs().total_cmp(&motion[*b].abs())).unwrap_or(0);
    let place = format!("in a motion that is largest at {}", names.full(row));
    Err(Error::IndefiniteMass { place, energy })
}

/// What roundings of M, all with one sign, can make of the energy of a motion in scaled dofs.
fn noise(mass: &SparseMatrix, rounding: Rounding, (scale, motion): (&[f64], &[f64])) -> f64 {
    let x = Mat::from_fn(motion.len(), 1, |i, _| scale[i] * motion[i]);
    energies_of_terms(x.as_ref(), rounding.terms(mass.into(), x.as_ref()).as_ref()).into_iter().sum()
}

struct Lanczos<'a> {
    mass: &'a SparseMatrix,
    scale: &'a [f64],
}

impl Lanczos<'_> {
    /// The tridiagonal matrix of the steps, from a fixed random start; every unit vector is shown on its way.
    fn run(&self, see: &mut dyn FnMut(usize, &[f64])) -> Mat<f64> {
        let n = self.scale.len();
        let mut unit = Mat::zeros(n, 1);
        SplitMix64::new(crate::random::SEED).fill(unit.as_mut());
        for (value, scale) in dense::column_mut(unit.as_mut(), 0).iter_mut().zip(self.scale) {
            *value *= f64::from(u8::from(*scale > 0.0));
        }
        let (mut diagonal, mut off_diagonal) = (Vec::new(), Vec::<f64>::new());
        let mut before = vec![0.0; n];
        let mut length = dense::norm(dense::column(unit.as_ref(), 0));
        for step in 0..STEPS.min(n) {
            dense::column_mut(unit.as_mut(), 0).iter_mut().for_each(|value| *value /= length);
            see(step, dense::column(unit.as_ref(), 0));
            let mut next = self.apply(&unit);
            let along = dense::dot(dense::column(unit.as_ref(), 0), &next);
            dense::add_scaled(&mut next, -along, dense::column(unit.as_ref(), 0));
            if let Some(beta) = off_diagonal.last() {
                dense::add_scaled(&mut next, -*beta, &before);
            }
            diagonal.push(along);
            length = dense::norm(&next);
            // Nothing but rounding is left: the space is exhausted.
            if length.is_nan() || length <= 1e-10 * along.abs() {
                break;
            }
            off_diagonal.push(length);
            before.copy_from_slice(dense::column(unit.as_ref(), 0));
            dense::column_mut(unit.as_mut(), 0).copy_from_slice(&next);
        }
        let m = diagonal.len();
        Mat::from_fn(m, m, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => off_diagonal[i.min(j)],
            _ => 0.0,
        })
    }

    /// D M D x.
    fn apply(&self, x: &Mat<f64>) -> Vec<f64> {
        let scaled = Mat::from_fn(x.nrows(), 1, |i, _| self.scale[i] * x[(i, 0)]);
        let image = product(self.mass, scaled.as_ref());
        dense::column(image.as_ref(), 0).iter().zip(self.scale).map(|(value, scale)| value * scale).collect()
    }
}
