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
/// The errors of the HDF5 library.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_share_the_cells_and_have_places_of_their_own() {
        let mesh = HexMesh::structured([2, 1, 1], |x| x, |_| true);
        let frame = |time: f64| Frame {
            time,
            places: mesh.nodes.iter().map(|x| [x[0] + time, x[1], x[2]]).collect(),
            deformations: vec![time; mesh.nodes.len()],
        };
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("swing.vtkhdf");
        write(&path, &mesh, &[frame(0.0), frame(0.5)]).expect("written");

        let file = File::open(&path).expect("HDF5");
        let numbers = |name: &str| file.dataset(name).and_then(|set| set.read_raw::<i64>()).expect("a list");
        let values = |name: &str| file.dataset(name).and_then(|set| set.read_raw::<f64>()).expect("a list");
        assert_eq!(numbers("VTKHDF/Offsets"), [0, 8, 16]);
        assert_eq!(numbers("VTKHDF/Connectivity").len(), 16);
        assert_eq!(numbers("VTKHDF/Steps/CellOffsets"), [0, 0]);
        let points = values("VTKHDF/Points");
        assert_eq!(points.len(), 2 * 12 * 3);
        for (name, of_step) in [("PointOffsets", 12), ("PointDataOffsets/deformation", 12), ("PartOffsets", 0)] {
            assert_eq!(numbers(&format!("VTKHDF/Steps/{name}")), [0, of_step], "{name}");
        }
        // The second step begins where the offset says: its first node has moved by half.
        assert_eq!(points[3 * 12], points[0] + 0.5);
        assert_eq!(values("VTKHDF/Steps/Values"), [0.0, 0.5]);
        assert_eq!(values("VTKHDF/PointData/deformation")[12], 0.5);
    }
}
