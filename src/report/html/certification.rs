//! The certification of a result of another program as a page for people.

use super::front::{capital, counts_of, matrix, sentence, signatures};
use super::markup::{Cell, Markup, Table, class_of};
use super::{checks, document, preservation};
use crate::certification::JudgedPair;
use crate::number::{counted, decade, scientific};
use crate::report::certification::{kind_word, pair_in_words, verdict_of};
use crate::report::{CertificationReport, CertifiedModel, Generator, ReducedReport, Reservations};
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::Preservation;

/// What a signature under a page about eigenpairs means.
const OF_PAIRS: &str = "Says of each pair of the result whether it is a mode of the supplied K and M, and which modes of the band the \
                        result has not. Does not validate the finite element model.";
/// What a signature under a page about a superelement means.
const OF_SUPERELEMENT: &str = "Says how far the superelement is that of its basis and of the supplied K and M, and how well it preserves \
                               them. Does not validate the finite element model.";

/// The page, UTF-8, HTML and well-formed XML at once.
pub(in crate::report) fn of_pairs(report: &CertificationReport, reservations: Reservations) -> String {
    let CertificationReport { model, result, certification, .. } = report;
    let dofs = counted(model.n_dofs, "degree of freedom", "degrees of freedom");
    document(&format!("Certification of eigenpairs, {dofs}"), |page| {
        page.raw("<main>\n<div id=\"body\">\n");
        Front {
            kind: "eigenpairs",
            generator: &report.generator,
            checks: &certification.checks,
            verdict: (certification.verdict(), reservations),
            scope: OF_PAIRS,
            model,
            subject: ("Result", result_in_words(report)),
            found: report.found(),
            digests: vec![("BLAKE3 of the result", &result.digest)],
        }
        .write(page);
        page.section("pairs", "Pairs of the result", |page| pairs(page, &certification.pairs));
        page.section("checks", "Checks in words", |page| checks::checks(page, &certification.checks));
        page.raw("</div>\n</main>\n");
    })
}

/// The page, UTF-8, HTML and well-formed XML at once.
pub(in crate::report) fn of_superelement(report: &ReducedReport, reservations: Reservations) -> String {
    let ReducedReport { model, source, certification, .. } = report;
    let dofs = counted(model.n_dofs, "degree of freedom", "degrees of freedom");
    document(&format!("Certification of a superelement, {dofs}"), |page| {
        page.raw("<main>\n<div id=\"body\">\n");
        Front {
            kind: "a superelement",
            generator: &report.generator,
            checks: &certification.checks,
            verdict: (certification.verdict(), reservations),
            scope: OF_SUPERELEMENT,
            model,
            subject: ("Superelement", counted(certification.n_coordinates, "coordinate", "coordinates")),
            found: report.found(),
            digests: vec![
                ("BLAKE3 of the basis", &source.basis),
                ("BLAKE3 of the reduced stiffness", &source.stiffness),
                ("BLAKE3 of the reduced mass", &source.mass),
            ],
        }
        .write(page);
        page.section("preservation", "Superelement against component", |page| {
            let of_free = certification.free.frequencies.iter().cloned();
            let own = certification.preservation.clone().unwrap_or_default();
            // The comparison at the interface has the free one too, where there is one.
            let boundaries = if own.boundaries.is_empty() { of_free.collect() } else { own.boundaries };
            preservation::preservation(page, &Preservation { boundaries, ..own });
        });
        page.section("checks", "Checks in words", |page| checks::checks(page, &certification.checks));
        page.raw("</div>\n</main>\n");
    })
}

