//! The page for people.

use super::examined::Examined;
use super::finding::{Finding, Severity};
use super::fitted_surface::Surface;
use super::units::{UnitGuess, Units};
use crate::input::MatrixFacts;
use crate::number::{counted, quantity, scientific};
use crate::report::page::{Page, Paint, Tone, WIDTH};
use crate::report::summary::body::mass_properties;
use crate::report::{Generator, ModelReport, ReportBody, table};
use crate::sparse::Triangle;
use crate::verification::check::Verdict;

/// Groups that are listed.
const LISTED: usize = 24;

impl Examined {
    /// The page, with a newline at its end.
    pub fn to_text(&self, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let generator = Generator::default();
        let title = format!("{} {} · what this pair of matrices is", generator.name, generator.version);
        page.line(Page::toned(&title, Tone::Heading));
        self.matrices(&mut page);
        if let Some(body) = &self.body {
            page.heading("The body");
            self.of_body(&mut page, body);
            modes(&mut page, body);
        }
        self.interfaces(&mut page);
        self.findings(&mut page);
        page.into_text()
    }

    fn matrices(&self, page: &mut Page) {
        let Some(facts) = &self.facts else { return };
        page.heading("The matrices");
        for (label, facts) in ["stiffness", "mass"].into_iter().zip(&facts.matrices) {
            page.entry(label, &matrix(facts, self.symmetry()));
        }
    }

    /// How symmetric the matrices are: the less so of both.
    fn symmetry(&self) -> &'static str {
        let has = |code: &str| self.findings.iter().any(|finding| finding.code == Some(code));
        match (has("E-UNSYMMETRIC"), has("W-UNSYMMETRIC")) {
            (true, _) => "not symmetric",
            (false, true) => "symmetric to rounding",
            (false, false) => "symmetric",
        }
    }

    fn of_body(&self, page: &mut Page, body: &ReportBody) {
        let ModelReport { n_dofs, n_nodes, n_bodies, mass_properties: properties, rigid_body_modes, .. } = &body.model;
        let mut parts = vec![counted(*n_dofs, "row", "rows")];
        parts.extend(n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes")));
        parts.push(counted(*n_bodies, "body", "bodies"));
        let massless = self.n_massless.filter(|n_massless| *n_massless > 0);
        parts.extend(massless.map(|n_massless| format!("{} without mass", counted(n_massless, "row", "rows"))));
        page.entry("size", &parts.join(" · "));
        if let Some(extents) = self.extents {
            page.entry("extents", &extents.map(|extent| quantity(extent, 4)).join(" × "));
        }
        let motions = match rigid_body_modes.count {
            0 => "none free: supports hold it".to_owned(),
            6 if *n_bodies == 1 => "six free, as of a body in space".to_owned(),
            count => format!("{} free", counted(count, "motion is", "motions are")),
        };
        page.entry("rigid body", &motions);
        mass_properties(page, properties);
        page.entry("units", &units(&self.units));
    }

    fn interfaces(&self, page: &mut Page) {
        if self.interfaces.is_empty() {
            return;
        }
        page.heading("Groups that may be interfaces");
        for candidate in self.interfaces.iter().take(LISTED) {
            let mut parts = vec![counted(candidate.n_nodes, "node", "nodes"), counted(candidate.n_dofs, "dof", "dofs")];
            parts.push(match candidate.couplings.as_slice() {
                [] => "none".to_owned(),
                couplings => couplings.join(", "),
            });
            parts.extend(candidate.surface.as_ref().map(on_surface));
            parts.extend(candidate.remark.clone());
            page.entry(&candidate.group, &parts.join(" · "));
        }
        if self.interfaces.len() > LISTED {
            page.entry("", &format!("… and {} more with --json", self.interfaces.len() - LISTED));
        }
    }

    fn findings(&self, page: &mut Page) {
        page.heading("Findings");
        if self.findings.is_empty() {
            page.line(Page::toned("  ✓ nothing: the pair can be reduced as it is", Tone::Of(Verdict::Pass)));
            return;
        }
        self.findings.iter().for_each(|finding| told(page, finding));
    }
}

