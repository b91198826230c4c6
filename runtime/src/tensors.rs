//! The numbers of a superelement, which say nothing of what they mean.
//!
//! | symbol | field | shape |
//! |---|---|---|
//! | K̂, M̂ | `stiffness`, `mass` | r × r, r = n_B + n_η |
//! | Û | `rigid_body_modes` | r × n_r |
//! | M_F | `rigid_body_mass` | n_r × n_r |
//! | ω | `frequencies` | n_modes, rad/s |

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::direction::Direction;
use crate::error::{FileError, Result};
use crate::matrix::Matrix;
use crate::recovered_faces::RecoveredFaces;

/// The numbers of a superelement, under the names they have in the file.
///
/// All are in classical coordinates: displacement and rotation of each interface node in the inertial frame, followed
/// by the modal amplitudes. Units are those of the model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tensors {
    /// Reduced stiffness matrix K̂, r × r, symmetric to the bit.
    pub stiffness: Matrix,
    /// Reduced mass matrix M̂, r × r, symmetric to the bit; empty, 0 × 0, and absent from the file where the flags say that it has the
    /// stiffness only.
    pub mass: Matrix,
    /// Rigid-body modes in the reduced coordinates Û, r × n_r; n_r is 6 for each free component, 0 for a fixed one.
    pub rigid_body_modes: Matrix,
    /// Rigid-body mass M_F = UᵀMU of the full model, n_r × n_r; empty and absent where the mass is.
    pub rigid_body_mass: Matrix,
    /// Positions of the k interface nodes in the reference configuration, k × 3.
    pub interface_positions: Vec<[f64; 3]>,
    /// Rotation matrices of the k interface nodes, k × 3 × 3: columns are the node's axes in the inertial frame.
    pub interface_frames: Vec<[[f64; 3]; 3]>,
    /// Natural angular frequencies of the modes that were computed, n_modes, rad/s, ascending: fixed-interface ones for
    /// Craig-Bampton, elastic free-free ones for Herting and Rubin.
    pub frequencies: Vec<f64>,
    /// Reduced damping matrix, r × r.
    pub damping: Option<Matrix>,
    /// Mixing of the modal columns, n_η × n_η: stored dynamic modes = named modes · mixing.
    pub mixing: Option<Matrix>,
    /// Loads of a unit gravity field along x, y, z, r × 3.
    pub gravity: Option<Matrix>,
    /// Reduced load vectors, r × n_loads, named by `load_names` of the metadata.
    pub load_vectors: Option<Matrix>,
    /// Rows of the reduction basis for displacements inside the component.
    pub recovery: Option<Recovery>,
    /// Rows R Ψ of quantities that follow from displacements, stresses for instance, m × r, named by `quantities` of the metadata.
    pub quantities: Option<Matrix>,
    /// Further matrices ΨᵀAΨ, r × r each, named by `matrices` of the metadata. Skew parts are kept.
    pub matrices: Vec<Matrix>,
}

/// Rows of the reduction basis Ψ: displacement inside the component = `rows` · reduced coordinates.
///
/// In single precision they are fit for the deformation, to which the client adds the rigid-body motion; applied to the whole
/// motion they would lose the deformation in the rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct Recovery {
    pub(crate) rows: Matrix,
    pub(crate) dofs: Vec<RecoveredDof>,
    pub(crate) precision: Precision,
    pub(crate) positions: Option<Vec<[f64; 3]>>,
    pub(crate) faces: Option<RecoveredFaces>,
}

/// What one recovered row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecoveredDof {
    /// Label of the node in the model.
    pub node: i64,
    /// Direction at the node.
    pub direction: Direction,
}

/// How many bytes a number of the recovery takes in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schemars", schemars(rename = "RecoveryPrecision"))]
pub enum Precision {
    /// Eight.
    #[default]
    Double,
    /// Four: enough for the deformation, to which the simulation adds the rigid-body motion.
    Single,
}

impl Recovery {
    /// Recovery rows (n × r) and the n degrees of freedom they recover; in single precision the values are rounded.
    ///
    /// # Errors
    ///
    /// [`FileError::WrongShape`] if there are not as many dofs as rows.
    pub fn new(rows: Matrix, dofs: Vec<RecoveredDof>, precision: Precision) -> Result<Self> {
        if rows.rows() != dofs.len() {
            let (found, expected) = (vec![dofs.len(), 2], vec![rows.rows(), 2]);
            return Err(FileError::WrongShape { tensor: "recovery_dofs", found, expected });
        }
        let rows = match precision {
            Precision::Double => rows,
            Precision::Single => Matrix::from_fn(rows.rows(), rows.cols(), |i, j| f64::from(rows[(i, j)] as f32)),
        };
        Ok(Self { rows, dofs, precision, positions: None, faces: None })
    }

    /// These rows with the positions of their nodes in the reference configuration, in the order of [`Recovery::labels`].
    ///
    /// # Errors
    ///
    /// [`FileError::WrongShape`] if there are not as many positions as nodes.
    pub fn with_positions(self, positions: Vec<[f64; 3]>) -> Result<Self> {
        let (found, expected) = (positions.len(), self.labels().len());
        if found != expected {
            let (found, expected) = (vec![found, 3], vec![expected, 3]);
            return Err(FileError::WrongShape { tensor: "recovery_positions", found, expected });
        }
        Ok(Self { positions: Some(positions), ..self })
    }

    /// These rows with the faces of the mesh all of whose nodes are recovered.
    ///
    /// # Errors
    ///
    /// [`FileError::RecoveryIncomplete`] without positions, [`FileError::RecoveryFace`] where a face has a node that is not recovered.
    pub fn with_faces(self, faces: RecoveredFaces) -> Result<Self> {
        let positions = self.positions.as_ref();
        let n_nodes = positions.ok_or(FileError::RecoveryIncomplete { missing: "recovery_positions" })?.len();
        RecoveredFaces::new(faces.iter(), n_nodes)?;
        Ok(Self { faces: Some(faces), ..self })
    }

    /// Labels of the nodes, each once, in the order of their first rows.
    pub fn labels(&self) -> Vec<i64> {
        let mut known = BTreeSet::new();
        self.dofs.iter().map(|dof| dof.node).filter(|node| known.insert(*node)).collect()
    }

    /// Positions of the nodes in the order of [`Recovery::labels`], where the model has coordinates.
    pub fn positions(&self) -> Option<&[[f64; 3]]> {
        self.positions.as_deref()
    }

    /// Faces of the mesh between the nodes, where it has some.
    pub fn faces(&self) -> Option<&RecoveredFaces> {
        self.faces.as_ref()
    }

    /// The rows, n × r.
    pub fn rows(&self) -> &Matrix {
        &self.rows
    }

    /// What each row is.
    pub fn dofs(&self) -> &[RecoveredDof] {
        &self.dofs
    }

    /// How the rows are stored.
    pub fn precision(&self) -> Precision {
        self.precision
    }
}
