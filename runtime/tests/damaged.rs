//! No damage goes unnoticed: every bit of a file, every length of it.

use supel_models::superelements::particle as sample;

use supel_runtime::{FileError, Superelement};

#[test]
fn every_flipped_bit_is_noticed() {
    let intact = sample::two_particles().to_bytes().unwrap().bytes;
    assert!(intact.len() <= 4096, "small enough for all its bits: {} bytes", intact.len());
    let mut file = intact.clone();
    for bit in 0..8 * file.len() {
        file[bit / 8] ^= 1 << (bit % 8);
        assert!(Superelement::from_bytes(&file).is_err(), "bit {bit} can be flipped unnoticed");
        file[bit / 8] ^= 1 << (bit % 8);
    }
    assert_eq!(file, intact);
}

#[test]
fn one_flipped_bit_in_every_byte_of_a_full_file_is_noticed() {
    let mut file = sample::complete().to_bytes().unwrap().bytes;
    for byte in 0..file.len() {
        file[byte] ^= 1 << (byte % 8);
        assert!(Superelement::from_bytes(&file).is_err(), "byte {byte} can be changed unnoticed");
        file[byte] ^= 1 << (byte % 8);
    }
}

#[test]
fn every_truncation_is_named_as_such() {
    for superelement in [sample::two_particles(), sample::complete()] {
        let file = superelement.to_bytes().unwrap().bytes;
        for length in 0..file.len() {
            let error = Superelement::from_bytes(&file[..length]).unwrap_err();
            assert!(
                matches!(
                    error,
                    FileError::TooShort { .. } | FileError::HeaderTruncated { .. } | FileError::DataLength { .. }
                ),
                "cut at {length}: {error}"
            );
        }
    }
}

#[test]
fn anything_appended_is_noticed() {
    let mut file = sample::two_particles().to_bytes().unwrap().bytes;
    file.push(0);
    assert!(matches!(Superelement::from_bytes(&file), Err(FileError::DataLength { .. })));
}

/// A value changed in the numbers alone keeps the layout: only the digest can tell.
#[test]
fn a_changed_number_is_told_by_the_digest() {
    let mut file = sample::two_particles().to_bytes().unwrap().bytes;
    *file.last_mut().unwrap() ^= 1;
    assert!(matches!(Superelement::from_bytes(&file), Err(FileError::DigestMismatch { .. })));
}
