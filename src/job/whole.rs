//! Whole numbers of a job: `3` and `3.0` are the same number, as the schema of a job says and programs that know one kind of number write.

use serde::{Deserialize, Deserializer, de};

/// A whole number, with a point or without.
struct Whole(i64);

/// The whole number that a real one is, where every whole number near it is one of a double.
pub(super) fn of_real(value: f64) -> Option<i64> {
    /// 2^53.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    (value.fract() == 0.0 && value.abs() <= LARGEST).then_some(value as i64)
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WholeVisitor)
    }
}

struct WholeVisitor;

impl de::Visitor<'_> for WholeVisitor {
    type Value = Whole;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a whole number")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Whole, E> {
        Ok(Whole(value))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Whole, E> {
        i64::try_from(value).map(Whole).map_err(|_| E::custom(format!("{value} is too large, expected a whole number")))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Whole, E> {
        of_real(value).map(Whole).ok_or_else(|| E::custom(format!("{value} is no whole number")))
    }
}

fn not_negative<E: de::Error>(Whole(value): Whole) -> Result<usize, E> {
    usize::try_from(value).map_err(|_| E::custom(format!("{value} is below zero")))
}

/// A number of things.
pub(super) fn size<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<usize>, D::Error> {
    Option::<Whole>::deserialize(deserializer)?.map(not_negative).transpose()
}

/// Numbers of things.
pub(super) fn sizes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<usize>>, D::Error> {
    let wholes = Option::<Vec<Whole>>::deserialize(deserializer)?;
    wholes.map(|wholes| wholes.into_iter().map(not_negative).collect()).transpose()
}

/// A label.
pub(super) fn label<'de, D: Deserializer<'de>>(deserializer: D) -> Result<i64, D::Error> {
    Whole::deserialize(deserializer).map(|Whole(value)| value)
}

/// Labels.
pub(super) fn labels<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<i64>, D::Error> {
    Ok(Vec::<Whole>::deserialize(deserializer)?.into_iter().map(|Whole(value)| value).collect())
}
