//! Scaling and conditioning: lines C-01 to C-15. C-07 is in `tests/theorems`. C-11 and C-12 (single precision) are in
//! `tests/factor/single.rs` and `tests/end_to_end/recovery.rs`.

mod conditioning;
mod digits;
mod units;
