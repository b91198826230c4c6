//! Curves of our own, as in the figures of the paper, as SVG: each with a panel of differences from the reference, because lines that
//! lie on each other show no error, and with marks that tell lines apart where they do.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::Result;
use crate::curve::Curves;
use crate::examples::Example;

/// What one figure of the paper shows, drawn here once for each kind of measures.
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

/// What every figure of curves in section 5 shows.
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

    /// What is left of the line after the reference, where both have a sample.
    fn less(&self, reference: &Self) -> Self {
        let difference = |&(x, y): &(f64, f64)| {
            let near = reference.points.partition_point(|point| point.0 < x - SAME_TIME);
            let (time, value) = reference.points.get(near)?;
            ((time - x).abs() < SAME_TIME).then_some((x, y - value))
        };
        Self { label: self.label.clone(), points: self.points.iter().filter_map(difference).collect() }
    }
}

/// Samples closer than this are of one time, s (or of one load, N).
const SAME_TIME: f64 = 1e-6;

/// In half points of a drawing 1200 wide: the backend rounds to whole numbers, which steps would show.
const WIDTH: u32 = 2400;
const HEIGHT: u32 = 1200;
const LETTER: u32 = 44;
const INK: RGBColor = RGBColor(26, 33, 41);
const GRID: RGBColor = RGBColor(226, 231, 236);
/// Colour, width and mark: the reference first, then the variants; apart in lightness too, and narrower one after the other, so that
/// a line stays visible where the next one hides it.
const STYLES: [(RGBColor, u32, Mark); 4] = [
    (INK, 14, Mark::None),
    (RGBColor(31, 95, 168), 8, Mark::Circle),
    (RGBColor(196, 90, 16), 5, Mark::Triangle),
    (RGBColor(22, 136, 74), 3, Mark::Cross),
];

/// What is drawn on a line at some of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    None,
    Circle,
    Triangle,
    Cross,
}

/// Marks of one line in a panel; those of the lines take turns.
const MARKS: usize = 10;
/// Half the width of a mark.
const MARK_SIZE: i32 = 15;

type Style = (RGBColor, u32, Mark);
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// One coordinate system with its lines and their legend.
struct Panel<'a> {
    title: String,
    across: &'static str,
    lines: Vec<(&'a Line, Style)>,
    x: [f64; 2],
    y: [f64; 2],
}

/// The lines in each window, one panel above the other, and their differences from the first line, the reference; each panel has
/// its legend.
///
/// # Errors
/// The backend refuses.
pub fn drawn(figure: &Figure, lines: &[Line]) -> Result<String> {
    let across = if figure.example == Example::Bend { "load, N" } else { "time, s" };
    let windows = figure.windows.iter().enumerate().map(|(number, &(x, y))| {
        let title = if number == 0 {
            figure.quantity.1.to_owned()
        } else {
            format!("{}, from {} s to {} s", figure.quantity.1, x[0], x[1])
        };
        Panel { title, across, lines: lines.iter().zip(STYLES).collect(), x, y }
    });
    let differences: Vec<Line> = lines.iter().skip(1).map(|line| line.less(&lines[0])).collect();
    let (x, _) = figure.windows[0];
    let [low, high] = range(&differences, x);
    let margin = 0.05 * (high - low);
    let below = (high > low).then(|| Panel {
        title: format!("difference from the reference: {}", figure.quantity.1),
        across,
        lines: differences.iter().zip(STYLES.into_iter().skip(1)).collect(),
        x,
        y: [low - margin, high + margin],
    });
    let panels: Vec<Panel<'_>> = windows.chain(below).collect();
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT * panels.len() as u32)).into_drawing_area();
        for (area, panel) in area.split_evenly((panels.len(), 1)).iter().zip(&panels) {
            panel.draw(area).map_err(|error| error.to_string())?;
        }
        area.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}

/// From the lowest to the highest value of the lines inside a window, zero among them; none of what is not a number.
fn range(lines: &[Line], [from, to]: [f64; 2]) -> [f64; 2] {
    let points = lines.iter().flat_map(|line| &line.points).filter(|(x, y)| (from..=to).contains(x) && y.is_finite());
    points.fold([0.0, 0.0], |[low, high]: [f64; 2], (_, y)| [low.min(*y), high.max(*y)])
}

