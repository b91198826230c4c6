//! How far the entries of a matrix may be from what their program computed.
//!
//! ```text
//! |E_ij| ≤ max(relative |A_ij|, absolute)               an entry that was rounded as a whole
//! |E_ij| ≤ max(relative √(A_ii A_jj), absolute)         a sum of parts that were rounded each by itself
//! ```
//! Digits after the first one of a number make a relative rounding, digits after the decimal point an absolute one. Parts of a sum may
//! cancel, and their roundings do not: those of semidefinite element matrices have Σ|a_ij| ≤ Σ√(a_ii a_jj) ≤ √(A_ii A_jj) by Cauchy and
//! Schwarz.

use faer::{Mat, MatRef};

use super::leading::{Leading, ends};
use super::product::absolute_product;
use super::turning::TurnedRoundings;
use crate::error::{Error, Uncertain};

/// Share of its own size that half a unit of the last digit is at least, in units of that of the smallest number of as many digits:
/// single precision counts as seven digits, and is coarser than these where the first of them is a nine.
const LEAST_SHARE: f64 = 1.0 / 8.0;

/// Triangles of a matrix that differ beyond its digits: where they do most, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differing {
    /// |A_ij − A_ji| / √(A_ii A_jj).
    pub of_rows: f64,
    /// Row and column of that in the file, from one.
    pub at: [usize; 2],
}

/// Bounds on the roundings of the entries of a matrix, in its own units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// Relative to an entry: half a unit of the last decimal digit of the smallest number of as many digits, or ε/2 for binary data.
    pub relative: f64,
    /// Of every entry whatever its size: half a unit of the last decimal of fixed point; zero for all other data.
    pub absolute: f64,
    /// Whether entries are sums of numbers that were rounded before they were added.
    pub is_of_parts: bool,
    /// How many of these numbers are of one size at most, and round alike.
    pub n_alike: f64,
    /// The largest share that the roundings of a row can have in its sum of moduli: `relative` where nothing is absolute. For where one
    /// number has to stand for the matrix.
    pub share: f64,
    /// Why entries are known no better, where it is not for their digits.
    pub differing: Option<Differing>,
    /// How many times ε/2 entries may be off from those that follow exactly from the numbers of the files, relative to max(|A_ij|, √(A_ii A_jj)):
    /// numbers were added up or turned. None of entries as they were read.
    pub made: f64,
}

impl Rounding {
    /// Of data in double precision.
    pub const BINARY: Self = Self::relative(f64::EPSILON / 2.0);

    /// Of entries that were rounded to a share of themselves.
    pub const fn relative(relative: f64) -> Self {
        let n_alike = f64::INFINITY;
        Self { relative, absolute: 0.0, is_of_parts: false, n_alike, share: relative, differing: None, made: 0.0 }
    }

    /// Of entries that this many more roundings of arithmetic have made.
    #[must_use]
    pub fn made_by(self, roundings: f64) -> Self {
        Self { made: self.made + roundings, ..self }
    }

    /// With `share` as this matrix has it. Rows without entries do not count, and no row is more than uncertain.
    pub fn measured(self, matrix: Leading<'_>) -> Self {
        if self.absolute == 0.0 && !self.is_of_parts {
            return Self { share: self.relative, ..self };
        }
        let diagonal = matrix.diagonal();
        let of_row = |row: usize| {
            let sum: f64 = matrix.entries(row).map(|(_, value)| value.abs()).sum();
            if sum > 0.0 { self.of_row(matrix, &diagonal, row) / sum } else { 0.0 }
        };
        let share = (0..matrix.rows()).map(of_row).fold(self.relative, f64::max);
        Self { share: share.min(1.0), ..self }
    }

    /// Of the matrix with some of its rows turned. Entries there are sums; those of double precision are rounded once more, to as much.
    #[must_use]
    pub fn turned(self, turned: TurnedRoundings) -> Self {
        // An entry is rounded once, or left out: that counts with the diagonal.
        let made = self.made * turned.enlargement + 1.0 + turned.left_out / (0.5 * f64::EPSILON);
        // Of the nine entries that make one up to three in each row of T count in full.
        let of_parts = Self { absolute: 3.0 * self.absolute, is_of_parts: true, n_alike: f64::INFINITY, made, ..self };
        if !self.is_coarse() {
            return of_parts;
        }
        let relative = (self.relative * turned.enlargement).min(1.0);
        Self { relative, share: relative, ..of_parts }
    }

    /// At least that share of √(A_ii A_jj).
    #[must_use]
    pub fn of_parts(self, share: f64) -> Self {
        let relative = self.relative.max(share);
        Self { relative, share: relative, is_of_parts: true, n_alike: f64::INFINITY, ..self }
    }

    /// With entries that are known no better than two triangles agree.
    #[must_use]
    pub fn of_differing(self, differing: Differing) -> Self {
        // The mean of two entries is rounded.
        Self { differing: Some(differing), ..self.of_parts(0.5 * differing.of_rows).made_by(1.0) }
    }

    /// The error of what the entries do not tell.
    pub fn too_uncertain(self, what: String) -> Error {
        Error::DigitsTooFew { cause: self.cause(), what, known: self.in_words() }
    }

