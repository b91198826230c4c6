//! Constraints of few digits, set right within these digits.
//!
//! ```text
//! g    n_t        factors of one constraint
//! C    n_t × 6    the six unit motions of its rows about their middle
//! h    n_t        half a unit of the last digit of each factor
//! (g + d)ᵀC = 0, Σ (dᵢ/hᵢ)² least:  d = H z,  B = H C = U S Vᵀ,  z = −U S⁻¹ Vᵀ Cᵀg
//! ```
//! A constraint between nodes lets rigid-body motion pass, and one that was written with few digits does but for these. As it stands it holds
//! rotations by next to nothing: they would be neither without energy nor elastic, and nothing told from the stiffness says which. The digits
//! that were lost are those that let rigid-body motion pass, as far as anybody knows. A tie of nodes that are apart has no such digits.

use faer::Mat;

use super::constraint_ground::{EXACT, Motions, Resisting};
use crate::dense;
use crate::error::Result;
use crate::input::decimal::Decimal;
use crate::input::{Constraint, ConstraintRows};
use crate::model::Finding;

/// Digits that factors are taken to have at least.
const FEWEST: i32 = 4;
/// Half a unit of the last of these: what is resisted more is no rounding.
const ROUNDED: f64 = 5e-4;
/// What is resisted less is rounding of doubles. Up to [`EXACT`] nobody needs to know of it, and recovered rows are as exact as any.
const OF_DOUBLES: f64 = 1e-13;
/// Digits of a double; a factor that needs as many was not rounded to fewer.
const OF_DOUBLE: i32 = 16;
/// Roundings that each factor may be off by in the mean: its own, and that of the coordinates that it was made of.
const ROUNDINGS: f64 = 2.0;
/// Share of itself that a factor may change by: a half, and what rounding makes of that.
const MOST_OF_A_FACTOR: f64 = 0.5 + 1e-9;
/// Singular values of unit columns, relative to the largest, that are rounding of coordinates: nodes in line turn about none.
const NOTHING: f64 = 1e-9;

/// Constraints with those set right that digits alone keep from letting rigid-body motion pass.
pub(super) struct SetRight {
    pub(super) rows: ConstraintRows,
    /// What their digits leave open of the factors of each that was set right.
    pub(super) open: Vec<Option<Constraint>>,
    /// What is to be said of them.
    pub(super) finding: Option<Finding>,
}

/// Sets right what digits alone keep from letting rigid-body motion pass.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(super) fn set_right(motions: &Motions<'_>, given: &ConstraintRows) -> Result<SetRight> {
    let (mut rows, mut open) = (given.clone(), vec![None; given.list.len()]);
    let mut worst: Option<(Resisting<'_>, f64)> = None;
    let mut n_rows = 0;
    if !motions.are_placed() {
        return Ok(SetRight { rows, open, finding: None });
    }
    for ((constraint, own), open) in given.list.iter().zip(&mut rows.list).zip(&mut open) {
        let resisting = motions.resisted(constraint, OF_DOUBLES).filter(|resisting| resisting.share <= ROUNDED);
        let Some(resisting) = resisting else { continue };
        let half_units = half_units(&constraint.terms);
        // Factors that are what rounding left of nothing resist other motions than the rest, by next to nothing and by more than digits of
        // their own explain.
        let mut right = None;
        for least in [OF_DOUBLES, EXACT] {
            right = within_digits(motions, constraint, (&half_units, least))?
                .filter(|right| motions.resisted(right, EXACT).is_none());
            if right.is_some() {
                break;
            }
        }
        let Some(right) = right else { continue };
        let of_rows = constraint.terms.iter().zip(&half_units).map(|((row, _), half_unit)| (*row, *half_unit));
        *open = Some(Constraint { row: constraint.row, terms: of_rows.collect() });
        let change = change(constraint, &right);
        *own = right;
        if resisting.share <= EXACT {
            continue;
        }
        n_rows += 1;
        if worst.as_ref().is_none_or(|(worst, _)| resisting.share > worst.share) {
            worst = Some((resisting, change));
        }
    }
    let finding = worst.map(|(resisting, change)| {
        let (row, dofs) = (resisting.constraint.row + 1, resisting.constraint.dofs(motions.names()).join(", "));
        Finding::ConstraintMended { row, dofs, motion: resisting.name(), n_rows, share: resisting.share, change }
    });
    Ok(SetRight { rows, open, finding })
}

