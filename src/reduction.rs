//! Projection: the reduced matrices K̂ = ΨᵀKΨ (29) and M̂ = ΨᵀMΨ (31).
//!
//! ```text
//! r = n_B + n_η
//! K̂, M̂   r × r      interface coordinates first
//! Û       r × n_r    the rigid-body modes in reduced coordinates: [U_B; 0], because Ψ_S U_B = U_I; without an interface
//!                    the amplitudes of the rigid-body modes
//! M_F     n_r × n_r  UᵀMU of the full model
//! ```
//! K̂ is formed as ΨᵀKΨ, whose error is of second order in that of Ψ; its blocks between interface and dynamic
//! coordinates vanish by (29) and are set to zero after being measured. Of MacNeal's method M̂ is what [`ModalMass`] leaves of it.

use std::ops::Range;

use faer::{Mat, MatRef};
use supel_runtime::{MatrixKind, Symmetry};

use crate::basis::{Basis, DynamicCoordinate};
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{elastic_scale, relief_scale};
use crate::error::Result;
use crate::job::{MassOf, ReductionJob};
use crate::modal_mass::ModalMass;
use crate::modes::Retained;
use crate::partition::{CarriedMatrix, Partition};
use crate::rigid::RigidBodyModes;
use crate::sparse::{SparseMatrix, absolute_energy, panels, product};

/// The reduced matrices, in scaled units.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// K̂.
    pub stiffness: Mat<f64>,
    /// M̂.
    pub mass: Mat<f64>,
    /// What M̂ was made from where it sees the retained modes and rigid-body motion alone, and is singular for it.
    pub modal_mass: Option<ModalMass>,
    /// Û.
    pub rigid_body_modes: Mat<f64>,
    /// M_F.
    pub rigid_body_mass: Mat<f64>,
    /// ΨᵀM of the three unit translations, r × 3, where the directions are known and the component is free or held by the job.
    pub gravity: Option<Mat<f64>>,
    /// ΨᵀF of the loads of the job, r × n_l, each column in its unit.
    pub loads: Mat<f64>,
    /// ΨᵀAΨ of the further matrices of the job, r × r, each in its unit; symmetric or skew to the bit where A is.
    pub matrices: Vec<Mat<f64>>,
    /// K̂_Bη as it was projected, before it was set to zero, n_B × n_η; rounding where K is exact.
    pub cleared: Mat<f64>,
    /// What projecting measured.
    pub measured: Projection,
}

/// Reduced matrices in the user's units.
#[derive(Clone, Debug)]
pub struct UserUnits {
    /// K̂, r × r.
    pub stiffness: Mat<f64>,
    /// M̂, r × r.
    pub mass: Mat<f64>,
    /// Û, r × n_r.
    pub rigid_body_modes: Mat<f64>,
    /// ΨᵀAΨ of the further matrices, r × r each.
    pub matrices: Vec<Mat<f64>>,
}

/// What was measured before it was mended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projection {
    /// max |K̂_Bη| / √(K_BB K̂_ηη) over all entries (M-13); of a rigid component, max |K̂| / √(t_i t_j) with t the terms it is the
    /// rounding of.
    pub block_coupling: f64,
    /// The entry it is reached at.
    pub block_coupling_at: (usize, usize),
    /// max |K̂ − K̂ᵀ|_ij / √(s_i s_j) with s the diagonal of K_BB and that of K̂_ηη; without an interface the largest of this (M-25).
    pub stiffness_asymmetry: f64,
    /// max |M̂ − M̂ᵀ|_ij / √(M̂_ii M̂_jj) (M-25).
    pub mass_asymmetry: f64,
}

impl Reduction {
    /// Projects the partition's matrices on the basis.
    pub fn new(partition: &Partition, basis: &Basis<'_>, rigid: &RigidBodyModes) -> Self {
        Self::of(partition, basis, rigid, || project(&partition.mass, basis))
    }

    /// Projects the stiffness; M̂ is zero, because nothing asked depends on it.
    pub fn of_statics(partition: &Partition, basis: &Basis<'_>, rigid: &RigidBodyModes) -> Self {
        let r = basis.n_reduced();
        Self::of(partition, basis, rigid, || Mat::zeros(r, r))
    }

