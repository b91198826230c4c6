//! Combinations of two modes whose frequencies are near are no modes: not both of them, not one, and not the last of a result.

use std::f64::consts::FRAC_PI_4;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::{Material, Model, brick};

use super::digits::{rounded, turn};
use super::{Pairs, certify, document, lowest, missing, place_of, verdict};

/// The first two elastic modes, which bend a bar of nearly square section.
const NEAR: [usize; 2] = [6, 7];

/// A free bar whose section is deeper than wide by a share.
fn oblong(share: f64) -> Model {
    brick([8, 2, 2], [1.0, 0.05, 0.05 * (1.0 + share)], &Material::STEEL_SI)
}

/// The first pairs of a bar, the near modes turned into each other by an angle, with shapes of so many digits.
fn turned(all: &Pairs, (count, angle, digits): (usize, f64, usize)) -> Pairs {
    let mut pairs = all.clone();
    turn(&mut pairs.shapes, NEAR, angle);
    let [a, b] = NEAR.map(|mode| all.hertz[mode].powi(2));
    let share = angle.sin().powi(2);
    // Rayleigh quotients.
    pairs.hertz[NEAR[0]] = ((1.0 - share) * a + share * b).sqrt();
    pairs.hertz[NEAR[1]] = (share * a + (1.0 - share) * b).sqrt();
    pairs.hertz[..6].fill(0.0);
    pairs.hertz.truncate(count);
    pairs.shapes.truncate(count);
    pairs.shapes.iter_mut().flatten().for_each(|value| *value = rounded(*value, digits));
    pairs
}

/// Every elastic pair has a mode of the model within its error bar, and what is missing is one. A dense decomposition knows eigenvalues to some ε of
/// the largest one, 10⁷ times the first.
#[track_caller]
fn assert_true(found: &Value, all: &Pairs) {
    let nearest = |hertz: f64| all.hertz.iter().map(|mode| (mode - hertz).abs()).fold(f64::INFINITY, f64::min);
    for pair in found["pairs"].as_array().expect("pairs").iter().skip(6) {
        let hertz = pair["shape_hz"].as_f64().expect("a frequency");
        // None where nothing is known of a shape.
        let bar = pair["error_bar_hz"].as_f64().unwrap_or(f64::INFINITY);
        assert!(nearest(hertz) <= bar + 1e-8 * hertz, "{hertz} ± {bar}, off by {}", nearest(hertz));
    }
    missing(found).into_iter().for_each(|hertz| assert!(nearest(hertz) <= 1e-5 * hertz, "missing {hertz}"));
}

/// Modes of one cluster are one space, and any of its shapes are modes; the frequency of a combination lies between theirs all the same.
#[test]
fn a_combination_in_a_cluster_is_as_far_from_a_frequency_as_its_bar_says() {
    for share in [1e-6, 2e-6, 4e-6] {
        let model = oblong(share);
        let all = lowest(&model, 12);
        for angle in [0.03, 0.5, FRAC_PI_4] {
            let result = turned(&all, (10, angle, 17));
            let found = document(&place_of(&model, &result), "", ExitCode::Done);
            assert_true(&found, &all);
        }
    }
}

#[test]
fn combinations_of_two_near_modes_are_no_modes() {
    for (share, digits) in [(1e-2, 5), (1e-2, 17), (3e-4, 17), (1e-3, 6)] {
        let model = oblong(share);
        let all = lowest(&model, 12);
        for angle in [FRAC_PI_4, 0.6] {
            let both = turned(&all, (10, angle, digits));
            for result in [both.clone(), both.clone().without(NEAR[1]), turned(&all, (7, angle, digits))] {
                let found = document(&place_of(&model, &result), "", ExitCode::CheckFailed);
                assert_eq!(verdict(&found, "M-08"), Some("fail"), "{share} {angle} {digits}: {found}");
                assert_true(&found, &all);
            }
        }
        // The modes themselves are right.
        let found = document(&place_of(&model, &turned(&all, (10, 0.0, digits))), "", ExitCode::Done);
        assert_true(&found, &all);
    }
}