/// The constraint that lets all motions pass and is nearest to this one by its digits; none where these do not reach it. What it resists by
/// no more than a share `least` stays so.
fn within_digits(
    motions: &Motions<'_>,
    constraint: &Constraint,
    (half_units, least): (&[f64], f64),
) -> Result<Option<Constraint>> {
    let (terms, middle) = (&constraint.terms, motions.middle(constraint));
    let of_rows: Vec<[f64; 6]> = terms.iter().map(|(row, _)| motions.at(*row as usize, middle)).collect();
    let shares = motions.shares(constraint, middle);
    let weighted = Mat::from_fn(terms.len(), 6, |i, j| half_units[i] * of_rows[i][j]);
    let norms: Vec<f64> = (0..6).map(|j| dense::norm(dense::column(weighted.as_ref(), j))).collect();
    let moving: Vec<usize> = (0..6).filter(|j| norms[*j] > 0.0).collect();
    // No fewer rows than columns.
    let n_rows = terms.len().max(moving.len());
    let unit = Mat::from_fn(n_rows, moving.len(), |i, j| {
        if i < terms.len() { weighted[(i, moving[j])] / norms[moving[j]] } else { 0.0 }
    });
    let sum = |j: usize| terms.iter().zip(&of_rows).map(|((_, value), of)| value * of[j]).sum::<f64>();
    let left = |j: &usize| if shares[*j] > least { sum(*j) / norms[*j] } else { 0.0 };
    let left: Vec<f64> = moving.iter().map(left).collect();
    let (singular, directions) = dense::right_singular(unit.as_ref())?;
    let mut steps = vec![0.0; terms.len()];
    for (k, size) in singular.iter().enumerate().filter(|(_, size)| **size > NOTHING * singular[0]) {
        let along: f64 = (0..moving.len()).map(|j| directions[(j, k)] * left[j]).sum::<f64>() / size.powi(2);
        for (i, step) in steps.iter_mut().enumerate() {
            *step -= along * (0..moving.len()).map(|j| unit[(i, j)] * directions[(j, k)]).sum::<f64>();
        }
    }
    if dense::norm(&steps) > ROUNDINGS * (terms.len() as f64).sqrt() {
        return Ok(None);
    }
    // A number that was rounded to what is there is at least half of it: another would not be this constraint.
    let mut changed = terms.iter().zip(half_units.iter().zip(&steps));
    if changed.any(|((_, value), (half_unit, step))| (half_unit * step).abs() > MOST_OF_A_FACTOR * value.abs()) {
        return Ok(None);
    }
    let right = terms.iter().zip(half_units.iter().zip(&steps));
    let right = right.map(|((row, value), (half_unit, step))| (*row, value + half_unit * step)).collect();
    Ok(Some(Constraint { row: constraint.row, terms: right }))
}

/// Half a unit of the last digit of each factor. The longest of them tells how many digits all have, or how many decimals: of few factors it
/// is not known which, and it is the coarser.
fn half_units(terms: &[(u32, f64)]) -> Vec<f64> {
    let forms: Vec<Decimal> = terms.iter().map(|(_, value)| Decimal::of(*value)).collect();
    let n_digits = forms.iter().fold(FEWEST, |most, form| most.max(form.n_digits as i32));
    let n_decimals = forms.iter().map(|form| form.n_decimals()).max().unwrap_or(0);
    let exponent = forms.iter().map(|form| form.exponent).max().unwrap_or(0);
    let of_decimals = half(-n_decimals.max(FEWEST - 1 - exponent));
    let are_single = terms.iter().all(|(_, value)| f64::from(*value as f32) == *value);
    let of_each = |((_, value), form): (&(u32, f64), &Decimal)| match n_digits < OF_DOUBLE {
        true => half(form.exponent + 1 - n_digits).max(of_decimals),
        false if are_single => f64::from(f32::EPSILON) / 2.0 * value.abs(),
        false => f64::EPSILON * value.abs(),
    };
    terms.iter().zip(&forms).map(of_each).collect()
}

/// Half of a power of ten.
fn half(exponent: i32) -> f64 {
    0.5 * 10f64.powi(exponent)
}

/// By how much of the largest factor another was changed at most.
fn change(constraint: &Constraint, right: &Constraint) -> f64 {
    let largest = constraint.terms.iter().fold(0.0f64, |max, (_, value)| max.max(value.abs()));
    let changes = constraint.terms.iter().zip(&right.terms).map(|((_, from), (_, to))| (to - from).abs());
    changes.fold(0.0, f64::max) / largest
}
