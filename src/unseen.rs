//! Modes that a reduction has and its superelement leaves out, because nothing starts them and nothing sees them.
//!
//! ```text
//! A      r × r    K̂, M̂, each further matrix, Ĉ
//! a_ij   |A_ij| s_i s_j,  s = 1/√(K̂ + λ₁M̂)_ii
//! tie    max a_ij / max_k a_jk over coordinates j that stay, and over the matrices
//! ```
//! [`crate::modes`] says which modes neither interface, outputs nor loads see. Such a mode is uncoupled from all others in K̂ and M̂: with
//! r = (K − λM) x = 0 at the interface its column v of Ψ has Ψ_Sᵀ M v = −r_B/λ = 0, and vᵀf = 0 of every load. Damping and further matrices
//! may tie it to others all the same, so that what they do is measured, and a mode that anything is tied to stays. Whether a mode moves is thus
//! decided for the whole component: what is recovered inside lacks nothing either, because the mode is at rest.
//!
//! The reduction itself has all modes, and is verified with them. A superelement without the coordinates that are tied to nothing is the other
//! part of the same matrices.

use faer::{Mat, MatRef};
use supel_runtime::MatrixKind;

use crate::basis::Basis;
use crate::damping::Damping;
use crate::dense;
use crate::modes::{Coupling, MAX_UNSEEN_COUPLING, Retained, clusters};
use crate::partition::Partition;
use crate::plan::Unseen;
use crate::reduction::Reduction;

/// Largest tie of a mode that is left out. A tie moves what is kept by its square, as what [`MAX_UNSEEN_COUPLING`] says does.
pub const MAX_TIE: f64 = MAX_UNSEEN_COUPLING;
/// Share of the largest entry of a matrix below which a row is its rounding, and nothing to compare with.
const NO_ROW: f64 = 1e-6;

/// A mode that is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnseenMode {
    /// Its number among the modes.
    pub mode: usize,
    /// Its reduced coordinate.
    pub coordinate: usize,
    /// What its cluster contributes, over the largest of all modes.
    pub coupling: f64,
    /// Up to which that is rounding, over the same.
    pub rounding: f64,
    /// What it is tied to others with.
    pub tie: f64,
}

impl UnseenMode {
    /// A mode with what it contributes among all; none where it is not among them.
    pub(crate) fn of(mode: usize, coordinate: usize, couplings: &[Coupling], tie: f64) -> Option<Self> {
        let largest = dense::worst(couplings.iter().map(|coupling| coupling.size));
        let own = couplings.get(mode)?;
        Some(Self { mode, coordinate, coupling: own.share, rounding: own.rounding / largest, tie })
    }

    /// Why it is left out, in words.
    pub fn reason(&self) -> String {
        format!(
            "nothing starts it and nothing sees it: at the interface, at outputs and under loads it does {:.1e} of what the mode that \
             does most there does, up to {:.1e} of which is rounding, and {:.1e} is tied to what is kept",
            self.coupling, self.rounding, self.tie
        )
    }
}

