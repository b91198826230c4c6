//! Symmetry of a matrix stored whole.

use std::ops::Range;

use rayon::prelude::*;

use crate::sparse::{SparseMatrix, balanced_ranges, diagonal};

/// How far a matrix was from symmetric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asymmetry {
    /// max |A − Aᵀ| / max |A|.
    pub of_largest: f64,
    /// The largest |A_ij − A_ji| / √(A_ii A_jj): a stiff row hides nothing of a soft one.
    pub of_rows: f64,
    /// |A_ij − A_ji| of this one.
    pub difference: f64,
    /// Its row and column.
    pub worst: (usize, usize),
    /// Entries below and above the diagonal that have none at their mirror image.
    pub unpaired: [usize; 2],
}

/// Replaces A by (A + Aᵀ)/2 and says how far it was from symmetric; exact zeros in, same bits out.
///
/// A position stored on one side only counts as zero on the other and is given to both.
pub fn make_symmetric(matrix: &mut SparseMatrix) -> Asymmetry {
    if is_symmetric(matrix) {
        return Asymmetry { of_largest: 0.0, of_rows: 0.0, difference: 0.0, worst: (0, 0), unpaired: [0, 0] };
    }
    let mut differences = Differences::of(matrix);
    let mut unpaired = [0, 0];
    if !walk_pairs(matrix, &mut differences) {
        let transposed = matrix.transpose_view().to_csr();
        *matrix = sprs::binop::csmat_binop(matrix.view(), transposed.view(), |a, b| 0.5 * (a + b));
        unpaired = n_unpaired(&transposed);
        one_sided_differences(matrix, &transposed, &mut differences);
    }
    let Differences { largest, most, of_rows, of_worst, worst, .. } = differences;
    let of_largest = if largest > 0.0 { most / largest } else { 0.0 };
    Asymmetry { of_largest, of_rows, difference: of_worst, worst, unpaired }
}

/// Share of the largest entry below which a diagonal entry tells no size of its row: what rounding leaves of massless rows.
const NO_SIZE: f64 = 1e-12;

/// Differences of entries at (i, j) and (j, i).
struct Differences {
    /// max |A|.
    largest: f64,
    /// √A_ii of each row.
    sizes: Vec<f64>,
    /// The largest of all.
    most: f64,
    /// The largest relative to its rows, and where.
    of_rows: f64,
    /// That one itself.
    of_worst: f64,
    worst: (usize, usize),
}

impl Differences {
    fn of(matrix: &SparseMatrix) -> Self {
        let largest = matrix.data().iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let sizes = diagonal(matrix).into_iter().map(|value| value.abs().max(NO_SIZE * largest).sqrt()).collect();
        Self { largest, sizes, most: 0.0, of_rows: 0.0, of_worst: 0.0, worst: (0, 0) }
    }

    fn add(&mut self, difference: f64, (row, col): (usize, usize)) {
        self.most = self.most.max(difference);
        let of_rows = difference / (self.sizes[row] * self.sizes[col]);
        if of_rows > self.of_rows {
            (self.of_rows, self.of_worst, self.worst) = (of_rows, difference, (row, col));
        }
    }
}

/// Whether a matrix has the same values at (i, j) and (j, i), by ranges of rows side by side.
///
/// Each entry below the diagonal has its partner above it, and there are no more of those.
fn is_symmetric(matrix: &SparseMatrix) -> bool {
    let pointers = matrix.indptr();
    let pointers = pointers.raw_storage();
    let ranges = balanced_ranges(pointers, rayon::current_num_threads());
    let beyond: Option<Vec<i64>> = ranges.into_par_iter().map(|rows| unmatched_above(matrix, pointers, rows)).collect();
    beyond.is_some_and(|counts| counts.iter().sum::<i64>() == 0)
}

/// Entries above the diagonal less those below it in some rows, every one of which has an equal partner; none where one has not.
fn unmatched_above(matrix: &SparseMatrix, pointers: &[usize], rows: Range<usize>) -> Option<i64> {
    let (columns, values) = (matrix.indices(), matrix.data());
    // As in the walk of all pairs: the partners in row j are met in ascending order.
    let first_partner = |row: usize| {
        let entries = pointers[row]..pointers[row + 1];
        entries.start + columns[entries].partition_point(|col| (*col as usize) < rows.start.max(row + 1))
    };
    let mut cursor: Vec<usize> = (0..rows.end).map(first_partner).collect();
    let mut above = 0;
    for row in rows {
        for at in pointers[row]..pointers[row + 1] {
            let col = columns[at] as usize;
            if col >= row {
                above += i64::from(col > row);
                continue;
            }
            let partner = cursor[col];
            if partner >= pointers[col + 1] || columns[partner] as usize != row || values[at] != values[partner] {
                return None;
            }
            cursor[col] += 1;
            above -= 1;
        }
    }
    Some(above)
}

