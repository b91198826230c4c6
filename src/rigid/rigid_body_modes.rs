//! The rigid-body modes of a partition, and how well K lets them pass.

use faer::{Mat, MatRef};
/// Geometric ones come from coordinates and are verified against K, algebraic ones from inverse iteration on K − σM.
pub use supel_runtime::RigidBodyModes as RigidSource;

use super::residual::Residual;
use crate::cache::Key;
use crate::dense;
use crate::job::Boundary;
use crate::partition::{InterfaceNode, Partition};
use crate::plan::Relief;
use crate::sparse::{SparseMatrix, product};

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
    /// Those motions with mass that leave the dofs at rest which are held while mixed-interface modes are computed, at the dofs of that
    /// eigenproblem; none under any other boundary.
    pub passing: Option<Box<RigidBodyModes>>,
}

/// How well K lets the rigid-body modes pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidEnergy {
    /// Largest Rayleigh quotient qᵀKq of an orthonormal mode, in scaled units.
    pub largest_quotient: f64,
    /// Largest relative residual ‖Kq‖ / ‖ |K||q| ‖.
    pub largest_residual: f64,
    /// What rounding of coordinates and of the entries of K makes of it; not asked for where practice accepts it.
    pub residual_rounding: f64,
    /// Largest Rayleigh quotient that rounding of the data can make: ε_K · |q|ᵀ|K||q|.
    pub noise: f64,
    /// How far rounding of the data may turn the modes towards elastic motion: nothing where they are from the coordinates.
    pub angle: f64,
}

impl RigidEnergy {
    /// Its residual, as [`Residual`] joins it with others.
    pub(crate) fn residual(&self) -> Residual {
        Residual { value: self.largest_residual, rounding: self.residual_rounding }
    }

    /// With the residual of further motions.
    #[must_use]
    pub(crate) fn with_residual(self, other: Residual) -> Self {
        let Residual { value, rounding } = self.residual().and(other);
        Self { largest_residual: value, residual_rounding: rounding, ..self }
    }
}

impl RigidBodyModes {
    /// Motions without energy that are none of a body as a whole: without coordinates a body can move in six ways at most.
    pub fn n_inside(&self, n_bodies: usize) -> usize {
        let surplus = match self.source {
            RigidSource::Algebraic => self.count().saturating_sub(6 * n_bodies),
            RigidSource::Geometric => 0,
        };
        self.n_mechanisms.max(surplus)
    }

    /// Eigenvalue below which zero modes that are known from the matrices alone cannot be told from elastic ones; zero for those of coordinates.
    pub fn level_of_digits(&self) -> f64 {
        match self.source {
            RigidSource::Algebraic => self.energy.noise,
            RigidSource::Geometric => 0.0,
        }
    }

    /// Goes on with the key of what is made of them.
    pub(crate) fn key(&self, key: Key) -> Key {
        let Self {
            modes,
            orthonormal,
            mass_orthonormal,
            n_massless,
            n_mechanisms,
            n_grey,
            source,
            is_classical,
            energy,
            passing,
        } = self;
        let key = [modes, orthonormal, mass_orthonormal].iter().fold(key, |key, motions| key.columns(motions.as_ref()));
        let key = key.shown(&(n_massless, n_mechanisms, n_grey, source, is_classical, energy, passing.is_some()));
        passing.iter().fold(key, |key, passing| passing.key(key))
    }

    /// n_r.
    pub fn count(&self) -> usize {
        self.modes.ncols()
    }

    /// Whether the rows of the interface are the six unit motions of its nodes to the bit: by the coordinates, or at rigid patches,
    /// whose nodes K ties as it knows them.
    pub fn are_unit_motions(&self, partition: &Partition) -> bool {
        let is_of_patches = || {
            let is_patch = |node: &InterfaceNode| node.coupling.is_patch();
            partition.fit.rounded().is_some()
                && !partition.interface.is_empty()
                && partition.interface.iter().all(is_patch)
        };
        self.is_classical && self.n_mechanisms == 0 && (self.source == RigidSource::Geometric || is_of_patches())
    }

    /// What the file calls them.
    pub fn in_file(&self, partition: &Partition) -> RigidSource {
        match self.are_unit_motions(partition) {
            true => RigidSource::Geometric,
            false => RigidSource::Algebraic,
        }
    }

    /// Numbers of those that have a column of inertia relief.
    pub fn relieved(&self, partition: &Partition, relief: Relief) -> Vec<usize> {
        relief.motions(self.count(), self.in_file(partition))
    }

    /// The motions of Q that have mass, n' × (n_r − n_massless), M-orthonormal.
    pub fn massive(&self) -> MatRef<'_, f64> {
        self.orthonormal.as_ref().subcols(0, self.count() - self.n_massless)
    }

    /// The motions of Q without mass, n' × n_massless.
    pub fn massless(&self) -> MatRef<'_, f64> {
        self.orthonormal.as_ref().subcols(self.count() - self.n_massless, self.n_massless)
    }

    /// The motions that a boundary leaves free, at the dofs of its eigenproblem; none where it leaves none.
    pub fn under(&self, boundary: Boundary) -> Option<&Self> {
        match boundary {
            Boundary::FreeInterface => Some(self),
            Boundary::FixedInterface => None,
            Boundary::MixedInterface => self.passing.as_deref(),
        }
    }

    /// These modes without those of mechanisms: what was known before these were looked for.
    pub(crate) fn without_mechanisms(&self) -> Self {
        let n = self.count() - self.n_mechanisms;
        let massive = self.massive().subcols(0, n - self.n_massless);
        let orthonormal = dense::side_by_side(massive, self.massless());
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
            passing: None,
        }
    }

    /// Q and MQ, what eigensolvers deflate.
    pub fn deflated(&self) -> [MatRef<'_, f64>; 2] {
        [self.orthonormal.as_ref(), self.mass_orthonormal.as_ref()]
    }

    /// M_F = UᵀMU, n_r × n_r.
    pub fn rigid_body_mass(&self, mass: &SparseMatrix) -> Mat<f64> {
        let mut m_f = dense::gram(self.modes.as_ref(), product(mass, self.modes.as_ref()).as_ref());
        dense::symmetrise(&mut m_f);
        m_f
    }
}
