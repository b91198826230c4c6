//! The modal component in large motion.

#[cfg(feature = "std")]
mod batch;
#[path = "../beam/mod.rs"]
mod beam;
mod construction;
mod dynamics;
mod forces;
mod invariance;
mod loads;
#[path = "../random/mod.rs"]
mod random;
mod recovery;
mod situation;
