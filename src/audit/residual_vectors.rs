//! Residual vectors answer their loads: M-27.
//!
//! With y = K_II⁻¹ f_I and q its amplitudes, K̂_ηη q = Ψ_Dᵀ f_I, the rows of the modal coordinates of the load vector.

use faer::Mat;
use supel_runtime::Coordinate;

use super::content::Content;
use super::named_modes::named_amplitudes;
use crate::dense::{self, unpacked};
use crate::verification::check::Check;

/// M-27: K̂_ηη q = f̂_η for every residual vector.
pub(super) fn identity(content: &Content<'_>) -> Option<Check> {
    let metadata = content.superelement.metadata();
    let (b, n) = (content.n_b, content.n_reduced() - content.n_b);
    let modal = metadata.coordinates[b..].iter().enumerate();
    let residual: Vec<(usize, usize)> = modal
        .filter_map(|(slot, coordinate)| match *coordinate {
            Coordinate::ResidualVector { load } => Some((slot, load)),
            _ => None,
        })
        .collect();
    let loads = unpacked(content.superelement.tensors().load_vectors.as_ref().filter(|_| !residual.is_empty())?);
    let amplitudes = named_amplitudes(content);
    let stiffness = content.k.as_ref().submatrix(b, b, n, n);
    let mut worst = (0.0, None);
    for (slot, load) in residual {
        let q = dense::column(amplitudes.as_ref(), slot);
        let scaled = |i: usize, force: f64| force * content.scale[b + i];
        // The sizes of the terms before they cancel are what rounding is relative to.
        let of_row = |i: usize| (0..n).map(move |j| stiffness[(i, j)] * q[j]);
        let force = Mat::from_fn(n, 1, |i, _| scaled(i, of_row(i).sum::<f64>() - loads[(b + i, load)]));
        let terms: Vec<f64> = (0..n).map(|i| scaled(i, of_row(i).map(f64::abs).sum())).collect();
        let own: Vec<f64> = (0..n).map(|i| scaled(i, loads[(b + i, load)])).collect();
        let size = dense::norm(&terms).max(dense::norm(&own));
        let error = if size > 0.0 { dense::norm(dense::column(force.as_ref(), 0)) / size } else { 0.0 };
        if dense::worse(error, worst.0) {
            worst = (error, Some(metadata.load_names[load].clone()));
        }
    }
    let limits = content.answer_limits("M-27");
    Some(Check {
        id: "M-27",
        name: "residual vectors answer their loads",
        equation: "max ‖K̂_ηη q − f̂_η‖ / ‖|K̂_ηη||q|‖, in scales of K̂ + λ₁M̂",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    })
}
