//! What the page says.

use std::collections::BTreeSet;
use std::path::Path;

use supel::error::Warning;
use supel::report::{Completeness, RigidBodyEvidence, html};
use supel::verification::catalogue::{CATALOGUE, Entry, OF_RESULTS, Proof};
use supel::verification::check::Verdict;
use supel::verification::preservation::Preservation;

use super::{by_id, parse, report_of_all_checks, sample, text};

const SCOPE: &str =
    "Proves that the reduction reproduces the supplied K and M. Does not validate the finite element model.";

/// Where the cells of a mesh are of a kind that is not read, summary and page say so in the place of the centroid.
#[test]
fn faces_that_are_not_known_are_told_with_the_reason() {
    let mut report = sample::passing_report();
    let reason = "the mesh has what supel does not read, cells of type POE";
    let at = report.body.reduction.interfaces.iter_mut().flat_map(|interface| &mut interface.at);
    at.for_each(|at| at.faces_unknown = at.faces.take().map(|_| reason.to_owned()));
    let told = format!("the mean of its nodes; the centroid of its faces is not known: {reason}");
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(one_line(&html(&report)).contains(&told), "{}", html(&report));
    let summary = supel::report::summary(&report, supel::report::Paint::Plain);
    assert!(one_line(&summary).contains(&told), "{summary}");
}

#[test]
fn first_page_has_all_that_is_signed_for() {
    let mut report = sample::passing_report();
    report.body.warnings = sample::full_report().body.warnings;
    report.body.reduction.dropped = sample::full_report().body.reduction.dropped;
    let page = html(&report);
    let page = parse(&page);
    let front = text(by_id(&page, "verdict"));
    for expected in [
        "Verified, with warnings",
        SCOPE,
        "123,486 degrees of freedom, 41,162 nodes, 1 body, 6 rigid-body motions",
        "mm-t-s",
        &"a".repeat(64),
        &"b".repeat(64),
        "Herting; modes by block Lanczos",
        "65 coordinates: 9 interface, 6 inertia relief, 50 elastic modes",
        "50 free-interface modes, 100 Hz to 16168.2 Hz",
        "a Sturm count finds 56 below 16200.25 Hz and all were found",
        "hub held, interface hub was held: frequencies off by at most",
        "up to 7818.9 Hz",
        "response, free: off by at most",
        "static stiffness at rim: it has 96 dofs",
        "stiffness: declared general but held one triangle; it was mirrored",
        "left out mode 7: spanned by the constraint modes to 2.3e-11",
        "constraint modes corrected",
        "W-INTERFACE-ILL: the interface holds",
        "Prepared",
        "Name Role Date Signature",
    ] {
        assert!(front.contains(expected), "`{expected}` is not in:\n{front}");
    }
    let file = text(by_id(&page, "of-run"));
    assert_eq!(file, format!("Superelement bracket.supel BLAKE3 {}", "c".repeat(64)));
}

#[test]
fn verdict_comes_first_and_counts_the_checks() {
    let said = |report| {
        let page = html(&report);
        text(by_id(&parse(&page), "verdict"))
    };
    let failing = report_of_all_checks();
    assert_eq!(failing.body.verdict(), Verdict::Fail);
    let failing = said(failing);
    let expected = "✗ Not verified 27 of 35 checks passed; failed: M-03, M-12, M-21, M-30; past the limit: M-02, M-11, M-20, M-29; 1 warning.";
    assert!(failing.contains(expected), "{failing}");
    let mut incomplete = sample::passing_report();
    for (n_found, doubt, expected) in
        [(56, 0.1, "passed."), (56, 1.5, "likely, not certified."), (55, 0.1, "modes are missing.")]
    {
        incomplete.body.completeness = Completeness::SturmCount { below_hz: 1.0, n_counted: 56, n_found, doubt };
        let said = said(incomplete.clone());
        assert!(said.contains(expected), "{said}");
        assert_eq!(said.contains("✓ Verified"), n_found == 56 && doubt < 1.0, "{said}");
    }
    assert!(failing.contains("Does not prove that") && !failing.contains(SCOPE), "{failing}");
    let passing = said(sample::passing_report());
    assert!(passing.contains("✓ Verified 1 of 1 check passed.") && passing.contains(SCOPE), "{passing}");
}

