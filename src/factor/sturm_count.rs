//! Sturm counts: how many eigenvalues lie below a shift, with the interface held and free.
//!
//! (K − σM)_II = L B Lᵀ has as many negative eigenvalues in B as there are clamped eigenvalues below σ (Sylvester).
//! With S(σ) = (K − σM)_BB − (K − σM)_BI (K − σM)_II⁻¹ (K − σM)_IB, the free count is the clamped count plus the
//! negative eigenvalues of S(σ) (Haynsworth 1968): one factorisation certifies both, and solves with K − σM too.

use faer::{Mat, MatMut};

use super::Analysis;
use super::indefinite::Indefinite;
use super::multifrontal::Keep;
use crate::cache::{Kind, Reader, Recorded, Writer};
use crate::dense;
use crate::error::{Error, Result, held_words};
use crate::sparse::Pencil;
use crate::sparse::{Leading, Rounding, SparseMatrix, ends};

/// Numbers of eigenvalues below a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaCount {
    /// The shift, in scaled units.
    pub sigma: f64,
    /// Below it with the interface held.
    pub clamped: usize,
    /// Below it with the interface free, or those dofs of it that were asked for.
    pub free: usize,
    /// Bound of the largest entry of |L||B||Lᵀ| over the largest entry of the scaled matrix: near one, the signs can be trusted.
    pub growth: f64,
    /// Smallest pivot over largest entry: near rounding, σ lies on an eigenvalue with the interface held.
    pub pivot_gap: f64,
    /// Smallest |eigenvalue| of S(σ) over its largest: near rounding, σ lies on a free eigenvalue.
    pub schur_gap: f64,
    /// Smallest |eigenvalue| of S(σ) relative to the interface stiffness before condensation, as rounding of S(σ) is.
    pub condensed_gap: f64,
}

/// Below this share an eigenvalue of S(σ) is rounding, and σ too near a free eigenvalue.
const SCHUR_GAP: f64 = 1e-12;
/// Below this share of the stiffness before condensation an eigenvalue of S(σ) is what rounding left of the condensation.
pub const CONDENSED_GAP: f64 = 100.0 * f64::EPSILON;
/// Below this share a pivot of B is rounding, as in the Cholesky factorisation, and σ too near a clamped eigenvalue.
const PIVOT_GAP: f64 = 1024.0 * f64::EPSILON;

impl InertiaCount {
    /// Whether σ lies off the clamped eigenvalues as far as the pivots tell. Where it does not, S(σ) is dominated by one
    /// term and the free count is in doubt too.
    pub fn is_off_clamped(&self) -> bool {
        self.pivot_gap > PIVOT_GAP
    }

    /// Whether σ lies off the free eigenvalues as far as S(σ) tells.
    pub fn is_off_free(&self) -> bool {
        self.schur_gap > SCHUR_GAP && self.condensed_gap > CONDENSED_GAP
    }
}

impl Recorded for InertiaCount {
    const KIND: Kind = Kind::Count;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { sigma, clamped, free, growth, pivot_gap, schur_gap, condensed_gap } = *self;
        to.counts(&[clamped, free])?;
        to.array(&[sigma, growth, pivot_gap, schur_gap, condensed_gap])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let [clamped, free] = from.counts()?[..] else { return None };
        let [sigma, growth, pivot_gap, schur_gap, condensed_gap] = from.array()?[..] else { return None };
        Some(Self { sigma, clamped, free, growth, pivot_gap, schur_gap, condensed_gap })
    }
}