    /// Why entries are known no better.
    pub fn cause(self) -> Uncertain {
        if self.differing.is_some() { Uncertain::Triangles } else { Uncertain::Digits }
    }

    /// Whether the entries were rounded to fewer digits than double precision has.
    pub fn is_coarse(self) -> bool {
        self.relative > f64::EPSILON || self.absolute > 0.0
    }

    /// Whether an entry may be off by more than a share of itself.
    pub fn is_beyond_entries(self) -> bool {
        self.absolute > 0.0 || self.is_of_parts
    }

    /// What roundings are relative to: the size of an entry, or with `ends` = √(A_ii A_jj) that of its parts.
    pub fn size_of(self, value: f64, ends: f64) -> f64 {
        if self.is_of_parts { value.abs().max(ends) } else { value.abs() }
    }

    /// Bound on the rounding of an entry, `ends` = √(A_ii A_jj).
    pub fn of_entry(self, value: f64, ends: f64) -> f64 {
        (self.relative * self.size_of(value, ends)).max(self.absolute)
    }

    /// Sum of the bounds of a row.
    pub fn of_row(self, matrix: Leading<'_>, diagonal: &[f64], row: usize) -> f64 {
        matrix.entries(row).map(|(col, value)| self.of_entry(value, ends(diagonal, row, col))).sum()
    }

    /// What roundings can make of A x, all with one sign: Σ_j |E_ij| |x_j|, n × k.
    pub fn terms(self, matrix: Leading<'_>, x: MatRef<'_, f64>) -> Mat<f64> {
        if !self.is_beyond_entries() {
            let mut terms = absolute_product(matrix, x);
            terms *= faer::Scale(self.relative);
            return terms;
        }
        let diagonal = matrix.diagonal();
        let mut terms = Mat::zeros(matrix.rows(), x.ncols());
        for row in 0..matrix.rows() {
            for (col, value) in matrix.entries(row) {
                let bound = self.of_entry(value, ends(&diagonal, row, col));
                (0..x.ncols()).for_each(|j| terms[(row, j)] += bound * x[(col, j)].abs());
            }
        }
        terms
    }

    /// How well entries are known, as an error message has it.
    pub fn in_words(self) -> String {
        let Self { relative, share, .. } = self;
        if let Some(differing) = self.differing {
            format!("they differ by {differing}, and either may be right")
        } else if self.absolute > 0.0 {
            format!(
                "its entries have a fixed count of decimals, which leaves up to {share:.0e} of the sum of a row open"
            )
        } else if self.is_of_parts {
            format!("its entries are sums of numbers known to {relative:.0e} of themselves")
        } else {
            format!("its entries are known to {relative:.0e} of themselves")
        }
    }
}

impl std::fmt::Display for Differing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { of_rows, at: [row, col] } = self;
        write!(f, "{of_rows:.0e} of their rows, most at row {row}, column {col}")
    }
}

/// Half units of the last digits of entries of a matrix of a unit, one after the other; all digits are those of user units.
///
/// A decade is looked for where an entry is of another one than that before it.
#[derive(Clone, Copy, Debug)]
pub struct HalfUnits {
    rounding: Rounding,
    unit: f64,
    decade: f64,
}

impl HalfUnits {
    /// Of the entries of a matrix with this unit.
    pub fn new(rounding: Rounding, unit: f64) -> Self {
        Self { rounding, unit, decade: 0.0 }
    }

    /// Half a unit of the last digit of an entry of this size.
    pub fn of(&mut self, size: f64) -> f64 {
        if self.rounding.is_beyond_entries() {
            return self.rounding.of_entry(size, 0.0);
        }
        let size = size * self.unit;
        if !(self.decade <= size && size < 10.0 * self.decade) {
            self.decade = decade(size);
        }
        half_unit(size, self.decade, self.rounding.relative) / self.unit
    }
}

/// The power of ten that a number begins with.
fn decade(size: f64) -> f64 {
    let decade = 10f64.powi(size.log10().floor() as i32);
    // A logarithm may round up just below a power of ten; a decade that is too small would promise too much.
    if 10.0 * decade <= size { 10.0 * decade } else { decade }
}

/// Half a unit of the last digit of a number of this size and decade, where such a half is `precision` of the smallest number of as
/// many digits.
fn half_unit(size: f64, decade: f64, precision: f64) -> f64 {
    precision * decade.max(LEAST_SHARE * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_unit_is_that_of_the_last_digit() {
        // Four digits: 1.234e3 is known to 0.5, 9.876e-5 to 0.5e-8.
        let precision = 0.5e-3;
        for (size, half) in [(1234.0, 0.5), (1000.0, 0.5), (6.5e2, 0.05), (1.0e-300, 0.5e-303)] {
            let found = half_unit(size, decade(size), precision);
            assert!((found / half - 1.0).abs() < 1e-12, "{size}: {found}");
        }
        // Of a nine no less than an eighth of its size.
        assert_eq!(half_unit(9.876e-5, 1e-5, precision), precision * 9.876e-5 / 8.0);
    }
}
