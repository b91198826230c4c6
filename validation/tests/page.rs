//! What the page says.

use validation::claims::claims;
use validation::examples::Example;
use validation::figure::{Line, drawn};
use validation::page::{figures, page};
use validation::study::Study;
use validation::summary::{summary, totals};
use validation::verdict::Verdict;

fn study(example: Example) -> Study {
    let folder = tempfile::tempdir().expect("folder");
    Study::new(example, folder.path(), None).expect("computed")
}

fn verdicts(study: &Study) -> Vec<Verdict> {
    claims(study).iter().map(|claim| claim.verdict).collect()
}

#[test]
fn static_example_reaches_every_claim_and_shows_every_figure() {
    let study = study(Example::Bend);
    assert_eq!(verdicts(&study), [Verdict::Reached; 4]);
    let figures = figures(&study).expect("drawn");
    let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["figure-4a.svg", "figure-4b.svg", "figure-5a.svg", "figure-5b.svg"]);
    // Four lines, the reference and three variants, and below them the differences of the three, each panel with its legend.
    for (name, svg) in &figures {
        let count = |words: &str| svg.matches(words).count();
        assert!(svg.contains("difference from the reference"), "{name} lacks the panel of differences");
        assert_eq!(count("4 elements"), 2, "{name} lacks a legend");
        assert_eq!(count("\nreference\n"), 1, "{name}: the reference has no difference from itself");
        assert!(count("<polyline") >= 7, "{name} lacks lines");
        // Marks of the variants, ten loads each: a circle twice, a triangle.
        assert!(count("<circle") >= 20 && count("<polygon") >= 10, "{name} lacks marks");
    }
    let html = page(&[study], None);
    for needed in [
        "5.1 Static problem",
        "bend/figure-5b.svg",
        "load step 8: the iteration does not converge",
        "As figure 4a of the paper, computed here: motion-based measures",
    ] {
        assert!(html.contains(needed), "the page lacks {needed}");
    }
    assert!(!html.contains(">Figure "), "a curve of our own is captioned as one of the paper");
}

/// What an error says may hold signs that mean something to a browser.
#[test]
fn texts_are_shown_as_they_stand() {
    let mut study = study(Example::Bend);
    study.runs[0].1.stopped = Some("<b> of \"A & B\"".to_owned());
    let html = page(&[study], None);
    assert!(html.contains("stops: &lt;b&gt; of &quot;A &amp; B&quot;<"), "an error is taken for markup");
}

/// The windows of 5.3 that show a second each have the legend that the whole record has.
#[test]
fn windows_have_legends() {
    let figure = validation::figure::FIGURES.iter().find(|figure| figure.number == "9").expect("a figure");
    let line = |label: &str, height: f64| {
        let points = (0..=500).map(|i| 0.1 * f64::from(i)).map(|t| (t, height + 0.01 * t.sin())).collect();
        Line { label: label.into(), points }
    };
    let svg = drawn(figure, &[line("reference", 0.03), line("one element", 0.0301)]).expect("drawn");
    // The record, two windows and the differences.
    assert_eq!(svg.matches("one element").count(), 4);
    assert_eq!(svg.matches("\nreference\n").count(), 3);
    assert!(svg.contains("from 17.5 s to 18.5 s") && svg.contains("from 45.5 s to 46.5 s"));
}

/// One run of everything, the examples side by side, for all that is said of all.
#[test]
fn examples_reach_what_page_and_readme_say() {
    use Verdict::{NotReached, Partly, Reached};
    let studies: Vec<Study> = std::thread::scope(|scope| {
        let started = Example::ALL.map(|example| scope.spawn(move || study(example)));
        started.map(|one| one.join().expect("computed")).into()
    });
    let expected: [&[Verdict]; 5] = [
        &[Reached; 4],
        &[Reached, Reached, Partly, Reached, Reached],
        &[Reached; 4],
        &[Reached, NotReached, Partly, NotReached, NotReached],
        &[Reached, Partly, Reached, Reached, Reached, Partly, Partly],
    ];
    for (study, expected) in studies.iter().zip(expected) {
        assert_eq!(verdicts(study), expected, "{}", study.example.name());
    }
    let readme =
        |path: &str| std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).expect("README");
    let (own, of_tool) = (readme("README.md"), readme("../README.md"));
    assert!(of_tool.replace('\n', " ").contains(&totals(&studies)), "README.md lacks: {}", totals(&studies));
    let summary = summary(&studies);
    for row in summary.lines().filter(|row| !row.is_empty()) {
        assert!(own.lines().any(|line| is_same(line, row)), "validation/README.md lacks the row\n{row}");
    }
}

/// Whether two lines have the same words, and numbers that differ by one in the last digit at most: processors round
/// differently. Whole numbers
/// count what an iteration did where it came to a threshold, which rounding moves by a few of ten.
fn is_same(line: &str, row: &str) -> bool {
    let words = |text: &str| -> Vec<String> { text.split_whitespace().map(str::to_owned).collect() };
    let near = |a: &str, b: &str| {
        let bare = |word: &str| word.trim_matches(|c: char| !c.is_ascii_digit()).to_owned();
        let (a, b) = (bare(a), bare(b));
        let decimals = b.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let number = |word: &str| word.parse::<f64>().ok();
        // With a half for the rounding of the decimal fractions themselves.
        let allowed = |b: f64| if decimals == 0 { (b / 4.0).max(1.5) } else { 1.5 * 0.1_f64.powi(decimals as i32) };
        number(&a).zip(number(&b)).is_some_and(|(a, b)| (a - b).abs() < allowed(b))
    };
    let (line, row) = (words(line), words(row));
    line.len() == row.len() && line.iter().zip(&row).all(|(a, b)| a == b || near(a, b))
}
