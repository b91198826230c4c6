//! What is wrong with a result is found, and named with its frequency.

use supel::cli::ExitCode;
use supel_models::transform::supported;
use supel_testing::place::{Place, steel_brick};

use super::{Pairs, assert_near, bar, certify, document, lowest, missing, of_kind, place_of, verdict};

/// Both the oracle and the program know a frequency of these models to some ε times a spectrum of 10⁷.
const KNOWN: f64 = 1e-8;

#[test]
fn a_complete_result_is_certified() {
    let pairs = lowest(&bar(), 17);
    let place = place_of(&bar(), &pairs);
    let found = document(&place, "", ExitCode::Done);
    assert_eq!(found["verdict"], "pass", "{found}");
    assert_eq!((missing(&found).len(), of_kind(&found, "rigid-body")), (0, vec![1, 2, 3, 4, 5, 6]));
    assert_eq!(of_kind(&found, "mode").len(), 11);
    assert_eq!((&found["count"]["n_counted"], &found["count"]["n_given"]), (&17.into(), &17.into()));
    for pair in found["pairs"].as_array().expect("pairs").iter().skip(6) {
        let [stated, shape, bar] = ["stated_hz", "shape_hz", "error_bar_hz"].map(|key| pair[key].as_f64().expect(key));
        assert!((stated - shape).abs() <= bar + KNOWN * stated && bar < KNOWN * stated, "{pair}");
    }
    let text = certify(&place, "").expect(ExitCode::Done).out;
    assert!(text.contains("✓ certified") && text.contains("a Sturm count finds 17 modes"), "{text}");
}

/// Whichever elastic mode is lost: one of a pair, one by itself, the first.
#[test]
fn a_lost_mode_is_named_with_its_frequency() {
    let all = lowest(&bar(), 17);
    for lost in [6, 7, 9, 10, 13] {
        let place = place_of(&bar(), &all.clone().without(lost));
        let found = document(&place, "", ExitCode::CheckFailed);
        let frequencies = missing(&found);
        assert_eq!(frequencies.len(), 1, "mode {lost}: {found}");
        assert_near(frequencies[0], all.hertz[lost], KNOWN);
        assert_eq!(verdict(&found, "M-06"), Some("fail"));
        assert_eq!((of_kind(&found, "invented").len(), of_kind(&found, "inexact").len()), (0, 0), "{found}");
        let is_of_pair =
            [lost.wrapping_sub(1), lost + 1].iter().any(|at| (all.hertz[*at] / all.hertz[lost] - 1.0).abs() < 1e-6);
        let of_frequency = if is_of_pair { [2, 1] } else { [1, 0] };
        assert_eq!(found["missing"][0]["of_frequency"], serde_json::json!(of_frequency), "mode {lost}");
    }
}

/// A result that ends with one mode of a pair is not to blame: it is told to ask for one more.
#[test]
fn a_cluster_that_is_cut_at_the_end_is_a_note() {
    let all = lowest(&bar(), 17);
    let first_of_pair = (8..16).find(|at| (all.hertz[*at + 1] / all.hertz[*at] - 1.0).abs() < 1e-6).expect("a pair");
    let mut cut = all.clone();
    cut.hertz.truncate(first_of_pair + 1);
    cut.shapes.truncate(first_of_pair + 1);
    let found = document(&place_of(&bar(), &cut), "", ExitCode::Done);
    assert_eq!(missing(&found).len(), 0, "{found}");
    let notes = found["notes"].to_string();
    assert!(notes.contains("ends inside a group of modes of one frequency"), "{notes}");
    // A band that is asked for has to be complete.
    let to = all.hertz[first_of_pair] * 1.0001;
    let found = document(&place_of(&bar(), &cut), &format!("--band 0,{to}"), ExitCode::CheckFailed);
    assert_eq!(missing(&found).len(), 1, "{found}");
}

/// A shape that is no mode, at a frequency between two: as a singular factor or a penalty in K makes it.
#[test]
fn an_invented_mode_is_named_with_its_frequency_and_its_neighbours() {
    let mut pairs = lowest(&bar(), 14);
    let n = pairs.shapes[0].len();
    let frequency = 0.5 * (pairs.hertz[7] + pairs.hertz[8]);
    pairs.hertz.insert(8, frequency);
    pairs.shapes.insert(8, (0..n).map(|row| (0.7 * row as f64).sin()).collect());
    let place = place_of(&bar(), &pairs);
    let found = document(&place, "", ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "invented"), missing(&found).len()), (vec![9], 0), "{found}");
    let pair = &found["pairs"][8];
    assert_near(pair["stated_hz"].as_f64().expect("a frequency"), frequency, KNOWN);
    assert_near(pair["neighbours_hz"][0].as_f64().expect("below"), pairs.hertz[7], KNOWN);
    assert_near(pair["neighbours_hz"][1].as_f64().expect("above"), pairs.hertz[9], KNOWN);
    assert_eq!((verdict(&found, "C-02"), verdict(&found, "M-06")), (Some("fail"), Some("pass")));
    let text = certify(&place, "").expect(ExitCode::CheckFailed).out;
    assert!(text.contains("invented") && text.contains("K and M have no such mode"), "{text}");
}

