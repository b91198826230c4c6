//! The checks as JUnit XML.

use roxmltree::Document;
use supel::error::Warning;
use supel::report::{Completeness, Reservations, junit};

use super::sample;

/// Name and the element that says how it ended, of each test.
fn cases<'a>(document: &'a Document<'_>) -> Vec<(&'a str, &'a str)> {
    let cases = document.descendants().filter(|node| node.tag_name().name() == "testcase");
    cases
        .map(|case| {
            let outcome = case.children().find(roxmltree::Node::is_element);
            (case.attribute("name").expect("a name"), outcome.map_or("", |outcome| outcome.tag_name().name()))
        })
        .collect()
}

#[test]
fn one_suite_with_a_test_for_each_check() {
    let xml = junit(&sample::full_report());
    let document = Document::parse(&xml).expect("well-formed");
    assert_eq!(
        cases(&document),
        [
            ("M-01 eigenpair backward error", ""),
            ("M-09 error bar from the digits of the input", "system-out"),
            ("M-16 mass properties of the reduced model against those of the full one", "failure"),
            ("M-19 effective mass of the kept modes, least carried", "system-out"),
            ("completeness of the modes", "system-out"),
            ("W-INTERFACE-ILL", "system-out"),
        ]
    );
    for name in ["testsuites", "testsuite"] {
        let suite = document.descendants().find(|node| node.tag_name().name() == name).expect("a suite");
        let counts = ["tests", "failures", "errors", "skipped"].map(|count| suite.attribute(count).expect("a count"));
        assert_eq!(counts, ["6", "1", "0", "0"], "{name}");
        assert_eq!(suite.attribute("time"), Some("12.414"));
    }
    let failure = document.descendants().find(|node| node.tag_name().name() == "failure").expect("a failure");
    assert_eq!(failure.attribute("message"), Some("M-16: value 2.50e-02, limit 3.00e-09"));
    assert!(failure.text().expect("details").contains("set by arithmetic; fails above 1.00e-06"));
}

#[test]
fn warnings_fail_where_strictness_asks_and_a_missing_certificate_is_skipped() {
    let mut report = sample::full_report();
    report.body.completeness = Completeness::NotCertified { reason: "--certify none was asked".to_owned() };
    report.run.reservations = Reservations::Refused;
    let xml = junit(&report);
    let document = Document::parse(&xml).expect("well-formed");
    let outcomes: Vec<&str> = cases(&document).into_iter().map(|(_, outcome)| outcome).collect();
    assert_eq!(outcomes, ["", "failure", "failure", "system-out", "skipped", "failure"]);
    report.body.completeness = Completeness::SturmCount { below_hz: 1.0, n_counted: 8, n_found: 7, doubt: 0.0 };
    report.run.reservations = Reservations::Accepted;
    let xml = junit(&report);
    assert_eq!(cases(&Document::parse(&xml).expect("well-formed"))[4].1, "failure");
    // Equal counts with signs that are not certain: a warning.
    report.body.completeness = Completeness::SturmCount { below_hz: 1.0, n_counted: 8, n_found: 8, doubt: 1.5 };
    for (reservations, expected) in [(Reservations::Accepted, "system-out"), (Reservations::Refused, "failure")] {
        report.run.reservations = reservations;
        let xml = junit(&report);
        assert_eq!(cases(&Document::parse(&xml).expect("well-formed"))[4].1, expected);
    }
}

#[test]
fn hostile_text_and_repeated_names_leave_it_well_formed() {
    let mut report = sample::full_report();
    let hostile = "]]></failure><x y=\"&\" z='\u{0}\u{b}'>\n second line";
    report.body.checks[2].worst = Some(hostile.to_owned());
    report.body.checks.push(report.body.checks[2].clone());
    report.body.warnings.push(Warning { code: "W-INTERFACE-ILL", message: hostile.to_owned() });
    report.run.reservations = Reservations::Refused;
    let xml = junit(&report);
    let document = Document::parse(&xml).expect("well-formed");
    let mut names: Vec<&str> = cases(&document).into_iter().map(|(name, _)| name).collect();
    let n_cases = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), n_cases, "two tests of one name");
    assert!(xml.contains("]]&gt;&lt;/failure&gt;&lt;x y=&quot;&amp;&quot;"));
}
