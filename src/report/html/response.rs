//! Frequency response between interface coordinates and at outputs: full, reduced, error.

use super::front::{in_words, percent};
use super::markup::{Figure, Markup};
use super::plot;
use crate::number::quantity;
use crate::report::words;
use crate::verification::preservation::ResponseComparison;

pub(super) fn response(page: &mut Markup, response: Option<&ResponseComparison>) {
    let Some(response) = response else {
        page.absent("Not in this report: no frequency response was computed. The frequencies above do not replace it.");
        return;
    };
    let [driven, observed] = &response.worst_pair;
    let worst = format!(
        "The largest error between any two interface coordinates{} is {} dB, at {} Hz, driven at {driven} and observed \
         at {observed}; resonance peaks shift by at most {}.",
        if response.n_outputs > 0 { ", or at an output driven by one," } else { "" },
        quantity(response.worst_db, 3),
        quantity(response.worst_at_hz, 6),
        percent(response.peak_shift)
    );
    page.paragraph(&worst);
    page.facts(&[
        ("Boundary", vec![words::boundary(&response.boundary)]),
        ("Damping", vec![format!("structural, η = {}: stiffness K (1 + iη)", quantity(response.damping, 4))]),
        (
            "Rotations",
            vec![format!("scaled by the length {}, in units of the model", quantity(response.rotation_length, 5))],
        ),
        (
            "Samples",
            vec![format!(
                "{}, each with the full model solved anew to a relative residual of at most {}",
                response.samples.len(),
                in_words(response.residual, 2)
            )],
        ),
    ]);
    page.figure(&Figure {
        id: "figure-response",
        svg: plot::response(&response.samples),
        title: "Full against reduced response".to_owned(),
        description: worst,
        caption: format!(
            "Above: response of the worst pair, {driven} to {observed}. Below: the largest error over all pairs of \
             interface coordinates{} at each frequency.",
            if response.n_outputs > 0 { " and all outputs" } else { "" }
        ),
    });
}
