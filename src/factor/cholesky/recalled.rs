//! A factor that an earlier run has made.

use super::{Cholesky, Kept, scale_of};
use crate::cache::{Cache, Key, Kind, Reader, Writer};
use crate::error::Result;
use crate::factor::multifrontal::Numbers;
use crate::factor::refined::Refined;
use crate::factor::{Analysis, Storage};
use crate::sparse::Pencil;

impl<'a> Cholesky<'a> {
    /// The factor that [`Cholesky::kept`] makes, or the one that it made in an earlier run under a key, to the same bits.
    ///
    /// # Errors
    /// As [`Cholesky::kept`].
    pub(crate) fn recalled(
        (cache, key): (&Cache, &Key),
        analysis: &'a Analysis,
        (pencil, sigma): (Pencil<'a>, f64),
        storage: Storage,
        name: &dyn Fn(usize) -> String,
    ) -> Result<Self> {
        let read = |from: &mut Reader<'_>| Self::read(from, analysis, (pencil, sigma), storage);
        let make = || Self::kept(analysis, (pencil, sigma), storage, name);
        cache.recall((Kind::Factor, key), read, make, Self::write)
    }

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        to.array(&[self.smallest_pivot_ratio])?;
        match &self.kept {
            Kept::Double(numbers) => numbers.write(to),
            Kept::Single(refined) => refined.numbers().write(to),
        }
    }

    fn read(
        from: &mut Reader<'_>,
        analysis: &'a Analysis,
        (pencil, sigma): (Pencil<'a>, f64),
        storage: Storage,
    ) -> Option<Self> {
        let smallest_pivot_ratio = from.number()?;
        let kept = match storage {
            Storage::Double => Kept::Double(Numbers::read(from, analysis)?),
            Storage::Single => {
                let numbers = Numbers::read(from, analysis)?;
                Kept::Single(Refined::new(analysis, (pencil, sigma), scale_of(pencil, sigma), numbers))
            }
        };
        Some(Self { analysis, kept, smallest_pivot_ratio })
    }
}
