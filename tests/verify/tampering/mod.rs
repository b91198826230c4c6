//! What `supel verify` sees: every field changed, one at a time, and the file sealed again.

mod alterations;
mod fields;
mod subjects;
mod table;
