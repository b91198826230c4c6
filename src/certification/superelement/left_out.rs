//! Modes that a superelement left out of those it is made of: C-12.
//!
//! Every superelement of modes has some modes of its component exactly: Craig and Bampton's those with the interface held, Herting's and
//! Rubin's those with it free. Up to the highest of them none may be missing. A mode that is lost is not gone from the basis: static
//! columns make up for most of its shape, and what is left of it is a frequency that is far off. One that is there with a share of others, as
//! an eigensolver that stops early leaves, or the digits of the basis, has a frequency that is off by the square of that share: up to the δ
//! at which certified pairs are taken for eigenvectors it is not left out.

use super::files::ForeignSuperelement;
use super::interface::Interface;
use crate::certification::certified::certified_pairs;
use crate::certification::claims::Claims;
use crate::certification::independence::RECOGNISED;
use crate::certification::listing::first_of;
use crate::certification::measured::Measured;
use crate::certification::pair::MissingMode;
use crate::certification::rounding::{MOST_OF_DIGITS, of_rounding};
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;
use crate::input::ForeignModes;
use crate::job::ReductionJob;
use crate::modes::{Component, Search};
use crate::number::{counted, quantity};
use crate::verification::check::{Check, Limits};

/// Backward error of a shape that is a mode exactly: that at which M-01 fails.
const EXACT: f64 = 1e-6;
/// Modes that the check names.
const LISTED: usize = 6;

/// How the interface is where a superelement has modes of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// At rest.
    Held,
    /// Free, as the component is.
    Free,
}

/// The modes of its own that a superelement has, and those that it left out.
#[derive(Clone, Debug)]
pub struct LeftOut {
    own: Own,
    /// How many it has.
    n_own: usize,
    /// The highest of them, in Hz.
    up_to_hz: f64,
    missing: Vec<MissingMode>,
    /// Modes missing beyond those that were looked for.
    n_not_sought: usize,
}

/// What modes of its own a superelement has in a component that is held at the interface, or free. None where they are fewer than half of its
/// amplitudes: it is made of something else. Of a free superelement the first `n_rigid` motions are no modes.
///
/// # Errors
/// Those of the counts and searches.
pub fn left_out(
    component: Component<'_>,
    job: &ReductionJob,
    (given, interface): (&ForeignSuperelement, &Interface),
    (own, n_rigid): (Own, usize),
) -> Result<Option<LeftOut>> {
    let amplitudes: Vec<usize> = {
        let rows: Vec<usize> = interface.coordinates.values().copied().collect();
        (0..given.n_coordinates()).filter(|coordinate| !rows.contains(coordinate)).collect()
    };
    let moving = if own == Own::Held { amplitudes.clone() } else { (0..given.n_coordinates()).collect() };
    let Some(modes) = modes_of(given, &moving, (n_rigid, 2 * amplitudes.len()))? else { return Ok(None) };
    let claims = Claims::of(component.partition, &modes, None)?;
    let problem = Search::new(component, job)?.problem;
    let measured = problem.with_definite_operator(|operator| Ok(Measured::of(problem.modal(), operator, &claims)))?;
    let exact: Vec<usize> = (0..claims.count()).filter(|mode| is_exact(&claims, &measured, *mode)).collect();
    if exact.is_empty() || 2 * exact.len() < amplitudes.len() {
        return Ok(None);
    }
    let highest = exact.iter().map(|mode| measured.lambda[*mode]).fold(0.0, f64::max);
    let is_there = |mode: &usize| {
        is_exact(&claims, &measured, *mode)
            || measured.lambda[*mode] <= highest && measured.lacking[*mode] <= RECOGNISED
    };
    let there: Vec<usize> = (0..claims.count()).filter(is_there).collect();
    let found = certified_pairs(component, job, &claims.only(&there), None)?;
    Ok(Some(LeftOut {
        own,
        n_own: there.len(),
        up_to_hz: found.band_hz[1],
        missing: found.missing,
        n_not_sought: found.n_not_sought,
    }))
}

/// Whether a shape is a mode exactly, as far as the digits of the basis tell.
fn is_exact(claims: &Claims, measured: &Measured, mode: usize) -> bool {
    let of_digits = of_rounding(claims, measured, mode).min(MOST_OF_DIGITS.sqrt());
    measured.backward[mode] <= EXACT || measured.lacking[mode] <= of_digits
}

/// The lowest modes of K̂ and M̂ with some coordinates moving, as motions of the rows of the files: `n` behind the first few. None where
/// the matrices have none.
fn modes_of(given: &ForeignSuperelement, moving: &[usize], (first, n): (usize, usize)) -> Result<Option<ForeignModes>> {
    let [k, m] = [&given.stiffness, &given.mass].map(|matrix| {
        let mut part = dense::part(matrix.values.as_ref(), moving);
        dense::symmetrise(&mut part);
        part
    });
    let quotients = (0..moving.len()).map(|at| k[(at, at)] / m[(at, at)]);
    let least = quotients.filter(|lambda| *lambda > 0.0 && lambda.is_finite()).fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return Ok(None);
    }
    let Some(spectral) = Spectral::if_definite(k.as_ref(), m.as_ref(), least)? else { return Ok(None) };
    let n_modes = spectral.eigenvalues().len();
    let modes: Vec<Vec<f64>> = (first.min(n_modes)..(first + n).min(n_modes))
        .map(|mode| motion(given, moving, &spectral.eigenvector(mode)))
        .filter(|motion| motion.iter().any(|value| *value != 0.0))
        .collect();
    Ok((!modes.is_empty()).then(|| ForeignModes { columns: modes, values: None, program: None, ..given.basis.clone() }))
}

/// Σ ψ_j q_j.
fn motion(given: &ForeignSuperelement, moving: &[usize], q: &[f64]) -> Vec<f64> {
    let mut motion = vec![0.0; given.basis.columns.first().map_or(0, Vec::len)];
    // Of unit length, so that roundings of columns, which add up like the root of their squares, are what they are in each of them.
    let length = q.iter().map(|value| value * value).sum::<f64>().sqrt();
    let share = |value: &f64| if length > 0.0 { value / length } else { 0.0 };
    moving
        .iter()
        .zip(q)
        .for_each(|(at, value)| dense::add_scaled(&mut motion, share(value), &given.basis.columns[*at]));
    motion
}

impl LeftOut {
    /// C-12. Modes that were left out on purpose are a warning, unless frequencies of the component in the band show that they are needed.
    pub(super) fn check(&self, is_needed: impl FnOnce() -> bool) -> Check {
        let n_missing = self.missing.len() + self.n_not_sought;
        let held = match self.own {
            Own::Held => "with the interface held",
            Own::Free => "of the free component",
        };
        let named = self.missing.iter().map(|mode| format!("{} Hz", quantity(mode.frequency_hz, 7)));
        let listed = first_of(named, (LISTED, n_missing));
        let has = format!("{} {held} up to {} Hz", counted(self.n_own, "mode", "modes"), quantity(self.up_to_hz, 7));
        Check {
            id: "C-12",
            name: "none of its own modes is left out",
            equation: "modes of the component up to the highest that the superelement has exactly, less those that it has",
            value: n_missing as f64,
            limits: Limits::default(),
            fail_above: if n_missing > 0 && is_needed() { 0.0 } else { Check::NEVER },
            worst: Some(match listed.is_empty() {
                true => format!("it has all {has}"),
                false => format!("{listed}, left out of the {has}"),
            }),
        }
    }
}
