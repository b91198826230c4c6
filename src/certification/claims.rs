//! The pairs of a result on the dofs of a partition.

use std::path::PathBuf;

use faer::Mat;

use crate::dense;
use crate::error::{Error, Result};
use crate::input::{ForeignModes, ModeValues, ValueSource, ValueUnit};
use crate::partition::{DofOrigin, Partition, TransformationRow};
use crate::sparse::{absolute_energy, product};

/// Where the eigenpairs of another program are.
#[derive(Clone, Debug)]
pub struct PairFiles {
    /// Shapes: a matrix of numbers, or a file of a program that is known.
    pub shapes: PathBuf,
    /// Frequencies, where they are not with the shapes.
    pub values: Option<(ValueUnit, ValueSource)>,
}

/// The pairs of a result on the dofs of a partition.
#[derive(Clone, Debug)]
pub struct Claims {
    /// Shapes, n' × k, each with xᵀMx = 1 where it moves mass.
    pub(super) shapes: Mat<f64>,
    /// Modal masses of the shapes as they are in the file, in the user's units.
    pub(super) modal_masses: Vec<f64>,
    /// Whether a shape moves any mass beyond rounding.
    pub(super) has_mass: Vec<bool>,
    /// λ in scaled units, where the result has frequencies.
    pub(super) lambda: Option<Vec<f64>>,
    /// How far dofs that are held, or follow others, move away from that: relative to the largest displacement of each shape.
    pub(super) not_followed: f64,
    /// What the numbers of the shapes may be off by, relative to each.
    pub(super) shape_rounding: f64,
    /// Likewise of the frequencies.
    pub(super) value_rounding: f64,
    /// What the numbers of the frequencies are.
    pub(super) unit: Option<ValueUnit>,
    /// The numbers as they are.
    pub(super) numbers: Vec<f64>,
}

/// Modal masses relative to their terms that are rounding of the sums.
const MASS_OF_ROUNDING: f64 = dense::NOISE_FACTOR * f64::EPSILON;

impl Claims {
    /// Puts modes that were read on the dofs of a partition.
    ///
    /// # Errors
    /// [`Error::ModesNothing`] for a shape of zeros, or one that moves nothing but held dofs.
    pub fn of(partition: &Partition, modes: &ForeignModes, values: Option<&ModeValues>) -> Result<Self> {
        let (n, k) = (partition.n_dofs(), modes.columns.len());
        let (mut shapes, mut units, mut not_followed) = (Mat::zeros(n, k), Vec::with_capacity(k), 0.0f64);
        for (at, column) in modes.columns.iter().enumerate() {
            let (unit, left) = carried(partition, column, dense::column_mut(shapes.as_mut(), at))
                .ok_or(Error::ModesNothing { mode: at + 1, found: "zero everywhere" })?;
            if dense::column(shapes.as_ref(), at).iter().all(|value| *value == 0.0) {
                return Err(Error::ModesNothing { mode: at + 1, found: "nothing but held dofs that it moves" });
            }
            units.push(unit);
            not_followed = not_followed.max(left);
        }
        let momenta = product(&partition.mass, shapes.as_ref());
        let terms = absolute_energy(&partition.mass, shapes.as_ref());
        let masses = dense::dots(shapes.as_ref(), momenta.as_ref());
        let has_mass: Vec<bool> =
            masses.iter().zip(&terms).map(|(mass, terms)| *mass > MASS_OF_ROUNDING * terms).collect();
        for at in (0..k).filter(|at| has_mass[*at]) {
            let length = masses[at].sqrt();
            dense::column_mut(shapes.as_mut(), at).iter_mut().for_each(|value| *value /= length);
        }
        let unit_of_mass = partition.scaling.mass_unit();
        let of_file = |(mass, unit): (&f64, &f64)| mass * unit * unit * unit_of_mass;
        let to_scaled =
            |values: &ModeValues, number: &f64| values.unit.eigenvalue(*number) / partition.scaling.eigenvalue_unit();
        Ok(Self {
            shapes,
            modal_masses: masses.iter().zip(&units).map(of_file).collect(),
            has_mass,
            lambda: values.map(|values| values.numbers.iter().map(|number| to_scaled(values, number)).collect()),
            not_followed,
            shape_rounding: modes.rounding,
            value_rounding: values.map_or(0.0, |values| values.rounding),
            unit: values.map(|values| values.unit),
            numbers: values.map_or_else(Vec::new, |values| values.numbers.clone()),
        })
    }

    /// k.
    pub fn count(&self) -> usize {
        self.modal_masses.len()
    }
}

/// Puts a shape on the dofs, in a unit that brings its largest entry into [1, 2): the unit, and how far rows without a dof of their own
/// move away from what the dofs make of them. None for a shape of zeros.
pub(super) fn carried(partition: &Partition, column: &[f64], dofs: &mut [f64]) -> Option<(f64, f64)> {
    let rows = &partition.model.rows;
    let n_rows = partition.transformation.rows.len();
    let value = |row: usize| column[rows.of(row)];
    let largest = (0..n_rows).fold(0.0f64, |max, row| max.max(value(row).abs()));
    if largest == 0.0 {
        return None;
    }
    let unit = largest.log2().floor().clamp(-1022.0, 1023.0).exp2();
    for (to, dof) in dofs.iter_mut().zip(&partition.dofs) {
        if let DofOrigin::Row(row) = dof.origin {
            *to = value(row) / unit;
        }
    }
    let left = |(row, of_row): (usize, &TransformationRow)| match of_row {
        TransformationRow::Dof(_) => 0.0,
        other => {
            let moved: f64 = other.entries().map(|(dof, factor)| factor * dofs[dof as usize]).sum();
            (value(row) / unit - moved).abs()
        }
    };
    let worst = partition.transformation.rows.iter().enumerate().map(left).fold(0.0, f64::max);
    Some((unit, worst / (largest / unit)))
}
