//! Frequency of each mode: its error bar, and what the reduced model makes of it.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::chart::{Drawn, FAINT, INK, LETTER, Margins, PALE_BLUE, axes, draw, text};
use crate::report::ModeRow;
use crate::verification::preservation::PreservedMode;

/// Bars for what cannot be told from rounding and data, dots for the difference of reduced and full; both relative.
pub(in crate::report::html) fn frequency_error(modes: &[ModeRow], preserved: &[PreservedMode]) -> Option<String> {
    let bar = |mode: &ModeRow| mode.error_bar_hz / mode.frequency_hz;
    let values = modes.iter().map(bar).chain(preserved.iter().map(|mode| mode.relative_difference));
    // One decade of room below: the bars need a foot to stand on, and differences of exactly zero a place.
    let values: Vec<f64> = values.filter(|value| value.is_finite() && *value > 0.0).collect();
    let foot = values.iter().copied().reduce(f64::min).map(|least| least / 10.0);
    let y = Axis::decades("relative to the frequency", values.into_iter().chain(foot))?;
    let (first, last) = (modes.first()?.index, modes.last()?.index);
    let x = Axis::whole("mode", first, last.max(first));
    let half = (0.35_f64).min(0.35 * 40.0 / modes.len().max(1) as f64).max(0.2);
    draw(520, |area| -> Drawn {
        let mut chart = axes(area, &x, &y, Margins::default())?;
        chart.draw_series(modes.iter().map(|mode| {
            let at = mode.index as f64;
            Rectangle::new([(at - half, y.low), (at + half, y.place(bar(mode)))], PALE_BLUE.filled())
        }))?;
        let radius = if modes.len() > 120 { 4 } else { 7 };
        chart.draw_series(
            preserved
                .iter()
                .map(|mode| Circle::new((mode.index as f64, y.place(mode.relative_difference)), radius, INK.filled())),
        )?;
        area.draw(&Rectangle::new([(906, 8), (930, 24)], PALE_BLUE.filled()))?;
        area.draw(&Text::new("error bar", (940, 4), text(LETTER, FAINT, HPos::Left, VPos::Top)))?;
        if !preserved.is_empty() {
            area.draw(&Circle::new((1086, 16), 7, INK.filled()))?;
            area.draw(&Text::new("reduced against full", (1102, 4), text(LETTER, FAINT, HPos::Left, VPos::Top)))?;
        }
        Ok(())
    })
}
