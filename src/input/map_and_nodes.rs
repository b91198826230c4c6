//! The dof map and the nodes of a model: what each row is, and where its node is.

use std::collections::BTreeMap;
use std::path::Path;

use super::allowance::Allowance;
use super::bulk_lines::digest_with_included;
use super::calculix::rebuilt;
use super::common_rows::RowLabels;
use super::format::{DirectionBase, ReadDofs, ReadNodes};
use super::mesh_cells::{MeshCells, mesh_cells};
use super::node_frames::NodeFrames;
use super::{InputNote, dof_map, formats};
use crate::dofs::{DofMap, Nodes};
use crate::error::{Error, Result};
use crate::job::ModelJob;
use crate::regular_file::unchanged;
use crate::sparse::MAX_ORDER;

/// Digests by the role of a file.
pub(super) type Digests = BTreeMap<&'static str, String>;

/// What each row is, and where the nodes are, as far as files of a job say it.
pub(super) struct MapAndNodes {
    pub(super) dofs: Option<DofMap>,
    pub(super) nodes: Option<Nodes>,
    /// The cells of the mesh that has these nodes, by their indices; none where it has none, and where CalculiX has made nodes of its own.
    pub(super) cells: Vec<MeshCells>,
    /// Axes that nodes have of their own, as the files say.
    pub(super) said: SaidFrames,
}

/// Axes of nodes as files say them that are read for something else.
pub(super) struct SaidFrames {
    /// By the decks of the dof map, of the nodes and of the matrices, of Nastran: the rows are along them. An error where one does not tell all of them.
    pub(super) by_decks: Vec<Result<Option<NodeFrames>>>,
    /// By the deck of the nodes: whether rows are along them depends on who writes the matrices.
    pub(super) by_nodes: Option<NodeFrames>,
}

/// Reads the dof map and the nodes of a model of n rows, and compares them. Where no map is given it is the one of the rows that the
/// matrices name, in the file that names them.
///
/// # Errors
/// A file that cannot be read or whose content is wrong, more data than `allowance` has room for; [`Error::DofCount`],
/// [`Error::DofRepeated`], [`Error::DofNodeMissing`] and [`Error::DofOrderUnknown`] where they do not fit together.
pub(super) fn map_and_nodes(
    model: &ModelJob,
    (n, named): (usize, Option<(&Path, DofMap)>),
    allowance: &Allowance,
    (digests, notes): (&mut Digests, &mut Vec<InputNote>),
) -> Result<MapAndNodes> {
    let mut said = SaidFrames { by_decks: Vec::new(), by_nodes: None };
    let nodes = match model.nodes.as_deref() {
        Some(path) => {
            let ReadNodes { nodes, frames, along_frames, .. } = read_nodes(path, allowance, digests)?;
            said.by_nodes = frames;
            said.by_decks.push(Ok(along_frames));
            Some(nodes)
        }
        None => None,
    };
    let mesh = model.nodes.as_deref().zip(nodes.as_ref());
    let cells = mesh.map_or(Ok(Vec::new()), |mesh| mesh_cells(mesh, allowance, notes))?;
    match (model.dofs.as_deref(), nodes, model.nodes.as_deref()) {
        (Some(path), nodes, nodes_path) => {
            let (read, of_map) =
                unchanged(path, || Ok((read_dofs(path, n, (allowance, notes))?, digest_with_included(path)?)))?;
            let dofs = read.dofs;
            said.by_decks.push(read.frames);
            digests.insert("dofs", of_map);
            let Some((nodes, nodes_path)) = nodes.zip(nodes_path) else {
                dof_map::check_repeated(path, &dofs)?;
                return Ok(MapAndNodes { dofs: Some(dofs), nodes: None, cells, said });
            };
            let (dofs, nodes, cells) = match rebuilt((path, &dofs), (nodes_path, &nodes), allowance)? {
                Some(rebuilt) => {
                    digests.insert("dofs_data", rebuilt.digest);
                    notes.extend(rebuilt.notes);
                    (rebuilt.dofs, rebuilt.nodes, Vec::new())
                }
                None => (dofs, nodes, cells),
            };
            dof_map::check_repeated(path, &dofs)?;
            compare(&dofs, path, (&nodes, nodes_path), notes)?;
            Ok(MapAndNodes { dofs: Some(dofs), nodes: Some(nodes), cells, said })
        }
        (None, nodes, nodes_path) if named.is_some() => {
            let (path, dofs) = named.unwrap_or((Path::new(""), DofMap::new()));
            notes.push(InputNote::RowsNamed { path: path.to_owned(), n });
            if let Some((nodes, nodes_path)) = nodes.as_ref().zip(nodes_path) {
                compare(&dofs, path, (nodes, nodes_path), notes)?;
            }
            Ok(MapAndNodes { dofs: Some(dofs), nodes, cells, said })
        }
        (None, Some(nodes), Some(path)) => {
            let dofs = dof_map::default_order(&nodes, path, n)?;
            let dofs_per_node = n / nodes.labels.len();
            notes.push(InputNote::DefaultOrder { dofs_per_node, nodes: path.to_owned() });
            Ok(MapAndNodes { dofs: Some(dofs), nodes: Some(nodes), cells, said })
        }
        (None, nodes, _) => Ok(MapAndNodes { dofs: None, nodes, cells, said }),
    }
}

