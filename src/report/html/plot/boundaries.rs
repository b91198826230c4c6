//! Frequencies under other boundaries: how far the reduced model is off, over the frequency.

use plotters::prelude::*;

use super::axis::Axis;
use super::chart::{Drawn, FAINT, GRID, LETTER, Margins, SERIES, axes, draw, end_labels, text};
use crate::report::words;
use crate::verification::preservation::BoundaryComparison;
use plotters::style::text_anchor::{HPos, VPos};

/// One line for each boundary, named at its end; the shaded part lies beyond the band.
pub(in crate::report::html) fn boundaries(comparisons: &[BoundaryComparison]) -> Option<String> {
    let pairs = || comparisons.iter().flat_map(|comparison| &comparison.frequencies);
    let x = Axis::frequencies("frequency of the full model, Hz", pairs().map(|pair| pair.full_hz))?;
    let y = Axis::decades(
        "relative difference of the reduced frequency",
        pairs().map(|pair| pair.relative_difference.abs()),
    )?;
    let band = pairs().filter(|pair| pair.in_band).map(|pair| pair.full_hz).fold(0.0, f64::max);
    let beyond = pairs().filter(|pair| !pair.in_band).map(|pair| pair.full_hz).reduce(f64::min);
    draw(600, |area| -> Drawn {
        let mut chart = axes(area, &x, &y, Margins { right: 250, ..Margins::default() })?;
        if let Some(beyond) = beyond.filter(|_| band > 0.0) {
            let edge = x.place((band * beyond.max(band)).sqrt());
            chart.draw_series([Rectangle::new([(edge, y.low), (x.high, y.high)], GRID.mix(0.5).filled())])?;
            let style = text(LETTER, FAINT, HPos::Right, VPos::Top);
            let (right, _) = chart.backend_coord(&(x.high, y.high));
            area.draw(&Text::new("shaded: beyond the band", (right - area.get_base_pixel().0, 4), style))?;
        }
        let mut labels = Vec::new();
        for (series, comparison) in comparisons.iter().enumerate() {
            let colour = SERIES[series % SERIES.len()];
            let points: Vec<(f64, f64)> = comparison
                .frequencies
                .iter()
                .map(|pair| (x.place(pair.full_hz), y.place(pair.relative_difference.abs())))
                .collect();
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
            chart.draw_series(points.iter().map(|point| Circle::new(*point, 6, colour.filled())))?;
            labels.extend(points.last().map(|(_, end)| (*end, words::boundary(&comparison.boundary), colour)));
        }
        end_labels(area, &chart, x.high, &labels)
    })
}
