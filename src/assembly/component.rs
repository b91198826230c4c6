//! A superelement of an assembly, under the name it has there.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Flag, Superelement};

use super::omitted::{Omitted, omitted};
use super::spectrum::Pencil;
use crate::audit::negative_mass;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::error::{Error, Result};

/// Energy of a rigid-body motion relative to that of the first mode that no rounding leaves: Û is not that of the matrices then.
const LARGEST_RIGID_ENERGY: f64 = 0.1;

/// A superelement with its name and its matrices.
#[derive(Clone, Debug)]
pub struct Component {
    /// Its name in the assembly.
    pub name: String,
    /// What was read.
    pub superelement: Superelement,
    /// What the reduction left out of its motions.
    pub omitted: Omitted,
    /// K̂, r × r.
    pub(super) stiffness: Mat<f64>,
    /// M̂, r × r.
    pub(super) mass: Mat<f64>,
    /// Û, r × n_r.
    pub(super) rigid: Mat<f64>,
    /// What is not known of an energy xᵀK̂x is xᵀDx, D r × r: the energy that rigid-body motion has by rounding of K̂, and beyond it
    /// the error bar of the first mode.
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
        let doubt = doubt(mass.as_ref(), motions.as_ref(), (NOISE_FACTOR * rounding, known_to(&superelement)));
        Ok(Self { name, superelement, omitted, stiffness, mass, rigid, doubt })
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

/// ρ M̂ + κ (M̂ − M̂R(M̂R)ᵀ), ρ the rounding, κ what the first eigenvalue is known to, R rigid-body motions with RᵀM̂R = 1: what rounding of the
/// full matrices makes of an energy is of motion beyond theirs. It has no moduli, which next to a heavy mass are far more than what such motion moves.
fn doubt(mass: MatRef<'_, f64>, motions: MatRef<'_, f64>, (rounding, known_to): (f64, f64)) -> Mat<f64> {
    let momenta = dense::product(mass, motions);
    let rigid = dense::product(momenta.as_ref(), momenta.transpose());
    Mat::from_fn(mass.nrows(), mass.ncols(), |i, j| (rounding + known_to) * mass[(i, j)] - known_to * rigid[(i, j)])
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

/// What energies are compared with: the eigenvalue of the first mode that the file states, or of the stiffest coordinate where it states
/// none.
fn energy_unit(superelement: &Superelement) -> f64 {
    let tensors = superelement.tensors();
    let stated = tensors.frequencies.iter().map(|omega| omega * omega).find(|lambda| *lambda > 0.0);
    let ratio = |i: usize| (tensors.stiffness[(i, i)] / tensors.mass[(i, i)]).abs();
    let ratios = (0..tensors.mass.rows()).map(ratio).filter(|ratio| ratio.is_finite());
    stated.unwrap_or_else(|| ratios.fold(0.0, f64::max))
}