    fn of(
        partition: &Partition,
        basis: &Basis<'_>,
        rigid: &RigidBodyModes,
        reduced_mass: impl FnOnce() -> Mat<f64> + Send,
    ) -> Self {
        let (mut stiffness, mut mass) = rayon::join(|| project_stiffness(partition, basis), reduced_mass);
        let n_b = partition.n_interface();
        // K̂Û = 0 with a regular Û: the component is rigid as far as its coordinates go, and what was projected is rounding.
        let deforms = if rigid.count() == basis.n_reduced() { Deforms::Nowhere } else { Deforms::Somewhere };
        let rounding = (deforms == Deforms::Nowhere).then(|| clear_all(&mut stiffness, partition, basis));
        let mut measured = Projection {
            stiffness_asymmetry: asymmetry(stiffness.as_ref(), &stiffness_sizes(&stiffness, partition, basis)),
            mass_asymmetry: asymmetry(mass.as_ref(), &dense::diagonal(mass.as_ref())),
            ..Projection::default()
        };
        for matrix in [&mut stiffness, &mut mass] {
            dense::symmetrise(matrix);
        }
        let cleared = stiffness.as_ref().get(0..n_b, n_b..).to_owned();
        (measured.block_coupling, measured.block_coupling_at) = match (n_b, rounding) {
            (_, Some(rounding)) => rounding,
            (0, None) => clear_rigid_body(&mut stiffness, rigid.count()),
            // Rigid-body modes that are columns of their own are coupled to the interface: K̂_B = −A_B⁻¹ U_B.
            (_, None) if basis.rigid_amplitudes().is_some() => (0.0, (0, 0)),
            (_, None) => uncouple(&mut stiffness, partition),
        };
        let r = basis.n_reduced();
        let u_b = rigid.modes.as_ref().subrows(partition.n_internal, n_b);
        let mut rigid_body_modes = Mat::from_fn(r, rigid.count(), |i, j| if i < n_b { u_b[(i, j)] } else { 0.0 });
        if let Some(amplitudes) = basis.rigid_amplitudes().filter(|_| n_b > 0) {
            rigid_body_modes.as_mut().subrows_mut(n_b, r - n_b).copy_from(amplitudes);
        }
        if n_b == 0 {
            // The rigid-body modes are among the columns of Ψ_D, which is M-orthonormal: η = Ψ_DᵀMU.
            let momenta = product(&partition.mass, rigid.modes.as_ref());
            rigid_body_modes = transpose_apply(basis, momenta.as_ref());
        }
        let of_free = || product(&partition.mass, rigid.modes.as_ref().subcols(0, 3));
        let of_held = partition.gravity.as_ref().map(|gravity| gravity.loads.clone());
        let gravity = of_held.or_else(|| rigid.is_classical.then(of_free));
        let gravity = gravity.map(|loads| transpose_apply(basis, loads.as_ref()));
        Self {
            stiffness,
            mass,
            modal_mass: None,
            rigid_body_modes,
            rigid_body_mass: rigid.rigid_body_mass(&partition.mass),
            gravity,
            loads: transpose_apply(basis, partition.loads.vectors.as_ref()),
            matrices: partition.matrices.iter().map(|further| project_further(further, basis, deforms)).collect(),
            cleared,
            measured,
        }
    }

    /// The reduction with the mass that the method of a job has; `retained` are modes of whose columns the basis is.
    ///
    /// # Errors
    /// The errors of [`ModalMass::new`].
    pub fn with_mass_of(mut self, job: &ReductionJob, basis: &Basis<'_>, retained: &Retained) -> Result<Self> {
        if job.method.mass() == MassOf::RetainedModes {
            let modes = basis.reduced_modes(&retained.modes, basis.constraint_modes.n_internal());
            (self.mass, self.modal_mass) = ModalMass::new(self.mass, &self.rigid_body_modes, modes)?;
        }
        Ok(self)
    }

    /// The rank of M̂ where the method makes it singular.
    pub fn mass_rank(&self) -> Option<usize> {
        self.modal_mass.as_ref().map(|modal| modal.rank)
    }

