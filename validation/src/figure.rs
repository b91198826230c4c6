//! The figures of the paper as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::Result;
use crate::curve::Curves;
use crate::examples::Example;

/// One figure of the paper, drawn once for each kind of measures.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Number in the paper.
    pub number: &'static str,
    /// The example.
    pub example: Example,
    /// Column of the curves, from 0 after the time, and what it is.
    pub quantity: (usize, &'static str),
    /// Layouts and modes that are drawn.
    pub models: &'static [(usize, usize)],
    /// Windows of the horizontal axis and the range shown in each.
    pub windows: &'static [([f64; 2], [f64; 2])],
}

const BEND: [(usize, usize); 3] = [(1, 0), (2, 0), (4, 0)];
const LOADS: [f64; 2] = [0.0, 1000.0];

/// Every figure of curves in section 5.
pub const FIGURES: [Figure; 9] = [
    Figure {
        number: "4",
        example: Example::Bend,
        quantity: (2, "tip displacement out of the plane, m"),
        models: &BEND,
        windows: &[(LOADS, [0.0, 80.0])],
    },
    Figure {
        number: "5",
        example: Example::Bend,
        quantity: (0, "tip displacement in the plane (x), m"),
        models: &BEND,
        windows: &[(LOADS, [-40.0, 0.0])],
    },
    Figure {
        number: "6",
        example: Example::Rotating,
        quantity: (0, "transverse tip displacement, m"),
        models: &[(1, 0), (1, 3)],
        windows: &[([0.0, 20.0], [-0.65, 0.05])],
    },
    Figure {
        number: "7",
        example: Example::Rotating,
        quantity: (1, "axial tip displacement, m"),
        models: &[(1, 0), (1, 3)],
        windows: &[([0.0, 20.0], [-0.028, 0.002])],
    },
    Figure {
        number: "9",
        example: Example::Spherical,
        quantity: (0, "root angular velocity, rad/s"),
        models: &[(1, 0), (1, 6), (1, 12)],
        windows: &[([0.0, 50.0], [-0.06, 0.1]), ([17.5, 18.5], [0.022, 0.036]), ([45.5, 46.5], [-0.02, 0.08])],
    },
    Figure {
        number: "11",
        example: Example::Crank,
        quantity: (0, "transverse displacement of M, m"),
        models: &[(2, 0), (2, 3)],
        windows: &[([0.0, 10.0], [-1.0, 1.0])],
    },
    Figure {
        number: "12",
        example: Example::Crank,
        quantity: (1, "transverse displacement of N, m"),
        models: &[(2, 0), (2, 3)],
        windows: &[([0.0, 10.0], [-0.8, 0.6])],
    },
    Figure {
        number: "14",
        example: Example::Elbow,
        quantity: (0, "tip displacement out of the plane, m"),
        models: &[(1, 0), (2, 0), (3, 0)],
        windows: &[([0.0, 30.0], [-10.5, 10.5])],
    },
    Figure {
        number: "15",
        example: Example::Elbow,
        quantity: (0, "tip displacement out of the plane, m"),
        models: &[(1, 6), (2, 6), (3, 6)],
        windows: &[([0.0, 30.0], [-10.5, 10.5])],
    },
];

/// A curve with its name.
#[derive(Clone, Debug)]
pub struct Line {
    /// What it is.
    pub label: String,
    /// Where it is.
    pub points: Vec<(f64, f64)>,
}

impl Line {
    /// A column of curves.
    pub fn of(label: &str, curves: &Curves, column: usize) -> Self {
        let points = curves.times.iter().copied().zip(curves.column(column)).collect();
        Self { label: label.to_owned(), points }
    }
}

/// In half points of a drawing 1200 wide: the backend rounds to whole numbers, which steps would show.
const WIDTH: u32 = 2400;
const HEIGHT: u32 = 1200;
const LETTER: u32 = 44;
const INK: RGBColor = RGBColor(26, 33, 41);
const GRID: RGBColor = RGBColor(226, 231, 236);
/// Colour and width: the reference first, then the variants; apart in lightness too, and narrower one after the other, so that
/// a line stays visible where the next one hides it.
const STYLES: [(RGBColor, u32); 4] =
    [(INK, 14), (RGBColor(31, 95, 168), 8), (RGBColor(196, 90, 16), 5), (RGBColor(22, 136, 74), 3)];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The lines in each window, one above the other, under one legend; the first line is the reference.
