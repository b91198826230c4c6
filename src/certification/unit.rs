//! Frequencies that are said to be in a unit, and by their shapes are in another.

use super::claims::Claims;
use super::measured::Measured;
use crate::error::{Error, Result};
use crate::input::ValueUnit;
use crate::partition::Partition;

/// Relative difference of frequencies up to which a number belongs to its shape: units differ by more, and so do modes that an
/// iteration has not found well by less.
const AGREES: f64 = 1e-2;
/// Share of the numbers that have to agree in another unit.
const NEARLY_ALL: f64 = 0.9;

/// Refuses frequencies of which most are not those of their shapes in the unit that was stated, and nearly all are in another one.
///
/// # Errors
/// [`Error::ValuesUnit`].
pub(super) fn refuse_other(partition: &Partition, claims: &Claims, measured: &Measured) -> Result<()> {
    let Some(stated) = claims.unit else { return Ok(()) };
    let unit = partition.scaling.eigenvalue_unit();
    // What is nearly rigid-body motion has the same number in every unit.
    let elastic: Vec<usize> = (0..claims.count())
        .filter(|j| claims.has_mass[*j] && measured.rigid_share(*j) < 0.5 && measured.lambda[*j] > 0.0)
        .collect();
    let n_agree = |of_number: &dyn Fn(f64) -> f64| {
        let agrees = |j: &&usize| {
            let ratio = of_number(claims.numbers[**j]) / (measured.lambda[**j] * unit);
            (ratio.max(0.0).sqrt() - 1.0).abs() <= AGREES
        };
        elastic.iter().filter(agrees).count()
    };
    if 2 * n_agree(&|number| stated.eigenvalue(number)) >= elastic.len() {
        return Ok(());
    }
    let is_found = |n_agree: usize| n_agree as f64 >= NEARLY_ALL * elastic.len() as f64;
    let refused = |n_agree: usize, found: &str, flag: &str| {
        let (found, flag) = (found.to_owned(), flag.to_owned());
        Err(Error::ValuesUnit { stated: stated.name(), found, n_agree, n_modes: elastic.len(), flag })
    };
    for other in ValueUnit::ALL.into_iter().filter(|other| *other != stated) {
        let n = n_agree(&|number| other.eigenvalue(number));
        if is_found(n) {
            return refused(n, other.name(), flag_of(other));
        }
    }
    let n = n_agree(&|number| ValueUnit::Hertz.eigenvalue(1e3 * number));
    if is_found(n) {
        return refused(n, "frequencies in kHz", "--hz with numbers in Hz");
    }
    Ok(())
}

fn flag_of(unit: ValueUnit) -> &'static str {
    match unit {
        ValueUnit::Hertz => "--hz",
        ValueUnit::RadPerSecond => "--rad-per-s",
        ValueUnit::Eigenvalue => "--eigenvalues",
    }
}
