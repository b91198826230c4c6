//! Modes in an entry of a cache.

use super::modes::{ElasticCount, Modes};
use super::problem::EigenWork;
use super::quality::ModeError;
use crate::cache::{Kind, Reader, Recorded, Writer};
use crate::factor::InertiaCount;

impl Recorded for Modes {
    const KIND: Kind = Kind::Modes;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { lambda, shapes, errors, searched_to, next, counts, work } = self;
        to.array(lambda)?;
        to.columns(shapes.as_ref())?;
        to.array(&errors.iter().flat_map(ModeError::numbers).collect::<Vec<f64>>())?;
        to.array(searched_to.as_slice())?;
        to.array(next.as_slice())?;
        to.counts(&counts.iter().map(|count| count.n_elastic).collect::<Vec<usize>>())?;
        counts.iter().try_for_each(|count| count.inertia.write(to))?;
        let EigenWork { solves, steps, restarts, factorisations } = *work;
        to.counts(&[solves, steps, restarts, factorisations])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let lambda: Vec<f64> = from.array()?;
        let shapes = from.columns()?;
        let errors: Vec<f64> = from.array()?;
        let (errors, rest) = errors.as_chunks();
        let errors: Vec<ModeError> = errors.iter().map(ModeError::of_numbers).collect();
        if !rest.is_empty() || [shapes.ncols(), errors.len()] != [lambda.len(); 2] {
            return None;
        }
        let searched_to = from.at_most_one()?;
        let next = from.at_most_one()?;
        let counted = from.counts()?.into_iter();
        let counted = counted.map(|n_elastic| Some(ElasticCount { inertia: InertiaCount::read(from)?, n_elastic }));
        let counts: Vec<ElasticCount> = counted.collect::<Option<_>>()?;
        let [solves, steps, restarts, factorisations] = from.counts()?[..] else { return None };
        let work = EigenWork { solves, steps, restarts, factorisations };
        Some(Self { lambda, shapes, errors, searched_to, next, counts, work })
    }
}

impl ModeError {
    /// Its numbers, in an order of their own.
    pub(crate) fn numbers(&self) -> [f64; 8] {
        let Self { backward, of_terms, cancellation, relative_bar, data_bar, residual_bar, rounding_floor, zero_level } =
            *self;
        [backward, of_terms, cancellation, relative_bar, data_bar, residual_bar, rounding_floor, zero_level]
    }

    /// The one that has such numbers.
    pub(crate) fn of_numbers(numbers: &[f64; 8]) -> Self {
        let [backward, of_terms, cancellation, relative_bar, data_bar, residual_bar, rounding_floor, zero_level] =
            *numbers;
        Self { backward, of_terms, cancellation, relative_bar, data_bar, residual_bar, rounding_floor, zero_level }
    }
}
