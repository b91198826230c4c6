//! MATLAB level 5: what `save` of MATLAB and `scipy.io.savemat` write unless they are told otherwise.
//!
//! ```text
//! 116 bytes text, 8 bytes, version 0x0100, IM or MI for the order of bytes
//! elements: type and length of four bytes each, both in one word where up to four bytes follow; content up to a multiple of 8
//!   miCOMPRESSED  zlib of one element
//!   miMATRIX      flags and class · dimensions · name · then of a sparse matrix rows, column pointers, values; of a dense one values
//! ```

mod element;
mod file;
mod modes;
mod picked;
mod reader;

pub(super) use modes::modes;
pub(super) use reader::{Matlab5, begins};
