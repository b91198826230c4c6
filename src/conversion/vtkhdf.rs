//! A mesh as a VTKHDF file: an `UnstructuredGrid` of version 2.0 in one part, which ParaView opens.
//!
//! Points have their labels in `node`, and for each group an array of its name that is one at its members and zero elsewhere. Points that no
//! cell has get a vertex, so that they are seen. An attribute says that arrays mean this, so that the file is read again as what was written.

use std::path::Path;

use supel_runtime::StagedWriter;

#[cfg(not(feature = "hdf5"))]
use crate::error::Error;
use crate::error::Result;
use crate::input::MeshInput;

/// Writes a mesh into the file that `out` is, with the HDF5 library.
///
/// # Errors
/// [`crate::error::Error::Write`]; [`crate::error::Error::FeatureMissing`] in a program without HDF5.
#[cfg(feature = "hdf5")]
pub fn write_mesh(mesh: &MeshInput, path: &Path, out: &StagedWriter) -> Result<()> {
    use crate::error::Error;

    crate::input::start_hdf5()?;
    library::write(out.path(), mesh).map_err(|error| {
        let source = std::io::Error::other(error);
        Error::Write { path: path.to_owned(), source }
    })
}

#[cfg(not(feature = "hdf5"))]
/// Nothing: the program is built without the library.
///
/// # Errors
/// [`Error::FeatureMissing`].
pub fn write_mesh(_: &MeshInput, path: &Path, _: &StagedWriter) -> Result<()> {
    Err(Error::FeatureMissing { path: path.to_owned(), feature: "hdf5" })
}

#[cfg(feature = "hdf5")]
mod library {
    use std::collections::BTreeSet;
    use std::path::Path;

    use hdf5_metno::types::FixedAscii;
    use hdf5_metno::{DatasetBuilderEmpty, File, Group, H5Type, Result};

    use crate::input::MeshInput;
    use crate::input::hdf5::{GROUP_NAME, LABELS, MESH_OF_SUPEL};

    /// The longest name of a group that is kept where its array has another one.
    const MAX_NAME: usize = 4096;
    /// VTK's number of a vertex.
    const VERTEX: u8 = 1;

    pub(super) fn write(path: &Path, mesh: &MeshInput) -> Result<()> {
        let file = File::create(path)?;
        let root = file.create_group("VTKHDF")?;
        root.new_attr::<i64>().shape(2).create("Version")?.write(&[2_i64, 0])?;
        let kind = FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|error| error.to_string())?;
        root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;
        root.new_attr::<i64>().create(MESH_OF_SUPEL)?.write_scalar(&1_i64)?;
        let Grid { connectivity, offsets, types } = Grid::of(mesh);
        let n_points = mesh.nodes.coordinates.len();
        let counts = [
            ("NumberOfPoints", n_points),
            ("NumberOfCells", types.len()),
            ("NumberOfConnectivityIds", connectivity.len()),
        ];
        for (name, count) in counts {
            list(&root, name, &[count as i64])?;
        }
        let points: Vec<f64> = mesh.nodes.coordinates.iter().flatten().copied().collect();
        timeless::<f64>(&root).shape((n_points, 3)).create("Points")?.write_raw(&points)?;
        list(&root, "Connectivity", &connectivity)?;
        list(&root, "Offsets", &offsets)?;
        list(&root, "Types", &types)?;
        let data = root.create_group("PointData")?;
        list(&data, LABELS, &mesh.nodes.labels)?;
        let mut used = BTreeSet::from([LABELS.to_owned()]);
        for (name, members) in &mesh.nodes.groups {
            let mut is_member = vec![0_i8; n_points];
            members.iter().for_each(|node| is_member[*node] = 1);
            let array = array_name(name, &mut used);
            list(&data, &array, &is_member)?;
            if array != *name && (1..=MAX_NAME).contains(&name.len()) {
                let attribute = data.dataset(&array)?.new_attr::<u8>().shape(name.len()).create(GROUP_NAME)?;
                attribute.write(name.as_bytes())?;
            }
        }
        file.flush()
    }

    /// The name of an array of a group: a name in HDF5 has no slash and is no dot, and no two arrays have one name.
    fn array_name(group: &str, used: &mut BTreeSet<String>) -> String {
        let plain: String = group.chars().map(|c| if matches!(c, '/' | '\0') { '_' } else { c }).collect();
        let plain = if plain.chars().all(|c| c == '.') { format!("_{plain}") } else { plain };
        let numbered = (2..).map(|number| format!("{plain} ({number})"));
        let free = std::iter::once(plain.clone()).chain(numbered).find(|name| !used.contains(name)).unwrap_or_default();
        used.insert(free.clone());
        free
    }

    /// The cells of a mesh, and a vertex at each point that none of them has.
    struct Grid {
        connectivity: Vec<i64>,
        offsets: Vec<i64>,
        types: Vec<u8>,
    }

    impl Grid {
        fn of(mesh: &MeshInput) -> Self {
            let mut grid = Self { connectivity: Vec::new(), offsets: vec![0], types: Vec::new() };
            let mut is_alone = vec![true; mesh.nodes.coordinates.len()];
            for cells in &mesh.cells {
                for nodes in cells.nodes.chunks_exact(cells.n_nodes) {
                    nodes.iter().for_each(|node| is_alone[*node as usize] = false);
                    grid.push(cells.number, nodes.iter().map(|node| i64::from(*node)));
                }
            }
            for point in (0..is_alone.len()).filter(|point| is_alone[*point]) {
                grid.push(VERTEX, [point as i64]);
            }
            grid
        }

        fn push(&mut self, number: u8, nodes: impl IntoIterator<Item = i64>) {
            self.connectivity.extend(nodes);
            self.offsets.push(self.connectivity.len() as i64);
            self.types.push(number);
        }
    }

    /// An array without the time of its making, so that the bytes are those of any day.
    fn timeless<T: H5Type>(group: &Group) -> DatasetBuilderEmpty {
        group.new_dataset::<T>().with_dcpl(|plist| plist.obj_track_times(false))
    }

    fn list<T: H5Type>(group: &Group, name: &str, values: &[T]) -> Result<()> {
        timeless::<T>(group).shape(values.len()).create(name)?.write_raw(values)
    }
}
