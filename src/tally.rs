//! What the running stage has done so far: counts that the deepest loops raise and that progress shows. Nothing is decided by them, and they
//! are those of the process, so that no loop has to be handed a listener.

use std::sync::atomic::{AtomicU64, Ordering};

/// Right-hand sides solved for.
static SOLVES: AtomicU64 = AtomicU64::new(0);
/// Operations of eliminations.
static FLOPS: AtomicU64 = AtomicU64::new(0);
/// Modes that have converged.
static MODES: AtomicU64 = AtomicU64::new(0);

/// What a stage has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Right-hand sides solved for.
    pub solves: u64,
    /// Floating-point operations of eliminations.
    pub flops: u64,
    /// Modes that have converged.
    pub modes: u64,
}

/// A stage begins, and has done nothing.
pub fn begin() {
    [&SOLVES, &FLOPS, &MODES].into_iter().for_each(|count| count.store(0, Ordering::Relaxed));
}

/// Right-hand sides have been solved for.
pub fn solved(columns: usize) {
    SOLVES.fetch_add(columns as u64, Ordering::Relaxed);
}

/// Columns have been eliminated.
pub fn eliminated(flops: u64) {
    FLOPS.fetch_add(flops, Ordering::Relaxed);
}

/// So many modes of a search for the lowest ones have converged by now.
pub fn converged(modes: usize) {
    MODES.fetch_max(modes as u64, Ordering::Relaxed);
}

/// A slice of a band has ended with so many modes.
pub fn found(modes: usize) {
    MODES.fetch_add(modes as u64, Ordering::Relaxed);
}

/// What the running stage has done so far.
pub fn so_far() -> Tally {
    let [solves, flops, modes] = [&SOLVES, &FLOPS, &MODES].map(|count| count.load(Ordering::Relaxed));
    Tally { solves, flops, modes }
}
