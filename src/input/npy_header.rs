//! Headers of NumPy arrays, versions 1 to 3 of the format of `numpy.save`.
//!
//! ```text
//! 6 bytes   \x93NUMPY
//! 2 bytes   version
//! 2 or 4    length of the header, little-endian, 4 from version 2 on
//! header    {'descr': '<f8', 'fortran_order': False, 'shape': (120, 4), }
//! numbers   as many as the shape says, and nothing behind them
//! ```

use std::io::Read;

use super::mode_matrix::Order;

/// The first bytes of an array.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// Magic and version.
const PREFIX: usize = 8;
/// The longest header: one of two numbers takes less than a hundred bytes.
const MAX_HEADER: usize = 1 << 12;

/// Whether a file begins as an array of NumPy does.
pub(super) fn is_array(head: &[u8]) -> bool {
    head.starts_with(MAGIC)
}

/// What a header says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Type of the numbers as NumPy writes it, `<f8`.
    pub(super) descr: String,
    pub(super) shape: Vec<u64>,
    pub(super) order: Order,
    /// Bytes before the numbers.
    pub(super) length: u64,
}

/// Why there is no header.
pub(super) enum Failure {
    /// What was found in its place.
    Found(String),
    Read(std::io::Error),
}

impl Header {
    /// Reads a header up to the numbers.
    pub(super) fn read(source: &mut impl Read) -> Result<Self, Failure> {
        let cut = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => Failure::Found("a header cut short or too long".to_owned()),
            _ => Failure::Read(error),
        };
        let mut prefix = [0; PREFIX];
        source.read_exact(&mut prefix).map_err(cut)?;
        if !prefix.starts_with(MAGIC) {
            return Err(Failure::Found("bytes that do not begin as an array of NumPy".to_owned()));
        }
        let (n_bytes, length) = match prefix[PREFIX - 2] {
            1 => {
                let mut bytes = [0; 2];
                source.read_exact(&mut bytes).map_err(cut)?;
                (2, usize::from(u16::from_le_bytes(bytes)))
            }
            2 | 3 => {
                let mut bytes = [0; 4];
                source.read_exact(&mut bytes).map_err(cut)?;
                (4, u32::from_le_bytes(bytes) as usize)
            }
            version => return Err(Failure::Found(format!("version {version} of the format"))),
        };
        if length > MAX_HEADER {
            return Err(Failure::Found("a header cut short or too long".to_owned()));
        }
        let mut text = vec![0; length];
        source.read_exact(&mut text).map_err(cut)?;
        let mut header = Self::of(&String::from_utf8_lossy(&text)).map_err(Failure::Found)?;
        header.length = (PREFIX + n_bytes + length) as u64;
        Ok(header)
    }

    /// The three keys of a header; the error is what was found.
    fn of(text: &str) -> Result<Self, String> {
        let quoted = || format!("the header `{}`", text.trim());
        let inside = text.trim().strip_prefix('{').and_then(|text| text.strip_suffix('}')).ok_or_else(quoted)?;
        let value = |key: &str| {
            let (_, rest) = inside.split_once(&format!("'{key}':"))?;
            let rest = rest.trim_start();
            let end = if rest.starts_with('(') { rest.find(')')? + 1 } else { rest.find(',').unwrap_or(rest.len()) };
            Some(rest[..end].trim())
        };
        let [descr, order, shape] = ["descr", "fortran_order", "shape"].map(value);
        let order = match order {
            Some("True") => Order::ByColumns,
            Some("False") => Order::ByRows,
            _ => return Err(quoted()),
        };
        let sizes = shape.and_then(|shape| shape.strip_prefix('(')?.strip_suffix(')')).ok_or_else(quoted)?;
        let sizes = sizes.split(',').map(str::trim).filter(|size| !size.is_empty()).map(str::parse);
        let shape =
            sizes.collect::<Result<Vec<u64>, _>>().map_err(|_| format!("the shape {}", shape.unwrap_or_default()))?;
        Ok(Self { descr: descr.unwrap_or("unknown").trim_matches('\'').to_owned(), shape, order, length: 0 })
    }

    /// Numbers that the shape asks for; none where they are more than can be counted.
    pub(super) fn n_numbers(&self) -> Option<u64> {
        self.shape.iter().try_fold(1u64, |n, size| n.checked_mul(*size))
    }
}
