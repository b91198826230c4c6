//! The two eigensolvers against exact spectra, against each other, and the Sturm count against dense spectra.

mod component;
mod exact_spectra;
mod requests;
mod structures;
mod sturm;
