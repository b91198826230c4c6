//! The sparse matrix of the model, and its assembly from triplets.
//!
//! sprs owns the storage. Its constructor checks every index once, and products and factorisations trust the indices
//! after that. Row indices are 32-bit, which cuts the memory traffic of a product by a quarter; pointers are machine words,
//! so that the number of entries has no 32-bit limit. Symmetric matrices are stored whole (both triangles): compressed
//! rows are then also compressed columns, and a product needs no scatter, which makes it parallel and deterministic.

mod assembly;
mod by_rows;
mod energy;
mod given;
mod leading;
mod pairs;
mod pencil;
mod principal;
mod product;
mod rounding;
mod rows;
mod triangle;
mod turning;

pub(crate) use by_rows::{RowStorage, balanced_ranges, filled};
pub(crate) use energy::{absolute_energy, energies_of_terms};
pub use given::Given;
pub(crate) use leading::ends;
pub use leading::{Leading, diagonal};
pub(crate) use pairs::{Completed, completed};
pub use pencil::{Pencil, Precision};
pub(crate) use principal::principal;
pub use product::{absolute_product, multiply, panels, product, product_and_terms};
pub use rounding::{Differing, HalfUnits, Rounding};
pub(crate) use rows::{couples, is_empty_row};
pub(crate) use triangle::Mirrored;
pub use triangle::Triangle;
pub use turning::{Turned, TurnedRoundings, Turning};

/// A symmetric sparse matrix in compressed rows, both triangles stored, indices sorted, no duplicates.
pub type SparseMatrix = sprs::CsMatI<f64, u32, usize>;

/// Whether a matrix has no entry other than zero off its diagonal.
pub(crate) fn is_diagonal(matrix: &SparseMatrix) -> bool {
    matrix.iter().all(|(value, (row, col))| row == col || *value == 0.0)
}

/// The largest order a matrix may have, 2³¹ − 1: what METIS and 32-bit row indices can number.
pub const MAX_ORDER: usize = i32::MAX as usize;

/// Bytes of an entry before it is in its row: row, column, value.
pub(crate) const TRIPLET_BYTES: u64 = 16;
/// Bytes of an entry of the assembled matrix: column and value.
pub(crate) const ENTRY_BYTES: u64 = 12;
/// Bytes of a row of the assembled matrix.
pub(crate) const ROW_BYTES: u64 = 8;

/// How a source declares its triplets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declared {
    /// Every entry is given, or each pair of a row and a column once, in one triangle or in either order, which stands for both.
    General,
    /// Every entry is given, or one triangle that stands for both; which triangle holds is known.
    OneHolds,
    /// Every entry is given.
    Whole,
    /// Each pair of a row and a column is given once, in one triangle or in either order, and stands for both.
    Symmetric,
    /// Each pair is given once, and its mirror image has the opposite sign.
    Skew,
}

/// Entries of a matrix in the order of their file: row, column, value, zero-based.
#[derive(Clone, Debug, Default)]
pub struct Triplets {
    /// Row of each entry.
    pub rows: Vec<u32>,
    /// Column of each entry.
    pub cols: Vec<u32>,
    /// Value of each entry.
    pub values: Vec<f64>,
}

/// Entries of a matrix in the order of their file, block after block: a list that grows would be held twice each time it moves.
#[derive(Clone, Debug, Default)]
pub struct TripletBlocks {
    /// The blocks.
    pub blocks: Vec<Triplets>,
}

/// What assembling a matrix did beyond copying, for the user.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AssemblyNotes {
    /// Entries that repeated an earlier position and were added to it.
    pub n_duplicates: usize,
    /// The most entries that were added up at one position; none where nothing repeats.
    pub most_repeated: usize,
    /// The most of the entries as they came that are of one size; unknown where not counted.
    pub most_alike: Option<usize>,
    /// What a source declared general gave. It was mirrored unless that was the whole matrix.
    pub given: Given,
    /// The triangle in which all entries were given; none where some stand in either, or it was not asked.
    pub triangle: Option<Triangle>,
    /// What turning rows made of the roundings of its entries; none where no row was turned.
    pub turned: Option<TurnedRoundings>,
    /// Roundings of numbers that were added to its entries after that, as [`Rounding::made`] counts them.
    pub added: f64,
}
