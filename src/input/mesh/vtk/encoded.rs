//! Arrays of VTK's XML: in text, in base64, or as bytes behind the document, packed by zlib or not.

use std::io::Read;

use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::input::raw_numbers::Endian;

/// How arrays of a file are encoded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encoding<'a> {
    /// Bytes of a number in the heads of arrays, 4 or 8.
    pub(super) header: usize,
    pub(super) endian: Endian,
    /// The name of the compressor; none where arrays are not packed.
    pub(super) compressor: Option<&'a str>,
}

/// Inflation that deflate cannot exceed.
const MAX_RATIO: u64 = 1032;

/// Base64 whose padding is not judged: heads and data are padded one by one.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

impl Encoding<'_> {
    /// The compressor, where it is one that is not read.
    pub(super) fn unread_compressor(&self) -> Option<&str> {
        self.compressor.filter(|name| *name != "vtkZLibDataCompressor")
    }

    /// The bytes of an array from base64, which other arrays may follow. Head and data are padded one by one, or without a compressor together.
    pub(super) fn of_base64(self, text: &[u8]) -> Result<Vec<u8>, String> {
        let characters = |from: usize, n: usize| -> Vec<u8> {
            text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).skip(from).take(n).collect()
        };
        if self.compressor.is_none() {
            let in_head = base64_length(self.header)?;
            let head_text = characters(0, in_head);
            let head = decoded(&head_text)?;
            let n_bytes = self.number(&head, 0)?;
            let padding = head_text.iter().rev().take_while(|byte| **byte == b'=').count();
            if padding == 3 * in_head / 4 - self.header {
                let data = decoded(&characters(in_head, base64_length(n_bytes)?))?;
                return self.plain(&[&head[..self.header], &data].concat(), n_bytes);
            }
            let n_all = n_bytes.checked_add(self.header).ok_or("a size that is too large")?;
            return self.plain(&decoded(&characters(0, base64_length(n_all)?))?, n_bytes);
        }
        let n_blocks = self.number(&decoded(&characters(0, base64_length(3 * self.header)?))?, 0)?;
        let head_bytes = n_blocks.checked_add(3).and_then(|n| n.checked_mul(self.header)).ok_or("too many blocks")?;
        let in_head = Some(base64_length(head_bytes)?).filter(|length| *length <= text.len());
        let in_head = in_head.ok_or_else(|| format!("{n_blocks} blocks"))?;
        let head = decoded(&characters(0, in_head))?;
        let sizes = (0..n_blocks).map(|block| self.number(&head, 3 + block));
        let n_packed = sizes.sum::<Result<usize, String>>()?;
        self.unpacked(&head, &decoded(&characters(in_head, base64_length(n_packed)?))?)
    }

    /// The bytes of an array from bytes, which go on behind it.
    pub(super) fn of_bytes(self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        if self.compressor.is_none() {
            return self.plain(bytes, self.number(bytes, 0)?);
        }
        let n_blocks = self.number(bytes, 0)?;
        let head = n_blocks.checked_add(3).and_then(|n| n.checked_mul(self.header)).filter(|n| *n <= bytes.len());
        let (head, data) = bytes.split_at(head.ok_or_else(|| format!("{n_blocks} blocks"))?);
        self.unpacked(head, data)
    }

    fn plain(self, bytes: &[u8], n_bytes: usize) -> Result<Vec<u8>, String> {
        let data = bytes.get(self.header..).and_then(|rest| rest.get(..n_bytes));
        data.map(<[u8]>::to_vec).ok_or_else(|| format!("{} bytes of the {n_bytes} that its head states", bytes.len()))
    }

    /// Unpacks blocks whose number and sizes are in the head.
    fn unpacked(self, head: &[u8], data: &[u8]) -> Result<Vec<u8>, String> {
        let n_blocks = self.number(head, 0)?;
        let mut bytes = Vec::new();
        let mut at = 0_usize;
        for block in 0..n_blocks {
            let size = self.number(head, 3 + block)?;
            let end =
                at.checked_add(size).filter(|end| *end <= data.len()).ok_or("fewer bytes than its head states")?;
            let limit = (size as u64).saturating_mul(MAX_RATIO).saturating_add(64);
            let decoder = flate2::read::ZlibDecoder::new(&data[at..end]);
            decoder
                .take(limit)
                .read_to_end(&mut bytes)
                .map_err(|error| format!("packed data that are damaged ({error})"))?;
            at = end;
        }
        Ok(bytes)
    }

    /// The number at a place in a head.
    fn number(self, head: &[u8], at: usize) -> Result<usize, String> {
        let from = at.checked_mul(self.header).ok_or("a head that is too long")?;
        let bytes = from.checked_add(self.header).and_then(|end| head.get(from..end)).ok_or("the end within a head")?;
        let digits = bytes.iter();
        let value = match self.endian {
            Endian::Big => digits.fold(0_u64, |value, byte| value << 8 | u64::from(*byte)),
            Endian::Little => digits.rev().fold(0_u64, |value, byte| value << 8 | u64::from(*byte)),
        };
        usize::try_from(value).map_err(|_| format!("a size of {value} bytes"))
    }
}

/// Characters that stand for so many bytes, with their padding.
fn base64_length(n_bytes: usize) -> Result<usize, String> {
    n_bytes.div_ceil(3).checked_mul(4).ok_or_else(|| format!("a size of {n_bytes} bytes"))
}

fn decoded(text: &[u8]) -> Result<Vec<u8>, String> {
    BASE64.decode(text).map_err(|error| format!("text that is not base64 ({error})"))
}

/// Numbers of a type of VTK in bytes.
pub(super) enum Numbers {
    Whole(Vec<i64>),
    Real(Vec<f64>),
}

/// The numbers of a type; none where the type is unknown or the bytes are no whole number of them.
pub(super) fn numbers(bytes: &[u8], kind: &str, endian: Endian) -> Option<Numbers> {
    macro_rules! each {
        ($number:ty, $into:expr) => {{
            const SIZE: usize = size_of::<$number>();
            let number = |bytes: &[u8]| {
                let bytes = <[u8; SIZE]>::try_from(bytes).unwrap_or([0; SIZE]);
                $into(match endian {
                    Endian::Big => <$number>::from_be_bytes(bytes),
                    Endian::Little => <$number>::from_le_bytes(bytes),
                })
            };
            bytes.len().is_multiple_of(SIZE).then(|| bytes.chunks_exact(SIZE).map(number).collect())
        }};
    }
    Some(match kind {
        "Int8" => Numbers::Whole(each!(i8, i64::from)?),
        "UInt8" => Numbers::Whole(each!(u8, i64::from)?),
        "Int16" => Numbers::Whole(each!(i16, i64::from)?),
        "UInt16" => Numbers::Whole(each!(u16, i64::from)?),
        "Int32" => Numbers::Whole(each!(i32, i64::from)?),
        "UInt32" => Numbers::Whole(each!(u32, i64::from)?),
        "Int64" => Numbers::Whole(each!(i64, i64::from)?),
        "UInt64" => Numbers::Whole(each!(u64, |n: u64| i64::try_from(n).unwrap_or(i64::MAX))?),
        "Float32" => Numbers::Real(each!(f32, f64::from)?),
        "Float64" => Numbers::Real(each!(f64, f64::from)?),
        _ => return None,
    })
}
