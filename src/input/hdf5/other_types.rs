//! Numbers of types that are not this machine's: half precision, and bytes in the other order.
//!
//! A type is taken for one of them where the library finds it equal, bit by bit, to one that is made here, whatever the file says of it. The
//! values are then copied as they are stored: the library is given the type of the file for that of memory, between which it has nothing to
//! convert. Calls of the library are made one at a time, as everywhere in the crate that binds it.
#![allow(unsafe_code)]

use hdf5_metno::{Container, Datatype, sync::sync};
use hdf5_metno_sys::h5a::H5Aread;
use hdf5_metno_sys::h5d::H5Dread;
use hdf5_metno_sys::h5i::{H5I_type_t, hid_t};
use hdf5_metno_sys::h5p::H5P_DEFAULT;
use hdf5_metno_sys::h5s::H5S_ALL;
use hdf5_metno_sys::h5t::{self, H5Tclose, H5Tcopy, H5Tequal, H5Tset_ebias, H5Tset_fields, H5Tset_size};

use crate::input::raw_numbers::{Endian, Kind};

/// How numbers of a type are stored, where that is not how this machine stores them.
pub(super) fn stored_as(datatype: &Datatype) -> Option<(Kind, Endian)> {
    let own = if cfg!(target_endian = "little") { Endian::Little } else { Endian::Big };
    let id = datatype.id();
    sync(|| {
        let is_standard = |(kind, other): &(Kind, hid_t)| -> Option<(Kind, Endian)> {
            // SAFETY: both are types of an open library, which compares them without a change.
            (unsafe { H5Tequal(id, *other) } > 0).then_some((*kind, own.other()))
        };
        let standard = of_other_order();
        standard.iter().find_map(is_standard).or_else(|| {
            [Endian::Little, Endian::Big]
                .into_iter()
                .find(|endian| is_half(id, *endian))
                .map(|endian| (Kind::F16, endian))
        })
    })
}

/// Types of more than one byte in the order that is not this machine's.
fn of_other_order() -> [(Kind, hid_t); 8] {
    #[cfg(target_endian = "little")]
    let types = [
        h5t::H5T_IEEE_F64BE,
        h5t::H5T_IEEE_F32BE,
        h5t::H5T_STD_I16BE,
        h5t::H5T_STD_I32BE,
        h5t::H5T_STD_I64BE,
        h5t::H5T_STD_U16BE,
        h5t::H5T_STD_U32BE,
        h5t::H5T_STD_U64BE,
    ];
    #[cfg(target_endian = "big")]
    let types = [
        h5t::H5T_IEEE_F64LE,
        h5t::H5T_IEEE_F32LE,
        h5t::H5T_STD_I16LE,
        h5t::H5T_STD_I32LE,
        h5t::H5T_STD_I64LE,
        h5t::H5T_STD_U16LE,
        h5t::H5T_STD_U32LE,
        h5t::H5T_STD_U64LE,
    ];
    let kinds = [Kind::F64, Kind::F32, Kind::I16, Kind::I32, Kind::I64, Kind::U16, Kind::U32, Kind::U64];
    std::array::from_fn(|at| (kinds[at], *types[at]))
}

/// Whether a type is that of half precision: a sign, five bits of exponent with a bias of 15, ten of fraction.
fn is_half(id: hid_t, endian: Endian) -> bool {
    let single = if endian == Endian::Little { *h5t::H5T_IEEE_F32LE } else { *h5t::H5T_IEEE_F32BE };
    // SAFETY: the copy is a type of this function alone, which closes it; the bits are moved before the type is made shorter.
    unsafe {
        let half = H5Tcopy(single);
        let is_made =
            H5Tset_fields(half, 15, 10, 5, 0, 10) >= 0 && H5Tset_size(half, 2) >= 0 && H5Tset_ebias(half, 15) >= 0;
        let is_equal = is_made && H5Tequal(id, half) > 0;
        H5Tclose(half);
        is_equal
    }
}

/// The bytes of all values, as they are stored.
pub(super) fn bytes(container: &Container) -> hdf5_metno::Result<Vec<u8>> {
    let datatype = container.dtype()?;
    let n_bytes = container.space()?.size().checked_mul(datatype.size()).ok_or("more bytes than memory can have")?;
    let mut bytes = vec![0u8; n_bytes];
    let (id, type_id, to) = (container.id(), datatype.id(), bytes.as_mut_ptr().cast());
    // SAFETY: the buffer has room for every value of the container's own type, in which they are written to it.
    let status = sync(|| match container.id_type() == H5I_type_t::H5I_ATTR {
        true => unsafe { H5Aread(id, type_id, to) },
        false => unsafe { H5Dread(id, type_id, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) },
    });
    if status < 0 { Err("the values could not be read".into()) } else { Ok(bytes) }
}
