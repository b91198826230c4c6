//! One row for each retained mode.

use super::markup::{Cell, Markup, Table};
use crate::number::{decade, scientific};
use crate::report::ModeRow;
use crate::verification::preservation::PreservedMode;

/// Significant digits of the highest frequency.
const DIGITS: i32 = 9;

pub(super) fn mode_table(page: &mut Markup, modes: &[ModeRow], preserved: &[PreservedMode]) {
    let highest = modes.iter().map(|mode| mode.frequency_hz).fold(0.0, f64::max);
    let decimals = usize::try_from(DIGITS - 1 - decade(highest)).unwrap_or(0).min(9);
    let is_enclosed = modes.iter().any(|mode| mode.enclosure_hz.is_some());
    let mut heads = vec!["mode", "frequency, Hz", "± Hz"];
    if is_enclosed {
        heads.extend(["proved above, Hz", "proved below, Hz"]);
    }
    heads.extend(["contribution", "rank", "backward error"]);
    if !preserved.is_empty() {
        heads.extend(["reduced, Hz", "difference", "MAC"]);
    }
    let rows = modes.iter().map(|mode| {
        let hertz = |frequency: f64| Cell::Number(format!("{frequency:.decimals$}"));
        let none = || Cell::Number("–".to_owned());
        let mut cells = vec![
            Cell::Head(mode.index.to_string()),
            hertz(mode.frequency_hz),
            Cell::Number(scientific(mode.error_bar_hz, 2)),
        ];
        if is_enclosed {
            match mode.enclosure_hz {
                Some([low, high]) => cells.extend([hertz_down(low, decimals), hertz_up(high, decimals)]),
                None => cells.extend([none(), none()]),
            }
        }
        cells.extend([
            Cell::Number(scientific(mode.coupling, 2)),
            Cell::Number(mode.rank.to_string()),
            Cell::Number(scientific(mode.backward_error, 2)),
        ]);
        if !preserved.is_empty() {
            match preserved.iter().find(|other| other.index == mode.index) {
                Some(other) => cells.extend([
                    hertz(other.reduced_hz),
                    Cell::Number(scientific(other.relative_difference, 2)),
                    Cell::Number(mac(other.mac)),
                ]),
                None => cells.extend([none(), none(), none()]),
            }
        }
        cells
    });
    let mut caption =
        "Retained modes: natural frequency of the full model with its error bar, what the mode contributes at the \
                       interface, to outputs and under loads with its place in that order, and the backward error of the \
                       mode in the full model"
            .to_owned();
    if is_enclosed {
        caption += "; bounds between which an exact frequency is proved to lie, rounded outwards";
    }
    if !preserved.is_empty() {
        caption += "; frequency of the reduced model under the same boundary, its relative difference, and the agreement \
                    of the shapes";
    }
    let heads = heads.into_iter().map(str::to_owned).collect();
    page.table(&Table { id: "table-modes".to_owned(), caption: caption + ".", heads, rows: rows.collect() });
}

/// A bound must not move inwards by being written down.
fn hertz_down(frequency: f64, decimals: usize) -> Cell {
    let unit = 10.0_f64.powi(decimals as i32);
    Cell::Number(format!("{:.decimals$}", (frequency * unit).floor() / unit))
}

fn hertz_up(frequency: f64, decimals: usize) -> Cell {
    let unit = 10.0_f64.powi(decimals as i32);
    Cell::Number(format!("{:.decimals$}", (frequency * unit).ceil() / unit))
}

/// As the distance from one where that is small: all digits of 0.999999… say less.
pub(super) fn mac(mac: f64) -> String {
    match 1.0 - mac {
        distance if distance <= 0.0 => "1".to_owned(),
        distance if distance < 1e-3 => format!("1 − {}", scientific(distance, 1)),
        _ => format!("{mac:.4}"),
    }
}
