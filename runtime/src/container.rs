//! The safetensors container: a length, a JSON header, the numbers.
//!
//! Every length is checked before it is used, and no allocation exceeds the bytes of the file. The rules are those of the
//! reference implementation: tensors follow each other without a gap, the last one ends with the file, and shape times size
//! equals the bytes given. Three rules are stricter: no key twice, no unknown tensor, no foreign metadata.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use serde_json::{Map, Value};

use crate::error::{FileError, Result};
use crate::strict_json::{self, StrictJsonError};

/// Length of the prefix that holds the header's length.
pub(crate) const PREFIX: usize = 8;

/// Longest header that the reference implementation reads.
const HEADER_LIMIT: u64 = 100_000_000;

/// Type of the numbers of a tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dtype {
    F64,
    F32,
    I64,
}

impl Dtype {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::F64 => "F64",
            Self::F32 => "F32",
            Self::I64 => "I64",
        }
    }

    fn from_name(name: &str) -> Option<Self> {
        [Self::F64, Self::F32, Self::I64].into_iter().find(|dtype| dtype.name() == name)
    }

    fn size(self) -> u64 {
        match self {
            Self::F64 | Self::I64 => 8,
            Self::F32 => 4,
        }
    }
}

/// Every tensor a superelement can have, in the order of the file.
///
/// `recovery` comes last: in single precision it would leave what follows unaligned.
pub(crate) const TENSORS: [&str; 18] = [
    "damping",
    "frequencies",
    "gravity",
    "interface_frames",
    "interface_positions",
    "load_vectors",
    "mass",
    "matrices",
    "mixing",
    "quantities",
    "recovery_dofs",
    "recovery_face_offsets",
    "recovery_faces",
    "recovery_positions",
    "rigid_body_mass",
    "rigid_body_modes",
    "stiffness",
    "recovery",
];

/// A tensor as it lies in the file.
#[derive(Debug)]
pub(crate) struct RawTensor<'a> {
    pub(crate) dtype: Dtype,
    pub(crate) shape: Vec<usize>,
    pub(crate) bytes: &'a [u8],
}

/// The length of the header, from the first bytes of a file.
pub(crate) fn header_length(bytes: &[u8]) -> Result<u64> {
    let prefix = bytes.first_chunk::<PREFIX>().ok_or(FileError::TooShort { found: bytes.len() })?;
    let length = u64::from_le_bytes(*prefix);
    if length > HEADER_LIMIT {
        // Eight letters of text are never the length of a header.
        let is_text = prefix.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
        let begins = || String::from_utf8_lossy(prefix).trim().to_owned();
        let too_large = FileError::HeaderTooLarge { found: length, limit: HEADER_LIMIT };
        return Err(if is_text { FileError::IsText { begins: begins() } } else { too_large });
    }
    Ok(length)
}

/// Whether a file that begins with these bytes is a superelement, sound or not: a length, and a header that has its metadata under `supel`.
pub fn begins_as_superelement(bytes: &[u8]) -> bool {
    let holds = |word: &[u8]| bytes.windows(word.len()).any(|window| window == word);
    header_length(bytes).is_ok()
        && bytes.get(PREFIX) == Some(&b'{')
        && holds(b"\"__metadata__\"")
        && holds(b"\"supel\"")
}

/// A file split into its two parts.
#[derive(Debug)]
pub(crate) struct Container<'a> {
    /// Text of the header.
    pub(crate) header: &'a str,
    /// Descriptions of the tensors, taken from the header.
    entries: Map<String, Value>,
    /// What follows the header.
    data: &'a [u8],
}

impl<'a> Container<'a> {
    /// Splits a file and parses its header.
    pub(crate) fn split(bytes: &'a [u8]) -> Result<Self> {
        let length = header_length(bytes)?;
        let rest = bytes.get(PREFIX..).unwrap_or_default();
        let (header, data) = usize::try_from(length)
            .ok()
            .and_then(|length| rest.split_at_checked(length))
            .ok_or(FileError::HeaderTruncated { found: rest.len(), expected: length })?;
        let header = core::str::from_utf8(header)
            .map_err(|source| FileError::HeaderNotUtf8 { offset: PREFIX + source.valid_up_to() })?;
        if !header.starts_with('{') {
            return Err(FileError::HeaderNotObject);
        }
        match strict_json::parse(header) {
            Ok(Value::Object(entries)) => Ok(Self { header, entries, data }),
            Ok(_) => Err(FileError::HeaderNotObject),
            Err(StrictJsonError::Duplicate(key)) => Err(FileError::DuplicateKey { key, place: "header" }),
            Err(StrictJsonError::Syntax(source)) => Err(FileError::HeaderNotJson { source }),
        }
    }

    /// Takes the one text `supel` out of the header.
    pub(crate) fn take_metadata(&mut self) -> Result<String> {
        let Some(Value::Object(metadata)) = self.entries.remove("__metadata__") else {
            return Err(FileError::MetadataMissing);
        };
        if let Some(key) = metadata.keys().find(|key| *key != "supel") {
            return Err(FileError::MetadataForeignKey { key: key.clone() });
        }
        match metadata.into_iter().next() {
            Some((_, Value::String(text))) => Ok(text),
            _ => Err(FileError::MetadataMissing),
        }
    }

    /// The tensors by name, after all rules of the layout.
    pub(crate) fn tensors(&self) -> Result<BTreeMap<&'static str, RawTensor<'a>>> {
        let entries = self.layout(self.data.len() as u64)?;
        entries.into_iter().map(|entry| entry.attach(self.data)).collect()
    }