/// The answer to a result, whatever its exit code is.
fn answer(model: &Model, pairs: &Pairs) -> Value {
    serde_json::from_str(&certify(&place_of(model, pairs), "--json").out).expect("JSON")
}

/// Bars of shapes that are poor, and of those at the end of a result, where the next modes are known by counts alone.
#[test]
fn bars_of_poor_shapes_hold_the_nearest_frequency() {
    let model = oblong(0.0);
    let all = lowest(&model, 40);
    for share in [1e-4, 1e-3, 1e-2, 0.1, 0.2, 0.4] {
        for other in [12, 19, 30] {
            for count in [8, 9, 11] {
                let mut result = Pairs { hertz: all.hertz[..count].to_vec(), shapes: all.shapes[..count].to_vec() };
                let poor =
                    result.shapes[count - 1].iter().zip(&all.shapes[other]).map(|(a, b)| a + share * b).collect();
                result.shapes[count - 1] = poor;
                assert_true(&answer(&model, &result), &all);
            }
        }
    }
}

/// The last shape of a result, mixed with the next mode above it: that one is no pair, and a count alone tells where it may be. With a part a of
/// it the quotient is off by a²(λ′ − ρ) and its residual is a²(1 − ρ/λ′)(λ′ − ρ), less by 1 − ρ/λ′: a quarter at ρ/λ′ = ¾.
#[test]
fn bars_at_the_end_of_a_result_know_that_others_lie_above() {
    let model = oblong(0.0);
    let all = lowest(&model, 40);
    let last: Vec<usize> = (7..32).filter(|at| (1.12..1.5).contains(&(all.hertz[*at + 1] / all.hertz[*at]))).collect();
    assert!(last.len() > 2, "{last:?}");
    for at in last {
        for share in [0.01, 0.05, 0.1, 0.2] {
            let mut result = Pairs { hertz: all.hertz[..=at].to_vec(), shapes: all.shapes[..=at].to_vec() };
            result.shapes[at] = result.shapes[at].iter().zip(&all.shapes[at + 1]).map(|(a, b)| a + share * b).collect();
            assert_true(&answer(&model, &result), &all);
        }
    }
}

/// The last shape of a result is one of two modes of one frequency with a little of the next one, which puts its own frequency above that of both:
/// what is stated of it tells that the result ends inside of the two.
#[test]
fn a_poor_shape_that_states_the_frequency_of_a_pair_ends_the_result_inside_of_it() {
    let model = oblong(0.0);
    let all = lowest(&model, 40);
    for at in [8, 12] {
        let mut result = turned(&all, (at + 1, 0.0, 17));
        result.shapes[at] = result.shapes[at].iter().zip(&all.shapes[at + 2]).map(|(a, b)| a + 0.03 * b).collect();
        let found = answer(&model, &result);
        assert!(missing(&found).is_empty(), "{at}: {found}");
        assert!(found["notes"].to_string().contains("ends inside a group"), "{at}: {found}");
    }
}

/// A result of any number of digits that ends with one of two modes of one frequency does so without anybody's fault.
#[test]
fn a_result_of_few_digits_ends_inside_of_a_pair() {
    let model = oblong(0.0);
    let all = lowest(&model, 40);
    let pairs: Vec<usize> = (7..32).filter(|at| (all.hertz[*at] / all.hertz[*at + 1] - 1.0).abs() < 1e-9).collect();
    assert!(pairs.len() > 3, "{pairs:?}");
    for digits in [2, 3, 4, 5, 17] {
        for count in pairs.iter().map(|at| at + 1) {
            let result = turned(&all, (count, 0.0, digits));
            let found = answer(&model, &result);
            assert!(missing(&found).is_empty(), "{digits} digits, {count} modes: {found}");
            assert!(
                found["notes"].to_string().contains("ends inside a group"),
                "{digits} digits, {count} modes: {found}"
            );
        }
    }
}
