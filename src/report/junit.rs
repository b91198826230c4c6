//! The checks as JUnit XML, which continuous integration shows together with its other tests.
//!
//! The writer is our own: `quick-junit` would bring chrono, uuid and four other crates for the forty lines it saves, and drops the
//! characters that XML cannot hold where we show them.

use std::fmt::Write;

use super::conclusion::Reservations;
use super::html::escaped;
use super::{CertifiedModel, Completeness, Report, RunFacts, words};
use crate::error::Warning;
use crate::number::scientific;
use crate::verification::check::{Check, Verdict};

/// How one test ended.
enum Outcome {
    Passed,
    /// Passed, with something to say, line by line.
    Told(Vec<String>),
    Failed {
        kind: &'static str,
        message: String,
        details: Vec<String>,
    },
    Skipped(String),
}

/// One suite for the run; a test for each check, one for completeness, one for each warning. Values past their limits, warnings and a missing
/// certificate have passed, with what they say as output, where the run accepts them.
pub fn junit(report: &Report) -> String {
    let (body, reservations) = (&report.body, report.run.reservations);
    let mut cases = of_checks(&body.checks, reservations);
    cases.push(("completeness of the modes".to_owned(), of_completeness(&body.completeness, reservations)));
    cases.extend(body.warnings.iter().map(|warning| (warning.code.to_owned(), of_warning(warning, reservations))));
    let seconds: f64 = report.run.stages.iter().map(|stage| stage.seconds).sum();
    written(&suite(report), seconds, |xml| write_properties(xml, &report.run), cases)
}

/// One suite for what another program computed; a test for each check and for each warning of the model.
pub(super) fn certified(subject: &str, checks: &[Check], model: &CertifiedModel, reservations: Reservations) -> String {
    let mut cases = of_checks(checks, reservations);
    cases.extend(model.warnings.iter().map(|warning| (warning.code.to_owned(), of_warning(warning, reservations))));
    let name = format!("certification of {subject}, {} degrees of freedom", model.n_dofs);
    written(&escaped(&name), 0.0, |_| {}, cases)
}

fn of_checks(checks: &[Check], reservations: Reservations) -> Vec<(String, Outcome)> {
    checks.iter().map(|check| (format!("{} {}", check.id, check.name), of_check(check, reservations))).collect()
}

/// The document of one suite, whose name is escaped.
fn written(
    suite: &str,
    seconds: f64,
    write_properties: impl FnOnce(&mut String),
    cases: Vec<(String, Outcome)>,
) -> String {
    let n_failed = cases.iter().filter(|(_, outcome)| matches!(outcome, Outcome::Failed { .. })).count();
    let n_skipped = cases.iter().filter(|(_, outcome)| matches!(outcome, Outcome::Skipped(_))).count();
    let counts = format!(
        "tests=\"{}\" failures=\"{n_failed}\" errors=\"0\" skipped=\"{n_skipped}\" time=\"{seconds:.3}\"",
        cases.len()
    );
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(xml, "<testsuites name=\"supel\" {counts}>\n  <testsuite name=\"{suite}\" {counts}>");
    write_properties(&mut xml);
    let mut seen: Vec<String> = Vec::new();
    for (name, outcome) in cases {
        // Servers take tests of one name for one test.
        let n_before = seen.iter().filter(|earlier| **earlier == name).count();
        let numbered = if n_before > 0 { format!("{name} ({})", n_before + 1) } else { name.clone() };
        seen.push(name);
        write_case(&mut xml, &numbered, &outcome);
    }
    xml.push_str("  </testsuite>\n</testsuites>\n");
    xml
}

/// Which superelement the checks are about.
fn write_properties(xml: &mut String, run: &RunFacts) {
    let name = run.superelement.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
    let Some((name, digest)) = name.zip(run.file_digest.as_ref()) else { return };
    let _ = writeln!(xml, "    <properties>");
    for (property, value) in [("superelement", name.as_ref()), ("blake3", digest)] {
        let _ = writeln!(xml, "      <property name=\"{property}\" value=\"{}\"/>", escaped(value));
    }
    let _ = writeln!(xml, "    </properties>");
}

