//! Symmetry of a matrix stored whole.

use crate::sparse::SparseMatrix;

/// How far a matrix was from symmetric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asymmetry {
    /// max |A − Aᵀ| / max |A|.
    pub relative: f64,
    /// Row and column of the largest difference.
    pub worst: (usize, usize),
}

/// Replaces A by (A + Aᵀ)/2 and says how far it was from symmetric; exact zeros in, same bits out.
///
/// A position stored on one side only counts as zero on the other and is given to both.
pub fn make_symmetric(matrix: &mut SparseMatrix) -> Asymmetry {
    let largest = matrix.data().iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let mut worst = (0.0, (0, 0));
    if !walk_pairs(matrix, &mut worst) {
        let transposed = matrix.transpose_view().to_csr();
        *matrix = sprs::binop::csmat_binop(matrix.view(), transposed.view(), |a, b| 0.5 * (a + b));
        let one_sided = one_sided_difference(matrix, &transposed);
        if one_sided.0 > worst.0 {
            worst = one_sided;
        }
    }
    Asymmetry { relative: if largest > 0.0 { worst.0 / largest } else { 0.0 }, worst: worst.1 }
}

/// Averages every pair (i, j), (j, i) in one pass; false where the pattern is not symmetric.
///
/// Rows are visited in ascending order. The entries of row j right of its diagonal are then met in ascending column
/// order by the rows below, so one cursor for each row finds every partner without a search.
fn walk_pairs(matrix: &mut SparseMatrix, worst: &mut (f64, (usize, usize))) -> bool {
    let n = matrix.rows();
    let pointers: Vec<usize> = matrix.indptr().raw_storage().to_vec();
    let columns: Vec<u32> = matrix.indices().to_vec();
    let data = matrix.data_mut();
    let mut cursor: Vec<usize> = (0..n)
        .map(|row| {
            let range = pointers[row]..pointers[row + 1];
            range.start + columns[range].partition_point(|col| *col as usize <= row)
        })
        .collect();
    for row in 0..n {
        for at in pointers[row]..pointers[row + 1] {
            let col = columns[at] as usize;
            if col >= row {
                break;
            }
            let partner = cursor[col];
            if partner >= pointers[col + 1] || columns[partner] as usize != row {
                return false;
            }
            cursor[col] += 1;
            if data[at] != data[partner] {
                let difference = (data[at] - data[partner]).abs();
                if difference > worst.0 {
                    *worst = (difference, (row, col));
                }
                let mean = 0.5 * (data[at] + data[partner]);
                data[at] = mean;
                data[partner] = mean;
            }
        }
    }
    (0..n).all(|row| cursor[row] == pointers[row + 1])
}

fn one_sided_difference(mean: &SparseMatrix, transposed: &SparseMatrix) -> (f64, (usize, usize)) {
    let mut worst = (0.0, (0, 0));
    for (row, view) in mean.outer_iterator().enumerate() {
        for (col, value) in view.iter() {
            let difference = 2.0 * (transposed.get(row, col).copied().unwrap_or(0.0) - value).abs();
            if difference > worst.0 {
                worst = (difference, (row, col));
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(entries: &[(u32, u32, f64)]) -> SparseMatrix {
        let mut triplets = sprs::TriMatI::<f64, u32>::new((3, 3));
        for (row, col, value) in entries {
            triplets.add_triplet(*row as usize, *col as usize, *value);
        }
        let csr: sprs::CsMatI<f64, u32, u32> = triplets.to_csr();
        let pointers = csr.indptr().raw_storage().iter().map(|p| *p as usize).collect();
        SparseMatrix::new((3, 3), pointers, csr.indices().to_vec(), csr.data().to_vec())
    }

    #[test]
    fn symmetric_matrix_keeps_its_bits() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 1, -0.1), (1, 0, -0.1), (1, 1, 3.0), (2, 2, 1.0)]);
        let before = a.clone();
        assert_eq!(make_symmetric(&mut a).relative, 0.0);
        assert_eq!(a, before);
    }

    #[test]
    fn unequal_pair_is_averaged_and_measured() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 1, 1.0), (1, 0, 0.5), (1, 1, 3.0), (2, 2, 4.0)]);
        let found = make_symmetric(&mut a);
        assert_eq!(found, Asymmetry { relative: 0.125, worst: (1, 0) });
        assert_eq!((a.get(0, 1), a.get(1, 0)), (Some(&0.75), Some(&0.75)));
    }

    #[test]
    fn entry_on_one_side_only_is_given_to_both() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 2, 1.0), (1, 1, 2.0), (2, 2, 2.0)]);
        let found = make_symmetric(&mut a);
        assert_eq!(found.relative, 0.5);
        assert_eq!((a.get(0, 2), a.get(2, 0)), (Some(&0.5), Some(&0.5)));
    }
}