#[test]
fn every_part_of_the_evidence_is_shown() {
    let page = html(&sample::full_report());
    let page = parse(&page);
    for (section, expected) in [
        ("rigid-body", "through the reduced stiffness"),
        ("rigid-body", "expected by the job"),
        ("table-mass", "Mass properties by independent routes"),
        ("table-rigid", "zero but for rounding"),
        ("table-grounding", "Strain energy of each rigid-body motion"),
        ("rigid-body", "node 285 uz"),
        ("figure-effective-mass", "translation x"),
        ("modes", "pivot growth"),
        ("modes", "proved above, Hz"),
        ("modes", "16168.1752"),
        ("figure-frequency-error", "reduced against full"),
        ("figure-mac", "The smallest value on the diagonal is 0.7000 (mode 4)"),
        ("figure-boundaries", "hub loaded"),
        ("preservation", "uz of node 812"),
        ("response", "driven at hub rx and observed at foot uz of node 812"),
        ("response", "361, each with the full model solved anew"),
        ("response", "scaled by the length 83.4"),
        ("size", "stable up to a step of 5.20\u{a0}×\u{a0}10⁻⁶ s"),
        ("size", "With 0 elastic modes"),
        ("preservation", "Not compared: static stiffness at rim"),
        ("checks", "M-19 effective mass of the kept modes, least carried 8.3e-01 – – – · shown"),
        ("run", "4.20 s"),
        ("run", "/models/bracket.report.json"),
    ] {
        let found = text(by_id(&page, section));
        // The words are compared without regard to blanks that no line breaks.
        let (found, expected) = (found.replace('\u{a0}', " "), expected.replace('\u{a0}', " "));
        assert!(found.contains(&expected), "`{expected}` is not in `{section}`:\n{found}");
    }
    for section in ["verdict", "preservation", "response", "size"] {
        let found = text(by_id(&page, section));
        assert!(!found.contains("fix:") && !found.contains("mass:hub"), "a code of the job in `{section}`:\n{found}");
    }
    let modes = page.descendants().filter(|node| node.attribute("id") == Some("table-modes"));
    assert_eq!(modes.count(), 1);
    let table = by_id(&page, "table-modes").parent().expect("a table");
    assert_eq!(table.descendants().filter(|node| node.tag_name().name() == "tr").count(), 51);
}

#[test]
fn absent_evidence_is_named_as_absent() {
    let mut report = sample::passing_report();
    report.body.rigid_body = RigidBodyEvidence::default();
    report.body.preservation = Preservation::default();
    report.body.trust_intervals.clear();
    report.body.model.mass_properties = Default::default();
    report.body.model.units = None;
    report.body.reduction.modes.clear();
    report.run = Default::default();
    let page = html(&report);
    let page = parse(&page);
    let absent = page.descendants().filter(|node| node.attribute("class") == Some("absent")).count();
    assert_eq!(absent, 13, "parts that are absent and say so");
    assert_eq!(page.descendants().filter(|node| node.tag_name().name() == "svg").count(), 0);
    assert!(text(by_id(&page, "verdict")).contains("Compared with full model nothing"));
    assert!(text(by_id(&page, "of-run")).contains("No superelement was written"));
}

#[test]
fn every_check_is_explained_and_advice_follows_what_is_past_its_limit() {
    let report = report_of_all_checks();
    let page = html(&report);
    let page = parse(&page);
    for (entry, check) in CATALOGUE.iter().zip(&report.body.checks) {
        let told = text(by_id(&page, &format!("check-{}", entry.id)));
        assert!(told.contains(entry.meaning), "{told}");
        assert!(told.to_lowercase().contains(&format!(" {}.", entry.proof.word())), "{told}");
        assert!(told.contains("; node 12 uz"), "{told}");
        assert_eq!(told.contains(entry.remedy), check.verdict() != Verdict::Pass, "{told}");
    }
}

