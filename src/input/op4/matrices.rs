//! The matrices of a file one after another, whatever their form.

use super::head::Head;
use crate::error::Result;

/// A file that stands at the head of a matrix, or before the records of one.
pub(super) trait Matrices<'a>: Sized {
    /// The head of the next matrix; none at the end of the file.
    fn head(&mut self) -> Result<Option<Head>>;

    /// Goes over the records of a matrix.
    fn skip(&mut self, head: &Head) -> Result<()>;

    /// Hands every entry, row and column from zero, to `take`.
    fn entries(&mut self, head: &Head, take: &mut dyn FnMut(u32, u32, f64) -> Result<()>) -> Result<()>;

    /// BLAKE3 of the file.
    fn digest(self) -> Result<String>;
}