    /// The descriptions of the tensors in the order of the file, once they are known to fill the `n_data` bytes behind the header.
    pub(crate) fn layout(&self, n_data: u64) -> Result<Vec<Entry>> {
        let mut entries =
            self.entries.iter().map(|(name, value)| Entry::parse(name, value)).collect::<Result<Vec<_>>>()?;
        // Empty tensors share their offset with the next one, hence the end as second key.
        entries.sort_by_key(|entry| (entry.begin, entry.end));
        let mut expected = 0;
        for entry in &entries {
            entry.check(expected)?;
            expected = entry.end;
        }
        if n_data != expected {
            return Err(FileError::DataLength { found: n_data, expected });
        }
        Ok(entries)
    }
}

/// The description of one tensor in the header.
pub(crate) struct Entry {
    name: &'static str,
    dtype: Dtype,
    shape: Vec<usize>,
    begin: u64,
    end: u64,
}

impl Entry {
    fn parse(name: &str, value: &Value) -> Result<Self> {
        let malformed = |part: &str| FileError::TensorEntry { tensor: name.to_owned(), part: part.to_owned() };
        let Some(name) = TENSORS.into_iter().find(|known| *known == name) else {
            return Err(FileError::UnknownTensor { tensor: name.to_owned() });
        };
        let parts = value.as_object().ok_or_else(|| malformed("description"))?;
        if let Some(part) = parts.keys().find(|part| !["dtype", "shape", "data_offsets"].contains(&part.as_str())) {
            return Err(malformed(part));
        }
        let integers =
            |part: &str| -> Option<Vec<u64>> { parts.get(part)?.as_array()?.iter().map(Value::as_u64).collect() };
        let dtype = parts.get("dtype").and_then(Value::as_str).ok_or_else(|| malformed("dtype"))?;
        let dtype = Dtype::from_name(dtype)
            .ok_or_else(|| FileError::UnknownDtype { tensor: name.to_owned(), found: dtype.to_owned() })?;
        let shape = integers("shape").ok_or_else(|| malformed("shape"))?;
        let shape = shape
            .into_iter()
            .map(|length| usize::try_from(length).map_err(|_| FileError::TensorOverflow { tensor: name.to_owned() }))
            .collect::<Result<Vec<_>>>()?;
        match integers("data_offsets").as_deref() {
            Some(&[begin, end]) => Ok(Self { name, dtype, shape, begin, end }),
            _ => Err(malformed("data_offsets")),
        }
    }

    /// Checks that the tensor begins where the one before ends and has the bytes that its shape takes.
    fn check(&self, expected_begin: u64) -> Result<()> {
        let tensor = || self.name.to_owned();
        if self.begin != expected_begin {
            return Err(FileError::TensorOffset { tensor: tensor(), found: self.begin, expected: expected_begin });
        }
        let size = self
            .shape
            .iter()
            .try_fold(self.dtype.size(), |size, &length| size.checked_mul(u64::try_from(length).ok()?))
            .ok_or_else(|| FileError::TensorOverflow { tensor: tensor() })?;
        let found = i128::from(self.end) - i128::from(self.begin);
        if found != i128::from(size) {
            return Err(FileError::TensorSize { tensor: tensor(), found, expected: size });
        }
        Ok(())
    }

    /// Gives the tensor its bytes; the layout has been checked against the length of the data.
    fn attach(self, data: &[u8]) -> Result<(&'static str, RawTensor<'_>)> {
        let range = usize::try_from(self.begin).ok().zip(usize::try_from(self.end).ok());
        let bytes = range
            .and_then(|(begin, end)| data.get(begin..end))
            .ok_or(FileError::DataLength { found: data.len() as u64, expected: self.end })?;
        Ok((self.name, RawTensor { dtype: self.dtype, shape: self.shape, bytes }))
    }
}

/// A tensor to be written.
#[derive(Debug)]
pub(crate) struct TensorToWrite {
    pub(crate) name: &'static str,
    pub(crate) dtype: Dtype,
    pub(crate) shape: Vec<usize>,
    pub(crate) bytes: Vec<u8>,
}

/// The whole file: prefix, header padded with spaces to a multiple of eight, tensors in the given order.
pub(crate) fn assemble(metadata: &str, tensors: &[TensorToWrite]) -> Result<Vec<u8>> {
    let mut header = format!("{{\"__metadata__\":{{\"supel\":{}}}", Value::from(metadata));
    let mut offset = 0;
    for TensorToWrite { name, dtype, shape, bytes } in tensors {
        let end = offset + bytes.len();
        let dtype = dtype.name();
        header +=
            &format!(",\"{name}\":{{\"dtype\":\"{dtype}\",\"shape\":{shape:?},\"data_offsets\":[{offset},{end}]}}");
        offset = end;
    }
    header.push('}');
    while !header.len().is_multiple_of(PREFIX) {
        header.push(' ');
    }
    let length = header.len() as u64;
    if length > HEADER_LIMIT {
        return Err(FileError::HeaderTooLarge { found: length, limit: HEADER_LIMIT });
    }
    let mut file = Vec::with_capacity(PREFIX + header.len() + offset);
    file.extend(length.to_le_bytes());
    file.extend(header.into_bytes());
    for tensor in tensors {
        file.extend(&tensor.bytes);
    }
    Ok(file)
}
