//! A series of states on one grid as a VTKHDF file, which ParaView opens and plays.
//!
//! The layout is `UnstructuredGrid` of version 2.0 with the group `Steps`: the cells are the same for all states, the points
//! are those of the last state that gave some. Values are appended state by state, so that their number needs no memory.

use std::path::{Path, PathBuf};

use hdf5_metno::types::FixedAscii;
use hdf5_metno::{Dataset, DatasetBuilderEmpty, File, Group, H5Type};

use super::vtk_grid::{Cells, Field, Values};
use crate::error::{Error, Result};

/// Values of a dataset that are stored in one piece.
const CHUNK: usize = 1 << 12;

/// A file that grows state by state.
pub struct Series {
    path: PathBuf,
    file: File,
    root: Group,
    n_points: usize,
    n_cells: usize,
    n_ids: usize,
    /// Blocks of points so far.
    n_blocks: usize,
    points: Dataset,
    fields: Vec<(Field, Dataset)>,
    times: Vec<f64>,
    /// For each state the first of its points.
    first_points: Vec<i64>,
}

impl Series {
    /// A file without a state, with these cells on `n_points` points and the fields that each state will give.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn create(path: &Path, n_points: usize, cells: &Cells, fields: &[Field]) -> Result<Self> {
        hdf5_metno::silence_errors(true);
        Self::begun(path, n_points, cells, fields).map_err(|error| failed(path, &error))
    }

    /// Appends a state: its time, its points where they are not those of the state before, and its values field by field.
    ///
    /// # Errors
    /// [`Error::Write`].
    ///
    /// # Panics
    /// Where the first state has no points.
    pub fn push(&mut self, time: f64, points: Option<&[[f64; 3]]>, values: &[Values<'_>]) -> Result<()> {
        assert!(points.is_some() || self.n_blocks > 0, "the first state has points");
        self.pushed(time, points, values).map_err(|error| failed(&self.path, &error))
    }

    /// Writes where the values of each state begin, and closes the file.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(self) -> Result<()> {
        self.ended().map_err(|error| failed(&self.path, &error))
    }

    fn begun(path: &Path, n_points: usize, cells: &Cells, fields: &[Field]) -> hdf5_metno::Result<Self> {
        let file = File::create(path)?;
        let root = file.create_group("VTKHDF")?;
        root.new_attr::<i64>().shape(2).create("Version")?.write(&[2_i64, 0])?;
        let kind = FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|error| error.to_string())?;
        root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;
        list(&root, "Connectivity", &cells.connectivity)?;
        list(&root, "Offsets", &cells.offsets)?;
        list(&root, "Types", &cells.types)?;
        let points = growing(&root, "Points", 3)?;
        let data = root.create_group("PointData")?;
        let grown = |field: &Field| Ok((*field, growing(&data, field.name, field.n_components)?));
        let fields = fields.iter().map(grown).collect::<hdf5_metno::Result<_>>()?;
        let (path, n_cells, n_ids) = (path.to_owned(), cells.types.len(), cells.connectivity.len());
        let (times, first_points) = (Vec::new(), Vec::new());
        Ok(Self { path, file, root, n_points, n_cells, n_ids, n_blocks: 0, points, fields, times, first_points })
    }

    fn pushed(&mut self, time: f64, points: Option<&[[f64; 3]]>, values: &[Values<'_>]) -> hdf5_metno::Result<()> {
        if let Some(points) = points {
            append(&self.points, Values::Vectors(points))?;
            self.n_blocks += 1;
        }
        self.first_points.push(((self.n_blocks - 1) * self.n_points) as i64);
        self.times.push(time);
        self.fields.iter().zip(values).try_for_each(|((_, set), values)| append(set, *values))
    }

    fn ended(&self) -> hdf5_metno::Result<()> {
        let n_steps = self.times.len();
        let counts = [
            ("NumberOfPoints", self.n_points),
            ("NumberOfCells", self.n_cells),
            ("NumberOfConnectivityIds", self.n_ids),
        ];
        for (name, count) in counts {
            list(&self.root, name, &vec![count as i64; n_steps])?;
        }
        let steps = self.root.create_group("Steps")?;
        steps.new_attr::<i64>().create("NSteps")?.write_scalar(&(n_steps as i64))?;
        list(&steps, "Values", &self.times)?;
        list(&steps, "NumberOfParts", &vec![1_i64; n_steps])?;
        let none = vec![0_i64; n_steps];
        list(&steps, "PartOffsets", &none)?;
        list(&steps, "PointOffsets", &self.first_points)?;
        for name in ["CellOffsets", "ConnectivityIdOffsets"] {
            timeless::<i64>(&steps).shape((n_steps, 1)).create(name)?.write_raw(&none)?;
        }
        let offsets = steps.create_group("PointDataOffsets")?;
        let of_state: Vec<i64> = (0..n_steps).map(|step| (step * self.n_points) as i64).collect();
        self.fields.iter().try_for_each(|(field, _)| list(&offsets, field.name, &of_state))?;
        self.file.flush()
    }
}

/// A dataset of which no time of writing is kept: the same values make the same bytes.
fn timeless<T: H5Type>(group: &Group) -> DatasetBuilderEmpty {
    group.new_dataset::<T>().with_dcpl(|plist| plist.obj_track_times(false))
}

fn list<T: H5Type>(group: &Group, name: &str, values: &[T]) -> hdf5_metno::Result<()> {
    timeless::<T>(group).shape(values.len()).create(name)?.write_raw(values)
}

/// A dataset without values yet, a row for each point and state; scalars are a list.
fn growing(group: &Group, name: &str, n_components: usize) -> hdf5_metno::Result<Dataset> {
    match n_components {
        1 => timeless::<f64>(group).chunk(CHUNK).shape(0..).create(name),
        n => timeless::<f64>(group).chunk((CHUNK, n)).shape((0.., n)).create(name),
    }
}

fn append(set: &Dataset, values: Values<'_>) -> hdf5_metno::Result<()> {
    let start = set.shape()[0];
    match values {
        Values::Scalars(values) => {
            let end = start + values.len();
            set.resize(end)?;
            set.write_slice(values, start..end)
        }
        Values::Vectors(values) => {
            let end = start + values.len();
            set.resize((end, 3))?;
            (0..3).try_for_each(|axis| {
                let column: Vec<f64> = values.iter().map(|value| value[axis]).collect();
                set.write_slice(column.as_slice(), (start..end, axis))
            })
        }
    }
}

fn failed(path: &Path, error: &hdf5_metno::Error) -> Error {
    Error::Write { path: path.to_owned(), source: std::io::Error::other(error.to_string()) }
}
