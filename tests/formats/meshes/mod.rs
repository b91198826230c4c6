//! Meshes in decks, text and binary files: nodes, groups and faces as their programs mean them, and damaged files.

mod calculix;
#[cfg(feature = "hdf5")]
mod converted;
mod damage;
mod decks;
mod examples;
mod gmsh;
mod hdf5;
#[cfg(feature = "hdf5")]
mod opened_by_vtk;
mod oracle;
mod vtk;

use std::path::{Path, PathBuf};

use supel::dofs::Nodes;
use supel::error::{Error, Result, Selector};
use supel::input::{Allowance, Faces, Patch, Patches, nodes, patch_faces};
use supel::job::ModelJob;
use tempfile::TempDir;

/// A folder with files of a test.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, content).expect("written");
        path
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn fixture(name: &str) -> PathBuf {
    root().join("fixtures").join(name)
}

fn read(path: &Path) -> Result<Nodes> {
    nodes(path, &Allowance::of(None))
}

fn read_text(name: &str, content: impl AsRef<[u8]>) -> Result<Nodes> {
    let folder = Folder::new();
    read(&folder.write(name, content))
}

fn refused(name: &str, content: impl AsRef<[u8]>) -> Error {
    match read_text(name, content) {
        Ok(nodes) => panic!("{name} was read: {nodes:?}"),
        Err(error) => error,
    }
}

/// Labels of the nodes of a group.
fn group(nodes: &Nodes, name: &str) -> Vec<i64> {
    let members = nodes.groups.get(name).unwrap_or_else(|| panic!("no group {name}: {:?}", nodes.groups.keys()));
    members.iter().map(|index| nodes.labels[*index]).collect()
}

/// The faces whose nodes are all in a group.
fn faces(path: &Path, name: &str) -> Result<Option<Faces>> {
    let nodes = read(path)?;
    let members = nodes.groups[name].clone();
    let patch = Patch { of: Selector::Interface(name.to_owned()), nodes: members };
    let patches = Patches { list: vec![patch], coordinates: &nodes.coordinates };
    let model = ModelJob { nodes: Some(path.to_owned()), ..ModelJob::default() };
    Ok(patch_faces(&model, &patches, &Allowance::of(None))?.pop().map(|faces| faces.faces))
}
