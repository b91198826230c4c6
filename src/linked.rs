//! Files reached through a symbolic link: there are two folders from which the names written in them may count.
//!
//! One is the folder of the link, whose name was typed; the other is the folder of the file itself.

use std::path::{Path, PathBuf};

/// The folder of a name, which may be that of a link; empty for that of the process.
pub(crate) fn named_folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The file that a link leads to, where that lies in another folder or has another name; none where `path` is no link.
pub(crate) fn target(path: &Path) -> Option<PathBuf> {
    let is_link = std::fs::symlink_metadata(path).ok()?.is_symlink();
    if is_link { path.canonicalize().ok() } else { None }
}

/// The folder of the file that a link leads to, where that is another one than the folder of the link.
pub(crate) fn own_folder(path: &Path) -> Option<PathBuf> {
    let own = target(path)?.parent()?.to_owned();
    let named = std::path::absolute(path).ok()?.parent()?.canonicalize().ok();
    (named.as_ref() != Some(&own)).then_some(own)
}
