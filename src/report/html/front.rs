//! The page that is signed: the verdict, what it is about, where it holds, and room for names.

use super::markup::{Markup, class_of, escaped};
use super::plot::power_of_ten;
use crate::number;
use crate::number::{counted, no_less_than, quantity, scientific};
use crate::report::conclusion::{Reservations, reserved_as};
use crate::report::words;
use crate::report::{Completeness, MatrixReport, ModelReport, ReductionReport, Report, ReportBody, RunFacts};
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::Preservation;

/// What a signature under this page means.
const SCOPE: &str =
    "Proves that the reduction reproduces the supplied K and M. Does not validate the finite element model.";

/// What stands in its place where a check failed.
const NOT_PROVED: &str = "Does not prove that the reduction reproduces the supplied K and M: see what failed. Does not \
                          validate the finite element model.";

/// What the run says of itself at the head of the page: the file that is signed for.
pub(super) fn of_run(page: &mut Markup, run: &RunFacts) {
    page.raw("<header id=\"of-run\">\n");
    let file = run.superelement.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
    match file {
        Some(name) => page.classed("p", "file", &format!("Superelement {name}")),
        None => page.classed("p", "file", "No superelement was written"),
    }
    if let Some(digest) = &run.file_digest {
        page.classed("p", "digest", &format!("BLAKE3 {digest}"));
    }
    page.raw("</header>\n");
}

pub(super) fn front(page: &mut Markup, report: &Report) {
    let body = &report.body;
    page.raw("<section id=\"verdict\" aria-labelledby=\"verdict-heading\">\n");
    let generator = format!("Reduction report by {} {}", body.generator.name, body.generator.version);
    page.classed("p", "kind", &generator);
    let verdict = body.verdict();
    let (sign, word) = match (verdict, report.run.reservations) {
        (Verdict::Info | Verdict::Pass, _) => ("✓", "Verified".to_owned()),
        (Verdict::Warn, Reservations::Accepted) => ("!", format!("Verified, {}", reserved(body))),
        (Verdict::Warn, Reservations::Refused) => ("!", format!("Not accepted {}", reserved(body))),
        (Verdict::Fail, _) => ("✗", "Not verified".to_owned()),
    };
    page.raw(&format!("<div class=\"box {}\">\n", class_of(verdict)));
    page.raw(&format!("<h1 id=\"verdict-heading\"><span aria-hidden=\"true\">{sign}</span> {word}</h1>\n"));
    page.paragraph(&counts(body));
    for (label, line) in words::accuracy(body) {
        page.classed("p", "accuracy", &format!("{}: {line}", capital(label)));
    }
    page.raw("</div>\n");
    page.classed("p", "scope", if verdict == Verdict::Fail { NOT_PROVED } else { SCOPE });
    page.facts(&[
        ("Model", model(&body.model)),
        ("Held at rest", words::held(&body.model)),
        ("Units", vec![units(&body.model)]),
        ("Stiffness K", vec![matrix(&body.model.stiffness)]),
        ("Mass M", vec![body.model.mass.as_ref().map_or_else(|| words::NO_MASS.to_owned(), matrix)]),
        ("Method", vec![method(&body.reduction)]),
        ("Interfaces", interfaces(&body.reduction)),
        ("Reduced to", vec![coordinates(&body.reduction)]),
        ("Reduced mass", words::mass(&body.reduction).into_iter().collect()),
        ("Modes kept", modes(&body.reduction)),
        ("Loads by name", words::loads(&body.reduction)),
        ("Completeness", vec![sentence(&body.completeness.statement())]),
        ("Compared with full model", compared(body)),
        ("Not compared", body.preservation.not_compared.clone()),
        ("Done to the data", repairs(body)),
        ("Warnings", body.warnings.iter().map(|warning| format!("{}: {}", warning.code, warning.message)).collect()),
    ]);
    digests(page, &body.model);
    signatures(page);
    page.raw("</section>\n");
}

fn digests(page: &mut Markup, model: &ModelReport) {
    let matrices = [Some(("K", &model.stiffness.digest)), model.mass.as_ref().map(|mass| ("M", &mass.digest))];
    let files = model.files.iter().map(|(role, digest)| (words::file(role), digest));
    let lines: Vec<(String, Vec<String>)> = matrices
        .into_iter()
        .flatten()
        .chain(files)
        .map(|(what, digest)| (format!("BLAKE3 of {what}"), vec![digest.clone()]))
        .collect();
    let lines: Vec<(&str, Vec<String>)> =
        lines.iter().map(|(label, digest)| (label.as_str(), digest.clone())).collect();
    page.digests(&lines);
}

