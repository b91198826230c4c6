//! The congruence TᵀAT of a sparse matrix, row by row and in parallel; that of a symmetric one is symmetric to the bit.
//!
//! Rows are counted first, without their values, and then written to their final place, so that no second copy of the result is needed.
//!
//! Entries are summed to twice the working precision and rounded once. A large mass away from the node of its patch makes terms m r² that
//! hundreds of others are added to: an ulp of it at each of them is more than the smallest inertia of the patch can bear.

use std::collections::{BTreeMap, BTreeSet};

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::transformation::{DofOrigin, ReducedDof, Transformation};
use super::transformation_row::TransformationRow;
use crate::dense::NOISE_FACTOR;
use crate::sparse::{RowStorage, SparseMatrix, filled};
use crate::twofold::{Twofold, exact_product};

/// Rows worth a thread of their own: tens of microseconds of work.
const ROWS_PER_TASK: usize = 512;

/// TᵀAT, n' × n', bitwise symmetric for a bitwise symmetric A.
pub(super) fn congruence(matrix: &SparseMatrix, transformation: &Transformation) -> SparseMatrix {
    let n = transformation.dofs.len();
    let moved = Moved::by(transformation);
    let mut stored = rows(matrix, &moved);
    symmetrise(&mut stored, &moved);
    SparseMatrix::new((n, n), stored.pointers, stored.indices, stored.values)
}

/// TᵀAT, n' × n', of any A: sums at (i, j) and (j, i) are taken in different orders.
pub(super) fn general_congruence(matrix: &SparseMatrix, transformation: &Transformation) -> SparseMatrix {
    let n = transformation.dofs.len();
    let RowStorage { pointers, indices, values } = rows(matrix, &Moved::by(transformation));
    SparseMatrix::new((n, n), pointers, indices, values)
}

/// TᵀAT row by row.
fn rows(matrix: &SparseMatrix, moved: &Moved<'_>) -> RowStorage {
    let n = moved.transformation.dofs.len();
    let dofs = (0..n).into_par_iter().with_min_len(ROWS_PER_TASK);
    let length = |row: &mut Row<Place>, dof: usize| match moved.permuted(matrix, dof) {
        Some(own) => own.len(),
        None => row.gather(matrix, moved, dof).sums().count(),
    };
    let lengths: Vec<usize> = dofs.map_init(Row::default, length).collect();
    filled(&lengths, Row::<Twofold>::default, |row, dof, indices, values| {
        if let Some(own) = moved.permuted(matrix, dof) {
            return row.sort(own, indices, values);
        }
        let places = indices.iter_mut().zip(values);
        let sums = row.gather(matrix, moved, dof).sums();
        sums.zip(places).for_each(|((col, sum), (index, value))| (*index, *value) = (col, sum.value()));
    })
}

/// The rows of A that move with each dof.
struct Moved<'a> {
    transformation: &'a Transformation,
    /// Rows of A and factors for the dofs that rows of patches and of constraints follow, in addition to the row that is the dof itself;
    /// any other dof has that one alone, factor one.
    by_patch_nodes: BTreeMap<usize, Vec<(u32, f64)>>,
    /// Whether rows of T have tens of entries: rows of A are added up before T expands them.
    has_long_rows: bool,
}

impl<'a> Moved<'a> {
    fn by(transformation: &'a Transformation) -> Self {
        let mut by_patch_nodes: BTreeMap<usize, Vec<(u32, f64)>> = BTreeMap::new();
        for (row, entries) in transformation.rows.iter().enumerate() {
            if let TransformationRow::Tied(entries) = entries {
                for (dof, factor) in entries {
                    by_patch_nodes.entry(*dof as usize).or_default().push((row as u32, *factor));
                }
            }
        }
        let is_long = |dof: &ReducedDof| matches!(dof.origin, DofOrigin::Distortion(..));
        let is_long_row =
            |row: &TransformationRow| matches!(row, TransformationRow::Tied(entries) if entries.len() > 6);
        let has_long_rows = transformation.dofs.iter().any(is_long) || transformation.rows.iter().any(is_long_row);
        Self { transformation, by_patch_nodes, has_long_rows }
    }

