//! Nastran OUTPUT4 in binary, `FORM=UNFORMATTED`: records of Fortran, words of four bytes, little-endian, dense columns.
//!
//! ```text
//! 24 | columns rows form type NAME | 24                       four words and eight characters
//! 12 + 8 n | column  first-row  2 n  values | 12 + 8 n        n values, two words each
//! 20 | columns + 1   1   2  value | 20                        after the last column
//! ```

use supel_runtime::Superelement;

use super::format::{ExportedFile, Format};
use super::names::Names;
use super::op4_content::{LAST, Named, REAL_DOUBLE, content, matrices};
use crate::error::Result;

/// OUTPUT4 in binary.
#[derive(Debug)]
pub(super) struct Op4Binary;

impl Format for Op4Binary {
    fn name(&self) -> &'static str {
        "op4-binary"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["op4"]
    }

    fn files(&self, superelement: &Superelement, _: &Names) -> Result<Vec<ExportedFile>> {
        let matrices = matrices(superelement)?;
        let bytes = matrices.iter().flat_map(bytes).collect();
        Ok(vec![ExportedFile { ending: "op4", content: content(&matrices), bytes }])
    }
}

fn bytes(named: &Named) -> Vec<u8> {
    let Named { name, form, matrix } = named;
    let columns = matrix.cols();
    let mut head = words(&[columns, matrix.rows(), *form as usize, REAL_DOUBLE]);
    head.extend(format!("{name:8}").into_bytes());
    let mut bytes = record(head);
    for (column, first, values) in named.columns() {
        bytes.extend(column_record([column, first], &values));
    }
    bytes.extend(column_record([columns + 1, 1], &[LAST]));
    bytes
}

fn column_record([column, first]: [usize; 2], values: &[f64]) -> Vec<u8> {
    let mut content = words(&[column, first, 2 * values.len()]);
    content.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    record(content)
}

/// Content between its lengths.
fn record(content: Vec<u8>) -> Vec<u8> {
    let length = words(&[content.len()]);
    [length.clone(), content, length].concat()
}

/// Whole numbers as words. A dense matrix whose sizes are none does not fit into memory.
fn words(numbers: &[usize]) -> Vec<u8> {
    numbers.iter().flat_map(|number| (*number as u32).to_le_bytes()).collect()
}
