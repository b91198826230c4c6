//! The modal component in large motion.

mod at_nodes;
#[cfg(feature = "std")]
mod batch;
#[path = "../beam/mod.rs"]
mod beam;
mod construction;
mod damping;
mod dynamics;
mod exact;
mod forces;
mod gravity;
mod invariance;
mod loads;
#[path = "../random/mod.rs"]
mod random;
mod recovery;
mod situation;