/// Averages every pair (i, j), (j, i) in one pass; false where the pattern is not symmetric.
///
/// Rows are visited in ascending order. The entries of row j right of its diagonal are then met in ascending column
/// order by the rows below, so one cursor for each row finds every partner without a search.
fn walk_pairs(matrix: &mut SparseMatrix, differences: &mut Differences) -> bool {
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
                differences.add((data[at] - data[partner]).abs(), (row, col));
                let mean = 0.5 * (data[at] + data[partner]);
                data[at] = mean;
                data[partner] = mean;
            }
        }
    }
    (0..n).all(|row| cursor[row] == pointers[row + 1])
}

/// Entries other than zero, below and above the diagonal, that have none at their mirror image.
fn n_unpaired(transposed: &SparseMatrix) -> [usize; 2] {
    let mut unpaired = [0, 0];
    for (value, (col, row)) in transposed.iter() {
        let (row, col) = (row as usize, col as usize);
        if row != col && *value != 0.0 && transposed.get(row, col).is_none_or(|image| *image == 0.0) {
            unpaired[usize::from(col > row)] += 1;
        }
    }
    unpaired
}

fn one_sided_differences(mean: &SparseMatrix, transposed: &SparseMatrix, differences: &mut Differences) {
    for (row, view) in mean.outer_iterator().enumerate() {
        for (col, value) in view.iter() {
            let difference = 2.0 * (transposed.get(row, col).copied().unwrap_or(0.0) - value).abs();
            if difference > 0.0 {
                differences.add(difference, (row, col));
            }
        }
    }
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

    /// Values, and positions on either side, that differ anywhere, for any number of threads.
    #[test]
    fn a_single_difference_is_seen() {
        let n = 200;
        let mut entries = Vec::new();
        for i in 0..n {
            entries.push((i, i, 4.0));
            for j in (0..i).filter(|j| (i * 7 + j * 3) % 11 == 0) {
                entries.extend([(i, j, f64::from(i + j)), (j, i, f64::from(i + j))]);
            }
        }
        let of = |entries: &[(u32, u32, f64)]| {
            let mut triplets = crate::sparse::Triplets::default();
            entries.iter().for_each(|(row, col, value)| triplets.push(*row, *col, *value));
            triplets.assemble(n as usize, crate::sparse::Declared::General, "a".as_ref()).expect("a matrix").0
        };
        let off_diagonal: Vec<usize> = (0..entries.len()).filter(|at| entries[*at].0 != entries[*at].1).collect();
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                assert!(is_symmetric(&of(&entries)));
                for at in off_diagonal.iter().step_by(97) {
                    let mut other = entries.clone();
                    other[*at].2 += 1e-9;
                    assert!(!is_symmetric(&of(&other)), "{:?} on {threads} threads", entries[*at]);
                    other.remove(*at);
                    assert!(!is_symmetric(&of(&other)), "without {:?} on {threads} threads", entries[*at]);
                }
            });
        }
    }

    #[test]
    fn symmetric_matrix_keeps_its_bits() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 1, -0.1), (1, 0, -0.1), (1, 1, 3.0), (2, 2, 1.0)]);
        let before = a.clone();
        assert_eq!(make_symmetric(&mut a).of_rows, 0.0);
        assert_eq!(a, before);
    }

    #[test]
    fn unequal_pair_is_averaged_and_measured() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 1, 1.0), (1, 0, 0.5), (1, 1, 3.0), (2, 2, 4.0)]);
        let found = make_symmetric(&mut a);
        let of_rows = 0.5 / (2f64.sqrt() * 3f64.sqrt());
        assert_eq!(found, Asymmetry { of_largest: 0.125, of_rows, difference: 0.5, worst: (1, 0), unpaired: [0, 0] });
        assert_eq!((a.get(0, 1), a.get(1, 0)), (Some(&0.75), Some(&0.75)));
    }

    #[test]
    fn entry_on_one_side_only_is_given_to_both() {
        let mut a = matrix(&[(0, 0, 2.0), (0, 2, 1.0), (1, 1, 2.0), (2, 2, 2.0)]);
        let found = make_symmetric(&mut a);
        assert_eq!(found.of_largest, 0.5);
        assert_eq!((a.get(0, 2), a.get(2, 0)), (Some(&0.5), Some(&0.5)));
    }
}
