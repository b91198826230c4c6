//! The faces of patches from the cells of a mesh; the content tells the format.

use std::path::Path;

use super::file::{H5, with_memory};
use super::group::Group;
use super::{layout, nodes, xdmf_cells};
use crate::error::Result;
use crate::input::Allowance;
use crate::input::cell_kind::Known;
use crate::input::faces::Gathered;
use crate::input::format::ReadCells;
use crate::input::patch::{PatchFaces, Patches};

/// The faces of patches whose nodes are those of the mesh at `path`.
///
/// # Errors
/// Cells that refer to nodes that are not there or do not fill their table, and everything that can be wrong with a file.
pub(crate) fn read_faces(path: &Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
    match gathered(path, allowance, || Gathered::new(path, patches, allowance))? {
        (faces, Known::All) => faces.into_centroids(),
        (faces, Known::Not(what)) => Ok(faces.unknown(&format!("the mesh has what supel does not read, {what}"))),
    }
}

/// All cells of the mesh at `path`, whose nodes are at these places.
///
/// # Errors
/// The errors of [`read_faces`].
pub(in crate::input) fn read_cells(path: &Path, coordinates: &[[f64; 3]], allowance: &Allowance) -> Result<ReadCells> {
    let patches = Patches { list: Vec::new(), coordinates };
    let listing = || Gathered::new(path, &patches, allowance).map(Gathered::listing);
    let (faces, known) = gathered(path, allowance, listing)?;
    let unread = match known {
        Known::All => None,
        Known::Not(what) => Some(what),
    };
    Ok(ReadCells { cells: faces.into_list(), unread })
}

/// What is made of the cells of a mesh, and whether all of them are known.
fn gathered<'a>(
    path: &Path,
    allowance: &Allowance,
    begun: impl Fn() -> Result<Gathered<'a>>,
) -> Result<(Gathered<'a>, Known)> {
    if nodes::is_xml(path)? {
        let mut faces = begun()?;
        let known = xdmf_cells::read(path, allowance, &mut faces)?;
        return Ok((faces, known));
    }
    with_memory(path, || {
        let mut faces = begun()?;
        let h5 = H5::open(path, allowance)?;
        let root = Group::root(&h5)?;
        let known = (layout::of(&root)?.cells)(&root, &mut faces)?;
        Ok((faces, known))
    })
}
