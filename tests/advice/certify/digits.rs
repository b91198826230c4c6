//! Right results that are written with few digits.

use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Model, Section, brick, frame};

use super::{Pairs, bar, certify, document, lowest, of_kind, place_of, verdict};
use supel_models::transform::rounded as of_digits;
use supel_testing::place::steel_brick;

pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().expect("a number")
}

/// The lowest pairs, with shapes and frequencies of so many digits, rigid-body modes at zero.
fn short(shapes: usize, frequencies: usize) -> Pairs {
    let mut pairs = lowest(&bar(), 14);
    pairs.hertz[..6].fill(0.0);
    pairs.hertz.iter_mut().for_each(|hertz| *hertz = rounded(*hertz, frequencies));
    for shape in &mut pairs.shapes {
        let largest = shape.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        shape.iter_mut().for_each(|value| *value = rounded(*value / largest, shapes));
    }
    pairs
}

#[test]
fn frequencies_of_five_digits_are_right() {
    for digits in [5, 6, 7] {
        let found = document(&place_of(&bar(), &short(17, digits)), "--strict", ExitCode::Done);
        assert_eq!(found["verdict"], "pass", "{digits} digits: {found}");
    }
    // The check about frequencies is the one that says so where one is wrong.
    let mut wrong = short(17, 17);
    wrong.hertz[9] *= 1.0 + 3e-4;
    let found = document(&place_of(&bar(), &wrong), "", ExitCode::Done);
    assert_eq!((verdict(&found, "C-01"), verdict(&found, "M-01")), (Some("warn"), Some("pass")), "{found}");
    wrong.hertz[9] *= 1.0 + 3e-3;
    let found = document(&place_of(&bar(), &wrong), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-01"), of_kind(&found, "inexact")), (Some("fail"), vec![10]), "{found}");
}

#[test]
fn shapes_of_five_digits_are_right() {
    for digits in [5, 6, 7] {
        let found = document(&place_of(&bar(), &short(digits, 17)), "--strict", ExitCode::Done);
        assert_eq!(found["verdict"], "pass", "{digits} digits: {found}");
    }
}

/// Shapes of half precision, which has eleven bits, in a text that has all their digits: as right as those of three digits.
#[test]
fn shapes_of_half_precision_are_right() {
    let mut pairs = short(17, 17);
    for value in pairs.shapes.iter_mut().flatten().filter(|value| **value != 0.0) {
        let unit = (value.abs().log2().floor() - 10.0).exp2();
        *value = (*value / unit).round() * unit;
    }
    let found = document(&place_of(&bar(), &pairs), "", ExitCode::Done);
    assert_eq!(verdict(&found, "M-01"), Some("warn"), "{found}");
}

/// Numbers with one decimal are off by half of it, which is much of a small one.
#[test]
fn decimals_of_frequencies_are_known() {
    let mut pairs = short(17, 17);
    pairs.hertz.iter_mut().for_each(|hertz| *hertz = format!("{hertz:.1}").parse().expect("a number"));
    let found = document(&place_of(&bar(), &pairs), "--strict", ExitCode::Done);
    let checks = found["checks"].as_array().expect("checks");
    let check = checks.iter().find(|check| check["id"] == "C-01").expect("C-01");
    assert_eq!((&check["verdict"], &check["active_limit"]), (&"pass".into(), &"data".into()), "{check}");
}

/// Pairs of K and M of five digits as these stand in their files are exact, rigid-body modes at the energy that digits give them included:
/// how far those of the model itself may be is a matter of M-09.
#[test]
fn exact_pairs_of_matrices_of_five_digits_are_right() {
    let model = of_digits(&steel_brick(), 5);
    let pairs = lowest(&model, 12);
    let place = place_of(&model, &pairs);
    let found = document(&place, "", ExitCode::Done);
    let verdicts = ["C-01", "C-05", "M-01"].map(|id| verdict(&found, id));
    assert_eq!((verdicts, verdict(&found, "M-09")), ([Some("pass"); 3], Some("warn")), "{found}");
    assert_eq!(of_kind(&found, "inexact"), Vec::<u64>::new(), "{found}");
    // What no digits explain is off all the same.
    let mut wrong = pairs.clone();
    wrong.hertz[0] = 0.2 * pairs.hertz[6];
    let found = document(&place_of(&model, &wrong), "", ExitCode::CheckFailed);
    assert_eq!((verdict(&found, "C-05"), of_kind(&found, "inexact")), (Some("fail"), vec![1]), "{found}");
}

/// The mode that a poor shape mostly is, is named with what is known of it, and no digits beyond that.
#[test]
fn modes_next_to_poor_shapes_have_error_bars() {
    let mut pairs = lowest(&bar(), 12);
    let n = pairs.shapes[0].len();
    let disturbance: Vec<f64> = (0..n).map(|row| (0.7 * row as f64).sin()).collect();
    let size = |shape: &[f64]| shape.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let share = 2e-2 * size(&pairs.shapes[9]);
    pairs.shapes[9].iter_mut().zip(&disturbance).for_each(|(value, other)| *value += share * other);
    let place = place_of(&bar(), &pairs);
    let found = document(&place, "", ExitCode::CheckFailed);
    assert_eq!(of_kind(&found, "inexact"), [10], "{found}");
    let [mode, bar_hz] = ["mode_hz", "mode_error_bar_hz"].map(|key| found["pairs"][9][key].as_f64().expect(key));
    assert!((mode - pairs.hertz[9]).abs() <= bar_hz.max(1e-8 * mode), "{mode} ± {bar_hz}, {}", pairs.hertz[9]);
    let text = certify(&place, "").expect(ExitCode::CheckFailed).out;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("the mode that it is has") && text.contains(" Hz ± "), "{text}");
}

