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

    /// How many pairs of a row and a column a general matrix has at one place only, where no pair at both places tells it from a symmetric
    /// matrix of which entries are missing; none where one does.
    pub fn given_once(self, matrix: &SparseMatrix) -> Option<usize> {
        if self != Self::General {
            return None;
        }
        let mut n_once = 0;
        for (row, view) in matrix.outer_iterator().enumerate() {
            for (col, value) in view.iter().filter(|(col, value)| *col != row && **value != 0.0) {
                match matrix.get(col, row).copied() {
                    None | Some(0.0) => n_once += 1,
                    Some(image) if image != *value => return None,
                    Some(_) => {}
                }
            }
        }
        (n_once > 0).then_some(n_once)
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

    fn matrix(entries: &[(u32, u32, f64)]) -> SparseMatrix {
        let mut triplets = Triplets::default();
        entries.iter().for_each(|(row, col, value)| triplets.push(*row, *col, *value));
        triplets.assemble(3, Declared::Whole, "a".as_ref()).expect("a matrix").0
    }

    fn shape(entries: &[(u32, u32, f64)]) -> Shape {
        Shape::of(&matrix(entries))
    }

    #[test]
    fn half_of_a_symmetric_matrix_is_told_from_a_general_one() {
        let once = |entries: &[(u32, u32, f64)]| {
            let matrix = matrix(entries);
            Shape::of(&matrix).given_once(&matrix)
        };
        assert_eq!(once(&[(0, 0, 1.0), (1, 0, 2.0), (2, 1, 3.0)]), Some(2), "one triangle");
        assert_eq!(once(&[(1, 0, 2.0), (1, 2, 3.0), (2, 1, 0.0)]), Some(2), "either order");
        assert_eq!(once(&[(1, 0, 2.0), (0, 1, 2.0), (1, 2, 3.0)]), Some(1), "one entry is missing");
        assert_eq!(once(&[(1, 0, 2.0), (0, 1, 2.5), (1, 2, 3.0)]), None, "truly general");
        assert_eq!(once(&[(0, 0, 2.0), (1, 1, 2.5)]), None, "diagonal");
        assert_eq!(once(&[(0, 0, 2.0), (1, 0, 2.5), (0, 1, 2.5)]), None, "symmetric");
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
