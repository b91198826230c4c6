//! Rows that are held, or that follow others, are part of what a result says: they are looked at, and not thrown away.

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::transform::supported;
use supel_testing::pencil::{eigen, matrices};
use supel_testing::place::{Place, steel_brick};

use super::{Pairs, document, lowest, of_kind, pairs_of, verdict};

/// The modes of a held brick on all rows of the free one, and the flags that hold it.
pub(super) fn held() -> (Model, Pairs, impl Fn(&Place) -> String) {
    let free = steel_brick();
    let is_held = |label: i64| label % 5 == 1;
    let pairs = lowest(&supported(&free, |(label, _)| is_held(label)), 10);
    let kept: Vec<usize> = (0..free.n).filter(|row| !is_held(free.dofs[*row].0)).collect();
    let on_all_rows = |shape: &Vec<f64>| {
        let mut whole = vec![0.0; free.n];
        kept.iter().zip(shape).for_each(|(row, value)| whole[*row] = *value);
        whole
    };
    let whole = Pairs { hertz: pairs.hertz.clone(), shapes: pairs.shapes.iter().map(on_all_rows).collect() };
    let labels: Vec<String> = free.labels.iter().filter(|label| is_held(**label)).map(i64::to_string).collect();
    let flags = move |place: &Place| format!("--dofs {} --fix wall={}", place.text("dofs.txt"), labels.join(","));
    (free, whole, flags)
}

/// The modes of a free brick whose fourth row follows its first, and G of that.
fn tied() -> (Model, Pairs) {
    let model = steel_brick();
    let [k, m] = matrices(&model);
    let kept: Vec<usize> = (0..model.n).filter(|row| *row != 3).collect();
    let t = Mat::from_fn(model.n, model.n - 1, |i, j| f64::from(u8::from(kept[j] == i || (i == 3 && kept[j] == 0))));
    let [k, m] = [k, m].map(|a| t.transpose() * &a * &t);
    let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), 1e6);
    (model, pairs_of(&lambda[..12], &(&t * &shapes)))
}

fn write_tie(place: &Place) -> String {
    let g = format!("%%MatrixMarket matrix coordinate real general\n1 {} 2\n1 1 1\n1 4 -1\n", steel_brick().n);
    place.write("G.mtx", g.as_bytes());
    format!("--constraints {}", place.text("G.mtx"))
}

fn largest(shape: &[f64]) -> f64 {
    shape.iter().fold(0.0, |max, value| max.max(value.abs()))
}

fn worst(document: &Value) -> String {
    let checks = document["checks"].as_array().expect("checks");
    let check = checks.iter().find(|check| check["id"] == "C-10").expect("C-10");
    check["worst"].to_string()
}

#[test]
fn a_shape_that_moves_a_held_row_is_no_mode() {
    let (model, right, flags) = held();
    let place = Place::with(&model);
    let certified = |moved: f64, code| {
        let mut pairs = right.clone();
        let row = (0..model.n).find(|row| model.dofs[*row].0 == 6).expect("a held row");
        pairs.shapes[3][row] = moved * largest(&right.shapes[3]);
        pairs.write(&place);
        document(&place, &format!("{} --strict", flags(&place)), code)
    };
    let found = certified(0.0, ExitCode::Done);
    assert_eq!((&found["verdict"], verdict(&found, "C-10")), (&"pass".into(), Some("pass")), "{found}");
    for moved in [1e-3, 1.0] {
        let found = certified(moved, ExitCode::CheckFailed);
        assert_eq!((of_kind(&found, "inexact"), verdict(&found, "C-10")), (vec![4], Some("fail")), "{found}");
        assert!(worst(&found).contains("node 6 ux in mode 4 at"), "{}", worst(&found));
        assert_eq!(found["missing"], serde_json::json!([]), "{found}");
        assert!(!found["notes"].to_string().contains("different orders"), "{found}");
    }
    // What a stiff penalty lets pass is a warning.
    assert_eq!(verdict(&certified(2e-5, ExitCode::CheckFailed), "C-10"), Some("warn"));
}

#[test]
fn a_shape_that_breaks_a_constraint_is_no_mode() {
    let (model, right) = tied();
    let place = Place::with(&model);
    let flags = format!("{} --strict", write_tie(&place));
    right.write(&place);
    let found = document(&place, &flags, ExitCode::Done);
    assert_eq!((&found["verdict"], verdict(&found, "C-10")), (&"pass".into(), Some("pass")), "{found}");
    let mut broken = right.clone();
    broken.shapes[7][3] += 0.1 * largest(&right.shapes[7]);
    broken.write(&place);
    let found = document(&place, &flags, ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "inexact"), verdict(&found, "C-10")), (vec![8], Some("fail")), "{found}");
    assert!(worst(&found).contains("in mode 8 at"), "{}", worst(&found));
    // The rows of a file of five digits follow each other to five digits.
    let mut short = right;
    short.shapes.iter_mut().flatten().for_each(|value| *value = format!("{value:.4e}").parse().expect("a number"));
    short.shapes.iter_mut().for_each(|shape| shape[3] *= 1.0 + 2e-5);
    short.write(&place);
    let found = document(&place, &write_tie(&place), ExitCode::Done);
    assert_eq!(verdict(&found, "C-10"), Some("pass"), "{found}");
}
