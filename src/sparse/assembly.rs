//! From triplets to compressed rows.
//!
//! A counting sort by row, then each row by column where its entries do not come sorted already. Row ranges are
//! independent and every row receives its entries in file order, so that sums of duplicates have the same bits whatever
//! the number of threads.
//!
//! Shapes: m entries in, at most 2 m out, n rows.

use std::path::Path;

use rayon::prelude::*;

use super::by_rows::{balanced_ranges, split_by_rows};
use super::{AssemblyNotes, Declared, Given, SparseMatrix, Triangle, TripletBlocks, Triplets};
use crate::error::{Error, Result};

impl Triplets {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// True without entries.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Appends one entry: row, column, value, zero-based.
    pub fn push(&mut self, row: u32, col: u32, value: f64) {
        self.rows.push(row);
        self.cols.push(col);
        self.values.push(value);
    }

    /// An empty list with room for so many entries.
    pub fn with_capacity(n_entries: usize) -> Self {
        let (rows, cols) = (Vec::with_capacity(n_entries), Vec::with_capacity(n_entries));
        Self { rows, cols, values: Vec::with_capacity(n_entries) }
    }

    /// Row, column and value of each entry, in order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u32, f64)> {
        self.rows.iter().zip(&self.cols).zip(&self.values).map(|((&row, &col), &value)| (row, col, value))
    }

    /// [`TripletBlocks::assemble`] of one block.
    ///
    /// # Errors
    /// Those of [`TripletBlocks::assemble`].
    pub fn assemble(self, n: usize, declared: Declared, path: &Path) -> Result<(SparseMatrix, AssemblyNotes)> {
        TripletBlocks::from(self).assemble(n, declared, path)
    }
}

impl From<Triplets> for TripletBlocks {
    fn from(block: Triplets) -> Self {
        Self { blocks: vec![block] }
    }
}

impl TripletBlocks {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(Triplets::len).sum()
    }

    /// True without entries.
    pub fn is_empty(&self) -> bool {
        self.blocks.iter().all(Triplets::is_empty)
    }

    /// Row, column and value of each entry, in order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u32, f64)> {
        self.blocks.iter().flat_map(Triplets::iter)
    }

    /// Assembles the n × n matrix: mirrors the triangle of a symmetric source, adds duplicates in the order of the
    /// file, sorts every row. A source declared general that gives each pair of a row and a column once is mirrored too,
    /// which the notes say; one declared whole is not. `path` names the source in errors.
    ///
    /// # Errors
    /// [`Error::DoubleTriangle`] where a source declared symmetric or skew has entries at both places of a pair of a row and a column;
    /// [`Error::SkewDiagonal`] where one declared skew has an entry other than zero on it.
    ///
    /// # Panics
    /// Where the three lists differ in length or an index is not below n; readers check indices where they can still
    /// name the line.
    pub fn assemble(self, n: usize, declared: Declared, path: &Path) -> Result<(SparseMatrix, AssemblyNotes)> {
        let n_entries = self.len();
        for Triplets { rows, cols, values } in &self.blocks {
            let lengths = (rows.len(), cols.len(), values.len());
            assert!(lengths.0 == lengths.2 && lengths.1 == lengths.2, "rows, columns and values: {lengths:?}");
        }
        let given = if declared == Declared::Whole { Given::Whole } else { self.given() };
        self.check_declared(declared, given, path)?;
        let mirror = match (declared, given) {
            (_, Given::Whole) | (Declared::OneHolds, Given::EitherOrder { .. }) => Mirror::Off,
            (Declared::Skew, _) => Mirror::Negated,
            _ => Mirror::On,
        };
        let triangle = if given == Given::OneTriangle { self.triangle() } else { None };
        let pointers = row_pointers(&self, n, mirror);
        let (mut indices, mut data) = scatter(&self, &pointers, mirror);
        drop(self);
        let (merged, most_repeated) = sort_rows(&pointers, &mut indices, &mut data);
        let n_merged = indices.len() - merged.iter().sum::<usize>();
        let pointers = if n_merged == 0 { pointers } else { compact(&pointers, &merged, &mut indices, &mut data) };
        let n_duplicates = match (n_merged, mirror) {
            (0, _) => 0,
            (_, Mirror::Off) => n_merged,
            // What is stored twice was given once.
            (_, Mirror::On | Mirror::Negated) => n_entries - (indices.len() + n_on_diagonal(&pointers, &indices)) / 2,
        };
        let is_told = mirror == Mirror::On && !(declared == Declared::Symmetric && given == Given::OneTriangle);
        let given = if is_told { given } else { Given::Whole };
        let notes = AssemblyNotes { n_duplicates, most_repeated, given, triangle, ..AssemblyNotes::default() };
        let matrix = SparseMatrix::try_new((n, n), pointers, indices, data);
        Ok((matrix.unwrap_or_else(|(.., fault)| panic!("rows of {} are not sorted: {fault}", path.display())), notes))
    }

    /// Refuses what contradicts a declaration that one triangle is given.
    fn check_declared(&self, declared: Declared, given: Given, path: &Path) -> Result<()> {
        if matches!(declared, Declared::Symmetric | Declared::Skew)
            && given == Given::Whole
            && let Some((row, col)) = self.twice()
        {
            let (declared, remedy) = match declared {
                Declared::Skew => ("skew-symmetric", "give each pair once, or declare the matrix general"),
                _ => (
                    "symmetric",
                    "give each pair once, declare the matrix general, or say which triangle holds: model.symmetric = \"lower\" or \
                     \"upper\" (reduce --symmetric)",
                ),
            };
            let (row, col) = (u64::from(row) + 1, u64::from(col) + 1);
            return Err(Error::DoubleTriangle {
                path: path.to_owned(),
                declared,
                remedy,
                lower: (row, col),
                upper: (col, row),
            });
        }
        if declared == Declared::Skew
            && let Some((row, _, value)) = self.iter().find(|&(row, col, value)| row == col && value != 0.0)
        {
            return Err(Error::SkewDiagonal { path: path.to_owned(), row: u64::from(row) + 1, value });
        }
        Ok(())
    }

    /// The triangle of the first entry off the diagonal.
    fn triangle(&self) -> Option<Triangle> {
        let (row, col, _) = self.iter().find(|&(row, col, _)| row != col)?;
        Some(if row > col { Triangle::Lower } else { Triangle::Upper })
    }
}

