//! Rows along axes of their own, three by three, turned to the axes of the model.
//!
//! ```text
//! T    n × n    orthogonal: u_file = T u; a block of three rows for each node, whose rows are its axes, the identity elsewhere
//! TᵀAT          a matrix of the model;  Tᵀx a column of displacements or forces, and the coefficients of a row
//! ```
//! T is orthogonal to rounding whatever digits the axes were given with: axes that are off turn the model at a node and leave its
//! frequencies what they are.

use rayon::prelude::*;

use super::leading::ends;
use super::{RowStorage, SparseMatrix, diagonal, filled};
use crate::twofold::{Twofold, exact_product};

/// The axes of a node, each by its components along those of the model.
type Axes = [[f64; 3]; 3];

/// Share of its terms below which a sum is what their rounding left: at most nine terms, each of three factors that are rounded.
const NOTHING: f64 = 16.0 * f64::EPSILON;

/// Which rows lie along axes of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turning {
    /// Three rows each, and their axes.
    blocks: Vec<([u32; 3], Axes)>,
    /// Block of each row, and which of its three rows it is; none for a row along the axes of the model.
    places: Vec<Option<(u32, u8)>>,
}

/// A matrix of the model.
pub struct Turned {
    /// TᵀAT, symmetric or skew to the bit where A is.
    pub matrix: SparseMatrix,
    /// What became of the roundings of its entries.
    pub roundings: TurnedRoundings,
}

/// What turning rows made of the roundings of the entries of a matrix, relative to √(A_ii A_jj) of the turned one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRoundings {
    /// How many times their own share entries may be off: the rounding of a stiff direction reaches a soft one.
    pub enlargement: f64,
    /// The largest sum over a row of the entries that were left out as rounding of nothing.
    pub left_out: f64,
}

/// An entry of a turned matrix.
#[derive(Clone, Copy)]
struct TurnedEntry {
    col: u32,
    value: f64,
    /// Whether it is what rounding of its terms leaves of nothing.
    is_rounding: bool,
}

impl Turning {
    /// Of n rows; each row is in one block at most.
    pub fn new(n: usize, blocks: Vec<([u32; 3], Axes)>) -> Self {
        let mut places = vec![None; n];
        for ((rows, _), block) in blocks.iter().zip(0u32..) {
            rows.iter().zip(0u8..).for_each(|(row, at)| places[*row as usize] = Some((block, at)));
        }
        Self { blocks, places }
    }

    /// Three rows for each part of a node, and the axes that they are along.
    pub fn blocks(&self) -> &[([u32; 3], Axes)] {
        &self.blocks
    }

    /// Tᵀx in place of x.
    ///
    /// # Panics
    /// If x has fewer rows than T.
    pub fn turn(&self, x: &mut [f64]) {
        for (rows, axes) in &self.blocks {
            let own = rows.map(|row| x[row as usize]);
            for (k, row) in rows.iter().enumerate() {
                x[*row as usize] = (0..3).map(|at| axes[at][k] * own[at]).sum();
            }
        }
    }

    /// The terms of Tᵀg for those of a row g, ascending, without zeros.
    pub fn turned_terms(&self, terms: &[(u32, f64)]) -> Vec<(u32, f64)> {
        let mut sums: std::collections::BTreeMap<u32, f64> = std::collections::BTreeMap::new();
        for (row, value) in terms {
            self.shares(*row).for_each(|(other, share)| *sums.entry(other).or_default() += share * value);
        }
        sums.into_iter().filter(|(_, value)| *value != 0.0).collect()
    }

    /// TᵀAT for a matrix A of n × n.
    pub fn turned(&self, matrix: &SparseMatrix) -> Turned {
        let n = matrix.rows();
        let mut rows: Vec<Option<Vec<TurnedEntry>>> =
            (0..n).into_par_iter().map(|row| self.turned_row(matrix, row)).collect();
        let own = diagonal(matrix);
        let of_turned = diagonal_of(&rows, &own);
        let left_out = rows
            .par_iter_mut()
            .enumerate()
            .map(|(row, turned)| leave_out(turned, row, &of_turned))
            .reduce(|| 0.0, f64::max);
        let length = |row: usize| match &rows[row] {
            Some(entries) => entries.len(),
            None => matrix.outer_view(row).map_or(0, |view| view.nnz()),
        };
        let lengths: Vec<usize> = (0..n).map(length).collect();
        let RowStorage { pointers, indices, values } = filled(
            &lengths,
            || (),
            |(), row, indices, values| match &rows[row] {
                Some(entries) => {
                    let places = indices.iter_mut().zip(values).zip(entries);
                    places.for_each(|((index, value), entry)| (*index, *value) = (entry.col, entry.value));
                }
                None => {
                    let Some(view) = matrix.outer_view(row) else { return };
                    indices.copy_from_slice(view.indices());
                    values.copy_from_slice(view.data());
                }
            },
        );
        let roundings = TurnedRoundings { enlargement: self.enlargement(&[own, of_turned]), left_out };
        Turned { matrix: SparseMatrix::new((n, n), pointers, indices, values), roundings }
    }

