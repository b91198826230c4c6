//! A file that appears whole or not at all.

use alloc::borrow::ToOwned;
use alloc::vec::Vec;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::{FileError, Result};

/// A file written and synced under a temporary name in the folder of its final one.
///
/// [`StagedFile::commit`] gives it its name in one step; dropped without that, it is removed and whatever had the name
/// before stays untouched. So a reader sees the old file or the new one, never half of one, and a superelement can be
/// read back and checked before it gets its name. A process killed in between leaves a file that ends in `.part`.
#[derive(Debug)]
pub struct StagedFile {
    target: PathBuf,
    temporary: PathBuf,
    committed: bool,
}

impl StagedFile {
    /// Writes `bytes` beside `target`, under a name of its own, and syncs them to the disk.
    ///
    /// # Errors
    ///
    /// [`FileError::NotAFile`] if the name is taken by something that is not a regular file,
    /// [`FileError::Write`] if the system refuses; nothing is left behind in both cases.
    pub fn write(target: &Path, bytes: &[u8]) -> Result<Self> {
        let name = target.file_name().ok_or_else(|| FileError::NotAFile { path: target.to_owned() })?;
        // Renaming onto a device or a pipe would replace it; onto a folder it fails only after all the work.
        if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
            return Err(FileError::NotAFile { path: target.to_owned() });
        }
        let failed = |source| FileError::Write { path: target.to_owned(), source };
        let (mut file, temporary) = create_beside(target, name).map_err(failed)?;
        // From here on the temporary file is removed on every way out.
        let staged = Self { target: target.to_owned(), temporary, committed: false };
        file.write_all(bytes).and_then(|()| file.sync_all()).map_err(failed)?;
        Ok(staged)
    }

    /// Where the bytes are until the commit, to read them back.
    pub fn path(&self) -> &Path {
        &self.temporary
    }

    /// Gives the file its final name and syncs the folder.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`] if the system refuses. If it refuses the renaming, the old file is intact and the new one
    /// removed; if it refuses to sync the folder, the new file is in place but might not survive a power cut.
    pub fn commit(mut self) -> Result<()> {
        let target = self.target.clone();
        let failed = |source| FileError::Write { path: target.clone(), source };
        fs::rename(&self.temporary, &target).map_err(failed)?;
        self.committed = true;
        sync_folder(folder_of(&target)).map_err(failed)
    }
}

impl Drop for StagedFile {
    fn drop(&mut self) {
        // After a commit the name is free and may already be another writer's.
        if !self.committed {
            // If the removal fails too, nobody is left to be told; the next writer reports the file.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Temporary files beside `target` that an interrupted run left (or a running one is writing), sorted by name.
///
/// Readers ignore them; a writer reports them.
pub fn abandoned_parts(target: &Path) -> Vec<PathBuf> {
    let Some(name) = target.file_name() else {
        return Vec::new();
    };
    let start = part_prefix(name);
    let Ok(entries) = fs::read_dir(folder_of(target)) else {
        return Vec::new();
    };
    let is_part = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().as_encoded_bytes();
        name.starts_with(start.as_encoded_bytes()) && name.ends_with(PART.as_bytes())
    };
    let mut parts = entries.flatten().map(|entry| entry.path()).filter(is_part).collect::<Vec<_>>();
    parts.sort();
    parts
}

const PART: &str = ".part";

fn part_prefix(name: &std::ffi::OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(".");
    prefix
}

/// Creates a file that did not exist, in the folder of `target` so that renaming never crosses file systems.
fn create_beside(target: &Path, name: &std::ffi::OsStr) -> io::Result<(File, PathBuf)> {
    let mut attempt = 0u32;
    loop {
        let mut temporary = part_prefix(name);
        temporary.push(format!("{}-{attempt}{PART}", std::process::id()));
        let path = target.with_file_name(temporary);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((file, path)),
            Err(source) if source.kind() == ErrorKind::AlreadyExists && attempt < 1000 => attempt += 1,
            Err(source) => return Err(source),
        }
    }
}

fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes the renaming itself survive a power cut, where the system can: only Unix opens folders as files, and some
/// network file systems do not sync them.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    match File::open(folder)?.sync_all() {
        Err(source) if matches!(source.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        synced => synced,
    }
}