impl Panel<'_> {
    fn draw(&self, area: &Area<'_>) -> Drawn {
        let (x, y) = (self.x, self.y);
        let mut chart = ChartBuilder::on(area)
            .margin_top(176)
            .margin_right(60)
            .x_label_area_size(128)
            .y_label_area_size(220)
            .build_cartesian_2d(x[0]..x[1], y[0]..y[1])?;
        let decimals = if y[1] - y[0] > 5.0 { 0 } else { (1.5 - (y[1] - y[0]).log10()).ceil() as usize };
        // Without the sign of a rounded zero.
        let negligible = 1e-9 * (y[1] - y[0]);
        chart
            .configure_mesh()
            .bold_line_style(GRID.stroke_width(2))
            .light_line_style(TRANSPARENT)
            .axis_style(INK.stroke_width(2))
            .set_all_tick_mark_size(10)
            .label_style(("sans-serif", LETTER).into_font().color(&INK))
            .x_label_formatter(&|value| format!("{value}"))
            .y_label_formatter(&|value| format!("{:.decimals$}", if value.abs() < negligible { 0.0 } else { *value }))
            .x_desc(self.across)
            .draw()?;
        for (line, (colour, width, _)) in &self.lines {
            for run in within(&line.points, x, y) {
                chart.draw_series(LineSeries::new(run, colour.stroke_width(*width)))?;
            }
        }
        for (number, (line, style)) in self.lines.iter().enumerate() {
            let share = (number as f64 + 0.5) / self.lines.len() as f64;
            let (across, down) = area.get_pixel_range();
            for place in marked(&line.points, x, y, share) {
                let pixel = chart.backend_coord(&place);
                style.2.draw(area, (pixel.0 - across.start, pixel.1 - down.start), style.0)?;
            }
        }
        area.draw(&Text::new(self.title.clone(), (0, 8), words()))?;
        self.legend(area)
    }

    fn legend(&self, area: &Area<'_>) -> Drawn {
        let mut left = 220;
        for (line, style) in &self.lines {
            let (colour, width, _) = style;
            area.draw(&PathElement::new([(left, 104), (left + 72, 104)], colour.stroke_width(*width)))?;
            style.2.draw(area, (left + 36, 104), *colour)?;
            area.draw(&Text::new(line.label.clone(), (left + 88, 80), words()))?;
            left += 120 + 22 * line.label.chars().count() as i32;
        }
        Ok(())
    }
}

impl Mark {
    /// At a pixel of an area.
    fn draw(self, area: &Area<'_>, place: (i32, i32), colour: RGBColor) -> Drawn {
        match self {
            Self::None => Ok(()),
            Self::Circle => {
                area.draw(&Circle::new(place, MARK_SIZE, WHITE.filled()))?;
                area.draw(&Circle::new(place, MARK_SIZE, colour.stroke_width(5)))
            }
            Self::Triangle => area.draw(&TriangleMarker::new(place, MARK_SIZE + 5, colour.filled())),
            Self::Cross => area.draw(&Cross::new(place, MARK_SIZE, colour.stroke_width(6))),
        }
    }
}

/// The samples nearest to evenly spread places of a window, which `share` moves along by as much of their distance.
fn marked(points: &[(f64, f64)], [from, to]: [f64; 2], [low, high]: [f64; 2], share: f64) -> Vec<(f64, f64)> {
    let place = |number: usize| from + (to - from) * (number as f64 + share) / MARKS as f64;
    let nearest = |x: f64| {
        let after = points.partition_point(|point| point.0 < x).min(points.len().checked_sub(1)?);
        let before = after.saturating_sub(1);
        Some(if (points[after].0 - x).abs() < (points[before].0 - x).abs() { points[after] } else { points[before] })
    };
    let inside = |point: &(f64, f64)| (from..=to).contains(&point.0) && (low..=high).contains(&point.1);
    let mut found: Vec<(f64, f64)> = (0..MARKS).filter_map(|number| nearest(place(number))).filter(inside).collect();
    found.dedup();
    found
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
        // A line ends where it leaves the window, and before what is not a number.
        if first < last && (step.0 + step.1).is_finite() {
            match runs.last_mut().filter(|run| first == 0.0 && run.last() == Some(a)) {
                Some(run) => run.push(place(last)),
                None => runs.push(vec![place(first), place(last)]),
            }
        }
    }
    runs
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

    #[test]
    fn differences_are_taken_where_both_lines_have_a_sample() {
        let line = |points: &[(f64, f64)]| Line { label: "a".into(), points: points.to_vec() };
        let reference = line(&[(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)]);
        let found = line(&[(0.0, 1.5), (0.5, 9.0), (1.0 + 1e-9, 2.0), (3.0, 7.0)]).less(&reference);
        assert_eq!(found.points, [(0.0, 0.5), (1.0 + 1e-9, 0.0)]);
        assert_eq!(range(&[found], [0.0, 3.0]), [0.0, 0.5]);
    }

    #[test]
    fn marks_of_lines_take_turns() {
        let line: Vec<(f64, f64)> = (0..=1000).map(|i| (0.01 * f64::from(i), 0.5)).collect();
        let [first, second] = [0.25, 0.75].map(|share| marked(&line, [0.0, 10.0], [0.0, 1.0], share));
        assert_eq!((first.len(), second.len()), (MARKS, MARKS));
        assert!(first.iter().zip(&second).all(|(a, b)| (b.0 - a.0 - 0.5).abs() < 1e-9), "{first:?} {second:?}");
        assert!(
            marked(&line, [0.0, 10.0], [0.6, 1.0], 0.25).is_empty() && marked(&[], [0.0; 2], [0.0; 2], 0.5).is_empty()
        );
    }
}
