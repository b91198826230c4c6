//! The two eigensolvers against exact spectra, against each other, and the Sturm count against dense spectra.

#[path = "../chain/mod.rs"]
mod chain;
mod component;
mod exact_spectra;
mod few_digits;
mod ladder;
mod requests;
mod structures;
mod sturm;
