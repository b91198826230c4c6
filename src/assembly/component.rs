//! A superelement of an assembly, under the name it has there.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Flag, Superelement, Verdict};

use super::omitted::{Omitted, omitted};
use super::spectrum::Pencil;
use crate::audit::negative_mass;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::error::{Error, Result};
use crate::job::unseen_hz;
use crate::number::{counted, quantity};
use crate::sparse::energies_of_terms;

/// Energy of a rigid-body motion relative to that of the first mode that no rounding leaves: Û is not that of the matrices then.
const LARGEST_RIGID_ENERGY: f64 = 0.1;
/// Energy of rigid-body motion is taken out where it is so many times what double precision leaves. The products that do so add some units
/// of that themselves.
const BEYOND_DOUBLE: f64 = 100.0;

/// A superelement with its name and its matrices.
#[derive(Clone, Debug)]
pub struct Component {
    /// Its name in the assembly.
    pub name: String,
    /// What was read.
    pub superelement: Superelement,
    /// What the reduction left out of its motions.
    pub omitted: Omitted,
    /// K̂, without K̂Û where that is more than rounding to double precision, r × r.
    pub(super) stiffness: Mat<f64>,
    /// M̂, r × r.
    pub(super) mass: Mat<f64>,
    /// Û, r × n_r.
    pub(super) rigid: Mat<f64>,
    /// What is not known of an energy xᵀK̂x is xᵀDx, D r × r: of rigid-body motion what rounding leaves, of motion beyond it as
    /// much as in the file, the error bar of the first mode, and of its energy the largest bar of a mode relative to that.
    pub(super) doubt: Mat<f64>,
}

impl Component {
    /// A component of an assembly; `name` is what selections call it.
    ///
    /// # Errors
    /// [`Error::AssemblyNoMass`] of a superelement for statics alone; [`Error::AssemblySingularMass`] where a method left static answers without mass; [`Error::AssemblyIndefinite`] where the mass has a negative eigenvalue, [`Error::AssemblyRigid`] where the rigid-body modes strain it;
    /// [`Error::DenseEigen`].
    pub fn new(name: String, superelement: Superelement) -> Result<Self> {
        // Small matrices are decomposed by one thread, so that the order of sums never depends on how many there are.
        faer::set_global_parallelism(faer::Par::Seq);
        if superelement.metadata().flags.contains(&Flag::StiffnessOnly) {
            return Err(Error::AssemblyNoMass { name });
        }
        if superelement.metadata().flags.contains(&Flag::SingularMass) {
            return Err(Error::AssemblySingularMass { name });
        }
        let tensors = superelement.tensors();
        let (stiffness, mass) = (unpacked(&tensors.stiffness), unpacked(&tensors.mass));
        let rigid = unpacked(&tensors.rigid_body_modes);
        if let Some(value) = negative_mass(mass.as_ref())? {
            return Err(Error::AssemblyIndefinite { what: format!("component {name}"), matrix: "mass", value });
        }
        let motions = dense::orthonormal(rigid.as_ref(), mass.as_ref());
        let rounding = largest_energy(stiffness.as_ref(), motions.as_ref())?;
        let mut unit = energy_unit(&superelement);
        if rounding > LARGEST_RIGID_ENERGY * unit {
            // A mode that the file states may be that of a heavy mass with the interface held, far slower than the free component.
            unit = unit.max(first_elastic((&stiffness, &mass), &motions)?.unwrap_or(0.0));
        }
        if rounding > LARGEST_RIGID_ENERGY * unit {
            return Err(Error::AssemblyRigid { name, value: rounding / unit });
        }
        let omitted = omitted(&superelement, stiffness.as_ref(), mass.as_ref(), rigid.as_ref())?;
        let momenta = dense::product(mass.as_ref(), motions.as_ref());
        let of_double = rounding_of_double(stiffness.as_ref(), motions.as_ref());
        // A file that failed its checks may have energy there that is none of rounding.
        let is_checked = superelement.metadata().verification.verdict != Verdict::Fail;
        let (stiffness, left) = match is_checked && rounding > BEYOND_DOUBLE * of_double {
            true => (without_rigid_energy(stiffness, (motions.as_ref(), momenta.as_ref())), of_double),
            false => (stiffness, rounding),
        };
        let doubts = (NOISE_FACTOR * left, NOISE_FACTOR * rounding + known_to(&superelement));
        let mut doubt = doubt(mass.as_ref(), &momenta, doubts);
        doubt += &stiffness * faer::Scale(largest_bar(&superelement));
        Ok(Self { name, superelement, omitted, stiffness, mass, rigid, doubt })
    }

    /// How many modes it leaves out because nothing starts or sees them, in words; none where it leaves out none.
    pub fn unseen_modes(&self) -> Option<String> {
        let all = unseen_hz(&self.superelement);
        let lowest = all.iter().copied().reduce(f64::min)?;
        let n = counted(all.len(), "mode", "modes");
        Some(format!(
            "{} leaves out {n} that nothing starts or sees, the lowest at {} Hz",
            self.name,
            quantity(lowest, 7)
        ))
    }

    /// r.
    pub fn n_coordinates(&self) -> usize {
        self.stiffness.nrows()
    }

    /// What a coordinate is called in messages.
    pub(super) fn name_of(&self, coordinate: usize) -> String {
        let metadata = self.superelement.metadata();
        let of_component = match &metadata.coordinates[coordinate] {
            Coordinate::Interface { node, direction } => {
                format!("{}.{direction}", metadata.interface_nodes[*node].name)
            }
            Coordinate::InterfaceRow { row } => format!("rows:{row}"),
            mode => mode.mode_name(&metadata.load_names).unwrap_or_default(),
        };
        format!("{}.{of_component}", self.name)
    }

