//! Memory that reading may take, known to all readers of a model and counted while they read.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{Error, Result};

/// Memory for everything that is read of one model and made of it on the way.
#[derive(Debug)]
pub struct Allowance {
    available: u64,
    claimed: AtomicU64,
}

impl Allowance {
    /// An allowance of this many bytes; `None` sets no limit.
    pub fn of(bytes: Option<u64>) -> Self {
        Self { available: bytes.unwrap_or(u64::MAX), claimed: AtomicU64::new(0) }
    }

    /// What is read of the file `path`, nothing so far.
    pub(super) fn claim(&self, path: &Path) -> Claim<'_> {
        Claim { allowance: self, path: path.to_owned(), bytes: Cell::new(0) }
    }
}

/// What the content of one file takes. It counts as long as the allowance does: what was read stays.
#[derive(Debug)]
pub(super) struct Claim<'a> {
    allowance: &'a Allowance,
    path: PathBuf,
    bytes: Cell<u64>,
}

impl Claim<'_> {
    /// Bytes that the content takes from now on, as far as it is known.
    ///
    /// # Errors
    /// [`Error::MemoryRead`] where all files together take more than there is.
    pub(super) fn set(&self, bytes: u64) -> Result<()> {
        let Allowance { available, claimed } = self.allowance;
        let before = self.bytes.replace(bytes);
        let others = claimed.fetch_sub(before, Ordering::Relaxed) - before;
        let needed = others.saturating_add(bytes);
        claimed.fetch_add(bytes, Ordering::Relaxed);
        if needed > *available {
            return Err(Error::MemoryRead { path: self.path.clone(), needed, available: *available });
        }
        Ok(())
    }

    /// More bytes than before.
    pub(super) fn add(&self, bytes: u64) -> Result<()> {
        self.set(self.bytes.get().saturating_add(bytes))
    }
}
