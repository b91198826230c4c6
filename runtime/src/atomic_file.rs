//! A file that appears whole or not at all.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
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
    /// Writes `bytes` next to `target`, under a name of its own, and syncs them to the disk.
    ///
    /// # Errors
    ///
    /// [`FileError::NotAFile`] if the name is taken by something that is not a regular file,
    /// [`FileError::Write`] if the system refuses; nothing is left behind in both cases.
    pub fn write(target: &Path, bytes: &[u8]) -> Result<Self> {
        let mut writer = StagedWriter::create(target)?;
        writer.write_all(bytes).map_err(|source| FileError::Write { path: target.to_owned(), source })?;
        writer.finish()
    }

    /// Where the bytes are until the commit, to read them back.
    pub fn path(&self) -> &Path {
        &self.temporary
    }

    /// Gives the file its final name and syncs the folder.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`] if the system refuses the renaming: the old file is intact and the new one removed.
    /// [`FileError::NotSynced`] if it refuses to sync the folder: the new file is in place but might not survive a power cut.
    pub fn commit(mut self) -> Result<()> {
        self.rename()?;
        sync_folder(folder_of(&self.target))
            .map_err(|source| FileError::NotSynced { path: self.target.clone(), source })
    }

    /// Gives several files their final names, in their order, all of them or none.
    ///
    /// A file that had one of the names before is kept under a temporary name until the last file has its own. It gets its name
    /// back if the system refuses one of the new names. A process killed in between leaves the first files new and the last one
    /// old. So the file that the others describe goes last.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`] if the system refuses a name: everything is as it was. [`FileError::HalfWritten`] if it also refuses
    /// to take back a file that had its name already. [`FileError::NotSynced`] if all have their names, but the folder of the last
    /// one was not synced.
    pub fn commit_all(files: Vec<Self>) -> Result<()> {
        let mut renamings = Vec::with_capacity(files.len());
        for file in files {
            match Replaced::keep(&file.target) {
                Ok(old) => renamings.push(Renaming { file, old }),
                Err(error) => return Err(undone(renamings, error)),
            }
        }
        // Nothing between the first name and the last needs memory: there may be none left.
        if let Err(error) = rename_all(&mut renamings) {
            return Err(undone(renamings, error));
        }
        let synced = renamings.last().map_or(Ok(()), |last| sync_folder(folder_of(&last.file.target)));
        let last = renamings.pop();
        renamings.into_iter().for_each(|renaming| renaming.old.forget());
        let Some(Renaming { file, old }) = last else { return Ok(()) };
        old.forget();
        synced.map_err(|source| FileError::NotSynced { path: file.target.clone(), source })
    }

    fn rename(&mut self) -> Result<()> {
        fs::rename(&self.temporary, &self.target)
            .map_err(|source| FileError::Write { path: self.target.clone(), source })?;
        self.committed = true;
        Ok(())
    }
}

/// A staged file that is still being written, piece by piece; dropped before [`StagedWriter::finish`] it is removed.
#[derive(Debug)]
pub struct StagedWriter {
    file: BufWriter<File>,
    staged: StagedFile,
}

impl StagedWriter {
    /// An empty file next to `target`, under a name of its own.
    ///
    /// # Errors
    ///
    /// [`FileError::NotAFile`] if the name is taken by something that is not a regular file,
    /// [`FileError::Write`] if the system refuses; nothing is left behind in both cases.
    pub fn create(target: &Path) -> Result<Self> {
        let name = target.file_name().ok_or_else(|| FileError::NotAFile { path: target.to_owned() })?;
        // Renaming onto a device or a pipe would replace it; onto a folder it fails only after all the work.
        if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
            return Err(FileError::NotAFile { path: target.to_owned() });
        }
        let failed = |source| FileError::Write { path: target.to_owned(), source };
        let (file, temporary) = create_next_to(target, name).map_err(failed)?;
        // From here on the temporary file is removed on every way out.
        let staged = StagedFile { target: target.to_owned(), temporary, committed: false };
        Ok(Self { file: BufWriter::new(file), staged })
    }

    /// Where the bytes are meanwhile.
    pub fn path(&self) -> &Path {
        self.staged.path()
    }

    /// Syncs what was written to the disk.
    ///
    /// # Errors
    ///
    /// [`FileError::Write`] if the system refuses; nothing is left behind.
    pub fn finish(self) -> Result<StagedFile> {
        let Self { file, staged } = self;
        let failed = |source| FileError::Write { path: staged.target.clone(), source };
        let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
        file.sync_all().map_err(failed)?;
        Ok(staged)
    }
}

