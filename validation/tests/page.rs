//! What the page says.

use validation::claims::{Verdict, claims};
use validation::examples::Example;
use validation::page::{figures, page};
use validation::study::Study;

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
    // Four lines in each: the reference and three variants.
    for (name, svg) in &figures {
        assert!(svg.contains("reference") && svg.contains("4 elements"), "{name} lacks its legend");
        assert!(svg.matches("<polyline").count() >= 4, "{name} lacks lines");
    }
    let html = page(&[study], None);
    for needed in ["5.1 Static problem", "bend/figure-5b.svg", "load step 8: the iteration does not converge"] {
        assert!(html.contains(needed), "the page lacks {needed}");
    }
}

/// All variants at all tolerances: on demand, `cargo test -p validation -- --ignored`. The curves are tested always.
#[test]
#[ignore = "repeats every simulation at four tolerances"]
fn dynamic_examples_reach_what_the_page_says() {
    use Verdict::{NotReached, Partly, Reached};
    let expected: [(Example, &[Verdict]); 4] = [
        (Example::Rotating, &[Reached; 5]),
        (Example::Spherical, &[Reached; 4]),
        (Example::Crank, &[Reached, NotReached, Partly, NotReached, Reached]),
        (Example::Elbow, &[Reached, Partly, Reached, Reached, Partly, Partly]),
    ];
    for (example, verdicts_of_page) in expected {
        let study = study(example);
        assert_eq!(verdicts(&study), verdicts_of_page, "{}", example.name());
    }
}