/// What is left of a pair once one of it took the place of the other.
#[test]
fn a_mode_given_twice_hides_none_that_is_missing() {
    let mut pairs = lowest(&bar(), 14);
    // Nearly the same shape, as an iteration without orthogonalisation finds it again.
    let copy: Vec<f64> =
        pairs.shapes[6].iter().enumerate().map(|(row, x)| x * (1.0 + 1e-9 * (row % 7) as f64)).collect();
    let lost = pairs.hertz[7];
    pairs.shapes[7] = copy;
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!(of_kind(&found, "repeated"), [8], "{found}");
    assert_eq!(found["pairs"][7]["repeats"], 7);
    assert_eq!(missing(&found).len(), 1);
    assert_near(missing(&found)[0], lost, KNOWN);
    // A combination of several modes is none either.
    let mut pairs = lowest(&bar(), 14);
    pairs.shapes[10] =
        (0..pairs.shapes[0].len()).map(|row| pairs.shapes[6][row] + 1e-3 * pairs.shapes[8][row]).collect();
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "mode").len(), missing(&found).len()), (7, 1), "{found}");
}

/// Modes of a repeated frequency are any basis of their space, orthogonal or not.
#[test]
fn a_repeated_frequency_may_have_any_basis() {
    let mut pairs = lowest(&bar(), 16);
    let (a, b) = (pairs.shapes[6].clone(), pairs.shapes[7].clone());
    pairs.shapes[6] = a.iter().zip(&b).map(|(a, b)| 0.6 * a + 0.8 * b).collect();
    pairs.shapes[7] = a.iter().zip(&b).map(|(a, b)| -0.8 * a + 0.6 * b).collect();
    assert_eq!(document(&place_of(&bar(), &pairs), "", ExitCode::Done)["verdict"], "pass");
    // Not orthogonal, and a basis all the same: that is said, and none of them is missing.
    pairs.shapes[7] = a.iter().zip(&b).map(|(a, b)| 0.5 * a + 0.87 * b).collect();
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((missing(&found).len(), of_kind(&found, "mode").len()), (0, 10), "{found}");
    assert_eq!((verdict(&found, "M-03"), verdict(&found, "M-06")), (Some("fail"), Some("pass")));
}

#[test]
fn an_inexact_frequency_is_told_with_the_right_one() {
    let mut pairs = lowest(&bar(), 14);
    let right = pairs.hertz[9];
    pairs.hertz[9] *= 1.02;
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!(of_kind(&found, "inexact"), [10], "{found}");
    assert_near(found["pairs"][9]["mode_hz"].as_f64().expect("a frequency"), right, KNOWN);
    assert_eq!((verdict(&found, "C-01"), missing(&found).len()), (Some("fail"), 0));
}

/// An iteration that was stopped early: the shape is mostly its mode, and the frequency too high.
#[test]
fn an_unconverged_mode_is_inexact_and_not_missing() {
    let all = lowest(&bar(), 40);
    let mut pairs = all.clone();
    pairs.hertz.truncate(14);
    pairs.shapes.truncate(14);
    let (low, high) = (all.shapes[12].clone(), &all.shapes[35]);
    // A tenth of a mode far above: λ = 0.99 λ₁₂ + 0.01 λ₃₅.
    pairs.shapes[12] = low.iter().zip(high).map(|(a, b)| 0.99f64.sqrt() * a + 0.1 * b).collect();
    let lambda = 0.99 * all.hertz[12].powi(2) + 0.01 * all.hertz[35].powi(2);
    pairs.hertz[12] = lambda.sqrt();
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "inexact"), missing(&found).len()), (vec![13], 0), "{found}");
    assert_near(found["pairs"][12]["mode_hz"].as_f64().expect("a frequency"), all.hertz[12], 1e-6);
    assert_near(found["pairs"][12]["shape_hz"].as_f64().expect("a frequency"), lambda.sqrt(), KNOWN);
}

#[test]
fn frequencies_in_another_order_than_shapes_are_told() {
    let mut pairs = lowest(&bar(), 14);
    pairs.shapes.swap(9, 12);
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
    assert_eq!(of_kind(&found, "inexact"), [10, 13], "{found}");
    assert!(found["notes"].to_string().contains("different orders"), "{found}");
}

