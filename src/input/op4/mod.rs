//! Nastran OUTPUT4: text and binary, dense and sparse, in either order of bytes.
//!
//! A file holds matrices one after another, each with a head (columns, rows, form, type, name) and a record for each column that has
//! entries; a record of a column beyond the last one ends the matrix. A record holds consecutive rows of a dense column, or strings of
//! consecutive rows of a sparse one: with a word for the length and one for the row where the number of rows is negative or above 65535
//! ("big matrix"), else with both in one word.

mod binary;
mod head;
mod matrices;
mod reader;
mod text;

pub(super) use reader::{Op4, begins, modes};