/// Counts the eigenvalues of a pencil below σ, with its border held and free; `analysis` is that of the pencil with its border.
///
/// # Errors
/// No memory for the second factor; pivots that are not numbers, which means that σ hits an eigenvalue exactly.
pub fn count_below(analysis: &Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<InertiaCount> {
    count_below_freeing(analysis, pencil, sigma, None)
}

/// Counts as [`count_below`] does, with some dofs of the border free (their numbers, ascending) and the others held, by the part of S(σ) that
/// is theirs; with all of them where none are named.
///
/// # Errors
/// As [`count_below`].
pub fn count_below_freeing(
    analysis: &Analysis,
    pencil: Pencil<'_>,
    sigma: f64,
    free: Option<&[usize]>,
) -> Result<InertiaCount> {
    let (_, _, count) = counted(analysis, (pencil, sigma), free, Keep::Pivots)?;
    Ok(count)
}

/// The counts below σ with S(σ), n_B × n_B, what elimination of the internal dofs leaves of K − σM.
///
/// # Errors
/// As [`count_below`].
pub fn condensed(analysis: &Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<(InertiaCount, Mat<f64>)> {
    let (factor, _, count) = counted(analysis, (pencil, sigma), None, Keep::Pivots)?;
    Ok((count, factor.schur()))
}

/// K − σM factored, S(σ) decomposed, and the counts.
fn counted<'a>(
    analysis: &'a Analysis,
    (pencil, sigma): (Pencil<'_>, f64),
    free: Option<&[usize]>,
    keep: Keep,
) -> Result<(Indefinite<'a>, Schur, InertiaCount)> {
    let factor = Indefinite::new(analysis, pencil, sigma, keep)?;
    let signs = factor.signs()?;
    let n_i = analysis.n();
    let (stiffness, mass) = (pencil.stiffness.diagonal(), pencil.mass.diagonal());
    let uncondensed: Vec<f64> =
        (n_i..stiffness.len()).map(|i| stiffness[i].abs() + sigma.abs() * mass[i].abs()).collect();
    let whole = factor.schur();
    let schur = match free {
        None => Schur::new(whole, &uncondensed)?,
        Some(free) => {
            let part = Mat::from_fn(free.len(), free.len(), |i, j| whole[(free[i], free[j])]);
            Schur::new(part, &free.iter().map(|dof| uncondensed[*dof]).collect::<Vec<f64>>())?
        }
    };
    let count = InertiaCount {
        sigma,
        clamped: signs.negative,
        free: signs.negative + schur.n_negative(),
        growth: signs.growth,
        pivot_gap: signs.smallest,
        schur_gap: schur.gap(),
        condensed_gap: schur.condensed_gap,
    };
    if !count.schur_gap.is_finite() {
        return Err(Error::SturmPivot);
    }
    Ok((factor, schur, count))
}

/// The boundary that a definite matrix is factored under: its interface is held where it is the border of the elimination, or left
/// out of the block.
pub(crate) fn boundary_of(analysis: &Analysis, stiffness: Leading<'_>) -> &'static str {
    if analysis.n_border() > 0 || !stiffness.is_whole() { "held" } else { "free" }
}

/// Eigenvalues of K_II below zero by more than rounding of its entries, however σ and M are.
///
/// K_II + τ diag(K_II) is counted: a negative eigenvalue that a relative change τ of the diagonal makes vanish is one that
/// rounding may have made. τ is the share below which the Cholesky factorisation calls a pivot rounding.
///
/// # Errors
/// As [`count_below`].
pub fn count_negative<'a>(analysis: &Analysis, stiffness: impl Into<Leading<'a>>) -> Result<usize> {
    below_share_of_diagonal(analysis, stiffness.into(), -PIVOT_GAP)
}

/// The rank of a semidefinite M beyond rounding of its entries, which have a relative `precision`: the eigenvalues relative to
/// its diagonal above what that moves them by, a share of the largest row sum.
///
/// # Errors
/// As [`count_below`].
///
/// # Panics
/// The analysis has a border.
pub fn rank<'a>(analysis: &Analysis, mass: impl Into<Leading<'a>>, rounding: Rounding) -> Result<usize> {
    let mass = mass.into();
    assert_eq!(analysis.n_border(), 0, "the rank is that of a whole matrix");
    let diagonal = mass.diagonal();
    // A row of a semidefinite matrix without a diagonal is empty.
    let scale: Vec<f64> = diagonal.iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }).collect();
    let bound = |row: usize, col: usize, value: f64| rounding.of_entry(value, ends(&diagonal, row, col));
    let row_sum =
        |row| scale[row] * mass.entries(row).map(|(col, value)| bound(row, col, value) * scale[col]).sum::<f64>();
    let moved = PIVOT_GAP + (0..mass.rows()).map(row_sum).fold(0.0, f64::max);
    Ok(mass.rows() - below_share_of_diagonal(analysis, mass, moved)?)
}

