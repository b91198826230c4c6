//! How many modes would give which error.

use plotters::prelude::*;

use super::axis::Axis;
use super::chart::{BLUE, Chart, Drawn, Margins, ORANGE, axes, draw};
use crate::verification::preservation::SizeError;

const PANEL: u32 = 400;

/// One panel for the frequencies, one for the response where it is known.
pub(in crate::report::html) fn size_error(sizes: &[SizeError]) -> Option<String> {
    let x = Axis::whole("elastic modes kept", sizes.first()?.n_modes, sizes.last()?.n_modes);
    let frequencies: Vec<(usize, f64)> = sizes.iter().map(|size| (size.n_modes, size.frequency_error)).collect();
    let responses: Vec<(usize, f64)> =
        sizes.iter().filter_map(|size| Some((size.n_modes, size.response_error_db?))).collect();
    let axis = |title, points: &[(usize, f64)]| Axis::decades(title, points.iter().map(|(_, error)| *error));
    let frequency = axis("largest relative frequency error", &frequencies);
    let response = axis("largest response error, dB", &responses);
    let panels: Vec<_> = [(frequency, frequencies, BLUE), (response, responses, ORANGE)]
        .into_iter()
        .filter_map(|(axis, points, colour)| Some((axis?, points, colour)))
        .collect();
    if panels.is_empty() {
        return None;
    }
    draw(PANEL * panels.len() as u32, |area| -> Drawn {
        for (panel, (y, points, colour)) in area.split_evenly((panels.len(), 1)).iter().zip(&panels) {
            let mut chart = axes(panel, &x, y, Margins::default())?;
            points_joined(&mut chart, y, points, *colour)?;
        }
        Ok(())
    })
}

fn points_joined(chart: &mut Chart<'_, '_>, y: &Axis, points: &[(usize, f64)], colour: RGBColor) -> Drawn {
    let points: Vec<(f64, f64)> = points.iter().map(|(size, error)| (*size as f64, y.place(*error))).collect();
    chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(3)))?;
    chart.draw_series(points.into_iter().map(|point| Circle::new(point, 6, colour.filled())))?;
    Ok(())
}
