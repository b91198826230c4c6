//! A moving solid as a VTKHDF file, which ParaView opens and plays: one mesh, places of the nodes at every instant.

use std::path::Path;

use supel::error::Result;
use supel::recovery::{Cells, Field, Series, Values};
use supel_models::HexMesh;

use crate::film::Frame;

/// VTK's number of an eight-node hexahedron.
const HEXAHEDRON: u8 = 12;

/// Writes the frames of a solid with the length of the deformation at every node.
///
/// # Errors
/// The errors of [`Series`].
pub fn write(path: &Path, mesh: &HexMesh, frames: &[Frame]) -> Result<()> {
    let cells = Cells {
        connectivity: mesh.elements.iter().flatten().map(|node| i64::from(*node)).collect(),
        offsets: (0..=mesh.elements.len() as i64).map(|cell| 8 * cell).collect(),
        types: vec![HEXAHEDRON; mesh.elements.len()],
    };
    let deformation = Field { name: "deformation", n_components: 1 };
    let mut series = Series::create(path, mesh.nodes.len(), &cells, &[deformation])?;
    for Frame { time, places, deformations } in frames {
        series.push(*time, Some(places), &[Values::Scalars(deformations)])?;
    }
    series.finish()
}

#[cfg(test)]
mod tests {
    use hdf5_metno::File;

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
