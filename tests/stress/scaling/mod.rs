//! Scaling and conditioning: lines C-01 to C-15. C-07 (Rubin), C-11 and C-12 (single precision) wait for their features.

mod conditioning;
mod digits;
mod units;