    /// Columns and values of a dof's row, not in order, where it is a row of A with its columns in other places, each to itself.
    fn permuted(&self, matrix: &SparseMatrix, dof: usize) -> Option<impl ExactSizeIterator<Item = (u32, f64)>> {
        let DofOrigin::Row(row) = self.transformation.dofs[dof].origin else { return None };
        if self.is_followed(dof) {
            return None;
        }
        let (columns, values) = matrix.outer_view(row).map_or((&[][..], &[][..]), |row| row.into_raw_storage());
        let place = |col: u32| match self.transformation.rows[col as usize] {
            TransformationRow::Dof(dof) => Some(dof),
            _ => None,
        };
        let is_permuted = columns.iter().all(|col| place(*col).is_some());
        is_permuted
            .then(|| columns.iter().zip(values).map(move |(col, value)| (place(*col).unwrap_or_default(), *value)))
    }

    /// Whether rows of patches or constraints follow a dof.
    fn is_followed(&self, dof: usize) -> bool {
        self.by_patch_nodes.contains_key(&dof)
    }

    fn with(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> {
        let own = match self.transformation.dofs[dof].origin {
            DofOrigin::Row(row) => Some((row, 1.0)),
            DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => None,
        };
        let several = self.by_patch_nodes.get(&dof).into_iter().flatten();
        own.into_iter().chain(several.map(|(row, factor)| (*row as usize, *factor)))
    }
}

/// What is known of a term t_i A_ij t_j.
trait Term: Copy + Default + Send + Sync {
    fn of(factor: f64, value: f64) -> Self;
    fn times(self, lever: f64) -> Self;
    fn plus(self, other: Self) -> Self;
}

impl Term for Twofold {
    #[inline(always)]
    fn of(factor: f64, value: f64) -> Self {
        exact_product(factor, value)
    }

    #[inline(always)]
    fn times(self, lever: f64) -> Self {
        self * lever
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }
}

/// That it is there.
#[derive(Clone, Copy, Default)]
struct Place;

impl Term for Place {
    #[inline(always)]
    fn of(_: f64, _: f64) -> Self {
        Self
    }

    #[inline(always)]
    fn times(self, _: f64) -> Self {
        self
    }

    #[inline(always)]
    fn plus(self, _: Self) -> Self {
        self
    }
}

/// The terms of one row of TᵀAT, in memory used again for the next.
#[derive(Default)]
struct Row<V> {
    /// Column of each term in the upper half, its place among the values in the lower: sorted, the terms of a column stay in
    /// the order of the model, so that their sum is always the same.
    keys: Vec<u64>,
    values: Vec<V>,
    /// Values that are single terms.
    unsorted: Vec<f64>,
}

/// The rows of A that move with a dof, expanded by T.
struct Gather<'a, V> {
    to: &'a mut Row<V>,
    matrix: &'a SparseMatrix,
    moved: &'a Moved<'a>,
    dof: usize,
}

impl<V: Term> WithSimd for Gather<'_, V> {
    type Output = ();

    /// For the processor that is there, which multiplies and adds in one instruction: exact products take that.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { to, matrix, moved, dof } = self;
        to.clear();
        for (row, factor) in moved.with(dof) {
            let Some(entries) = matrix.outer_view(row) else { continue };
            for (col, value) in entries.indices().iter().zip(entries.data()) {
                let term = V::of(factor, *value);
                match moved.has_long_rows {
                    true => to.push(*col, term),
                    false => to.expand(moved, (*col, term)),
                }
            }
        }
        if moved.has_long_rows {
            let columns: Vec<(u32, V)> = to.sums().collect();
            to.clear();
            for column in columns {
                to.expand(moved, column);
            }
        }
    }
}

impl<V: Term> Row<V> {
    /// The rows that move with this dof, expanded by T.
    fn gather(&mut self, matrix: &SparseMatrix, moved: &Moved<'_>, dof: usize) -> &mut Self {
        Arch::new().dispatch(Gather { to: &mut *self, matrix, moved, dof });
        assert!(self.values.len() <= u32::MAX as usize, "a row of TᵀAT has {} terms", self.values.len());
        self
    }

