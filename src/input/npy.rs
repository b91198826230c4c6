//! Arrays of NumPy: the format of `numpy.save`, versions 1 to 3, real numbers in double precision.
//!
//! ```text
//! 6 bytes   \x93NUMPY
//! 2 bytes   version
//! 2 or 4    length of the header, little-endian, 4 from version 2 on
//! header    {'descr': '<f8', 'fortran_order': False, 'shape': (120, 4), }
//! numbers   as many as the shape says, and nothing behind them
//! ```

use std::io::Read;
use std::path::Path;

use super::allowance::Claim;
use super::mode_matrix::{NUMBER, Order, checked_count, columns_of, refuse_not_finite};
use crate::error::{Error, Result};
use crate::regular_file;

const MAGIC: &[u8] = b"\x93NUMPY";
/// Magic and version.
const PREFIX: usize = 8;
/// The longest header: one of two numbers takes less than a hundred bytes.
const MAX_HEADER: usize = 1 << 12;
const EXPECTED: &str = "a NumPy array of float64, little-endian, of one or two dimensions, as numpy.save writes it";

/// Whether a file begins as an array of NumPy does.
pub(super) fn is_array(head: &[u8]) -> bool {
    head.starts_with(MAGIC)
}

/// The columns of an array of two dimensions; of one dimension, the only one.
///
/// # Errors
/// [`Error::ModesFormat`] for what is no such array, [`Error::ModesRows`] and [`Error::ModesColumns`] for another size,
/// [`Error::MemoryRead`]; those of reading the file.
pub(super) fn columns(path: &Path, n_rows: usize, claim: &Claim<'_>) -> Result<Vec<Vec<f64>>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let wrong = |found: String| Error::ModesFormat { path: path.to_owned(), line: None, found, expected: EXPECTED };
    let mut file = regular_file::open(path)?;
    let n_bytes = file.metadata().map_err(failed)?.len();
    let mut head = Vec::new();
    file.by_ref().take((PREFIX + 4 + MAX_HEADER) as u64).read_to_end(&mut head).map_err(failed)?;
    let (start, header) = header(&head).ok_or_else(|| wrong("a header cut short or too long".to_owned()))?;
    let Header { shape: [rows, n_columns], order } = Header::of(header).map_err(wrong)?;
    if rows != n_rows as u64 {
        return Err(Error::ModesRows { path: path.to_owned(), found: rows, n: n_rows });
    }
    let n_columns = checked_count(path, n_columns, n_rows)?;
    let promised = (n_rows as u64).checked_mul(n_columns as u64).and_then(|n| n.checked_mul(NUMBER));
    let there = n_bytes.saturating_sub(start as u64);
    if promised != Some(there) {
        return Err(wrong(format!("{there} bytes behind the header of {n_rows} × {n_columns} numbers")));
    }
    // The numbers as they are read and in columns.
    claim.add(there.saturating_mul(2))?;
    let mut bytes = head.split_off(start);
    file.take(there - bytes.len() as u64).read_to_end(&mut bytes).map_err(failed)?;
    let (numbers, _) = bytes.as_chunks::<8>();
    let values: Vec<f64> = numbers.iter().map(|number| f64::from_le_bytes(*number)).collect();
    if values.len() as u64 * NUMBER != there {
        return Err(Error::Changed { path: path.to_owned() });
    }
    let columns = columns_of(&values, [n_rows, n_columns], order);
    refuse_not_finite(path, &columns)?;
    Ok(columns)
}

/// Where the numbers begin, and the header before them.
fn header(head: &[u8]) -> Option<(usize, &str)> {
    let (first, length) = match head.get(PREFIX - 2)? {
        1 => (PREFIX + 2, usize::from(u16::from_le_bytes(*head.get(PREFIX..)?.first_chunk()?))),
        2 | 3 => (PREFIX + 4, usize::try_from(u32::from_le_bytes(*head.get(PREFIX..)?.first_chunk()?)).ok()?),
        _ => return None,
    };
    let end = first.checked_add(length)?;
    Some((end, std::str::from_utf8(head.get(first..end)?).ok()?))
}

/// What a header says.
struct Header {
    shape: [u64; 2],
    order: Order,
}

impl Header {
    /// Reads the three keys of a header; the error is what was found.
    fn of(text: &str) -> std::result::Result<Self, String> {
        let quoted = || format!("the header `{}`", text.trim());
        let inside = text.trim().strip_prefix('{').and_then(|text| text.strip_suffix('}')).ok_or_else(quoted)?;
        let value = |key: &str| {
            let (_, rest) = inside.split_once(&format!("'{key}':"))?;
            let rest = rest.trim_start();
            let end = if rest.starts_with('(') { rest.find(')')? + 1 } else { rest.find(',').unwrap_or(rest.len()) };
            Some(rest[..end].trim())
        };
        let [descr, order, shape] = ["descr", "fortran_order", "shape"].map(value);
        if descr != Some("'<f8'") {
            return Err(format!("numbers of type {}", descr.unwrap_or("unknown")));
        }
        let order = match order {
            Some("True") => Order::ByColumns,
            Some("False") => Order::ByRows,
            _ => return Err(quoted()),
        };
        let sizes = shape.and_then(|shape| shape.strip_prefix('(')?.strip_suffix(')')).ok_or_else(quoted)?;
        let sizes = sizes.split(',').map(str::trim).filter(|size| !size.is_empty()).map(str::parse);
        match sizes.collect::<Result<Vec<u64>, _>>().as_deref() {
            Ok([rows]) => Ok(Self { shape: [*rows, 1], order }),
            Ok([rows, columns]) => Ok(Self { shape: [*rows, *columns], order }),
            _ => Err(format!("the shape {}", shape.unwrap_or_default())),
        }
    }
}
