//! Numbers of fixed size, read in pieces: memory grows with what is there, never with what a header promises.

use std::io::{ErrorKind, Read};

use super::indices::Indices;
use crate::error::Error;

/// Bytes read at once.
const PIECE: usize = 1 << 18;
/// Room that is made at once for numbers that are only promised.
const MAX_PROMISED: usize = 1 << 20;

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Endian {
    Little,
    Big,
}

impl Endian {
    /// The other one.
    #[cfg(feature = "hdf5")]
    pub(super) fn other(self) -> Self {
        match self {
            Self::Little => Self::Big,
            Self::Big => Self::Little,
        }
    }
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    F16,
    F32,
    F64,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

/// Decimal digits of a 16-bit float.
const DIGITS_F16: u32 = 3;
/// Decimal digits of a 32-bit float.
const DIGITS_F32: u32 = 7;

impl Kind {
    /// Bytes of a number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::F16 | Self::I16 | Self::U16 => 2,
            Self::F32 | Self::I32 | Self::U32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }

    /// Whether it holds whole numbers alone.
    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::F16 | Self::F32 | Self::F64)
    }

    /// Digits of a real number that it has room for.
    pub(super) fn digits(self) -> u32 {
        match self {
            Self::F16 => DIGITS_F16,
            Self::F32 => DIGITS_F32,
            _ => u32::MAX,
        }
    }

    /// The number in the first bytes as a double; none where it is whole and no double equals it.
    fn real(self, bytes: &[u8], endian: Endian) -> Option<f64> {
        let bits = raw(bytes, self.size(), endian);
        match self {
            Self::F64 => Some(f64::from_bits(bits)),
            Self::F32 => Some(f64::from(f32::from_bits(bits as u32))),
            Self::F16 => Some(half_precision(bits as u16)),
            _ => {
                let whole = if self == Self::U64 { i128::from(bits) } else { self.whole(bytes, endian)?.into() };
                Some(whole as f64).filter(|real| *real as i128 == whole)
            }
        }
    }

    /// The whole number in the first bytes; none where it is none or beyond 2⁶³.
    fn whole(self, bytes: &[u8], endian: Endian) -> Option<i64> {
        let bits = raw(bytes, self.size(), endian);
        match self {
            Self::I8 => Some((bits as u8).cast_signed().into()),
            Self::I16 => Some((bits as u16).cast_signed().into()),
            Self::I32 => Some((bits as u32).cast_signed().into()),
            Self::I64 => Some(bits.cast_signed()),
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => i64::try_from(bits).ok(),
            Self::F16 | Self::F32 | Self::F64 => {
                let real = self.real(bytes, endian)?;
                Some(real as i64).filter(|whole| *whole as f64 == real && *whole < i64::MAX)
            }
        }
    }
}

/// The number of sixteen bits: a sign, five bits of exponent, ten of fraction.
fn half_precision(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from((bits >> 10) & 0x1f), f64::from(bits & 0x3ff));
    let size = match exponent {
        0 => fraction * 2f64.powi(-24),
        0x1f if fraction == 0.0 => f64::INFINITY,
        0x1f => f64::NAN,
        _ => (1024.0 + fraction) * 2f64.powi(exponent - 25),
    };
    if bits >> 15 == 0 { size } else { -size }
}

/// The bits of a number of so many bytes.
fn raw(bytes: &[u8], size: usize, endian: Endian) -> u64 {
    let digits = bytes[..size].iter();
    let add = |bits: u64, byte: &u8| (bits << 8) | u64::from(*byte);
    match endian {
        Endian::Big => digits.fold(0, add),
        Endian::Little => digits.rev().fold(0, add),
    }
}

/// Why numbers could not be read.
#[derive(Debug)]
pub(super) enum Failure {
    /// So many numbers came in place of all.
    Cut(u64),
    /// The number at a position is none of those wanted.
    Value(u64),
    Read(std::io::Error),
    /// What takes the numbers refuses one.
    Refused(Box<Error>),
}

/// Numbers for which room is made at once where so many are promised.
pub(super) fn room(n: u64) -> usize {
    n.min(MAX_PROMISED as u64) as usize
}

/// The next real numbers.
pub(super) fn reals(source: &mut impl Read, stored: (Kind, Endian), n: u64) -> Result<Vec<f64>, Failure> {
    let (kind, endian) = stored;
    let mut values = Vec::with_capacity(room(n));
    each(source, kind, n, |position, bytes| {
        values.push(kind.real(bytes, endian).ok_or(Failure::Value(position))?);
        Ok(())
    })?;
    Ok(values)
}

