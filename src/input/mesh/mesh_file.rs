//! The formats of meshes that are read from beginning to end, one line each, among the formats of nodes.

use std::path::{Path, PathBuf};

use super::cell_mesh::CellMesh;
use super::{deck, frd, gmsh, vtk};
use crate::error::Result;
use crate::input::Allowance;
use crate::input::file_start::FileStart;
use crate::input::format::{Format, NodeFormat, ReadNodes, Sureness};
use crate::input::patch::{PatchFaces, Patches};

/// A format of meshes.
pub(in crate::input) struct MeshFile {
    sureness: fn(&FileStart<'_>) -> Sureness,
    read: fn(&Path, &Allowance) -> Result<CellMesh>,
    referenced: fn(&Path) -> Vec<PathBuf>,
}

/// Input decks of Abaqus and CalculiX.
pub(in crate::input) const DECK: MeshFile =
    MeshFile { sureness: deck::sureness, read: deck::read, referenced: deck::included_files };

/// Meshes of Gmsh.
pub(in crate::input) const GMSH: MeshFile =
    MeshFile { sureness: gmsh::sureness, read: gmsh::read, referenced: |_| Vec::new() };

/// Result files of CalculiX.
pub(in crate::input) const FRD: MeshFile =
    MeshFile { sureness: frd::sureness, read: frd::read, referenced: |_| Vec::new() };

/// Old files of VTK.
pub(in crate::input) const VTK: MeshFile =
    MeshFile { sureness: vtk::legacy_sureness, read: vtk::read_legacy, referenced: |_| Vec::new() };

/// XML files of VTK.
pub(in crate::input) const VTU: MeshFile =
    MeshFile { sureness: vtk::xml_sureness, read: vtk::read_xml, referenced: |_| Vec::new() };

impl Format for MeshFile {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        (self.sureness)(start)
    }
}

impl NodeFormat for MeshFile {
    fn read(&self, path: &Path, allowance: &Allowance) -> Result<ReadNodes> {
        let CellMesh { nodes, data_digest, local_directions, .. } = (self.read)(path, allowance)?;
        Ok(ReadNodes { nodes, data_digest, local_directions })
    }

    fn referenced_files(&self, path: &Path) -> Vec<PathBuf> {
        (self.referenced)(path)
    }

    fn has_cells(&self) -> bool {
        true
    }

    fn read_faces(&self, path: &Path, patches: &Patches, allowance: &Allowance) -> Result<Vec<PatchFaces>> {
        (self.read)(path, allowance)?.faces(path, patches, allowance)
    }
}
