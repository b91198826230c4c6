//! What a format of exports has to say of itself.

use supel_runtime::Superelement;

use super::joined::Joined;
use super::names::Names;
use crate::error::Result;

/// A format in which a superelement leaves for other programs.
pub trait Format: std::fmt::Debug + Sync {
    /// What `--to` calls it.
    fn name(&self) -> &'static str;

    /// Endings of all files that an export of it may have: a file of such a name that is not part of one looks as if it were.
    fn endings(&self) -> &'static [&'static str];

    /// Its files, complete, in the order in which they get their names.
    ///
    /// # Errors
    /// [`crate::error::Error::ExportLabel`] where the format cannot hold the label of a node.
    fn files(&self, superelement: &Superelement, names: &Names) -> Result<Vec<ExportedFile>>;

    /// The files of an assembly as one model, in the order in which they get their names; none where the format is not one of models.
    fn files_of_joined(&self, _joined: &Joined, _names: &Names) -> Option<Vec<ExportedFile>> {
        None
    }
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportedFile {
    /// How its name ends: `stiffness.mtx`.
    pub ending: &'static str,
    /// What it holds, in a few words.
    pub content: String,
    /// All of it.
    pub bytes: Vec<u8>,
}

impl ExportedFile {
    pub(super) fn text(ending: &'static str, content: &str, text: String) -> Self {
        Self { ending, content: content.to_owned(), bytes: text.into_bytes() }
    }
}