/// Eigenvalues of K_II that stay below zero when every entry of K may be off by its last digit.
///
/// Such roundings E leave |xᵀEx| ≤ Σ r_i x_i² with r_i the sum of the bounds |E_ij| along row i, for |x_i x_j| ≤ (x_i² + x_j²)/2: K_II
/// with r on its diagonal is counted.
///
/// # Errors
/// As [`count_below`].
fn count_negative_beyond(analysis: &Analysis, stiffness: Leading<'_>, rounding: Rounding) -> Result<usize> {
    let margin = margin_of_roundings(stiffness, rounding);
    let pencil = Pencil::new(stiffness, &margin);
    Ok(Indefinite::new(analysis, pencil, -1.0, Keep::Pivots)?.signs()?.negative)
}

/// diag(r).
pub(super) fn margin_of_roundings(stiffness: Leading<'_>, rounding: Rounding) -> SparseMatrix {
    let n = stiffness.rows();
    let diagonal = stiffness.diagonal();
    let row = |row: usize| {
        let sum: f64 = stiffness.entries(row).map(|(_, value)| value.abs()).sum();
        // An empty row has no stiffness to be rounded.
        if sum == 0.0 { 1.0 } else { PIVOT_GAP * diagonal[row].abs() + rounding.of_row(stiffness, &diagonal, row) }
    };
    SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), (0..n).map(row).collect())
}

/// Why K is not a definite matrix, where its digits are few and rounding of them may be all that is wrong with it.
pub fn few_digits(error: Error, analysis: &Analysis, stiffness: Leading<'_>, rounding: Rounding) -> Error {
    let is_of_definiteness = matches!(
        error,
        Error::IndefiniteStiffness { .. } | Error::NotDefinite { .. } | Error::NegativeRigidEnergy { .. }
    );
    if !is_of_definiteness || !rounding.is_coarse() {
        return error;
    }
    let held = held_words(boundary_of(analysis, stiffness));
    match count_negative_beyond(analysis, stiffness, rounding) {
        Ok(0) => {
            let what =
                format!("whether it is definite with {held}: as it stands it is not, with other last digits it is");
            rounding.too_uncertain(what)
        }
        _ => error,
    }
}

/// Eigenvalues of A relative to its diagonal below a share; empty rows count as zero.
fn below_share_of_diagonal(analysis: &Analysis, matrix: Leading<'_>, share: f64) -> Result<usize> {
    let n = matrix.rows();
    let or_one = |d: f64| if d == 0.0 { 1.0 } else { d.abs() };
    let diagonal = matrix.diagonal().into_iter().map(or_one).collect();
    let diagonal = SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), diagonal);
    let pencil = Pencil::new(matrix, &diagonal);
    Ok(Indefinite::new(analysis, pencil, share, Keep::Pivots)?.signs()?.negative)
}

/// K − σM factored, σ inside the spectrum: counts, and solves with the interface held or free.
pub struct ShiftedFactor<'a> {
    factor: Indefinite<'a>,
    schur: Schur,
    /// Dofs of the border that are free, where not all of them are.
    free: Option<Vec<usize>>,
    /// The counts below σ.
    pub count: InertiaCount,
}

/// S(σ) = D⁻¹ V diag(μ) Vᵀ D⁻¹.
struct Schur {
    scale: Vec<f64>,
    eigenvalues: Vec<f64>,
    vectors: Mat<f64>,
    /// Smallest |eigenvalue| relative to the interface before condensation; one without an interface.
    condensed_gap: f64,
}

impl<'a> ShiftedFactor<'a> {
    /// Factors K − σM; `analysis` is that of the pencil with its border.
    ///
    /// # Errors
    /// As [`count_below`].
    pub fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<Self> {
        Self::freeing(analysis, pencil, sigma, None)
    }

    /// Factors K − σM for solves with some dofs of the border free, as [`count_below_freeing`] counts.
    ///
    /// # Errors
    /// As [`count_below`].
    pub fn freeing(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64, free: Option<&[usize]>) -> Result<Self> {
        let (factor, schur, count) = counted(analysis, (pencil, sigma), free, Keep::Factor)?;
        Ok(Self { factor, schur, free: free.map(<[usize]>::to_vec), count })
    }