/// Makes sure that every node of a dof map has a position.
fn compare(dofs: &DofMap, path: &Path, (nodes, nodes_path): (&Nodes, &Path), notes: &mut Vec<InputNote>) -> Result<()> {
    let count = dof_map::check_nodes(dofs, path, nodes, nodes_path)?;
    if count > 0 {
        notes.push(InputNote::UnusedNodes { path: nodes_path.to_owned(), count });
    }
    Ok(())
}

/// The nodes of a mesh or a table, in whatever format that is read.
///
/// # Errors
/// A file that cannot be read or whose content is wrong, more data than `allowance` has room for.
pub fn nodes(path: &Path, allowance: &Allowance) -> Result<Nodes> {
    read_nodes(path, allowance, &mut Digests::new()).map(|read| read.nodes)
}

fn read_nodes(path: &Path, allowance: &Allowance, digests: &mut Digests) -> Result<ReadNodes> {
    let (mut read, of_nodes) =
        unchanged(path, || Ok((formats::of_nodes(path)?.read(path, allowance)?, digest_with_included(path)?)))?;
    digests.extend(read.data_digest.take().map(|digest| ("nodes_data", digest)));
    digests.insert("nodes", of_nodes);
    refuse_out_of_range(path, &read.nodes)?;
    Ok(read)
}

/// Refuses coordinates with which moments of inertia, and what is squared of them, would leave the range of double precision.
fn refuse_out_of_range(path: &Path, nodes: &Nodes) -> Result<()> {
    /// Four factors of so many bits leave room for stiffness and mass.
    const BITS: u32 = 160;
    let sizes = nodes
        .coordinates
        .iter()
        .enumerate()
        .flat_map(|(node, point)| (0..3).map(move |axis| (node, axis, point[axis])));
    let Some((node, axis, value)) = sizes.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())) else { return Ok(()) };
    let range = f64::from(BITS).exp2().recip()..=f64::from(BITS).exp2();
    if value == 0.0 || range.contains(&value.abs()) {
        return Ok(());
    }
    Err(Error::NodeRange { path: path.to_owned(), node: nodes.labels[node], axis, value, bits: BITS })
}

/// The dof map in which rows that a matrix names are looked up: each label is that of one row.
///
/// # Errors
/// A file that cannot be read or whose content is wrong; [`Error::DofRepeated`].
pub(super) fn dof_map_for_labels(path: &Path, allowance: &Allowance) -> Result<(DofMap, RowLabels)> {
    let ReadDofs { dofs, scalars, .. } = formats::of_dof_map(path)?.read(path, MAX_ORDER, allowance)?;
    dof_map::check_repeated(path, &dofs)?;
    let labels = RowLabels::of_map(&dofs).with_scalars(path, &scalars)?;
    Ok((dofs, labels))
}

fn read_dofs(path: &Path, n: usize, (allowance, notes): (&Allowance, &mut Vec<InputNote>)) -> Result<ReadDofs> {
    let read = formats::of_dof_map(path)?.read(path, n, allowance)?;
    if read.n_rows != n {
        return Err(Error::DofCount { path: path.to_owned(), found: read.n_rows, n });
    }
    if read.base == DirectionBase::Zero {
        notes.push(InputNote::DirectionsFromZero { path: path.to_owned() });
    }
    Ok(read)
}
