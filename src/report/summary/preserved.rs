//! What the reduction preserves, in a few lines.

use crate::number;
use crate::report::page::Page;
use crate::verification::preservation::{BoundaryComparison, Preservation};

/// Longer lists are cut; the JSON document has them all.
pub(super) const LINES_SHOWN: usize = 8;

pub(crate) fn write(page: &mut Page, preservation: &Preservation) {
    if *preservation == Preservation::default() {
        return;
    }
    page.heading("Preserved");
    for comparison in preservation.boundaries.iter().take(LINES_SHOWN) {
        page.entry(&comparison.boundary, &boundary(comparison));
    }
    let n_more = preservation.boundaries.len().saturating_sub(LINES_SHOWN);
    if n_more > 0 {
        page.entry("", &format!("… and {n_more} more in the report"));
    }
    let statics = preservation.statics.iter().map(|statics| statics.relative_difference).fold(0.0, f64::max);
    if !preservation.statics.is_empty() {
        let n = number::counted(preservation.statics.len(), "interface", "interfaces");
        page.entry(
            "statics",
            &format!("{n} · stiffness differs by at most {}", number::scientific(number::no_less_than(statics, 2), 2)),
        );
    }
    if let Some(response) = &preservation.response {
        let [driven, observed] = &response.worst_pair;
        let worst = format!(
            "at most {} dB off at {} Hz, {driven} to {observed}",
            number::quantity(number::no_less_than(response.worst_db, 2), 2),
            number::quantity(response.worst_at_hz, 5)
        );
        page.entry("response", &worst);
        let mut sampled = number::counted(response.samples.len(), "sample", "samples");
        if response.n_outputs > 0 {
            sampled += &format!(" · {} of outputs", number::counted(response.n_outputs, "dof", "dofs"));
        }
        let damping = number::quantity(response.damping, 2);
        page.entry(
            "",
            &format!("{sampled} · damping factor {damping} · residual {}", number::scientific(response.residual, 1)),
        );
    }
    if let Some(highest) = preservation.highest {
        let text = format!(
            "{} Hz · explicit steps below {} s {}, {} s to follow it",
            number::quantity(highest.frequency_hz, 5),
            number::scientific(number::no_more_than(highest.explicit_step_s, 2), 2),
            if highest.is_damped { "damped" } else { "undamped" },
            number::scientific(highest.resolving_step_s, 2)
        );
        page.entry("highest", &text);
    }
    for note in preservation.not_compared.iter().take(LINES_SHOWN) {
        page.entry("not compared", note);
    }
}

fn boundary(comparison: &BoundaryComparison) -> String {
    let n_in_band = comparison.frequencies.iter().filter(|pair| pair.in_band).count();
    if n_in_band == 0 {
        return "no elastic frequency in the band".to_owned();
    }
    let frequencies = number::counted(n_in_band, "frequency", "frequencies");
    let worst = number::no_less_than(comparison.worst_in_band, 2);
    format!("{frequencies} in the band · off by at most {}", number::scientific(worst, 2))
}
