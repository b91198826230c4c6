//! Sturm counts: how many eigenvalues lie below a shift, with the interface held and free.
//!
//! (K − σM)_II = L B Lᵀ has as many negative eigenvalues in B as there are clamped eigenvalues below σ (Sylvester).
//! With S(σ) = (K − σM)_BB − (K − σM)_BI (K − σM)_II⁻¹ (K − σM)_IB, the free count is the clamped count plus the
//! negative eigenvalues of S(σ) (Haynsworth 1968): one factorisation certifies both.

mod whole;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::supernodal::{
    SupernodalIntranodeLbltRef, factorize_supernodal_numeric_intranode_lblt,
    factorize_supernodal_numeric_intranode_lblt_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Par, Spec};

use super::cholesky::zeros;
use super::{Analysis, Pencil, Triangle};
use crate::dense;
use crate::error::{Error, Result};
use crate::partition::Partition;

pub use whole::{WholeCount, whole_count};

/// Numbers of eigenvalues below a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaCount {
    /// The shift, in scaled units.
    pub sigma: f64,
    /// Below it with the interface held.
    pub clamped: usize,
    /// Below it with the interface free.
    pub free: usize,
    /// Largest pivot over largest entry: near one, the signs can be trusted.
    pub growth: f64,
    /// Smallest |eigenvalue| of S(σ) over its largest: near rounding, σ lies on a free eigenvalue.
    pub schur_gap: f64,
}

/// Counts the eigenvalues of the partition's pencil below σ; `analysis` is that of K_II and M_II.
///
/// # Errors
/// No memory for the second factor; pivots that are not numbers, which means that σ hits an eigenvalue exactly.
pub fn count_below(partition: &Partition, analysis: &Analysis, sigma: f64) -> Result<InertiaCount> {
    let (stiffness, mass) = (partition.internal_stiffness(), partition.internal_mass());
    let pencil = Pencil { stiffness: &stiffness, mass: &mass };
    let factor = Indefinite::new(analysis, pencil, sigma)?;
    let signs = factor.signs()?;
    let (below_free, schur_gap) = factor.schur_signs(partition, sigma)?;
    Ok(InertiaCount {
        sigma,
        clamped: signs.negative,
        free: signs.negative + below_free,
        growth: signs.growth,
        schur_gap,
    })
}

/// L B Lᵀ of D (K − σM) D with pivots of order one and two inside each supernode.
///
/// D holds powers of two that bring the diagonal of K near one: pivots are then compared on equal terms whatever the
/// units of translations and rotations.
struct Indefinite<'a> {
    analysis: &'a Analysis,
    scale: Vec<f64>,
    largest: f64,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

struct Signs {
    negative: usize,
    growth: f64,
}

impl<'a> Indefinite<'a> {
    fn new(analysis: &'a Analysis, pencil: Pencil<'_>, sigma: f64) -> Result<Self> {
        let (symbolic, n) = (&analysis.symbolic, analysis.n);
        let scale: Vec<f64> =
            crate::model::diagonal(pencil.stiffness).into_iter().map(|d| dense::power_of_two_root(d.abs())).collect();
        let lower = Triangle::shifted_and_scaled(pencil, sigma, &scale);
        let largest = lower.values.iter().fold(0.0, |max: f64, value| max.max(value.abs()));
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &lower.pointers, None, &lower.indices);
        let mut factor = Self {
            analysis,
            scale,
            largest,
            values: zeros(symbolic.len_val())?,
            subdiagonal: vec![0.0; n],
            forward: vec![0; n],
            inverse: vec![0; n],
        };
        let parameters = Spec::default();
        let scratch = factorize_supernodal_numeric_intranode_lblt_scratch::<usize, f64>(symbolic, Par::Seq, parameters);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| Error::OutOfMemory { what: "the Sturm count" })?;
        factorize_supernodal_numeric_intranode_lblt(
            &mut factor.values,
            &mut factor.subdiagonal,
            &mut factor.forward,
            &mut factor.inverse,
            SparseColMatRef::new(pattern, lower.values.as_slice()),
            symbolic,
            Par::Seq,
            MemStack::new(&mut memory),
            parameters,
        );
        Ok(factor)
    }

    fn as_ref(&self) -> SupernodalIntranodeLbltRef<'_, usize, f64> {
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.analysis.n);
        SupernodalIntranodeLbltRef::new(&self.analysis.symbolic, &self.values, &self.subdiagonal, permutation)
    }

    /// Signs of the pivots of B.
    fn signs(&self) -> Result<Signs> {
        let factor = self.as_ref();
        let mut signs = Signs { negative: 0, growth: 0.0 };
        let mut largest_pivot = 0.0f64;
        for s in 0..self.analysis.symbolic.n_supernodes() {
            let node = factor.supernode(s);
            let (size, start) = (node.val().ncols(), node.start());
            let mut j = 0;
            while j < size {
                let (d, below) = (node.val()[(j, j)], self.subdiagonal[start + j]);
                largest_pivot = largest_pivot.max(d.abs()).max(below.abs());
                if !d.is_finite() || (d == 0.0 && below == 0.0) {
                    return Err(Error::SturmPivot { step: start + j });
                }
                if below == 0.0 {
                    signs.negative += usize::from(d < 0.0);
                    j += 1;
                } else {
                    let next = node.val()[(j + 1, j + 1)];
                    // One of each sign unless the determinant is positive; then both have the sign of the trace.
                    signs.negative += if d * next - below * below < 0.0 { 1 } else { 2 * usize::from(d < 0.0) };
                    j += 2;
                }
            }
        }
        signs.growth = largest_pivot / self.largest;
        Ok(signs)
    }

    /// (K − σM)_II⁻¹ applied to a block.
    fn solve(&self, block: &Mat<f64>) -> Mat<f64> {
        let mut x = Mat::from_fn(block.nrows(), block.ncols(), |i, j| {
            let row = self.forward[i];
            block[(row, j)] * self.scale[row]
        });
        let scratch = self.analysis.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        self.as_ref().solve_in_place_no_numeric_permute_with_conj(Conj::No, x.as_mut(), Par::Seq, stack);
        Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(self.inverse[i], j)] * self.scale[i])
    }

    /// Negative eigenvalues of S(σ), and how far its smallest is from zero.
    fn schur_signs(&self, partition: &Partition, sigma: f64) -> Result<(usize, f64)> {
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        if n_b == 0 {
            return Ok((0, 1.0));
        }
        let coupling = partition.interface_columns(sigma);
        let internal = coupling.as_ref().subrows(0, n_i).to_owned();
        let solution = self.solve(&internal);
        let mut schur = coupling.as_ref().subrows(n_i, n_b).to_owned();
        dense::add_product(schur.as_mut(), -1.0, internal.transpose(), solution.as_ref());
        dense::symmetrise(&mut schur);
        let scale: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(schur[(i, i)].abs())).collect();
        let scaled = Mat::from_fn(n_b, n_b, |i, j| schur[(i, j)] * scale[i] * scale[j]);
        let (eigenvalues, _) = dense::symmetric_eigen(scaled.as_ref())?;
        let largest = eigenvalues.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let smallest = eigenvalues.iter().fold(f64::INFINITY, |min, value| min.min(value.abs()));
        Ok((eigenvalues.iter().filter(|value| **value < 0.0).count(), smallest / largest))
    }
}
