//! What is written: a matrix, and what its entries show.

use crate::sparse::SparseMatrix;

/// What the entries of a matrix show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Every entry equals its mirror image to the bit.
    Symmetric,
    /// Every entry is its mirror image with the opposite sign.
    Skew,
    /// Neither.
    General,
}

/// What is written: a square matrix and its name, for formats that have names.
#[derive(Clone, Copy, Debug)]
pub struct Content<'a> {
    /// The matrix.
    pub matrix: &'a SparseMatrix,
    /// What its entries show.
    pub shape: Shape,
    /// A letter, then letters, digits and underscores.
    pub name: &'a str,
}

impl Shape {
    /// What the entries of a matrix show.
    pub fn of(matrix: &SparseMatrix) -> Self {
        let mirrored = |row: usize, col: usize| matrix.get(col, row).copied();
        let all = |is_image: fn(f64, f64) -> bool| {
            matrix.outer_iterator().enumerate().all(|(row, view)| {
                view.iter().all(|(col, value)| mirrored(row, col).is_some_and(|image| is_image(*value, image)))
            })
        };
        let is_diagonal_empty = || (0..matrix.rows()).all(|row| matrix.get(row, row).is_none());
        match () {
            () if all(|value, image| value.to_bits() == image.to_bits()) => Self::Symmetric,
            () if is_diagonal_empty() && all(|value, image| value.to_bits() == (-image).to_bits()) => Self::Skew,
            () => Self::General,
        }
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Symmetric => "symmetric",
            Self::Skew => "skew-symmetric",
            Self::General => "general",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::{Declared, Triplets};

    fn shape(entries: &[(u32, u32, f64)]) -> Shape {
        let mut triplets = Triplets::default();
        entries.iter().for_each(|(row, col, value)| triplets.push(*row, *col, *value));
        Shape::of(&triplets.assemble(3, Declared::Whole, "a".as_ref()).expect("a matrix").0)
    }

    #[test]
    fn shapes_are_judged_by_bits() {
        assert_eq!(shape(&[(0, 0, 1.0), (1, 0, 2.0), (0, 1, 2.0)]), Shape::Symmetric);
        assert_eq!(shape(&[(1, 0, 2.0), (0, 1, -2.0)]), Shape::Skew);
        assert_eq!(shape(&[(1, 0, 2.0), (0, 1, 2.0 + 4.0 * f64::EPSILON)]), Shape::General);
        assert_eq!(shape(&[(1, 0, 0.0), (0, 1, -0.0)]), Shape::Skew);
        assert_eq!(shape(&[(2, 2, 1.0), (1, 0, 2.0), (0, 1, -2.0)]), Shape::General);
        assert_eq!(shape(&[(1, 0, 2.0)]), Shape::General);
    }
}