    /// Writes entries of columns of their own in the order of these.
    fn sort(&mut self, entries: impl Iterator<Item = (u32, f64)>, indices: &mut [u32], values: &mut [f64]) {
        self.clear();
        self.unsorted.clear();
        for (at, (col, value)) in entries.enumerate() {
            self.keys.push(u64::from(col) << 32 | at as u64);
            self.unsorted.push(value);
        }
        self.keys.sort_unstable();
        for (key, (index, value)) in self.keys.iter().zip(indices.iter_mut().zip(values)) {
            (*index, *value) = ((key >> 32) as u32, self.unsorted[(key & u64::from(u32::MAX)) as usize]);
        }
    }

    fn clear(&mut self) {
        self.keys.clear();
        self.values.clear();
    }

    #[inline(always)]
    fn push(&mut self, column: u32, value: V) {
        self.keys.push(u64::from(column) << 32 | self.values.len() as u64);
        self.values.push(value);
    }

    /// The terms of a column of A.
    #[inline(always)]
    fn expand(&mut self, moved: &Moved<'_>, (col, value): (u32, V)) {
        for (target, lever) in moved.transformation.rows[col as usize].entries() {
            self.push(target, value.times(lever));
        }
    }

    /// Columns in ascending order, and the sum of the terms of each.
    fn sums(&mut self) -> impl Iterator<Item = (u32, V)> {
        self.keys.sort_unstable();
        let term = |key: &u64| self.values[(key & u64::from(u32::MAX)) as usize];
        let columns = self.keys.chunk_by(|left, right| left >> 32 == right >> 32);
        columns.map(move |keys| ((keys[0] >> 32) as u32, keys.iter().map(term).fold(V::default(), V::plus)))
    }
}

/// Replaces the entries of dofs that others follow by the mean of the two sides of the diagonal: their sums are taken in different orders
/// there. All other entries are single terms.
fn symmetrise(RowStorage { pointers, indices, values }: &mut RowStorage, moved: &Moved<'_>) {
    for dof in moved.by_patch_nodes.keys() {
        for at in pointers[*dof]..pointers[dof + 1] {
            let other = indices[at] as usize;
            let row = pointers[other]..pointers[other + 1];
            let partner = indices[row.clone()].binary_search(&(*dof as u32)).expect("A has a symmetric pattern");
            let mean = 0.5 * (values[at] + values[row.start + partner]);
            values[at] = mean;
            values[row.start + partner] = mean;
        }
    }
}

/// (|T|ᵀ|A||T|)_ii of the dofs that others follow: the terms of their stiffness, whatever is left of their sum.
pub(super) fn terms(matrix: &SparseMatrix, transformation: &Transformation) -> BTreeMap<u32, f64> {
    let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
    let followed = transformation.followed();
    let takes_part = |row: usize| match &transformation.rows[row] {
        TransformationRow::Dof(dof) => followed[*dof as usize],
        TransformationRow::Tied(_) => true,
        TransformationRow::Held => false,
    };
    for row in (0..transformation.rows.len()).filter(|row| takes_part(*row)) {
        let Some(view) = matrix.outer_view(row) else { continue };
        for (col, value) in view.iter().filter(|(col, _)| takes_part(*col)) {
            for (dof, factor) in transformation.rows[row].entries() {
                let mut others = transformation.rows[col].entries();
                let lever = others.find(|(other, _)| *other == dof).map_or(0.0, |(_, lever)| lever);
                *sums.entry(dof).or_default() += (factor * value * lever).abs();
            }
        }
    }
    sums
}

/// The largest (|T|ᵀ|A||T|)_ii / (TᵀAT)_ii: how much larger the terms of the stiffness of a dof that others follow are than their sum.
/// Rounding of the data reaches its row enlarged by this factor.
pub(super) fn cancellation(product: &SparseMatrix, terms: &BTreeMap<u32, f64>) -> f64 {
    let ratio = |(dof, sum): (&u32, &f64)| {
        let left = product.get(*dof as usize, *dof as usize).copied().unwrap_or(0.0);
        if left > 0.0 { sum / left } else { 1.0 }
    };
    terms.iter().map(ratio).fold(1.0, f64::max)
}

