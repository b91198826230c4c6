//! The page as a document: whole, accessible, alone.

use std::collections::BTreeSet;

use roxmltree::Node;
use supel::report::html;

use super::{parse, report_of_all_checks, sample};

fn elements<'a, 'input>(page: &'a roxmltree::Document<'input>, name: &str) -> Vec<Node<'a, 'input>> {
    page.descendants().filter(|node| node.tag_name().name() == name).collect()
}

#[test]
fn identifiers_are_unique_and_references_lead_somewhere() {
    let page = html(&report_of_all_checks());
    let page = parse(&page);
    let mut ids = BTreeSet::new();
    for id in page.descendants().filter_map(|node| node.attribute("id")) {
        assert!(ids.insert(id), "the identifier {id} stands twice");
    }
    let labels = page.descendants().filter_map(|node| node.attribute("aria-labelledby"));
    let links = page.descendants().filter_map(|node| node.attribute("href"));
    let links: Vec<&str> = links.map(|link| link.strip_prefix('#').expect("links stay on the page")).collect();
    assert!(links.len() >= 7);
    for reference in labels.flat_map(str::split_whitespace).chain(links) {
        assert!(ids.contains(reference), "{reference} is not on the page");
    }
}

#[test]
fn headings_descend_one_level_at_a_time_from_the_verdict() {
    for report in [report_of_all_checks(), sample::passing_report()] {
        let page = html(&report);
        let page = parse(&page);
        let level = |node: Node<'_, '_>| match node.tag_name().name() {
            "h1" => Some(1),
            "h2" => Some(2),
            "h3" => Some(3),
            "h4" => Some(4),
            _ => None,
        };
        let levels: Vec<i32> = page.descendants().filter_map(level).collect();
        assert_eq!((levels[0], levels.iter().filter(|level| **level == 1).count()), (1, 1));
        assert!(levels.windows(2).all(|pair| pair[1] - pair[0] <= 1), "{levels:?}");
    }
}

#[test]
fn tables_and_figures_say_what_they_are() {
    let page = html(&report_of_all_checks());
    let page = parse(&page);
    assert_eq!(elements(&page, "html")[0].attribute("lang"), Some("en"));
    for table in elements(&page, "table") {
        let captions = table.children().filter(|child| child.tag_name().name() == "caption").count();
        assert_eq!(captions, 1, "a table without a caption");
        for head in table.descendants().filter(|node| node.tag_name().name() == "th") {
            assert!(matches!(head.attribute("scope"), Some("row" | "col")));
        }
        let cells = |row: Node<'_, '_>| row.children().filter(Node::is_element).count();
        let rows = table.descendants().filter(|node| node.tag_name().name() == "tr");
        let widths: BTreeSet<usize> = rows.map(cells).collect();
        assert_eq!(widths.len(), 1, "rows of different width: {widths:?}");
    }
    let drawings = elements(&page, "svg");
    assert_eq!(drawings.len(), 7);
    for drawing in drawings {
        assert_eq!(drawing.attribute("role"), Some("img"));
        for name in ["title", "desc"] {
            let described =
                drawing.children().find(|child| child.tag_name().name() == name).and_then(|node| node.text());
            assert!(described.is_some_and(|text| text.len() > 8), "a drawing without {name}");
        }
        let figure = drawing.ancestors().find(|node| node.tag_name().name() == "figure").expect("a figure");
        assert!(figure.children().any(|child| child.tag_name().name() == "figcaption"));
    }
}

#[test]
fn page_needs_no_script_and_nothing_from_elsewhere() {
    let text = html(&report_of_all_checks());
    let page = parse(&text);
    for name in ["script", "link", "img", "iframe", "object", "embed", "image", "use", "form"] {
        assert!(elements(&page, name).is_empty(), "<{name}> on the page");
    }
    let attributes = page.descendants().flat_map(|node| node.attributes().collect::<Vec<_>>());
    for attribute in attributes {
        assert!(!attribute.name().starts_with("on") && attribute.name() != "src", "{}", attribute.name());
    }
    let style = elements(&page, "style")[0].text().expect("a style");
    assert!(!style.contains("url(") && !style.contains("@import"));
    let outside = text.replace("http://www.w3.org/2000/svg", "").replace("http://www.w3.org/1999/xhtml", "");
    assert!(!outside.contains("://"), "an address on the page");
}

#[test]
fn verdict_is_never_told_by_colour_alone() {
    let page = html(&report_of_all_checks());
    let page = parse(&page);
    let verdicts =
        page.descendants().filter(|node| node.attribute("class").is_some_and(|class| class.starts_with("verdict ")));
    let mut n_seen = 0;
    for verdict in verdicts {
        let (class, text) = (verdict.attribute("class").expect("class"), verdict.text().expect("text"));
        assert!(text.ends_with(class.trim_start_matches("verdict ")), "{class}: {text}");
        n_seen += 1;
    }
    assert_eq!(n_seen, 35);
}
