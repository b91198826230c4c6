//! The files of a run: written under temporary names, then renamed together, the superelement last.

use std::io::Write;
use std::path::Path;

use supel_runtime::{StagedFile, StagedWriter, abandoned_parts, writer_of_part};

use super::overwriting::OwnFiles;
use super::signals;
use crate::error::{Error, Result};
use crate::unfinished;

/// Files that wait for their names.
pub(super) struct Outputs<'a> {
    own: &'a OwnFiles,
    staged: Vec<StagedFile>,
}

impl<'a> Outputs<'a> {
    /// None yet of the outputs of a command.
    pub(super) fn new(own: &'a OwnFiles) -> Self {
        Self { own, staged: Vec::new() }
    }

    /// Writes a file under a temporary name, after those before it in the order of names.
    pub(super) fn stage(&mut self, path: &Path, bytes: &[u8]) -> Result<()> {
        self.staged.push(staged(self.own, path, bytes)?);
        Ok(())
    }

    /// Takes a file that was staged already as the last one.
    pub(super) fn push(&mut self, file: StagedFile) {
        self.staged.push(file);
    }

    /// Gives all files their names, or none.
    pub(super) fn commit(self) -> Result<()> {
        let committed = signals::deferred(|| StagedFile::commit_all(self.staged));
        unfinished::keep_all();
        committed.map_err(Error::of_writing)
    }
}

/// A file under a temporary name, which is removed wherever the run ends before it gets its own.
///
/// # Panics
/// Where it is none of the outputs of the command.
pub(super) fn staged(own: &OwnFiles, path: &Path, bytes: &[u8]) -> Result<StagedFile> {
    let mut writer = writer(own, path)?;
    writer.write_all(bytes).map_err(|source| Error::Write { path: path.to_owned(), source })?;
    writer.finish().map_err(Error::of_writing)
}

/// A file that is written piece by piece under a temporary name, which is removed wherever the run ends before it gets its own.
///
/// # Panics
/// Where it is none of the outputs of the command.
pub(super) fn writer(own: &OwnFiles, path: &Path) -> Result<StagedWriter> {
    assert!(own.paths().iter().any(|output| output == path), "{} is no output of this command", path.display());
    // No signal comes between a file and what removes it.
    signals::deferred(|| {
        let writer = StagedWriter::create(path).map_err(Error::of_writing)?;
        unfinished::remove_at_end(writer.path());
        Ok(writer)
    })
}

/// Refuses an output that has no place before the model is read, with the error that its writing would end in: an empty
/// file is written in the folder of each and dropped.
pub(super) fn refuse_unwritable(own: &OwnFiles) -> Result<()> {
    // The names of other outputs follow from the superelement, which is the last: its folder is checked first.
    let try_writing = |path: &_| StagedFile::write(path, &[]).map(drop).map_err(Error::of_writing);
    own.paths().iter().rev().try_for_each(|path| signals::deferred(|| try_writing(path)))
}

/// What is to be said of temporary files in the folders of the outputs, which other runs left or are writing.
pub(super) fn abandoned(own: &OwnFiles) -> Vec<String> {
    let parts = own.paths().iter().flat_map(|path| abandoned_parts(path));
    let said = |part: &Path| match is_of_running(part) {
        true => "another run may be writing it – remove it if none is",
        false => "left by an interrupted run – it can be removed",
    };
    parts.map(|part| format!("supel: {}: {}", part.display(), said(&part))).collect()
}

/// Whether the process that writes a temporary file runs, where the system tells.
fn is_of_running(part: &Path) -> bool {
    writer_of_part(part).is_some_and(|process| Path::new("/proc").join(process.to_string()).exists())
}