/// Whether an off-diagonal entry stands for its transpose too.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mirror {
    On,
    /// With the opposite sign.
    Negated,
    Off,
}

/// Where each row starts, n + 1 values, duplicates counted.
fn row_pointers(triplets: &TripletBlocks, n: usize, mirror: Mirror) -> Vec<usize> {
    let mut pointers = vec![0_usize; n + 1];
    let places = triplets.blocks.iter().flat_map(|block| block.rows.iter().zip(&block.cols));
    for (&row, &col) in places {
        let (row, col) = (row as usize, col as usize);
        assert!(row < n && col < n, "entry ({row}, {col}) in a matrix of order {n}");
        pointers[row + 1] += 1;
        if mirror != Mirror::Off && row != col {
            pointers[col + 1] += 1;
        }
    }
    let mut total = 0;
    for pointer in &mut pointers {
        total += *pointer;
        *pointer = total;
    }
    pointers
}

/// Columns and values of all rows, each row in the order of the file.
///
/// Every range of rows is filled by one task that passes over all triplets: reading them once per task is cheaper than
/// sharing the scattered writes.
fn scatter(triplets: &TripletBlocks, pointers: &[usize], mirror: Mirror) -> (Vec<u32>, Vec<f64>) {
    let n_stored = pointers.last().copied().unwrap_or(0);
    let mut indices = vec![0_u32; n_stored];
    let mut data = vec![0.0; n_stored];
    let ranges = balanced_ranges(pointers, rayon::current_num_threads());
    let parts = split_by_rows(pointers, &ranges, &mut indices, &mut data);
    parts.into_par_iter().for_each(|(rows, indices, data)| {
        let offset = pointers[rows.start];
        let mut next: Vec<usize> = pointers[rows.clone()].iter().map(|pointer| pointer - offset).collect();
        let (first, n_rows) = (rows.start, rows.len());
        let mut put = |row: u32, col: u32, value: f64| {
            // A row before the range wraps to a huge number, so that one comparison decides.
            let local = (row as usize).wrapping_sub(first);
            if local < n_rows {
                let at = next[local];
                next[local] = at + 1;
                indices[at] = col;
                data[at] = value;
            }
        };
        for (row, col, value) in triplets.iter() {
            put(row, col, value);
            if mirror != Mirror::Off && row != col {
                put(col, row, if mirror == Mirror::Negated { -value } else { value });
            }
        }
    });
    (indices, data)
}

