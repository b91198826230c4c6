//! The page for people: what it says, that nobody can write into it, how a browser shows it; and the same checks as
//! JUnit XML.

mod browser;
mod command;
mod content;
mod junit;
mod structure;

use supel_testing::sample;

use roxmltree::{Document, Node};
use supel::report::Report;
use supel::verification::catalogue::CATALOGUE;
use supel::verification::check::{Check, Limits};

/// A report with a check for every identifier, some of them past their limits.
fn report_of_all_checks() -> Report {
    let mut report = sample::full_report();
    report.body.checks = CATALOGUE
        .iter()
        .enumerate()
        .map(|(place, entry)| Check {
            id: entry.id,
            name: "a measure of the reduction",
            equation: "|a − b| / |b|",
            value: match place % 9 {
                1 => 3e-12,
                2 => 1e-6,
                _ => 1e-15,
            },
            limits: Limits { engineering: 1e-12, arithmetic: 1e-13, data: 1e-16 * place as f64 },
            fail_above: 1e-9,
            worst: Some("node 12 uz".to_owned()),
        })
        .collect();
    report
}

/// The page read back by a strict XML parser.
fn parse(page: &str) -> Document<'_> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    Document::parse_with_options(page, options).unwrap_or_else(|error| panic!("the page is not well-formed: {error}"))
}

/// All text below a node, with blanks between the pieces.
fn text(node: Node<'_, '_>) -> String {
    let pieces: Vec<&str> = node.descendants().filter(Node::is_text).filter_map(|piece| piece.text()).collect();
    pieces.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[track_caller]
fn by_id<'a, 'input>(page: &'a Document<'input>, id: &str) -> Node<'a, 'input> {
    let found = page.descendants().find(|node| node.attribute("id") == Some(id));
    found.unwrap_or_else(|| panic!("no element `{id}`"))
}
