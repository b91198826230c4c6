//! The formats of meshes that are read from beginning to end, one line each, among the formats of nodes.

use std::path::{Path, PathBuf};

use super::cell_mesh::CellMesh;
use super::{deck, frd, gmsh, vtk};
use crate::error::Result;
use crate::input::Allowance;
use crate::input::faces::CellList;
use crate::input::file_start::FileStart;
use crate::input::format::{Format, NodeFormat, ReadCells, ReadNodes, Sureness};
use crate::input::patch::{PatchFaces, Patches};

/// A format of meshes.
pub(in crate::input) struct MeshFile {
    sureness: fn(&FileStart<'_>) -> Sureness,
    read: fn(&Path, &Allowance) -> Result<CellMesh>,
    referenced: fn(&Path) -> Vec<PathBuf>,
    data_digest: fn(&Path) -> Result<Option<String>>,
}

/// Input decks of Abaqus and CalculiX.
pub(in crate::input) const DECK: MeshFile = MeshFile {
    sureness: deck::sureness,
    read: deck::read,
    referenced: deck::included_files,
    data_digest: deck::digest_of_included,
};

/// Meshes of Gmsh.
pub(in crate::input) const GMSH: MeshFile = MeshFile::alone(gmsh::sureness, gmsh::read);

/// Result files of CalculiX.
pub(in crate::input) const FRD: MeshFile = MeshFile::alone(frd::sureness, frd::read);

/// Old files of VTK.
pub(in crate::input) const VTK: MeshFile = MeshFile::alone(vtk::legacy_sureness, vtk::read_legacy);

/// XML files of VTK.
pub(in crate::input) const VTU: MeshFile = MeshFile::alone(vtk::xml_sureness, vtk::read_xml);

impl MeshFile {
    /// A format whose files refer to no others.
    const fn alone(sureness: fn(&FileStart<'_>) -> Sureness, read: fn(&Path, &Allowance) -> Result<CellMesh>) -> Self {
        Self { sureness, read, referenced: |_| Vec::new(), data_digest: |_| Ok(None) }
    }
}

impl Format for MeshFile {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        (self.sureness)(start)
    }
}

impl NodeFormat for MeshFile {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        let CellMesh { nodes, data_digest, frames, .. } = (self.read)(path, allowance)?;
        Ok(ReadNodes { frames, ..ReadNodes::along_the_axes(nodes, data_digest) })
    }

    fn referenced_files(&self, path: &Path) -> Vec<PathBuf> {
        (self.referenced)(path)
    }

    fn data_digest(&self, path: &Path) -> Result<Option<String>> {
        (self.data_digest)(path)
    }

    fn has_cells(&self) -> bool {
        true
    }

    fn read_cells(&self, path: &Path, _: &[[f64; 3]], allowance: &Allowance) -> Result<ReadCells> {
        let CellMesh { cells: runs, unread, .. } = (self.read)(path, allowance)?;
        let mut cells = CellList::default();
        runs.into_iter().for_each(|run| cells.extend(run.cell, run.nodes));
        Ok(ReadCells { cells, unread })
    }

    fn read_faces(&self, path: &Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
        (self.read)(path, allowance)?.faces(path, patches, allowance)
    }
}