/// A block whose fourteenth mode and the next are a fifth of a per cent apart.
fn block() -> Model {
    brick([5, 2, 2], [0.5, 0.12, 0.12], &Material::STEEL_SI)
}

/// Its first fourteen pairs with shapes of so many digits, made of its modes by `mix`.
fn mixed(digits: usize, mix: impl Fn(&mut [Vec<f64>])) -> Pairs {
    let mut pairs = lowest(&block(), 15);
    mix(&mut pairs.shapes);
    pairs.hertz[..6].fill(0.0);
    pairs.hertz.truncate(14);
    pairs.shapes.truncate(14);
    pairs.shapes.iter_mut().flatten().for_each(|value| *value = rounded(*value, digits));
    pairs
}

/// Turns two shapes into each other by an angle.
pub(super) fn turn(shapes: &mut [Vec<f64>], [a, b]: [usize; 2], angle: f64) {
    let (sin, cos) = angle.sin_cos();
    for row in 0..shapes[a].len() {
        let [x, y] = [shapes[a][row], shapes[b][row]];
        (shapes[a][row], shapes[b][row]) = (cos * x + sin * y, cos * y - sin * x);
    }
}

/// Rounding is spread over all modes, and is not taken for much of the nearest one. What is not proved for want of digits is said.
#[test]
fn shapes_of_few_digits_next_to_a_close_mode_are_right() {
    for digits in [3, 4] {
        let place = place_of(&block(), &mixed(digits, |_| {}));
        let found = document(&place, "", ExitCode::Done);
        let verdicts = ["C-01", "M-04"].map(|id| verdict(&found, id));
        assert_eq!(verdicts, [Some("pass"); 2], "{digits} digits");
        assert_eq!(of_kind(&found, "inexact").len(), 0, "{digits} digits");
        let (notes, is_open) = (found["notes"].to_string(), verdict(&found, "M-08") == Some("warn"));
        let said = format!("the shapes have {digits} digits");
        assert_eq!(notes.contains(&said) && notes.contains("M-08"), is_open, "{digits} digits: {notes}");
        assert_eq!(is_open, digits == 3, "{digits} digits");
    }
    let found = document(&place_of(&block(), &mixed(17, |_| {})), "--strict", ExitCode::Done);
    assert!(!found["notes"].to_string().contains("digits"), "{}", found["notes"]);
}

