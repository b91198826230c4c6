//! Rigid-body modes: every motion of the component that stores no energy.
//!
//! ```text
//! U    n' × n_r    K U = 0; for one free body the six unit motions, translations first, rotations about the origin
//! Q    n' × n_r    the same space, QᵀMQ = I, used to deflate
//! ```
//!
//! They come from the coordinates where those are known, and are verified against K; without coordinates from the
//! matrices, by inverse iteration. The count is never assumed: it is the number of motions that K lets pass.

mod algebraic;
mod geometric;
mod mechanism;
mod rank;

use faer::{Mat, MatRef};

use crate::dense;
use crate::error::Result;
use crate::job::Coupling;
use crate::modes::{Equilibrated, zero};
use crate::partition::{InterfaceNode, Partition};
use crate::sparse::{Leading, SparseMatrix, absolute_product, product, product_and_terms};

pub use algebraic::from_matrices;
pub(crate) use algebraic::zero_modes;
pub(crate) use geometric::{NO_MASS, moving_directions};
pub use mechanism::{Loose, LooseMotions, with_mechanisms};
pub use rank::{ILL_CONDITIONED, InterfaceRank, confirmed_rank, interface_rank, or_lack_of_rank};
pub(crate) use rank::{scales, unit_motions};

/// Where rigid-body modes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidSource {
    /// Coordinates, verified against K.
    Geometric,
    /// Inverse iteration on K − σM.
    Algebraic,
}

/// The rigid-body modes of a partition.
#[derive(Clone, Debug)]
pub struct RigidBodyModes {
    /// U, n' × n_r; the motions of mechanisms come last.
    pub modes: Mat<f64>,
    /// Q, n' × n_r, spanning the same space: motions with mass first, M-orthonormal, then those without.
    pub orthonormal: Mat<f64>,
    /// M Q, n' × n_r.
    pub mass_orthonormal: Mat<f64>,
    /// How many motions, the last of Q, have neither energy nor mass: M lets them pass too, so that deflation ignores them.
    pub n_massless: usize,
    /// How many motions, the last of U, are those of mechanisms and not of rigid bodies.
    pub n_mechanisms: usize,
    /// How many further motions are so soft that the data hardly tell them from motions without energy; they count as elastic.
    pub n_grey: usize,
    /// Where they come from.
    pub source: RigidSource,
    /// True where the first six columns of U are the unit motions of one free body, so that UᵀMU holds its mass properties.
    pub is_classical: bool,
    /// Energies of the modes against the noise of the data.
    pub energy: RigidEnergy,
}

/// How well K lets the rigid-body modes pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidEnergy {
    /// Largest Rayleigh quotient qᵀKq of an orthonormal mode, in scaled units.
    pub largest_quotient: f64,
    /// Largest relative residual ‖Kq‖ / ‖ |K||q| ‖.
    pub largest_residual: f64,
    /// Largest Rayleigh quotient that rounding of the data can make: ε_K · |q|ᵀ|K||q|.
    pub noise: f64,
    /// How far rounding of the data may turn the modes towards elastic motion: nothing where they are from the coordinates.
    pub angle: f64,
}

impl RigidBodyModes {
    /// n_r.
    pub fn count(&self) -> usize {
        self.modes.ncols()
    }

    /// Whether the rows of the interface are the six unit motions of its nodes to the bit: by the coordinates, or at rigid patches,
    /// whose nodes K ties as it knows them.
    pub fn are_unit_motions(&self, partition: &Partition) -> bool {
        let is_of_patches = || {
            let is_patch = |node: &InterfaceNode| node.coupling == Coupling::Rigid;
            partition.fit.rounded().is_some()
                && !partition.interface.is_empty()
                && partition.interface.iter().all(is_patch)
        };
        self.is_classical && self.n_mechanisms == 0 && (self.source == RigidSource::Geometric || is_of_patches())
    }

    /// The motions of Q that have mass, n' × (n_r − n_massless), M-orthonormal.
    pub fn massive(&self) -> MatRef<'_, f64> {
        self.orthonormal.as_ref().subcols(0, self.count() - self.n_massless)
    }

    /// The motions of Q without mass, n' × n_massless.
    pub fn massless(&self) -> MatRef<'_, f64> {
        self.orthonormal.as_ref().subcols(self.count() - self.n_massless, self.n_massless)
    }

    /// The same modes without those of mechanisms: what was known before these were looked for.
    pub(crate) fn without_mechanisms(&self) -> Self {
        let n = self.count() - self.n_mechanisms;
        let massive = self.massive().subcols(0, n - self.n_massless);
        let orthonormal = dense::beside(massive, self.massless());
        Self { modes: self.modes.as_ref().subcols(0, n).to_owned(), orthonormal, n_mechanisms: 0, ..self.clone() }
    }

    /// The modes of a component that is held: none.
    pub fn none(n_dofs: usize) -> Self {
        Self {
            modes: Mat::zeros(n_dofs, 0),
            orthonormal: Mat::zeros(n_dofs, 0),
            mass_orthonormal: Mat::zeros(n_dofs, 0),
            n_massless: 0,
            n_mechanisms: 0,
            n_grey: 0,
            source: RigidSource::Geometric,
            is_classical: false,
            energy: RigidEnergy::default(),
        }
    }

    /// M_F = UᵀMU, n_r × n_r.
    pub fn rigid_body_mass(&self, mass: &SparseMatrix) -> Mat<f64> {
        let mut m_f = dense::gram(self.modes.as_ref(), product(mass, self.modes.as_ref()).as_ref());
        dense::symmetrise(&mut m_f);
        m_f
    }
}