    /// K̂, M̂, Û and the further matrices in the user's units.
    pub fn in_user_units(&self, partition: &Partition) -> UserUnits {
        let (scaling, n_b) = (partition.scaling, partition.n_interface());
        let shape = scaling.shape_unit();
        // A coordinate's unit: one for an interface dof, that of a mass-normalised shape for a modal amplitude.
        let unit = |i: usize| if i < n_b { 1.0 } else { shape };
        let both =
            |a: &Mat<f64>, of: f64| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * of * unit(i) * unit(j));
        // One product of both units, so that what is symmetric or skew stays so to the bit.
        let further = |(a, carried): (&Mat<f64>, &CarriedMatrix)| {
            Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] * carried.facts.unit * (unit(i) * unit(j)))
        };
        // An amplitude is the smaller the larger its shape; those of rigid-body motion are not zero without an interface.
        let u = &self.rigid_body_modes;
        UserUnits {
            stiffness: both(&self.stiffness, scaling.stiffness_unit()),
            mass: both(&self.mass, scaling.mass_unit()),
            rigid_body_modes: Mat::from_fn(u.nrows(), u.ncols(), |i, j| u[(i, j)] / unit(i)),
            matrices: self.matrices.iter().zip(&partition.matrices).map(further).collect(),
        }
    }

    /// r.
    pub fn n_reduced(&self) -> usize {
        self.stiffness.nrows()
    }

    /// The first elastic eigenvalue where no mode tells it, by the reduced matrices.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(crate) fn elastic_scale(&self) -> Result<Option<f64>> {
        match self.modal_mass {
            Some(_) => Ok(relief_scale(self.pencil(), self.cleared.nrows())),
            None => elastic_scale(self.pencil()),
        }
    }

    /// K̂, M̂ and the motions Û that K̂ lets pass.
    pub(crate) fn pencil(&self) -> (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>) {
        (self.stiffness.as_ref(), self.mass.as_ref(), self.rigid_body_modes.as_ref())
    }
}

/// ΨᵀKΨ; of interface dofs what is known of it where the constraint modes are not stored.
fn project_stiffness(partition: &Partition, basis: &Basis<'_>) -> Mat<f64> {
    let Some(known) = basis.constraint_modes.stiffness() else { return project(&partition.stiffness, basis) };
    let (n_b, r) = (known.nrows(), basis.n_reduced());
    let mut projected = Mat::zeros(r, r);
    projected.as_mut().submatrix_mut(0, 0, n_b, n_b).copy_from(known);
    for columns in panels(basis.n_dynamic()).map(|columns| n_b + columns.start..n_b + columns.end) {
        let image = product(&partition.stiffness, panel_of(basis, columns.clone()).as_ref());
        let column = transpose_apply(basis, image.as_ref());
        projected.as_mut().get_mut(.., columns.clone()).copy_from(&column);
        let mirrored = column.as_ref().subrows(0, n_b).transpose().to_owned();
        projected.as_mut().get_mut(columns, ..n_b).copy_from(mirrored);
    }
    projected
}

/// ΨᵀAΨ, panel by panel.
fn project(matrix: &SparseMatrix, basis: &Basis<'_>) -> Mat<f64> {
    let r = basis.n_reduced();
    let mut projected = Mat::zeros(r, r);
    for columns in panels(r) {
        let image = product(matrix, panel_of(basis, columns.clone()).as_ref());
        projected.as_mut().get_mut(.., columns).copy_from(transpose_apply(basis, image.as_ref()));
    }
    projected
}

/// ΨᵀAΨ of a further matrix. What rounding leaves of its symmetry goes; a matrix that has none is left as it is.
fn project_further(further: &CarriedMatrix, basis: &Basis<'_>, deforms: Deforms) -> Mat<f64> {
    let mut projected = project(&further.matrix, basis);
    if deforms == Deforms::Nowhere && further.facts.kind == MatrixKind::Damping {
        clear_rounding(&mut projected, further, panel_of(basis, 0..basis.n_reduced()).as_ref());
    }
    match further.facts.symmetry {
        Some(Symmetry::Symmetric) => {
            dense::symmetrise(&mut projected);
        }
        Some(Symmetry::Skew) => {
            let r = projected.nrows();
            projected = Mat::from_fn(r, r, |i, j| 0.5 * (projected[(i, j)] - projected[(j, i)]));
        }
        None => {}
    }
    projected
}

