//! Which component a workspace is for.

use core::sync::atomic::{AtomicUsize, Ordering};

/// A number that no other component of this process has. A clone shares it, because it has the same matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Identity(usize);

static NEXT: AtomicUsize = AtomicUsize::new(0);

impl Identity {
    pub(super) fn new() -> Self {
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}
