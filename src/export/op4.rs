//! Nastran OUTPUT4 as text, `FORM=FORMATTED`: dense columns, seventeen digits.
//!
//! ```text
//! columns rows form type NAME    1P,3E24.16      widths 8, the name's too
//! column  first-row  number of values            widths 8; then the values, three a line
//! columns + 1   1   1                            after the last column, with one value
//! ```
//! The record of a column without entries is left out. Fields of 24 characters hold a sign, seventeen digits and an exponent of
//! three digits: with the usual 23 Fortran drops the letter E of such numbers.

use std::fmt::Write as _;

use supel_runtime::Superelement;

use super::format::{ExportedFile, Format};
use super::names::Names;
use super::op4_content::{LAST, Named, REAL_DOUBLE, content, matrices};
use crate::error::Result;

/// OUTPUT4 as text.
#[derive(Debug)]
pub(super) struct Op4;

impl Format for Op4 {
    fn name(&self) -> &'static str {
        "op4"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["op4"]
    }

    fn files(&self, superelement: &Superelement, _: &Names) -> Result<Vec<ExportedFile>> {
        let matrices = matrices(superelement)?;
        let text: String = matrices.iter().map(text).collect();
        Ok(vec![ExportedFile::text("op4", &content(&matrices), text)])
    }
}

/// Values in a line.
const PER_LINE: usize = 3;

fn text(named: &Named) -> String {
    let Named { name, form, matrix } = named;
    let (rows, columns) = (matrix.rows(), matrix.cols());
    let mut text = format!("{columns:8}{rows:8}{:8}{REAL_DOUBLE:8}{name:8}1P,{PER_LINE}E24.16\n", *form as usize);
    for (column, first, values) in named.columns() {
        put(&mut text, [column, first], &values);
    }
    put(&mut text, [columns + 1, 1], &[LAST]);
    text
}

fn put(text: &mut String, [column, first]: [usize; 2], values: &[f64]) {
    let _ = writeln!(text, "{column:8}{first:8}{:8}", values.len());
    for line in values.chunks(PER_LINE) {
        let line: String = line.iter().map(|value| format!("{:>24}", number(*value))).collect();
        let _ = writeln!(text, "{line}");
    }
}

/// As Fortran writes it: a sign and two digits at least in the exponent.
fn number(value: f64) -> String {
    let text = format!("{value:.16e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = exponent.strip_prefix('-').map_or(('+', exponent), |exponent| ('-', exponent));
    format!("{digits}E{sign}{exponent:0>2}")
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_fit_their_fields_and_come_back() {
        for value in [0.1, -1.0 / 3.0, f64::MIN_POSITIVE, -f64::MAX, 5e-324, 0.0, 1e10] {
            let text = number(value);
            assert!(text.len() <= 24, "{text}");
            assert_eq!(text.parse::<f64>().expect("a number").to_bits(), value.to_bits());
        }
        assert_eq!(number(-0.5), "-5.0000000000000000E-01");
        assert!(number(-1e-300).contains("E-3"), "{}", number(-1e-300));
        assert_eq!(number(12.0), "1.2000000000000000E+01");
    }
}