#[test]
fn the_catalogue_has_each_check_once_in_order() {
    assert!(CATALOGUE.windows(2).all(|pair| pair[0].id < pair[1].id));
    let sources = source_files(Path::new(env!("CARGO_MANIFEST_DIR")).join("src").as_path());
    let made: BTreeSet<String> = sources.iter().flat_map(|source| identifiers(source)).collect();
    assert!(OF_RESULTS.windows(2).all(|pair| pair[0].id < pair[1].id));
    let known: BTreeSet<String> = CATALOGUE.iter().chain(OF_RESULTS).map(|entry| entry.id.to_owned()).collect();
    assert_eq!(made, known, "checks that the source names, and those of the catalogue");
}

/// The text of all sources but the catalogue, which would name each check in any case.
fn source_files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("sources").map(|entry| entry.expect("entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let of_this = files.iter().filter(|file| file.file_name().is_some_and(|name| name != "catalogue.rs"));
    let mut texts: Vec<String> = of_this.map(|file| std::fs::read_to_string(file).expect("text")).collect();
    texts.extend(folders.iter().flat_map(|folder| source_files(folder)));
    texts
}

/// Every `"M-05"` and `"C-01"` of a source, which is how code names a check.
fn identifiers(source: &str) -> Vec<String> {
    let starts = ["\"M-", "\"C-"].into_iter().flat_map(|start| source.match_indices(start));
    let starts = starts.map(|(place, _)| &source[place + 1..]);
    starts.filter(|rest| rest.as_bytes().get(4) == Some(&b'"')).map(|rest| rest[..4].to_owned()).collect()
}

/// The tables of the documentation are made from the catalogue: `SUPEL_UPDATE_DOCS=1 cargo test --test report_html documentation`
/// writes them.
fn with_table(document: &str, entries: &[Entry]) -> String {
    const HEAD: &str = "| check | answer | what is measured and why |\n|---|---|---|\n";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(document);
    let document = std::fs::read_to_string(&path).expect("document");
    let (before, rest) = document.split_once(HEAD).expect("head of the table");
    let (_, after) = rest.split_once("\n\n").expect("end of the table");
    let rows = entries.iter().map(|entry| format!("| {} | {} | {} |", entry.id, entry.proof.word(), entry.meaning));
    let made = format!("{before}{HEAD}{}\n\n{after}", rows.collect::<Vec<_>>().join("\n"));
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, &made).expect("written");
    } else {
        assert!(document == made, "the table is another: SUPEL_UPDATE_DOCS=1 writes it");
    }
    made
}

#[test]
fn documentation_has_the_table_of_results() {
    with_table("docs/certify.md", OF_RESULTS);
}

#[test]
fn documentation_has_the_table_of_the_catalogue() {
    let made = with_table("docs/what-the-report-proves.md", CATALOGUE);
    let words = made.replace('`', "").split_whitespace().collect::<Vec<_>>().join(" ");
    for proof in [Proof::Certified, Proof::Measured, Proof::Estimated, Proof::Shown] {
        let definition = format!("**{}**: {}", proof.word(), proof.meaning());
        assert!(words.contains(&definition), "not in the documentation: {definition}");
    }
    assert!(words.contains(SCOPE));
}

