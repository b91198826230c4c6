//! A row of the transformation T.

/// One row of T.
#[derive(Clone, Debug, PartialEq)]
pub enum TransformationRow {
    /// The row is a dof of the partition itself.
    Dof(u32),
    /// The row follows dofs: those of the interface node of a patch, distortions of the patch where it has any, those that constraints name.
    Tied(Box<[(u32, f64)]>),
    /// The row is at rest.
    Held,
}

impl TransformationRow {
    /// Adds entries to those of a row that follows a patch. One that the patch's node leaves at rest, as its directions are held, follows them alone.
    pub(super) fn extend(&mut self, more: &[(u32, f64)]) {
        match self {
            Self::Tied(entries) => *entries = entries.iter().chain(more).copied().collect(),
            Self::Held if !more.is_empty() => *self = Self::Tied(more.into()),
            Self::Held | Self::Dof(_) => {}
        }
    }

    /// The entries of the row.
    pub fn entries(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let single = match self {
            Self::Dof(dof) => Some((*dof, 1.0)),
            Self::Tied(_) | Self::Held => None,
        };
        let several = match self {
            Self::Dof(_) | Self::Held => &[],
            Self::Tied(entries) => &**entries,
        };
        single.into_iter().chain(several.iter().copied())
    }
}
