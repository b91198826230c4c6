//! Modes that the file leaves out as if nothing started or saw them, by modes found again: M-35.
//!
//! Nothing that the file says of them counts. The modes of the job, its loads, gravity and outputs say what starts and sees each, the columns
//! made again what mass and further matrices tie it to.

use supel_runtime::Superelement;

use super::identity::{named, places};
use super::projection::Projected;
use crate::job::Boundary;
use crate::modes::Coupling;
use crate::unseen::{UnseenMode, in_scales, scales, tie};
use crate::verification::check::Check;
use crate::verification::unseen::of_modes;

/// M-35 of the modes that the file leaves out; none where it leaves out none. `first` is the first elastic eigenvalue.
pub(super) fn unseen(
    superelement: &Superelement,
    projected: &Projected,
    (couplings, boundary): (&[Coupling], Boundary),
    first: f64,
) -> Option<Check> {
    let p = projected.n_probes();
    let kept = places(superelement, projected, boundary).unwrap_or_default();
    let is_kept = |column: usize| column < p || kept.contains(&(column - p));
    let left_out: Vec<usize> = (0..p + projected.named.len()).filter(|column| !is_kept(*column)).collect();
    let (k, m) = (projected.stiffness.matrix.as_ref(), projected.mass.matrix.as_ref());
    let scales = scales(k, m, first);
    let further = projected.matrices.iter().map(|further| further.matrix.as_ref());
    let matrices: Vec<_> = [k, m].into_iter().chain(further).map(|matrix| in_scales(matrix, &scales)).collect();
    // A mode that was not found again is not known to be unseen.
    let of_mode = |mode: usize| {
        let coordinate =
            superelement.metadata().named_columns().find(|column| column.mode().is_some_and(|of| of.0 == mode))?;
        let place = p + projected.place_of(named(coordinate, boundary)?)?;
        UnseenMode::of(mode, place, couplings, tie(&matrices, place, &left_out))
    };
    let unknown = |mode: usize| UnseenMode { mode, coordinate: 0, coupling: f64::INFINITY, rounding: 0.0, tie: 0.0 };
    let modes = superelement.metadata().unseen_modes().map(|mode| of_mode(mode).unwrap_or_else(|| unknown(mode)));
    of_modes(&modes.collect::<Vec<_>>())
}