    /// How large the component is, as far as its file tells: the largest of the distances between interface nodes, from them to the
    /// centre of mass, and of the radius of gyration.
    pub(super) fn size(&self) -> f64 {
        let positions = &self.superelement.tensors().interface_positions;
        let properties = self.superelement.metadata().model.mass_properties.as_ref();
        let centre = properties.map(|properties| properties.center_of_mass);
        let gyration = properties.filter(|properties| properties.mass > 0.0).map_or(0.0, |properties| {
            let trace: f64 = (0..3).map(|axis| properties.inertia[axis][axis]).sum();
            (0.5 * trace.max(0.0) / properties.mass).sqrt()
        });
        // The farthest from any of the points is at least half of the largest distance between two: enough for a size.
        let from_first = |point: &[f64; 3]| positions.first().map_or(0.0, |first| distance(first, point));
        positions.iter().chain(&centre).map(from_first).fold(gyration, f64::max)
    }
}

pub(super) fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// The first eigenvalue of the free component that is more than rounding.
fn first_elastic((stiffness, mass): (&Mat<f64>, &Mat<f64>), motions: &Mat<f64>) -> Result<Option<f64>> {
    let spectrum = Pencil::of(stiffness.as_ref(), mass.as_ref(), motions.clone()).spectrum(None)?;
    Ok(spectrum.and_then(|spectrum| spectrum.first_elastic()))
}

/// The largest energy in any combination of M-orthonormal motions.
fn largest_energy(stiffness: MatRef<'_, f64>, motions: MatRef<'_, f64>) -> Result<f64> {
    let mut energies = dense::gram(motions, dense::product(stiffness, motions).as_ref());
    dense::symmetrise(&mut energies);
    let (values, _) = dense::symmetric_eigen(energies.as_ref())?;
    Ok(values.into_iter().fold(0.0, |most, value| most.max(value.abs())))
}

/// PᵀK̂P with P = 1 − R(M̂R)ᵀ, R rigid-body motions with RᵀM̂R = 1: no force of rigid-body motion is left, which in K̂ is rounding and next to
/// a component that is softer by orders would hold this one to the ground.
fn without_rigid_energy(stiffness: Mat<f64>, (motions, momenta): (MatRef<'_, f64>, MatRef<'_, f64>)) -> Mat<f64> {
    let forces = dense::product(stiffness.as_ref(), motions);
    let energies = dense::gram(motions, forces.as_ref());
    let half = forces - dense::product(momenta, energies.as_ref()) * faer::Scale(0.5);
    let mut free = stiffness;
    dense::add_product(free.as_mut(), -1.0, half.as_ref(), momenta.transpose());
    dense::add_product(free.as_mut(), -1.0, momenta, half.transpose());
    dense::symmetrise(&mut free);
    free
}

/// What rounding to double precision of the terms alone leaves of the energy of rigid-body motion, ε |r|ᵀ|K̂||r|.
fn rounding_of_double(stiffness: MatRef<'_, f64>, motions: MatRef<'_, f64>) -> f64 {
    let terms = dense::product(dense::absolute(stiffness).as_ref(), dense::absolute(motions).as_ref());
    energies_of_terms(motions, terms.as_ref()).into_iter().fold(0.0, f64::max) * f64::EPSILON
}

/// α M̂R(M̂R)ᵀ + β (M̂ − M̂R(M̂R)ᵀ), R rigid-body motions with RᵀM̂R = 1: what rounding leaves of the energies of these, and what it and the error
/// bars leave of those of others. It has no moduli, which next to a heavy mass are far more than what such motion moves.
fn doubt(mass: MatRef<'_, f64>, momenta: &Mat<f64>, (of_rigid, of_others): (f64, f64)) -> Mat<f64> {
    let rigid = dense::product(momenta.as_ref(), momenta.transpose());
    Mat::from_fn(mass.nrows(), mass.ncols(), |i, j| {
        of_rigid * rigid[(i, j)] + of_others * (mass[(i, j)] - rigid[(i, j)])
    })
}

/// How far the first eigenvalue of a mode may be off by its error bar; zero without modes, and the eigenvalue itself where no bar is known.
fn known_to(superelement: &Superelement) -> f64 {
    let coordinates = &superelement.metadata().coordinates;
    let first = coordinates.iter().find_map(|coordinate| Some((coordinate.mode()?.1, coordinate.error_bar_hz())));
    first.map_or(0.0, |(hertz, bar)| {
        let [lower, upper] = [hertz, hertz + bar.unwrap_or(hertz)].map(|hertz| (std::f64::consts::TAU * hertz).powi(2));
        upper - lower
    })
}

/// The largest error bar of an eigenvalue relative to it: of the energy of stiffer motion as much is not known.
fn largest_bar(superelement: &Superelement) -> f64 {
    let coordinates = superelement.metadata().coordinates.iter();
    let bars = coordinates.filter_map(|coordinate| Some(coordinate.error_bar_hz()? / coordinate.mode()?.1));
    bars.filter(|bar| bar.is_finite()).fold(0.0, |largest, bar| f64::max(largest, bar * (2.0 + bar)))
}

/// What energies are compared with: the eigenvalue of the first mode that the file states, or of the stiffest coordinate where it states
/// none.
fn energy_unit(superelement: &Superelement) -> f64 {
    let tensors = superelement.tensors();
    let stated = superelement.frequencies_kept().into_iter().map(|omega| omega * omega).find(|lambda| *lambda > 0.0);
    let ratio = |i: usize| (tensors.stiffness[(i, i)] / tensors.mass[(i, i)]).abs();
    let ratios = (0..tensors.mass.rows()).map(ratio).filter(|ratio| ratio.is_finite());
    stated.unwrap_or_else(|| ratios.fold(0.0, f64::max))
}