///
/// # Errors
/// The backend refuses.
pub fn drawn(figure: &Figure, lines: &[Line]) -> Result<String> {
    let mut svg = String::new();
    {
        let panels = figure.windows.len();
        let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT * panels as u32)).into_drawing_area();
        for (panel, window) in area.split_evenly((panels, 1)).iter().zip(figure.windows) {
            panel_of(panel, figure, lines, window).map_err(|error| error.to_string())?;
        }
        legend(&area, lines).map_err(|error| error.to_string())?;
        area.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}

type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

fn panel_of(area: &Area<'_>, figure: &Figure, lines: &[Line], (x, y): &([f64; 2], [f64; 2])) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .margin_top(176)
        .margin_right(60)
        .x_label_area_size(128)
        .y_label_area_size(220)
        .build_cartesian_2d(x[0]..x[1], y[0]..y[1])?;
    let decimals = if y[1] - y[0] > 5.0 { 0 } else { (1.5 - (y[1] - y[0]).log10()).ceil() as usize };
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(2))
        .light_line_style(TRANSPARENT)
        .axis_style(INK.stroke_width(2))
        .set_all_tick_mark_size(10)
        .label_style(("sans-serif", LETTER).into_font().color(&INK))
        .x_label_formatter(&|value| format!("{value}"))
        // Without the sign of a rounded zero.
        .y_label_formatter(&|value| format!("{:.decimals$}", if value.abs() < 1e-9 { 0.0 } else { *value }))
        .x_desc(if figure.example == Example::Bend { "load, N" } else { "time, s" })
        .draw()?;
    for (line, (colour, width)) in lines.iter().zip(STYLES) {
        for run in within(&line.points, *x, *y) {
            chart.draw_series(LineSeries::new(run, colour.stroke_width(width)))?;
        }
    }
    area.draw(&Text::new(figure.quantity.1, (0, 8), words()))
}

/// The runs of a line inside a window, up to its border.
fn within(points: &[(f64, f64)], x: [f64; 2], y: [f64; 2]) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    for (a, b) in points.iter().zip(points.iter().skip(1)) {
        let step = (b.0 - a.0, b.1 - a.1);
        // Shares of the step at which it crosses two borders; along a border it is inside or not.
        let share = |start: f64, step: f64, [low, high]: [f64; 2]| {
            let ends = [(low - start) / step, (high - start) / step];
            let inside = if (low..=high).contains(&start) { [0.0, 1.0] } else { [1.0, 0.0] };
            if step == 0.0 { inside } else { [ends[0].min(ends[1]), ends[0].max(ends[1])] }
        };
        let (across, along) = (share(a.0, step.0, x), share(a.1, step.1, y));
        let (first, last) = (across[0].max(along[0]).max(0.0), across[1].min(along[1]).min(1.0));
        let place = |share: f64| if share == 1.0 { *b } else { (a.0 + share * step.0, a.1 + share * step.1) };
        // A line ends where it leaves the window, and before what is no number.
        if first < last && (step.0 + step.1).is_finite() {
            match runs.last_mut().filter(|run| first == 0.0 && run.last() == Some(a)) {
                Some(run) => run.push(place(last)),
                None => runs.push(vec![place(first), place(last)]),
            }
        }
    }
    runs
}

fn legend(area: &Area<'_>, lines: &[Line]) -> Drawn {
    let mut left = 220;
    for (line, (colour, width)) in lines.iter().zip(STYLES) {
        area.draw(&PathElement::new([(left, 104), (left + 72, 104)], colour.stroke_width(width)))?;
        area.draw(&Text::new(line.label.clone(), (left + 88, 80), words()))?;
        left += 120 + 22 * line.label.chars().count() as i32;
    }
    Ok(())
}

fn words() -> TextStyle<'static> {
    ("sans-serif", LETTER).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Top))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_border_of_the_window() {
        let line = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, 0.5), (4.0, f64::NAN), (5.0, 0.0), (6.0, 0.0)];
        let runs = within(&line, [0.0, 5.5], [0.0, 1.0]);
        let expected =
            [vec![(0.0, 0.0), (0.5, 1.0)], vec![(1.5, 1.0), (2.0, 0.0), (3.0, 0.5)], vec![(5.0, 0.0), (5.5, 0.0)]];
        assert_eq!(runs, expected);
    }
}
