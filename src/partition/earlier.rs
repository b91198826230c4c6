//! The cache of a run, with the digests that the keys of a partition begin with.

use std::sync::OnceLock;

use crate::cache::{Cache, Digest};

/// A cache, and digests that are made once.
#[derive(Debug)]
pub(super) struct Earlier {
    pub(super) cache: Cache,
    /// Of K, and of where M has entries.
    pub(super) stiffness: OnceLock<Digest>,
    /// Of K and M.
    pub(super) matrices: OnceLock<Digest>,
    /// Of everything that modes depend on.
    pub(super) whole: OnceLock<Digest>,
}

impl Earlier {
    pub(super) fn new(cache: &Cache) -> Self {
        let [stiffness, matrices, whole] = [const { OnceLock::new() }; 3];
        Self { cache: cache.clone(), stiffness, matrices, whole }
    }
}
