//! Every check: its line, and what it means.

use super::front::{in_words, sentence};
use super::markup::{Cell, Markup, Table};
use crate::number::scientific;
use crate::report::words;
use crate::verification::catalogue::{Proof, entry};
use crate::verification::check::{Check, Verdict};

pub(super) fn checks(page: &mut Markup, checks: &[Check]) {
    page.paragraph(
        "Each check compares a measured value with a limit. The limit is the largest of three: what engineering practice \
         asks, what double-precision arithmetic can give for this model, and what the digits of the input can give; the \
         table says which one it was. A value past its limit warns, far past it fails. The margin is limit over value. \
         Where no limit can be right for every use, the value is shown and not judged.",
    );
    let heads = ["id", "check", "value", "limit", "set by", "margin", "verdict"].map(str::to_owned).into();
    let rows = checks.iter().map(row).collect();
    page.table(&Table { id: "table-checks".to_owned(), caption: "All checks of this run.".to_owned(), heads, rows });
    page.heading("What they mean");
    let kinds = [Proof::Certified, Proof::Measured, Proof::Estimated, Proof::Shown];
    page.paragraph("Not every answer is equally firm.");
    page.raw("<ul>\n");
    for kind in kinds {
        page.element("li", &format!("{}: {}", kind.word(), kind.meaning()));
    }
    page.raw("</ul>\n");
    let mut told: Vec<&str> = Vec::new();
    for check in checks {
        if !told.contains(&check.id) {
            told.push(check.id);
            let group: Vec<&Check> = checks.iter().filter(|other| other.id == check.id).collect();
            tell(page, check.id, &group);
        }
    }
}

fn row(check: &Check) -> Vec<Cell> {
    let [limit, active, margin] = words::limit(check);
    vec![
        Cell::Head(check.id.to_owned()),
        Cell::Text(check.name.to_owned()),
        Cell::Number(scientific(check.value, 2)),
        Cell::Number(limit),
        Cell::Text(active),
        Cell::Number(margin),
        Cell::Verdict(check.verdict()),
    ]
}

/// What one identifier means and what each of its checks found.
fn tell(page: &mut Markup, id: &str, group: &[&Check]) {
    let names: Vec<&str> = group.iter().map(|check| check.name).collect();
    page.raw(&format!("<div class=\"check\" id=\"check-{id}\">\n"));
    page.element("h4", &format!("{id}: {}", names.join("; ")));
    let known = entry(id);
    if let Some(known) = known {
        page.paragraph(&format!("{} {}", known.meaning, sentence(known.proof.word())));
    }
    page.raw("<ul>\n");
    for check in group {
        let worst = check.worst.as_ref().map(|worst| format!("; {worst}")).unwrap_or_default();
        let definition = format!("{}: {}{worst}", check.equation, in_words(check.value, 2));
        page.element("li", &definition);
    }
    page.raw("</ul>\n");
    let is_past = group.iter().any(|check| check.verdict() > Verdict::Pass);
    if let (true, Some(known)) = (is_past, known) {
        page.classed("p", "remedy", &format!("What to look at: {}", known.remedy));
    }
    page.raw("</div>\n");
}
