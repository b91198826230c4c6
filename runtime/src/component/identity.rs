//! Which component a workspace is for.

use core::sync::atomic::{AtomicUsize, Ordering};

/// A number that no other component of this process has; a clone, which has the same matrices, shares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Identity(usize);

static NEXT: AtomicUsize = AtomicUsize::new(0);

impl Identity {
    pub(super) fn new() -> Self {
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}
