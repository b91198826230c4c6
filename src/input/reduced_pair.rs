//! K̂ and M̂ of a superelement of another program, on common rows.

use std::path::Path;

use super::common_rows::{RowLabels, take_notes};
use super::deck_axes::together;
use super::format::{MatrixSource, ReadMatrix};
use super::member::split_member;
use super::model_files::{read_matrix, refuse_duplicates};
use super::{Allowance, InputNote, MatrixInput, MatrixRole};
use crate::dofs::DofMap;
use crate::error::{Result, Unnamed};
use crate::job::Duplicates;

/// The reduced matrices of a superelement.
#[derive(Clone, Debug)]
pub struct ReducedPair {
    /// K̂.
    pub stiffness: MatrixInput,
    /// M̂.
    pub mass: MatrixInput,
    /// What each row is, where both matrices name theirs: none for amplitudes and scalar points.
    pub dofs: Option<DofMap>,
    /// What reading them did beyond copying: one triangle taken for both, entries added.
    pub notes: Vec<InputNote>,
}

impl ReducedPair {
    /// Reads both matrices. Where they name their rows these are in the order of nodes and directions, and have a row for each name that
    /// either has.
    ///
    /// # Errors
    /// The errors of the readers; [`crate::error::Error::FrameDiffer`]; [`crate::error::Error::RowsUnnamed`] where only one of them names its rows;
    /// [`crate::error::Error::Duplicates`] where entries that repeat a position are refused.
    pub fn read([stiffness, mass]: [&Path; 2], (duplicates, allowance): (Duplicates, &Allowance)) -> Result<Self> {
        let read = |path: &Path| -> Result<ReadMatrix> {
            let (file, member) = split_member(path);
            let role = MatrixRole::Reduced;
            read_matrix(&MatrixSource {
                file,
                member,
                layout: None,
                role,
                triangle: None,
                stated_digits: None,
                allowance,
            })
        };
        let (mut stiffness, mut mass) = (read(stiffness)?, read(mass)?);
        let of_deck = |matrix: &mut ReadMatrix| std::mem::replace(&mut matrix.frames, Ok(None));
        let decks = [of_deck(&mut stiffness), of_deck(&mut mass)].into_iter().collect::<Result<Vec<_>>>()?;
        together(decks.into_iter().flatten().collect())?;
        let labels = RowLabels::common(&[&stiffness, &mass], (None, Unnamed::Reduced))?;
        let mut notes = Vec::new();
        let mut placed = |matrix| {
            let (matrix, _) = take_notes(labels.placed(matrix)?, &mut notes);
            refuse_duplicates(&matrix, duplicates).map(|()| matrix)
        };
        Ok(Self { stiffness: placed(stiffness)?, mass: placed(mass)?, dofs: labels.dof_map(), notes })
    }
}
