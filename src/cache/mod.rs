//! Results of earlier runs, kept in a folder and found again by the numbers that they were computed from.
//!
//! ```text
//! FOLDER/CACHEDIR.TAG            says to backup programs that everything here can be made again
//! FOLDER/factor-3f…e1.entry      one result: its kind, and its key
//! FOLDER/….part                  one that is being written
//!
//! entry    "supel cache 1\n" · key, 32 bytes · arrays · BLAKE3 of all before, 32 bytes
//! array    tag of its type, 1 byte · length, 8 bytes · values, in the order of the processor
//! ```
//! An entry is the result of a function to the last bit, and its key is a digest of all that the function takes, of the bytes of the program
//! and of the instructions of the processor, which decide how sums are rounded. So a run with a cache writes the bytes that a run
//! without one writes, and takes less time. A result that contains what is asked, and is certified to, may serve in part: it is named by a
//! second entry, whose key leaves out how much was asked. Such parts are right to their error bars, and the tally counts them.
//!
//! Entries come and go whole: each is written under another name first, and read only where its digest is right. What is damaged or foreign
//! under the name of an entry is removed and computed anew. Several processes may use one folder. Where it has more bytes than allowed, the
//! entries that were used longest ago are removed; files that no cache has written are never touched.

mod entry;
mod folder;
mod key;
mod kind;
mod recorded;

pub(crate) use entry::{Number, Reader, Writer};
pub use folder::{Cache, Tally};
pub(crate) use key::{Digest, Key};
pub use kind::Kind;
pub(crate) use recorded::Recorded;

use crate::error::Result;

/// What `make` makes, or what it made in an earlier run under the same key.
///
/// # Errors
/// What `make` refuses; a cache that cannot be used is none.
pub(crate) fn recalled<T: Recorded>(
    cache: Option<&Cache>,
    key: impl FnOnce() -> Key,
    make: impl FnOnce() -> Result<T>,
) -> Result<T> {
    match cache {
        None => make(),
        Some(cache) => cache.recall((T::KIND, &key()), T::read, make, T::write),
    }
}
