//! Zip archives: members by name, stored or deflated, each compared with its checksum where it is read to its end.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, FileReader, RECOMMENDED_BUFFER_SIZE, ZipArchive, ZipArchiveEntryWayfinder};

use super::source::damage;
use crate::error::{Error, Result};
use crate::regular_file;

/// Members of an archive; those of matrices have a handful.
const MAX_MEMBERS: usize = 1 << 16;

/// An archive whose index has been read.
pub(super) struct Archive<'a> {
    path: &'a Path,
    format: &'static str,
    zip: ZipArchive<FileReader>,
    members: Vec<Member>,
}

struct Member {
    name: String,
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    is_encrypted: bool,
}

impl<'a> Archive<'a> {
    /// Reads the index of an archive, which `format` is in messages.
    pub(super) fn open(path: &'a Path, format: &'static str) -> Result<Self> {
        let damaged = |place: &str, found: String| Error::MatrixFormat {
            path: path.to_owned(),
            format,
            place: place.to_owned(),
            found,
            expected: "a zip archive that is whole".into(),
        };
        let file: File = regular_file::open(path)?;
        let n_bytes = file.metadata().map_err(|source| Error::Read { path: path.to_owned(), source })?.len();
        let index = format!("the index at its end, byte {n_bytes}");
        let in_index = |error: rawzip::Error| damaged(&index, error.to_string());
        let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
        let zip = ZipArchive::from_file(file, &mut buffer).map_err(in_index)?;
        let mut members = Vec::new();
        let mut entries = zip.entries(&mut buffer);
        while let Some(entry) = entries.next_entry().map_err(in_index)? {
            let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
            let (place, method) = (entry.wayfinder(), entry.compression_method());
            members.push(Member { name, place, method, is_encrypted: entry.flags().is_encrypted() });
            if members.len() > MAX_MEMBERS {
                return Err(damaged(&index, format!("more than {MAX_MEMBERS} members")));
            }
        }
        if zip.entries_hint() != members.len() as u64 {
            let found = format!("{} members, of which its end announces {}", members.len(), zip.entries_hint());
            return Err(damaged(&index, found));
        }
        Ok(Self { path, format, zip, members })
    }

    /// Names of the members.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().map(|member| member.name.as_str())
    }

    /// Whether there is a member of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.names().any(|other| other == name)
    }

    /// The bytes of a member.
    pub(super) fn member(&self, name: &str) -> Result<Box<dyn Read + '_>> {
        let damaged = |found: String, expected: &str| Error::MatrixFormat {
            path: self.path.to_owned(),
            format: self.format,
            place: name.to_owned(),
            found,
            expected: expected.into(),
        };
        let Some(member) = self.members.iter().find(|member| member.name == name) else {
            return Err(damaged("no such member".to_owned(), "one, as scipy.sparse.save_npz writes it"));
        };
        if member.is_encrypted {
            return Err(damaged("an encrypted member".to_owned(), "one without a password"));
        }
        let entry =
            self.zip.get_entry(member.place).map_err(|error| damaged(error.to_string(), "a member that is whole"))?;
        let packed = entry.reader();
        if member.method == CompressionMethod::STORE {
            return Ok(Box::new(BufReader::new(entry.verifying_reader(packed))));
        }
        if member.method == CompressionMethod::DEFLATE {
            // Deflate ends at 1032 to 1, and what is read grows with what comes.
            let inflated = Inflated { decoder: DeflateDecoder::new(BufReader::new(packed)), unpacked: 0 };
            return Ok(Box::new(entry.verifying_reader(inflated)));
        }
        Err(damaged(format!("a member packed by {:?}", member.method), "one that is stored or deflated"))
    }
}

/// Unpacks a member, and tells damage of its data from what the system says.
struct Inflated<R> {
    decoder: DeflateDecoder<R>,
    unpacked: u64,
}

impl<R: BufRead> Read for Inflated<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n_read = self.decoder.read(buffer).map_err(|error| damage("data of the archive", self.unpacked, error))?;
        self.unpacked += n_read as u64;
        Ok(n_read)
    }
}