/// Lines that stay lines.
fn escaped_lines(lines: &[String]) -> String {
    lines.iter().map(|line| escaped(line)).collect::<Vec<_>>().join("\n")
}

/// The suite is named after the method and the sizes; the file is named by whoever collects it.
fn suite(report: &Report) -> String {
    let reduction = &report.body.reduction;
    let sizes = format!("{} to {} degrees of freedom", report.body.model.n_dofs, reduction.n_reduced);
    escaped(&format!("{} reduction, {sizes}", reduction.method.name()))
}

fn of_check(check: &Check, reservations: Reservations) -> Outcome {
    let (value, limit) = (scientific(check.value, 3), scientific(check.limits.value(), 3));
    let message = format!("{}: value {value}, limit {limit}", check.id);
    let worst = check.worst.as_ref().map(|worst| format!("worst: {worst}"));
    let limits = if check.is_judged() {
        let source = words::active_limit(check.limits.active());
        let fails = match check.fails_above() {
            Check::NEVER => "never fails".to_owned(),
            fail_above => format!("fails above {}", scientific(fail_above, 3)),
        };
        format!("limit {limit}, set by {source}; {fails}")
    } else {
        "no limit: shown, not judged".to_owned()
    };
    let mut details = vec![check.name.to_owned(), format!("{} = {value}", check.equation), limits];
    details.extend(worst);
    match (check.verdict(), reservations) {
        (Verdict::Info, _) => Outcome::Told(details),
        (Verdict::Pass, _) => Outcome::Passed,
        (Verdict::Warn, Reservations::Accepted) => {
            details.insert(0, "past the limit".to_owned());
            Outcome::Told(details)
        }
        (Verdict::Warn, Reservations::Refused) => Outcome::Failed { kind: "warn", message, details },
        (Verdict::Fail, _) => Outcome::Failed { kind: "fail", message, details },
    }
}

fn of_completeness(completeness: &Completeness, reservations: Reservations) -> Outcome {
    let message = completeness.statement();
    match completeness {
        Completeness::NotCertified { .. } => Outcome::Skipped(message),
        Completeness::SturmCount { .. } if completeness.is_certified() => Outcome::Told(vec![message]),
        Completeness::SturmCount { n_counted, n_found, .. } if n_counted == n_found => of_told(message, reservations),
        Completeness::SturmCount { .. } => Outcome::Failed { kind: "fail", details: vec![message.clone()], message },
    }
}

fn of_warning(warning: &Warning, reservations: Reservations) -> Outcome {
    of_told(warning.message.clone(), reservations)
}

fn of_told(message: String, reservations: Reservations) -> Outcome {
    match reservations {
        Reservations::Accepted => Outcome::Told(vec![message]),
        Reservations::Refused => Outcome::Failed { kind: "warn", details: vec![message.clone()], message },
    }
}

fn write_case(xml: &mut String, name: &str, outcome: &Outcome) {
    let name = escaped(name);
    let open = format!("    <testcase classname=\"supel\" name=\"{name}\" time=\"0\"");
    let _ = match outcome {
        Outcome::Passed => writeln!(xml, "{open}/>"),
        Outcome::Told(words) => {
            writeln!(xml, "{open}>\n      <system-out>{}</system-out>\n    </testcase>", escaped_lines(words))
        }
        Outcome::Failed { kind, message, details } => writeln!(
            xml,
            "{open}>\n      <failure type=\"{kind}\" message=\"{}\">{}</failure>\n    </testcase>",
            escaped(message),
            escaped_lines(details)
        ),
        Outcome::Skipped(message) => {
            writeln!(xml, "{open}>\n      <skipped message=\"{}\"/>\n    </testcase>", escaped(message))
        }
    };
}
