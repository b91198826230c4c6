//! The superelement: a component reduced to its interface and a few modal amplitudes.

use alloc::vec::Vec;

use crate::coordinate::Coordinate;
use crate::error::Result;
use crate::further_matrix::NamedMatrix;
use crate::matrix::Matrix;
use crate::metadata::Metadata;
use crate::tensors::Tensors;
use crate::validation;

/// A superelement whose parts are known to fit each other; it cannot be changed, so threads may share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Superelement {
    tensors: Tensors,
    metadata: Metadata,
}

impl Superelement {
    /// A superelement from its numbers and what they mean.
    ///
    /// # Errors
    ///
    /// The content variants of [`FileError`](crate::FileError): shapes that contradict the coordinates, values that are not finite, a
    /// stiffness or mass matrix that is not symmetric to the bit, a further matrix that is not what its kind demands, coordinates out of
    /// order, modes, positions or verdicts that metadata and tensors give differently.
    pub fn new(tensors: Tensors, metadata: Metadata) -> Result<Self> {
        validation::check(&tensors, &metadata)?;
        Ok(Self { tensors, metadata })
    }

    /// The numbers.
    pub fn tensors(&self) -> &Tensors {
        &self.tensors
    }

    /// What they mean.
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// The further matrices with what they are, in the order of the file.
    pub fn further_matrices(&self) -> impl Iterator<Item = (&NamedMatrix, &Matrix)> {
        self.metadata.matrices.iter().zip(&self.tensors.matrices)
    }

    /// Number of reduced coordinates r = n_B + n_η.
    pub fn n_coordinates(&self) -> usize {
        self.metadata.coordinates.len()
    }

    /// Number of interface coordinates n_B, which come first.
    pub fn n_interface(&self) -> usize {
        self.metadata.coordinates.iter().filter(|coordinate| coordinate.is_interface()).count()
    }

    /// Number of modal amplitudes n_η, which come last.
    pub fn n_modal(&self) -> usize {
        self.n_coordinates() - self.n_interface()
    }

    /// Whether rigid-body modes are coordinates beside those of an interface, which leaves some of their motions free: modal amplitudes
    /// then move with a rigid-body motion.
    pub fn has_rigid_amplitudes(&self) -> bool {
        let mut named = self.metadata.named_columns();
        self.n_interface() > 0 && named.any(|coordinate| matches!(coordinate, Coordinate::RigidBodyMode { .. }))
    }

    /// ω of the modes that the coordinates have, ascending: those that were left out because nothing sees them are not among them.
    pub fn frequencies_kept(&self) -> Vec<f64> {
        let unseen: Vec<usize> = self.metadata.unseen_modes().collect();
        let all = self.tensors.frequencies.iter().enumerate();
        all.filter(|(mode, _)| !unseen.contains(mode)).map(|(_, omega)| *omega).collect()
    }

    /// Number of rigid-body modes n_r.
    pub fn n_rigid(&self) -> usize {
        self.tensors.rigid_body_modes.cols()
    }
}