/// The next whole numbers.
pub(super) fn wholes(source: &mut impl Read, stored: (Kind, Endian), n: u64) -> Result<Vec<i64>, Failure> {
    let (kind, endian) = stored;
    let mut values = Vec::with_capacity(room(n));
    each(source, kind, n, |position, bytes| {
        values.push(kind.whole(bytes, endian).ok_or(Failure::Value(position))?);
        Ok(())
    })?;
    Ok(values)
}

/// The next whole numbers as indices.
pub(super) fn indices(source: &mut impl Read, stored: (Kind, Endian), n: u64) -> Result<Indices, Failure> {
    let (kind, endian) = stored;
    let mut indices = Indices::with_capacity(room(n));
    each(source, kind, n, |position, bytes| {
        indices.push(kind.whole(bytes, endian).ok_or(Failure::Value(position))?);
        Ok(())
    })?;
    Ok(indices)
}

/// Hands every one of the next real numbers with its position to `take`.
pub(super) fn each_real(
    source: &mut impl Read,
    (kind, endian): (Kind, Endian),
    n: u64,
    mut take: impl FnMut(u64, f64) -> Result<(), Failure>,
) -> Result<(), Failure> {
    each(source, kind, n, |position, bytes| take(position, kind.real(bytes, endian).ok_or(Failure::Value(position))?))
}

fn each(
    source: &mut impl Read,
    kind: Kind,
    n: u64,
    mut take: impl FnMut(u64, &[u8]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let size = kind.size();
    let mut piece = vec![0; n.saturating_mul(size as u64).min(PIECE as u64) as usize];
    let mut position = 0;
    while position < n {
        let wanted = (n - position).saturating_mul(size as u64).min(PIECE as u64) as usize;
        let n_read = fill(source, &mut piece[..wanted]).map_err(Failure::Read)?;
        for bytes in piece[..n_read].chunks_exact(size) {
            take(position, bytes)?;
            position += 1;
        }
        if n_read < wanted {
            return Err(Failure::Cut(position));
        }
    }
    Ok(())
}

/// Reads until the buffer is full or nothing comes any more; the bytes read.
pub(super) fn fill(source: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n_read) => filled += n_read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_kind_and_order() {
        let little = |kind, bytes: &[u8]| kind_of(kind, Endian::Little, bytes);
        assert_eq!(little(Kind::I16, &[0xfe, 0xff]), (Some(-2.0), Some(-2)));
        assert_eq!(kind_of(Kind::I16, Endian::Big, &[0xff, 0xfe]), (Some(-2.0), Some(-2)));
        assert_eq!(little(Kind::U64, &[0xff; 8]), (None, None));
        assert_eq!(little(Kind::I64, &(1i64 << 53 | 1).to_le_bytes()), (None, Some(1 << 53 | 1)));
        assert_eq!(little(Kind::F32, &0.1f32.to_le_bytes()), (Some(f64::from(0.1f32)), None));
        assert_eq!(kind_of(Kind::F64, Endian::Big, &3.0f64.to_be_bytes()), (Some(3.0), Some(3)));
        assert_eq!(little(Kind::F64, &1e300f64.to_le_bytes()), (Some(1e300), None));
        // One, minus two, a third, the largest, the smallest normal and the smallest number, minus infinity.
        for (bits, real) in [
            (0x3c00u16, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (0x7bff, 65504.0),
            (0x0400, 6.103_515_625e-5),
            (0x0001, 5.960_464_477_539_063e-8),
            (0xfc00, f64::NEG_INFINITY),
        ] {
            assert_eq!(little(Kind::F16, &bits.to_le_bytes()).0, Some(real), "{bits:#x}");
        }
    }

    fn kind_of(kind: Kind, endian: Endian, bytes: &[u8]) -> (Option<f64>, Option<i64>) {
        (kind.real(bytes, endian), kind.whole(bytes, endian))
    }

    #[test]
    fn what_is_promised_is_not_allocated() {
        let bytes = [0u8; 100];
        let cut = reals(&mut &bytes[..], (Kind::F64, Endian::Little), u64::MAX).expect_err("too few");
        assert!(matches!(cut, Failure::Cut(12)), "{cut:?}");
    }
}
