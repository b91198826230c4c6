//! `supel certify`: results that are right, and results with a mode lost, invented, repeated or inexact, each named with its frequency.

mod band;
mod digits;
mod document;
#[cfg(feature = "hdf5")]
mod exudyn;
mod files;
mod foreign_files;
mod found;
mod frd;
mod held_rows;
mod left_out;
mod near_modes;
mod reduced;
mod refused;
mod rigid;
mod strayed;
mod superelement;
mod turned;

use faer::Mat;
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::{Material, Model, brick};
use supel_testing::pencil::{eigen, matrices};
use supel_testing::place::{Ended, Place, supel};

/// A free bar of square section: its bending modes come in pairs of one frequency.
fn bar() -> Model {
    brick([8, 2, 2], [1.0, 0.05, 0.05], &Material::STEEL_SI)
}

/// Pairs of a model as another program would have them.
#[derive(Clone)]
struct Pairs {
    hertz: Vec<f64>,
    /// Shapes by columns.
    shapes: Vec<Vec<f64>>,
}

/// The lowest pairs of a model by dense algebra, rigid-body modes included.
fn lowest(model: &Model, count: usize) -> Pairs {
    let [k, m] = matrices(model);
    // A spectrum of the size of the first elastic modes.
    let alpha = 1e6;
    let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), alpha);
    pairs_of(&lambda[..count], &shapes)
}

fn pairs_of(lambda: &[f64], shapes: &Mat<f64>) -> Pairs {
    let hertz = lambda.iter().map(|lambda| lambda.abs().sqrt() / std::f64::consts::TAU).collect();
    let column = |j: usize| (0..shapes.nrows()).map(|i| shapes[(i, j)]).collect();
    Pairs { hertz, shapes: (0..lambda.len()).map(column).collect() }
}

impl Pairs {
    /// All of them but one, numbered from zero.
    fn without(mut self, at: usize) -> Self {
        self.hertz.remove(at);
        self.shapes.remove(at);
        self
    }

    /// Those from a number on.
    fn from(mut self, at: usize) -> Self {
        self.hertz.drain(..at);
        self.shapes.drain(..at);
        self
    }

    /// Writes V.mtx and f.txt.
    fn write(&self, place: &Place) {
        place.write("V.mtx", array(&self.shapes).as_bytes());
        let lines: Vec<String> = self.hertz.iter().map(f64::to_string).collect();
        place.write("f.txt", (lines.join("\n") + "\n").as_bytes());
    }
}

/// A dense matrix in Matrix Market form.
fn array(columns: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", columns[0].len(), columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:e}\n"));
    text
}

/// `supel certify K.mtx M.mtx V.mtx --hz f.txt` with further arguments, split at spaces.
fn certify(place: &Place, rest: &str) -> Ended {
    let [k, m, v, f] = ["K.mtx", "M.mtx", "V.mtx", "f.txt"].map(|name| place.text(name));
    let mut args = vec!["certify", &k, &m, &v, "--hz", &f];
    args.extend(rest.split_whitespace());
    supel(&args)
}

/// The document of a result with this exit code.
#[track_caller]
fn document(place: &Place, rest: &str, code: ExitCode) -> Value {
    let ended = certify(place, &format!("--json {rest}")).expect(code);
    serde_json::from_str(&ended.out).expect("JSON")
}

/// A folder with a model and a result.
fn place_of(model: &Model, pairs: &Pairs) -> Place {
    let place = Place::with(model);
    pairs.write(&place);
    place
}

/// The verdict of a check; none where it was not made.
fn verdict<'a>(document: &'a Value, id: &str) -> Option<&'a str> {
    let checks = document["checks"].as_array().expect("checks");
    let check = checks.iter().find(|check| check["id"] == id)?;
    check["verdict"].as_str()
}

/// The numbers of the pairs of a kind.
fn of_kind(document: &Value, kind: &str) -> Vec<u64> {
    let pairs = document["pairs"].as_array().expect("pairs").iter();
    pairs.filter(|pair| pair["kind"] == kind).map(|pair| pair["number"].as_u64().expect("a number")).collect()
}

/// The frequencies that are missing.
fn missing(document: &Value) -> Vec<f64> {
    let missing = document["missing"].as_array().expect("missing").iter();
    missing.map(|mode| mode["frequency_hz"].as_f64().expect("a frequency")).collect()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, share: f64) {
    assert!((found / expected - 1.0).abs() <= share, "{found} and {expected}");
}
