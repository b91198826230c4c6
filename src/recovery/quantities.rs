//! Quantities that follow from displacements: R T Ψ q.

use std::fmt::Write;

use supel_runtime::{Matrix, Quantity};

use super::product::times;
use super::sheet::{Sheet, end_row};
use super::state::{Order, State};
use crate::report::field;

/// Quantities of a file, a row for each.
pub struct Quantities<'a> {
    names: &'a [Quantity],
    rows: &'a Matrix,
}

impl<'a> Quantities<'a> {
    /// By the rows of a file, m × r, and what each is.
    pub fn new(names: &'a [Quantity], rows: &'a Matrix) -> Self {
        Self { names, rows }
    }
}

impl Sheet for Quantities<'_> {
    fn columns(&self, _: &[Order]) -> Vec<&'static str> {
        vec!["quantity", "unit", "value"]
    }

    fn rows(&self, state: &State, start: &str, text: &mut String) -> Result<(), String> {
        let q = state.of(Order::Displacement).unwrap_or_default();
        for (i, Quantity { name, unit }) in self.names.iter().enumerate() {
            let _ = write!(text, "{start}{},{}", field(name), field(unit));
            end_row(text, &[times(self.rows, i, q)], || format!("`{name}`"))?;
        }
        Ok(())
    }
}
