//! The report as text for people: at most 100 columns, the same words as the JSON document.

pub(crate) mod body;
pub(crate) mod preserved;
mod run;

use super::Report;
use super::page::{Page, Paint};

/// The summary of `report`, with a newline at its end.
pub fn summary(report: &Report, paint: Paint) -> String {
    let mut page = Page::new(paint);
    body::write(&mut page, &report.body);
    run::write(&mut page, report);
    page.into_text()
}