/// Sorts every row by column and adds duplicates into the first of them; returns how many entries each row keeps, at
/// its front, and the most that were added into one, none where nothing was.
fn sort_rows(pointers: &[usize], indices: &mut [u32], data: &mut [f64]) -> (Vec<usize>, usize) {
    let ranges = balanced_ranges(pointers, 8 * rayon::current_num_threads());
    let parts = split_by_rows(pointers, &ranges, indices, data);
    let kept: Vec<Vec<[usize; 2]>> = parts
        .into_par_iter()
        .map(|(rows, indices, data)| {
            let offset = pointers[rows.start];
            let mut scratch = Vec::new();
            rows.map(|row| {
                let entries = pointers[row] - offset..pointers[row + 1] - offset;
                sort_row(&mut indices[entries.clone()], &mut data[entries], &mut scratch)
            })
            .collect()
        })
        .collect();
    let kept = kept.concat();
    let most = kept.iter().map(|[_, most]| *most).max().filter(|most| *most > 1).unwrap_or(0);
    (kept.into_iter().map(|[n_kept, _]| n_kept).collect(), most)
}

/// How many entries the row keeps, and the most that became one.
fn sort_row(indices: &mut [u32], data: &mut [f64], scratch: &mut Vec<(u32, f64)>) -> [usize; 2] {
    if indices.is_sorted_by(|a, b| a < b) {
        return [indices.len(), 1];
    }
    scratch.clear();
    scratch.extend(indices.iter().copied().zip(data.iter().copied()));
    // Stable, so that duplicates stay in the order of the file.
    scratch.sort_by_key(|&(col, _)| col);
    let (mut n_kept, mut run, mut most) = (0, 0, 1);
    for &(col, value) in &*scratch {
        if n_kept > 0 && indices[n_kept - 1] == col {
            data[n_kept - 1] += value;
            run += 1;
            most = most.max(run);
        } else {
            run = 1;
            indices[n_kept] = col;
            data[n_kept] = value;
            n_kept += 1;
        }
    }
    [n_kept, most]
}

/// Closes the gaps that merged duplicates left and returns the new row pointers.
fn compact(pointers: &[usize], kept: &[usize], indices: &mut Vec<u32>, data: &mut Vec<f64>) -> Vec<usize> {
    let mut packed = Vec::with_capacity(pointers.len());
    packed.push(0);
    let mut end = 0;
    for (&start, &n_kept) in pointers.iter().zip(kept) {
        indices.copy_within(start..start + n_kept, end);
        data.copy_within(start..start + n_kept, end);
        end += n_kept;
        packed.push(end);
    }
    indices.truncate(end);
    data.truncate(end);
    packed
}

/// Rows that hold their diagonal entry.
fn n_on_diagonal(pointers: &[usize], indices: &[u32]) -> usize {
    let rows = pointers.windows(2).enumerate();
    rows.filter(|(row, ends)| indices[ends[0]..ends[1]].binary_search(&(*row as u32)).is_ok()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(n: u32, n_entries: u32) -> Triplets {
        let mut triplets = Triplets::default();
        for k in 0..n_entries {
            let row = (k.wrapping_mul(2_654_435_761) >> 7) % n;
            triplets.push(row, k.wrapping_mul(40_503) % (row + 1), 1.0 / f64::from(k + 1));
        }
        triplets
    }

    #[test]
    fn bits_do_not_depend_on_threads() {
        let assemble = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| scattered(300, 20_000).assemble(300, Declared::Symmetric, "k".as_ref())).expect("a matrix")
        };
        let (reference, notes) = assemble(1);
        assert!(notes.n_duplicates > 1000, "{notes:?}");
        for threads in [2, 3, 7] {
            assert_eq!(assemble(threads), (reference.clone(), notes), "{threads} threads");
        }
    }

    #[test]
    fn duplicates_are_added_in_file_order() {
        let mut triplets = Triplets::default();
        // 1 + 1e-16 rounds to 1 twice; 1e-16 + 1e-16 + 1 does not: the order of addition shows.
        for value in [1.0, 1e-16, 1e-16] {
            triplets.push(1, 0, value);
        }
        for value in [1e-16, 1e-16, 1.0] {
            triplets.push(0, 0, value);
        }
        let (matrix, _) = triplets.assemble(2, Declared::Symmetric, "k".as_ref()).expect("a matrix");
        assert_eq!(matrix.get(1, 0), Some(&1.0));
        assert_eq!(matrix.get(0, 1), Some(&1.0));
        assert_eq!(matrix.get(0, 0), Some(&(1.0 + f64::EPSILON)));
    }

    #[test]
    fn a_matrix_without_entries_is_a_matrix() {
        let (matrix, notes) = Triplets::default().assemble(3, Declared::General, "k".as_ref()).expect("a matrix");
        assert_eq!((matrix.shape(), matrix.nnz(), notes), ((3, 3), 0, AssemblyNotes::default()));
    }

    #[test]
    #[should_panic(expected = "in a matrix of order 3")]
    fn indices_must_be_below_the_order() {
        let mut triplets = Triplets::default();
        triplets.push(0, 3, 1.0);
        let _ = triplets.assemble(3, Declared::General, "k".as_ref());
    }
}