#[test]
fn hostile_names_stay_text() {
    const HOSTILE: &str = "</title><script>alert('x')</script>\"><img src=x onerror=alert(1)> & &amp; ]]> \u{202e}drawkcab\u{0}\u{1b}[31m \u{ffff}";
    let mut report = sample::full_report();
    let quiet = html(&report);
    let body = &mut report.body;
    body.model.units = Some(HOSTILE.to_owned());
    body.model.notes.push(HOSTILE.to_owned());
    body.reduction.interfaces[0].name = HOSTILE.to_owned();
    body.reduction.dropped[0].reason = HOSTILE.to_owned();
    body.warnings.push(Warning { code: "W-X", message: HOSTILE.to_owned() });
    body.checks[0].worst = Some(HOSTILE.to_owned());
    body.rigid_body.grounding[0].direction = HOSTILE.to_owned();
    body.rigid_body.grounding[0].worst = Some(HOSTILE.to_owned());
    body.preservation.boundaries[1].boundary = HOSTILE.to_owned();
    body.preservation.boundaries[1].description = HOSTILE.to_owned();
    body.preservation.statics[0].interface = HOSTILE.to_owned();
    body.preservation.statics[0].dofs[0] = HOSTILE.to_owned();
    let response = body.preservation.response.as_mut().expect("response");
    response.worst_pair = [HOSTILE.to_owned(), HOSTILE.to_owned()];
    response.boundary = HOSTILE.to_owned();
    report.run.superelement = Some(format!("/a/{}.supel", HOSTILE.replace('/', "_")).into());
    let hostile = html(&report);
    let (quiet, page) = (parse(&quiet), parse(&hostile));
    let count = |page: &roxmltree::Document<'_>, name: &str| {
        page.descendants()
            .filter(|node| node.is_element() && (name.is_empty() || node.tag_name().name() == name))
            .count()
    };
    for name in ["script", "img", "title", "style", "a"] {
        assert_eq!(count(&page, name), count(&quiet, name), "<{name}>");
    }
    assert!(
        text(by_id(&page, "verdict"))
            .contains("<script>alert('x')</script>\"><img src=x onerror=alert(1)> & &amp; ]]>")
    );
    for character in ['\u{202e}', '\u{0}', '\u{1b}', '\u{ffff}'] {
        assert!(!hostile.contains(character), "{character:?} is on the page");
    }
}

#[test]
fn values_that_are_no_numbers_leave_a_page() {
    let mut report = sample::full_report();
    let body = &mut report.body;
    body.checks[0].value = f64::NAN;
    for mode in &mut body.reduction.modes {
        (mode.frequency_hz, mode.error_bar_hz) = (0.0, f64::INFINITY);
    }
    for mode in &mut body.preservation.modes {
        (mode.relative_difference, mode.mac) = (f64::NAN, f64::NAN);
    }
    body.preservation.mac.iter_mut().flatten().for_each(|value| *value = f64::NAN);
    for sample in &mut body.preservation.response.as_mut().expect("response").samples {
        (sample.full, sample.error_db) = (f64::NAN, f64::INFINITY);
    }
    for pair in body.preservation.boundaries.iter_mut().flat_map(|line| &mut line.frequencies) {
        (pair.full_hz, pair.relative_difference) = (f64::INFINITY, f64::NAN);
    }
    for mode in &mut body.rigid_body.effective_mass {
        mode.cumulated.iter_mut().for_each(|value| *value = f64::NAN);
    }
    body.preservation.size_errors.iter_mut().for_each(|size| size.frequency_error = 0.0);
    let page = html(&report);
    assert!(text(by_id(&parse(&page), "verdict")).contains("Not verified"));
}

/// What may differ between runs stands in two elements, and nowhere else.
#[test]
fn body_is_the_same_for_every_run() {
    let body = |page: &str| {
        let page = parse(page);
        let range = by_id(&page, "body").range();
        page.input_text()[range].to_owned()
    };
    let one = sample::passing_report();
    let mut other = one.clone();
    other.run = Default::default();
    let (one, other) = (html(&one), html(&other));
    assert_ne!(one, other);
    assert_eq!(body(&one), body(&other));
}

#[test]
fn page_reads_well_with_few_modes_and_with_many() {
    for n_modes in [1, 2, 14, 400] {
        let mut report = sample::passing_report();
        let row = report.body.reduction.modes[0];
        report.body.reduction.modes = (1..=n_modes).map(|index| supel::report::ModeRow { index, ..row }).collect();
        report.body.preservation.modes.truncate(n_modes);
        let is_same = |row, column| if row == column { 1.0 } else { 0.0 };
        report.body.preservation.mac =
            (0..n_modes).map(|row| (0..n_modes).map(|column| is_same(row, column)).collect()).collect();
        report.body.rigid_body.effective_mass.truncate(n_modes);
        report.body.preservation.size_errors.truncate(n_modes);
        let page = html(&report);
        assert!(page.len() < 600_000, "{} bytes for {n_modes} modes", page.len());
        assert_eq!(parse(&page).descendants().filter(|node| node.tag_name().name() == "svg").count(), 7);
    }
}
