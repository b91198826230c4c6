//! Numbers and fields as Fortran writes them.

use super::fortran_format::NumberLine;

/// The longest number.
const MAX_NUMBER: usize = 64;

/// A real number: also one whose exponent is marked by D, or by its sign alone as in `1.5-101` and `7.-3`.
pub(super) fn real(field: &[u8]) -> Option<f64> {
    let field = field.trim_ascii();
    let field = field.strip_prefix(b"+").unwrap_or(field);
    fast_float2::parse(field).ok().or_else(|| marked(field))
}

fn marked(field: &[u8]) -> Option<f64> {
    if field.len() >= MAX_NUMBER {
        return None;
    }
    let mut number: Vec<u8> = field.iter().map(|&byte| if matches!(byte, b'd' | b'D') { b'e' } else { byte }).collect();
    let sign = number.iter().skip(1).position(|byte| matches!(byte, b'+' | b'-')).map(|at| at + 1);
    if let Some(at) = sign.filter(|_| !number.contains(&b'e') && !number.contains(&b'E')) {
        number.insert(at, b'e');
    }
    fast_float2::parse(&number).ok()
}

/// What the values of a file are declared to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Values {
    Real,
    /// Whole numbers, each of which has to be kept as it is.
    Whole,
}

impl Values {
    /// What a banner of Matrix Market says by its fourth word; none where these are no numbers that are read.
    pub(super) fn of_banner(field: &str) -> Option<Self> {
        match field {
            // Programs write names of types, too, and readers take them.
            "real" | "double" => Some(Self::Real),
            "integer" | "unsigned-integer" => Some(Self::Whole),
            _ => None,
        }
    }

    /// What a message expects of a value.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::Real => "a number",
            Self::Whole => "a number, which a double equals where it is whole, as it does all up to 2^53",
        }
    }

    /// The value of a field; none where it is no number, or is declared whole and no double equals it.
    pub(super) fn of_field(self, field: &[u8]) -> Option<f64> {
        self.checked(field, real(field)?)
    }

    /// The value of a field of a format, likewise.
    pub(super) fn of_format(self, field: &[u8], fields: Fields) -> Option<f64> {
        self.checked(field, fields.real(field)?)
    }

    fn checked(self, field: &[u8], value: f64) -> Option<f64> {
        (self == Self::Real || is_kept(field, value)).then_some(value)
    }
}

/// Whether a double is the number of its field, or that has a point or an exponent and is not whole as it stands there.
fn is_kept(field: &[u8], value: f64) -> bool {
    /// Up to here every whole number is a double.
    const ALL_WHOLE: f64 = 9_007_199_254_740_992.0;
    let field = field.trim_ascii();
    let digits = field.strip_prefix(b"-").or_else(|| field.strip_prefix(b"+")).unwrap_or(field);
    if value.abs() < ALL_WHOLE || !digits.iter().all(u8::is_ascii_digit) {
        return true;
    }
    let size: Option<u128> = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
    size.is_some_and(|size| value.abs() as u128 == size)
}

/// A whole number.
pub(super) fn whole(field: &[u8]) -> Option<i64> {
    std::str::from_utf8(field.trim_ascii()).ok()?.parse().ok()
}

/// How numbers fill the lines of a file: `(4E20.12)` is four in a line, of twenty characters each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fields {
    pub(super) per_line: usize,
    pub(super) width: usize,
    /// Blanks before the first field.
    pub(super) before: usize,
    /// Blanks between two fields.
    pub(super) between: usize,
    /// Digits behind the point of a number that is written without one; none in a format of whole numbers.
    pub(super) decimals: i32,
    /// Power of ten by which a number without an exponent is written too large.
    pub(super) scale: i32,
}

impl Fields {
    /// The fields of a format, with or without brackets and a scale.
    pub(super) fn of(format: &[u8]) -> Option<Self> {
        let NumberLine { per_line, first, pitch, edit, scale } = NumberLine::of(std::str::from_utf8(format).ok()?)?;
        let (width, decimals) = (edit.width, edit.decimals as i32);
        Some(Self { per_line, width, before: first, between: pitch - width, decimals, scale })
    }

    /// The column behind the first n fields of a line.
    pub(super) fn end(self, n: usize) -> usize {
        self.start(n.saturating_sub(1)) + self.width
    }

    fn start(self, at: usize) -> usize {
        self.before + at * (self.width + self.between)
    }

