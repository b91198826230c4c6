//! Records of the tables in which MSC Nastran keeps matrices.
//!
//! The crate of the HDF5 library describes a record to it by a trait that is unsafe to implement: the description must be the layout of the
//! type. Its own macro derives both from one list of fields, and the types are plain numbers in the order of C.
#![allow(unsafe_code)]

use hdf5_metno::H5Type;
use hdf5_metno::types::FixedAscii;

/// A matrix: its name, size, and where its columns and entries begin.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
pub(super) struct Identity {
    #[hdf5(rename = "NAME")]
    pub(super) name: FixedAscii<8>,
    #[hdf5(rename = "FORM")]
    pub(super) form: i64,
    #[hdf5(rename = "ROW")]
    pub(super) rows: i64,
    #[hdf5(rename = "COLUMN")]
    pub(super) columns: i64,
    #[hdf5(rename = "NON_ZERO")]
    pub(super) n_entries: i64,
    #[hdf5(rename = "COLUMN_POS")]
    pub(super) first_column: i64,
    #[hdf5(rename = "DATA_POS")]
    pub(super) first_entry: i64,
    #[hdf5(rename = "DOMAIN_ID")]
    pub(super) domain: i64,
}

/// Where the entries of a column begin.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
pub(super) struct Column {
    #[hdf5(rename = "POSITION")]
    pub(super) position: i64,
}

/// An entry: its row, from zero, and its value.
#[derive(Clone, Copy, H5Type)]
#[repr(C)]
pub(super) struct Entry {
    #[hdf5(rename = "ROW")]
    pub(super) row: i64,
    #[hdf5(rename = "VALUE")]
    pub(super) value: f64,
}
