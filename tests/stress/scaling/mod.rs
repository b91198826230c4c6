//! Scaling and conditioning: lines C-01 to C-15.
