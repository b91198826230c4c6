//! Nodes as the reader of a format leaves them.

use std::collections::BTreeMap;
use std::path::Path;

use super::dataset::Dataset;
use crate::dofs::Nodes;
use crate::error::{Error, Result};
use crate::number::counted;

/// Nodes as a format's reader leaves them.
pub(super) struct Mesh {
    /// Labels if the format has them, with the dataset they come from.
    pub(super) labels: Option<(Vec<i64>, String)>,
    pub(super) coordinates: Vec<[f64; 3]>,
    /// Where the coordinates come from.
    pub(super) source: String,
    pub(super) groups: BTreeMap<String, Vec<usize>>,
}

impl Mesh {
    /// A mesh without labels and groups.
    pub(super) fn of_points(coordinates: Vec<[f64; 3]>, source: String) -> Self {
        Self { labels: None, coordinates, source, groups: BTreeMap::new() }
    }

    /// Checks what every format has in common.
    pub(super) fn into_nodes(self, path: &Path) -> Result<Nodes> {
        let n_nodes = self.coordinates.len();
        let (labels, label_source) =
            self.labels.unwrap_or_else(|| ((1..=n_nodes as i64).collect(), self.source.clone()));
        if n_nodes == 0 || labels.len() != n_nodes {
            let found =
                format!("{} and {}", counted(n_nodes, "node", "nodes"), counted(labels.len(), "label", "labels"));
            let expected = "a label for each of one or more nodes".to_owned();
            return Err(Error::Hdf5Shape { path: path.to_owned(), object: label_source, found, expected });
        }
        let mut sorted = labels.clone();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Error::MeshLabelTwice { path: path.to_owned(), object: label_source, label: pair[0] });
        }
        for (point, &label) in self.coordinates.iter().zip(&labels) {
            if let Some(axis) = point.iter().position(|x| !x.is_finite()) {
                let (path, object) = (path.to_owned(), self.source);
                return Err(Error::MeshNotFinite { path, object, label, axis, value: point[axis] });
            }
        }
        Ok(Nodes { labels, coordinates: self.coordinates, groups: self.groups })
    }
}

/// Points from a dataset of `n × 1`, `n × 2` or `n × 3` numbers.
pub(super) fn points_of_rows(dataset: &Dataset<'_>) -> Result<Vec<[f64; 3]>> {
    let shape = dataset.shape()?;
    match shape.as_slice() {
        &[_, n_axes @ 1..=3] => Ok(points(&dataset.reals()?.values, n_axes)),
        other => Err(dataset.wrong_shape(format!("shape {other:?}"), "shape [n, 1], [n, 2] or [n, 3]".to_owned())),
    }
}

/// Points from numbers in which those of one node are neighbours; axes that are missing are zero.
pub(super) fn points(values: &[f64], n_axes: usize) -> Vec<[f64; 3]> {
    values.chunks_exact(n_axes).map(|p| std::array::from_fn(|axis| p.get(axis).copied().unwrap_or(0.0))).collect()
}
