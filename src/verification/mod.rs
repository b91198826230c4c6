//! Proof of what the reduction preserves.

pub mod check;
