//! Rigid-body modes from the matrices alone, by inverse iteration on K − σM.

use faer::Mat;

use super::rigid_body_modes::{RigidBodyModes, RigidEnergy, RigidSource};
use super::rounding::residual;
use crate::cache::{Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::eigen::{Shifted, mass_qr, shifted};
use crate::error::{Error, Result};
use crate::factor::{Analysis, SolveOperator};
use crate::partition::Partition;
use crate::sparse::Rounding;
use crate::sparse::energies_of_terms;
use crate::sparse::{product, product_and_terms};

/// The zero modes of a pencil without coordinates, with the factorisations they took.
///
/// They span every motion without energy: rigid-body motions and mechanisms alike.
///
/// # Errors
/// K − σM is not definite for a negative σ; the eigensolver fails.
pub fn from_matrices(partition: &Partition) -> Result<(RigidBodyModes, usize)> {
    zero_modes(partition).map(|found| (found.rigid, found.n_factorisations))
}

/// The zero modes with what was found above them.
pub(crate) struct ZeroModes {
    pub(crate) rigid: RigidBodyModes,
    /// Eigenvalues above zero, ascending: the first ones, or none where there are none.
    pub(crate) elastic: Vec<f64>,
    /// Relative error bar that few digits of K leave of the first of them; 0 where there are none or the digits are all there.
    pub(crate) bar_of_digits: f64,
    /// Factorisations it took.
    pub(crate) n_factorisations: usize,
}

/// The zero modes with the first eigenvalues above zero.
///
/// # Errors
/// As [`from_matrices`].
pub(crate) fn zero_modes(partition: &Partition) -> Result<ZeroModes> {
    // More of them than bodies can have are looked at twice.
    let key = || partition.key("zero modes").numbers(&[partition.model.n_bodies]);
    recalled(partition.cache(), key, || found_zero_modes(partition))
}

/// [`zero_modes`], whatever earlier runs have kept.
pub(crate) fn found_zero_modes(partition: &Partition) -> Result<ZeroModes> {
    let analysis = Analysis::new(partition.pencil())?;
    let problem = partition.free_problem();
    let found = shifted(&analysis, problem, &|step| partition.name_of(step))?;
    let bar_of_digits = bar_of_digits(partition, &found);
    // A soft mode looks like a mechanism where rounding of few digits is larger than its energy: more zero modes than bodies can have are
    // believed where that rounding is nothing compared with the first elastic mode.
    if found.n_zero > 6 * partition.model.n_bodies {
        refuse_uncounted(partition.precision.stiffness, found.n_zero, bar_of_digits)?;
    }
    let orthonormal = without_elastic_rounding(partition, &found);
    let (forces, terms) = product_and_terms(&partition.stiffness, orthonormal.as_ref());
    let magnitudes = energies_of_terms(orthonormal.as_ref(), terms.as_ref());
    let elastic: Vec<f64> = found.lowest.lambda[found.n_zero..].iter().copied().chain(found.lowest.next).collect();
    let (mass_orthonormal, of_mass) = product_and_terms(&partition.mass, orthonormal.as_ref());
    // A free particle strains nothing, and its terms are rounding themselves: its inertia in the first elastic mode stands next to them, which is
    // less than the terms of what is joined to something.
    let sizes = &terms + of_mass * faer::Scale(elastic.first().copied().unwrap_or(0.0));
    let residual = residual(partition, orthonormal.as_ref(), [forces.as_ref(), sizes.as_ref()], None);
    // A rounding E turns a zero mode towards an elastic one x by xᵀEq / λ, and xᵀEq is what it makes of the energies of the two.
    let level = found.lowest.errors[..found.n_zero].iter().map(|error| error.zero_level).fold(0.0, f64::max);
    let angle = elastic.first().map_or(0.0, |lambda| level / lambda);
    let mut energy = RigidEnergy { angle, ..RigidEnergy::default() }.with_residual(residual);
    for (j, magnitude) in magnitudes.iter().enumerate() {
        let (q, force) = (dense::column(orthonormal.as_ref(), j), dense::column(forces.as_ref(), j));
        energy.largest_quotient = energy.largest_quotient.max(dense::dot(q, force).abs());
        energy.noise = energy.noise.max((partition.precision.stiffness.share + f64::EPSILON) * magnitude);
    }
    let rigid = algebraic(orthonormal, mass_orthonormal, energy);
    Ok(ZeroModes { rigid, elastic, bar_of_digits, n_factorisations: found.n_factorisations })
}

/// Modes that come from the matrices, Q and M Q.
fn algebraic(orthonormal: Mat<f64>, mass_orthonormal: Mat<f64>, energy: RigidEnergy) -> RigidBodyModes {
    RigidBodyModes {
        modes: orthonormal.clone(),
        mass_orthonormal,
        orthonormal,
        n_massless: 0,
        n_mechanisms: 0,
        n_grey: 0,
        source: RigidSource::Algebraic,
        is_classical: false,
        energy,
        passing: None,
    }
}

impl Recorded for ZeroModes {
    const KIND: Kind = Kind::Modes;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { rigid, elastic, bar_of_digits, n_factorisations } = self;
        let RigidEnergy { largest_quotient, largest_residual, residual_rounding, noise, angle } = rigid.energy;
        to.columns(rigid.orthonormal.as_ref())?;
        to.columns(rigid.mass_orthonormal.as_ref())?;
        to.array(&[largest_quotient, largest_residual, residual_rounding, noise, angle])?;
        to.array(elastic)?;
        to.array(&[*bar_of_digits])?;
        to.counts(&[*n_factorisations])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let (orthonormal, mass_orthonormal) = (from.columns()?, from.columns()?);
        let [largest_quotient, largest_residual, residual_rounding, noise, angle] = from.array()?[..] else {
            return None;
        };
        let energy = RigidEnergy { largest_quotient, largest_residual, residual_rounding, noise, angle };
        let (elastic, bar_of_digits) = (from.array()?, from.number()?);
        let [n_factorisations] = from.counts()?[..] else { return None };
        Some(Self { rigid: algebraic(orthonormal, mass_orthonormal, energy), elastic, bar_of_digits, n_factorisations })
    }
}