    /// Bytes of the factor, all of which a solve reads.
    pub fn bytes(&self) -> u64 {
        self.factor.bytes()
    }

    /// F ← (K − σM)_II⁻¹ F, the interface held: n_I rows.
    pub fn solve_held(&self, block: MatMut<'_, f64>) {
        self.factor.solve_held(block);
    }

    /// F ← (K − σM)⁻¹ F, the interface free: n_I + n_B rows; with some of it free n_I + n_F.
    pub fn solve_free(&self, mut block: MatMut<'_, f64>) {
        let Some(free) = &self.free else {
            return self.factor.solve_free(block, |loads| self.schur.solve_in_place(loads));
        };
        let n_i = block.nrows() - free.len();
        let mut whole = Mat::zeros(n_i + self.factor.n_border(), block.ncols());
        whole.as_mut().subrows_mut(0, n_i).copy_from(block.as_ref().subrows(0, n_i));
        for (row, dof) in free.iter().enumerate() {
            whole.as_mut().row_mut(n_i + dof).copy_from(block.as_ref().row(n_i + row));
        }
        self.factor.solve_free(whole.as_mut(), |mut loads| {
            let mut part = Mat::from_fn(free.len(), loads.ncols(), |i, j| loads[(free[i], j)]);
            self.schur.solve_in_place(part.as_mut());
            loads.fill(0.0);
            free.iter().enumerate().for_each(|(i, dof)| loads.as_mut().row_mut(*dof).copy_from(part.as_ref().row(i)));
        });
        block.as_mut().subrows_mut(0, n_i).copy_from(whole.as_ref().subrows(0, n_i));
        for (row, dof) in free.iter().enumerate() {
            block.as_mut().row_mut(n_i + row).copy_from(whole.as_ref().row(n_i + dof));
        }
    }
}

impl Schur {
    /// Decomposes S(σ); `uncondensed` is |K_ii| + |σ| M_ii of the interface dofs.
    fn new(mut schur: Mat<f64>, uncondensed: &[f64]) -> Result<Self> {
        dense::symmetrise(&mut schur);
        let n_b = schur.nrows();
        let scale: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(schur[(i, i)].abs())).collect();
        let scaled_by = |scale: &[f64]| Mat::from_fn(n_b, n_b, |i, j| schur[(i, j)] * scale[i] * scale[j]);
        let (eigenvalues, vectors) = dense::symmetric_eigen(scaled_by(&scale).as_ref())?;
        let before: Vec<f64> = uncondensed.iter().map(|term| dense::power_of_two_root(*term)).collect();
        let (sizes, _) = dense::symmetric_eigen(scaled_by(&before).as_ref())?;
        let condensed_gap = sizes.iter().fold(1.0, |least: f64, value| least.min(value.abs()));
        Ok(Self { scale, eigenvalues, vectors, condensed_gap })
    }

    fn n_negative(&self) -> usize {
        self.eigenvalues.iter().filter(|value| **value < 0.0).count()
    }

    /// Smallest |eigenvalue| over the largest; one without an interface.
    fn gap(&self) -> f64 {
        let largest = self.eigenvalues.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let smallest = self.eigenvalues.iter().fold(f64::INFINITY, |min, value| min.min(value.abs()));
        if self.eigenvalues.is_empty() { 1.0 } else { smallest / largest }
    }

    /// X ← S(σ)⁻¹ X.
    fn solve_in_place(&self, mut loads: MatMut<'_, f64>) {
        let scaled = Mat::from_fn(loads.nrows(), loads.ncols(), |i, j| loads[(i, j)] * self.scale[i]);
        let mut along = dense::gram(self.vectors.as_ref(), scaled.as_ref());
        for j in 0..along.ncols() {
            for i in 0..along.nrows() {
                along[(i, j)] /= self.eigenvalues[i];
            }
        }
        let x = dense::product(self.vectors.as_ref(), along.as_ref());
        loads.copy_from(Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(i, j)] * self.scale[i]));
    }
}
