//! The content of the file in the scaled units of the partition.

use faer::Mat;
use supel_runtime::{Coordinate, Direction, Matrix, Precision, Superelement};

use crate::audit::content::{directions, has_mass, unit_mass};
use crate::dense::unpacked;
use crate::partition::{CarriedMatrix, Partition};

/// K̂, M̂, Û and all the rest as the stages of the model see them.
pub(super) struct Scaled {
    pub(super) k: Mat<f64>,
    /// M̂; the diagonal of K̂ where the file has no mass.
    pub(super) m: Mat<f64>,
    pub(super) has_mass: bool,
    pub(super) u: Mat<f64>,
    pub(super) m_f: Mat<f64>,
    /// 3 × r.
    pub(super) gravity: Option<Mat<f64>>,
    /// fᵀΨ of each load, 1 × r, where there are as many as in the job.
    pub(super) loads: Vec<Mat<f64>>,
    /// R T Ψ, a matrix 1 × r for each row, where there are as many as in the job.
    pub(super) quantities: Vec<Mat<f64>>,
    /// ΨᵀAΨ of each further matrix, where there are as many as in the job.
    pub(super) matrices: Vec<Mat<f64>>,
    /// W, rows × r.
    pub(super) recovery: Option<Mat<f64>>,
    /// Relative rounding of the rows as they are kept.
    pub(super) recovery_rounding: f64,
    /// C, n_η × n_η.
    pub(super) mixing: Option<Mat<f64>>,
    pub(super) n_b: usize,
    /// Of each coordinate, where it has one.
    pub(super) directions: Vec<Option<Direction>>,
    /// λ of the stated frequencies.
    pub(super) lambda: Vec<f64>,
}

impl Scaled {
    pub(super) fn of(superelement: &Superelement, partition: &Partition) -> Self {
        let (tensors, units, n_b) = (superelement.tensors(), partition.scaling, superelement.n_interface());
        let shape = units.shape_unit();
        let of = |i: usize| if i < n_b { 1.0 } else { shape };
        let both =
            |a: Mat<f64>, unit: f64| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / (unit * of(i) * of(j)));
        let (has_mass, k) = (has_mass(superelement), both(unpacked(&tensors.stiffness), units.stiffness_unit()));
        let mut m_f = unpacked(&tensors.rigid_body_mass);
        m_f *= faer::Scale(1.0 / units.mass_unit());
        let gravity = tensors.gravity.as_ref();
        let recovery = tensors.recovery.as_ref();
        // A named shape is mass-normalised in the user's units; an inertia-relief mode K_II⁻¹(MU)_I carries the unit of M over
        // that of K, and so does an expansion mode; a residual vector that of its load.
        let load_unit = |load: usize| partition.loads.facts.get(load).map_or(1.0, |load| load.unit);
        let mode_unit = |mode: usize| partition.expansion.facts.get(mode).map_or(1.0, |mode| mode.unit);
        let named = |coordinate: &Coordinate| match coordinate {
            Coordinate::RigidBodyMode { .. } => shape,
            Coordinate::InertiaRelief { .. } => shape * units.eigenvalue_unit(),
            Coordinate::ExpansionMode { column } => shape * units.eigenvalue_unit() / mode_unit(*column),
            Coordinate::ResidualVector { load } => shape * units.stiffness_unit() / load_unit(*load),
            _ => 1.0,
        };
        let coordinates = &superelement.metadata().coordinates[n_b..];
        let mixing = tensors.mixing.as_ref().map(unpacked);
        let u = &tensors.rigid_body_modes;
        let u = Mat::from_fn(u.rows(), u.cols(), |i, j| u[(i, j)] * of(i));
        Self {
            m: match has_mass {
                true => both(unpacked(&tensors.mass), units.mass_unit()),
                false => unit_mass(&k, u.as_ref()),
            },
            k,
            has_mass,
            u,
            m_f,
            gravity: gravity.map(|g| Mat::from_fn(g.cols(), g.rows(), |i, j| g[(j, i)] / (units.mass_unit() * of(j)))),
            loads: loads_in_units(superelement, partition, &of),
            quantities: quantities_in_units(superelement, partition, &of),
            matrices: matrices_in_units(superelement, partition, &of),
            recovery: recovery.map(|w| {
                let w = w.rows();
                Mat::from_fn(w.rows(), w.cols(), |i, j| w[(i, j)] / of(j))
            }),
            recovery_rounding: match recovery.map(supel_runtime::Recovery::precision) {
                Some(Precision::Single) => f64::from(f32::EPSILON) / 2.0,
                Some(Precision::Double) | None => f64::EPSILON,
            },
            mixing: mixing.map(|c| Mat::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] / named(&coordinates[i]))),
            n_b,
            directions: directions(superelement),
            lambda: tensors.frequencies.iter().map(|omega| omega * omega / units.eigenvalue_unit()).collect(),
        }
    }

    /// n_η.
    pub(super) fn n_modal(&self) -> usize {
        self.k.nrows() - self.n_b
    }
}

/// The load vectors of a file in the units of the loads of a partition; none where there are not as many.
fn loads_in_units(
    superelement: &Superelement,
    partition: &Partition,
    of_coordinate: &dyn Fn(usize) -> f64,
) -> Vec<Mat<f64>> {
    let loads = &partition.loads.facts;
    let Some(vectors) = superelement.tensors().load_vectors.as_ref().filter(|stored| stored.cols() == loads.len())
    else {
        return Vec::new();
    };
    let of_load = |(load, unit): (usize, f64)| {
        Mat::from_fn(1, vectors.rows(), |_, j| vectors[(j, load)] / unit / of_coordinate(j))
    };
    loads.iter().map(|facts| facts.unit).enumerate().map(of_load).collect()
}

/// The quantities of a file on shapes in the units of a partition; none where there are not as many.
fn quantities_in_units(
    superelement: &Superelement,
    partition: &Partition,
    of_coordinate: &dyn Fn(usize) -> f64,
) -> Vec<Mat<f64>> {
    let n_rows = partition.quantities.rows.len();
    let Some(rows) = superelement.tensors().quantities.as_ref().filter(|stored| stored.rows() == n_rows) else {
        return Vec::new();
    };
    (0..n_rows).map(|row| Mat::from_fn(1, rows.cols(), |_, j| rows[(row, j)] / of_coordinate(j))).collect()
}

/// The further matrices of a file in the units of those of a partition; none where there are not as many.
fn matrices_in_units(
    superelement: &Superelement,
    partition: &Partition,
    of_coordinate: &dyn Fn(usize) -> f64,
) -> Vec<Mat<f64>> {
    let stored = &superelement.tensors().matrices;
    if stored.len() != partition.matrices.len() {
        return Vec::new();
    }
    let of_matrix = |(matrix, carried): (&Matrix, &CarriedMatrix)| {
        let unit = carried.facts.unit;
        Mat::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(i, j)] / unit / (of_coordinate(i) * of_coordinate(j)))
    };
    stored.iter().zip(&partition.matrices).map(of_matrix).collect()
}
