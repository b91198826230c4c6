//! Full against reduced frequency response, and below it the error.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::chart::{BLUE, Drawn, FAINT, LETTER, Margins, ORANGE, PALE_BLUE, axes, draw, text};
use crate::verification::preservation::ResponseSample;

const HEIGHT: u32 = 980;
const UPPER: u32 = 560;

/// Two panels over one frequency axis.
pub(in crate::report::html) fn response(samples: &[ResponseSample]) -> Option<String> {
    let magnitudes = samples.iter().flat_map(|sample| [sample.full, sample.reduced]);
    let magnitude = Axis::decades("response of the worst pair", magnitudes)?;
    let error = Axis::decades("largest error over all pairs, dB", samples.iter().map(|sample| sample.error_db))?;
    let frequency = Axis::frequencies("frequency, Hz", samples.iter().map(|sample| sample.frequency_hz))?;
    let mut shared = frequency.clone();
    shared.title.clear();
    let line = |axis: &Axis, value: &dyn Fn(&ResponseSample) -> f64| -> Vec<(f64, f64)> {
        let shown = samples.iter().filter(|sample| sample.frequency_hz > 0.0 && value(sample).is_finite());
        shown.map(|sample| (frequency.place(sample.frequency_hz), axis.place(value(sample)))).collect()
    };
    draw(HEIGHT, |area| -> Drawn {
        let (upper, lower) = area.split_vertically(UPPER);
        let mut chart = axes(&upper, &shared, &magnitude, Margins::default())?;
        chart.draw_series(LineSeries::new(line(&magnitude, &|sample| sample.full), PALE_BLUE.stroke_width(9)))?;
        chart.draw_series(LineSeries::new(line(&magnitude, &|sample| sample.reduced), BLUE.stroke_width(3)))?;
        for (left, width, colour, words) in [(1000, 9, PALE_BLUE, "full"), (1150, 3, BLUE, "reduced")] {
            upper.draw(&PathElement::new([(left, 17), (left + 50, 17)], colour.stroke_width(width)))?;
            upper.draw(&Text::new(words, (left + 62, 4), text(LETTER, FAINT, HPos::Left, VPos::Top)))?;
        }
        let mut chart = axes(&lower, &frequency, &error, Margins::default())?;
        chart.draw_series(LineSeries::new(line(&error, &|sample| sample.error_db), ORANGE.stroke_width(3)))?;
        Ok(())
    })
}
