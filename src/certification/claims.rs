//! The pairs of a result on the dofs of a partition.

use std::path::PathBuf;

use faer::Mat;

use super::carrier::{Carried, Carrier};
use super::strayed::Strayed;
use crate::dense;
use crate::error::{Error, Result};
use crate::input::{ForeignModes, ModeValues, ValueSource, ValueUnit};
use crate::partition::Partition;
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
    /// How far rows that are held, or follow others, are from where they have to be in each shape.
    pub(super) strayed: Vec<Strayed>,
    /// What the numbers of each shape may be off by, relative to them.
    pub(super) shape_rounding: Vec<f64>,
    /// Length of what the digits of each shape round, in the norm of the mass and relative to the shape: δxᵀMδx ≤ u² |x|ᵀ|M||x|.
    pub(super) rounded: Vec<f64>,
    /// What each stated frequency may be off by, relative to it; zero where the result has none.
    pub(super) value_rounding: Vec<f64>,
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
        let (mut shapes, mut carried) = (Mat::zeros(n, k), Vec::with_capacity(k));
        let carrier = Carrier::of(partition);
        for (at, column) in modes.columns.iter().enumerate() {
            let found = carrier
                .carry(column, modes.rounding, dense::column_mut(shapes.as_mut(), at))
                .ok_or(Error::ModesNothing { mode: at + 1, found: "zero everywhere" })?;
            if dense::column(shapes.as_ref(), at).iter().all(|value| *value == 0.0) {
                return Err(Error::ModesNothing { mode: at + 1, found: "nothing but held dofs that it moves" });
            }
            carried.push(found);
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
        // Half a unit of the last digit is that of the number as it was, which is smaller by as much at most.
        let of_shape = |at: usize| {
            let u = carried[at].rounding;
            if has_mass[at] && u < 1.0 { u / (1.0 - u) * (terms[at] / masses[at]).sqrt() } else { 0.0 }
        };
        let rounded = (0..k).map(of_shape).collect();
        let unit_of_mass = partition.scaling.mass_unit();
        let of_file = |(mass, shape): (&f64, &Carried)| mass * shape.unit * shape.unit * unit_of_mass;
        let to_scaled =
            |values: &ModeValues, number: &f64| values.unit.eigenvalue(*number) / partition.scaling.eigenvalue_unit();
        Ok(Self {
            shapes,
            modal_masses: masses.iter().zip(&carried).map(of_file).collect(),
            has_mass,
            lambda: values.map(|values| values.numbers.iter().map(|number| to_scaled(values, number)).collect()),
            strayed: carried.iter().map(|shape| shape.strayed).collect(),
            shape_rounding: carried.iter().map(|shape| shape.rounding).collect(),
            rounded,
            value_rounding: values
                .map_or_else(|| vec![0.0; k], |values| (0..k).map(|at| values.rounding_of(at)).collect()),
            unit: values.map(|values| values.unit),
            numbers: values.map_or_else(Vec::new, |values| values.numbers.clone()),
        })
    }

    /// Some of the pairs, by their numbers from zero.
    pub(super) fn only(&self, pairs: &[usize]) -> Self {
        let of = |values: &[f64]| pairs.iter().filter_map(|at| values.get(*at).copied()).collect::<Vec<f64>>();
        Self {
            shapes: dense::columns(self.shapes.as_ref(), pairs),
            modal_masses: of(&self.modal_masses),
            has_mass: pairs.iter().map(|at| self.has_mass[*at]).collect(),
            lambda: self.lambda.as_deref().map(of),
            strayed: pairs.iter().map(|at| self.strayed[*at]).collect(),
            shape_rounding: of(&self.shape_rounding),
            rounded: of(&self.rounded),
            value_rounding: of(&self.value_rounding),
            unit: self.unit,
            numbers: of(&self.numbers),
        }
    }

    /// k.
    pub fn count(&self) -> usize {
        self.modal_masses.len()
    }
}
