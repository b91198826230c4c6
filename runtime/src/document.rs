//! The metadata document of the file: format version and digest around [`Metadata`].

use alloc::borrow::ToOwned;
use alloc::string::{String, ToString};

use serde::Serialize;
use serde_json::Value;

use crate::container::PREFIX;
use crate::error::{FileError, Result};
use crate::metadata::Metadata;
use crate::strict_json::{self, StrictJsonError};

/// Version of the format that this crate writes and reads.
pub const FORMAT_VERSION: &str = "1";

/// Stands for the digest while the digest is computed.
const ZEROS: &str = "0000000000000000000000000000000000000000000000000000000000000000";

#[derive(Serialize)]
struct Document<'a> {
    format_version: &'static str,
    blake3: &'static str,
    #[serde(flatten)]
    metadata: &'a Metadata,
}

/// The document as it is written, with zeros for the digest.
pub(crate) fn write(metadata: &Metadata) -> Result<String> {
    serde_json::to_string(&Document { format_version: FORMAT_VERSION, blake3: ZEROS, metadata })
        .map_err(|source| FileError::MetadataSchema { source })
}

/// A document whose version is known, with the digest it records.
pub(crate) struct ParsedDocument {
    pub(crate) digest: String,
    rest: Value,
}

/// Parses a document as far as its version and its digest.
pub(crate) fn parse(text: &str) -> Result<ParsedDocument> {
    let mut document = match strict_json::parse(text) {
        Ok(document) => document,
        Err(StrictJsonError::Duplicate(key)) => return Err(FileError::DuplicateKey { key, place: "metadata" }),
        Err(StrictJsonError::Syntax(source)) => return Err(FileError::MetadataNotJson { source }),
    };
    let mut take = |key: &str| document.as_object_mut().and_then(|fields| fields.remove(key));
    let version = take("format_version");
    if version.as_ref().and_then(Value::as_str) != Some(FORMAT_VERSION) {
        let found = version.map_or_else(|| "none".to_owned(), |version| version.to_string());
        return Err(FileError::UnknownVersion { found, expected: FORMAT_VERSION });
    }
    match take("blake3") {
        Some(Value::String(digest)) if is_digest(&digest) => Ok(ParsedDocument { digest, rest: document }),
        _ => Err(FileError::DigestMalformed),
    }
}

impl ParsedDocument {
    /// The metadata, once the digest is known to hold.
    pub(crate) fn metadata(self) -> Result<Metadata> {
        serde_json::from_value(self.rest).map_err(|source| FileError::MetadataSchema { source })
    }
}

/// True for 64 lower-case hexadecimal digits.
pub(crate) fn is_digest(text: &str) -> bool {
    text.len() == ZEROS.len() && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// Checks the digest of a whole file; `header` is the text of its header, `recorded` the digest found in it.
pub(crate) fn check_digest(file: &[u8], header: &str, recorded: &str) -> Result<()> {
    let mut places = header.match_indices(recorded);
    let (Some((place, _)), None) = (places.next(), places.next()) else {
        return Err(FileError::DigestMalformed);
    };
    let found = digest_around(file, PREFIX + place);
    if found == recorded { Ok(()) } else { Err(FileError::DigestMismatch { found, expected: recorded.to_owned() }) }
}

/// Replaces the zeros of a file just assembled by its digest, and returns it.
pub(crate) fn seal(file: &mut [u8]) -> Result<String> {
    // The document opens with version and digest, before any text that could hold as many zeros.
    let place =
        file.windows(ZEROS.len()).position(|window| window == ZEROS.as_bytes()).ok_or(FileError::DigestMalformed)?;
    let digest = digest_around(file, place);
    if let Some(target) = file.get_mut(place..place + ZEROS.len()) {
        target.copy_from_slice(digest.as_bytes());
    }
    Ok(digest)
}

/// BLAKE3 of a file in which the 64 characters at `place` are taken as zeros.
fn digest_around(file: &[u8], place: usize) -> String {
    let (before, rest) = file.split_at(place.min(file.len()));
    let after = rest.get(ZEROS.len()..).unwrap_or_default();
    let mut hasher = blake3::Hasher::new();
    hasher.update(before).update(ZEROS.as_bytes()).update(after);
    hasher.finalize().to_hex().to_string()
}
