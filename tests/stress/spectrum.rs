//! Spectra: lines E-01 to E-11.