fn counts(body: &ReportBody) -> String {
    let mut parts = counts_of(&body.checks);
    match &body.completeness {
        Completeness::NotCertified { .. } => parts.push("completeness not certified".to_owned()),
        completeness if completeness.is_certified() => {}
        Completeness::SturmCount { n_counted, n_found, .. } if n_counted == n_found => {
            parts.push("completeness likely, not certified".to_owned());
        }
        Completeness::SturmCount { .. } => parts.push("modes are missing".to_owned()),
    }
    if !body.warnings.is_empty() {
        parts.push(counted(body.warnings.len(), "warning", "warnings"));
    }
    parts.join("; ") + "."
}

fn reserved(body: &ReportBody) -> &'static str {
    reserved_as(&body.checks, body.warnings.len())
}

/// How many checks passed, and which did not.
pub(super) fn counts_of(checks: &[Check]) -> Vec<String> {
    let of = |verdict| -> Vec<&str> {
        let ids = checks.iter().filter(|check| check.verdict() == verdict).map(|check: &Check| check.id);
        let mut ids: Vec<&str> = ids.collect();
        ids.dedup();
        ids
    };
    let n_passed = checks.iter().filter(|check| check.verdict() == Verdict::Pass).count();
    let n_judged = checks.iter().filter(|check| check.is_judged()).count();
    let mut parts = vec![format!("{n_passed} of {} passed", counted(n_judged, "check", "checks"))];
    let (failed, warned) = (of(Verdict::Fail), of(Verdict::Warn));
    if !failed.is_empty() {
        parts.push(format!("failed: {}", failed.join(", ")));
    }
    if !warned.is_empty() {
        parts.push(format!("past the limit: {}", warned.join(", ")));
    }
    let n_shown = checks.iter().filter(|check| check.verdict() == Verdict::Info).count();
    if n_shown > 0 {
        parts.push(format!("{n_shown} shown without a limit"));
    }
    parts
}

