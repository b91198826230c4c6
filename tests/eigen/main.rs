//! The two eigensolvers against exact spectra, against each other, and the Sturm count against dense spectra.

mod component;
mod exact_spectra;
mod few_digits;
mod ladder;
mod requests;
mod structures;
mod sturm;

use supel_testing::chain;
