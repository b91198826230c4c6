//! SciPy: compressed rows in an archive of NumPy, as `scipy.sparse.save_npz` writes it.

use std::io::{Error, Result, Write};

use rawzip::{CompressionMethod, ZipArchiveWriter};

use super::content::Content;

/// A header of NumPy is filled up to a multiple of so many bytes.
const ALIGNED: usize = 64;
/// Numbers that are turned into bytes at once.
const PIECE: usize = 1 << 15;

pub(super) fn write(content: Content<'_>, out: &mut impl Write) -> Result<()> {
    let matrix = content.matrix;
    let mut archive = ZipArchiveWriter::new(out);
    let n_entries = matrix.nnz();
    let pointers = matrix.indptr();
    let pointers = pointers.raw_storage().iter().map(|pointer| *pointer as i64);
    // The order of a matrix, and so each index, is below 2^31.
    let indices = matrix.indices().iter().map(|index| index.cast_signed().to_le_bytes());
    let shape = [matrix.rows() as i64, matrix.cols() as i64];
    member(&mut archive, "indices.npy", ("<i4", &format!("{n_entries},")), indices)?;
    member(&mut archive, "indptr.npy", ("<i8", &format!("{},", matrix.rows() + 1)), pointers.map(i64::to_le_bytes))?;
    member(&mut archive, "format.npy", ("|S3", ""), [*b"csr"])?;
    member(&mut archive, "shape.npy", ("<i8", "2,"), shape.map(i64::to_le_bytes))?;
    let values = matrix.data().iter().map(|value| value.to_le_bytes());
    member(&mut archive, "data.npy", ("<f8", &format!("{n_entries},")), values)?;
    archive.finish().map_err(Error::other).map(drop)
}

/// An array of a type and a shape, not compressed.
fn member<W: Write, const N: usize>(
    archive: &mut ZipArchiveWriter<W>,
    name: &str,
    (descr, shape): (&str, &str),
    numbers: impl IntoIterator<Item = [u8; N]>,
) -> Result<()> {
    let stored = archive.new_file(name).compression_method(CompressionMethod::STORE);
    let (mut entry, config) = stored.start().map_err(Error::other)?;
    let mut writer = config.wrap(&mut entry);
    writer.write_all(&header(descr, shape))?;
    let mut piece = Vec::with_capacity(PIECE * N);
    for number in numbers {
        piece.extend_from_slice(&number);
        if piece.len() == PIECE * N {
            writer.write_all(&piece)?;
            piece.clear();
        }
    }
    writer.write_all(&piece)?;
    let (_, descriptor) = writer.finish().map_err(Error::other)?;
    entry.finish(descriptor).map_err(Error::other)?;
    Ok(())
}

/// The header of an array, version 1 of the format.
fn header(descr: &str, shape: &str) -> Vec<u8> {
    let mut text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}), }}");
    let before = b"\x93NUMPY\x01\0\0\0".len();
    let length = (before + text.len() + 1).next_multiple_of(ALIGNED) - before;
    text.extend(std::iter::repeat_n(' ', length - text.len() - 1));
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\0".to_vec();
    header.extend_from_slice(&(length as u16).to_le_bytes());
    header.extend_from_slice(text.as_bytes());
    header
}
