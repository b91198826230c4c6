//! Opens files for every reader. Only regular files are opened, and a file that changes while it is read is refused.

use std::fs::{File, Metadata};
use std::path::Path;
use std::time::SystemTime;

use crate::error::{Error, Result};

/// Opens a file for reading. What would be waited for or has no end is refused before it is opened: pipes, devices, folders and what the
/// kernel makes up while it is read, by their own names or through links.
///
/// # Errors
/// [`Error::NotAFile`]; [`Error::Read`] where the system refuses.
pub(crate) fn open(path: &Path) -> Result<File> {
    facts(path)?;
    let file = File::open(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
    Ok(file)
}

/// What the system says of a regular file.
fn facts(path: &Path) -> Result<Metadata> {
    let facts = std::fs::metadata(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
    if !facts.is_file() || is_made_up(&facts) {
        return Err(Error::NotAFile { path: path.to_owned() });
    }
    Ok(facts)
}

/// Whether a file is one of the process file system, which calls it regular although a reader may wait for ever.
#[cfg(unix)]
fn is_made_up(facts: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::symlink_metadata("/proc/self").is_ok_and(|processes| processes.dev() == facts.dev())
}

#[cfg(not(unix))]
fn is_made_up(_: &Metadata) -> bool {
    false
}

/// Reads a file by `read` and makes sure that it is the same file afterwards, of one size and time: then what was read is what its digest
/// covers, however often it was opened.
///
/// # Errors
/// [`Error::Changed`], also where `read` failed because of that; those of [`open`]; those of `read`.
pub(crate) fn unchanged<T>(path: &Path, read: impl FnOnce() -> Result<T>) -> Result<T> {
    let before = stamp(&facts(path)?);
    let outcome = read();
    let after = std::fs::metadata(path).ok().map(|facts| stamp(&facts));
    if after.as_ref() == Some(&before) { outcome } else { Err(Error::Changed { path: path.to_owned() }) }
}

/// What tells one state of a file from another.
#[derive(PartialEq, Eq)]
struct Stamp {
    size: u64,
    written: Option<SystemTime>,
    identity: (u64, u64),
}

fn stamp(facts: &Metadata) -> Stamp {
    Stamp { size: facts.len(), written: facts.modified().ok(), identity: identity(facts) }
}

#[cfg(unix)]
fn identity(facts: &Metadata) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (facts.dev(), facts.ino())
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> (u64, u64) {
    (0, 0)
}

/// Whether a file that begins with these bytes is text in UTF-16, which some editors and shells write: by its byte order mark, or by every
/// other byte, which is zero in the letters of a format.
pub(crate) fn is_utf16(head: &[u8]) -> bool {
    let is_marked = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    is_marked || matches!(head, [b' '..=b'~', 0, b' '..=b'~', 0, ..] | [0, b' '..=b'~', 0, b' '..=b'~', ..])
}

/// BLAKE3 digest of a file's bytes, lower-case hexadecimal.
pub(crate) fn digest(path: &Path) -> Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(open(path)?).map_err(|source| Error::Read { path: path.to_owned(), source })?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// One digest for several files, from theirs in the order in which they were read: that of the only one, else that of the list, one below the
/// other.
pub(crate) fn digest_of_list(digests: &[String]) -> String {
    match digests {
        [digest] => digest.clone(),
        digests => blake3::hash(digests.join("\n").as_bytes()).to_hex().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever is done to a file while it is read shows afterwards, even where its content parses.
    #[test]
    fn a_file_that_changes_is_noticed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a");
        let other = folder.path().join("b");
        let whole = || {
            std::fs::write(&path, "whole").expect("written");
            std::fs::write(&other, "other").expect("written");
            for path in [&path, &other] {
                let file = File::options().write(true).open(path).expect("a file");
                file.set_modified(SystemTime::UNIX_EPOCH).expect("a time");
            }
        };
        type Change<'a> = &'a dyn Fn() -> std::io::Result<()>;
        let shorter: Change<'_> = &|| File::options().write(true).open(&path)?.set_len(3);
        let longer: Change<'_> = &|| std::fs::write(&path, "longer");
        let of_one_size: Change<'_> = &|| std::fs::write(&path, "WHOLE");
        let exchanged: Change<'_> = &|| std::fs::rename(&other, &path);
        let gone: Change<'_> = &|| std::fs::remove_file(&path);
        for change in [shorter, longer, of_one_size, exchanged, gone] {
            whole();
            let read = || change().map_err(|source| Error::Read { path: path.clone(), source });
            assert!(matches!(unchanged(&path, read), Err(Error::Changed { .. })));
            whole();
            let failing = || {
                change().expect("changed");
                Err::<(), Error>(Error::NoMass)
            };
            assert!(matches!(unchanged(&path, failing), Err(Error::Changed { .. })), "the reason goes first");
        }
        whole();
        assert!(unchanged(&path, || Ok(())).is_ok());
    }
}