/// Two or three digits of a shape are no fault of it, however stiff the part is against their rounding: no check fails for them, and what
/// they leave open is said with its bound.
#[test]
fn shapes_of_two_and_three_digits_are_right() {
    let thin = brick([12, 4, 1], [1.0, 0.3, 0.01], &Material::STEEL_SI);
    for digits in [2, 3] {
        for model in [bar(), block(), thin.clone()] {
            let mut pairs = lowest(&model, 14);
            pairs.hertz[..6].fill(0.0);
            pairs.shapes.iter_mut().flatten().for_each(|value| *value = rounded(*value, digits));
            let found = document(&place_of(&model, &pairs), "", ExitCode::Done);
            let verdicts = ["C-01", "C-05"].map(|id| verdict(&found, id));
            assert_eq!(verdicts, [Some("pass"); 2], "{digits} digits: {found}");
            assert_eq!(
                (of_kind(&found, "inexact").len(), of_kind(&found, "mode").len()),
                (0, 8),
                "{digits} digits: {found}"
            );
            let notes = found["notes"].to_string();
            let said = format!("the shapes have {digits} digits: numbers may be off by 5e-0{digits} of themselves");
            assert!(notes.contains(&said) && notes.contains("of their length in the mass"), "{digits} digits: {notes}");
            // A frequency that is off is so whatever the digits of its shape.
            pairs.hertz[9] *= 1.03;
            let found = document(&place_of(&model, &pairs), "", ExitCode::CheckFailed);
            assert_eq!(verdict(&found, "C-01"), Some("fail"), "{digits} digits: {found}");
        }
    }
}

/// A shape that has much of its neighbour is wrong in two digits as it is in all of them, whether the result has the neighbour or not.
#[test]
fn shapes_that_have_much_of_a_neighbour_are_wrong_in_few_digits() {
    for digits in [2, 3, 4, 17] {
        let of_next = mixed(digits, |shapes| turn(shapes, [13, 14], 0.3));
        let found = document(&place_of(&block(), &of_next), "", ExitCode::CheckFailed);
        assert_eq!(verdict(&found, "M-08"), Some("fail"), "{digits} digits");
        let of_each_other = mixed(digits, |shapes| turn(shapes, [12, 13], 0.3));
        let found = document(&place_of(&block(), &of_each_other), "", ExitCode::CheckFailed);
        assert_eq!(verdict(&found, "M-08"), Some("fail"), "{digits} digits");
    }
}

/// Digits of slender beams leave rigid-body motion an energy near that of the first mode. Exact pairs of such matrices have it too, and what is a
/// warning of the matrices is no failure of the result.
#[test]
fn energies_that_digits_leave_are_no_failure() {
    let at = |k: usize| [(k % 2) as f64, (k / 2 % 2) as f64, (k / 4) as f64];
    let nodes: Vec<[f64; 3]> = (0..12).map(at).collect();
    let pairs = (0..12).flat_map(|i| (0..i).map(move |j| [j, i]));
    let distance = |[i, j]: [usize; 2]| (0..3).map(|d| (at(i)[d] - at(j)[d]).abs()).sum::<f64>();
    let edges: Vec<[usize; 2]> = pairs.filter(|pair| distance(*pair) == 1.0).collect();
    let lattice = frame(&nodes, &edges, &Section::round(0.006), &Material::STEEL_SI, Inertia::Consistent);
    let model = of_digits(&lattice, 6);
    let place = place_of(&model, &lowest(&model, 8));
    // Few different numbers show no digits but by how they are written.
    for (name, entries) in [("K.mtx", &model.stiffness), ("M.mtx", &model.mass)] {
        let lower: Vec<_> = entries.iter().filter(|(row, col, _)| row >= col).collect();
        let n = [model.n, model.n, lower.len()].map(|n| n.to_string()).join(" ");
        let lines = lower.iter().map(|(row, col, value)| format!("{} {} {value:.5e}\n", row + 1, col + 1));
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n}\n{}", lines.collect::<String>());
        place.write(name, text.as_bytes());
    }
    let map = format!("--nodes {} --dofs {}", place.text("nodes.csv"), place.text("dofs.txt"));
    let found = document(&place, &map, ExitCode::Done);
    let value = |id: &str| {
        let checks = found["checks"].as_array().expect("checks");
        let check = checks.iter().find(|check| check["id"] == id);
        check.and_then(|check| check["value"].as_f64()).unwrap_or_else(|| panic!("{id}: {found}"))
    };
    assert!(value("C-05") > 1e-2, "more than digits excuse without a word: {found}");
    assert_eq!([verdict(&found, "M-05"), verdict(&found, "C-05")], [Some("warn"); 2], "{found}");
    assert_eq!(["invented", "inexact"].map(|kind| of_kind(&found, kind)), [Vec::<u64>::new(), Vec::new()], "{found}");
}
