//! The report as one page for people: to be read, printed and signed.
//!
//! The page needs no script and loads nothing. The verdict and what it is about come first, with room for signatures. The
//! evidence follows, in the order in which an engineer asks for it, and the facts of the run come last. The element `body`
//! has the same content for any number of threads, on any day and in any folder; `of-run` and `run` hold the rest.

pub(super) mod certification;
mod checks;
mod front;
mod markup;
mod mode_table;
mod modes;
mod plot;
mod preservation;
mod response;
mod rigid_body;
mod run;
mod size;

use super::Report;
use markup::Markup;

pub use markup::escaped;

/// Everything about looks; no element of the page carries a style of its own.
const STYLE: &str = include_str!("style.css");

/// The sections after the front page: identifier, heading.
const CONTENTS: [(&str, &str); 7] = [
    ("rigid-body", "The component as a rigid body"),
    ("modes", "Natural frequencies"),
    ("preservation", "Reduced against full model"),
    ("response", "Frequency response"),
    ("size", "Size and error"),
    ("checks", "Checks in words"),
    ("run", "The run"),
];

/// The page, UTF-8, HTML and well-formed XML at once.
pub fn html(report: &Report) -> String {
    let body = &report.body;
    let sizes = format!("{} to {} degrees of freedom", body.model.n_dofs, body.reduction.n_reduced);
    document(&format!("Reduction report: {}, {sizes}", body.reduction.method.name()), |page| {
        front::of_run(page, &report.run);
        page.raw("<main>\n<div id=\"body\">\n");
        front::front(page, report);
        contents(page);
        let [rigid, modes, preservation, response, size, checks, run] = CONTENTS;
        page.section(rigid.0, rigid.1, |page| rigid_body::rigid_body(page, body));
        page.section(modes.0, modes.1, |page| modes::modes(page, body));
        page.section(preservation.0, preservation.1, |page| preservation::preservation(page, &body.preservation));
        page.section(response.0, response.1, |page| response::response(page, body.preservation.response.as_ref()));
        page.section(size.0, size.1, |page| size::size(page, &body.preservation));
        page.section(checks.0, checks.1, |page| checks::checks(page, &body.checks));
        page.raw("</div>\n");
        page.section(run.0, run.1, |page| run::run(page, &report.run));
        page.raw("</main>\n");
    })
}

/// A page with a title and what `content` puts into its body.
fn document(title: &str, content: impl FnOnce(&mut Markup)) -> String {
    let mut page = Markup::default();
    page.raw("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n");
    page.raw("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n");
    page.raw("<meta name=\"color-scheme\" content=\"light\"/>\n");
    page.element("title", title);
    page.raw("<style>\n");
    page.raw(STYLE);
    page.raw("</style>\n</head>\n<body>\n");
    content(&mut page);
    page.raw("</body>\n</html>\n");
    page.into_text()
}

fn contents(page: &mut Markup) {
    page.raw("<nav aria-label=\"Contents\">\n<ol>\n");
    for (id, heading) in CONTENTS {
        page.raw(&format!("<li><a href=\"#{id}\">{}</a></li>\n", escaped(heading)));
    }
    page.raw("</ol>\n</nav>\n");
}
