//! The answer as a document, a page and a test suite.

use supel::cli::ExitCode;
use supel_testing::schema::{assert_follows, validator};

use super::{bar, certify, document, lowest, place_of};

#[test]
fn the_document_follows_its_schema() {
    let schema = validator("certification");
    let mut pairs = lowest(&bar(), 14);
    pairs.hertz[9] *= 1.02;
    pairs.shapes[11] = pairs.shapes[10].clone();
    pairs.shapes[12] = (0..pairs.shapes[0].len()).map(|row| (0.7 * row as f64).sin()).collect();
    for (pairs, code) in [(lowest(&bar(), 14), ExitCode::Done), (pairs, ExitCode::CheckFailed)] {
        let found = document(&place_of(&bar(), &pairs), "", code);
        assert_follows(&schema, &found);
    }
}

#[test]
fn page_and_test_suite_say_what_failed() {
    let lost = lowest(&bar(), 14).without(9);
    let frequency = lowest(&bar(), 14).hertz[9];
    let place = place_of(&bar(), &lost);
    let [html, junit] = ["x.html", "x.xml"].map(|name| place.text(name));
    let quiet = certify(&place, &format!("--quiet --html {html} --junit {junit}")).expect(ExitCode::CheckFailed);
    assert!(quiet.out.is_empty() && quiet.err.contains("M-06 no mode is missing"), "{}", quiet.err);
    let [html, junit] = ["x.html", "x.xml"].map(|name| String::from_utf8(place.bytes(name)).expect("UTF-8"));
    let told = &format!("{frequency:.6}")[..7];
    let page = roxmltree::Document::parse_with_options(&html, options()).expect("well-formed");
    let text: String = page.descendants().filter_map(|node| node.text()).collect();
    assert!(text.contains("Not certified") && text.contains(told), "{text}");
    let suite = roxmltree::Document::parse(&junit).expect("well-formed");
    let failures: Vec<_> = suite.descendants().filter(|node| node.has_tag_name("failure")).collect();
    assert_eq!(failures.len(), 1);
    assert!(failures[0].text().expect("details").contains("worst: "), "{junit}");
    // Nothing of it depends on the number of threads.
    let one = document(&place, "--threads 1", ExitCode::CheckFailed);
    assert_eq!(one, document(&place, "--threads 3", ExitCode::CheckFailed));
}

fn options<'a>() -> roxmltree::ParsingOptions<'a> {
    roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() }
}
