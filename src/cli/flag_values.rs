//! Values of flags that are those of a key of the job.

use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, Resettable, TypedValueParser};

/// The values of an enum of the job, without the descriptions that its schema has.
pub(super) fn values<T: ValueEnum + Clone + Send + Sync + 'static>() -> impl TypedValueParser<Value = T> {
    let names = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
    PossibleValuesParser::new(names.map(|name| name.help(Resettable::Reset))).try_map(|name| T::from_str(&name, false))
}