fn model(model: &ModelReport) -> Vec<String> {
    let mut parts = vec![counted(model.n_dofs, "degree of freedom", "degrees of freedom")];
    parts.extend(model.n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes")));
    parts.push(counted(model.n_bodies, "body", "bodies"));
    parts.push(match model.rigid_body_modes.count {
        0 => "restrained".to_owned(),
        count => counted(count, "rigid-body motion", "rigid-body motions"),
    });
    vec![parts.join(", ")]
}

fn units(model: &ModelReport) -> String {
    match &model.units {
        Some(units) => format!("{units}, as named by the job; no number was converted"),
        None => "not named; all numbers are in the units of the matrices, frequencies in Hz if time is in seconds"
            .to_owned(),
    }
}

pub(super) fn matrix(matrix: &MatrixReport) -> String {
    let nonzeros = counted(matrix.n_nonzeros, "nonzero", "nonzeros");
    format!("{nonzeros}, {}", matrix.digits.in_words().replacen("digit", "significant digit", 1))
}

fn method(reduction: &ReductionReport) -> String {
    let by = match reduction.expansion {
        Some(_) => "modes of a file".to_owned(),
        None => format!("modes by {}", words::eigensolver(reduction.eigensolver)),
    };
    format!("{}; {by}", reduction.method.name())
}

fn interfaces(reduction: &ReductionReport) -> Vec<String> {
    let line = |interface: &crate::report::InterfaceReport| {
        let (nodes, dofs) =
            (counted(interface.n_nodes, "node", "nodes"), counted(interface.n_dofs, "coordinate", "coordinates"));
        let places = words::positions(interface).map(|places| format!(", {places}")).unwrap_or_default();
        format!("{}: {} coupling, {nodes}, {dofs}{places}", interface.name, interface.coupling.name())
    };
    reduction.interfaces.iter().map(line).collect()
}

fn coordinates(reduction: &ReductionReport) -> String {
    let parts = words::coordinates(reduction).join(", ");
    format!("{}: {parts}", counted(reduction.n_reduced, "coordinate", "coordinates"))
}

fn modes(reduction: &ReductionReport) -> Vec<String> {
    if let Some(expansion) = &reduction.expansion {
        return words::expansion(expansion);
    }
    let line = match (reduction.modes.first(), reduction.modes.last()) {
        (Some(first), Some(last)) => format!(
            "{} {} {}, {} Hz to {} Hz",
            number::count(reduction.modes.len() as u64),
            words::modes_under(first.kind, reduction.modes_held.as_deref()),
            if reduction.modes.len() == 1 { "mode" } else { "modes" },
            quantity(first.frequency_hz, 6),
            quantity(last.frequency_hz, 6)
        ),
        _ => "none".to_owned(),
    };
    vec![line]
}

/// The band and the boundaries for which the reduced model was compared with the full one.
fn compared(body: &ReportBody) -> Vec<String> {
    let mut lines = compared_boundaries(&body.preservation);
    lines.extend(compared_response(&body.preservation));
    if lines.is_empty() {
        lines.push(if body.reduction.modes.is_empty() { "nothing" } else { "nothing but its own modes" }.to_owned());
    }
    lines
}

fn compared_boundaries(preservation: &Preservation) -> Vec<String> {
    preservation
        .boundaries
        .iter()
        .map(|comparison| {
            let worst = percent(no_less_than(comparison.worst_in_band, 2));
            let in_band = comparison.frequencies.iter().filter(|pair| pair.in_band);
            let boundary = words::boundary(&comparison.boundary);
            match in_band.map(|pair| pair.full_hz).reduce(f64::max) {
                Some(highest) => format!(
                    "{boundary}, {}: frequencies off by at most {worst}, up to {} Hz",
                    comparison.description,
                    quantity(highest, 5)
                ),
                None => format!("{boundary}, {}: no frequency in the band", comparison.description),
            }
        })
        .collect()
}

fn compared_response(preservation: &Preservation) -> Option<String> {
    let response = preservation.response.as_ref()?;
    let (first, last) = (response.samples.first()?, response.samples.last()?);
    Some(format!(
        "response, {}: off by at most {} dB, {} Hz to {} Hz",
        words::boundary(&response.boundary),
        quantity(no_less_than(response.worst_db, 2), 2),
        quantity(first.frequency_hz, 4),
        quantity(last.frequency_hz, 5)
    ))
}

/// A relative difference as engineers say it: percent where it can be seen, a power of ten where it cannot.
pub(super) fn percent(difference: f64) -> String {
    if difference >= 1e-5 { format!("{}\u{a0}%", quantity(difference * 100.0, 2)) } else { in_words(difference, 2) }
}

/// A number within a sentence: `2.7 × 10⁻⁶`, which no line breaks.
pub(super) fn in_words(value: f64, digits: usize) -> String {
    let text = scientific(value, digits);
    match text.split_once('e') {
        Some((mantissa, exponent)) => match exponent.parse() {
            Ok(exponent) => format!("{mantissa}\u{a0}×\u{a0}{}", power_of_ten(exponent)),
            Err(_) => text,
        },
        None => text,
    }
}

fn repairs(body: &ReportBody) -> Vec<String> {
    let mut lines = body.model.notes.clone();
    let dropped = body.reduction.dropped.iter();
    lines.extend(dropped.map(|dropped| format!("left out {}: {}", dropped.coordinate, dropped.reason)));
    let skipped = body.reduction.skipped.iter();
    lines.extend(skipped.map(|skipped| format!("skipped by rule {}: {}", skipped.rule, skipped.what)));
    if body.model.rigid_body_modes.count > 0 && body.reduction.n_interface > 0 {
        lines.push(
            "constraint modes corrected, so that rigid-body motion of the interface carries the component exactly \
             (always done; M-11 measures the result)"
                .to_owned(),
        );
    }
    if lines.is_empty() {
        lines.push("nothing".to_owned());
    }
    lines
}

pub(super) fn signatures(page: &mut Markup) {
    page.raw("<div class=\"sign\">\n<table>\n<caption>Signatures</caption>\n<thead>\n<tr><td></td>");
    for head in ["Name", "Role", "Date", "Signature"] {
        page.raw(&format!("<th scope=\"col\">{head}</th>"));
    }
    page.raw("</tr>\n</thead>\n<tbody>\n");
    for row in ["Prepared", "Checked", "Approved"] {
        page.raw(&format!("<tr><th scope=\"row\">{}</th><td></td><td></td><td></td><td></td></tr>\n", escaped(row)));
    }
    page.raw("</tbody>\n</table>\n</div>\n");
}

/// A statement with a capital letter and a full stop.
pub(super) fn sentence(statement: &str) -> String {
    capital(statement) + "."
}

pub(super) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
