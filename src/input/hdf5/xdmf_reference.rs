//! References of an XDMF to data in HDF5 files of its folder.

use std::path::{Component, Path, PathBuf};

use crate::linked;

/// The file in the folder of the XDMF. Where that was reached through a link in whose folder there is no such file, the one in the
/// folder of the XDMF itself.
fn next_to(path: &Path, file: &Path) -> PathBuf {
    let named = linked::named_folder(path).join(file);
    let own = || linked::own_folder(path).map(|folder| folder.join(file)).filter(|own| own.exists());
    if named.exists() { named } else { own().unwrap_or(named) }
}

/// The file and the path in it, if the reference is `file:/path` and the file lies in the folder of the XDMF or below.
pub(super) fn inside_folder<'a>(path: &Path, reference: &'a str) -> Option<(PathBuf, &'a str)> {
    let (file, object) = reference.rsplit_once(":/")?;
    let file = Path::new(file);
    let inside = file.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    // A backslash or a second colon would leave the folder on some systems.
    let portable = !reference.contains(['\\']) && !file.to_string_lossy().contains(':');
    let named = file.file_name().is_some() && !object.is_empty();
    (inside && portable && named).then(|| (next_to(path, file), object))
}
