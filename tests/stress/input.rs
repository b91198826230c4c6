//! Faults of matrices and maps: lines I-01 to I-26.
