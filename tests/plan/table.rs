//! The table of the rules: each has a reason, a guard, and a decision for every scene.

use std::path::Path;

use supel::job::Job;
use supel::plan::{Decision, Kind, Plan, RULES, RuleId};

use crate::{Case, HERTING, PATCHES};

fn plan(scene: &'static str) -> Plan {
    let text = Case::new(PATCHES, HERTING, scene).job();
    Plan::of(&Job::parse(&text, Path::new("job.toml")).expect("a job"))
}

#[test]
fn every_rule_has_a_reason_and_a_guard_in_whole_words() {
    for rule in RULES {
        let name = rule.id.name();
        for words in [rule.leaves_out, rule.because, rule.guard] {
            assert!(words.len() > 10 && !words.ends_with('.') && !words.contains("  "), "{name}: {words}");
        }
        let struck = rule.kind == Kind::Struck;
        let not_done = [RuleId::K12, RuleId::K22, RuleId::K26];
        assert_eq!(struck, not_done.contains(&rule.id), "{name}");
    }
}

#[test]
fn nothing_is_left_out_of_a_job_without_a_scene() {
    let by_scene = [RuleId::K1, RuleId::K2, RuleId::K8, RuleId::K9, RuleId::K10, RuleId::K11, RuleId::K13, RuleId::K14];
    for rule in by_scene {
        assert!(matches!(plan("").decision(rule), Decision::Kept(_)), "{}", rule.name());
    }
    let plan = plan("");
    assert_eq!(plan.job(), plan.given());
    assert!(plan.assumptions().is_empty());
}

#[test]
fn statements_are_decisions_with_names() {
    let words = |scene: &'static str, rule: RuleId| match plan(scene).decision(rule) {
        Decision::LeftOut(words) => words,
        other => panic!("{other:?}"),
    };
    assert!(words("unloaded = [\"tip.rx\"]", RuleId::K8).starts_with("tip.rx as interface dofs"));
    assert!(words("grounded = [\"root\"]", RuleId::K9).starts_with("root with their rows"));
    assert!(
        words("prescribed = [{ name = \"t\", interfaces = [\"root\", \"tip\"] }]", RuleId::K10).contains("root, tip")
    );
    assert!(words("analysis = \"static\"\ngravity = false", RuleId::K1).contains("the mass"));
    assert!(!words("analysis = \"static\"", RuleId::K1).starts_with("the mass"));
}

#[test]
fn what_depends_on_the_model_is_open_before_it_is_read() {
    for rule in [RuleId::K7, RuleId::K17, RuleId::K21, RuleId::K27] {
        assert_eq!(plan("").decision(rule), Decision::Open, "{}", rule.name());
    }
}

/// The table of the documentation is made from the rules: `SUPEL_UPDATE_DOCS=1 cargo test --test plan documentation` writes it.
#[test]
fn documentation_has_the_table_of_the_rules() {
    const HEAD: &str = "| rule | kind | leaves out | why that is safe | guard |\n|---|---|---|---|---|\n";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/plan.md");
    let document = std::fs::read_to_string(&path).expect("a page");
    let (before, rest) = document.split_once(HEAD).expect("head of the table");
    let (_, after) = rest.split_once("\n## ").expect("end of the table");
    let kind = |kind: Kind| match kind {
        Kind::Omission => "omission",
        Kind::WithinBars => "within bars",
        Kind::Always => "always",
        Kind::Struck => "struck",
    };
    let rows = RULES.iter().map(|rule| {
        format!(
            "| {} | {} | {} | {} | {} |\n",
            rule.id.name(),
            kind(rule.kind),
            rule.leaves_out,
            rule.because,
            rule.guard
        )
    });
    let made = format!("{before}{HEAD}{}\n## {after}", rows.collect::<String>());
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, &made).expect("written");
    } else {
        assert!(document == made, "the table is another: SUPEL_UPDATE_DOCS=1 writes it");
    }
}