/// The systems of units in words.
pub(super) fn units(units: &Units) -> String {
    let guesses = match units {
        Units::Untold => return "not told without coordinates: give --nodes".to_owned(),
        Units::LeftOut => return "not told: the nodes that were given were left out".to_owned(),
        Units::NoSpeed => {
            return "not told: without mass, or without two nodes that are joined, there is no speed of sound"
                .to_owned();
        }
        Units::NoVolume => {
            return "not told: the nodes lie in a plane or on a line, so that the density is unknown".to_owned();
        }
        Units::NoPlace => {
            return "not told: rows without a place have part of the mass, as amplitudes of a superelement do"
                .to_owned();
        }
        Units::Guessed(guesses) => guesses,
    };
    let named = |guess: &UnitGuess| match guess.is_mixed {
        true => format!("a mixture of {} (frequencies come out {} then)", guess.system, guess.frequencies),
        false => guess.system.to_owned(),
    };
    match guesses.as_slice() {
        [] => "density and speed of sound are those of no system that is known".to_owned(),
        [only] if !only.is_mixed => {
            format!("{}, by density and speed of sound; frequencies {}", only.system, only.frequencies)
        }
        _ => {
            let listed: Vec<String> = guesses.iter().map(named).collect();
            format!("{}, by density and speed of sound", listed.join(", or "))
        }
    }
}

/// The surface of a group in words.
pub(super) fn on_surface(surface: &Surface) -> String {
    let what = if surface.origin == "hole" { "cylinder" } else { "sphere" };
    format!("on a {what} of radius {}", quantity(surface.fit.radius, 4))
}

fn matrix(facts: &MatrixFacts, symmetry: &str) -> String {
    let digest: String = facts.digest.chars().take(12).collect();
    let nonzeros = counted(facts.n_nonzeros, "nonzero", "nonzeros");
    let mut parts = vec![format!("{nonzeros}, both triangles counted")];
    parts.extend(facts.layout.map(|layout| format!("from {}", layout.name())));
    parts.push(stored(facts.triangle).to_owned());
    parts.extend([symmetry.to_owned(), facts.digits.in_words(), format!("blake3 {digest}…")]);
    parts.join(" · ")
}

/// Which triangles a file has.
fn stored(triangle: Option<Triangle>) -> &'static str {
    match triangle {
        Some(Triangle::Lower) => "lower triangle stored",
        Some(Triangle::Upper) => "upper triangle stored",
        None => "both triangles stored",
    }
}

fn modes(page: &mut Page, body: &ReportBody) {
    let modes: Vec<String> = body
        .reduction
        .modes
        .iter()
        .map(|mode| format!("{} ± {}", quantity(mode.frequency_hz, 7), scientific(mode.error_bar_hz, 1)))
        .collect();
    let said = if modes.is_empty() { "none".to_owned() } else { modes.join(" · ") };
    page.entry("frequencies", &format!("{said} Hz"));
}

fn told(page: &mut Page, finding: &Finding) {
    let (sign, verdict) = match finding.severity {
        Severity::Error => ("✗", Verdict::Fail),
        Severity::Warning => ("!", Verdict::Warn),
        Severity::Remark => ("·", Verdict::Info),
    };
    let code = finding.code.map_or_else(String::new, |code| format!(" [{code}]"));
    let lines = table::wrap(&format!("{}{code}", finding.what), WIDTH - 4);
    for (at, line) in lines.iter().enumerate() {
        let sign = if at == 0 { Page::toned(sign, Tone::Of(verdict)) } else { " ".into() };
        page.spans(&["  ".into(), sign, " ".into(), line.into()]);
    }
    for (label, text) in [("do: ", Some(&finding.remedy)), ("went on ", finding.went_on.as_ref())] {
        let Some(text) = text.filter(|text| !text.is_empty()) else { continue };
        for line in table::wrap(&format!("{label}{text}"), WIDTH - 6) {
            page.spans(&["      ".into(), Page::toned(&line, Tone::Faint)]);
        }
    }
    finding.lines.iter().for_each(|line| page.line(&format!("          {line}")));
}