/// A right frequency of a poor shape: what is off is the shape, and no number stands for another one.
#[test]
fn a_poor_shape_is_told_as_one() {
    let all = lowest(&bar(), 40);
    let mut pairs = lowest(&bar(), 14);
    pairs.shapes[12] = all.shapes[12].iter().zip(&all.shapes[35]).map(|(a, b)| a + 0.1 * b).collect();
    let place = place_of(&bar(), &pairs);
    let found = document(&place, "", ExitCode::CheckFailed);
    let check = found["checks"].as_array().expect("checks").iter().find(|check| check["id"] == "C-01").expect("C-01");
    let said = check["worst"].as_str().expect("words");
    let numbers: Vec<&str> = said.split(' ').filter(|word| word.parse::<f64>().is_ok()).collect();
    assert!(said.contains("whose shape has") && numbers.len() == 4 && numbers[2] != numbers[3], "{said}");
    let text = certify(&place, "").expect(ExitCode::CheckFailed).out;
    assert!(text.contains("the shape is off by"), "{text}");
    // A wrong frequency of a right shape.
    let mut pairs = lowest(&bar(), 14);
    pairs.hertz[12] *= 1.02;
    let text = certify(&place_of(&bar(), &pairs), "").expect(ExitCode::CheckFailed).out;
    assert!(text.contains(", off by 2 %"), "{text}");
}

/// The band decides what is missing, whatever the result has beyond it.
#[test]
fn a_band_is_looked_through_from_end_to_end() {
    let all = lowest(&bar(), 20);
    let lost = all.clone().without(12).without(8);
    let place = place_of(&bar(), &lost);
    let between = |a: usize, b: usize| 0.5 * (all.hertz[a] + all.hertz[b]);
    let band = |from: f64, to: f64, code| document(&place, &format!("--band {from},{to}"), code);
    let found = band(between(9, 10), between(13, 14), ExitCode::CheckFailed);
    assert_eq!(missing(&found).len(), 1, "{found}");
    assert_near(missing(&found)[0], all.hertz[12], KNOWN);
    assert_eq!(verdict(&found, "C-04"), None, "no rigid-body modes in the band");
    let found = band(between(13, 14), between(18, 19), ExitCode::Done);
    assert_eq!(missing(&found).len(), 0, "{found}");
    let found = band(0.0, between(13, 14), ExitCode::CheckFailed);
    assert_eq!(missing(&found).len(), 2, "{found}");
    // Beyond what the result has, everything is missing; the bar has more modes than it looks for.
    let found = band(0.0, 1e6, ExitCode::CheckFailed);
    let n_missing = missing(&found).len() + found["n_not_sought"].as_u64().expect("a number") as usize;
    assert_eq!(n_missing, 3 * 81 - 18, "{found}");
}

/// A model that flags hold, and one whose rows are gone.
#[test]
fn a_held_component_has_no_rigid_body_modes() {
    let held = supported(&steel_brick(), |(label, _)| label % 5 == 1);
    let pairs = lowest(&held, 10);
    let found = document(&place_of(&held, &pairs), "", ExitCode::Done);
    assert_eq!((&found["model"]["n_rigid"], verdict(&found, "C-04")), (&0.into(), None));
    // The same modes on all rows, those of the held nodes at rest.
    let free = steel_brick();
    let place = Place::with(&free);
    let is_held = |row: usize| free.dofs[row].0 % 5 == 1;
    let kept: Vec<usize> = (0..free.n).filter(|row| !is_held(*row)).collect();
    let on_all_rows = |shape: &Vec<f64>| {
        let mut whole = vec![0.0; free.n];
        kept.iter().zip(shape).for_each(|(row, value)| whole[*row] = *value);
        whole
    };
    let whole = Pairs { hertz: pairs.hertz.clone(), shapes: pairs.shapes.iter().map(on_all_rows).collect() };
    whole.write(&place);
    let labels: Vec<String> = free.labels.iter().filter(|label| **label % 5 == 1).map(i64::to_string).collect();
    let flags = format!("--dofs {} --fix wall={}", place.text("dofs.txt"), labels.join(","));
    let found = document(&place, &flags, ExitCode::Done);
    assert_eq!((&found["verdict"], &found["model"]["n_rigid"]), (&"pass".into(), &0.into()));
    // Without the supports the same shapes are those of nothing.
    let found = document(&place, "", ExitCode::CheckFailed);
    assert!(of_kind(&found, "mode").is_empty(), "{found}");
}

/// Where no band is asked for, all that a result states is judged: shapes that are none do not end the band before them.
#[test]
fn noise_above_the_last_mode_is_invented() {
    let all = lowest(&bar(), 14);
    for n_right in [13, 8] {
        let mut pairs = all.clone();
        for (at, shape) in pairs.shapes.iter_mut().enumerate().skip(n_right) {
            let noise = |row: usize| (12.9898 * (row + 1) as f64 + 78.233 * at as f64).sin() * 43758.5453;
            shape.iter_mut().enumerate().for_each(|(row, value)| *value = noise(row).fract() - 0.5);
        }
        let found = document(&place_of(&bar(), &pairs), "", ExitCode::CheckFailed);
        let expected: Vec<u64> = (n_right as u64 + 1..=14).collect();
        assert_eq!((of_kind(&found, "invented"), verdict(&found, "C-02")), (expected, Some("fail")), "{found}");
    }
}