/// The modes that are left out of a superelement, ascending. A cluster goes as a whole or not at all: any basis of its space is one of modes.
pub fn unseen_modes(
    rule: Unseen,
    (partition, retained): (&Partition, &Retained),
    (basis, reduction, damping): (&Basis<'_>, &Reduction, Option<&Damping>),
) -> Vec<UnseenMode> {
    let n_b = partition.n_interface();
    if rule == Unseen::Kept || n_b == 0 || partition.expansion.count() > 0 {
        return Vec::new();
    }
    let couplings = &retained.couplings;
    let coordinate_of =
        |mode: usize| basis.coordinates.iter().position(|of| of.mode() == Some(mode)).map(|at| n_b + at);
    // Of a cluster that others span in part nothing is left out.
    let of_cluster = |cluster: std::ops::Range<usize>| -> Option<Vec<usize>> {
        let is_unseen = cluster.clone().all(|mode| couplings.get(mode).is_some_and(|coupling| !coupling.is_seen));
        if is_unseen { cluster.map(coordinate_of).collect() } else { None }
    };
    let mut left_out: Vec<Vec<usize>> = clusters(&retained.modes.lambda).into_iter().filter_map(of_cluster).collect();
    if left_out.is_empty() {
        return Vec::new();
    }
    let first = retained.modes.lambda[0];
    let matrices = scaled_matrices(partition, (reduction, damping), first);
    // What is tied to a mode that stays stays with it.
    loop {
        let all = left_out.concat();
        let n_before = left_out.len();
        left_out.retain(|cluster| cluster.iter().all(|at| tie(&matrices, *at, &all) <= MAX_TIE));
        if left_out.len() == n_before {
            let of_mode = |at: &usize| {
                let mode = basis.coordinates[*at - n_b].mode()?;
                UnseenMode::of(mode, *at, couplings, tie(&matrices, *at, &all))
            };
            return all.iter().filter_map(of_mode).collect();
        }
    }
}

/// a of every matrix.
fn scaled_matrices(
    partition: &Partition,
    (reduction, damping): (&Reduction, Option<&Damping>),
    first: f64,
) -> Vec<Mat<f64>> {
    let (k, m) = (&reduction.stiffness, &reduction.mass);
    let scales = scales(k.as_ref(), m.as_ref(), first);
    let (n_b, shape) = (partition.n_interface(), partition.scaling.shape_unit());
    let unit = |i: usize| if i < n_b { 1.0 } else { shape };
    // Damping is in the user's units.
    let in_units = |c: &Damping| Mat::from_fn(k.nrows(), k.nrows(), |i, j| c.matrix[(i, j)] / (unit(i) * unit(j)));
    let is_further =
        |(at, _): &(usize, &Mat<f64>)| partition.matrices[*at].facts.kind != MatrixKind::Damping || damping.is_none();
    let further = reduction.matrices.iter().enumerate().filter(is_further).map(|(_, matrix)| matrix.clone());
    let all = [k.clone(), m.clone()].into_iter().chain(further).chain(damping.map(in_units));
    all.map(|matrix| in_scales(matrix.as_ref(), &scales)).collect()
}

/// s.
pub(crate) fn scales(stiffness: MatRef<'_, f64>, mass: MatRef<'_, f64>, first: f64) -> Vec<f64> {
    (0..stiffness.nrows()).map(|i| dense::power_of_two_root(stiffness[(i, i)] + first * mass[(i, i)])).collect()
}

/// a of one matrix: the larger of an entry and its mirror image, so that a matrix need not be symmetric.
pub(crate) fn in_scales(matrix: MatRef<'_, f64>, scales: &[f64]) -> Mat<f64> {
    let entry = |i: usize, j: usize| (matrix[(i, j)] * scales[i] * scales[j]).abs();
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| entry(i, j).max(entry(j, i)))
}

/// What ties a coordinate to those that are not left out.
pub(crate) fn tie(matrices: &[Mat<f64>], coordinate: usize, left_out: &[usize]) -> f64 {
    let of_matrix = |a: &Mat<f64>| {
        let floor = NO_ROW * a.norm_max();
        let stays: Vec<usize> = (0..a.ncols()).filter(|j| !left_out.contains(j)).collect();
        let of_row = |j: usize| {
            let row = stays.iter().fold(floor, |largest, k| largest.max(a[(*k, j)]));
            if a[(coordinate, j)] == 0.0 { 0.0 } else { a[(coordinate, j)] / row }
        };
        dense::worst(stays.iter().map(|j| of_row(*j)))
    };
    dense::worst(matrices.iter().map(of_matrix))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two coordinates that stay, and one that a skew matrix ties to the second, which has a hundred thousandth of what the first has.
    #[test]
    fn a_tie_is_relative_to_what_the_other_coordinate_has_itself() {
        let scales = [1.0; 3];
        let tied = |by: f64| {
            let matrix = Mat::from_fn(3, 3, |i, j| match (i, j) {
                (0, 0) => 1.0,
                (1, 1) => 1e-5,
                (1, 2) => by,
                (2, 1) => -by,
                _ => 0.0,
            });
            tie(&[in_scales(matrix.as_ref(), &scales)], 2, &[2])
        };
        assert_eq!(tied(0.0), 0.0);
        assert!((tied(1e-7) - 1e-2).abs() < 1e-15 && tied(1e-15) < MAX_TIE);
    }
}
