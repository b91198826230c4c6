//! P12: the report is JSON that reads back as itself, and its verdicts follow from its numbers.

use proptest::prelude::*;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::rounded;
use supel_models::{Material, brick};

use crate::kept;
use crate::place::Place;

/// The verdict that a line's own numbers demand.
fn demanded(check: &Value) -> &'static str {
    let number = |key: &str| check[key].as_f64();
    match (number("value"), number("limit"), number("fail_above")) {
        // A measure without a limit is shown, not judged.
        (Some(_), None, _) => "info",
        (Some(value), Some(limit), _) if value <= limit => "pass",
        (Some(value), _, Some(fail)) if value <= fail => "warn",
        _ => "fail",
    }
}

proptest! {
    #![proptest_config(kept!("report"))]

    #[test]
    fn verdicts_follow_from_the_numbers(
        digits in 4usize..=17,
        method in prop_oneof![Just("herting"), Just("craig-bampton")],
        count in 1..=8usize,
        slender in 1..=30u8,
    ) {
        let model = brick([6, 1, 1], [f64::from(slender), 1.0, 0.75], &Material::STEEL_SI);
        let place = Place::with(&rounded(&model, digits));
        let flags = format!("--interface ends=1,7,9,22 --method {method} --modes {count} --allow-unverified --quiet");
        let ended = place.reduce(&place.model_flags(), &flags);
        prop_assume!(matches!(ended.code, ExitCode::Done | ExitCode::CheckFailed));
        let text = String::from_utf8(place.bytes("x.report.json")).expect("UTF-8");
        let report: Value = serde_json::from_str(&text).expect("JSON");
        let again: Value = serde_json::from_str(&serde_json::to_string(&report).expect("JSON")).expect("JSON");
        prop_assert_eq!(&again, &report);
        let checks = report["body"]["checks"].as_array().expect("checks");
        let rank = |verdict: &str| ["info", "pass", "warn", "fail"].iter().position(|known| *known == verdict);
        let mut worst = rank("pass");
        for check in checks {
            let verdict = check["verdict"].as_str().expect("a verdict");
            prop_assert_eq!(verdict, demanded(check), "{}", check);
            worst = worst.max(rank(verdict));
        }
        if !report["body"]["warnings"].as_array().expect("warnings").is_empty() {
            worst = worst.max(rank("warn"));
        }
        let verdict = report["body"]["verdict"].as_str().expect("a verdict");
        prop_assert_eq!(rank(verdict), worst, "the verdict of the whole is {}", verdict);
        prop_assert_eq!(ended.code == ExitCode::CheckFailed, verdict == "fail");
    }
}
