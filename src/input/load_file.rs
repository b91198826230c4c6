//! Loads: Matrix Market files of as many rows as the matrices have, one column for each load, or the load vectors of a superelement.

use std::collections::BTreeMap;
use std::path::Path;

use super::allowance::Allowance;
use super::file_start::FileStart;
use super::rectangular::{Content, RectangularFile};
use super::superelement_file;
use crate::error::{Error, Result};
use crate::regular_file::unchanged;

/// One column of a file of loads.
#[derive(Clone, Debug)]
pub struct LoadColumn {
    /// A force for every row of the files, in the units of the file.
    pub values: Vec<f64>,
    /// BLAKE3 digest of the file's bytes, lower-case hexadecimal.
    pub digest: String,
}

/// Which columns of a file are wanted, and how many rows it has to have.
#[derive(Clone, Copy, Debug)]
pub struct WantedColumns<'a> {
    /// The file.
    pub path: &'a Path,
    /// The columns.
    pub columns: &'a [WantedColumn<'a>],
    /// Rows of the matrices as they are in their files.
    pub n_rows: usize,
}

/// Which column is wanted, and by whom.
#[derive(Clone, Copy, Debug)]
pub struct WantedColumn<'a> {
    /// Name of the load.
    pub load: &'a str,
    /// Column from zero; the only one where absent.
    pub column: Option<usize>,
}

/// Reads columns of a file of loads, plain or gzipped, in one pass: one for each that is wanted, in their order.
///
/// # Errors
/// A file that cannot be read or is neither a Matrix Market file of loads nor a superelement; [`Error::LoadRows`] and [`Error::LoadColumn`] where it has another size;
/// [`Error::Changed`] where it is written meanwhile; [`Error::MemoryRead`] for a superelement that `allowance` has no room for.
pub fn columns_of_file(wanted: WantedColumns<'_>, allowance: &Allowance) -> Result<Vec<LoadColumn>> {
    unchanged(wanted.path, || read(wanted, allowance))
}

fn read(wanted: WantedColumns<'_>, allowance: &Allowance) -> Result<Vec<LoadColumn>> {
    if superelement_file::begins(&FileStart::of(wanted.path)?) {
        return of_superelement(wanted, allowance);
    }
    let load = wanted.columns.first().map_or("", |column| column.load);
    let file = RectangularFile::open(wanted.path, Content::Load { load, n_rows: wanted.n_rows })?;
    let mut places: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for (at, column) in wanted.columns.iter().enumerate() {
        places.entry(column_of(file.n_columns, wanted.path, *column)?).or_default().push(at);
    }
    let mut values = vec![vec![0.0; wanted.n_rows]; wanted.columns.len()];
    let digest = file.read(|entry| {
        for at in places.get(&entry.column).into_iter().flatten() {
            values[*at][entry.row] += entry.value;
        }
        Ok(())
    })?;
    Ok(values.into_iter().map(|values| LoadColumn { values, digest: digest.clone() }).collect())
}

/// Load vectors that a superelement has.
fn of_superelement(wanted: WantedColumns<'_>, allowance: &Allowance) -> Result<Vec<LoadColumn>> {
    let loads = superelement_file::load_vectors(wanted.path, allowance)?;
    let n_rows = loads.columns.rows();
    let of_column = |column: &WantedColumn<'_>| {
        let at = column_of(loads.columns.cols() as u64, wanted.path, *column)? as usize;
        if n_rows != wanted.n_rows {
            let (path, load) = (wanted.path.to_owned(), column.load.to_owned());
            return Err(Error::LoadRows { path, load, found: n_rows as u64, n: wanted.n_rows });
        }
        let values = (0..n_rows).map(|row| loads.columns[(row, at)]).collect();
        Ok(LoadColumn { values, digest: loads.digest.clone() })
    };
    wanted.columns.iter().map(of_column).collect()
}

/// The column that is wanted, from zero.
fn column_of(n_columns: u64, path: &Path, wanted: WantedColumn<'_>) -> Result<u64> {
    let column = match (wanted.column, n_columns) {
        (None, 1) => Some(0),
        (None, _) => None,
        (Some(column), n_columns) => Some(column as u64).filter(|column| *column < n_columns),
    };
    column.ok_or_else(|| Error::LoadColumn {
        path: path.to_owned(),
        load: wanted.load.to_owned(),
        asked: wanted.column,
        n_columns,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One pass gives every load its own column, in the order of the loads, and one column to as many as want it.
    #[test]
    fn columns_of_one_file_go_to_their_loads() {
        let folder = tempfile::tempdir().expect("a folder");
        let banner = "%%MatrixMarket matrix";
        for text in [
            format!("{banner} array real general\n2 3\n1\n2\n3\n4\n5\n6\n"),
            format!("{banner} coordinate real general\n2 3 6\n2 3 6\n1 1 1\n1 3 5\n2 1 2\n2 2 4\n1 2 3\n"),
        ] {
            let path = folder.path().join("loads.mtx");
            std::fs::write(&path, text).expect("written");
            let wanted = |column| WantedColumn { load: "push", column: Some(column) };
            let read = |columns: &[WantedColumn<'_>]| {
                columns_of_file(WantedColumns { path: &path, columns, n_rows: 2 }, &Allowance::of(None))
            };
            let columns = read(&[wanted(2), wanted(0), wanted(2)]).expect("three loads");
            let values: Vec<&[f64]> = columns.iter().map(|column| &column.values[..]).collect();
            assert_eq!(values, [[5.0, 6.0], [1.0, 2.0], [5.0, 6.0]]);
            assert!(columns.iter().all(|column| column.digest == columns[0].digest && column.digest.len() == 64));
            let refused = read(&[wanted(2), wanted(3)]).expect_err("three columns");
            assert_eq!(refused.code(), "E-LOAD-COLUMN");
        }
    }
}