    /// The rows that a row of the files is a sum of, and by what factors.
    fn shares(&self, row: u32) -> impl Iterator<Item = (u32, f64)> {
        self.along(row, |axes, at, k| axes[at][k])
    }

    /// The rows of the files that move with a row of the model, and by what factors.
    fn sources(&self, row: u32) -> impl Iterator<Item = (u32, f64)> {
        self.along(row, |axes, at, k| axes[k][at])
    }

    /// The rows of the block of a row with an entry of its axes for the place of either; the row itself where it is in none.
    fn along(&self, row: u32, of: fn(&Axes, usize, usize) -> f64) -> impl Iterator<Item = (u32, f64)> {
        let place = self.places[row as usize];
        let of_block = move |(block, at): (u32, u8)| {
            let (rows, axes) = &self.blocks[block as usize];
            std::array::from_fn::<_, 3, _>(|k| (rows[k], of(axes, usize::from(at), k)))
        };
        place.is_none().then_some((row, 1.0)).into_iter().chain(place.into_iter().flat_map(of_block))
    }

    /// A row of TᵀAT; none where it is that of A.
    ///
    /// The entries at (i, j) and (j, i) are sums of the same products. They are taken in an order that does not depend on the side: by the
    /// two rows of the files that they come from, and a pair of these that comes twice is added up first. They are summed to twice the working
    /// precision and rounded once: a stiff direction leaves no more of its rounding in a soft one than its own number has.
    fn turned_row(&self, matrix: &SparseMatrix, row: usize) -> Option<Vec<TurnedEntry>> {
        let is_turned = |row: u32| self.places[row as usize].is_some();
        let own = matrix.outer_view(row);
        if !is_turned(row as u32) && !own.iter().flat_map(|view| view.indices()).any(|col| is_turned(*col)) {
            return None;
        }
        let mut terms: Vec<(u32, [u32; 2], Twofold)> = Vec::new();
        for (source, factor) in self.sources(row as u32) {
            for (col, value) in matrix.outer_view(source as usize).iter().flat_map(|view| view.iter()) {
                let key = [source.min(col as u32), source.max(col as u32)];
                let of_pair = |share: f64| exact_product(factor, share) * *value;
                terms.extend(self.shares(col as u32).map(|(target, share)| (target, key, of_pair(share))));
            }
        }
        terms.sort_unstable_by_key(|(target, key, _)| (*target, *key));
        let of_target = |terms: &[(u32, [u32; 2], Twofold)]| {
            let of_pair = terms.chunk_by(|a, b| a.1 == b.1);
            let of_pair = of_pair.map(|pair| pair.iter().fold(Twofold::default(), |sum, (_, _, value)| sum + *value));
            let value = of_pair.fold(Twofold::default(), |sum, of_pair| sum + of_pair).value();
            let size = terms.iter().fold(0.0, |size: f64, (_, _, value)| size.max(value.high.abs()));
            let is_rounding = terms.len() > 1 && value.abs() <= NOTHING * size;
            TurnedEntry { col: terms[0].0, value, is_rounding }
        };
        Some(terms.chunk_by(|a, b| a.0 == b.0).map(of_target).collect())
    }

    /// The largest (Σ_a |T_ai| √A_aa)² / (TᵀAT)_ii, one at least. With |E_ab| ≤ r √(A_aa A_bb) the sum over a and b at (i, j) is r times the
    /// product of both sums at most.
    fn enlargement(&self, [own, turned]: &[Vec<f64>; 2]) -> f64 {
        let of_row = |row: u32| {
            let sum: f64 =
                self.sources(row).map(|(source, share)| share.abs() * own[source as usize].abs().sqrt()).sum();
            let left = turned[row as usize];
            if left > 0.0 { sum * sum / left } else { 1.0 }
        };
        self.blocks.iter().flat_map(|(rows, _)| *rows).map(of_row).fold(1.0, f64::max)
    }
}

/// The diagonal of a turned matrix; `own` is that of the rows that were not turned.
fn diagonal_of(rows: &[Option<Vec<TurnedEntry>>], own: &[f64]) -> Vec<f64> {
    let of_row = |(row, turned): (usize, &Option<Vec<TurnedEntry>>)| match turned {
        Some(entries) => entries.iter().find(|entry| entry.col as usize == row).map_or(0.0, |entry| entry.value),
        None => own[row],
    };
    rows.iter().enumerate().map(of_row).collect()
}

