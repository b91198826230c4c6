//! The bytes of one entry: arrays one after the other, and a digest of them.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};

use bytemuck::{NoUninit, Pod};
use faer::{Mat, MatRef};

use super::key::Digest;
use crate::dense;
use crate::heap::fallibly;

const MAGIC: &[u8; 14] = b"supel cache 1\n";
const DIGEST_BYTES: u64 = 32;
/// Bytes that are read and hashed while they are near.
const BLOCK: usize = 1 << 18;

/// A type of which an entry may hold arrays.
pub(crate) trait Number: Pod {
    /// What tells its arrays from those of other types.
    const TAG: u8;
}

impl Number for f64 {
    const TAG: u8 = b'd';
}

impl Number for f32 {
    const TAG: u8 = b'f';
}

impl Number for u64 {
    const TAG: u8 = b'n';
}

impl Number for u8 {
    const TAG: u8 = b'b';
}

impl Number for u32 {
    const TAG: u8 = b'i';
}

/// Writes an entry.
pub(crate) struct Writer<'a> {
    file: BufWriter<&'a File>,
    hasher: blake3::Hasher,
    n_bytes: u64,
    max_bytes: u64,
}

impl<'a> Writer<'a> {
    /// An entry of so many bytes at most.
    pub(super) fn new(file: &'a File, key: &Digest, max_bytes: u64) -> std::io::Result<Self> {
        let file = BufWriter::with_capacity(BLOCK, file);
        let mut new = Self { file, hasher: blake3::Hasher::new(), n_bytes: DIGEST_BYTES, max_bytes };
        new.bytes(MAGIC)?;
        new.bytes(key)?;
        Ok(new)
    }

    fn bytes(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.n_bytes += bytes.len() as u64;
        if self.n_bytes > self.max_bytes {
            return Err(std::io::Error::other("it is larger than the cache may be"));
        }
        for block in bytes.chunks(BLOCK) {
            self.hasher.update(block);
            self.file.write_all(block)?;
        }
        Ok(())
    }

    /// An array.
    pub(crate) fn array<T: Number + NoUninit>(&mut self, values: &[T]) -> std::io::Result<()> {
        self.bytes(&[T::TAG])?;
        self.bytes(&(values.len() as u64).to_le_bytes())?;
        self.bytes(bytemuck::cast_slice(values))
    }

    /// Whole numbers.
    pub(crate) fn counts(&mut self, counts: &[usize]) -> std::io::Result<()> {
        self.array(&counts.iter().map(|count| *count as u64).collect::<Vec<u64>>())
    }

    /// A matrix, column by column.
    pub(crate) fn columns(&mut self, matrix: MatRef<'_, f64>) -> std::io::Result<()> {
        self.counts(&[matrix.nrows(), matrix.ncols()])?;
        (0..matrix.ncols()).try_for_each(|j| self.array(dense::column(matrix, j)))
    }

    /// Ends the entry and says how many bytes it has.
    pub(super) fn finish(mut self) -> std::io::Result<u64> {
        let digest = self.hasher.finalize();
        self.file.write_all(digest.as_bytes())?;
        self.file.flush()?;
        Ok(self.n_bytes)
    }
}

/// Reads an entry. Every array is bounded by the bytes that are left of the file.
pub(crate) struct Reader<'a> {
    file: BufReader<&'a File>,
    hasher: blake3::Hasher,
    n_left: u64,
    /// Whether there was no memory for an array.
    pub(super) lacks_memory: bool,
}

impl<'a> Reader<'a> {
    /// None where the file is no entry of this key.
    pub(super) fn new(file: &'a File, key: &Digest) -> Option<Self> {
        let n_left = file.metadata().ok()?.len().checked_sub(DIGEST_BYTES)?;
        let file = BufReader::with_capacity(BLOCK, file);
        let mut new = Self { file, hasher: blake3::Hasher::new(), n_left, lacks_memory: false };
        let (mut magic, mut found) = ([0; MAGIC.len()], Digest::default());
        new.bytes(&mut magic)?;
        new.bytes(&mut found)?;
        (magic == *MAGIC && found == *key).then_some(new)
    }

    fn bytes(&mut self, bytes: &mut [u8]) -> Option<()> {
        self.n_left = self.n_left.checked_sub(bytes.len() as u64)?;
        for block in bytes.chunks_mut(BLOCK) {
            self.file.read_exact(block).ok()?;
            self.hasher.update(block);
        }
        Some(())
    }

    /// An array; none where something else is next or there is no memory for it.
    pub(crate) fn array<T: Number>(&mut self) -> Option<Vec<T>> {
        let (mut tag, mut length) = ([0], [0; 8]);
        self.bytes(&mut tag)?;
        self.bytes(&mut length)?;
        let n_bytes = u64::from_le_bytes(length).checked_mul(size_of::<T>() as u64)?;
        if tag != [T::TAG] || n_bytes > self.n_left {
            return None;
        }
        let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
        let Ok(mut values) = fallibly(|| bytemuck::allocation::try_zeroed_vec(length)) else {
            self.lacks_memory = true;
            return None;
        };
        self.bytes(bytemuck::cast_slice_mut(&mut values))?;
        Some(values)
    }

    /// The only number of an array; none where it has more or fewer.
    pub(crate) fn number<T: Number>(&mut self) -> Option<T> {
        match self.array()?[..] {
            [number] => Some(number),
            _ => None,
        }
    }

    /// An array of one number or none.
    pub(crate) fn at_most_one<T: Number>(&mut self) -> Option<Option<T>> {
        match self.array()?[..] {
            [] => Some(None),
            [number] => Some(Some(number)),
            _ => None,
        }
    }

    /// The digest of a key.
    pub(crate) fn digest(&mut self) -> Option<Digest> {
        self.array::<u8>()?.try_into().ok()
    }

    /// Whole numbers, small enough to be added up.
    pub(crate) fn counts(&mut self) -> Option<Vec<usize>> {
        let small = |count: u64| usize::try_from(count).ok().filter(|count| *count <= u32::MAX as usize);
        self.array::<u64>()?.into_iter().map(small).collect()
    }

    /// A matrix.
    pub(crate) fn columns(&mut self) -> Option<Mat<f64>> {
        let [n_rows, n_columns] = self.counts()?[..] else { return None };
        let n_bytes = (n_rows as u64).checked_mul(n_columns as u64)?.checked_mul(size_of::<f64>() as u64)?;
        if n_bytes > self.n_left {
            return None;
        }
        let mut matrix = Mat::zeros(n_rows, n_columns);
        for j in 0..n_columns {
            let column = self.array::<f64>()?;
            if column.len() != n_rows {
                return None;
            }
            dense::column_mut(matrix.as_mut(), j).copy_from_slice(&column);
        }
        Some(matrix)
    }

    /// Whether the entry ends here and is as it was written.
    pub(super) fn ends_whole(mut self) -> bool {
        let mut digest = Digest::default();
        self.n_left == 0 && self.file.read_exact(&mut digest).is_ok() && self.hasher.finalize() == digest
    }
}
