//! A moving solid as a VTKHDF file, which ParaView opens and plays: one mesh, places of the nodes at every instant.

use std::path::Path;

use hdf5_metno::types::FixedAscii;
use hdf5_metno::{File, Group, H5Type, Result};
use supel_models::HexMesh;

use crate::film::Frame;

/// VTK's number of an eight-node hexahedron.
const HEXAHEDRON: u8 = 12;

/// Writes the frames of a solid with the length of the deformation at every node.
///
/// # Errors
/// Those of the HDF5 library.
pub fn write(path: &Path, mesh: &HexMesh, frames: &[Frame]) -> Result<()> {
    let (n_nodes, n_cells, n_steps) = (mesh.nodes.len() as i64, mesh.elements.len() as i64, frames.len());
    let root = File::create(path)?.create_group("VTKHDF")?;
    root.new_attr::<i64>().shape(2).create("Version")?.write(&[2_i64, 0])?;
    let kind = FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|error| error.to_string())?;
    root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;

    for (name, count) in
        [("NumberOfPoints", n_nodes), ("NumberOfCells", n_cells), ("NumberOfConnectivityIds", 8 * n_cells)]
    {
        list(&root, name, &vec![count; n_steps])?;
    }
    let places: Vec<[f64; 3]> = frames.iter().flat_map(|frame| frame.places.iter().copied()).collect();
    let table = root.new_dataset::<f64>().shape((places.len(), 3)).create("Points")?;
    table.write_raw(places.as_flattened())?;
    list(&root, "Connectivity", &mesh.elements.iter().flatten().map(|node| i64::from(*node)).collect::<Vec<_>>())?;
    list(&root, "Offsets", &(0..=n_cells).map(|cell| 8 * cell).collect::<Vec<_>>())?;
    list(&root, "Types", &vec![HEXAHEDRON; mesh.elements.len()])?;
    let deformations: Vec<f64> = frames.iter().flat_map(|frame| frame.deformations.iter().copied()).collect();
    list(&root.create_group("PointData")?, "deformation", &deformations)?;
    steps(&root, frames, n_nodes)
}

/// Where the data of each step begin: the cells are the same for all.
fn steps(root: &Group, frames: &[Frame], n_nodes: i64) -> Result<()> {
    let steps = root.create_group("Steps")?;
    steps.new_attr::<i64>().create("NSteps")?.write_scalar(&(frames.len() as i64))?;
    list(&steps, "Values", &frames.iter().map(|frame| frame.time).collect::<Vec<_>>())?;
    let (none, one) = (vec![0_i64; frames.len()], vec![1_i64; frames.len()]);
    let of_nodes: Vec<i64> = (0..frames.len() as i64).map(|step| step * n_nodes).collect();
    list(&steps, "NumberOfParts", &one)?;
    list(&steps, "PartOffsets", &none)?;
    list(&steps, "PointOffsets", &of_nodes)?;
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        steps.new_dataset::<i64>().shape((frames.len(), 1)).create(name)?.write_raw(&none)?;
    }
    list(&steps.create_group("PointDataOffsets")?, "deformation", &of_nodes)
}

fn list<T: H5Type>(group: &Group, name: &str, values: &[T]) -> Result<()> {
    group.new_dataset::<T>().shape(values.len()).create(name)?.write_raw(values)
}