impl Write for StagedWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A file that gets its name, and what had it before.
struct Renaming {
    file: StagedFile,
    old: Replaced,
}

/// The last one when the names of the others are on the disk.
fn rename_all(renamings: &mut [Renaming]) -> Result<()> {
    let Some((last, others)) = renamings.split_last_mut() else { return Ok(()) };
    others.iter_mut().try_for_each(|renaming| renaming.file.rename())?;
    for Renaming { file, .. } in others {
        sync_folder(folder_of(&file.target))
            .map_err(|source| FileError::Write { path: file.target.clone(), source })?;
    }
    last.file.rename()
}

/// Puts back what had the names before, the last one first, because of `error`.
fn undone(renamings: Vec<Renaming>, error: FileError) -> FileError {
    let left: Vec<String> = renamings.into_iter().rev().filter_map(Renaming::undo).collect();
    match error {
        FileError::Write { path, source } if !left.is_empty() => {
            FileError::HalfWritten { path, source, left: left.join("; ") }
        }
        error => error,
    }
}

impl Renaming {
    /// Says what is left to be done where the system refuses.
    fn undo(self) -> Option<String> {
        let Self { file, old } = self;
        if !file.committed {
            old.forget();
            return None;
        }
        let target = file.target.display();
        match &old.kept {
            Some(kept) => {
                let told = |_| format!("{target} is new, its old content is in {}", kept.display());
                fs::rename(kept, &file.target).err().map(told)
            }
            None => fs::remove_file(&file.target).err().map(|_| format!("{target} is new")),
        }
    }
}

/// What had a name before a new file takes it, under a temporary name; none where nothing had it.
struct Replaced {
    kept: Option<PathBuf>,
}

impl Replaced {
    fn keep(target: &Path) -> Result<Self> {
        let failed = |source| FileError::Write { path: target.to_owned(), source };
        if fs::symlink_metadata(target).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
            return Ok(Self { kept: None });
        }
        let name = target.file_name().ok_or_else(|| FileError::NotAFile { path: target.to_owned() })?;
        // A second name costs nothing. File systems without second names get a copy.
        let linked = under_a_free_name(target, name, |path| fs::hard_link(target, path));
        let kept = match linked {
            Ok(((), path)) => path,
            Err(_) => copied_next_to(target, name).map_err(failed)?,
        };
        Ok(Self { kept: Some(kept) })
    }

    fn forget(self) {
        if let Some(kept) = self.kept {
            // If the removal fails, the next writer reports the file.
            let _ = fs::remove_file(kept);
        }
    }
}

/// A synced copy of a file, in its folder.
fn copied_next_to(target: &Path, name: &std::ffi::OsStr) -> io::Result<PathBuf> {
    let (mut copy, path) = create_next_to(target, name)?;
    let copied = File::open(target).and_then(|mut old| io::copy(&mut old, &mut copy)).and_then(|_| copy.sync_all());
    match copied {
        Ok(()) => Ok(path),
        Err(source) => {
            let _ = fs::remove_file(path);
            Err(source)
        }
    }
}

impl Drop for StagedFile {
    fn drop(&mut self) {
        // After a commit the name is free and may already be another writer's.
        if !self.committed {
            // If the removal fails too there is no one to report it to; the next writer reports the file.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Temporary files next to `target` that an interrupted run left (or a running one is writing), sorted by name.
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

/// The number of the process that wrote a temporary file or is writing it, which its name tells.
pub fn writer_of_part(part: &Path) -> Option<u32> {
    let name = part.file_name()?.to_str()?.strip_suffix(PART)?;
    let (number, _attempt) = name.rsplit_once('.')?.1.split_once('-')?;
    number.parse().ok()
}

const PART: &str = ".part";

fn part_prefix(name: &std::ffi::OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(".");
    prefix
}

/// Creates a file that did not exist, in the folder of `target` so that renaming never crosses file systems.
fn create_next_to(target: &Path, name: &std::ffi::OsStr) -> io::Result<(File, PathBuf)> {
    under_a_free_name(target, name, |path| OpenOptions::new().write(true).create_new(true).open(path))
}

/// Does something with the first temporary name in the folder of `target` that nothing has.
fn under_a_free_name<T>(
    target: &Path,
    name: &std::ffi::OsStr,
    make: impl Fn(&Path) -> io::Result<T>,
) -> io::Result<(T, PathBuf)> {
    let mut attempt = 0u32;
    loop {
        let mut temporary = part_prefix(name);
        temporary.push(format!("{}-{attempt}{PART}", std::process::id()));
        let path = target.with_file_name(temporary);
        match make(&path) {
            Ok(made) => return Ok((made, path)),
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