/// Sets damping of columns that are all rigid-body motions, n' × r, to zero, entry by entry, where it is the rounding of its terms.
pub(crate) fn clear_rounding(projected: &mut Mat<f64>, further: &CarriedMatrix, columns: MatRef<'_, f64>) {
    let [terms, _] = further.sizes_of_forces(columns);
    let terms = dense::gram(dense::absolute(columns).as_ref(), terms.as_ref());
    let rounding = NOISE_FACTOR * further.facts.rounding.max(f64::EPSILON);
    let is_rounding = |i: usize, j: usize, value: f64| value.abs() <= rounding * terms[(i, j)];
    let kept = |i: usize, j: usize| if is_rounding(i, j, projected[(i, j)]) { 0.0 } else { projected[(i, j)] };
    *projected = Mat::from_fn(projected.nrows(), projected.ncols(), kept);
}

/// Where a reduced component deforms.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Deforms {
    Somewhere,
    /// All its motions are those of rigid bodies.
    Nowhere,
}

/// Some columns of Ψ, n' × k.
pub(crate) fn panel_of(basis: &Basis<'_>, columns: Range<usize>) -> Mat<f64> {
    let (n_i, n_b) = (basis.constraint_modes.n_internal(), basis.constraint_modes.n_interface());
    let mut panel = Mat::zeros(n_i + n_b, columns.len());
    let n_static = columns.end.min(n_b).saturating_sub(columns.start);
    if n_static > 0 {
        let statics = basis.constraint_modes.columns(columns.start..columns.start + n_static);
        panel.as_mut().subrows_mut(0, n_i).subcols_mut(0, n_static).copy_from(statics);
        (0..n_static).for_each(|j| panel[(n_i + columns.start + j, j)] = 1.0);
    }
    if n_static < columns.len() {
        let dynamics = basis.dynamic_modes.as_ref().get(.., columns.start + n_static - n_b..columns.end - n_b);
        panel.as_mut().subrows_mut(0, n_i).subcols_mut(n_static, columns.len() - n_static).copy_from(dynamics);
    }
    panel
}

/// Ψᵀ F, r × k.
pub(crate) fn transpose_apply(basis: &Basis<'_>, forces: MatRef<'_, f64>) -> Mat<f64> {
    let (n_i, n_b) = (basis.constraint_modes.n_internal(), basis.constraint_modes.n_interface());
    let (internal, interface) = (forces.subrows(0, n_i), forces.subrows(n_i, n_b));
    let mut reduced = Mat::zeros(basis.n_reduced(), forces.ncols());
    let mut top = reduced.as_mut().subrows_mut(0, n_b);
    top.copy_from(basis.constraint_modes.gather(internal));
    top += interface;
    reduced.as_mut().subrows_mut(n_b, basis.n_dynamic()).copy_from(dense::gram(basis.dynamic_modes.as_ref(), internal));
    reduced
}

/// How large a block was, relative to what its entries are rounding of, and where.
type Worst = (f64, (usize, usize));

/// Without an interface the first n_r coordinates are rigid-body modes: K U = 0 (2). Sets their rows of K̂ to zero and says how
/// large they were, relative to the largest diagonal entry.
fn clear_rigid_body(stiffness: &mut Mat<f64>, n_rigid: usize) -> Worst {
    let r = stiffness.nrows();
    let size = (0..r).fold(0.0f64, |max, i| max.max(stiffness[(i, i)]));
    clear(stiffness, [0..r, 0..n_rigid], |_, _| size)
}

/// Sets K̂ of a rigid component to zero and says how large it was, relative to what it is the rounding of: the diagonal of K_BB,
/// or without an interface the terms |Ψ|ᵀ|K||Ψ| of its rigid-body modes.
fn clear_all(stiffness: &mut Mat<f64>, partition: &Partition, basis: &Basis<'_>) -> Worst {
    let r = stiffness.nrows();
    let sizes: Vec<f64> = match partition.n_interface() {
        0 => absolute_energy(&partition.stiffness, basis.dynamic_modes.as_ref()),
        _ => (0..r).map(|i| uncondensed(partition, i)).collect(),
    };
    clear(stiffness, [0..r, 0..r], |i, j| (sizes[i] * sizes[j]).abs().sqrt())
}

