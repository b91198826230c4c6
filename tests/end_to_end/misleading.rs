//! Numbers that look more precise than they are, or less: what the numbers and their text show, and what only the job can say.

use supel::cli::ExitCode;

use crate::few_digits::Found;
use crate::fixed_point::{components, full, printed, reduced};
use crate::place::supel;

/// Single precision in other units has all digits of a double, and exact numbers may have seven.
#[test]
fn stated_digits_replace_those_that_the_numbers_show() {
    const FOOT: f64 = 0.3048;
    let [held, _] = components();
    let of = |stiffness: &dyn Fn(f64) -> String, keys: &str| {
        let texts = printed(&held.model, [stiffness, &full]);
        let (place, out) = reduced(&held, &held.model, texts.each_ref().map(String::as_str), keys);
        let found = Found::of(&place.report("x.report.json")["body"]);
        (found, out, place)
    };
    let in_feet = |value: f64| full(FOOT * value);
    let single_in_feet = |value: f64| full(FOOT * f64::from(value as f32));
    let (exact, ..) = of(&in_feet, "");
    let (judged, out, _) = of(&single_in_feet, "");
    assert!(judged.worst(&exact) > 1.0 && out.contains("17 digits"), "{out}");
    let (stated, out, place) = of(&single_in_feet, ", stiffness_digits = 7");
    assert!(stated.worst(&exact) <= 1.0 && out.contains("7 digits as the job states"), "{out}");
    let matrices = &place.report("x.report.json")["body"]["model"];
    assert!(matrices["stiffness"]["digits"] == 7 && matrices["stiffness"]["digits_by"] == "job", "{matrices}");
    assert!(matrices["mass"]["digits"] == 17 && matrices["mass"]["digits_by"].is_null(), "{matrices}");

    let in_seven = |value: f64| format!("{value:.6e}");
    let bar = |found: &Found| found.frequencies[0][1] / found.frequencies[0][0];
    let (rounded, ..) = of(&in_seven, "");
    let (stated, out, place) = of(&in_seven, ", stiffness_digits = 17");
    assert!(bar(&stated) < 1e-3 * bar(&rounded), "{out}");
    // Digits decide which motions are free: another job than the one that the file was made by.
    let job = String::from_utf8(place.bytes("job.toml")).expect("text").replace(", stiffness_digits = 17", "");
    place.write("other.toml", job.as_bytes());
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("other.toml")]);
    let ended = ended.expect(ExitCode::CheckFailed);
    assert!(ended.out.contains("model.stiffness_digits"), "{}", ended.out);
}
