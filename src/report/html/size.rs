//! What another number of modes would give, and what the highest frequency asks of the integrator.

use super::front::{in_words, percent};
use super::markup::{Cell, Figure, Markup, Table};
use super::plot;
use crate::number::{counted, no_more_than, quantity, scientific};
use crate::verification::preservation::{Preservation, SizeError};

pub(super) fn size(page: &mut Markup, preservation: &Preservation) {
    page.heading("How many modes would give which error");
    match (preservation.size_errors.first(), preservation.size_errors.last()) {
        (Some(first), Some(last)) => curve(page, &preservation.size_errors, first, last),
        _ => page.absent("Not in this report: smaller bases were not compared."),
    }
    page.heading("Highest frequency of the reduced model");
    match &preservation.highest {
        Some(highest) => page.paragraph(&format!(
            "{} Hz. The central difference scheme is stable up to a step of {} s, {}; an implicit scheme still follows this \
             motion with steps of {} s, a twentieth of its period. It belongs to the basis rather than to the component: \
             where it costs too many steps, damp it or leave it out.",
            quantity(highest.frequency_hz, 6),
            in_words(no_more_than(highest.explicit_step_s, 3), 3),
            if highest.is_damped { "with the damping of the superelement" } else { "undamped" },
            in_words(highest.resolving_step_s, 3)
        )),
        None => page.absent(
            "None is in this report: where a motion of the reduced model has no mass, no explicit step follows it.",
        ),
    }
}

fn curve(page: &mut Markup, sizes: &[SizeError], first: &SizeError, last: &SizeError) {
    let description = format!(
        "With {} the largest frequency error in the band is {}, with {} it is {}.",
        counted(first.n_modes, "elastic mode", "elastic modes"),
        percent(first.frequency_error),
        last.n_modes,
        percent(last.frequency_error)
    );
    page.figure(&Figure {
        id: "figure-size-error",
        svg: plot::size_error(sizes),
        title: "Size and error".to_owned(),
        caption: format!("{description} Errors are the largest over the boundaries compared."),
        description,
    });
    let heads = ["elastic modes", "coordinates", "frequency error", "response error, dB"].map(str::to_owned).into();
    let rows = sizes.iter().map(|size| {
        vec![
            Cell::Head(size.n_modes.to_string()),
            Cell::Number(size.n_reduced.to_string()),
            Cell::Number(scientific(size.frequency_error, 2)),
            Cell::Number(size.response_error_db.map_or("–".to_owned(), |error| quantity(error, 2))),
        ]
    });
    let caption = "Largest errors in the band for smaller bases of the same method.".to_owned();
    page.table(&Table { id: "table-size-error".to_owned(), caption, heads, rows: rows.collect() });
}