    /// The number in a field as Fortran reads it: without a point, the last digits before the exponent are decimals; without an
    /// exponent, the scale of the format counts.
    pub(super) fn real(self, field: &[u8]) -> Option<f64> {
        let field = field.trim_ascii();
        let is_mark = |(at, byte): (usize, &u8)| {
            matches!(byte, b'e' | b'E' | b'd' | b'D') || at > 0 && matches!(byte, b'+' | b'-')
        };
        let end = field.iter().enumerate().position(is_mark).unwrap_or(field.len());
        let (digits, exponent) = field.split_at(end);
        let is_number = digits.iter().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'+' | b'-'));
        let decimals = if digits.contains(&b'.') { 0 } else { self.decimals };
        let shift = decimals + if exponent.is_empty() { self.scale } else { 0 };
        if shift == 0 || !is_number {
            return real(field);
        }
        let exponent = match exponent {
            [] => 0,
            [b'+' | b'-', ..] => whole(exponent)?,
            [_, power @ ..] => whole(power)?,
        };
        let digits = std::str::from_utf8(digits).ok()?.trim_start_matches('+');
        fast_float2::parse(format!("{digits}e{}", exponent.checked_sub(shift.into())?)).ok()
    }

    /// The field at a place of a line; nothing beyond its end.
    pub(super) fn field(self, line: &[u8], at: usize) -> &[u8] {
        let start = self.start(at).min(line.len());
        &line[start..(start + self.width).min(line.len())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_in_every_dress() {
        for (text, value) in [
            ("1.5D+03", 1500.0),
            (" -1.5d-3 ", -0.0015),
            ("+2.5E2", 250.0),
            ("1.5-101", 1.5e-101),
            ("7.-3", 0.007),
            ("-7.+3", -7000.0),
            (".5", 0.5),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["", "-", "1.5-", "a", "1 2", "1-2-3"] {
            assert_eq!(real(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn whole_numbers_are_kept_or_refused() {
        let at_most = |text: &str| Values::Whole.of_field(text.as_bytes());
        for (text, value) in [
            ("9007199254740992", 9_007_199_254_740_992.0),
            ("-9007199254740994", -9_007_199_254_740_994.0),
            ("+36893488147419103232", 36_893_488_147_419_103_232.0),
            ("9007199254740993.0", 9_007_199_254_740_992.0),
            ("7", 7.0),
        ] {
            assert_eq!(at_most(text), Some(value), "{text}");
        }
        for text in ["9007199254740993", "-9007199254740993", "36893488147419103233", &"9".repeat(50), "x"] {
            assert_eq!(at_most(text), None, "{text}");
            assert_eq!(Values::Real.of_field(text.as_bytes()).is_some(), text != "x", "{text}");
        }
    }

    #[test]
    fn formats_of_lines() {
        for (text, per_line, width, decimals, scale) in [
            ("(16I5)", 16, 5, 0, 0),
            ("(8I6.4)", 8, 6, 0, 0),
            ("(4E20.12)", 4, 20, 12, 0),
            ("(1P,4D25.16)", 4, 25, 16, 1),
            ("(1P3E24.16E3)", 3, 24, 16, 1),
            ("1P,3E24.16", 3, 24, 16, 1),
            ("(-2P3F10.3)", 3, 10, 3, -2),
            ("(1I20)  ", 1, 20, 0, 0),
            ("(E25.17)", 1, 25, 17, 0),
            ("5e16.9", 5, 16, 9, 0),
            ("(3ES23.15)", 3, 23, 15, 0),
        ] {
            let fields = Fields { per_line, width, before: 0, between: 0, decimals, scale };
            assert_eq!(Fields::of(text.as_bytes()), Some(fields), "{text}");
        }
        for text in ["", "(A80)", "(0I5)", "(3E)", "(99999999999999999999I5)", "(2E999)"] {
            assert_eq!(Fields::of(text.as_bytes()), None, "{text}");
        }
    }

    /// Fortran 2018, 13.7.2.3: the last d digits are decimals where no point is there, and a scale counts without an exponent.
    #[test]
    fn numbers_without_a_point_or_an_exponent_are_those_of_fortran() {
        for (format, text, value) in [
            ("3F10.3", "      1500", 1.5),
            ("3F10.3", "     -1500", -1.5),
            ("3F10.3", "        +7", 0.007),
            ("3F10.3", "     1500.", 1500.0),
            ("3F10.0", "      1500", 1500.0),
            ("3E20.12", "1500", 1.5e-9),
            ("3E10.2", "15E3", 150.0),
            ("3D10.2", "15D3", 150.0),
            ("3E10.2", "15-3", 1.5e-4),
            ("3E10.2", "-15+3", -150.0),
            ("1P,3E25.16", "1.5", 0.15),
            ("1P,3E25.16", "1.5E+00", 1.5),
            ("-1P,3F10.1", "15", 15.0),
            ("2P3F10.3", "1500", 0.015),
        ] {
            let fields = Fields::of(format.as_bytes()).expect("a format");
            assert_eq!(fields.real(text.as_bytes()), Some(value), "{format} {text}");
        }
        let fields = Fields::of(b"3F10.3").expect("a format");
        for text in ["", "-", "+", "1 2", "x", "1e", "--1", "+-1"] {
            assert_eq!(fields.real(text.as_bytes()), None, "{text}");
        }
    }
}