/// Relative error bar of the first elastic eigenvalue up to which mechanisms below it are counted: what is lost in rounding is then
/// slower than a hundredth of the first elastic mode, as what M-05 takes for a support is.
const COUNTED_BELOW: f64 = 1e-4;

/// What few digits leave of the first eigenvalue above the zero ones.
pub(crate) fn bar_of_digits(partition: &Partition, found: &Shifted<'_>) -> f64 {
    match (found.lowest.errors.get(found.n_zero), found.lowest.next) {
        _ if !partition.has_few_digits() => 0.0,
        (Some(error), _) => error.data_bar,
        // Nothing was found that is not zero, and there is more.
        (None, Some(_)) => 1.0,
        (None, None) => 0.0,
    }
}

/// Whether the bar of the first eigenvalue that seems to be none of a motion without energy is too large for a count of these.
pub(crate) fn is_uncounted(bar: f64) -> bool {
    bar > COUNTED_BELOW
}

/// An error where motions seem to cost no energy, and the next one is known to too large a share of its eigenvalue, `bar`.
pub(crate) fn refuse_uncounted(rounding: Rounding, n_zero: usize, bar: f64) -> Result<()> {
    if !is_uncounted(bar) {
        return Ok(());
    }
    let known = 0.5 * bar;
    let what = format!(
        "how many motions cost no energy: {n_zero} seem to, and with the frequency of the next known to {known:.0e} of itself \
         elastic ones may be among them"
    );
    Err(rounding.too_uncertain(what))
}

/// The error where no motion of the interface is left whose energy the digits tell from none.
pub(crate) fn lost_interface(rounding: Rounding, n_zero: usize) -> Error {
    let what = format!(
        "how many motions cost no energy: {n_zero} seem to, and these are all that the interface can do, so that nothing is left of its \
         stiffness"
    );
    rounding.too_uncertain(what)
}

/// The zero modes after a step of inverse iteration, which takes what rounding of the eigensolver left of an elastic motion
/// λ down to σ/(λ + σ) of itself: forces are λ times the motion, and the stiffest ones would be all that is left of KQ.
fn without_elastic_rounding(partition: &Partition, found: &Shifted<'_>) -> Mat<f64> {
    let mut zero = found.lowest.shapes.as_ref().subcols(0, found.n_zero).to_owned();
    let mut momenta = product(&partition.mass, zero.as_ref());
    zero.copy_from(&momenta);
    found.factor.solve_in_place(zero.as_mut());
    // Twice is enough for orthogonality to rounding; modes this near to orthonormal depend on none of the others.
    for _ in 0..2 {
        momenta = product(&partition.mass, zero.as_ref());
        mass_qr(&mut zero, &mut momenta, 0.0, &mut vec![false; found.n_zero]);
    }
    zero
}
