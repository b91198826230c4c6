//! Numbers as people write them.

/// `123,486`.
pub(crate) fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `1 body`, `2 bodies`: every number with a noun in a message is written by this. A verb goes with its noun, as in `1 row has`.
pub(crate) fn counted(number: impl TryInto<u64>, one: &str, many: &str) -> String {
    let number = number.try_into().unwrap_or(u64::MAX);
    format!("{} {}", count(number), if number == 1 { one } else { many })
}

/// `4 decimals`, or `multiples of 1e2` where numbers end before the point.
pub(crate) fn decimals(count: i32) -> String {
    if count < 0 { format!("multiples of 1e{}", -count) } else { counted(count, "decimal", "decimals") }
}

/// A quantity with about `digits` significant digits, in plain notation where that is short.
pub(crate) fn quantity(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let decade = decade(value);
    if !value.is_finite() || !(-3..6).contains(&decade) {
        return scientific(value, digits);
    }
    let decimals = usize::try_from(digits as i32 - 1 - decade).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A number as a person would type it: `0.25`, and `1e300` rather than three hundred zeros.
pub(crate) fn typed(value: f64) -> String {
    let (plain, power) = (format!("{value}"), format!("{value:e}"));
    if plain.len() <= power.len().max(9) { plain } else { power }
}

/// `1.2e-09` with the exponent's sign and two digits, so that columns align.
pub(crate) fn scientific(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "NaN".to_owned();
    }
    // JSON has no infinity: the largest number stands for it.
    if value.abs() >= f64::MAX {
        return if value > 0.0 { "∞".to_owned() } else { "-∞".to_owned() };
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let (sign, size) = exponent.strip_prefix('-').map_or(('+', exponent), |size| ('-', size));
            format!("{mantissa}e{sign}{size:0>2}")
        }
        None => text,
    }
}

/// A positive limit with `digits` significant digits, rounded towards zero: what is below it as it is printed is below it.
pub(crate) fn no_more_than(value: f64, digits: usize) -> f64 {
    let rounded = |value: f64| format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    let nearest = rounded(value);
    if nearest <= value { nearest } else { rounded(nearest - 10.0f64.powi(decade(value) + 1 - digits as i32)) }
}

/// A positive bound with `digits` significant digits, rounded away from zero: what is above it as it is printed is above it. What is no
/// number stays what it is.
pub(crate) fn no_less_than(value: f64, digits: usize) -> f64 {
    let below = no_more_than(value, digits);
    if below >= value || !value.is_normal() {
        return value;
    }
    no_more_than(below + 1.5 * 10.0f64.powi(decade(below) + 1 - digits as i32), digits)
}

/// Powers of 1024 with three digits: `41.2 MiB`.
pub(crate) fn bytes(size: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    let mut value = size as f64;
    let mut unit = "bytes";
    for larger in UNITS {
        if value < 1000.0 {
            break;
        }
        value /= 1024.0;
        unit = larger;
    }
    let noun = if size == 1 { "byte" } else { "bytes" };
    if unit == "bytes" { format!("{size} {noun}") } else { format!("{} {unit}", quantity(value, 3)) }
}

/// `0.012 s`, `1.24 s`, `2 min 05 s`.
pub(crate) fn duration(seconds: f64) -> String {
    if seconds < 120.0 {
        let decimals = if seconds < 1.0 {
            3
        } else if seconds < 10.0 {
            2
        } else {
            1
        };
        return format!("{seconds:.decimals$} s");
    }
    let whole = seconds.round() as u64;
    format!("{} min {:02} s", whole / 60, whole % 60)
}

/// The power of ten of the leading digit.
pub(crate) fn decade(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() { 0 } else { value.abs().log10().floor() as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_rounded_outwards() {
        for (value, digits, below, above) in [
            (1.0, 2, 1.0, 1.0),
            (1.01, 2, 1.0, 1.1),
            (9.96, 2, 9.9, 10.0),
            (0.0123, 2, 0.012, 0.013),
            (9.99e-7, 1, 9e-7, 1e-6),
        ] {
            let found = [no_more_than(value, digits), no_less_than(value, digits)];
            assert!(
                (found[0] / below - 1.0).abs() < 1e-15 && (found[1] / above - 1.0).abs() < 1e-15,
                "{value}: {found:?}"
            );
        }
        assert_eq!(no_less_than(0.0, 2), 0.0);
        assert!(no_less_than(f64::NAN, 2).is_nan() && no_less_than(f64::INFINITY, 2).is_infinite());
    }

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(count(0), "0");
        assert_eq!(count(1234), "1,234");
        assert_eq!(count(123_486), "123,486");
        assert_eq!(quantity(41.2, 6), "41.2");
        assert_eq!(quantity(1.234e-3, 6), "0.001234");
        assert_eq!(quantity(-2.5e-9, 3), "-2.50e-09");
        assert_eq!([0.25, -5.0, 1e300, 1e-9].map(typed), ["0.25", "-5", "1e300", "1e-9"]);
        assert_eq!([4.981e-5, 5e-5, 9.96e-5, 1.0].map(|value| no_more_than(value, 2)), [4.9e-5, 5e-5, 9.9e-5, 1.0]);
        assert_eq!(scientific(1.25e-13, 2), "1.2e-13");
        assert_eq!(scientific(f64::INFINITY, 2), "∞");
        assert_eq!(bytes(999), "999 bytes");
        assert_eq!(bytes(43_200_000), "41.2 MiB");
        assert_eq!(duration(125.4), "2 min 05 s");
    }
}
