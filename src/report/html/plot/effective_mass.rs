//! Effective mass, summed from the first mode on, for each rigid direction.

use plotters::prelude::*;

use super::axis::Axis;
use super::chart::{Drawn, Margins, SERIES, axes, draw, end_labels};
use crate::report::EffectiveMass;

/// One stepped line for each direction, named at its end.
pub(in crate::report::html) fn effective_mass(modes: &[EffectiveMass], directions: &[String]) -> Option<String> {
    let (first, last) = (modes.first()?, modes.last()?);
    let highest = modes.iter().flat_map(|mode| mode.cumulated.iter().copied()).fold(1.0, f64::max);
    let x = Axis::whole("modes, summed from the first", first.mode, last.mode);
    let y = Axis::linear("share of the total", 0.0, highest);
    draw(560, |area| -> Drawn {
        let mut chart = axes(area, &x, &y, Margins { right: 250, ..Margins::default() })?;
        let mut labels = Vec::new();
        for (direction, end) in last.cumulated.iter().enumerate() {
            let colour = SERIES[direction % SERIES.len()];
            let mut height = 0.0;
            let mut steps = vec![(x.place(first.mode as f64 - 0.5), 0.0)];
            for mode in modes {
                let at = mode.mode as f64 - 0.5;
                steps.push((x.place(at), y.place(height)));
                height = mode.cumulated.get(direction).copied().unwrap_or(height);
                steps.push((x.place(at), y.place(height)));
            }
            steps.push((x.high, y.place(height)));
            chart.draw_series(LineSeries::new(steps, colour.stroke_width(3)))?;
            let name = directions.get(direction).cloned().unwrap_or_else(|| format!("direction {}", direction + 1));
            labels.push((y.place(*end), name, colour));
        }
        end_labels(area, &chart, x.high, &labels)
    })
}
