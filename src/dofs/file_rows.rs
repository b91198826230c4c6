//! Numbers of rows in the files. They stay what they are when rows are dropped.

use super::Dof;

/// Which rows of the files the rows of the matrices are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileRows {
    /// The rows that are kept, in ascending order; absent where all are.
    kept: Option<Vec<u32>>,
    /// Rows that are not.
    n_dropped: usize,
}

impl FileRows {
    /// The rows that a filter keeps, one mark for each row of the files.
    pub(crate) fn kept(is_kept: &[bool]) -> Self {
        let rows = is_kept.iter().zip(0u32..).filter(|(kept, _)| **kept).map(|(_, row)| row);
        let kept: Vec<u32> = rows.collect();
        Self { n_dropped: is_kept.len() - kept.len(), kept: Some(kept) }
    }

    /// Rows that are not among those of the matrices.
    pub fn n_dropped(&self) -> usize {
        self.n_dropped
    }

    /// The number in the files of a row of the matrices, both from zero.
    pub fn of(&self, row: usize) -> usize {
        self.kept.as_ref().map_or(row, |kept| kept[row] as usize)
    }

    /// The row of the matrices that a row of the files has become, both from zero; nothing where it was dropped.
    pub fn find(&self, row_of_files: usize) -> Option<usize> {
        let Some(kept) = &self.kept else { return Some(row_of_files) };
        kept.binary_search(&u32::try_from(row_of_files).ok()?).ok()
    }
}

/// Names of rows in messages: the number in the files, and node and direction where there is a dof map.
#[derive(Clone, Copy, Debug)]
pub struct RowNames<'a> {
    /// Which rows of the files they are.
    pub rows: &'a FileRows,
    /// Node and direction of each row.
    pub dofs: Option<&'a [Option<Dof>]>,
}

impl RowNames<'_> {
    /// Number in the files, from one.
    pub fn number(self, row: usize) -> usize {
        self.rows.of(row) + 1
    }

    /// ` (node 40 rx)`, or nothing where unknown.
    pub fn bracketed(self, row: usize) -> String {
        self.dof(row).map_or_else(String::new, |dof| format!(" ({dof})"))
    }

    /// `row 238 (node 40 rx)`.
    pub fn full(self, row: usize) -> String {
        format!("row {}{}", self.number(row), self.bracketed(row))
    }

    /// `node 40 rx`, or `row 238` where no map tells it or no node has it.
    pub fn short(self, row: usize) -> String {
        self.dof(row).map_or_else(|| format!("row {}", self.number(row)), |dof| dof.to_string())
    }

    /// Whether a map says that no node has the row.
    pub fn is_scalar(self, row: usize) -> bool {
        self.dofs.is_some_and(|dofs| dofs[row].is_none())
    }

    /// The label of the node that has the row.
    pub fn node(self, row: usize) -> Option<i64> {
        self.dof(row).map(|dof| dof.node)
    }

    fn dof(self, row: usize) -> Option<Dof> {
        self.dofs.and_then(|dofs| dofs[row])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dofs::Direction;

    #[test]
    fn rows_keep_their_numbers_of_the_files() {
        let rows = FileRows::kept(&[true, false, true, false, false, true]);
        assert_eq!([0, 1, 2].map(|row| rows.of(row)), [0, 2, 5]);
        assert_eq!([0, 1, 2, 5, 6].map(|row| rows.find(row)), [Some(0), None, Some(1), Some(2), None]);
        assert_eq!((FileRows::default().of(7), FileRows::default().find(7)), (7, Some(7)));
        let dofs = [Direction::Ux, Direction::Uy, Direction::Rx].map(|direction| Some(Dof { node: 40, direction }));
        let names = RowNames { rows: &rows, dofs: Some(&dofs) };
        assert_eq!((names.full(2), names.short(2)), ("row 6 (node 40 rx)".to_owned(), "node 40 rx".to_owned()));
        assert_eq!(RowNames { dofs: None, ..names }.short(2), "row 6");
        let scalar = RowNames { dofs: Some(&[None; 3]), ..names };
        assert_eq!((scalar.full(2), scalar.is_scalar(2), names.is_scalar(2)), ("row 6".to_owned(), true, false));
    }
}