/// Sets K̂_Bη to zero and says how large it was, relative to the diagonal: for an interface dof that of K_BB, of whose
/// terms the block is the rounding, for a mode that of K̂_ηη.
fn uncouple(stiffness: &mut Mat<f64>, partition: &Partition) -> Worst {
    let (n_b, r) = (partition.n_interface(), stiffness.nrows());
    let diagonal: Vec<f64> = (0..r).map(|j| stiffness[(j, j)]).collect();
    clear(stiffness, [0..n_b, n_b..r], |i, j| (uncondensed(partition, i) * diagonal[j]).abs().sqrt())
}

/// What the entries of K̂ are compared with in each row, whatever the units of the interface: K_BB,ii, and K̂_jj of modes. A mode by which
/// nothing deforms has none of its own.
fn stiffness_sizes(stiffness: &Mat<f64>, partition: &Partition, basis: &Basis<'_>) -> Vec<f64> {
    let n_b = partition.n_interface();
    let of_modes = sizes_of_modes(stiffness.as_ref(), n_b, basis);
    let largest = of_modes.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let of_mode = |j: usize| if n_b == 0 { largest } else { of_modes[j] };
    (0..stiffness.nrows()).map(|i| if i < n_b { uncondensed(partition, i) } else { of_mode(i - n_b) }).collect()
}

/// K̂_jj of the columns behind the interface of n_B dofs; of those of another program nobody knows what they are. A rigid-body mode that leaves
/// the interface at rest has rounding there: it gets the least of the elastic columns, which have unit modal mass as it has, or without them
/// the largest of all.
pub(crate) fn sizes_of_modes(stiffness: MatRef<'_, f64>, n_b: usize, basis: &Basis<'_>) -> Vec<f64> {
    let of = |j: usize| stiffness[(n_b + j, n_b + j)];
    let is_rigid = |j: &usize| matches!(basis.coordinates.get(*j), Some(DynamicCoordinate::RigidBody(_)));
    let columns = 0..stiffness.nrows() - n_b;
    let elastic = columns.clone().filter(|j| !is_rigid(j)).map(of).reduce(f64::min);
    let least = elastic.unwrap_or_else(|| columns.clone().map(of).fold(0.0, f64::max));
    columns.map(|j| if is_rigid(&j) { of(j).max(least) } else { of(j) }).collect()
}

/// max |A − Aᵀ|_ij / √(s_i s_j).
fn asymmetry(a: MatRef<'_, f64>, sizes: &[f64]) -> f64 {
    let mut worst = 0.0;
    for j in 0..a.ncols() {
        for i in 0..j {
            let size = (sizes[i] * sizes[j]).abs().sqrt();
            let value = if size > 0.0 { (a[(i, j)] - a[(j, i)]).abs() / size } else { 0.0 };
            worst = if dense::worse(value, worst) { value } else { worst };
        }
    }
    worst
}

/// An entry of the diagonal of K_BB.
fn uncondensed(partition: &Partition, i: usize) -> f64 {
    let at = partition.n_internal + i;
    partition.stiffness.get(at, at).copied().unwrap_or(0.0)
}

/// Sets a block, rows and columns, and the one across the diagonal to zero and says how large they were, relative to `size`.
fn clear(a: &mut Mat<f64>, [rows, columns]: [Range<usize>; 2], size: impl Fn(usize, usize) -> f64) -> Worst {
    let mut worst = (0.0, (0, 0));
    for (i, j) in columns.flat_map(|j| rows.clone().map(move |i| (i, j))) {
        let size = size(i, j);
        for at in [(i, j), (j, i)] {
            if size != 0.0 && dense::worse(a[at].abs() / size, worst.0) {
                worst = (a[at].abs() / size, at);
            }
            a[at] = 0.0;
        }
    }
    worst
}