/// TᵀAT with zero in the rows and columns of dofs that move the component as a whole: what rounding left there of `terms` is no stiffness, and no
/// size of anything. An average over all nodes of a free model has six of them.
///
/// A row is rounding where every entry of it is, |TᵀAT|_ij ≤ c ε √(t_i t_j): entries of A are rounded to ε, and their terms add up to no more
/// than that root.
pub(super) fn without_rounding(mut product: SparseMatrix, terms: &BTreeMap<u32, f64>) -> SparseMatrix {
    let own = |dof: usize| product.get(dof, dof).copied().unwrap_or(0.0);
    let size = |dof: usize| terms.get(&(dof as u32)).copied().unwrap_or_else(|| own(dof));
    let is_rounding = |dof: &usize| {
        let least = |col: usize| NOISE_FACTOR * f64::EPSILON * (size(*dof) * size(col)).sqrt();
        own(*dof).abs() <= least(*dof)
            && product.outer_view(*dof).is_some_and(|row| row.iter().all(|(col, value)| value.abs() <= least(col)))
    };
    let cleared: BTreeSet<usize> = terms.keys().map(|dof| *dof as usize).filter(is_rounding).collect();
    if !cleared.is_empty() {
        for (row, mut entries) in product.outer_iterator_mut().enumerate() {
            let is_cleared = |col: usize| cleared.contains(&row) || cleared.contains(&col);
            entries.iter_mut().filter(|(col, _)| is_cleared(*col)).for_each(|(_, value)| *value = 0.0);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dofs::Direction;
    use crate::model::Site;

    /// A chain of rows, the first and the last few of which move with the nodes of two patches by levers that no sum of keeps exact.
    fn two_patches(n: usize) -> (SparseMatrix, Transformation) {
        let mut triplets = crate::sparse::Triplets::default();
        for row in 0..n as u32 {
            for step in (0..40).filter(|step| *step <= row) {
                triplets.push(row, row - step, 1.0 / f64::from(3 * row + 7 * step + 1));
            }
        }
        let matrix = triplets.assemble(n, crate::sparse::Declared::Symmetric, "a".as_ref()).expect("a matrix").0;
        let n_internal = n - 40;
        let site = Some(Site { position: [0.0; 3], direction: Direction::Ux });
        let dof = |origin, is_interface| ReducedDof { origin, is_interface, site, node: 0, dof: None };
        let mut dofs: Vec<ReducedDof> = (20..n - 20).map(|row| dof(DofOrigin::Row(row), false)).collect();
        for node in 0..2 {
            dofs.extend(Direction::ALL.map(|direction| dof(DofOrigin::PatchNode(node, direction), true)));
        }
        let patch = |node: usize, row: usize| {
            let entry = |k: usize| ((n_internal + 6 * node + k) as u32, ((row + k) as f64).sin());
            TransformationRow::Tied((0..6).map(entry).collect())
        };
        let rows = (0..n).map(|row| match row {
            0..20 => patch(0, row),
            row if row < n - 20 => TransformationRow::Dof((row - 20) as u32),
            row => patch(1, row),
        });
        (matrix, Transformation { dofs, rows: rows.collect() })
    }

    #[test]
    fn both_sides_of_the_diagonal_have_the_same_bits_for_any_number_of_threads() {
        let (matrix, transformation) = two_patches(1500);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| congruence(&matrix, &transformation))
        };
        let product = run(1);
        assert_eq!(product.rows(), 1460 + 12);
        for (row, entries) in product.outer_iterator().enumerate() {
            for (col, value) in entries.iter() {
                let other = product.get(col, row).expect("a partner");
                assert_eq!(value.to_bits(), other.to_bits(), "{row}, {col}");
            }
        }
        for threads in [2, 7] {
            assert_eq!(run(threads), product, "{threads} threads");
        }
    }
}
