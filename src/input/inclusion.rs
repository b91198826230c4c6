//! Files that a deck includes: where they may lie, and how many there may be.

use std::path::{Component, Path, PathBuf};

use crate::linked;

/// Files that are open at once, each included by the one before.
const MAX_DEPTH: usize = 16;
/// What is expected of a file that is not where it has to be, and of files that go on including others.
const INSIDE: &str = "a file in the folder of the deck or below – put it there";
const FINITE: &str = "files that do not include themselves, by others or directly – take the line out that does";
const FEWER: &str = "a thousand inclusions at most – put the files together";
/// Inclusions of one deck.
const MAX_INCLUSIONS: usize = 1 << 10;

/// The file that a deck includes by the name `reference`, where it lies in the deck's folder or below, links followed. `n_open` files are
/// open, and `n_files` were opened so far, the deck among them.
///
/// # Errors
/// Why the file is not read, and what is expected, in words.
pub(super) fn included_file(
    deck: &Path,
    reference: &str,
    (n_open, n_files): (usize, usize),
) -> Result<PathBuf, [&'static str; 2]> {
    let file = inside_folder(deck, reference).map_err(|reason| [reason, INSIDE])?;
    match () {
        () if n_open >= MAX_DEPTH => Err(["by 16 files that include each other", FINITE]),
        () if n_files > MAX_INCLUSIONS => Err(["behind a thousand others", FEWER]),
        () => Ok(file),
    }
}

/// The file of a name, where it lies in the deck's folder or below. Decks that were written for Windows part folders by a backslash.
fn inside_folder(deck: &Path, reference: &str) -> Result<PathBuf, &'static str> {
    let reference = reference.replace('\\', "/");
    let name = Path::new(&reference);
    let is_inside = name.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !is_inside || reference.contains(':') {
        return Err("which is outside its folder");
    }
    let folders = [Some(linked::named_folder(deck).to_owned()), linked::own_folder(deck)];
    let mut reason = "which is not there";
    for folder in folders.into_iter().flatten() {
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        let file = folder.join(name);
        let (Ok(real), Ok(real_folder)) = (file.canonicalize(), folder.canonicalize()) else { continue };
        if real.starts_with(real_folder) {
            return Ok(file);
        }
        reason = "a link to a file outside its folder";
    }
    Err(reason)
}
