//! The frame that all drawings share: size, fonts, colours, axes.
//!
//! The canvas has twice the pixels of the printed width, because the backend rounds to whole ones.

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use crate::report::printable;
use crate::report::table;

/// Width of every drawing in pixels of the canvas.
pub(super) const WIDTH: u32 = 1440;

/// Height of letters: 12 px where the drawing is as wide as the text.
pub(super) const LETTER: u32 = 24;

/// Height of what is written below an axis.
pub(super) const X_LABELS: u32 = 76;

/// Letters that fit next to the end of a line.
const END_LABEL: usize = 17;

pub(super) const INK: RGBColor = RGBColor(26, 33, 41);
pub(super) const FAINT: RGBColor = RGBColor(85, 96, 107);
pub(super) const GRID: RGBColor = RGBColor(226, 231, 236);
pub(super) const BLUE: RGBColor = RGBColor(31, 95, 168);
pub(super) const PALE_BLUE: RGBColor = RGBColor(182, 204, 229);
pub(super) const ORANGE: RGBColor = RGBColor(176, 78, 11);

/// Colours of lines that stand next to each other: apart in lightness too, each readable as text on white.
pub(super) const SERIES: [RGBColor; 6] =
    [BLUE, ORANGE, RGBColor(22, 116, 64), RGBColor(122, 61, 158), RGBColor(12, 108, 128), RGBColor(125, 87, 0)];

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Chart<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<Axis, Axis>>;

/// What the backend says of a drawing; writing to a text cannot fail.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// The drawing as SVG.
pub(super) fn draw(height: u32, content: impl FnOnce(&Area<'_>) -> Drawn) -> Option<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
        content(&area).ok()?;
        area.present().ok()?;
    }
    Some(svg)
}

/// Room next to the axes, in pixels.
#[derive(Clone, Copy)]
pub(super) struct Margins {
    /// For the labels of the vertical axis.
    pub(super) left: u32,
    /// For what is written next to the ends of lines.
    pub(super) right: u32,
}

impl Default for Margins {
    fn default() -> Self {
        Self { left: 110, right: 30 }
    }
}

/// Axes with a grid; the title of the vertical one stands above it, where it can be read without turning the head.
pub(super) fn axes<'a, 'b>(
    area: &'b Area<'a>,
    x: &Axis,
    y: &Axis,
    margins: Margins,
) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
    area.draw(&Text::new(y.title.clone(), (0, 4), text(LETTER, FAINT, HPos::Left, VPos::Top)))?;
    let mut chart = ChartBuilder::on(area)
        .margin_top(48)
        .margin_right(margins.right)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(margins.left)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(1))
        .light_line_style(TRANSPARENT)
        .axis_style(FAINT.stroke_width(1))
        .label_style(("sans-serif", LETTER).into_font().color(&INK))
        .axis_desc_style(("sans-serif", LETTER).into_font().color(&FAINT))
        .x_desc(x.title.clone())
        .set_all_tick_mark_size(6)
        .draw()?;
    Ok(chart)
}

/// Style of a text that is placed by its own middle or end.
pub(super) fn text(size: u32, colour: RGBColor, across: HPos, along: VPos) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&colour).pos(Pos::new(across, along))
}

/// Writes what each line is next to its right end, moved apart where the ends meet.
pub(super) fn end_labels(
    area: &Area<'_>,
    chart: &Chart<'_, '_>,
    x_end: f64,
    labels: &[(f64, String, RGBColor)],
) -> Drawn {
    let mut order: Vec<usize> = (0..labels.len()).collect();
    let row = |idx: usize| chart.backend_coord(&(x_end, labels[idx].0)).1;
    order.sort_by_key(|idx| row(*idx));
    let (top, gap) = (chart.plotting_area().get_pixel_range().1.start, LETTER as i32 + 2);
    let bottom = chart.plotting_area().get_pixel_range().1.end;
    let mut rows: Vec<i32> = order.iter().map(|idx| row(*idx)).collect();
    for place in 0..rows.len() {
        let floor = if place == 0 { top } else { rows[place - 1] + gap };
        rows[place] = rows[place].max(floor);
    }
    let mut ceiling = bottom;
    for row in rows.iter_mut().rev() {
        *row = (*row).min(ceiling);
        ceiling = *row - gap;
    }
    let (left, upper) = area.get_base_pixel();
    for (idx, row) in order.into_iter().zip(rows) {
        let (_, words, colour) = &labels[idx];
        let x = chart.backend_coord(&(x_end, labels[idx].0)).0 + 14;
        let style = text(LETTER, *colour, HPos::Left, VPos::Center);
        area.draw(&Text::new(table::shorten(&printable(words), END_LABEL), (x - left, row - upper), style))?;
    }
    Ok(())
}
