//! The modal assurance criterion as a map.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::chart::{Drawn, FAINT, INK, LETTER, Margins, X_LABELS, axes, draw, text};

/// Values below this are left white: they would only fill the page with drawings of nothing.
const SHOWN_FROM: f64 = 0.005;

/// Up to here each cell is large enough for its number.
const NUMBERED: usize = 14;

/// Of the drawing, in pixels.
const HEIGHT: u32 = 1000;

/// The scale at the side, in steps.
const STEPS: u32 = 10;

/// Rows are modes of the full model, columns those of the reduced one; dark is alike.
pub(in crate::report::html) fn mac(mac: &[Vec<f64>]) -> Option<String> {
    let (n_rows, n_columns) = (mac.len(), mac.first()?.len());
    if n_columns == 0 {
        return None;
    }
    let x = Axis::whole("mode of the reduced model", 1, n_columns);
    // Drawn downwards as a matrix is written: row numbers are negative heights.
    let mut y = Axis::whole("mode of the full model", 1, n_rows);
    (y.low, y.high) = (-y.high, -y.low);
    y.ticks.iter_mut().for_each(|(at, _)| *at = -*at);
    y.ticks.reverse();
    draw(HEIGHT, |area| -> Drawn {
        // As wide as high.
        let mut chart = axes(area, &x, &y, Margins { left: 110, right: WIDTH_LEFT_FREE })?;
        let cells = mac.iter().enumerate().flat_map(|(row, values)| {
            values.iter().enumerate().map(move |(column, value)| (row + 1, column + 1, *value))
        });
        let cells = cells.filter(|(_, _, value)| *value >= SHOWN_FROM);
        chart.draw_series(cells.clone().map(|(row, column, value)| {
            let (x, y) = (column as f64, -(row as f64));
            Rectangle::new([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], shade(value).filled())
        }))?;
        if n_rows.max(n_columns) <= NUMBERED {
            chart.draw_series(cells.map(|(row, column, value)| {
                let colour = if value > 0.5 { WHITE } else { INK };
                let style = text(LETTER, colour, HPos::Center, VPos::Center);
                Text::new(rounded_down(value), (column as f64, -(row as f64)), style)
            }))?;
        }
        scale(area)
    })
}

/// What is left at the right of the square for the scale.
const WIDTH_LEFT_FREE: u32 = 1440 - 110 - (HEIGHT - 48 - X_LABELS);

fn scale(area: &super::chart::Area<'_>) -> Drawn {
    let (left, top, step) = (1060, 120, 44);
    area.draw(&Text::new("MAC", (left, top - 44), text(LETTER, FAINT, HPos::Left, VPos::Top)))?;
    for place in 0..STEPS as i32 {
        let value = 1.0 - (f64::from(place) + 0.5) / f64::from(STEPS);
        let upper = top + place * step;
        area.draw(&Rectangle::new([(left, upper), (left + 40, upper + step)], shade(value).filled()))?;
    }
    for (value, share) in [("1", 0), ("0.5", 5), ("0", 10)] {
        let style = text(LETTER, INK, HPos::Left, VPos::Center);
        area.draw(&Text::new(value, (left + 54, top + share * step), style))?;
    }
    Ok(())
}

/// 0.996 must not be written as 1.00.
fn rounded_down(value: f64) -> String {
    if value >= 1.0 - 5e-7 { "1".to_owned() } else { format!("{:.2}", (value * 100.0).floor() / 100.0) }
}

/// From white to dark blue.
fn shade(value: f64) -> RGBColor {
    let mix = |white: f64, dark: f64| (white + (dark - white) * value.clamp(0.0, 1.0)).round() as u8;
    RGBColor(mix(255.0, 20.0), mix(255.0, 66.0), mix(255.0, 124.0))
}