/// The rigid-body modes, and the factorisations they took: from coordinates none.
///
/// Without an interface there is no S in which mechanisms would show, so that a free component is counted by its matrices too.
///
/// # Errors
/// Those of [`from_coordinates`] and [`from_matrices`].
pub fn rigid_body_modes(partition: &Partition) -> Result<(RigidBodyModes, usize)> {
    let Some(sites) = partition.sites() else {
        return from_matrices(partition);
    };
    let rigid = geometric::rigid_body_modes(partition, &sites)?;
    if partition.n_interface() > 0 || rigid.count() == 0 {
        return Ok((rigid, 0));
    }
    let (every, n_factorisations) = from_matrices(partition)?;
    let n_mechanisms = every.count().saturating_sub(rigid.count());
    let rigid = if n_mechanisms > 0 { RigidBodyModes { n_mechanisms, ..every } } else { rigid };
    Ok((rigid, n_factorisations))
}

/// The rigid-body modes from the coordinates, or `None` where the model has none.
///
/// # Errors
/// A rigid motion without mass or of negative energy.
pub fn from_coordinates(partition: &Partition) -> Result<Option<RigidBodyModes>> {
    partition.sites().map(|sites| geometric::rigid_body_modes(partition, &sites)).transpose()
}

/// |x|ᵀ|A||x| for each column.
pub(crate) fn absolute_energy<'a>(matrix: impl Into<Leading<'a>>, x: MatRef<'_, f64>) -> Vec<f64> {
    energies_of_terms(x, absolute_product(matrix, x).as_ref())
}

/// |x|ᵀ t for each column of x and of its terms |A||x|.
pub(crate) fn energies_of_terms(x: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Vec<f64> {
    let energy = |j: usize| dense::column(x, j).iter().zip(dense::column(terms, j)).map(|(x, t)| x.abs() * t).sum();
    (0..x.ncols()).map(energy).collect()
}

/// Energy xᵀKx up to which one of some motions is zero, by the criterion of [`crate::modes::zero`]; `terms` are |K||x|.
fn zero_energy(partition: &Partition, x: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> f64 {
    let norms = Equilibrated::of(partition.pencil());
    let (digits, sizes) = (partition.energy_noise(x), energies_of_terms(x, terms));
    let patches = partition.patch_terms(x);
    let level = |j: usize| {
        let floor = norms.stiffness_norm * norms.scaled_norm(dense::column(x, j)).powi(2);
        zero::level(digits[j], f64::EPSILON * (sizes[j] + patches[j]), f64::EPSILON * floor)
    };
    (0..x.ncols()).map(level).fold(0.0, f64::max)
}

/// What few digits of K, or roundings of it that rigid patches hide, can make of the energy of a rigid-body motion of unit modal mass.
pub(crate) fn noise_of_digits(partition: &Partition, rigid: &RigidBodyModes) -> f64 {
    let of_patches = partition.patch_terms(rigid.massive()).into_iter().fold(0.0, f64::max);
    let of_digits = match partition.has_few_digits() {
        true => partition.energy_noise(rigid.massive()).into_iter().fold(0.0, f64::max),
        false => 0.0,
    };
    of_digits.max(f64::EPSILON * of_patches)
}

/// The largest ‖Kq‖ / ‖ |K||q| ‖ of the columns.
fn largest_residual(stiffness: &SparseMatrix, q: MatRef<'_, f64>) -> f64 {
    let (forces, terms) = product_and_terms(stiffness, q);
    residuals(forces.as_ref(), terms.as_ref()).into_iter().fold(0.0, f64::max)
}

/// ‖Kq‖ / ‖ |K||q| ‖ of each column, from the two products.
fn residuals(forces: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Vec<f64> {
    let ratio = |j: usize| {
        let size = dense::norm(dense::column(terms, j));
        if size > 0.0 { dense::norm(dense::column(forces, j)) / size } else { 0.0 }
    };
    (0..forces.ncols()).map(ratio).collect()
}
