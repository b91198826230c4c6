//! What comes out, in the tables of the README; a test compares them.

use std::collections::BTreeSet;

use crate::claims::claims;
use crate::examples::motion_based;
use crate::figure::FIGURES;
use crate::study::{Study, taken};
use crate::verdict::Verdict;

/// Misfits of the motion-based variants and iterations per step, as two tables of Markdown.
pub fn summary(studies: &[Study]) -> String {
    let misfits: String = studies.iter().map(misfits).collect();
    let iterations: String = studies.iter().filter_map(iterations).collect();
    format!(
        "| example | quantity | largest / RMS misfit |\n|---|---|---|\n{misfits}\n\
         | example | the paper: iterations per step | found, by variant, at tolerance |\n|---|---|---|\n{iterations}"
    )
}

/// How many claims hold.
pub fn totals(studies: &[Study]) -> String {
    let verdicts: Vec<Verdict> = studies.iter().flat_map(claims).map(|claim| claim.verdict).collect();
    let count = |one: Verdict| verdicts.iter().filter(|verdict| **verdict == one).count();
    let [reached, partly, not] = [Verdict::Reached, Verdict::Partly, Verdict::NotReached].map(count);
    format!("of {}, {reached} are reached, {partly} in part and {not} not", verdicts.len())
}

fn number(study: &Study) -> &'static str {
    &study.example.title()[..3]
}

fn misfits(study: &Study) -> String {
    let models = study.example.models();
    let drawn: BTreeSet<usize> = FIGURES.iter().filter(|f| f.example == study.example).map(|f| f.quantity.0).collect();
    let row = |column: usize| {
        let one = |model: &(usize, usize)| {
            let misfit = study.misfit(motion_based(model.0, model.1), column, [0.0, f64::INFINITY]);
            let words = misfit.map_or("stops".to_owned(), |m| format!("{:.2} / {:.2} %", 100.0 * m.max, 100.0 * m.rms));
            format!("{} {words}", study.example.label(*model))
        };
        let found: Vec<String> = models.iter().map(one).collect();
        let (what, _) = study.reference.quantity(column);
        format!("| {} | {what} | {} |\n", number(study), found.join("; "))
    };
    drawn.into_iter().map(row).collect()
}

fn iterations(study: &Study) -> Option<String> {
    let paper = study.example.iterations()?;
    let tolerance = study.example.counted_at();
    Some(format!("| {} | {paper} | {} at {tolerance:.0e} |\n", number(study), taken(study, tolerance)))
}