/// The first part of a page: verdict, subject, what was found.
struct Front<'a> {
    kind: &'static str,
    generator: &'a Generator,
    checks: &'a [Check],
    verdict: (Verdict, Reservations),
    scope: &'static str,
    model: &'a CertifiedModel,
    subject: (&'static str, String),
    /// A label and a line each; one without a label goes on.
    found: Vec<(&'static str, String)>,
    digests: Vec<(&'static str, &'a String)>,
}

impl Front<'_> {
    fn write(self, page: &mut Markup) {
        let Self { kind, generator, model, .. } = self;
        page.raw("<section id=\"verdict\" aria-labelledby=\"verdict-heading\">\n");
        page.classed("p", "kind", &format!("Certification of {kind} by {} {}", generator.name, generator.version));
        let (sign, word) = match self.verdict {
            (Verdict::Info | Verdict::Pass, _) => ("✓", "Certified"),
            (Verdict::Warn, Reservations::Accepted) => ("!", "Certified, with checks past their limits"),
            (Verdict::Warn, Reservations::Refused) => ("!", "Not accepted with checks past their limits"),
            (Verdict::Fail, _) => ("✗", "Not certified"),
        };
        page.raw(&format!("<div class=\"box {}\">\n", class_of(self.verdict.0)));
        page.raw(&format!("<h1 id=\"verdict-heading\"><span aria-hidden=\"true\">{sign}</span> {word}</h1>\n"));
        page.paragraph(&(counts_of(self.checks).join("; ") + "."));
        page.raw("</div>\n");
        page.classed("p", "scope", self.scope);
        let (label, subject) = self.subject;
        let mut facts: Vec<(String, Vec<String>)> = vec![
            ("Model".to_owned(), vec![model_in_words(model)]),
            ("Stiffness K".to_owned(), vec![matrix(&model.stiffness)]),
            ("Mass M".to_owned(), vec![matrix(&model.mass)]),
            (label.to_owned(), vec![subject]),
        ];
        for (label, line) in self.found {
            match (label, facts.last_mut()) {
                ("", Some((_, lines))) => lines.push(sentence(&line)),
                _ => facts.push((capital(label), vec![sentence(&line)])),
            }
        }
        facts.push(("Done to the data".to_owned(), model.notes.clone()));
        let warnings = model.warnings.iter().map(|warning| format!("{}: {}", warning.code, warning.message)).collect();
        facts.push(("Warnings".to_owned(), warnings));
        let facts: Vec<(&str, Vec<String>)> =
            facts.iter().map(|(label, lines)| (label.as_str(), lines.clone())).collect();
        page.facts(&facts);
        let of_model = [("BLAKE3 of K", &model.stiffness.digest), ("BLAKE3 of M", &model.mass.digest)];
        let digests: Vec<(&str, Vec<String>)> =
            of_model.into_iter().chain(self.digests).map(|(label, digest)| (label, vec![digest.clone()])).collect();
        page.digests(&digests);
        signatures(page);
        page.raw("</section>\n");
    }
}

fn model_in_words(model: &CertifiedModel) -> String {
    let mut parts = vec![counted(model.n_dofs, "degree of freedom", "degrees of freedom")];
    parts.extend(model.n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes")));
    parts.push(counted(model.n_bodies, "body", "bodies"));
    if model.n_held > 0 {
        parts.push(format!("{} held", counted(model.n_held, "row", "rows")));
    }
    parts.push(match model.n_rigid {
        0 => "restrained".to_owned(),
        count => counted(count, "rigid-body motion", "rigid-body motions"),
    });
    parts.join(", ")
}

fn result_in_words(report: &CertificationReport) -> String {
    let result = &report.result;
    let shapes = counted(result.n_pairs, "shape", "shapes");
    let by = result.program.map_or_else(String::new, |program| format!(", written by {program}"));
    match result.frequencies {
        Some(frequencies) => format!("{shapes} with {frequencies}{by}"),
        None => format!("{shapes} without frequencies{by}"),
    }
}

fn pairs(page: &mut Markup, pairs: &[JudgedPair]) {
    let highest = pairs.iter().map(|pair| pair.shape_hz).filter(|hertz| hertz.is_finite()).fold(0.0, f64::max);
    let decimals = usize::try_from(8 - decade(highest)).unwrap_or(0).min(9);
    let hertz =
        |value: Option<f64>| Cell::Number(value.map_or_else(|| "–".to_owned(), |hertz| format!("{hertz:.decimals$}")));
    let row = |pair: &JudgedPair| {
        vec![
            Cell::Head(pair.number.to_string()),
            hertz(pair.stated_hz),
            hertz(Some(pair.shape_hz)),
            Cell::Number(scientific(pair.error_bar_hz, 2)),
            Cell::Number(scientific(pair.backward_error, 2)),
            Cell::Text(kind_word(pair.kind).to_owned()),
            Cell::Verdict(verdict_of(pair.kind)),
        ]
    };
    let heads = ["pair", "stated, Hz", "of its shape, Hz", "± Hz", "backward error", "is", ""];
    page.table(&Table {
        id: "table-pairs".to_owned(),
        caption: "Pairs of the result: the frequency as it is stated, the one that belongs to the shape with how far the nearest one of K \
                  and M may be, and how well the pair satisfies K x = λ M x."
            .to_owned(),
        heads: heads.map(str::to_owned).into(),
        rows: pairs.iter().map(row).collect(),
    });
    let wrong: Vec<&JudgedPair> = pairs.iter().filter(|pair| verdict_of(pair.kind) > Verdict::Pass).collect();
    if !wrong.is_empty() {
        page.heading("What is wrong with some");
        page.raw("<ul>\n");
        wrong.iter().for_each(|pair| page.element("li", &sentence(&pair_in_words(pair))));
        page.raw("</ul>\n");
    }
}
