//! Natural frequencies with what is known of them.

use super::front::{in_words, sentence};
use super::markup::{Cell, Figure, Markup, Table};
use super::{mode_table, plot};
use crate::number::scientific;
use crate::report::words;
use crate::report::{ReportBody, TrustInterval};

pub(super) fn modes(page: &mut Markup, body: &ReportBody) {
    page.heading("Is any missing?");
    page.paragraph(&sentence(&body.completeness.statement()));
    if body.trust_intervals.is_empty() {
        page.absent("No interval with a count at both ends is in this report.");
    } else {
        trust(page, &body.trust_intervals);
    }
    page.heading("How exact are they?");
    let (modes, preserved) = (&body.reduction.modes, &body.preservation.modes);
    if modes.is_empty() {
        page.absent(match body.reduction.expansion {
            Some(_) => "The modes come from a file; no frequency of the full model was computed with them.",
            None => "No elastic mode was kept.",
        });
        return;
    }
    let worst_bar = modes.iter().map(|mode| mode.error_bar_hz / mode.frequency_hz).fold(0.0, f64::max);
    let mut description = format!("The widest error bar is {} of its frequency.", in_words(worst_bar, 2));
    if let Some(worst) = preserved.iter().map(|mode| mode.relative_difference).reduce(f64::max) {
        description += &format!(" Reduced and full frequencies differ by at most {}.", in_words(worst, 2));
    }
    page.figure(&Figure {
        id: "figure-frequency-error",
        svg: plot::frequency_error(modes, preserved),
        title: "Error of each natural frequency".to_owned(),
        caption: format!(
            "{description} Bars: what rounding and the digits of the input can move the frequency by; a dot within its bar \
             says nothing about the reduction, because the two frequencies agree as far as they are known."
        ),
        description,
    });
    mode_table::mode_table(page, modes, preserved);
}

fn trust(page: &mut Markup, intervals: &[TrustInterval]) {
    let heads = ["from, Hz", "to, Hz", "boundary", "counted", "found", "pivot growth"].map(str::to_owned).into();
    let rows = intervals.iter().map(|interval| {
        vec![
            Cell::Number(words::lower_end(interval.from_hz, 8)),
            Cell::Number(crate::number::quantity(interval.to_hz, 8)),
            Cell::Text(words::mode_kind(interval.kind).to_owned()),
            Cell::Number(interval.n_counted.to_string()),
            Cell::Number(interval.n_found.to_string()),
            Cell::Number(scientific(interval.pivot_growth, 2)),
        ]
    });
    let caption = "Intervals in which every natural frequency is accounted for: the number counted from the signs of two \
                   factorisations, rigid-body motions included, next to the number found. A large pivot growth would make the signs doubtful."
        .to_owned();
    page.table(&Table { id: "table-trust".to_owned(), caption, heads, rows: rows.collect() });
}
