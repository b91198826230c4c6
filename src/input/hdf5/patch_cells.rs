//! The faces of patches from the cells of a mesh; the content tells the format.

use std::path::Path;

use super::file::{H5, with_memory};
use super::group::Group;
use super::{layout, nodes, xdmf_cells};
use crate::error::Result;
use crate::input::Allowance;
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;
use crate::input::patch::{PatchFaces, Patches};

/// The faces of patches whose nodes are those of the mesh at `path`.
///
/// # Errors
/// Cells that refer to nodes that are not there or do not fill their table, and everything that can be wrong with a file.
pub(crate) fn read_faces(path: &Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
    let gathered = || Gathered::new(path, patches, allowance);
    let (faces, known) = if nodes::is_xml(path)? {
        let mut faces = gathered()?;
        let known = xdmf_cells::read(path, allowance, &mut faces)?;
        (faces, known)
    } else {
        with_memory(path, || {
            let mut faces = gathered()?;
            let h5 = H5::open(path, allowance)?;
            let root = Group::root(&h5)?;
            let known = (layout::of(&root)?.cells)(&root, &mut faces)?;
            Ok((faces, known))
        })?
    };
    match known {
        Known::All => faces.into_centroids(),
        Known::Not(what) => Ok(faces.unknown(&format!("the mesh has what supel does not read, {what}"))),
    }
}
