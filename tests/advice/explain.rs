//! `supel explain`: the page of a code, and all codes.

use serde_json::Value;
use supel::cli::ExitCode;
use supel::error::Error;
use supel::verification::catalogue::{CATALOGUE, OF_RESULTS};
use supel_testing::place::supel;
use supel_testing::schema::{assert_follows, validator};

fn all() -> Value {
    let ended = supel(&["explain", "--json"]).expect(ExitCode::Done);
    let document: Value = serde_json::from_str(&ended.out).expect("JSON");
    assert_follows(&validator("explain"), &document);
    document
}

fn one(code: &str) -> Value {
    serde_json::from_str(&supel(&["explain", code, "--json"]).expect(ExitCode::Done).out).expect("JSON")
}

fn codes(document: &Value) -> Vec<&str> {
    document["entries"]
        .as_array()
        .expect("entries")
        .iter()
        .map(|entry| entry["code"].as_str().expect("a code"))
        .collect()
}

#[test]
fn every_code_has_its_page() {
    let document = all();
    let codes = codes(&document);
    let of_errors = Error::CODES.iter().map(|entry| entry.code);
    let of_checks = CATALOGUE.iter().chain(OF_RESULTS).map(|entry| entry.id);
    for code in of_errors.chain(of_checks).chain(["E-USAGE", "E-INTERNAL", "W-GROUNDED", "W-ACCURACY"]) {
        assert!(codes.contains(&code), "{code}");
    }
    let mut once = codes.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), codes.len(), "each code once");
    for entry in document["entries"].as_array().expect("entries") {
        let code = entry["code"].as_str().expect("a code");
        let page =
            supel(&["explain", code]).expect(ExitCode::Done).out.split_whitespace().collect::<Vec<_>>().join(" ");
        for key in ["what", "remedy"] {
            let said = entry[key].as_str().expect("text").split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(!said.is_empty() && page.contains(&said), "{code}, {key}: {page}");
        }
    }
}

/// Every code that a message of the program's own sources can end with is known, warnings included.
#[test]
fn no_code_of_the_documentation_is_left_out() {
    let document = all();
    let codes = codes(&document);
    let page = include_str!("../../docs/errors.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`'));
    let of_page: Vec<&str> =
        rows.map(|(code, _)| code).filter(|code| code.starts_with("E-") || code.starts_with("W-")).collect();
    assert!(of_page.len() > 100);
    of_page.iter().for_each(|code| assert!(codes.contains(code), "{code}"));
}

#[test]
fn a_code_may_be_typed_as_it_is_read() {
    let page = supel(&["explain", "E-SWAPPED"]).expect(ExitCode::Done).out;
    assert!(page.contains("error, exit code 3") && page.contains("exchange the two files"), "{page}");
    for typed in ["e-swapped", "swapped", "error[E-SWAPPED]", "[E-SWAPPED]", "e_swapped"] {
        assert_eq!(supel(&["explain", typed]).expect(ExitCode::Done).out, page, "{typed}");
    }
    let check = supel(&["explain", "m-06"]).expect(ExitCode::Done).out;
    assert!(check.contains("check of a report") && check.contains("without computing a single mode"), "{check}");
    for typed in ["M-6", "m-006", "[M-6]"] {
        assert_eq!(supel(&["explain", typed]).expect(ExitCode::Done).out, check, "{typed}");
    }
    for (typed, code) in [("C-1", "C-01"), ("M-26", "M-26")] {
        assert_eq!(codes(&one(typed)), [code]);
    }
}

#[test]
fn an_unknown_code_offers_one_that_is_like_it() {
    for (typed, offered) in [("E-SWAPED", "E-SWAPPED"), ("W-GRUONDED", "W-GROUNDED"), ("swaped", "E-SWAPPED")] {
        let ended = supel(&["explain", typed]).expect(ExitCode::Usage);
        assert!(ended.err.contains("E-CODE") && ended.err.contains(&format!("`{offered}`")), "{}", ended.err);
    }
    let ended = supel(&["explain", "zzzzzzzz"]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-CODE") && !ended.err.contains("did you mean"), "{}", ended.err);
}

#[test]
fn the_list_has_every_code_on_a_line() {
    let list = supel(&["explain"]).expect(ExitCode::Done).out;
    for code in codes(&all()) {
        assert!(list.lines().any(|line| line.split_whitespace().next() == Some(code)), "{code}");
    }
    assert!(list.lines().all(|line| line.chars().count() <= 100), "{list}");
}
