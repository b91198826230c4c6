//! What an entry holds whole.

use super::entry::{Reader, Writer};
use super::kind::Kind;

/// A result that an entry holds whole.
pub(crate) trait Recorded: Sized {
    /// The kind of its entries.
    const KIND: Kind;

    /// Writes it.
    ///
    /// # Errors
    /// The file cannot be written.
    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()>;

    /// Reads it; none where the arrays are not those of such a result.
    fn read(from: &mut Reader<'_>) -> Option<Self>;
}