/// Leaves out what rounding of its terms leaves of nothing, and returns the sum of that over √(A_ii A_jj), which are zero where no entries are:
/// what is rounding of a stiff direction may be much in a soft one.
///
/// ```text
/// Σ |D_ij||x_i||x_j| ≤ max_i Σ_j |D_ij| / √(A_ii A_jj)  Σ A_ii x_i²
/// ```
fn leave_out(turned: &mut Option<Vec<TurnedEntry>>, row: usize, diagonal: &[f64]) -> f64 {
    let mut left_out = 0.0;
    for entries in turned.iter_mut() {
        entries.retain(|TurnedEntry { col, value, is_rounding }| {
            let root = ends(diagonal, row, *col as usize);
            left_out += if *is_rounding && root > 0.0 { value.abs() / root } else { 0.0 };
            !is_rounding && *value != 0.0
        });
    }
    left_out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::{Declared, Triplets};

    /// x along (2, 2, 1), y along (-2, 1, 2), z along (1, -2, 2).
    const AXES: Axes = {
        let (a, b) = (2.0 / 3.0, 1.0 / 3.0);
        [[a, a, b], [-a, b, a], [b, -a, a]]
    };

    fn matrix(declared: Declared) -> SparseMatrix {
        let mut triplets = Triplets::default();
        for row in 0..8u32 {
            for col in 0..=row {
                if declared == Declared::Symmetric || col < row {
                    triplets.push(
                        row,
                        col,
                        f64::from((7 * row + 3 * col) % 11) - 4.7 + f64::from(u8::from(row == col)) * 30.0,
                    );
                }
            }
        }
        triplets.assemble(8, declared, "a".as_ref()).expect("a matrix").0
    }

    fn dense(matrix: &SparseMatrix) -> Vec<Vec<f64>> {
        let entry = |row, col| matrix.get(row, col).copied().unwrap_or(0.0);
        (0..matrix.rows()).map(|row| (0..matrix.cols()).map(|col| entry(row, col)).collect()).collect()
    }

    #[test]
    fn a_matrix_is_turned_on_both_sides_and_stays_what_it_was_to_the_bit() {
        let turning = Turning::new(8, vec![([1, 4, 2], AXES)]);
        let mut t = vec![vec![0.0; 8]; 8];
        (0..8).for_each(|row| turning.shares(row as u32).for_each(|(col, share)| t[row][col as usize] = share));
        for (declared, sign) in [(Declared::Symmetric, 1.0), (Declared::Skew, -1.0)] {
            let given = matrix(declared);
            let (a, turned) = (dense(&given), dense(&turning.turned(&given).matrix));
            for i in 0..8 {
                for j in 0..8 {
                    let sum: f64 = (0..8)
                        .flat_map(|p| (0..8).map(move |q| (p, q)))
                        .map(|(p, q)| t[p][i] * a[p][q] * t[q][j])
                        .sum();
                    // Nine products of numbers up to 40.
                    assert!((turned[i][j] - sum).abs() < 1e-13, "{i} {j}");
                    assert_eq!(turned[i][j], sign * turned[j][i], "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn a_column_and_a_row_turn_as_the_matrix_does() {
        let turning = Turning::new(5, vec![([0, 2, 3], AXES)]);
        let mut x = [3.0, 5.0, 0.0, 0.0, 7.0];
        turning.turn(&mut x);
        assert_eq!(x, [2.0, 5.0, 2.0, 1.0, 7.0]);
        assert_eq!(
            turning.turned_terms(&[(0, 3.0), (1, 5.0), (4, 7.0)]),
            [(0, 2.0), (1, 5.0), (2, 2.0), (3, 1.0), (4, 7.0)]
        );
        let mut spring = Triplets::default();
        spring.push(0, 0, 9e9);
        let spring = spring.assemble(5, Declared::Symmetric, "a".as_ref()).expect("a matrix").0;
        let turned = turning.turned(&spring);
        for (row, sum) in [(0, 6e9), (2, 6e9), (3, 3e9)] {
            // Twelve products of three rounded factors at most.
            assert!(
                (turned.matrix.outer_view(row).expect("a row").iter().map(|(col, v)| v * x[col] / 3.0).sum::<f64>()
                    / sum
                    - 1.0)
                    .abs()
                    < 1e-14
            );
        }
        // The rounding of the spring is a share of itself, and of each of its parts: nothing is enlarged but by rounding.
        assert!((turned.roundings.enlargement - 1.0).abs() < 1e-14);
    }

    /// Soft across and stiff along: in the axes of the model both are of one size, turned back the soft one has the rounding of the other.
    #[test]
    fn rounding_of_a_stiff_direction_reaches_a_soft_one() {
        let turning = Turning::new(3, vec![([0, 1, 2], AXES)]);
        let mut triplets = Triplets::default();
        [1e6, 1.0, 1.0].into_iter().zip(0u32..).for_each(|(value, row)| triplets.push(row, row, value));
        let diagonal = triplets.assemble(3, Declared::Symmetric, "a".as_ref()).expect("a matrix").0;
        let there = turning.turned(&diagonal);
        assert!(there.roundings.enlargement < 3.0, "{}", there.roundings.enlargement);
        let transposed: Axes = std::array::from_fn(|i| std::array::from_fn(|j| AXES[j][i]));
        let back = Turning::new(3, vec![([0, 1, 2], transposed)]).turned(&there.matrix);
        assert!(back.roundings.enlargement > 1e5, "{}", back.roundings.enlargement);
    }
}
